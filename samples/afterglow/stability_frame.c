// SPDX-License-Identifier: MIT
#include "stability.h"

#include "file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const shot radiance = { .layer = LAYER_RADIANCE };
static const shot indirect = { .layer = LAYER_INDIRECT };

// ---- rows 17 to 21 ---------------------------------------------------------------------------

static fg_status emissive_alone(stability *s, double *out)
{
    const room what = { .emission = 1 };
    return stability_checks(s, &what, radiance, out);
}

static fg_status no_light(stability *s, double *out)
{
    const room what = { .block = true };
    return stability_figure(s, &what, radiance, stability_most, out);
}

static fg_status black_room(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .black = true, .lights = &lamp, .light_count = 1 };
    return stability_figure(s, &what, radiance, stability_most, out);
}

// After the light has jumped, a renderer that has seen it against one that has not.
static fg_status teleport(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = {
        .lights = &lamp, .light_count = 1, .block = true, .jump = true, .travel = { 0.3, -0.2, 0.2 }
    };
    double seen = 0, fresh = 0;
    shot before = radiance, after = radiance;
    before.time = 0.4;
    before.step = 0.2 / 3;
    before.frames = 4; // at 0.4, 0.47, 0.53, 0.6 s; it jumps at 0.5
    after.time = 0.6;
    fg_status status = stability_figure(s, &what, before, stability_mean, &seen);
    if (status == FG_OK)
        status = stability_figure(s, &what, after, stability_mean, &fresh);
    *out = stability_change(seen, fresh);
    return status;
}

// With small shadow maps: all that is written is read in every frame.
static fg_status still(stability *s, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    shot first = radiance, last = radiance;
    double a = 0, b = 0;
    setting own;
    fg_status status = stability_with_known(s, "max_lights=64 map_size=32", &own);
    first.width = first.height = last.width = last.height = 16;
    first.values = last.values = own.values;
    last.frames = s->frames;
    if (status == FG_OK)
        status = stability_figure(s, &what, first, stability_mean, &a);
    if (status == FG_OK)
        status = stability_figure(s, &what, last, stability_mean, &b);
    *out = stability_change(b, a);
    setting_finish(&own);
    return status;
}

// Refused with a message is as good as drawn.
static fg_status spot_of(stability *s, double degrees, double *out)
{
    ag_light lamp = stability_lamp();
    lamp.cos_outer = (float) cos(0.5 * degrees * M_PI / 180);
    lamp.cos_inner = 1;
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    const fg_status status = stability_checks(s, &what, radiance, out);
    return status != FG_OK && s->error[0] ? FG_OK : status;
}

static fg_status spot_0(stability *s, double *out)
{
    return spot_of(s, 0, out);
}

static fg_status spot_180(stability *s, double *out)
{
    return spot_of(s, 180, out);
}

static fg_status spot_270(stability *s, double *out)
{
    return spot_of(s, 270, out);
}

// ---- rows 25 and 26 --------------------------------------------------------------------------

static fg_status lit_room(stability *s, shot view, stability_figure_fn figure, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    return stability_figure(s, &what, view, figure, out);
}

static fg_status odd_sizes(stability *s, double *out)
{
    static const int sizes[] = { 255, 257 };
    double base = 0;
    shot view = radiance;
    view.width = view.height = 256;
    fg_status status = lit_room(s, view, stability_mean, &base);
    *out = 0;
    for (int i = 0; i < FG_COUNT(sizes) && status == FG_OK; ++i) {
        double mean = 0;
        view.width = view.height = sizes[i];
        status = lit_room(s, view, stability_mean, &mean);
        *out = fmax(*out, stability_change(mean, base));
    }
    return status;
}

static fg_status thin_sizes(stability *s, double *out)
{
    static const int sizes[][2] = { { 1, 1 }, { 1, 257 },  { 2, 2 },
                                    { 3, 5 }, { 1000, 3 }, { 4096, 1 } };
    fg_status status = FG_OK;
    for (int i = 0; i < FG_COUNT(sizes) && status == FG_OK; ++i) {
        shot view = radiance;
        view.width = sizes[i][0];
        view.height = sizes[i][1];
        status = lit_room(s, view, stability_most, out);
    }
    *out = (double) s->bad;
    return status;
}

// What must be refused: 0 if it was, with a message.
static fg_status refused(const stability *s, fg_status status, double *out)
{
    *out = status == FG_OK || !s->error[0];
    return FG_OK;
}

static fg_status huge_size(stability *s, double *out)
{
    shot view = radiance;
    double unused = 0;
    view.width = view.height = 1 << 20;
    return refused(s, lit_room(s, view, stability_most, &unused), out);
}

