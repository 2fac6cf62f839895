// SPDX-License-Identifier: MIT
// What changes from one frame to the next: lights, objects, camera, size, plugin, parameters. No
// technique may show what was.
#include "stability.h"

#include <math.h>

// Whoever keeps VPLs shows them in the frame that they are of, and has few of them.
static const char prompt[] = "delay=0 max_lights=64 map_size=32";

static room lit_room(const ag_light *lamp)
{
    return (room){ .lights = lamp, .light_count = 1, .block = true };
}

static room moving_room(const ag_light *lamp)
{
    room what = lit_room(lamp);
    what.travel[0] = 0.4;
    what.travel[1] = -0.3;
    what.travel[2] = 0.2;
    return what;
}

// ---- lights ----------------------------------------------------------------------------------

typedef struct kind {
    ag_light_kind kind;
    bool cosine;
    double degrees; // of a spot
} kind;

static fg_status move_kind(stability *s, kind k)
{
    ag_light lamp = stability_lamp();
    lamp.kind = k.kind;
    lamp.cosine = k.cosine;
    lamp.cos_outer = (float) cos(0.5 * k.degrees * M_PI / 180);
    lamp.cos_inner = 1;
    const room what = moving_room(&lamp);
    reel r;
    fg_status status = reel_open(s, &what, (shot){ 0 }, prompt, false, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0, 0.1, 4);
    reel_close(&r);
    return status;
}

static fg_status all_kinds(stability *s, double *out)
{
    static const kind kinds[] = {
        { AG_LIGHT_SPOT, .degrees = 0 },   { AG_LIGHT_SPOT, .degrees = 180 },
        { AG_LIGHT_SPOT, .degrees = 270 }, { AG_LIGHT_SPOT, .degrees = 360 },
        { AG_LIGHT_SPOT, .cosine = true }, { AG_LIGHT_POINT },
        { AG_LIGHT_DIRECTIONAL },
    };
    fg_status status = FG_OK;
    for (int i = 0; i < FG_COUNT(kinds) && status == FG_OK; ++i)
        status = move_kind(s, kinds[i]);
    *out = (double) s->bad;
    return status;
}

static fg_status set_intensity(const reel *r, float intensity)
{
    ag_light lamp = stability_lamp();
    for (int c = 0; c < 3; ++c)
        lamp.intensity[c] = intensity;
    return ag_scene_add_light(r->scene, &lamp);
}

// A lamp that goes out after three frames, and what the reel is then.
static fg_status open_dark(stability *s, reel *r, double *before)
{
    const ag_light lamp = stability_lamp();
    const room what = lit_room(&lamp);
    fg_status status = reel_open(s, &what, (shot){ 0 }, prompt, false, r);
    if (status == FG_OK)
        status = reel_run(r, 0, 0, 3);
    if (status == FG_OK)
        status = reel_mean(r, before);
    if (status == FG_OK)
        status = set_intensity(r, 0);
    return status == FG_OK ? reel_run(r, 0, 0, 1) : status;
}

static fg_status goes_out(stability *s, double *out)
{
    reel r;
    double before;
    fg_status status = open_dark(s, &r, &before);
    if (status == FG_OK)
        status = reel_mean(&r, out);
    reel_close(&r);
    return status;
}

static fg_status comes_back(stability *s, double *out)
{
    reel r;
    double before = 0, after = 0;
    fg_status status = open_dark(s, &r, &before);
    if (status == FG_OK)
        status = set_intensity(&r, 1);
    if (status == FG_OK)
        status = reel_run(&r, 0, 0, 1);
    if (status == FG_OK)
        status = reel_mean(&r, &after);
    *out = stability_change(after, before);
    reel_close(&r);
    return status;
}

