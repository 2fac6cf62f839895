// SPDX-License-Identifier: MIT
#include "manage_priv.h"

#include <math.h>
#include <pass/math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double iir_cpu_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

// ---- making -----------------------------------------------------------------------------------

static void widen(double box_min[3], double box_max[3], const double p[3])
{
    for (int k = 0; k < 3; k++) {
        box_min[k] = fmin(box_min[k], p[k]);
        box_max[k] = fmax(box_max[k], p[k]);
    }
}

static void corner_of(const ag_primitive *primitive, int corner, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = (double) (corner >> k & 1 ? primitive->box_max : primitive->box_min)[k];
}

// Of what does not move: the disc of a directional light is to stay where it is while things move.
static void static_box(const ag_scene *scene, double box_min[3], double box_max[3])
{
    for (int k = 0; k < 3; k++) {
        box_min[k] = (double) INFINITY;
        box_max[k] = -(double) INFINITY;
    }
    for (int i = 0; i < scene->instance_count; i++) {
        const ag_instance *instance = &scene->instances[i];
        const ag_primitive *primitive = &scene->primitives[instance->primitive];
        if (instance->moving || primitive->index_count == 0)
            continue;
        for (int corner = 0; corner < 8; corner++) {
            double p[3];
            corner_of(primitive, corner, p);
            ag_mat_point(instance->world, p, p);
            widen(box_min, box_max, p);
        }
    }
}

static bool allocate(iir_manager *m)
{
    const size_t n = (size_t) m->capacity;
    m->points = calloc(n, sizeof *m->points);
    m->order = calloc(n, sizeof *m->order);
    m->at = calloc(n, sizeof *m->at);
    m->ids = calloc(n, sizeof *m->ids);
    m->areas = calloc(n, sizeof *m->areas);
    m->probes = calloc(n, sizeof *m->probes);
    m->probed = calloc(n, sizeof *m->probed);
    m->blocked = calloc(n, sizeof *m->blocked);
    m->sorted = calloc(n, sizeof *m->sorted);
    for (int i = 0; i < 2; i++)
        m->vpls[i] = calloc(n, sizeof *m->vpls[i]);
    for (int i = 0; i < 2; i++)
        m->shown[i] = calloc(n, sizeof *m->shown[i]);
    return m->points && m->order && m->at && m->ids && m->areas && m->probes && m->probed &&
           m->blocked && m->sorted && m->vpls[0] && m->vpls[1] && m->shown[0] && m->shown[1];
}

static fg_status make_rays(iir_manager *m)
{
    static_box(m->scene, m->box_min, m->box_max);
    ag_rays_desc desc = { .log = m->log, .scene = m->scene, .static_only = true, .threads = 1 };
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * (m->box_min[k] + m->box_max[k]);
        desc.origin[k] = m->origin[k] = isfinite(middle) ? middle : 0;
    }
    return ag_rays_create(&desc, &m->rays);
}

fg_status iir_manager_create(const iir_manager_desc *desc, iir_manager **out)
{
    *out = NULL;
    const bool sized = desc->max_lights > 0 && desc->max_lights <= IIR_MAX_VPLS;
    if (!desc->scene || !sized) {
        fg_logf(desc->log, FG_LOG_ERROR, "iir: max_lights is %d, must be in [1, %d]%s",
                desc->max_lights, IIR_MAX_VPLS, desc->scene ? "" : "; there is no scene");
        return FG_ERR_INVALID;
    }
    iir_manager *m = calloc(1, sizeof *m);
    if (!m) {
        fg_logf(desc->log, FG_LOG_ERROR, "iir: out of memory");
        return FG_ERR_MEMORY;
    }
    m->log = desc->log;
    m->scene = desc->scene;
    m->capacity = desc->max_lights;
    m->triangulation = desc->triangulation;
    fg_status status = FG_ERR_MEMORY;
    if (allocate(m)) {
        status = ag_blur_create(m->log, m->scene, desc->blur, &m->blur);
        status = status == FG_OK ? make_rays(m) : status;
    } else {
        fg_logf(m->log, FG_LOG_ERROR, "iir: out of memory for %d VPLs", m->capacity);
    }
    if (status != FG_OK) {
        iir_manager_destroy(m);
        return status;
    }
    iir_manager_clear(m);
    *out = m;
    return FG_OK;
}

