// SPDX-License-Identifier: MIT
#include "iir_points.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

double points_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double) (*state >> 11) * 0x1p-53;
}

static void spherical(double azimuth, double z, double out[3])
{
    const double radius = sqrt(fmax(0, 1 - z * z));
    out[0] = radius * cos(azimuth);
    out[1] = radius * sin(azimuth);
    out[2] = z;
}

void points_random_place(uint64_t *state, iir_space space, double out[3])
{
    const double azimuth = 2 * M_PI * points_random(state), share = points_random(state);
    if (space == IIR_SPHERE) {
        spherical(azimuth, 2 * share - 1, out);
        return;
    }
    out[0] = sqrt(share) * cos(azimuth);
    out[1] = sqrt(share) * sin(azimuth);
    out[2] = 0;
}

// About a place, within `width`.
static void scatter(uint64_t *state, iir_space space, const double about[3], double width,
                    double out[3])
{
    double length = 0;
    for (int k = 0; k < 3; ++k) {
        out[k] = about[k] + width * (points_random(state) - 0.5);
        if (space == IIR_DISC && k == 2)
            out[k] = 0;
        length += out[k] * out[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3 && (space == IIR_SPHERE || length > 1); ++k)
        out[k] /= length;
}

static void on_line(uint64_t *state, iir_space space, double off, double out[3])
{
    const double share = points_random(state);
    if (space == IIR_SPHERE) {
        spherical(2 * M_PI * share, off, out);
        return;
    }
    out[0] = sqrt(1 - off * off) * (2 * share - 1);
    out[1] = off;
    out[2] = 0;
}

static void on_circle(iir_space space, double share, double radius, double out[3])
{
    spherical(2 * M_PI * share, space == IIR_SPHERE ? sqrt(1 - radius * radius) : 0, out);
    for (int k = 0; k < 2 && space == IIR_DISC; ++k)
        out[k] *= radius;
}

static void on_lattice(iir_space space, int i, int count, double out[3])
{
    const int side = (int) ceil(sqrt((double) count));
    const int column = i % side, row = i / side;
    const double u = (column + 0.5) / side, v = (row + 0.5) / side;
    if (space == IIR_SPHERE) {
        spherical(2 * M_PI * u, 2 * v - 1, out);
        return;
    }
    out[0] = (2 * u - 1) * M_SQRT1_2;
    out[1] = (2 * v - 1) * M_SQRT1_2;
    out[2] = 0;
}

static void one_point(points_kind kind, iir_space space, uint64_t *state, int i, int count,
                      double out[3])
{
    static const double here[] = { 0.36, -0.48, 0.8 }, there[] = { -0.36, 0.48, -0.8 };
    static const double along[] = { 1e-9, 1.01 * IIR_DUPLICATE, 0 };
    switch (kind) {
    case POINTS_CLUSTER: scatter(state, space, here, 1e-3, out); break;
    case POINTS_TIGHT: scatter(state, space, here, 6 * IIR_DUPLICATE, out); break;
    case POINTS_TWO_CLUSTERS: scatter(state, space, i % 2 ? here : there, 1e-4, out); break;
    case POINTS_LATTICE: on_lattice(space, i, count, out); break;
    case POINTS_LINE: on_line(state, space, 0, out); break;
    case POINTS_CHORD: on_line(state, space, 0.625, out); break;
    case POINTS_LINE_AND_ONE: on_line(state, space, i == count / 2 ? 0.5 : 0, out); break;
    case POINTS_CIRCLE: on_circle(space, (double) i / count, 0.6, out); break;
    case POINTS_RIM: on_circle(space, points_random(state), 1, out); break;
    case POINTS_RIM_AND_INSIDE:
        points_random_place(state, space, out);
        out[2] = fabs(out[2]);
        if (i % 2)
            on_circle(space, points_random(state), 1, out);
        break;
    case POINTS_CHAIN:
        for (int k = 0; k < 3; ++k)
            out[k] = here[k] + i * along[k];
        break;
    case POINTS_SAME: memcpy(out, here, 3 * sizeof *out); break;
    default: points_random_place(state, space, out); break;
    }
}

void points_make(points_kind kind, iir_space space, uint64_t *state, int count, double (*out)[3])
{
    for (int i = 0; i < count; ++i) {
        one_point(kind, space, state, i, count, out[i]);
        for (int k = 0; k < 3 && i % 2 && kind == POINTS_ANTIPODAL; ++k)
            out[i][k] = -out[i - 1][k];
        if (i % 2 && kind == POINTS_TWINS)
            scatter(state, space, out[i - 1], 1e-12, out[i]);
    }
}

const points_back points_backs[POINTS_BACKS] = {
    { IIR_DISC, IIR_TRIANGULATION_DEFAULT, "disc" },
    { IIR_SPHERE, IIR_TRIANGULATION_DEFAULT, "sphere" },
    { IIR_SPHERE, IIR_TRIANGULATION_TETRA, "tetra" },
};

iir_domain *points_domain(const points_back *back, int capacity)
{
    const iir_domain_desc desc = { .space = back->space,
                                   .triangulation = back->triangulation,
                                   .capacity = capacity };
    iir_domain *d = iir_domain_create(&desc);
    assert_non_null(d);
    return d;
}

void points_set(iir_domain *d, double (*points)[3], int count)
{
    static int ids[POINTS_MAX];
    for (int i = 0; i < count; ++i)
        ids[i] = i;
    assert_int_equal(iir_domain_set(d, (const double(*)[3]) points, ids, count), FG_OK);
}

int points_free_id(const iir_domain *d)
{
    int id = 0;
    while (iir_domain_has(d, id))
        ++id;
    return id;
}
