// SPDX-License-Identifier: MIT
#ifndef PASS_RSM_H
#define PASS_RSM_H

#include <pass/lighting.h>

FG_BEGIN

// Reflective shadow maps of all lights: what each texel sees of the scene and what flux it
// reflects. Passes "PREFIX.face0" ...
//
// A spot up to 60 degrees from axis to rim is one perspective face, a wider or cosine spot five,
// a point light six, a directional light one orthographic face over the scene's box. All are of one
// size, the layers of one array. Faces through which no light goes are cleared and not drawn.
//
// Shapes: layers = faces of all lights, edge = `size`:
//         position RGBA32F: xyz render space; w area A_j of the texel's footprint, m^2, 0: no light
//         normal RGBA16F: xyz unit, the face's, turned to the light; w 1, 0: nothing here
//         flux RGBA32F: rgb reflected flux rho_j Phi_j, W; a solid angle of the texel, sr
//         (directional: its cross-section, m^2)
//         depth DEPTH32F: reversed Z, 0: nothing here
// Left out where the scene has no light or no geometry.
// Source: Nichols, Shopf, Wyman. Hierarchical Image-Space Radiosity for Interactive Global
//         Illumination. EGSR 2009, sec. 3.2, eq. 2-4.
//         Departs from it: exact solid angles; A_j with the cosine; several lights.
typedef struct ag_rsm_pass {
    const ag_gpu_scene *gpu;
    ag_scene_res scene;
    fg_res depth, position, normal, flux;
    int size, face_count;
    bool equal_solid_angle;
    ag_face_user faces[AG_MAX_FACES];
} ag_rsm_pass;

typedef struct ag_rsm_desc {
    const char *prefix;     // of passes and resources, e.g. "rsm"
    int size;               // texels along an edge, [1, 1024]
    bool equal_solid_angle; // the paper's eq. 4: every texel the same share of its face
} ag_rsm_desc;

FG_API void ag_rsm_declare(ag_rsm_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                           const ag_scene_res *scene, const ag_rsm_desc *desc);

FG_END

#endif // PASS_RSM_H
