// SPDX-License-Identifier: MIT
#ifndef PASS_COMPENSATE_H
#define PASS_COMPENSATE_H

#include <pass/frame.h>

FG_BEGIN

// Gives back, from what the picture shows, the light that a bound on the geometry term takes from
// near VPLs: pass "PREFIX.compensate".
//
//     E(x) = sum_j V Phi_j min(G(x, y_j), b)  +  integral of V B(y) max(0, G(x, y) - b) dA_y
//            the gather's, AG_CLAMP_GEOMETRY     this pass
//
// with G = cos_i cos_j / (pi d^2) and B the radiosity. The two add up to all of the light, whatever
// b is: the first part is smooth where VPLs are near, and only surfaces within 1 / sqrt(pi b) of x
// have a part in the second. That matches AG_CLAMP_GEOMETRY with clamp_g = b. A clamp of each VPL's
// irradiance is one of its geometry term by clamp_e / Phi_j: it matches as far as the VPLs near x
// have one flux, b = clamp_e / Phi.
//
// The integral is over the pixels that the camera sees, of the light that they reflect: what is
// hidden or outside of the picture gives nothing back. Between x and y nothing is taken to stand.
// Light that moving surfaces reflect is given back too, though they make no VPLs.
//
// Each pixel takes the eight about it and `samples` farther out, in rings whose radii grow
// geometrically. The pattern repeats every n x n pixels; the box filter of as many takes its noise.
//
// Shapes: in, out RGBA32F of the frame's size.
// Units:  E / pi, W/(m^2 sr).
// Source: Novak, Engelhardt, Dachsbacher. Screen-Space Bias Compensation for Interactive
//         High-Quality Global Illumination with Virtual Point Lights. I3D 2011.
//         Departs from it: rings and an interleaved pattern instead of a hierarchy; a pixel counts
//         as a disc of half the area that it shows, so that neighbours stay finite.
typedef struct ag_compensate_pass {
    ag_scene_res scene;
    ag_gbuffer gbuffer;
    fg_res direct, in, out;
    float bound;
    int frame[2];
    int tiles, samples;
} ag_compensate_pass;

typedef struct ag_compensate_desc {
    const char *prefix;
    fg_res in;         // of the gather, E / pi
    fg_res direct;     // RGBA32F: radiance of direct light and emission, W/(m^2 sr)
    float bound;       // b, 1/m^2, > 0
    int tiles;         // n, [1, AG_MAX_TILES]
    int samples;       // [1, 256]; 0: 32
    int width, height; // of the frame
} ag_compensate_desc;

FG_API void ag_compensate_declare(ag_compensate_pass *pass, fg_graph *g, const ag_scene_res *scene,
                                  const ag_gbuffer *gbuffer, const ag_compensate_desc *desc);

FG_END

#endif // PASS_COMPENSATE_H
