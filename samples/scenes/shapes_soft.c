// SPDX-License-Identifier: MIT
#include "shapes.h"

#include <assert.h>
#include <math.h>

static const float pi = 3.14159265f;

// A ring of the rounded box at the angle `up` from the middle's plane, around +Y. Of each quarter
// the corner's sphere stays where it is, so that between quarters there is a flat.
static void round_ring(shape *s, const float inner[2][3], float radius, const float up[2],
                       int segments)
{
    const float y = inner[up[1] > 0.5f][1] + radius * sinf(up[0]);
    const float sides[2] = { inner[1][0] - inner[0][0], inner[1][2] - inner[0][2] };
    float along = 0.0f;
    for (int i = 0; i <= 4 * (segments + 1); ++i) {
        const int quarter = i / (segments + 1) % 4, step = i % (segments + 1);
        const float angle = 0.5f * pi * ((float) quarter + (float) step / (float) segments);
        const float normal[3] = { cosf(up[0]) * cosf(angle), sinf(up[0]),
                                  cosf(up[0]) * sinf(angle) };
        const bool right = quarter == 0 || quarter == 3, back = quarter < 2;
        const float p[3] = { inner[right][0] + radius * normal[0], y,
                             inner[back][2] + radius * normal[2] };
        if (i > 0)
            along += step ? 0.5f * pi * radius / (float) segments : sides[quarter % 2 == 0];
        shape_vertex(s, p, normal, along, -(y + radius * up[0]));
    }
}

void shape_round_box(shape *s, const float lo[3], const float hi[3], float radius, int segments)
{
    float inner[2][3];
    const uint32_t first = (uint32_t) s->vertex_count;
    assert(segments >= 1);
    for (int i = 0; i < 3; ++i) {
        radius = fminf(radius, 0.5f * (hi[i] - lo[i]));
        inner[0][i] = lo[i] + radius;
        inner[1][i] = hi[i] - radius;
    }
    for (int half = 0; half < 2; ++half)
        for (int i = 0; i <= segments; ++i) {
            const float turn = 0.5f * pi * ((float) i / (float) segments - (half ? 0.0f : 1.0f));
            round_ring(s, (const float(*)[3]) inner, radius, (float[2]){ turn, (float) half },
                       segments);
        }
    if (s->failed)
        return;
    shape_lattice(s, first, 4 * (segments + 1), 2 * segments + 1);
    for (int top = 0; top < 2; ++top) {
        const float y = top ? hi[1] : lo[1];
        const float x0 = inner[0][0], x1 = inner[1][0], z0 = inner[0][2], z1 = inner[1][2];
        const float corners[4][3] = { { x0, y, top ? z1 : z0 },
                                      { x1, y, top ? z1 : z0 },
                                      { x1, y, top ? z0 : z1 },
                                      { x0, y, top ? z0 : z1 } };
        shape_quad(s, (const float(*)[3]) corners);
    }
}

void shape_paint(shape *s, size_t first_vertex, const float rgb[3])
{
    for (size_t i = first_vertex; i < s->vertex_count; ++i)
        for (int k = 0; k < 3; ++k)
            s->vertices[i].color[k] = rgb[k];
}
