// SPDX-License-Identifier: MIT
#ifndef PASS_MULTIRES_H
#define PASS_MULTIRES_H

#include <pass/pyramid.h>
#include <pass/variation.h>

FG_BEGIN

// Chooses at which resolution each part of the image is lit, and brings what was gathered there
// back to every pixel:
//
//     ag_multires_declare(&m, g, &scene, &gbuffer, &(ag_multires_desc){ .prefix = "isr", ... });
//     ag_gather_declare(..., &(ag_gather_desc){ .multires = &m, ... });    // E / pi at its texels
//     ag_upsample_declare(&up, g, &m, gather.out, "isr");                  // at every pixel
//
// Level l of the multiresolution buffer has a texel for each block of 2^l x 2^l pixels, l = 0 ..
// levels - 1. A texel is refined where depth or normals change too much within it, where it reaches
// beyond the image, or where a neighbour is refined twice over: levels of neighbours differ by one
// at most. It is valid where it is not refined and the texel above it is, so that each pixel is
// covered by exactly one valid texel.
//
// With `share` above 0 the levels below are not refined to pixel by pixel: a block of level `share`
// that holds an edge is covered by its surfaces, and of each one pixel is valid for all.
//
// Passes "PREFIX.eye_variation", "PREFIX.refine", "PREFIX.valid", "PREFIX.share" where `share` is
// above 0, "PREFIX.list" and, with AG_CULL_STENCIL, "PREFIX.stencil".
//
// Shapes: flags: uint of each texel of levels 1 .. levels - 1; tiles: uvec4 of each 8 x 8 pixels,
//         what is valid; both as passes/multires/texel.glsl says.
//         texels: uint[capacity], the valid texels that show a surface, as multires_pack() makes
//         them; count: uvec4, x how many those are, yzw 0; then indirect dispatches of as many work
//         groups as take 64, 256 and 1024 each, 16 bytes apart.
//         stencil: depth-stencil of the pyramid's size, stencil 1 at those texels. STENCIL only.
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2.1.
//         Departs from it: 2:1 balance; departure from a plane as a metric; `share`; a texel never
//         reaches beyond the image.
typedef enum ag_cull {
    AG_CULL_COMPACT = 0, // valid texels in a list; indirect dispatch
    AG_CULL_STENCIL,     // the paper's: valid texels marked by stencil, early stencil test
} ag_cull;

typedef struct ag_multires_desc {
    const char *prefix;
    int width, height; // pixels
    int coarsest;      // texels along the longer edge of the coarsest level, about: >= 1; 0: 64
    float depth;       // depth derivative from which on a texel is refined, >= 0; 0: every texel
    float normal;      // extent of a component of the normal from which on it is, >= 0
    ag_depth_metric metric;
    ag_cull cull;
    int share;       // [0, 3]; 0: as the paper
    bool unbalanced; // leave 2:1 out
} ag_multires_desc;

typedef struct ag_multires_pass {
    ag_scene_res scene;
    fg_res position, normal; // of the G-buffer
    ag_variation_pass variation;
    fg_res flags, shared, sums, texels, count;
    fg_res marked, tiles; // without what lies in shared blocks, and with it
    fg_res stencil;       // AG_CULL_STENCIL
    ag_pyramid pyramid;
    int width, height;
    int capacity; // of `texels`: the pixels
    int share;
    float limit_depth, limit_normal;
    ag_cull cull;
    bool unbalanced;
} ag_multires_pass;

FG_API void ag_multires_declare(ag_multires_pass *pass, fg_graph *g, const ag_scene_res *scene,
                                const ag_gbuffer *gbuffer, const ag_multires_desc *desc);

// Levels for an image of this size: the coarsest has at most `coarsest` texels along its longer
// edge, or the image AG_MAX_LEVELS halvings.
FG_API int ag_multires_levels(int width, int height, int coarsest);

// Where the words of a level begin in `flags`.
FG_API int ag_multires_flag_start(const ag_multires_pass *pass, int level);

// Interpolates a multiresolution image to every pixel: passes "PREFIX.push..." and
// "PREFIX.upsample".
//
// From the coarsest level to the finest each texel without a value of its own takes the bilinear
// mean of the four nearest on the coarser level, of those that have no edge in them and are not
// beyond one. A constant stays as it is; what is linear stays linear within a surface.
//
// Shapes: in and out RGBA32F; `image` a pyramid of all levels (pass->pyramid), values at the valid
//         texels, the rest undefined; out of the frame's size, a 1, 0 where nothing is.
// Source: Nichols, Wyman. Multiresolution Splatting for Indirect Illumination. I3D 2009, sec. 4.4,
//         as used in Nichols, Shopf, Wyman 2009, sec. 3.2.2.
typedef struct ag_upsample_pass {
    const ag_multires_pass *multires;
    fg_res image;         // with the values that interpolation needs
    fg_res blocks, cells; // with share > 0
    fg_res out;
} ag_upsample_pass;

FG_API void ag_upsample_declare(ag_upsample_pass *pass, fg_graph *g,
                                const ag_multires_pass *multires, fg_res image, const char *prefix);

// The buffer to look at: passes "PREFIX.level_layer" and "PREFIX.validity_layer", left out while
// nobody reads what they make.
//
// Shapes: levels RGBA16F of the frame's size: the level that covers each pixel, from blue, the
//         finest, to red; black where nothing is. Shared blocks are black with their lit pixels
//         white. validity RGBA16F of the pyramid's size: white at valid texels that show a surface.
// Units:  display values in [0, 1].
typedef struct ag_multires_debug {
    const ag_multires_pass *multires;
    fg_res levels, validity;
} ag_multires_debug;

FG_API void ag_multires_debug_declare(ag_multires_debug *pass, fg_graph *g,
                                      const ag_multires_pass *multires, const char *prefix);

FG_END

#endif // PASS_MULTIRES_H
