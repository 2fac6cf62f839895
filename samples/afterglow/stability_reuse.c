// SPDX-License-Identifier: MIT
// Techniques that keep VPLs from frame to frame: what a light may do to them, and their budget at
// either end.
#include "stability.h"

#include <malloc.h>
#include <math.h>
#include <stdlib.h>

// Few VPLs and small maps, managed in the frame that shows them.
enum { POINTS = 64, BUDGET = 8, RECOVERY = POINTS / BUDGET };
#define SMALL "delay=0 max_lights=64 map_size=32"
#define BUDGETED SMALL " recalc_min=4 recalc_max=8"

// ---- rows 9, 19: nothing to keep -------------------------------------------------------------

// A wall across hides all that was lit from all that is, and the camera sees the latter.
static const double to_the_front[3] = { 0, 0, 0.5 };

static room divided_room(const ag_light *lamp)
{
    room what = { .lights = lamp, .light_count = 1, .partition = true, .jump = true };
    for (int c = 0; c < 3; ++c)
        what.travel[c] = to_the_front[c];
    return what;
}

static ag_light lamp_behind(void)
{
    ag_light lamp = stability_lamp();
    lamp.position[2] = -0.25;
    return lamp;
}

// After the last frame before the jump.
static fg_status open_before_jump(stability *s, const room *what, reel *r)
{
    const fg_status status = reel_open(s, what, (shot){ 0 }, BUDGETED " tiles=1", true, r);
    return status == FG_OK ? reel_run(r, 0.4, 0.02, 4) : status;
}

// The picture's mean in the first frame after, over that of a renderer that has seen no jump, with
// `lights` VPLs.
static fg_status jump_against(stability *s, const char *lights, double *out)
{
    const ag_light lamp = lamp_behind();
    const room what = divided_room(&lamp);
    reel r;
    image fresh = { 0 };
    double mean = 0;
    fg_status status = open_before_jump(s, &what, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0.6, 0, 1);
    if (status == FG_OK)
        status = reel_mean(&r, &mean);
    if (status == FG_OK)
        status = reel_fresh(s, &what, (shot){ 0 }, lights, 0.6, &fresh);
    if (status == FG_OK)
        *out = stability_change(mean, stability_mean(&fresh));
    image_finish(&fresh);
    reel_close(&r);
    return status;
}

// Nothing is left of what was: BUDGET VPLs are where they would be first of all, with all power.
static fg_status jump_as_new(stability *s, double *out)
{
    return jump_against(s, BUDGETED " tiles=1 max_lights=8", out);
}

// If a VPL gives the picture anything from nothing to twice the mean, by its place, that is
// 1/sqrt(3) to either side; BUDGET of them, 0.2.
static fg_status jump_energy(stability *s, double *out)
{
    return jump_against(s, BUDGETED " tiles=1", out);
}

static double points_short(const reel *r)
{
    return fabs(POINTS - reel_counter(r, "vpls") - reel_counter(r, "escaped"));
}

static fg_status jump_recovers(stability *s, double *out)
{
    const ag_light lamp = lamp_behind();
    const room what = divided_room(&lamp);
    reel r;
    fg_status status = open_before_jump(s, &what, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0.6, 0, RECOVERY);
    if (status == FG_OK)
        *out = points_short(&r);
    reel_close(&r);
    return status;
}

static fg_status jump_maps(stability *s, double *out)
{
    const ag_light lamp = lamp_behind();
    const room what = divided_room(&lamp);
    reel r;
    fg_status status = open_before_jump(s, &what, &r);
    *out = 0;
    for (int i = 0; i < RECOVERY && status == FG_OK; ++i) {
        status = reel_run(&r, 0.6, 0, 1);
        const double over = reel_counter(&r, "shadow_maps") - BUDGET;
        if (!(over <= *out)) // NAN, too
            *out = over;
    }
    reel_close(&r);
    return status;
}

static fg_status said_once(stability *s, double *out)
{
    ag_light up = stability_lamp();
    up.direction[1] = 1;
    const room what = { .lights = &up, .light_count = 1, .floor_alone = true };
    reel r;
    fg_status status = reel_open(s, &what, (shot){ 0 }, SMALL, true, &r);
    s->warnings = 0;
    if (status == FG_OK)
        status = reel_run(&r, 0, 1 / 60.0, 8);
    *out = abs(s->warnings - 1);
    reel_close(&r);
    return status;
}

