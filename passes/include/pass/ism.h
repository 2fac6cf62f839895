// SPDX-License-Identifier: MIT
#ifndef PASS_ISM_H
#define PASS_ISM_H

#include <pass/frame.h>
#include <pass/ism_shared.h>

FG_BEGIN

// Indirect visibility by imperfect shadow maps: small hemispherical depth maps of all VPLs, drawn
// from point samples of the scene.
//
//     ag_ism_samples_create(&(ag_ism_samples_desc){ .log = log, .scene = scene }, &samples); //
//     once
//     ... declare:
//     ag_ism_declare(&ism, g, samples, &in->scene,
//                    &(ag_ism_desc){ .prefix = "rsm", .vpls = vpl.vpls, .count = vpl.count,
//                                    .capacity = vpl.capacity });
//     ag_gather_declare(..., &(ag_gather_desc){ .prefix = "rsm", .visibility = &ism });
//     ag_ism_samples_destroy(samples);
//
// A pass of one's own reads AG_ISM_READS(ism), calls ag_ism_bind() and includes
// passes/ism/visibility.glsl.

// ---- samples --------------------------------------------------------------------------------

enum { AG_ISM_MAX_SAMPLES = 1 << 20 };

// Places `count` samples evenly over the area of the scene's surfaces as they stand, both faces
// being one. Every aligned run of 2^k samples is itself spread evenly: a triangle that has the
// fraction f of the area gets 2^k f of them, to less than one either way, and they follow a curve
// that fills it. Triangles without area get none; a sample where MASK, as it stands now, has taken
// the surface away has instance -1, and so have all where the scene has no area.
//
// Errors: FG_ERR_INVALID: `count` is no power of two in [1, AG_ISM_MAX_SAMPLES]; FG_ERR_MEMORY.
// Source: Ritschel et al. 2008, sec. 4.1. Departs from it: a space-filling curve instead of random
//         places, so that points do not clump and each map's subset is as even as the whole.
FG_API FG_NODISCARD fg_status ag_ism_sample_scene(const fg_log *log, const ag_scene *scene,
                                                  uint32_t seed, int count, ag_ism_sample *out);

// The samples of a scene on the GPU.
typedef struct ag_ism_samples ag_ism_samples;

typedef struct ag_ism_samples_desc {
    const fg_log *log;     // Optional. Borrowed during the call.
    const ag_scene *scene; // read during the call; its topology must stay
    uint32_t seed;
    int count; // a power of two in [1, AG_ISM_MAX_SAMPLES]; 0: 65536. Holds 32 bytes each.
} ag_ism_samples_desc;

// Errors: as ag_ism_sample_scene(); FG_ERR_UNSUPPORTED: the scene's vertices are more than a
//         storage block of the device holds, 128 MiB at least.
// Thread: the one that has the context.
FG_API FG_NODISCARD fg_status ag_ism_samples_create(const ag_ism_samples_desc *desc,
                                                    ag_ism_samples **out);
FG_API void ag_ism_samples_destroy(ag_ism_samples *s); // accepts NULL

// ---- maps -----------------------------------------------------------------------------------

// Passes "PREFIX.ism_place" (samples to render space, each frame) and "PREFIX.ism_maps".
//
// Map m is the hemisphere about the normal of the middle VPL of the m-th run of the list
// (ism_first_of() in pass/ism_shared.h): where there are no more VPLs than maps, of VPL m; else
// VPLs that follow each other share one, and it is looked up from where its owner is. Each map gets
// a subset of `points` samples; neighbours get different ones.
//
// Any buffer of ag_vpl has maps in this way, not only that of an ag_vpl_pass: with `maps` at
// least `capacity`, the map of entry i is i.
//
// Shapes: maps R32F [size x size x map_count], reciprocal distance, 0: nothing there;
//         eyes ag_ism_eye[map_count] (pass/ism_shared.h). Of maps beyond `count`.x all is 0.
// Units:  1 / scene units (lengths times view.scale.x).
// Left out where the scene has no light or no geometry.
// Source: Ritschel, Grosch, Kim, Seidel, Dachsbacher, Kautz. Imperfect Shadow Maps for Efficient
//         Computation of Indirect Illumination. ACM Trans. Graph. 27(5), SIGGRAPH Asia 2008.
//         Departs from it: see ism_maps.comp.
typedef struct ag_ism_pass {
    ag_scene_res scene;
    fg_res samples, points, vpls, count;
    fg_res maps, eyes;
    int sample_count;
    int size, point_count, map_count;
} ag_ism_pass;

typedef struct ag_ism_desc {
    const char *prefix; // of passes and resources, e.g. "rsm"
    fg_res vpls;        // ag_vpl[], pass/vpl_shared.h
    fg_res count;       // uvec4, x: how many of them are valid
    int capacity;       // of `vpls`, at least 1
    int size;           // texels along a map's edge: 8, 16, 32 or 64; 0: 64
    int points;         // samples of one map: a power of two in [256, 32768], at most as many as
                        // there are samples; 0: 8192
    int maps; // [1, 2048]; no more than `capacity` are made. 0: 1024. 4 size^2 bytes each.
} ag_ism_desc;

FG_API void ag_ism_declare(ag_ism_pass *pass, fg_graph *g, const ag_ism_samples *samples,
                           const ag_scene_res *scene, const ag_ism_desc *desc);

// What a pass that looks maps up must read, for its `reads` table.
#define AG_ISM_READS(ism)                                                                          \
    { (ism).maps },                                                                                \
    {                                                                                              \
        (ism).eyes                                                                                 \
    }

// Binds the maps to texture unit 4 and the eyes to storage 4, as visibility.glsl has them.
FG_API void ag_ism_bind(const fg_run *run, const ag_ism_pass *pass);

FG_END

#endif // PASS_ISM_H