void iir_manager_destroy(iir_manager *m)
{
    if (!m)
        return;
    iir_manager_clear(m);
    ag_rays_destroy(m->rays);
    ag_blur_destroy(m->blur);
    void *const blocks[] = {
        m->points, m->order,   m->at,     m->ids,      m->areas,    m->probes,
        m->probed, m->blocked, m->sorted, m->vpls[0],  m->vpls[1],  m->lights,
        m->shares, m->ranks,   m->first,  m->shown[0], m->shown[1],
    };
    for (int i = 0; i < FG_COUNT(blocks); i++)
        free(blocks[i]);
    free(m);
}

void iir_manager_clear(iir_manager *m)
{
    for (int i = 0; i < m->light_capacity; i++) {
        iir_domain_destroy(m->lights[i].domain);
        free(m->lights[i].points);
        m->lights[i] = (light_state){ 0 };
    }
    for (int i = 0; m->points && i < m->capacity; i++)
        m->points[i].light = -1;
    m->first_free = m->count = 0;
}

void iir_manager_unseen(iir_manager *m)
{
    m->unseen = true;
}

// ---- lights -----------------------------------------------------------------------------------

static bool room_for_lights(iir_manager *m, int count)
{
    if (count <= m->light_capacity && m->first)
        return true;
    size_t capacity = 4; // without any light, too
    while (capacity < (size_t) count)
        capacity *= 2;
    light_state *lights = realloc(m->lights, capacity * sizeof *lights);
    m->lights = lights ? lights : m->lights;
    share *shares = realloc(m->shares, capacity * sizeof *shares);
    m->shares = shares ? shares : m->shares;
    sort_entry *ranks = realloc(m->ranks, capacity * sizeof *ranks);
    m->ranks = ranks ? ranks : m->ranks;
    int *first = realloc(m->first, (capacity + 1) * sizeof *first);
    m->first = first ? first : m->first;
    if (!lights || !shares || !ranks || !first)
        return false;
    const size_t old = (size_t) m->light_capacity;
    memset(m->lights + old, 0, (capacity - old) * sizeof *m->lights);
    m->light_capacity = (int) capacity;
    return true;
}

static void follow_light(iir_manager *m, light_state *l, const ag_light *light)
{
    iir_emitter e = { 0 };
    const bool lit = light && iir_emitter_from_light(light, m->box_min, m->box_max, &e);
    iir_emitter before = l->emitter; // but for the power
    memcpy(before.power, e.power, sizeof before.power);
    l->moved = lit && (!l->lit || !iir_emitter_equal(&before, &e));
    l->turned = (before.kind == AG_LIGHT_DIRECTIONAL) != (e.kind == AG_LIGHT_DIRECTIONAL);
    l->lit = lit;
    l->wide = lit ? l->wide : 0;
    l->emitter = e;
}

static double weight_of(const light_state *l)
{
    const double *p = l->emitter.power;
    return l->lit ? fmax((p[0] + p[1] + p[2]) / 3, 0) : 0;
}

static void follow_lights(iir_manager *m, const iir_lights *lights)
{
    m->light_count = lights->count;
    for (int i = 0; i < m->light_capacity; i++)
        follow_light(m, &m->lights[i], i < lights->count ? &lights->lights[i] : NULL);
    for (int i = 0; i < lights->count; i++)
        m->result.power += weight_of(&m->lights[i]);
}

static void forget_all(iir_manager *m)
{
    for (int i = 0; i < m->capacity; i++)
        if (m->points[i].light >= 0) {
            iir_point_free(m, i);
            m->result.deleted++;
        }
}

static void forget_unlit(iir_manager *m)
{
    for (int i = 0; i < m->capacity; i++)
        if (m->points[i].light >= 0 && !m->lights[m->points[i].light].lit) {
            iir_point_free(m, i);
            m->result.invalid++;
        }
}

// m->order, m->first: points by light.
static void group(iir_manager *m)
{
    int next = 0;
    for (int i = 0; i < m->light_count; i++) {
        m->first[i] = next;
        m->shares[i].part = next;
        next += m->lights[i].count;
    }
    m->first[m->light_count] = next;
    for (int i = 0; i < m->capacity; i++)
        if (m->points[i].light >= 0)
            m->order[m->shares[m->points[i].light].part++] = i;
}