// ---- row 20: long runs -----------------------------------------------------------------------

static const shot tiny = { .width = 16, .height = 16 };

// The lamp goes to and fro; no frame is quite as another.
static room swinging_room(const ag_light *lamp)
{
    return (room){ .lights = lamp, .light_count = 1, .block = true, .travel = { 0.5, -0.2, 0.3 } };
}

static double swing_time(int frame)
{
    return 0.49 - 0.49 * cos(2 * M_PI * frame / 97.3);
}

static double bytes_in_use(const reel *r)
{
    const struct mallinfo2 heap = mallinfo2();
    const fg_graph_stats graph = fg_graph_get_stats(renderer_graph(r->r));
    return (double) heap.uordblks + (double) heap.hblkhd + (double) graph.transient_bytes +
           (double) graph.persistent_bytes;
}

// The least of the second half over the least of what is before, without the first tenth.
static fg_status growth(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = swinging_room(&lamp);
    const int start = s->frames / 10, middle = (start + s->frames) / 2;
    double least[2] = { HUGE_VAL, HUGE_VAL };
    reel r;
    fg_status status = reel_open(s, &what, tiny, BUDGETED, true, &r);
    for (int i = 0; i < s->frames && status == FG_OK; ++i) {
        status = reel_run(&r, swing_time(i), 0, 1);
        double *part = &least[i >= middle];
        if (i >= start)
            *part = fmin(*part, bytes_in_use(&r));
    }
    *out = fmax(0, least[1] - least[0]) / fmax(1, s->frames - middle);
    reel_close(&r);
    return status;
}

// After the long run the light stands still for as long as a full renewal takes.
static fg_status long_run(stability *s, reel *r)
{
    const ag_light lamp = stability_lamp();
    const room what = swinging_room(&lamp);
    fg_status status = reel_open(s, &what, tiny, BUDGETED, true, r);
    for (int i = 0; i < s->frames && status == FG_OK; ++i)
        status = reel_run(r, swing_time(i), 0, 1);
    return status == FG_OK ? reel_run(r, swing_time(s->frames), 0, 2 * RECOVERY) : status;
}

static fg_status long_run_points(stability *s, double *out)
{
    reel r;
    const fg_status status = long_run(s, &r);
    if (status == FG_OK)
        *out = points_short(&r);
    reel_close(&r);
    return status;
}

static fg_status long_run_dispersion(stability *s, double *out)
{
    reel r;
    const fg_status status = long_run(s, &r);
    if (status == FG_OK)
        *out = reel_counter(&r, "dispersion");
    reel_close(&r);
    return status;
}

// Once a light has come to rest, frames are bits of one another.
static fg_status comes_to_rest(stability *s, double *out)
{
    enum { SETTLING = 8 * RECOVERY, COMPARED = 8 };
    const ag_light lamp = stability_lamp();
    const room what = swinging_room(&lamp);
    reel r;
    image first = { 0 };
    fg_status status = reel_open(s, &what, (shot){ 0 }, BUDGETED, true, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0, 1 / 60.0, 8);
    if (status == FG_OK)
        status = reel_run(&r, 0.2, 0, SETTLING);
    if (status == FG_OK)
        status = reel_picture(&r, &first);
    *out = 0;
    for (int i = 0; i < COMPARED && status == FG_OK; ++i) {
        image next = { 0 };
        status = reel_run(&r, 0.2, 0, 1);
        if (status == FG_OK)
            status = reel_picture(&r, &next);
        if (status == FG_OK)
            *out += (double) stability_differing(&next, &first);
        image_finish(&next);
    }
    image_finish(&first);
    reel_close(&r);
    return status;
}

// ---- parameters at their ends ----------------------------------------------------------------

// The picture after five frames of a moving lamp.
static fg_status moving_picture(stability *s, shot view, const char *values, image *out)
{
    const ag_light lamp = stability_lamp();
    const room what = swinging_room(&lamp);
    reel r;
    *out = (image){ 0 };
    fg_status status = reel_open(s, &what, view, values, true, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0, 1 / 60.0, 5);
    if (status == FG_OK)
        status = reel_picture(&r, out);
    reel_close(&r);
    return status;
}

