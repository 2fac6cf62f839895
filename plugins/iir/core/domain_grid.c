// SPDX-License-Identifier: MIT
#include "domain_priv.h"

#include <math.h>
#include <stdlib.h>

// Wide enough that a point and all it could be a duplicate of mostly share a square.
static const double grid_width = 4 * IIR_DUPLICATE;

fg_status domain_grid_create(domain_grid *g, int capacity)
{
    uint32_t size = 1;
    while (size < 2 * (uint32_t) capacity)
        size *= 2;
    g->mask = size - 1;
    g->heads = malloc(size * sizeof *g->heads);
    g->next = malloc((size_t) capacity * sizeof *g->next);
    if (!g->heads || !g->next)
        return FG_ERR_MEMORY;
    domain_grid_clear(g);
    return FG_OK;
}

void domain_grid_destroy(domain_grid *g)
{
    free(g->heads);
    free(g->next);
}

void domain_grid_clear(domain_grid *g)
{
    for (uint32_t i = 0; i <= g->mask; ++i)
        g->heads[i] = -1;
}

static int grid_coordinate(double x)
{
    return (int) floor(x / grid_width + 0.5); // |x| <= 1: within 2^19
}

static int *grid_head(const domain_grid *g, const int at[3])
{
    uint32_t hash = 0;
    for (int k = 0; k < 3; ++k) {
        hash = (hash ^ (uint32_t) at[k]) * 0x9e3779b1u;
        hash ^= hash >> 15;
    }
    return &g->heads[hash & g->mask];
}

static int *grid_head_of(const domain_grid *g, const double point[3])
{
    int at[3];
    for (int k = 0; k < 3; ++k)
        at[k] = grid_coordinate(point[k]);
    return grid_head(g, at);
}

void domain_grid_add(domain_grid *g, const double point[3], int id)
{
    int *head = grid_head_of(g, point);
    g->next[id] = *head;
    *head = id;
}

void domain_grid_remove(domain_grid *g, const double point[3], int id)
{
    int *link = grid_head_of(g, point);
    while (*link != id)
        link = &g->next[*link];
    *link = g->next[id];
}

static int elder_twin(const iir_domain *d, const double point[3], const int at[3], int best)
{
    for (int i = *grid_head(&d->grid, at); i >= 0; i = d->grid.next[i])
        if (domain_distance2(d->points[i], point) < IIR_DUPLICATE * IIR_DUPLICATE &&
            (best < 0 || d->birth[i] < d->birth[best]))
            best = i;
    return best;
}

int domain_grid_twin(const iir_domain *d, const double point[3])
{
    int low[3], high[3], at[3], best = -1;
    for (int k = 0; k < 3; ++k) {
        low[k] = grid_coordinate(point[k] - IIR_DUPLICATE);
        high[k] = grid_coordinate(point[k] + IIR_DUPLICATE);
    }
    for (at[0] = low[0]; at[0] <= high[0]; ++at[0])
        for (at[1] = low[1]; at[1] <= high[1]; ++at[1])
            for (at[2] = low[2]; at[2] <= high[2]; ++at[2])
                best = elder_twin(d, point, at, best);
    return best;
}
