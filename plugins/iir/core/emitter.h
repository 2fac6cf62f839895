// SPDX-License-Identifier: MIT
#ifndef IIR_EMITTER_H
#define IIR_EMITTER_H

#include "domain.h"

#include <pass/scene.h>

FG_BEGIN

// A light as its sampling domain sees it: a map between places lit and points of the unit disc or
// sphere under which equal areas get equal power (sec. 4.1).
//
// | light          | domain | map                                                              |
// |----------------|--------|------------------------------------------------------------------|
// | point          | sphere | the direction                                                    |
// | cosine spot    | disc   | the direction's part across the axis: Nusselt's analog, fig. 3   |
// | spot           | disc   | the same with a radial stretch: radius^2 is the share of the     |
// |                |        | power within that angle; cones wider than a hemisphere too       |
// | directional    | disc   | the place across the direction, over the radius of a sphere about|
// |                |        | the scene                                                        |
//
// All in world space and double precision. A plain value: nothing to free.
typedef struct iir_emitter {
    iir_space space;
    ag_light_kind kind;
    bool cosine;
    double position[3]; // of directional lights: the centre of the disc, before the whole scene
    double axes[3][3];  // orthonormal; [2] is the way the light goes. Point lights: the world's
    double radius;      // directional: of the disc, m
    double flat, rim;   // spot: 1 - cosine where the falloff starts, and where it ends
    double ramp;        // spot: what 1 - cosine changes by from full intensity to none
    double power[3];    // all that leaves, W
} iir_emitter;

// False, and no power, where nothing leaves the light: no intensity, a cone of zero degrees, an
// empty scene's directional light. The box matters to directional lights only: the less it changes,
// the more rests, so that of what does not move serves best.
bool iir_emitter_from_light(const ag_light *light, const double box_min[3], const double box_max[3],
                            iir_emitter *out);

// Whether two are exactly the same: nothing has moved.
bool iir_emitter_equal(const iir_emitter *a, const iir_emitter *b);

// Where a place in the world lies in the domain. False outside of the cone (or of the disc's rim,
// or behind a directional light's start) and on the light itself. What is outside by no more than
// 1e-6 rad (or radii) was put there by rounding and lies on the rim.
bool iir_emitter_to_domain(const iir_emitter *e, const double place[3], double point[3]);
// The same for a direction at infinity, unit; false for directional lights.
bool iir_emitter_direction_to_domain(const iir_emitter *e, const double direction[3],
                                     double point[3]);

// The ray through a point of the domain; `direction` is unit. Inverse of the two above.
void iir_emitter_ray(const iir_emitter *e, const double point[3], double origin[3],
                     double direction[3]);

// Area across the ray, m^2, that a cell of `area` about `point` lights at `distance` from the ray's
// origin; at most what all of the light's cone has there. Divided by a surface's cosine it is the
// patch that a VPL stands for.
//
// Towards the rim of a spot the light gets faint and the section large. It stays bounded: its
// density is the mean over a ring of the disc, as wide as a round cell of that area.
double iir_emitter_section(const iir_emitter *e, const double point[3], double area,
                           double distance);

// All of the domain: pi or 4 pi.
double iir_space_area(iir_space space);

FG_END

#endif // IIR_EMITTER_H
