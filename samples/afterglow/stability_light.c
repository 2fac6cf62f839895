// SPDX-License-Identifier: MIT
#include "stability.h"

#include <math.h>

static const shot radiance = { .layer = LAYER_RADIANCE };
static const shot indirect = { .layer = LAYER_INDIRECT };
static const shot direct = { .layer = LAYER_DIRECT };

// ---- rows 1 to 5 -----------------------------------------------------------------------------

// No bounce is brighter than the albedo times the brightest surface that it comes from: form
// factors over a hemisphere sum to 1.
static fg_status near_vpl(stability *s, double *out)
{
    ag_light low = stability_lamp();
    double source = 0, bounce = 0;
    low.position[0] = -0.42;
    low.position[1] = -0.35;
    low.position[2] = -0.3;
    const room what = { .lights = &low, .light_count = 1, .albedo = 0.8f };
    fg_status status = stability_figure(s, &what, direct, stability_most, &source);
    if (status == FG_OK)
        status = stability_figure(s, &what, indirect, stability_most, &bounce);
    *out = source > 0 ? bounce / (0.8 * source) : 0;
    return status;
}

// A room without blocks hides nothing, so that one truth serves all techniques.
static fg_status trace_room(stability *s, const room *what, image *out)
{
    ag_scene *scene;
    fg_status status = stability_room(&s->log, what, &scene);
    if (status == FG_OK)
        status = reference_render(&(reference_desc){ .log = &s->log,
                                                     .scene = scene,
                                                     .camera = &scene->cameras[0],
                                                     .width = 48,
                                                     .height = 48,
                                                     .bounces = 1,
                                                     .spp = 1024,
                                                     .seed = 1,
                                                     .layer = REFERENCE_INDIRECT },
                                  out);
    ag_scene_destroy(scene);
    return status;
}

static double block_mean(const image *img, int x0, int y0, int size)
{
    double sum = 0;
    for (int y = y0; y < y0 + size; ++y)
        for (int x = x0; x < x0 + size; ++x)
            for (int c = 0; c < 3; ++c)
                sum +=
                    (double)
                        img->rgb[3 * ((size_t) y * (size_t) img->width + (size_t) x) + (size_t) c];
    return sum;
}

static fg_status corners(stability *s, double *out)
{
    enum { BLOCK = 6 };
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1 };
    image truth = { 0 }, img = { 0 };
    if (!s->setting->plugin)
        return FG_ERR_UNSUPPORTED;
    fg_status status = trace_room(s, &what, &truth);
    if (status == FG_OK)
        status = stability_shoot(s, &what, indirect, &img);
    *out = 0;
    for (int y = 0; y < 48 && status == FG_OK; y += BLOCK)
        for (int x = 0; x < 48; x += BLOCK)
            *out = fmax(*out, stability_change(block_mean(&img, x, y, BLOCK),
                                               block_mean(&truth, x, y, BLOCK)));
    image_finish(&truth);
    image_finish(&img);
    return status;
}

static fg_status floor_under(stability *s, double degrees, image *img)
{
    const double a = degrees * M_PI / 180;
    const ag_light sun = { .name = "sun",
                           .kind = AG_LIGHT_DIRECTIONAL,
                           .direction = { (float) cos(a), (float) -sin(a), 0 },
                           .intensity = { 1, 1, 1 } };
    const room what = { .lights = &sun, .light_count = 1, .floor_alone = true };
    return stability_shoot(s, &what, direct, img);
}

static fg_status grazing(stability *s, double *out)
{
    image img;
    const fg_status status = floor_under(s, 0, &img);
    if (status == FG_OK)
        *out = stability_most(&img);
    image_finish(&img);
    return status;
}

// Part of the floor, where a light from straight above reaches it, that is darker than half of what
// it should be.
static fg_status acne(stability *s, double *out)
{
    image img = { 0 }, above = { 0 };
    double lit = 0, dark = 0;
    const double want = 0.6 / M_PI * sin(2 * M_PI / 180);
    fg_status status = floor_under(s, 90, &above);
    if (status == FG_OK)
        status = floor_under(s, 2, &img);
    for (int i = 0; status == FG_OK && i < img.width * img.height; ++i) {
        const bool low = (double) img.rgb[3 * (size_t) i] < 0.5 * want;
        const bool there = above.rgb[3 * (size_t) i] > 0;
        dark += there && low;
        lit += there && !low;
    }
    *out = lit + dark > 0 ? dark / (lit + dark) : 1;
    image_finish(&img);
    image_finish(&above);
    return status;
}