// ---- shares -----------------------------------------------------------------------------------

static int least(int a, int b)
{
    return a < b ? a : b;
}

static void share_points(iir_manager *m, const iir_budget *budget)
{
    for (int i = 0; i < m->light_count; i++) {
        const light_state *l = &m->lights[i];
        m->shares[i] = (share){ .weight = weight_of(l),
                                .low = l->lit,
                                .high = l->lit ? budget->max_lights : 0 };
    }
    iir_share(m->shares, m->light_count, budget->max_lights, m->ranks);
    for (int i = 0; i < m->light_count; i++) {
        light_state *l = &m->lights[i];
        share *s = &m->shares[i];
        if (l->share != s->part) {
            l->least = HUGE_VAL;
            l->tries = 0;
            l->rested = false;
        }
        l->share = s->part;
        *s = (share){ .weight = s->weight, .high = l->share, .carry = &l->carry[0] };
    }
    iir_share(m->shares, m->light_count, least(budget->recalc_min, budget->recalc_max), m->ranks);
    for (int i = 0; i < m->light_count; i++)
        m->lights[i].spare = m->shares[i].part;
}

static void share_creation(iir_manager *m, int total)
{
    for (int i = 0; i < m->light_count; i++) {
        light_state *l = &m->lights[i];
        // A light without any point comes first: its power would be nowhere.
        m->shares[i] = (share){ .weight = weight_of(l),
                                .low = l->count == 0 && l->share > 0,
                                .high = l->share - l->count,
                                .carry = &l->carry[1] };
    }
    iir_share(m->shares, m->light_count, total, m->ranks);
    for (int i = 0; i < m->light_count; i++)
        m->lights[i].allowed = m->shares[i].part;
}

// ---- result -----------------------------------------------------------------------------------

static void fill_vpl(const iir_manager *m, int id, double scale, iir_vpl *out)
{
    const point *p = &m->points[id];
    const light_state *l = &m->lights[p->light];
    const double part = scale * p->cell / iir_space_area(l->space);
    *out = (iir_vpl){ .slot = id, .light = p->light, .birth = p->birth, .fresh = p->fresh };
    memcpy(out->position, p->place, sizeof out->position);
    memcpy(out->normal, p->normal, sizeof out->normal);
    memcpy(out->albedo, p->albedo, sizeof out->albedo);
    for (int k = 0; k < 3; k++)
        out->flux[k] = (float) ((double) p->albedo[k] * l->emitter.power[k] * part); // sec. 4.7
    iir_rays_patch(m, &l->emitter, p, out);
}

// Of every light, what its VPLs are brighter by so that they carry what has gone into the sky, into
// m->shares.
static void find_scales(iir_manager *m, bool rescale)
{
    for (int i = 0; i < m->light_count; i++)
        m->shares[i].weight = 0;
    for (int i = 0; i < m->capacity; i++) {
        const point *p = &m->points[i];
        if (p->light < 0 || !p->escaped)
            continue;
        m->shares[p->light].weight += p->cell / iir_space_area(m->lights[p->light].space);
        m->result.escaped++;
    }
    for (int i = 0; i < m->light_count; i++) {
        const double lost = m->shares[i].weight;
        const bool scaled = rescale && lost < 1 - 1e-9;
        m->result.lost += scaled ? 0 : lost * weight_of(&m->lights[i]);
        m->shares[i].weight = scaled ? 1 / (1 - lost) : 1;
    }
}

// m->order has the VPLs of the result in their order.
static void show_points(iir_manager *m)
{
    iir_point *out = m->shown[m->turn];
    int *const at = m->ids; // of each point: its VPL
    for (int i = 0; i < m->result.count; i++)
        at[m->order[i]] = i;
    m->result.points = out;
    for (int l = 0; l < m->light_count; l++) {
        const light_state *light = &m->lights[l];
        for (int i = 0; i < light->capacity; i++) {
            const int id = light->lit ? light->points[i] : -1; // a dark light's domain is stale
            if (id < 0)
                continue;
            const point *p = &m->points[id];
            iir_point *to = &out[m->result.point_count++];
            *to = (iir_point){ .space = light->space, .light = l, .fresh = p->fresh };
            to->vpl = p->escaped ? -1 : at[id];
            memcpy(to->place, p->at, sizeof to->place);
        }
    }
}

