// SPDX-License-Identifier: MIT
#ifndef PASS_RAYS_H
#define PASS_RAYS_H

#include <pass/scene.h>

FG_BEGIN

// Ray casts against a scene at its current time, on the CPU, by Embree. Exact:
// RTC_SCENE_FLAG_ROBUST, double-precision origin offset, alpha masks honoured.
//
// Thread: casts may run on any number of threads at once; create and destroy not. With static_only
//         they may run while another thread calls ag_scene_set_time(), which leaves alone what
//         does not move; while it adds lights or cameras, or builds or destroys the scene, never.
typedef struct ag_rays ag_rays;

typedef struct ag_rays_desc {
    const fg_log *log;
    const ag_scene *scene; // Borrowed while this lives; casts see it as it stands now, so
                           // make new rays after ag_scene_set_time(), unless static_only.
    double origin[3];      // Subtracted from all positions before they become floats: the camera.
    bool static_only;      // leave moving instances out, those of which the mask moves too
    int threads;           // for building; 0: all
} ag_rays_desc;

// Errors: FG_ERR_INVALID, FG_ERR_MEMORY; FG_ERR_UNSUPPORTED where Embree does not run.
FG_API FG_NODISCARD fg_status ag_rays_create(const ag_rays_desc *desc, ag_rays **out);
FG_API void ag_rays_destroy(ag_rays *rays); // accepts NULL

typedef struct ag_hit {
    float distance;       // in units of |direction|
    int instance;         // of the scene
    uint32_t triangle;    // within the primitive
    float barycentric[2]; // of vertices 1 and 2
    float position[3];    // relative to `origin`, recomputed from the triangle, not along the ray
    float face_normal[3]; // unit, by winding (mirroring accounted for)
    float normal[3]; // unit, interpolated from the vertices; a front-facing viewer sees it as it
                     // is, one behind the face sees its opposite
    float uv[2][2];
    float color[4];
    bool front; // the ray came from the side that face_normal points to
} ag_hit;

// Nearest hit in (tnear, tfar); false if none. Positions are relative to `origin`.
FG_API bool ag_rays_nearest(const ag_rays *rays, const float from[3], const float direction[3],
                            float tnear, float tfar, ag_hit *hit);

// Whether anything lies in (tnear, tfar).
FG_API bool ag_rays_blocked(const ag_rays *rays, const float from[3], const float direction[3],
                            float tnear, float tfar);

// The same for many rays at once, in one stream where Embree has them. Shapes: blocked [count].
typedef struct ag_ray {
    float from[3], direction[3];
    float tnear, tfar;
} ag_ray;
FG_API void ag_rays_blocked_many(const ag_rays *rays, const ag_ray *cast, int count, bool *blocked);

// All hits in (0, tfar), nearest first, at most `max`; for techniques that leave visibility
// out. Returns how many there are, which may exceed `max`.
FG_API int ag_rays_all(const ag_rays *rays, const float from[3], const float direction[3],
                       float tfar, ag_hit *hits, int max);

// A start for a ray that leaves `position` on the side of `side_normal`, moved just far
// enough off the surface that it cannot meet it again.
FG_API void ag_rays_offset(const float position[3], const float side_normal[3], float out[3]);

FG_END

#endif // PASS_RAYS_H
