// SPDX-License-Identifier: MIT
#include "domain_priv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- small geometry --------------------------------------------------------------------------

double domain_distance2(const double a[3], const double b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

void domain_rotate3(int *a, int *b, int *c)
{
    while (*b < *a || *c < *a) {
        const int first = *a;
        *a = *b;
        *b = *c;
        *c = first;
    }
}

bool domain_cell_holds(const iir_domain *d, int id, int size, const double place[3])
{
    const double mine = domain_distance2(place, d->points[id]);
    for (int i = 0; i < size; ++i)
        if (d->ring[i] >= 0 && domain_distance2(place, d->points[d->ring[i]]) < mine)
            return false;
    return true;
}

void domain_cell_offer(domain_cell *cell, const double place[3], double radius2)
{
    if (!(radius2 > cell->empty))
        return;
    cell->empty = radius2;
    memcpy(cell->centre, place, sizeof cell->centre);
}

// False for what cannot be brought into the domain.
static bool take_point(iir_space space, const double point[3], double out[3])
{
    double largest = 0, length2 = 0;
    for (int k = 0; k < 3; ++k) {
        out[k] = space == IIR_DISC && k == 2 ? 0 : point[k];
        if (!isfinite(out[k]))
            return false;
        largest = fmax(largest, fabs(out[k]));
    }
    if (largest == 0)
        return space == IIR_DISC;
    const double scale = largest > 2 ? largest : 1; // squares stay finite
    for (int k = 0; k < 3; ++k)
        length2 += (out[k] / scale) * (out[k] / scale);
    const double length = sqrt(length2) * scale;
    // What is right to rounding stays as it is, so that a point given back is the same.
    const double rounding = 0x1p-51;
    if (space == IIR_DISC ? length <= 1 + rounding : fabs(length - 1) <= rounding)
        return true;
    for (int k = 0; k < 3; ++k)
        out[k] /= length;
    return true;
}

// ---- life ------------------------------------------------------------------------------------

void iir_domain_destroy(iir_domain *d)
{
    if (!d)
        return;
    delaunay_destroy(d->net);
    domain_grid_destroy(&d->grid);
    domain_tree_destroy(&d->near);
    domain_tree_destroy(&d->empty);
    free(d->ring);
    free(d->points);
    free(d->twin);
    free(d->birth);
    free(d->cells);
    free(d->stale);
    free(d->rank.ids);
    free(d->area.ids);
    free(d);
}

static bool domain_allocate(iir_domain *d)
{
    const size_t n = (size_t) d->capacity;
    d->net = delaunay_create(d->kind, d->capacity);
    d->ring = malloc(4 * n * sizeof *d->ring);
    d->points = malloc(n * sizeof *d->points);
    d->twin = malloc(n * sizeof *d->twin);
    d->birth = malloc(n * sizeof *d->birth);
    d->cells = malloc(n * sizeof *d->cells);
    d->stale = malloc(n * sizeof *d->stale);
    d->rank.ids = malloc(n * sizeof *d->rank.ids);
    d->area.ids = malloc(n * sizeof *d->area.ids);
    return d->net && d->ring && d->points && d->twin && d->birth && d->cells && d->stale &&
           d->rank.ids && d->area.ids && !domain_grid_create(&d->grid, d->capacity) &&
           !domain_tree_create(&d->near, d->capacity) &&
           !domain_tree_create(&d->empty, d->capacity);
}

static bool near_before(const domain_cell *cells, int a, int b)
{
    for (int k = 0; k < 2; ++k)
        if (cells[a].near[k] != cells[b].near[k])
            return cells[a].near[k] < cells[b].near[k];
    return a > b;
}

static bool empty_before(const domain_cell *cells, int a, int b)
{
    return cells[a].empty != cells[b].empty ? cells[a].empty > cells[b].empty : a < b;
}

// Empty, the triangulation apart.
static void forget_points(iir_domain *d)
{
    d->count = d->duplicates = d->rank.count = d->area.count = 0;
    d->births = 0;
    for (int i = 0; i < d->capacity; ++i)
        d->twin[i] = DOMAIN_ABSENT;
    memset(d->stale, 0, (size_t) d->capacity);
    domain_grid_clear(&d->grid);
    domain_tree_fill(&d->near, d, near_before);
    domain_tree_fill(&d->empty, d, empty_before);
}

iir_domain *iir_domain_create(const iir_domain_desc *desc)
{
    iir_domain *d = calloc(1, sizeof *d);
    if (!d)
        return NULL;
    d->space = desc->space;
    d->capacity = desc->capacity;
    const delaunay_kind on_sphere =
        desc->triangulation == IIR_TRIANGULATION_TETRA ? DELAUNAY_TETRA : DELAUNAY_SPHERE;
    d->kind = desc->space == IIR_DISC ? DELAUNAY_PLANE : on_sphere;
    if (!domain_allocate(d)) {
        iir_domain_destroy(d);
        return NULL;
    }
    forget_points(d);
    return d;
}

// ---- what changes with a point ---------------------------------------------------------------

static void make_stale(iir_domain *d, int id)
{
    if (!(d->stale[id] & DOMAIN_STALE_RANK))
        d->rank.ids[d->rank.count++] = id;
    if (!(d->stale[id] & DOMAIN_STALE_AREA))
        d->area.ids[d->area.count++] = id;
    d->stale[id] = DOMAIN_STALE_RANK | DOMAIN_STALE_AREA;
}

static void make_ring_stale(iir_domain *d, int size)
{
    for (int i = 0; i < size; ++i)
        if (d->ring[i] >= 0)
            make_stale(d, d->ring[i]);
}

static fg_status give_up(iir_domain *d, fg_status status)
{
    d->broken = true;
    forget_points(d);
    return status;
}

// CGAL is not in order after it ran out of memory: a new triangulation.
static fg_status mend(iir_domain *d)
{
    if (!d->broken)
        return FG_OK;
    delaunay_destroy(d->net);
    d->net = delaunay_create(d->kind, d->capacity);
    d->broken = !d->net;
    return d->net ? FG_OK : FG_ERR_MEMORY;
}

// The ring of a corner into d->ring, from its smallest entry on. None, and the domain is empty,
// where memory runs out.
static int load_ring(iir_domain *d, int id)
{
    int least = 0;
    const int size = delaunay_ring(d->net, id, d->ring);
    if (size < 0) {
        (void) !give_up(d, FG_ERR_MEMORY);
        return 0;
    }
    for (int i = 1; i < size; ++i)
        if (d->ring[i] < d->ring[least])
            least = i;
    const size_t head = (size_t) least * sizeof *d->ring;
    const size_t tail = (size_t) (size - least) * sizeof *d->ring;
    memcpy(d->ring + size, d->ring, head);
    memmove(d->ring, d->ring + least, tail + head);
    return size;
}

static fg_status insert_corner(iir_domain *d, int id)
{
    // Points mostly come to the centre of the largest empty circle.
    int near = d->empty.nodes[1];
    if (near >= 0 && (near == id || d->twin[near] != DOMAIN_CORNER))
        near = -1;
    const fg_status status = delaunay_insert(d->net, id, d->points[id], near);
    if (status != FG_OK)
        return give_up(d, status);
    d->twin[id] = DOMAIN_CORNER;
    domain_grid_add(&d->grid, d->points[id], id);
    make_stale(d, id);
    make_ring_stale(d, load_ring(d, id));
    return d->broken ? FG_ERR_MEMORY : FG_OK;
}

static fg_status remove_corner(iir_domain *d, int id)
{
    make_stale(d, id);
    make_ring_stale(d, load_ring(d, id));
    if (d->broken)
        return FG_ERR_MEMORY;
    domain_grid_remove(&d->grid, d->points[id], id);
    d->twin[id] = DOMAIN_ABSENT;
    const fg_status status = delaunay_remove(d->net, id);
    return status == FG_OK ? FG_OK : give_up(d, status);
}

// A point is there, but in no triangulation yet.
static fg_status place_point(iir_domain *d, int id)
{
    d->twin[id] = domain_grid_twin(d, d->points[id]);
    if (d->twin[id] < 0)
        return insert_corner(d, id);
    ++d->duplicates;
    return FG_OK;
}

// The duplicates of a corner that is gone, the eldest first.
static fg_status place_orphans(iir_domain *d, int gone)
{
    for (;;) {
        int eldest = -1;
        for (int i = 0; i < d->capacity; ++i)
            if (d->twin[i] == gone && (eldest < 0 || d->birth[i] < d->birth[eldest]))
                eldest = i;
        if (eldest < 0)
            return FG_OK;
        --d->duplicates;
        const fg_status status = place_point(d, eldest);
        if (status != FG_OK)
            return status;
    }
}

// ---- points ----------------------------------------------------------------------------------

static bool add_point(iir_domain *d, int id, const double point[3])
{
    double at[3];
    if (id < 0 || id >= d->capacity || d->twin[id] != DOMAIN_ABSENT ||
        !take_point(d->space, point, at))
        return false;
    memcpy(d->points[id], at, sizeof at);
    d->birth[id] = d->births++;
    ++d->count;
    return true;
}

fg_status iir_domain_set(iir_domain *d, const double (*points)[3], const int *ids, int count)
{
    int corners = 0;
    forget_points(d);
    fg_status status = d->broken ? mend(d) : delaunay_clear(d->net);
    if (status != FG_OK)
        return give_up(d, status);
    int *list = d->ring; // of corners; has room for all
    for (int i = 0; i < count; ++i) {
        if (!add_point(d, ids[i], points[i])) {
            forget_points(d);
            return FG_ERR_INVALID;
        }
        d->twin[ids[i]] = domain_grid_twin(d, d->points[ids[i]]);
        if (d->twin[ids[i]] >= 0) {
            ++d->duplicates;
            continue;
        }
        d->twin[ids[i]] = DOMAIN_CORNER;
        domain_grid_add(&d->grid, d->points[ids[i]], ids[i]);
        make_stale(d, ids[i]);
        list[corners++] = ids[i];
    }
    status = delaunay_insert_all(d->net, (const double(*)[3]) d->points, list, corners);
    return status == FG_OK ? FG_OK : give_up(d, status);
}

fg_status iir_domain_insert(iir_domain *d, int id, const double point[3])
{
    const fg_status status = mend(d);
    if (status != FG_OK)
        return status;
    return add_point(d, id, point) ? place_point(d, id) : FG_ERR_INVALID;
}

void iir_domain_remove(iir_domain *d, int id)
{
    if (!iir_domain_has(d, id))
        return;
    --d->count;
    if (d->twin[id] >= 0) {
        --d->duplicates;
        d->twin[id] = DOMAIN_ABSENT;
        return;
    }
    if (remove_corner(d, id) == FG_OK && d->duplicates > 0)
        (void) !place_orphans(d, id); // which leaves the domain empty if it fails
}

int iir_domain_count(const iir_domain *d)
{
    return d->count;
}

bool iir_domain_has(const iir_domain *d, int id)
{
    return id >= 0 && id < d->capacity && d->twin[id] != DOMAIN_ABSENT;
}

void iir_domain_point(const iir_domain *d, int id, double out[3])
{
    memcpy(out, d->points[id], sizeof d->points[id]);
}

int iir_domain_duplicate_of(const iir_domain *d, int id)
{
    return iir_domain_has(d, id) && d->twin[id] >= 0 ? d->twin[id] : -1;
}

// ---- questions -------------------------------------------------------------------------------

static void find_near(const iir_domain *d, int id, int size, double near[2])
{
    near[0] = near[1] = HUGE_VAL;
    for (int i = 0; i < size; ++i) {
        if (d->ring[i] < 0)
            continue;
        const double distance = domain_distance2(d->points[id], d->points[d->ring[i]]);
        if (distance < near[0]) {
            near[1] = near[0];
            near[0] = distance;
        } else if (distance < near[1]) {
            near[1] = distance;
        }
    }
}

static void refresh_cell(iir_domain *d, int id, int wanted)
{
    wanted &= d->stale[id];
    d->stale[id] &= (uint8_t) ~wanted;
    if (!wanted || d->twin[id] != DOMAIN_CORNER)
        return;
    domain_cell *cell = &d->cells[id];
    const int size = load_ring(d, id);
    if (d->broken)
        return;
    if (wanted & DOMAIN_STALE_RANK) {
        find_near(d, id, size, cell->near);
        cell->empty = -1;
    }
    if (wanted & DOMAIN_STALE_AREA)
        cell->area = 0;
    if (d->space == IIR_DISC)
        domain_disc_fill(d, id, size, wanted, cell);
    else
        domain_sphere_fill(d, id, size, wanted, cell);
}

// Of many: their areas at the same time, for less than one after the other.
static void refresh_all(iir_domain *d)
{
    int kept = 0;
    for (int i = 0; i < d->rank.count; ++i)
        refresh_cell(d, d->rank.ids[i], DOMAIN_STALE_RANK | DOMAIN_STALE_AREA);
    for (int i = 0; i < d->area.count; ++i)
        if (d->stale[d->area.ids[i]] & DOMAIN_STALE_AREA)
            d->area.ids[kept++] = d->area.ids[i];
    d->area.count = kept;
    domain_tree_fill(&d->near, d, near_before);
    domain_tree_fill(&d->empty, d, empty_before);
}

static void refresh_ranks(iir_domain *d)
{
    const bool many = d->rank.count > 16 && d->rank.count > d->count / 4;
    if (many)
        refresh_all(d);
    for (int i = 0; i < d->rank.count && !many; ++i) {
        const int id = d->rank.ids[i];
        refresh_cell(d, id, DOMAIN_STALE_RANK);
        domain_tree_update(&d->near, d, near_before, id);
        domain_tree_update(&d->empty, d, empty_before, id);
    }
    d->rank.count = 0;
}

// Sec. 4.5. Both ends of the shortest edge are each other's closest neighbour, so the point wanted
// is the first by distance to the closest, then to the second closest neighbour.
int iir_domain_redundant(iir_domain *d)
{
    if (d->count < 2)
        return -1;
    for (int id = d->capacity - 1; id >= 0 && d->duplicates > 0; --id)
        if (d->twin[id] >= 0)
            return id;
    refresh_ranks(d);
    return d->near.nodes[1];
}

double iir_domain_largest_empty_circle(iir_domain *d, double centre[3])
{
    refresh_ranks(d);
    const int id = d->empty.nodes[1];
    if (id < 0) {
        memcpy(centre, (double[]){ 0, 0, d->space == IIR_SPHERE }, 3 * sizeof *centre);
        return d->space == IIR_SPHERE ? 2 : 1;
    }
    memcpy(centre, d->cells[id].centre, 3 * sizeof *centre);
    return sqrt(d->cells[id].empty);
}

void iir_domain_areas(iir_domain *d, double *areas)
{
    for (int i = 0; i < d->area.count; ++i)
        refresh_cell(d, d->area.ids[i], DOMAIN_STALE_AREA);
    d->area.count = 0;
    for (int id = 0; id < d->capacity; ++id)
        areas[id] = d->twin[id] == DOMAIN_CORNER ? d->cells[id].area : 0;
}

double iir_domain_least_distance(iir_domain *d)
{
    refresh_ranks(d);
    const int id = d->near.nodes[1];
    return id < 0 ? (double) INFINITY : sqrt(d->cells[id].near[0]);
}