static void publish(iir_manager *m, const iir_budget *budget)
{
    iir_result *r = &m->result;
    m->turn = !m->turn;
    find_scales(m, budget->rescale);
    r->count = iir_order(m, budget->deal, budget->tiles);
    r->vpls = m->vpls[m->turn];
    for (int i = 0; i < r->count; i++) {
        iir_vpl *v = &m->vpls[m->turn][i];
        fill_vpl(m, m->order[i], m->shares[m->points[m->order[i]].light].weight, v);
        r->fresh += v->fresh;
    }
    show_points(m);
    for (int i = 0; i < m->light_count; i++)
        r->dispersion = fmax(r->dispersion, m->lights[i].wide);
    if (r->power > 0 && r->count == 0 && !m->said) {
        m->said = true;
        fg_logf(m->log, FG_LOG_WARN,
                "iir: no VPL comes of %d light(s) of %g W: %d of %d rays meet nothing",
                m->light_count, r->power, r->escaped, m->count);
    }
}

// ---- a step -----------------------------------------------------------------------------------

static bool in_range(const iir_manager *m, const char *name, int value, int low, int high)
{
    if (value >= low && value <= high)
        return true;
    fg_logf(m->log, FG_LOG_ERROR, "iir: %s is %d, must be in [%d, %d]", name, value, low, high);
    return false;
}

static bool checked(const iir_manager *m, const iir_budget *b)
{
    if (!(b->rim >= 0 && b->rim <= 1)) {
        fg_logf(m->log, FG_LOG_ERROR, "iir: rim is %g, must be in [0, 1]", b->rim);
        return false;
    }
    return in_range(m, "max_lights", b->max_lights, 1, m->capacity) &&
           in_range(m, "recalc_min", b->recalc_min, 0, IIR_MAX_VPLS) &&
           in_range(m, "recalc_max", b->recalc_max, 0, IIR_MAX_VPLS) &&
           in_range(m, "tiles", b->tiles, 1, IIR_MAX_TILES);
}

// One light at a time. `again`: the domains are to be made of the points that there are.
static fg_status change_points(iir_manager *m, const iir_budget *budget, bool again, int creations)
{
    fg_status status = FG_OK;
    for (int i = 0; i < m->light_count && status == FG_OK; i++) {
        const light_state *l = &m->lights[i];
        if (l->lit && (again || l->moved || l->share > l->capacity))
            status = iir_points_place(m, i);
        if (l->lit && status == FG_OK)
            status = iir_points_delete(m, i, budget->settle && !l->moved);
    }
    share_creation(m, creations);
    for (int i = 0; i < m->light_count && status == FG_OK; i++) {
        if (m->lights[i].allowed > 0)
            status = iir_points_create(m, i, budget->rim);
        if (m->lights[i].lit && status == FG_OK)
            iir_points_measure(m, i);
    }
    return status;
}

fg_status iir_manager_step(iir_manager *m, const iir_lights *lights, const iir_budget *budget,
                           const iir_result **out)
{
    const double start = iir_cpu_time();
    const bool anew = budget->mode == IIR_ANEW;
    const bool all = anew || (budget->fill_first && m->count == 0);
    *out = NULL;
    if (!checked(m, budget))
        return FG_ERR_INVALID;
    m->result = (iir_result){ 0 };
    fg_status status = room_for_lights(m, lights->count) ? FG_OK : FG_ERR_MEMORY;
    for (int i = 0; i < m->capacity && !m->unseen; i++)
        m->points[i].fresh = false;
    m->unseen = false;
    if (status == FG_OK) {
        if (anew)
            forget_all(m);
        follow_lights(m, lights);
        forget_unlit(m);
        iir_rays_validate(m); // sec. 4.4
        share_points(m, budget);
        group(m);
        status = change_points(m, budget, anew, all ? budget->max_lights : budget->recalc_max);
    }
    if (status != FG_OK) {
        fg_logf(m->log, FG_LOG_ERROR, "iir: out of memory for the points of %d lights",
                lights->count);
        iir_manager_clear(m);
        return status;
    }
    publish(m, budget);
    m->result.ms = 1e3 * (iir_cpu_time() - start);
    m->results[m->turn] = m->result;
    *out = &m->results[m->turn];
    return FG_OK;
}
