// SPDX-License-Identifier: MIT
#include "bench_isr_loop.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

static const float pi = 3.14159265358979f;

// ---- a near patch: passes/gather/near.glsl ---------------------------------------------------

static const float near_areas = 4.0f, flat_slope2 = 1e-6f;

typedef struct vec3 {
    float x, y, z;
} vec3;

static vec3 add(vec3 a, vec3 b, float times)
{
    return (vec3){ a.x + b.x * times, a.y + b.y * times, a.z + b.z * times };
}

static float dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec3 cross(vec3 a, vec3 b)
{
    return (vec3){ a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

// A normal half float, or 0, which is what patches hold; others become 0.
static float from_half(uint32_t h)
{
    const uint32_t exponent = h >> 10 & 31,
                   bits = (h & 0x8000) << 16 | (exponent + 112) << 23 | (h & 0x3ff) << 13;
    float value;
    memcpy(&value, &bits, sizeof value);
    return exponent ? value : 0;
}

static vec3 unpack_edge(float packed, vec3 t, vec3 b, float times)
{
    uint32_t bits;
    memcpy(&bits, &packed, sizeof bits);
    const vec3 zero = { 0, 0, 0 };
    return add(add(zero, t, from_half(bits & 0xffff) * times), b, from_half(bits >> 16) * times);
}

static float edge_integral(vec3 a, vec3 b, vec3 n)
{
    const vec3 c = cross(a, b);
    const float s = sqrtf(dot(c, c));
    return s > 0 ? atan2f(s, dot(a, b)) * dot(c, n) / s : 0;
}

static float clipped_edge(const vec3 edge[2], vec3 n, vec3 *leaving, vec3 *entering)
{
    vec3 a = edge[0], b = edge[1];
    const float height = dot(n, a), next = dot(n, b);
    if (height <= 0 && next <= 0)
        return 0;
    if (height * next < 0) {
        const vec3 cut = add(a, add(b, a, -1), height / (height - next));
        if (height < 0)
            a = *entering = cut;
        else
            b = *leaving = cut;
    }
    return edge_integral(a, b, n);
}

static float patch_share(vec3 d, vec3 n, const struct ag_vpl *v, float area, float cos_j)
{
    const vec3 m = { v->normal[0], v->normal[1], v->normal[2] };
    const float s = m.z < 0 ? -1.0f : 1.0f, a = -1 / (s + m.z), c = m.x * m.y * a;
    const vec3 t = { 1 + s * m.x * m.x * a, s * c, -s * m.x };
    const vec3 b = { c, s + m.y * m.y * a, -m.y };
    const float edge = sqrtf(area);
    const vec3 u = unpack_edge(v->normal[3], t, b, 0.5f * edge);
    const vec3 w = unpack_edge(v->flux[3], t, b, 0.5f * edge);
    vec3 leaving = { 0, 0, 0 }, entering = { 0, 0, 0 };
    d = add(d, m, -fmaxf(0.5f * edge - cos_j, 0));
    const vec3 p[5] = { add(add(d, u, -1), w, -1), add(add(d, u, 1), w, -1),
                        add(add(d, u, 1), w, 1), add(add(d, u, -1), w, 1),
                        add(add(d, u, -1), w, -1) };
    float sum = 0;
    for (int i = 0; i < 4; i++)
        sum += clipped_edge(p + i, n, &leaving, &entering);
    sum += edge_integral(leaving, entering, n);
    return fabsf(sum) / (2 * pi) / area;
}

// ---- a block of receivers --------------------------------------------------------------------

typedef struct block {
    float px[LOOP_BLOCK], py[LOOP_BLOCK], pz[LOOP_BLOCK];
    float nx[LOOP_BLOCK], ny[LOOP_BLOCK], nz[LOOP_BLOCK];
    float r[LOOP_BLOCK], g[LOOP_BLOCK], b[LOOP_BLOCK];
} block;

static void add_disc(block *k, const struct ag_vpl *v, float unit)
{
    const float qx = v->position_area[0] * unit, qy = v->position_area[1] * unit,
                qz = v->position_area[2] * unit, area = v->position_area[3] * unit * unit;
    const float mx = v->normal[0], my = v->normal[1], mz = v->normal[2];
    const float fr = v->flux[0], fg = v->flux[1], fb = v->flux[2];
    for (int i = 0; i < LOOP_BLOCK; i++) {
        const float dx = qx - k->px[i], dy = qy - k->py[i], dz = qz - k->pz[i];
        const float d2 = dx * dx + dy * dy + dz * dz;
        const float ni = k->nx[i] * dx + k->ny[i] * dy + k->nz[i] * dz;
        const float nj = -(mx * dx + my * dy + mz * dz);
        const float ci = ni > 0 ? ni : 0, cj = nj > 0 ? nj : 0;
        const float below = d2 * (pi * d2 + area);
        const float share = ci * cj / (below > 1e-36f ? below : 1e-36f);
        k->r[i] += fr * share;
        k->g[i] += fg * share;
        k->b[i] += fb * share;
    }
}

// One near pair.
static void add_near(block *k, int i, const struct ag_vpl *v, float unit)
{
    const float area = v->position_area[3] * unit * unit;
    const vec3 d = { v->position_area[0] * unit - k->px[i], v->position_area[1] * unit - k->py[i],
                     v->position_area[2] * unit - k->pz[i] };
    const vec3 n = { k->nx[i], k->ny[i], k->nz[i] };
    const float nj = -(v->normal[0] * d.x + v->normal[1] * d.y + v->normal[2] * d.z);
    const float share = patch_share(d, n, v, area, nj > 0 ? nj : 0);
    k->r[i] += v->flux[0] * share;
    k->g[i] += v->flux[1] * share;
    k->b[i] += v->flux[2] * share;
}

static void add_footprint(block *k, const struct ag_vpl *v, float unit)
{
    const float qx = v->position_area[0] * unit, qy = v->position_area[1] * unit,
                qz = v->position_area[2] * unit, area = v->position_area[3] * unit * unit;
    const float mx = v->normal[0], my = v->normal[1], mz = v->normal[2];
    const float fr = v->flux[0], fg = v->flux[1], fb = v->flux[2];
    int near[LOOP_BLOCK], any = 0;
    for (int i = 0; i < LOOP_BLOCK; i++) {
        const float dx = qx - k->px[i], dy = qy - k->py[i], dz = qz - k->pz[i];
        const float d2 = dx * dx + dy * dy + dz * dz;
        const float ni = k->nx[i] * dx + k->ny[i] * dy + k->nz[i] * dz;
        const float nj = -(mx * dx + my * dy + mz * dz);
        const float ci = ni > 0 ? ni : 0, cj = nj > 0 ? nj : 0;
        const float below = d2 * (pi * d2 + area);
        const float disc = ci * cj / (below > 1e-36f ? below : 1e-36f);
        const int is_near = (d2 < near_areas * area) & (cj * cj > flat_slope2 * d2);
        const float share = is_near ? 0 : disc;
        near[i] = is_near;
        any |= is_near;
        k->r[i] += fr * share;
        k->g[i] += fg * share;
        k->b[i] += fb * share;
    }
    for (int i = 0; any && i < LOOP_BLOCK; i++)
        if (near[i])
            add_near(k, i, v, unit);
}

static void run_block(const loop *l, int first)
{
    const size_t bytes = LOOP_BLOCK * sizeof(float);
    const float factor = l->unit * l->unit / pi;
    block k;
    memcpy(k.px, l->position[0] + first, bytes);
    memcpy(k.py, l->position[1] + first, bytes);
    memcpy(k.pz, l->position[2] + first, bytes);
    memcpy(k.nx, l->normal[0] + first, bytes);
    memcpy(k.ny, l->normal[1] + first, bytes);
    memcpy(k.nz, l->normal[2] + first, bytes);
    memset(k.r, 0, bytes);
    memset(k.g, 0, bytes);
    memset(k.b, 0, bytes);
    if (l->footprint)
        for (int j = 0; j < l->vpl_count; j++)
            add_footprint(&k, &l->vpls[j], l->unit);
    else
        for (int j = 0; j < l->vpl_count; j++)
            add_disc(&k, &l->vpls[j], l->unit);
    for (int i = 0; i < LOOP_BLOCK; i++) {
        l->sum[0][first + i] = k.r[i] * factor;
        l->sum[1][first + i] = k.g[i] * factor;
        l->sum[2][first + i] = k.b[i] * factor;
    }
}

// ---- all cores -------------------------------------------------------------------------------

typedef struct work {
    const loop *l;
    int blocks, total; // of the loop; to be done
    atomic_int next;
} work;

static void *run_blocks(void *user)
{
    work *w = user;
    for (int i; (i = atomic_fetch_add(&w->next, 1)) < w->total;)
        run_block(w->l, i % w->blocks * LOOP_BLOCK);
    return NULL;
}

void loop_run(const loop *l, int threads, int times)
{
    enum { MOST = 64 };
    pthread_t others[MOST];
    work w = { .l = l, .blocks = l->receivers / LOOP_BLOCK };
    int count = 0;
    w.total = times * w.blocks;
    while (count < MOST && count + 1 < threads &&
           !pthread_create(&others[count], NULL, run_blocks, &w))
        count++;
    run_blocks(&w);
    for (int i = 0; i < count; i++)
        pthread_join(others[i], NULL);
}