// Of a lamp in the room's middle that is dark and goes on: two frames after it has, against frames
// in which it always was.
static fg_status goes_on(stability *s, double *out)
{
    ag_light lamps[] = { stability_lamp(), stability_lamp() };
    const room lit = { .lights = lamps, .light_count = 2, .block = true };
    image fresh = { 0 };
    double mean = 0;
    reel r = { 0 };
    snprintf(lamps[1].name, sizeof lamps[1].name, "second");
    lamps[1].position[0] = 0.3;
    lamps[1].position[1] = 0;
    const ag_light on = lamps[1];
    fg_status status = reel_fresh(s, &lit, (shot){ 0 }, prompt, 0, &fresh);
    for (int c = 0; c < 3; ++c)
        lamps[1].intensity[c] = 0;
    if (status == FG_OK)
        status = reel_open(s, &lit, (shot){ 0 }, prompt, false, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0, 0, 3);
    if (status == FG_OK)
        status = ag_scene_add_light(r.scene, &on);
    if (status == FG_OK)
        status = reel_run(&r, 0, 0, 2);
    if (status == FG_OK)
        status = reel_mean(&r, &mean);
    if (status == FG_OK)
        *out = stability_change(mean, stability_mean(&fresh));
    image_finish(&fresh);
    reel_close(&r);
    return status;
}

// From under the ceiling onto the middle of what it lit, where a sampling point is first.
static fg_status jumps_onto_vpl(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = {
        .lights = &lamp, .light_count = 1, .jump = true, .travel = { 0, -0.95, 0 }
    };
    reel r;
    fg_status status = reel_open(s, &what, (shot){ 0 }, prompt, false, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0.4, 0.2, 2);
    reel_close(&r);
    *out = (double) s->bad;
    return status;
}

static fg_status on_wall(stability *s, double gap, double *mean)
{
    ag_light lamp = stability_lamp();
    lamp.position[0] = -0.5 + gap;
    lamp.position[1] = 0;
    lamp.direction[0] = 1;
    lamp.direction[1] = 0;
    const room what = lit_room(&lamp);
    image img = { 0 };
    const fg_status status = reel_fresh(s, &what, (shot){ 0 }, prompt, 0, &img);
    if (status == FG_OK)
        *mean = stability_mean(&img);
    image_finish(&img);
    return status;
}

// Light that leaves a wall lights the same as from 1e-3 of the room before it, to about as much.
static fg_status wall_lamp(stability *s, double *out)
{
    double touching = 0, before = 0;
    fg_status status = on_wall(s, 0, &touching);
    if (status == FG_OK)
        status = on_wall(s, 1e-3, &before);
    *out = stability_change(touching, before);
    return status;
}

// ---- surfaces --------------------------------------------------------------------------------

static fg_status walls_twice(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    room what = lit_room(&lamp);
    image once = { 0 }, twice = { 0 };
    fg_status status = reel_fresh(s, &what, (shot){ 0 }, prompt, 0, &once);
    what.twice = true;
    if (status == FG_OK)
        status = reel_fresh(s, &what, (shot){ 0 }, prompt, 0, &twice);
    if (status == FG_OK)
        *out = stability_change(stability_mean(&twice), stability_mean(&once));
    image_finish(&once);
    image_finish(&twice);
    return status;
}

// The picture after six frames of a moving lamp.
static fg_status moving_picture(stability *s, double scale, image *out)
{
    const ag_light lamp = stability_lamp();
    room what = moving_room(&lamp);
    reel r;
    *out = (image){ 0 };
    what.scale = scale;
    fg_status status = reel_open(s, &what, (shot){ 0 }, prompt, false, &r);
    if (status == FG_OK)
        status = reel_run(&r, 0, 0.05, 6);
    if (status == FG_OK)
        status = reel_picture(&r, out);
    reel_close(&r);
    return status;
}

