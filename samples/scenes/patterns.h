// SPDX-License-Identifier: MIT
#ifndef PATTERNS_H
#define PATTERNS_H

#include <fg/base.h>

FG_BEGIN

// Tiling textures made by code: integer-hash value noise, so that every machine paints the same.
// The side of the tile in metres is what each is drawn for.
typedef enum pattern {
    PATTERN_ASHLAR = 0, // coursed limestone blocks, 2 m
    PATTERN_LIMESTONE,  // smooth, veined, for columns, 1 m
    PATTERN_PLASTER,    // ochre wash, weathered, 3 m
    PATTERN_BRICK,      // 1 m
    PATTERN_PAVING,     // court: pale squares with dark diamonds, 1.2 m
    PATTERN_TERRACOTTA, // gallery floors: square tiles, 1.2 m
    PATTERN_CLAY,       // roof tiles, pots, 1 m
    PATTERN_WOOD,       // planks along v, 1 m
    PATTERN_FABRIC,     // woven, near white: takes its colour from the material, 0.6 m
    PATTERN_LEAVES,     // a spray of leaves, alpha 0 or 1 between them, one card
    PATTERN_PARQUET,    // oak strips along v, 1.2 m
    PATTERN_RUG,        // one whole rug
    PATTERN_PICTURES,   // four paintings, a quarter each
    PATTERN_TELEVISION, // 4 x 4 pictures of a film, in rows; four of each programme
    PATTERN_EVENING,    // what is seen through a window, once
    PATTERN_CARTON,     // one side of a box with its tape, near white: takes the material's colour
    PATTERN_CONCRETE,   // a slab with its joints, 4 m
    PATTERN_BELT,       // rubber with a chevron that points to +v, 1 m
    PATTERN_SHEET,      // corrugated steel, ribs along v, 1 m
    PATTERN_HAZARD,     // yellow and black, 0.5 m
    PATTERN_FRESCO,     // painted plaster, near white: colour from the material, 3 m
    PATTERN_LAWN,       // turf seen from above, 2 m
    PATTERN_BARK,       // grooves along v, 1 m
    PATTERN_GRASS,      // blades from the lower edge up, alpha between them, one card
    PATTERN_FERN,       // a frond from the lower edge up, likewise
    PATTERN_FLOWER,     // petals, near white, around a yellow middle, likewise
    PATTERN_COUNT,
} pattern;

// Paints RGBA8, sRGB-encoded, `size` x `size`, a power of two.
void pattern_paint(pattern what, int size, uint8_t *rgba);

// Whether it has texels of alpha 0, to be left out.
bool pattern_is_masked(pattern what);

FG_END

#endif // PATTERNS_H