static fg_status against_plain(stability *s, const room *what, const shot *view, double *out)
{
    const ag_light lamp = stability_lamp();
    const room plain = { .lights = &lamp, .light_count = 1, .block = true };
    double base = 0, other = 0;
    fg_status status = stability_figure(s, &plain, radiance, stability_mean, &base);
    if (status == FG_OK)
        status = stability_figure(s, what, *view, stability_mean, &other);
    *out = stability_change(other, base);
    return status;
}

static fg_status scaled(stability *s, double scale, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1, .block = true, .scale = scale };
    return against_plain(s, &what, &radiance, out);
}

static fg_status scale_small(stability *s, double *out)
{
    return scaled(s, 1e-4, out);
}

static fg_status scale_large(stability *s, double *out)
{
    return scaled(s, 1e4, out);
}

static fg_status far_away(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = {
        .lights = &lamp, .light_count = 1, .block = true, .offset = { 1e6, -1e6, 1e6 }
    };
    return against_plain(s, &what, &radiance, out);
}

// FG_OK with nothing set where the plugin does not count VPLs.
static fg_status twice_the_vpls(const stability *s, setting *out)
{
    const int row = stability_find_vpls(s->setting->plugin);
    char text[32];
    *out = (setting){ 0 };
    if (row < 0)
        return FG_OK;
    snprintf(text, sizeof text, "vpls=%lld", 2 * (long long) s->setting->values[row].i);
    return stability_with(s, text, out);
}

// Both halves share one budget of VPLs: with twice as many each has those of the whole.
static fg_status coincident_lights(stability *s, double *out)
{
    ag_light half[2] = { stability_lamp(), stability_lamp() };
    for (int i = 0; i < 2; ++i)
        for (int c = 0; c < 3; ++c)
            half[i].intensity[c] = 0.5f;
    const room what = { .lights = half, .light_count = 2, .block = true };
    shot view = radiance;
    setting own = { 0 };
    fg_status status = twice_the_vpls(s, &own);
    view.values = own.values;
    if (status == FG_OK)
        status = against_plain(s, &what, &view, out);
    setting_finish(&own);
    return status;
}

// ---- rows 8 to 14 ----------------------------------------------------------------------------

// The lamp moves 1 mm a frame, so that its texels cross the block's edges.
static fg_status silhouette(stability *s, double *out)
{
    enum { STEPS = 12 };
    const ag_light lamp = stability_lamp();
    const room what = {
        .lights = &lamp, .light_count = 1, .block = true, .travel = { 0.06, 0, 0 }
    };
    double before = 0;
    fg_status status = FG_OK;
    *out = 0;
    for (int i = 0; i < STEPS && status == FG_OK; ++i) {
        double mean = 0;
        shot view = radiance;
        view.time = i / 60.0;
        status = stability_figure(s, &what, view, stability_mean, &mean);
        if (i)
            *out = fmax(*out, stability_change(mean, before));
        before = mean;
    }
    return status;
}

static fg_status lights_nothing(stability *s, double *out)
{
    ag_light up = stability_lamp();
    up.direction[1] = 1;
    const room what = { .lights = &up, .light_count = 1, .floor_alone = true };
    return stability_figure(s, &what, indirect, stability_most, out);
}

static fg_status lamp_at(stability *s, double x, double y, double z, double *out)
{
    ag_light lamp = stability_lamp();
    lamp.position[0] = x;
    lamp.position[1] = y;
    lamp.position[2] = z;
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    return stability_checks(s, &what, radiance, out);
}

static fg_status light_in_block(stability *s, double *out)
{
    return lamp_at(s, 0, -0.35, 0, out);
}

static fg_status light_on_floor(stability *s, double *out)
{
    return lamp_at(s, 0.3, -0.5, 0.3, out);
}

static fg_status light_at_camera(stability *s, double *out)
{
    return lamp_at(s, 0, 0, 0.49, out);
}

// Straight above a corner of the block's mesh and on it: the VPL and the light in one point.
static fg_status light_on_vertex(stability *s, double *out)
{
    return lamp_at(s, 0.15, -0.199, 0.15, out);
}