static fg_status differing(stability *s, const char *values, const char *other, double *out)
{
    image a = { 0 }, b = { 0 };
    fg_status status = moving_picture(s, (shot){ 0 }, values, &a);
    if (status == FG_OK)
        status = moving_picture(s, (shot){ 0 }, other, &b);
    if (status == FG_OK)
        *out = (double) stability_differing(&a, &b);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status renews_all(stability *s, double *out)
{
    return differing(s, SMALL " recalc_min=64 recalc_max=64 settle=0", SMALL " mode=anew", out);
}

static fg_status one_tile(stability *s, double *out)
{
    return differing(s, SMALL " tiles=1 alpha=1e-9 beta=1", SMALL " tiles=1", out);
}

static fg_status no_recalc(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = swinging_room(&lamp);
    reel r;
    fg_status status =
        reel_open(s, &what, (shot){ 0 }, SMALL " recalc_min=0 recalc_max=0", true, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0, 0, 1);
    *out = 0;
    for (int i = 1; i < 20 && status == FG_OK; ++i) {
        status = reel_run(&r, i / 20.0, 0, 1);
        *out += reel_counter(&r, "new_vpls");
    }
    reel_close(&r);
    return status;
}

static fg_status no_recalc_from_nothing(stability *s, double *out)
{
    image img = { 0 };
    const fg_status status =
        moving_picture(s, (shot){ 0 }, SMALL " recalc_min=0 recalc_max=0 first=budget", &img);
    if (status == FG_OK)
        *out = stability_most(&img);
    image_finish(&img);
    return status;
}

static fg_status mean_with(stability *s, int lights, double *out)
{
    char values[96];
    image img = { 0 };
    snprintf(values, sizeof values, "delay=0 map_size=16 tiles=1 max_lights=%d", lights);
    const fg_status status = moving_picture(s, tiny, values, &img);
    if (status == FG_OK)
        *out = stability_mean(&img);
    image_finish(&img);
    return status;
}

static fg_status counts(stability *s, const int *list, double *out)
{
    double most = 0;
    fg_status status = mean_with(s, 4096, &most);
    *out = 0;
    for (int i = 0; list[i] && status == FG_OK; ++i) {
        double mean = 0;
        status = mean_with(s, list[i], &mean);
        *out = fmax(*out, stability_change(mean, most));
    }
    return status;
}

// From nothing to twice the mean: see above.
static fg_status few_lights(stability *s, double *out)
{
    return counts(s, (const int[]){ 1, 2, 3, 0 }, out);
}

// Of N patches 4 sqrt(N) lie at the rim of what is lit. What of them reaches beyond a surface's
// edge, a quarter at most, lights nothing: of 255 patches, 6 %.
static fg_status many_lights(stability *s, double *out)
{
    return counts(s, (const int[]){ 255, 256, 257, 1024, 0 }, out);
}

// ---- rows 27, 28: tiles ----------------------------------------------------------------------

// The back wall alone: a plane, on which the filter leaves nothing of the pattern.
static fg_status wall_picture(stability *s, const int size[2], const char *values, image *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1 };
    ag_camera camera = ag_default_camera();
    reel r;
    *out = (image){ 0 };
    for (int i = 0; i < 4; ++i)
        camera.world[5 * (size_t) i] = 1;
    camera.world[14] = 0.49;
    camera.yfov = 0.6f;
    camera.znear = 1e-3f;
    const shot view = { .camera = &camera, .width = size[0], .height = size[1] };
    fg_status status = reel_open(s, &what, view, values, true, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0, 0, 1);
    if (status == FG_OK)
        status = reel_picture(&r, out);
    reel_close(&r);
    return status;
}

