// SPDX-License-Identifier: MIT
#ifndef PASS_PARABOLOID_H
#define PASS_PARABOLOID_H

#include <pass/frame.h>
#include <pass/paraboloid_shared.h>

FG_BEGIN

// Paraboloid shadow maps of VPLs: one hemisphere each, of the scene's static surfaces, kept from
// frame to frame; only new ones are drawn.
//
//     ag_paraboloid_create(&(ag_paraboloid_desc){ .scene = scene, .device = dev, .capacity = 256 },
//                          &maps);                                                   // once
//     each frame, before it runs:
//         ag_paraboloid_set(maps, vpls, count, &view);   // which VPLs there are; who is new
//     ... declare:
//     ag_paraboloid_declare(&pass, g, maps, "iir");
//     ag_gather_declare(..., &(ag_gather_desc){ .prefix = "iir", .paraboloid = &pass });
//     ag_paraboloid_destroy(maps);
//
// A pass of one's own reads AG_PARABOLOID_READS(pass), calls ag_paraboloid_bind() and includes
// passes/paraboloid/visibility.glsl.
//
// A texel holds the nearest surface along its middle's ray, found exactly: edges are straight lines
// of the scene whatever the tessellation, since no vertex is projected and joined by chords. They
// are sampled at texels' middles, so that an edge in a map lies within half a texel of where it is.
// Both faces of a triangle hide; MASK is honoured; instances that move, by themselves or by a skin,
// are not in.
//
// Shapes: maps R16F, reciprocal distance in units that bring the static scene's diagonal to
//         (1/2, 1], 0: nothing there. A texel whose middle is beyond the horizon has what is on the
//         horizon beside it, as far as lookups reach.
// Source: Heidrich, Seidel. View-independent Environment Maps. Graphics Hardware 1998; Brabec,
//         Annen, Seidel. Shadow Mapping for Hemispherical and Omnidirectional Light Sources. CGI
//         2002; as used in Laine et al. 2007, sec. 4.6.
//         Departs from it: triangles are rasterized by compute shaders, per texel's ray against the
//         planes through the eye and their edges; the paper tessellates the scene and lets the
//         hardware join projected vertices by straight lines.
// Thread: the one that has the context.
typedef struct ag_paraboloid_maps ag_paraboloid_maps;

typedef struct ag_paraboloid_desc {
    const fg_log *log; // Optional. Borrowed, as all below.
    fg_device *device;
    const ag_scene *scene; // read during the call: static triangles are copied
    int size;              // texels along an edge: 16 to 1024, a power of two; 0: 256
    int capacity;          // maps, [1, 4096]; 2 size^2 bytes each
} ag_paraboloid_desc;

// Errors: FG_ERR_INVALID; FG_ERR_MEMORY; FG_ERR_UNSUPPORTED: more than the device's textures or
//         buffers hold.
FG_API FG_NODISCARD fg_status ag_paraboloid_create(const ag_paraboloid_desc *desc,
                                                   ag_paraboloid_maps **out);
FG_API void ag_paraboloid_destroy(ag_paraboloid_maps *m); // accepts NULL

// A VPL that is looked up in the next frame; entry i of the array is VPL i of the gather's list.
//
// The position lies on its surface to 2^-20 of the scene's diagonal: within that, a triangle is
// taken to lie behind the side of it that `normal` is on, or, where it stands across the normal as
// a second wall does, behind its front face.
typedef struct ag_paraboloid_eye {
    double position[3]; // world
    float normal[3];    // unit
    int slot;           // of its map, [0, capacity), each in one entry at most
    bool fresh;         // the map is to be drawn: the slot has a new owner
} ag_paraboloid_eye;

// Says what the next frame looks up, and uploads nothing yet. A map that was asked for and not
// drawn, because the frame failed or left it out, stays asked for, and is drawn in the first frame
// that looks it up. At most `capacity` eyes; more, and slots out of range, are left out.
FG_API void ag_paraboloid_set(ag_paraboloid_maps *m, const ag_paraboloid_eye *eyes, int count,
                              const ag_view *view);

FG_API int ag_paraboloid_drawn(const ag_paraboloid_maps *m);      // maps that the last frame drew
FG_API uint64_t ag_paraboloid_bytes(const ag_paraboloid_maps *m); // device memory held

// Pass "PREFIX.shadow_maps"; maps and eyes are imports that outlive the frame.
typedef struct ag_paraboloid_pass {
    ag_paraboloid_maps *owner;
    fg_res maps, eyes; // as the pass leaves them
} ag_paraboloid_pass;

FG_API void ag_paraboloid_declare(ag_paraboloid_pass *pass, fg_graph *g, ag_paraboloid_maps *m,
                                  const char *prefix);

// What a pass that looks maps up must read, for its `reads` table; it reads the view besides.
#define AG_PARABOLOID_READS(pass)                                                                  \
    { (pass).maps },                                                                               \
    {                                                                                              \
        (pass).eyes                                                                                \
    }

// Binds the maps to texture unit 4 and the eyes to storage 4, as visibility.glsl has them.
FG_API void ag_paraboloid_bind(const fg_run *run, const ag_paraboloid_pass *pass);

FG_END

#endif // PASS_PARABOLOID_H
