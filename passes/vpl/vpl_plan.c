// SPDX-License-Identifier: MIT
#include "vpl_priv.h"

#include <string.h>

// The face that wants more VPLs most and for which there is room; -1: none. One that has less than
// `least` power wants none.
static int neediest(const double *power, int faces, double least, int64_t most_vpls,
                    const int *grid)
{
    int best = -1;
    double largest = 0;
    for (int i = 0; i < faces; i++) {
        const int64_t vpls = (int64_t) grid[i] * grid[i];
        if (!(power[i] > 0) || power[i] < least || vpls > most_vpls)
            continue;
        const double each = power[i] / (double) vpls;
        if (each > largest) {
            largest = each;
            best = i;
        }
    }
    return best;
}

int64_t ag_vpl_split(const double *power, int faces, int64_t budget, int most, int *grid)
{
    double sum = 0;
    for (int i = 0; i < faces; i++)
        sum += power[i];
    const double least = sum / (double) budget;
    int64_t room = budget, total = 0;
    for (int i = 0; i < faces; i++) {
        grid[i] = power[i] > 0;
        total += grid[i];
        room -= grid[i] && power[i] >= least;
    }
    const int64_t finest = (int64_t) most * most;
    for (;;) {
        // Four times as many fit: three more each, on at most half of the finest grid's edge.
        const int64_t fit = room / 3 < finest / 4 ? room / 3 : finest / 4;
        const int i = neediest(power, faces, least, fit, grid);
        if (i < 0)
            return total;
        const int64_t more = 3 * (int64_t) grid[i] * grid[i];
        grid[i] *= 2;
        room -= more;
        total += more;
    }
}

int vpl_plan(ag_vpl_pass *pass, int wide)
{
    double power[AG_MAX_FACES];
    int grid[AG_MAX_FACES], groups = 0, rows = 0;
    for (int i = 0; i < pass->face_count; i++) {
        power[i] = ag_gpu_scene_face_power(pass->gpu, i);
        grid[i] = power[i] > 0 ? pass->grid : 0;
    }
    // -size & size: the largest power of two that divides it.
    if (pass->grid == 0)
        ag_vpl_split(power, pass->face_count, pass->budget, -pass->size & pass->size, grid);
    pass->total = 0;
    for (int i = 0; i < pass->face_count; i++) {
        const int edge = grid[i];
        if (edge == 0)
            continue;
        const int32_t row[4] = { i, pass->total, groups, edge };
        memcpy(pass->rows[++rows], row, sizeof row);
        const int vpls = edge * edge;
        groups += pass->size / edge >= wide ? vpls : (vpls + VPL_GROUP - 1) / VPL_GROUP;
        pass->total += vpls;
    }
    const int32_t header[4] = { rows, groups, pass->size, pass->pattern == AG_VPL_STRATIFIED };
    memcpy(pass->rows[0], header, sizeof header);
    return rows;
}
