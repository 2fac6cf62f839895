// SPDX-License-Identifier: MIT
#ifndef PASS_INTERLEAVE_H
#define PASS_INTERLEAVE_H

#include <pass/frame.h>

FG_BEGIN

// Interleaved sampling: the G-buffer taken apart into n x n tiles, each lit by a subset of the
// VPLs, put together again and filtered.
//
//     ag_split_declare(&split, g, &in->scene, &in->gbuffer,
//                      &(ag_split_desc){ .prefix = "iir", .tiles = 4, .width = in->width,
//                                        .height = in->height });
//     ag_gather_declare(..., &(ag_gather_desc){ .prefix = "iir", .split = &split });
//     ag_combine_declare(&combine, g, &split, gather.out);
//     ag_box_filter_declare(&filter, g, &split, combine.out, &(ag_box_filter_desc){ 0 });
//     ... filter.out ...
//
// Tile (i, j) holds the pixels (a n + i, b n + j), as far as there are any: sec. 5.1. With n 1
// all three change nothing and are left out: what they would make is what they are given.
//
// Source: Laine, Saransaari, Kontkanen, Lehtinen, Aila. Incremental Instant Radiosity for
//         Real-Time Indirect Illumination. EGSR 2007, sec. 5; Segovia, Iehl, Mitanchey, Peroche.
//         Non-interleaved Deferred Shading of Interleaved Sample Patterns. Graphics Hardware 2006.

// Pass "PREFIX.split".
// Shapes: position RGBA32F, normal RGBA16F as in the G-buffer, [n ceil(w / n) x n ceil(h / n)], of
//         n x n tiles; where a tile has no pixel w is 0.
enum { AG_MAX_TILES = 16 };

typedef struct ag_split_pass {
    ag_scene_res scene;
    ag_gbuffer gbuffer;
    fg_res position, normal;
    const char *prefix; // as the descriptor had it: static
    int tiles;          // n: what was asked for, but no more than the frame has rows or columns
    int frame[2];       // pixels
    int size[2];        // of the split textures
    int tile[2];        // of one tile
} ag_split_pass;

typedef struct ag_split_desc {
    const char *prefix; // static
    int tiles;          // n, [1, AG_MAX_TILES]
    int width, height;  // of the frame
} ag_split_desc;

FG_API void ag_split_declare(ag_split_pass *pass, fg_graph *g, const ag_scene_res *scene,
                             const ag_gbuffer *gbuffer, const ag_split_desc *desc);

// Pass "PREFIX.combine": the exact opposite of the split.
// Shapes: in RGBA32F of the split's size; out RGBA32F of the frame's.
typedef struct ag_combine_pass {
    const ag_split_pass *split;
    fg_res in, out;
} ag_combine_pass;
FG_API void ag_combine_declare(ag_combine_pass *pass, fg_graph *g, const ag_split_pass *split,
                               fg_res in);

// Pass "PREFIX.filter": the mean over those of the n x n pixels about each that belong to its
// surface (fig. 5). Every pixel counts itself; what is not finite does not count.
//
// Each tile is to be met once, for then the pattern is gone. So the window is shifted inwards at
// the image's border, and for a pixel of another surface the one of its tile n pixels on, to the
// other side, counts if it belongs; a surface at least 2 n - 1 pixels wide about a pixel lacks
// none. With an even n the window's middle lies half a pixel to the left and below.
//
// Shapes: in, out RGBA32F of the frame's size; a 1; 0 where nothing is.
typedef enum ag_box_metric {
    AG_BOX_PLANE = 0, // alpha bounds how far a pixel lies off the plane of the middle one, over the
                      // distance to the viewer (orthographic: over the scene's size)
    AG_BOX_DISTANCE,  // alpha bounds the distance of the two, m: the paper's
} ag_box_metric;
typedef struct ag_box_filter_pass {
    const ag_split_pass *split;
    fg_res in, out;
    ag_box_metric metric;
    float alpha, beta;
} ag_box_filter_pass;
typedef struct ag_box_filter_desc {
    ag_box_metric metric;
    float alpha; // >= 0
    float beta;  // least cosine between the normals, [-1, 1]; the paper's is 0.8
} ag_box_filter_desc;
FG_API void ag_box_filter_declare(ag_box_filter_pass *pass, fg_graph *g, const ag_split_pass *split,
                                  fg_res in, const ag_box_filter_desc *desc);

FG_END

#endif // PASS_INTERLEAVE_H
