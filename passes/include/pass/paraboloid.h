// SPDX-License-Identifier: MIT
#ifndef PASS_PARABOLOID_H
#define PASS_PARABOLOID_H

#include <pass/frame.h>

FG_BEGIN

// Paraboloid shadow maps of VPLs: one hemisphere each, of the scene's static surfaces, kept from
// frame to frame; only new ones are drawn.
//
//     ag_paraboloid_create(&(ag_paraboloid_desc){ .scene = scene, .device = dev, .capacity = 256 },
//                          &maps);                                                   // once
//     each frame, before it runs:
//         ag_paraboloid_set(maps, vpls, count, &view);   // which VPLs there are; who is new
//     ... declare:
//     ag_paraboloid_declare(&pass, g, maps, &in->scene, "iir");
//     ag_gather_declare(..., &(ag_gather_desc){ .prefix = "iir", .paraboloid = &pass });
//     ag_paraboloid_destroy(maps);
//
// A texel holds the nearest surface along its ray, found exactly: edges are straight lines of the
// scene whatever the tessellation (no vertex is projected and joined by chords).
//
// Source: Heidrich, Seidel. View-independent Environment Maps. Graphics Hardware 1998; Brabec,
//         Annen, Seidel. Shadow Mapping for Hemispherical and Omnidirectional Light Sources. CGI
//         2002; as used in Laine et al. 2007, sec. 4.6.
// Thread: the one that has the context.
typedef struct ag_paraboloid_maps ag_paraboloid_maps;

typedef struct ag_paraboloid_desc {
    const fg_log *log; // Optional. Borrowed, as all below.
    fg_device *device;
    const ag_scene *scene;         // static triangles are copied now
    const ag_gpu_scene *gpu_scene; // textures of MASK
    int size;                      // texels along an edge: 16 to 1024, a power of two; 0: 256
    int capacity;                  // maps, [1, 4096]
} ag_paraboloid_desc;

// Errors: FG_ERR_INVALID; FG_ERR_MEMORY; FG_ERR_UNSUPPORTED: more than the device's textures or
//         buffers hold.
FG_API FG_NODISCARD fg_status ag_paraboloid_create(const ag_paraboloid_desc *desc,
                                                   ag_paraboloid_maps **out);
FG_API void ag_paraboloid_destroy(ag_paraboloid_maps *m); // accepts NULL

// A VPL that is looked up in the next frame; entry i of the array is VPL i of the gather's list.
typedef struct ag_paraboloid_eye {
    double position[3]; // world
    float normal[3];    // unit
    int slot;           // of its map, [0, capacity)
    bool fresh;         // the map is to be drawn: the slot has a new owner
} ag_paraboloid_eye;

// Says what the next frame looks up, and uploads nothing yet. A map that was asked for and not
// drawn, because the frame failed or left it out, stays asked for.
FG_API void ag_paraboloid_set(ag_paraboloid_maps *m, const ag_paraboloid_eye *eyes, int count,
                              const ag_view *view);

FG_API int ag_paraboloid_drawn(const ag_paraboloid_maps *m);      // maps that the last frame drew
FG_API uint64_t ag_paraboloid_bytes(const ag_paraboloid_maps *m); // device memory held

// Passes "PREFIX.shadow_..."; maps and eyes are imports that outlive the frame.
typedef struct ag_paraboloid_pass {
    ag_paraboloid_maps *owner;
    ag_scene_res scene;
    fg_res triangles, list, eyes, maps; // as the owner sees fit
} ag_paraboloid_pass;

FG_API void ag_paraboloid_declare(ag_paraboloid_pass *pass, fg_graph *g, ag_paraboloid_maps *m,
                                  const ag_scene_res *scene, const char *prefix);

FG_END

#endif // PASS_PARABOLOID_H