static fg_status junk_dropped(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room clean = { .lights = &lamp, .light_count = 1, .block = true };
    room dirty = clean;
    image a = { 0 }, b = { 0 };
    dirty.junk = 1;
    fg_status status = stability_shoot(s, &clean, radiance, &a);
    if (status == FG_OK)
        status = stability_shoot(s, &dirty, radiance, &b);
    if (status == FG_OK)
        *out = (double) stability_differing(&a, &b);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status slivers(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1, .junk = 2 };
    return stability_checks(s, &what, radiance, out);
}

static fg_status lamp_of(stability *s, float intensity, double *out)
{
    ag_light lamp = stability_lamp();
    for (int c = 0; c < 3; ++c)
        lamp.intensity[c] = intensity;
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    return stability_checks(s, &what, (shot){ 0 }, out);
}

static fg_status overflow(stability *s, double *out)
{
    return lamp_of(s, 1e12f, out);
}

static fg_status underflow(stability *s, double *out)
{
    return lamp_of(s, 1e-30f, out);
}

// One NaN in the G-buffer: in how many pixels of the picture does it arrive?
static fg_status nan_pixel(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    image img;
    s->poke = true;
    const fg_status status = stability_shoot(s, &what, radiance, &img);
    s->poke = false;
    if (status == FG_OK && !s->poked)
        fg_logf(&s->log, FG_LOG_ERROR, "stability: no pass wrote gbuffer.normal");
    *out = s->poked ? 0 : (double) INFINITY;
    for (int i = 0; status == FG_OK && i < img.width * img.height; ++i)
        *out += !isfinite(img.rgb[3 * (size_t) i]) || !isfinite(img.rgb[3 * (size_t) i + 1]) ||
                !isfinite(img.rgb[3 * (size_t) i + 2]);
    image_finish(&img);
    return status;
}

// ---- the table -------------------------------------------------------------------------------

static const char bad_values[] = "values that are not finite or negative light";
static const char brightest[] = "brightest value";
static const char change_of_mean[] = "relative change of the mean";
static const char differing_values[] = "values that differ";

const stability_case stability_light_cases[] = {
    { 1, "receiver_at_vpl", "brightest bounce over albedo times brightest source", 1.0, NULL, 0,
      near_vpl },
    { 2, "corners", "largest relative error of a 6x6 block", 0.05,
      "so few VPLs that single ones are seen near corners", 0.6, corners },
    { 3, "light_in_the_plane", brightest, 1e-6, NULL, 0, grazing },
    { 3, "light_2_degrees_above", "part of the floor that is dark", 0, NULL, 0, acne },
    { 4, "scale_1e-4", change_of_mean, 1e-3, NULL, 0, scale_small },
    { 4, "scale_1e4", change_of_mean, 1e-3, NULL, 0, scale_large },
    { 4, "offset_1e6_m", change_of_mean, 1e-3, NULL, 0, far_away },
    { 5, "light_split_in_two", change_of_mean, 1e-3,
      "halves share the patches of light by their power and have fewer each", 0.01,
      coincident_lights },
    { 8, "texels_over_edges", "largest relative step of the mean, 1 mm a frame", 0.02, NULL, 0,
      silhouette },
    { 9, "light_on_nothing", brightest, 0, NULL, 0, lights_nothing },
    { 10, "light_in_a_block", bad_values, 0, NULL, 0, light_in_block },
    { 10, "light_on_the_floor", bad_values, 0, NULL, 0, light_on_floor },
    { 10, "light_at_the_camera", bad_values, 0, NULL, 0, light_at_camera },
    { 11, "light_on_a_vpl", bad_values, 0, NULL, 0, light_on_vertex },
    { 12, "no_area_and_nan_vertices", differing_values, 0, NULL, 0, junk_dropped },
    { 12, "slivers_and_backs", bad_values, 0, NULL, 0, slivers },
    { 13, "light_of_1e12", bad_values, 0, NULL, 0, overflow },
    { 13, "light_of_1e-30", bad_values, 0, NULL, 0, underflow },
    { 14, "nan_in_one_pixel", "pixels that it reaches", 1, NULL, 0, nan_pixel },
    { 0 },
};