static fg_status moving_at(stability *s, double scale, double *out)
{
    image a = { 0 }, b = { 0 };
    fg_status status = moving_picture(s, 1, &a);
    if (status == FG_OK)
        status = moving_picture(s, scale, &b);
    if (status == FG_OK)
        status = stability_rmse(s, &b, &a, out);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status moving_small(stability *s, double *out)
{
    return moving_at(s, 1e-4, out);
}

static fg_status moving_large(stability *s, double *out)
{
    return moving_at(s, 1e4, out);
}

// Frames at which the block is there, then without it, against frames without it alone.
static fg_status uncovered(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    room what = lit_room(&lamp);
    reel a, b = { 0 };
    image seen = { 0 }, other = { 0 };
    what.block_goes = true;
    fg_status status = reel_open(s, &what, (shot){ 0 }, prompt, false, &a);
    if (status == FG_OK)
        status = reel_run(&a, 0.3, 0.1, 4); // the block goes at 0.5 s
    if (status == FG_OK)
        status = reel_picture(&a, &seen);
    if (status == FG_OK)
        status = reel_open(s, &what, (shot){ 0 }, prompt, false, &b);
    if (status == FG_OK)
        status = reel_run(&b, 0.6, 0, 4);
    if (status == FG_OK)
        status = reel_picture(&b, &other);
    if (status == FG_OK)
        *out = (double) stability_differing(&seen, &other);
    image_finish(&seen);
    image_finish(&other);
    reel_close(&a);
    reel_close(&b);
    return status;
}

// ---- the frame -------------------------------------------------------------------------------

// Four frames of a moving lamp with `change` before each; then the picture of a fifth.
typedef fg_status (*change_fn)(const reel *r, int frame);

static fg_status changed_picture(stability *s, shot view, const char *values, change_fn change,
                                 image *out)
{
    const ag_light lamp = stability_lamp();
    const room what = moving_room(&lamp);
    reel r;
    *out = (image){ 0 };
    fg_status status = reel_open(s, &what, view, values, false, &r);
    for (int i = 0; i < 5 && status == FG_OK; ++i) {
        if (change)
            status = change(&r, i);
        if (status == FG_OK)
            status = reel_run(&r, 0.1 * i, 0, 1);
    }
    if (status == FG_OK)
        status = reel_picture(&r, out);
    reel_close(&r);
    return status;
}

static fg_status against_unchanged(stability *s, shot view, const char *values, change_fn change,
                                   double *out)
{
    image a = { 0 }, b = { 0 };
    fg_status status = changed_picture(s, (shot){ 0 }, values, change, &a);
    if (status == FG_OK)
        status = changed_picture(s, view, values, NULL, &b);
    if (status == FG_OK)
        *out = (double) stability_differing(&a, &b);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status change_size(const reel *r, int frame)
{
    static const int sizes[][2] = { { 48, 48 }, { 31, 57 }, { 31, 57 }, { 1, 1 }, { 48, 48 } };
    return renderer_resize(r->r, sizes[frame][0], sizes[frame][1]);
}

static fg_status resized(stability *s, double *out)
{
    return against_unchanged(s, (shot){ 0 }, prompt, change_size, out);
}

static ag_camera other_camera(void)
{
    ag_camera camera = ag_default_camera();
    for (int i = 0; i < 4; ++i)
        camera.world[5 * (size_t) i] = 1;
    camera.world[12] = -0.3;
    camera.world[13] = 0.2;
    camera.world[14] = 0.4;
    camera.yfov = 1.2f;
    camera.znear = 1e-3f;
    return camera;
}

static fg_status cut_camera(const reel *r, int frame)
{
    const ag_camera camera = other_camera();
    if (frame == 4)
        renderer_set_camera(r->r, &camera);
    return FG_OK;
}

static fg_status camera_cut(stability *s, double *out)
{
    const ag_camera camera = other_camera();
    return against_unchanged(s, (shot){ .camera = &camera }, prompt, cut_camera, out);
}

// As it is set up, twice: what runs on threads of its own must not decide.
static fg_status same_path(stability *s, double *out)
{
    return against_unchanged(s, (shot){ 0 }, "max_lights=64 map_size=32", NULL, out);
}

static fg_status change_plugin(const reel *r, int frame)
{
    if (frame == 2)
        return renderer_set_plugin(r->r, NULL, NULL);
    if (frame == 3 && r->s->rsm)
        return renderer_set_plugin(r->r, r->s->rsm, NULL);
    return frame == 4 ? renderer_set_plugin(r->r, r->own.plugin, r->own.values) : FG_OK;
}

// What a reel ends in after `change`, and what a fresh plugin makes of that moment.
static fg_status changed_and_fresh(stability *s, change_fn change, image *a, image *b)
{
    const ag_light lamp = stability_lamp();
    const room what = moving_room(&lamp);
    const fg_status status = changed_picture(s, (shot){ 0 }, prompt, change, a);
    return status == FG_OK ? reel_fresh(s, &what, (shot){ 0 }, prompt, 0.4, b) : status;
}

// Back again, a plugin is as new.
static fg_status switched(stability *s, double *out)
{
    image a = { 0 }, b = { 0 };
    const fg_status status = changed_and_fresh(s, change_plugin, &a, &b);
    if (status == FG_OK)
        *out = (double) stability_differing(&a, &b);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status change_values(const reel *r, int frame)
{
    static const char *const values[] = {
        "tiles=1",
        "tiles=8 max_lights=7",
        "mode=anew map_size=64",
        "visibility=none clamp=disc",
    };
    stability with = *r->s;
    setting other;
    with.setting = &r->own;
    if (frame == 4)
        return renderer_set_plugin(r->r, r->own.plugin, r->own.values);
    fg_status status = stability_with(&with, values[frame], &other);
    if (status == FG_OK)
        status = renderer_set_plugin(r->r, other.plugin, other.values);
    setting_finish(&other);
    return status;
}

static fg_status other_values(stability *s, double *out)
{
    image a = { 0 }, b = { 0 };
    const fg_status status = changed_and_fresh(s, change_values, &a, &b);
    if (status == FG_OK)
        *out = stability_change(stability_mean(&a), stability_mean(&b));
    image_finish(&a);
    image_finish(&b);
    return status;
}

// ---- the table -------------------------------------------------------------------------------

static const char bad_values[] = "values that are not finite or negative light";
static const char change_of_mean[] = "relative change of the mean";
static const char differing_values[] = "values that differ";
static const char off_by[] = "relative RMSE";

const stability_case stability_change_cases[] = {
    { 4, "moving_at_1e-4", off_by, 0.01, NULL, 0, moving_small },
    { 4, "moving_at_1e4", off_by, 0.01, NULL, 0, moving_large },
    { 10, "light_on_a_wall", change_of_mean, 0.02, NULL, 0, wall_lamp },
    { 11, "light_jumps_onto_a_vpl", bad_values, 0, NULL, 0, jumps_onto_vpl },
    { 12, "every_wall_twice", change_of_mean, 1e-3, NULL, 0, walls_twice },
    { 17, "light_goes_out", "mean in the frame after", 0, NULL, 0, goes_out },
    { 17, "light_comes_back", change_of_mean, 0.02, NULL, 0, comes_back },
    { 19, "light_goes_on", change_of_mean, 0.05, NULL, 0, goes_on },
    { 21, "lights_of_all_kinds_move", bad_values, 0, NULL, 0, all_kinds },
    { 31, "receiver_uncovered", differing_values, 0, NULL, 0, uncovered },
    { 31, "camera_cut", differing_values, 0, NULL, 0, camera_cut },
    { 31, "size_changes", differing_values, 0, NULL, 0, resized },
    { 31, "plugin_changes", differing_values, 0, NULL, 0, switched },
    { 31, "parameters_change", change_of_mean, 0.05, NULL, 0, other_values },
    { 35, "same_path_twice", differing_values, 0, NULL, 0, same_path },
    { 0 },
};