// A window of n x n pixels is half a pixel off, sqrt(2) / 2 across, of 96; the wall's light changes
// by no more than its mean over the picture: 0.0074. Within n / 2 pixels of the picture's border it
// is n / 4 off on average: with n = 8 in a sixth of the pixels, sqrt(1 / 6) x 2 / 96 = 0.0085 more.
static fg_status tiles_against_none(stability *s, const int size[2], const char *tiles, double *out)
{
    char values[96];
    image a = { 0 }, b = { 0 };
    snprintf(values, sizeof values, "delay=0 max_lights=256 map_size=64 %s", tiles);
    fg_status status = wall_picture(s, size, values, &a);
    if (status == FG_OK)
        status = wall_picture(s, size, "delay=0 max_lights=256 map_size=64 tiles=1", &b);
    if (status == FG_OK)
        status = stability_rmse(s, &a, &b, out);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status tiles_of_4(stability *s, double *out)
{
    return tiles_against_none(s, (const int[]){ 96, 96 }, "tiles=4", out);
}

static fg_status tiles_of_8(stability *s, double *out)
{
    return tiles_against_none(s, (const int[]){ 96, 96 }, "tiles=8", out);
}

static fg_status odd_tiles(stability *s, double *out)
{
    return tiles_against_none(s, (const int[]){ 93, 97 }, "tiles=8", out);
}

// ---- row 33 ----------------------------------------------------------------------------------

// Nothing is hidden from anything in a convex room, of twelve triangles as large as its walls. A
// texel of 1/128 m at 1 m takes in the neighbouring wall along eight edges, on both sides: 2.5 % of
// what is seen, and of its light about an eighth, what comes along the wall: sqrt(0.025) / 8 =
// 0.02.
static fg_status empty_room(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1 };
    setting own;
    image a = { 0 }, b = { 0 };
    fg_status status = stability_with(s, "visibility=maps max_lights=64", &own);
    setting_finish(&own);
    if (status == FG_OK)
        status = reel_fresh(s, &what, (shot){ 0 }, "delay=0 max_lights=64 visibility=maps", 0, &a);
    if (status == FG_OK)
        status = reel_fresh(s, &what, (shot){ 0 }, "delay=0 max_lights=64 visibility=none", 0, &b);
    if (status == FG_OK)
        status = stability_rmse(s, &a, &b, out);
    image_finish(&a);
    image_finish(&b);
    return status;
}

// ---- the table -------------------------------------------------------------------------------

static const char brightest[] = "brightest value";
static const char differing_values[] = "values that differ";
static const char points[] = "points short of max_lights";
static const char rmse[] = "relative RMSE";

const stability_case stability_reuse_cases[] = {
    { 7, "recalc_of_all_is_anew", differing_values, 0, NULL, 0, renews_all },
    { 7, "tiles_of_1", differing_values, 0, NULL, 0, one_tile },
    { 9, "no_hits_are_said_once", "warnings but one", 0, NULL, 0, said_once },
    { 19, "light_jumps_away", "change of the mean from a new one of as many", 1e-5, NULL, 0,
      jump_as_new },
    { 19, "light_jumps_away_energy", "change of the mean from a new one in full", 0.2, NULL, 0,
      jump_energy },
    { 19, "light_jumps_away_recovers", points, 0, NULL, 0, jump_recovers },
    { 19, "maps_of_a_jump", "maps beyond recalc_max in a frame", 0, NULL, 0, jump_maps },
    { 20, "long_run_memory", "bytes more, a frame", 16, NULL, 0, growth },
    { 20, "long_run_points", points, 0, NULL, 0, long_run_points },
    { 20, "long_run_dispersion", "over a hexagonal lattice's", 2, NULL, 0, long_run_dispersion },
    { 20, "light_comes_to_rest", differing_values, 0, NULL, 0, comes_to_rest },
    { 26, "max_lights_1_to_3", "relative error of the mean", 1, NULL, 0, few_lights },
    { 26, "max_lights_255_to_4096", "relative error of the mean", 0.06, NULL, 0, many_lights },
    { 27, "tiles_over_the_edge", rmse, 0.016, NULL, 0, odd_tiles },
    { 28, "tiles_of_4", rmse, 0.01, NULL, 0, tiles_of_4 },
    { 28, "tiles_of_8", rmse, 0.016, NULL, 0, tiles_of_8 },
    { 33, "empty_room", rmse, 0.02, NULL, 0, empty_room },
    { 0, "recalc_max_of_0", "new VPLs after the first frame", 0, NULL, 0, no_recalc },
    { 0, "recalc_max_of_0_at_first", brightest, 0, NULL, 0, no_recalc_from_nothing },
    { 0 },
};
