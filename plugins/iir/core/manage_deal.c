// SPDX-License-Identifier: MIT
#include "manage_priv.h"

#include <math.h>

// ---- in place, without memory of its own ------------------------------------------------------

static bool before(const sort_entry *a, const sort_entry *b)
{
    return a->key != b->key ? a->key < b->key : a->birth < b->birth;
}

static void sift(sort_entry *heap, int at, int count)
{
    const sort_entry moved = heap[at];
    for (int child = 2 * at + 1; child < count; child = 2 * at + 1) {
        child += child + 1 < count && before(&heap[child], &heap[child + 1]);
        if (!before(&moved, &heap[child]))
            break;
        heap[at] = heap[child];
        at = child;
    }
    heap[at] = moved;
}

void iir_sort(sort_entry *entries, int count)
{
    for (int i = count / 2 - 1; i >= 0; i--)
        sift(entries, i, count);
    for (int last = count - 1; last > 0; last--) {
        const sort_entry largest = entries[0];
        entries[0] = entries[last];
        entries[last] = largest;
        sift(entries, 0, last);
    }
}

// ---- along a curve ----------------------------------------------------------------------------

enum { CURVE_BITS = 12 };

// Place of a cell on the Hilbert curve over a square of 2^CURVE_BITS cells along an edge.
static uint64_t hilbert(uint32_t x, uint32_t y)
{
    uint64_t place = 0;
    for (uint32_t side = 1u << (CURVE_BITS - 1); side > 0; side >>= 1) {
        const uint32_t right = (x & side) != 0, up = (y & side) != 0;
        place = 4 * place + ((3 * right) ^ up);
        if (up)
            continue;
        const uint32_t flip = right ? ~0u : 0, other = x ^ flip;
        x = y ^ flip;
        y = other;
    }
    return place;
}

static uint32_t cell_of(double v) // in [-1, 1]
{
    const double cells = 1 << CURVE_BITS;
    return (uint32_t) fmin(fmax((0.5 + 0.5 * v) * cells, 0), cells - 1);
}

static uint64_t curve_place(iir_space space, const double at[3])
{
    if (space == IIR_DISC)
        return hilbert(cell_of(at[0]), cell_of(at[1]));
    // The sphere's octahedron, unfolded into the square.
    const double sum = fabs(at[0]) + fabs(at[1]) + fabs(at[2]);
    const double u = sum > 0 ? at[0] / sum : 0, v = sum > 0 ? at[1] / sum : 0;
    if (at[2] >= 0)
        return hilbert(cell_of(u), cell_of(v));
    return hilbert(cell_of(copysign(1 - fabs(v), u)), cell_of(copysign(1 - fabs(u), v)));
}

// ---- to the tiles -----------------------------------------------------------------------------

// Which tile each of n x n VPLs in succession goes to. Part of the pattern, as the filter sees it
// beside an edge, is to hold VPLs from all along the curve: the tiles are taken in the order of a
// dither mask, of which any window has values from all of [0, 1) (Roberts. The Unreasonable
// Effectiveness of Quasirandom Sequences. 2018: frac(x / g + y / g^2), g^3 = g + 1).
static void tile_order(int n, int *order)
{
    sort_entry tiles[64];
    for (int t = 0; t < n * n; t++) {
        const int x = t % n, y = t / n;
        const double mask = 0.7548776662466927 * x + 0.5698402909980532 * y;
        tiles[t] = (sort_entry){ .key = (uint64_t) ((mask - floor(mask)) * 0x1p52),
                                 .birth = (uint64_t) t,
                                 .point = t };
    }
    iir_sort(tiles, n * n);
    for (int i = 0; i < n * n; i++)
        order[i] = tiles[i].point;
}

// Round robin: tile t of T gets count / T of them, and one more where t < count % T.
static void deal(const sort_entry *from, int count, int tiles, const int *order, int *to)
{
    const int all = tiles * tiles, rounds = count / all, rest = count % all;
    int next = rounds * all;
    for (int i = 0; i < all; i++) {
        const int t = order[i];
        const int start = t * rounds + (t < rest ? t : rest);
        for (int k = 0; k < rounds; k++)
            to[start + k] = from[k * all + i].point;
        if (t < rest)
            to[start + rounds] = from[next++].point;
    }
}

int iir_order(iir_manager *m, iir_deal rule, int tiles)
{
    int count = 0, order[64];
    for (int i = 0; i < m->capacity; i++) {
        const point *p = &m->points[i];
        if (p->light < 0 || p->escaped)
            continue;
        const uint64_t place = curve_place(m->lights[p->light].emitter.space, p->at);
        m->sorted[count++] =
            (sort_entry){ .key = rule == IIR_DEAL_CURVE ? (uint64_t) p->light << 32 | place : 0,
                          .birth = p->birth,
                          .point = i };
    }
    iir_sort(m->sorted, count);
    tile_order(tiles, order);
    for (int i = 0; rule == IIR_DEAL_CREATION && i < tiles * tiles; i++)
        order[i] = i;
    deal(m->sorted, count, tiles, order, m->order);
    return count;
}