// Means of the picture by the number of VPLs, over that of the most.
static fg_status vpl_counts(stability *s, double *out)
{
    static const int counts[] = { 65536, 257, 256, 255, 3, 2, 1 };
    const int row = stability_find_vpls(s->setting->plugin);
    setting own;
    double most = 0;
    fg_status status = FG_OK;
    if (row < 0)
        return FG_ERR_UNSUPPORTED;
    if (!setting_copy(s->setting, &own))
        return FG_ERR_MEMORY;
    *out = 0;
    for (int i = 0; i < FG_COUNT(counts) && status == FG_OK; ++i) {
        const double most_allowed = own.plugin->params[row].max;
        shot view = indirect;
        double mean = 0;
        own.values[row].i = counts[i] < most_allowed ? counts[i] : (int64_t) most_allowed;
        view.width = view.height = 16;
        view.values = own.values;
        status = lit_room(s, view, stability_mean, &mean);
        if (i == 0)
            most = mean;
        else if (counts[i] >= 255)
            *out = fmax(*out, stability_change(mean, most));
    }
    setting_finish(&own);
    return status;
}

// ---- rows 29, 30 -----------------------------------------------------------------------------

static fg_status empty_scene(stability *s, double *out)
{
    ag_builder *b = ag_builder_create(&s->log, "empty");
    shot view = radiance;
    image img = { 0 };
    if (!b)
        return FG_ERR_MEMORY;
    fg_status status = ag_scene_build(b, &view.scene);
    ag_builder_destroy(b);
    if (status == FG_OK)
        status = stability_render(s, &view, &img);
    if (status == FG_OK)
        *out = stability_most(&img);
    image_finish(&img);
    ag_scene_destroy(view.scene);
    return status;
}

static fg_status field(stability *s, int count, int cells, double *out)
{
    shot view = radiance;
    image img = { 0 };
    view.width = view.height = 32;
    fg_status status = stability_field(&s->log, count, cells, &view.scene);
    if (status == FG_OK)
        status = stability_render(s, &view, &img);
    *out = (double) s->bad;
    image_finish(&img);
    ag_scene_destroy(view.scene);
    return status;
}

static fg_status two_triangles(stability *s, double *out)
{
    return field(s, 1, 1, out);
}

static fg_status million_triangles(stability *s, double *out)
{
    return field(s, 1, 708, out); // 2 x 708^2
}

static fg_status many_objects(stability *s, double *out)
{
    return field(s, 10000, 1, out);
}

static fg_status with_camera(stability *s, const ag_camera *camera, double *out)
{
    shot view = radiance;
    view.camera = camera;
    const fg_status status = lit_room(s, view, stability_most, out);
    *out = (double) s->bad;
    return status;
}

static ag_camera camera_at(double x, double y, double z, double degrees)
{
    ag_camera camera = { .yfov = (float) (degrees * M_PI / 180), .znear = 1e-3f };
    for (int i = 0; i < 4; ++i)
        camera.world[5 * (size_t) i] = 1;
    camera.world[12] = x;
    camera.world[13] = y;
    camera.world[14] = z;
    return camera;
}

static fg_status camera_in_wall(stability *s, double *out)
{
    const ag_camera camera = camera_at(0.5, 0, 0, 60);
    return with_camera(s, &camera, out);
}

static fg_status wide_camera(stability *s, double *out)
{
    const ag_camera camera = camera_at(0, 0, 0.4, 179);
    return with_camera(s, &camera, out);
}

static fg_status flat_camera(stability *s, double *out)
{
    const ag_camera camera = camera_at(0, 0, 0.4, 180);
    return refused(s, with_camera(s, &camera, out), out);
}

static fg_status orthographic(stability *s, double *out)
{
    ag_camera camera = camera_at(0, 0, 0.4, 60);
    camera.orthographic = true;
    camera.half_height = 0.6f;
    camera.zfar = 2;
    return with_camera(s, &camera, out);
}

// Refused or a plane's worth of nothing: no more than that it is defined.
static fg_status near_is_far(stability *s, double *out)
{
    ag_camera camera = camera_at(0, 0, 0.4, 60);
    camera.orthographic = true;
    camera.half_height = 0.6f;
    camera.znear = camera.zfar = 1;
    const fg_status status = with_camera(s, &camera, out);
    return status != FG_OK && s->error[0] ? FG_OK : status;
}

// ---- rows 34, 35 -----------------------------------------------------------------------------

