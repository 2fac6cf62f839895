// SPDX-License-Identifier: MIT
#ifndef ISR_CLUSTER_H
#define ISR_CLUSTER_H

#include <pass/variation.h>
#include <pass/vpl.h>

FG_BEGIN

// VPLs by clustering the texels of reflective shadow maps anew each frame: passes
// "PREFIX.light_variation", "PREFIX.sum", "PREFIX.choose" and "PREFIX.pack".
//
//     isr_clusters_desc desc = isr_clusters_default;
//     desc.prefix = "isr";
//     isr_clusters_declare(&clusters, &vpl, g, &rsm, &desc);
//     ag_gather_declare(..., &vpl, ...);
//
// A face is sampled by a fine grid of blocks of texels. A block represents the patch about it at
// the coarsest level where that holds no discontinuity of depth or normals, or less than
// `least_flux` of all flux, while the next coarser one holds both. Of a patch across a
// discontinuity the surfaces get a VPL each, the three that reflect most, so that light moves from
// one surface to the next as smoothly as its texels do.
//
// A VPL sits at the mean of its texels by flux, its patch is spread as they are, and it carries
// their summed flux and area, so that the energy does not depend on the patches. With several
// lights the coarsest patches are split over faces by power, as ag_vpl_split() does it, and a
// face's finest ones are coarser in proportion.
//
// Shapes: `vpl`: vpls, count and capacity as ag_vpl_declare() makes them, in the order of faces,
//         rows and columns of the finest grid, three slots a block.
// Errors: an RSM whose edge is no power of two, grids or shares out of range fail the graph.
// Source: Nichols, Shopf, Wyman 2009, sec. 3.4, fig. 7. Departs from it: means instead of samples;
//         flux decides too; a VPL for each surface of a patch.
typedef struct isr_clusters_desc {
    const char *prefix;
    int initial;      // finest blocks along a face's edge, a power of two, [1, 1024], 32; the RSM's
                      // texels at most
    int coarsest;     // coarsest patches along an edge, a power of two, [initial / 8, initial], 8
    float depth;      // largest depth derivative that is no discontinuity, >= 0, 0.05
    float normal;     // likewise extent of a component of the normal, >= 0, 0.3; 2 is all there is
    float least_flux; // a patch with less than this share of all flux is not divided, >= 0, 0.01
} isr_clusters_desc;

extern const isr_clusters_desc isr_clusters_default; // as said above

typedef struct isr_clusters {
    const ag_gpu_scene *gpu;
    ag_variation_pass variation;
    ag_vpl_pass *vpl;
    fg_res position, normal, flux, faces, table, parts, sums;
    int size, face_count; // of the maps
    int coarsest, levels; // levels: how many times four blocks may become one
    float limit_depth, limit_normal, least_flux;
    int32_t rows[1 + AG_MAX_FACES][4]; // plugins/isr/cluster.glsl
} isr_clusters;

void isr_clusters_declare(isr_clusters *c, ag_vpl_pass *vpl, fg_graph *g, const ag_rsm_pass *rsm,
                          const isr_clusters_desc *desc);

FG_END

#endif // ISR_CLUSTER_H
