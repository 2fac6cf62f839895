// SPDX-License-Identifier: MIT
// Techniques that light fewer texels than there are pixels: sizes that their levels do not divide,
// what they must not refine, and their parameters at either end.
#include "stability.h"

#include <math.h>
#include <stdlib.h>

static const shot radiance = { .layer = LAYER_RADIANCE };
static const shot indirect = { .layer = LAYER_INDIRECT };

static fg_status lit_room(stability *s, shot view, const gi_value *values, image *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    view.values = values;
    return stability_shoot(s, &what, view, out);
}

static fg_status check_room(stability *s, shot view, const gi_value *values, double *out)
{
    image img;
    const fg_status status = lit_room(s, view, values, &img);
    image_finish(&img);
    *out = (double) s->bad;
    return status;
}

// ---- row 3 -----------------------------------------------------------------------------------

static ag_camera camera_at(double y, double z)
{
    ag_camera camera = { .yfov = 1.0f, .znear = 1e-3f };
    for (int i = 0; i < 4; ++i)
        camera.world[5 * (size_t) i] = 1;
    camera.world[13] = y;
    camera.world[14] = z;
    return camera;
}

static fg_status with_thresholds(const stability *s)
{
    setting own;
    const fg_status status = stability_with(s, "depth=0.005 normal=0.25", &own);
    setting_finish(&own);
    return status;
}

// A floor seen along, from 1 cm above it: at 28 degrees at the lower edge of the picture, at less
// than 1 where it ends. Depth changes fast from pixel to pixel, and yet it is a plane.
static fg_status plane_seen_along(stability *s, double *out)
{
    enum { EDGE = 512, FRAMES = 4 };
    const ag_light sun = { .name = "sun",
                           .kind = AG_LIGHT_DIRECTIONAL,
                           .direction = { 0, -1, 0 },
                           .intensity = { 1, 1, 1 } };
    const ag_camera low = camera_at(-0.49, 0.4);
    const room what = { .lights = &sun, .light_count = 1, .floor_alone = true };
    shot view = radiance;
    image img = { 0 };
    double floor_pixels = 0;
    view.camera = &low;
    view.width = view.height = EDGE;
    view.frames = FRAMES;
    fg_status status = with_thresholds(s);
    if (status == FG_OK)
        status = stability_shoot(s, &what, view, &img);
    for (size_t i = 0; status == FG_OK && i < stability_values(&img); i += 3)
        floor_pixels += img.rgb[i] > 0;
    image_finish(&img);
    *out = 100 * s->samples / floor_pixels;
    return status;
}

// ---- rows 4 to 10 ----------------------------------------------------------------------------

