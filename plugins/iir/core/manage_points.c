// SPDX-License-Identifier: MIT
#include "manage_priv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Circles are compared with this much to spare.
static const double rounding = 1e-9;

void iir_point_free(iir_manager *m, int id)
{
    m->lights[m->points[id].light].count--;
    m->points[id].light = -1;
    m->count--;
    if (id < m->first_free)
        m->first_free = id;
}

static point *point_at(iir_manager *m, const light_state *l, int local)
{
    return &m->points[l->points[local]];
}

// ---- the domain -------------------------------------------------------------------------------

static fg_status make_domain(iir_manager *m, light_state *l)
{
    const int least = l->count > l->share ? l->count : l->share;
    const iir_space space = l->emitter.space;
    if (l->domain && l->space == space && l->capacity >= least)
        return FG_OK;
    int capacity = 16;
    while (capacity < least)
        capacity *= 2;
    iir_domain_destroy(l->domain);
    free(l->points);
    const iir_domain_desc desc = { .space = space,
                                   .triangulation = m->triangulation,
                                   .capacity = capacity < m->capacity ? capacity : m->capacity };
    l->domain = iir_domain_create(&desc);
    l->points = malloc((size_t) desc.capacity * sizeof *l->points);
    l->capacity = desc.capacity;
    l->space = space;
    return l->domain && l->points ? FG_OK : FG_ERR_MEMORY;
}

fg_status iir_points_place(iir_manager *m, int light)
{
    light_state *l = &m->lights[light];
    if (make_domain(m, l) != FG_OK)
        return FG_ERR_MEMORY;
    for (int i = 0; i < l->capacity; i++)
        l->points[i] = -1;
    const int *ids = m->order + m->first[light];
    for (int i = 0; i < l->count; i++) {
        point *p = &m->points[ids[i]];
        p->local = i;
        l->points[i] = ids[i];
        m->ids[i] = i;
        memcpy(m->at[i], p->at, sizeof m->at[i]);
    }
    l->first_free = l->count;
    l->dirty = true;
    l->rested = false;
    l->least = HUGE_VAL;
    l->tries = 0;
    return iir_domain_set(l->domain, (const double(*)[3]) m->at, m->ids, l->count);
}

// ---- deletion ---------------------------------------------------------------------------------

static void forget(iir_manager *m, light_state *l, int local)
{
    iir_point_free(m, l->points[local]);
    l->points[local] = -1;
    if (local < l->first_free)
        l->first_free = local;
    l->dirty = true;
    l->rested = false;
    m->result.deleted++;
}

// The one to take away; where there is one alone the rule names none.
static int redundant(const light_state *l)
{
    const int local = iir_domain_redundant(l->domain);
    for (int i = 0; local < 0 && i < l->capacity; i++)
        if (l->points[i] >= 0)
            return i;
    return local;
}

// Whether taking `p` away has opened what is now the largest empty circle, and no smaller than the
// one before: the next point would go there again.
static bool reopens(const light_state *l, const point *p, double radius)
{
    double centre[3], away = 0;
    const double now = iir_domain_largest_empty_circle(l->domain, centre);
    for (int k = 0; k < 3; k++)
        away += (centre[k] - p->at[k]) * (centre[k] - p->at[k]);
    return sqrt(away) < now * (1 - rounding) && now >= radius * (1 - rounding);
}

// Points of equal merit might change places for ever: it is over once all have been tried and the
// largest circle is what it was.
static bool tried_all(light_state *l, double radius)
{
    if (radius < l->least * (1 - rounding)) {
        l->least = radius;
        l->tries = 0;
    }
    return l->tries > 2 * l->share + 2;
}

static fg_status free_some(iir_manager *m, light_state *l, int goal)
{
    double centre[3];
    const double radius = iir_domain_largest_empty_circle(l->domain, centre);
    l->rested = tried_all(l, radius);
    while (l->count > goal && !l->rested) {
        const int local = redundant(l);
        const point *p = point_at(m, l, local);
        iir_domain_remove(l->domain, local);
        if (reopens(l, p, radius)) {
            l->rested = true;
            return iir_domain_insert(l->domain, local, p->at);
        }
        forget(m, l, local);
        l->tries++;
    }
    return FG_OK;
}

fg_status iir_points_delete(iir_manager *m, int light, bool settle)
{
    light_state *l = &m->lights[light];
    const int goal = l->share - l->spare;
    while (l->count > (settle ? l->share : goal)) { // sec. 4.5
        const int local = redundant(l);
        iir_domain_remove(l->domain, local);
        forget(m, l, local);
    }
    const fg_status status =
        settle && l->count > goal && !l->rested ? free_some(m, l, goal) : FG_OK;
    // A removal that runs out of memory leaves nothing.
    return status == FG_OK && iir_domain_count(l->domain) != l->count ? FG_ERR_MEMORY : status;
}

// ---- creation ---------------------------------------------------------------------------------

static int take_id(iir_manager *m)
{
    while (m->points[m->first_free].light >= 0)
        m->first_free++;
    m->count++;
    return m->first_free++;
}

static int take_local(light_state *l)
{
    while (l->points[l->first_free] >= 0)
        l->first_free++;
    l->count++;
    return l->first_free++;
}

// Sec. 4.6. Rays change nothing about the circles: they are cast together in the end.
// A point on the rim is out of the cone with the next step of the light, and its circle lies half
// beyond the rim: it stands for its cell better, and for longer, from within.
static void draw_in(double at[3], double most)
{
    const double r = hypot(at[0], at[1]);
    for (int k = 0; k < 2 && r > most; k++)
        at[k] *= most / r;
}

fg_status iir_points_create(iir_manager *m, int light, double rim)
{
    light_state *l = &m->lights[light];
    fg_status status = FG_OK;
    int made = 0;
    for (; made < l->allowed && status == FG_OK; made++) {
        const int id = take_id(m), local = take_local(l);
        point *p = &m->points[id];
        *p = (point){ .light = light, .local = local, .fresh = true, .birth = m->births++ };
        const double radius = iir_domain_largest_empty_circle(l->domain, p->at);
        if (l->space == IIR_DISC)
            draw_in(p->at, 1 - rim * radius);
        l->points[local] = id;
        m->ids[made] = id;
        status = iir_domain_insert(l->domain, local, p->at);
    }
    if (made == 0 || status != FG_OK)
        return status;
    l->dirty = true;
    l->rested = false;
    m->result.created += made;
    const double start = iir_cpu_time();
    for (int i = 0; i < made; i++)
        iir_rays_hit(m, &l->emitter, &m->points[m->ids[i]]);
    m->result.ray_ms += 1e3 * (iir_cpu_time() - start);
    return FG_OK;
}

// ---- cells ------------------------------------------------------------------------------------

// Radius of the circles about as many points in a hexagonal lattice, each with a cell of its share
// of the domain: area = 3 sqrt(3) / 2 radius^2.
static double lattice_radius(const light_state *l)
{
    return sqrt(iir_space_area(l->space) / l->count / (1.5 * sqrt(3)));
}

void iir_points_measure(iir_manager *m, int light)
{
    light_state *l = &m->lights[light];
    double centre[3];
    if (!l->dirty)
        return;
    l->dirty = false;
    l->wide = 0;
    if (l->count == 0)
        return;
    iir_domain_areas(l->domain, m->areas);
    for (int i = 0; i < l->capacity; i++)
        if (l->points[i] >= 0)
            point_at(m, l, i)->cell = m->areas[i];
    l->wide = iir_domain_largest_empty_circle(l->domain, centre) / lattice_radius(l);
}
