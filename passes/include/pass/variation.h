// SPDX-License-Identifier: MIT
#ifndef PASS_VARIATION_H
#define PASS_VARIATION_H

#include <pass/frame.h>
#include <pass/pyramid.h>

FG_BEGIN

// How much depth and normals vary within blocks of 2^l x 2^l texels, l = 1 .. levels, of a G-buffer
// or of each layer of reflective shadow maps: pass "PREFIX_variation".
//
//     ag_variation_declare(&v, g, &(ag_variation_desc){ .prefix = "isr.eye",
//         .depth = gbuffer.depth, .normal = gbuffer.normal, .width = w, .height = h, .levels = 4
//         });
//
// Blocks at the right and upper edge may reach beyond the image; they hold what lies inside, so
// that no texel is lost at sizes that are no power of two.
//
// Shapes: change RGBA16F, a flattened pyramid of levels first .. levels (pass/pyramid.h): xyz
// extent
//         (largest minus least) of each component of the normal; w largest depth derivative. Both
//         are taken over the block's texels and their neighbours to the right and above, so that an
//         edge between two blocks shows in one of them at least. Rounded up, saturated at 65504.
//         range RG32F, likewise: least and largest reversed-Z depth of the block's texels that show
//         a surface; 1, 0 where none does.
//         Layers as the depth has; 0 means no array.
// Units:  depth derivative: relative to the distance from the eye, of one texel to the next;
//         orthographic: relative to the whole range of depth.
// Left out where the scene has no geometry; of lights, where it has none.
// Source: Nichols, Shopf, Wyman 2009, fig. 2c and sec. 3.2.1, 3.4.
typedef enum ag_depth_metric {
    AG_DEPTH_PLANE = 0, // by how much depth departs from going on straight: 0 on any plane, however
                        // steeply it is seen
    AG_DEPTH_SLOPE,     // the paper's derivative sqrt((dz/dx)^2 + (dz/dy)^2)
} ag_depth_metric;

enum { AG_MAX_LEVELS = 6 };

typedef struct ag_variation_desc {
    const char *prefix; // e.g. "isr.eye"
    fg_res depth;       // DEPTH32F, reversed Z, 0 where nothing is
    fg_res normal;      // RGBA16F, w 0 where nothing is
    int width, height;
    int layers; // 0: the view's G-buffer; else reflective shadow maps of all of the scene's faces
    int levels; // [1, AG_MAX_LEVELS]
    int first;  // finest level that is made, [1, levels]; 0: 1
    ag_depth_metric metric;
    bool range; // make it
} ag_variation_desc;

typedef struct ag_variation_pass {
    fg_res depth, normal;
    fg_res change;
    fg_res range; // null unless asked for
    ag_scene_res scene;
    ag_pyramid pyramid; // of levels first .. levels
    int width, height, layers, levels, first;
    ag_depth_metric metric;
} ag_variation_pass;

FG_API void ag_variation_declare(ag_variation_pass *pass, fg_graph *g, const ag_scene_res *scene,
                                 const ag_variation_desc *desc);

FG_END

#endif // PASS_VARIATION_H