static fg_status picture_at(stability *s, double scale, double *out)
{
    const ag_light lamp = stability_lamp();
    room what = { .lights = &lamp, .light_count = 1, .block = true };
    image a = { 0 }, b = { 0 };
    fg_status status = stability_shoot(s, &what, indirect, &a);
    what.scale = scale;
    if (status == FG_OK)
        status = stability_shoot(s, &what, indirect, &b);
    if (status == FG_OK)
        status = stability_rmse(s, &b, &a, out);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status picture_small(stability *s, double *out)
{
    return picture_at(s, 1e-4, out);
}

static fg_status picture_large(stability *s, double *out)
{
    return picture_at(s, 1e4, out);
}

// Surfaces that lie behind the camera.
static fg_status nothing_in_view(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const ag_camera ahead = camera_at(0, -2);
    const room what = { .lights = &lamp, .light_count = 1, .floor_alone = true };
    shot view = radiance;
    view.camera = &ahead;
    return stability_figure(s, &what, view, stability_most, out);
}

// A lamp `gap` rooms before the middle of a wall: shines on it, or along it.
static fg_status lamp_near_wall(stability *s, bool along, double *out)
{
    ag_light lamp = stability_lamp();
    lamp.position[0] = -0.5 + 1e-3;
    lamp.position[1] = 0;
    lamp.direction[0] = along ? 0 : -1;
    lamp.direction[1] = along ? -1 : 0;
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    return stability_checks(s, &what, radiance, out);
}

static fg_status lamp_at_wall(stability *s, double *out)
{
    return lamp_near_wall(s, false, out);
}

static fg_status lamp_along_wall(stability *s, double *out)
{
    return lamp_near_wall(s, true, out);
}

// ---- row 25 ----------------------------------------------------------------------------------

static fg_status odd_pictures(stability *s, double *out)
{
    static const int sizes[][2] = { { 2, 1 }, { 64, 64 }, { 65, 63 }, { 1023, 517 } };
    fg_status status = FG_OK;
    for (int i = 0; i < FG_COUNT(sizes) && status == FG_OK; ++i) {
        shot view = radiance;
        view.width = sizes[i][0];
        view.height = sizes[i][1];
        status = check_room(s, view, NULL, out);
    }
    return status;
}

// With few VPLs where there is a choice, and what the host's passes write unread: both grow with
// the pixels alone.
static fg_status large_picture(stability *s, double *out)
{
    setting own;
    shot view = radiance;
    if (!s->setting->plugin)
        return FG_ERR_UNSUPPORTED;
    fg_status status = stability_with_known(s, "vpls=4 max_lights=4 map_size=32", &own);
    if (status != FG_OK)
        return status;
    view.width = view.height = 4096;
    s->own_passes = true;
    status = check_room(s, view, own.values, out);
    s->own_passes = false;
    setting_finish(&own);
    return status;
}

// ---- row 29 ----------------------------------------------------------------------------------

static fg_status one_triangle(stability *s, double *out)
{
    shot view = radiance;
    image img = { 0 };
    fg_status status = stability_triangle(&s->log, &view.scene);
    if (status == FG_OK)
        status = stability_render(s, &view, &img);
    *out = (double) s->bad;
    image_finish(&img);
    ag_scene_destroy(view.scene);
    return status;
}

// ---- parameters at their ends ----------------------------------------------------------------

// rsm's picture with `values`.
static fg_status reference_picture(stability *s, const char *values, image *out)
{
    const setting *const at_hand = s->setting;
    setting own = { 0 }, plain = { .plugin = s->rsm };
    plain.values = calloc((size_t) gi_params_count(s->rsm) + 1, sizeof *plain.values);
    if (!plain.values)
        return FG_ERR_MEMORY;
    gi_params_default(s->rsm, plain.values);
    s->setting = &plain;
    fg_status status = stability_with(s, values, &own);
    if (status == FG_OK)
        status = lit_room(s, indirect, own.values, out);
    s->setting = at_hand;
    setting_finish(&own);
    setting_finish(&plain);
    return status;
}

// The plugin's picture with `values`, and rsm's with `reference`.
static fg_status both_pictures(stability *s, const char *values, const char *reference, image *a,
                               image *b)
{
    setting own;
    if (!s->rsm)
        return FG_ERR_UNSUPPORTED;
    fg_status status = stability_with(s, values, &own);
    if (status == FG_OK)
        status = lit_room(s, indirect, own.values, a);
    if (status == FG_OK)
        status = reference_picture(s, reference, b);
    setting_finish(&own);
    return status;
}

static fg_status thresholds_0(stability *s, double *out)
{
    image a = { 0 }, b = { 0 };
    const fg_status status =
        both_pictures(s, "depth=0 normal=0 share=0 source=regular vpls=256", "vpls=256", &a, &b);
    if (status == FG_OK)
        *out = (double) stability_differing(&a, &b);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status with_values(stability *s, const char *values, double *out)
{
    setting own;
    shot view = indirect;
    fg_status status = stability_with(s, values, &own);
    if (status != FG_OK)
        return status;
    view.width = view.height = 256; // several levels
    status = check_room(s, view, own.values, out);
    setting_finish(&own);
    return status;
}

static fg_status thresholds_0_shared(stability *s, double *out)
{
    return with_values(s, "depth=0 normal=0", out);
}

static fg_status thresholds_infinite(stability *s, double *out)
{
    return with_values(s, "depth=1e6 normal=4", out);
}

// The cut is made of all texels of the map: what is left are sums in another order, of 4096 terms
// of one sign, each within 1e-7 of their sum.
static fg_status tau_0(stability *s, double *out)
{
    image a = { 0 }, b = { 0 };
    fg_status status = both_pictures(s, "tau=0 rsm_size=64 finest=64 depth=0 normal=0 share=0",
                                     "rsm_size=64 pattern=all", &a, &b);
    if (status == FG_OK)
        status = stability_rmse(s, &a, &b, out);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status tau_infinite(stability *s, double *out)
{
    return with_values(s, "tau=1e12", out);
}

// ---- the table -------------------------------------------------------------------------------

static const char bad_values[] = "values that are not finite or negative light";
static const char brightest[] = "brightest value";
static const char off_by[] = "relative RMSE";

const stability_case stability_hierarchy_cases[] = {
    { 3, "plane_seen_along", "per cent of its pixels that gather", 3, NULL, 0, plane_seen_along },
    { 4, "picture_at_1e-4", off_by, 0.01, NULL, 0, picture_small },
    { 4, "picture_at_1e4", off_by, 0.01, NULL, 0, picture_large },
    { 9, "nothing_in_view", brightest, 0, NULL, 0, nothing_in_view },
    { 10, "light_1e-3_from_a_wall", bad_values, 0, NULL, 0, lamp_at_wall },
    { 10, "light_1e-3_along_a_wall", bad_values, 0, NULL, 0, lamp_along_wall },
    { 25, "odd_pictures", bad_values, 0, NULL, 0, odd_pictures },
    { 25, "4096_pixels_square", bad_values, 0, NULL, 0, large_picture },
    { 29, "one_triangle", bad_values, 0, NULL, 0, one_triangle },
    { 0, "thresholds_of_0", "values that differ from rsm's", 0, NULL, 0, thresholds_0 },
    { 0, "thresholds_of_0_shared", bad_values, 0, NULL, 0, thresholds_0_shared },
    { 0, "thresholds_infinite", bad_values, 0, NULL, 0, thresholds_infinite },
    { 0, "tau_of_0", "relative RMSE against all texels", 1e-5, NULL, 0, tau_0 },
    { 0, "tau_infinite", bad_values, 0, NULL, 0, tau_infinite },
    { 0 },
};