// A folder in which the tone curve's shader is no shader.
static fg_status broken_shader(stability *s, double *out)
{
    char folder[] = "/tmp/afterglow-XXXXXX", path[128], parents[64];
    const char text[] = "#version 450 core\nthis is no shader\n";
    fg_device *device = NULL, *own = s->device;
    double unused = 0;
    if (!mkdtemp(folder))
        return FG_ERR_IO;
    snprintf(parents, sizeof parents, "%s/passes/post", folder);
    snprintf(path, sizeof path, "%s/tone.frag", parents);
    fg_status status = file_make_folder(&s->log, parents);
    if (status == FG_OK)
        status = file_write(&s->log, path, text, sizeof text - 1);
    if (status == FG_OK)
        status = fg_gl_device_create(&(fg_gl_device_desc){ .log = &s->log, .shader_dir = folder },
                                     &device);
    if (status == FG_OK) {
        s->device = device;
        status = refused(s, lit_room(s, (shot){ 0 }, stability_most, &unused), out);
        s->device = own;
    }
    fg_device_destroy(device);
    unlink(path);
    rmdir(parents);
    snprintf(path, sizeof path, "%s/passes", folder);
    rmdir(path);
    rmdir(folder);
    return status;
}

static fg_status same_as_plain(stability *s, unsigned debug, double *out)
{
    const ag_light lamp = stability_lamp();
    const room what = { .lights = &lamp, .light_count = 1, .block = true };
    image a = { 0 }, b = { 0 };
    shot view = radiance;
    fg_status status = stability_shoot(s, &what, view, &a);
    view.debug = debug;
    if (status == FG_OK)
        status = stability_shoot(s, &what, view, &b);
    if (status == FG_OK)
        *out = (double) stability_differing(&a, &b);
    image_finish(&a);
    image_finish(&b);
    return status;
}

static fg_status same_twice(stability *s, double *out)
{
    return same_as_plain(s, 0, out);
}

static fg_status same_unshared(stability *s, double *out)
{
    return same_as_plain(s, FG_DEBUG_NO_SHARING, out);
}

static fg_status same_reordered(stability *s, double *out)
{
    return same_as_plain(s, FG_DEBUG_RANDOM_ORDER, out);
}

// ---- the table -------------------------------------------------------------------------------

static const char bad_values[] = "values that are not finite or negative light";
static const char brightest[] = "brightest value";
static const char change_of_mean[] = "relative change of the mean";
static const char differing_values[] = "values that differ";
static const char not_refused[] = "0: refused with a message";

const stability_case stability_frame_cases[] = {
    { 17, "emissive_alone", bad_values, 0, NULL, 0, emissive_alone },
    { 17, "no_light", brightest, 0, NULL, 0, no_light },
    { 17, "black_room", brightest, 0, NULL, 0, black_room },
    { 19, "light_jumps", "relative error of the mean, second frame after", 0.05, NULL, 0,
      teleport },
    { 20, "nothing_moves", "relative drift of the mean", 1e-6, NULL, 0, still },
    { 21, "spot_of_0_degrees", bad_values, 0, NULL, 0, spot_0 },
    { 21, "spot_of_180_degrees", bad_values, 0, NULL, 0, spot_180 },
    { 21, "spot_of_270_degrees", bad_values, 0, NULL, 0, spot_270 },
    { 25, "255_and_257_pixels", change_of_mean, 0.01, NULL, 0, odd_sizes },
    { 25, "thin_pictures", bad_values, 0, NULL, 0, thin_sizes },
    { 25, "a_million_pixels_wide", not_refused, 0, NULL, 0, huge_size },
    { 26, "vpl_counts", "relative error of the mean from 255 VPLs on", 0.1,
      "the regular pattern takes the power of four below: 64 for 255", 0.5, vpl_counts },
    { 29, "empty_scene", brightest, 0, NULL, 0, empty_scene },
    { 29, "two_triangles", bad_values, 0, NULL, 0, two_triangles },
    { 29, "a_million_triangles", bad_values, 0, NULL, 0, million_triangles },
    { 29, "ten_thousand_objects", bad_values, 0, NULL, 0, many_objects },
    { 30, "camera_in_a_wall", bad_values, 0, NULL, 0, camera_in_wall },
    { 30, "view_of_179_degrees", bad_values, 0, NULL, 0, wide_camera },
    { 30, "view_of_180_degrees", not_refused, 0, NULL, 0, flat_camera },
    { 30, "orthographic", bad_values, 0, NULL, 0, orthographic },
    { 30, "near_is_far", bad_values, 0, NULL, 0, near_is_far },
    { 34, "shader_does_not_compile", not_refused, 0, NULL, 0, broken_shader },
    { 35, "same_frame_twice", differing_values, 0, NULL, 0, same_twice },
    { 35, "memory_not_shared", differing_values, 0, NULL, 0, same_unshared },
    { 35, "other_legal_order", differing_values, 0, NULL, 0, same_reordered },
    { 0 },
};
