// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include "record.h"
#include "ui_bridge.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

// ---- messages --------------------------------------------------------------------------------

static void show(view *v, fg_log_level level, const char *text)
{
    if (level <= FG_LOG_WARN)
        cli_warn("%s", text);
    else if (v->h->c->verbose)
        fprintf(stderr, "afterglow: %s\n", text);
    if (level <= FG_LOG_INFO)
        view_messages_add(&v->messages, level, v->now, text);
}

// The libraries' messages: what goes wrong while the window is open ends no process. What they
// have to tell besides is for stderr alone.
static void receive(void *user, fg_log_level level, const char *text)
{
    show(user, level <= FG_LOG_WARN ? level : FG_LOG_DEBUG, text);
}

void view_say(view *v, fg_log_level level, const char *fmt, ...)
{
    char text[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    show(v, level, text);
}

// ---- camera ----------------------------------------------------------------------------------

void view_follow_camera(view *v, int index)
{
    v->camera_index = index;
    v->camera.orbiting = false;
    view_say(v, FG_LOG_DEBUG, "camera %s", v->h->scene->cameras[index].name);
}

void view_own_camera(view *v)
{
    if (v->camera_index < 0)
        return;
    view_camera_take(&v->camera, &v->h->scene->cameras[v->camera_index]);
    v->camera_index = -1;
    view_say(v, FG_LOG_DEBUG, "camera free");
}

// Where the camera of the next frame stands.
static ag_camera camera_now(const view *v)
{
    return v->camera_index >= 0 ? v->h->scene->cameras[v->camera_index]
                                : view_camera_get(&v->camera);
}

static bool create_cameras(view *v)
{
    const ag_scene *scene = v->h->scene;
    v->camera_names = calloc((size_t) scene->camera_count + 1, sizeof *v->camera_names);
    if (!v->camera_names)
        return false;
    for (int i = 0; i < scene->camera_count; ++i)
        v->camera_names[i] = scene->cameras[i].name[0] ? scene->cameras[i].name : "(no name)";
    v->camera_names[scene->camera_count] = "free";
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const double side = scene->box_max[i] - scene->box_min[i];
        sum += side > 0 ? side * side : 0;
    }
    v->camera.speed = sum > 0 ? sqrt(sum) / 12 : 1; // twelve seconds from end to end
    v->camera.distance = 1;
    const ag_camera first = host_camera(v->h);
    view_camera_take(&v->camera, &first);
    v->camera_index = v->h->has_camera ? -1 : v->h->camera_index;
    return true;
}

static void move_camera(view *v, double seconds)
{
    const view_input *in = &v->window.in;
    const bool turns = in->dx != 0 || in->dy != 0;
    const bool wheels = in->wheel != 0;
    if (!turns && !wheels && !(in->moves & ~(unsigned) VIEW_MOVE_FAST))
        return;
    if (!wheels || turns || v->camera.orbiting)
        view_own_camera(v); // the wheel alone sets how fast one would fly
    // Half a turn over the height of the window; in orbit the scene is what is dragged.
    const double angle = M_PI / (v->window.height > 0 ? v->window.height : 1);
    if (turns)
        view_camera_turn(&v->camera, -in->dx * angle,
                         (v->camera.orbiting ? 1 : -1) * in->dy * angle);
    if (wheels)
        view_camera_wheel(&v->camera, in->wheel);
    view_camera_move(&v->camera, in->moves, seconds < 0.1 ? seconds : 0.1);
}

// ---- a frame ---------------------------------------------------------------------------------

void view_frame_size(const view *v, int size[2])
{
    const int up = (1 << v->scale_log2) - 1;
    size[0] = (v->window.width + up) >> v->scale_log2;
    size[1] = (v->window.height + up) >> v->scale_log2;
}

// A plugin that fails the renderer drops by itself; a layer that is not there the viewer.
static fg_status render(view *v, double seconds)
{
    fg_status status = view_gi_layers(v);
    if (status == FG_OK)
        status = renderer_frame(v->r, seconds);
    if (status == FG_OK || status == FG_ERR_DEVICE || v->shown == LAYER_FINAL)
        return status;
    view_layer_set(v, LAYER_FINAL);
    status = view_gi_layers(v);
    return status == FG_OK ? renderer_frame(v->r, seconds) : status;
}

static fg_status present(view *v, const ag_camera *camera)
{
    const bool split = v->gi.shows_split;
    view_present_desc desc = {
        .left = { renderer_texture(v->r, v->shown), v->shown < LAYER_PLUGIN },
        .width = v->window.width,
        .height = v->window.height,
        .divider = split ? v->gi.divider : 1,
        .data = host_layer_kind(v->shown) == IMAGE_DATA,
    };
    if (!desc.left.texture && v->shown >= LAYER_PLUGIN)
        view_layer_set(v, LAYER_FINAL); // its plugin was dropped: from the next frame on
    if (split)
        desc.right = (view_picture){ renderer_second_texture(v->r, v->gi.second),
                                     v->gi.second < LAYER_PLUGIN };
    if (v->shown == LAYER_POSITION)
        memcpy(desc.origin, camera->world + 12, sizeof desc.origin);
    return view_present(&v->presenter, v->h->device, &desc);
}

static fg_status draw_scene(view *v)
{
    const double seconds = view_clock_seconds(&v->clock);
    int size[2];
    view_frame_size(v, size);
    if (v->h->scene->time != seconds)
        ag_scene_set_time(v->h->scene, seconds); // the camera that is followed stands there, too
    const ag_camera camera = camera_now(v);
    renderer_set_camera(v->r, &camera);
    fg_status status = renderer_set_exposure(v->r, (float) v->exposure);
    if (status == FG_OK)
        status = renderer_resize(v->r, size[0], size[1]);
    if (size[0] != v->size[0] || size[1] != v->size[1])
        view_say(v, FG_LOG_DEBUG, "size %d x %d", size[0], size[1]);
    if (size[0] != v->size[0] || size[1] != v->size[1])
        trace_mark(v->events, "resized");
    memcpy(v->size, size, sizeof size);
    const double begin = now_ms();
    if (status == FG_OK)
        status = render(v, seconds);
    if (status != FG_OK)
        return status;
    view_stats_take(v, now_ms() - begin);
    trace_frame(v->events, v->r);
    return present(v, &camera);
}

static void draw_ui(view *v)
{
    ui_frame_begin();
    view_messages_age(&v->messages, v->now);
    view_panel(v);
    view_graph_panel(v);
    ui_frame_end();
}

static void drag_divider(view *v)
{
    const view_input *in = &v->window.in;
    const double at = v->gi.divider * v->window.width;
    if (v->gi.shows_split && in->left_pressed &&
        fabs(in->press_x - at) < 8 * (double) v->window.scale)
        v->dragging = true;
    if (v->dragging && v->window.width > 0)
        v->gi.divider = fmax(0.02, fmin(0.98, in->x / v->window.width));
    v->dragging = v->dragging && in->left && v->gi.shows_split;
}

static void report_first(view *v)
{
    const double ms = now_ms() - v->start->started_ms;
    if (v->frames == 1)
        view_say(v, FG_LOG_DEBUG, "first frame after %.0f ms", ms);
    if (!v->gi.ready && !v->gi.wanted) {
        view_say(v, FG_LOG_DEBUG, "first frame with %s after %.0f ms", view_gi_name(v, 0), ms);
        v->gi.ready = true;
    }
}

static fg_status frame(view *v, double seconds)
{
    move_camera(v, seconds);
    drag_divider(v);
    for (int i = 0; i < v->window.in.action_count; ++i)
        view_do(v, v->window.in.actions[i]);
    view_gi_watch(v);
    if (v->gi.wanted && v->gi.said)
        view_gi_apply(v);
    else if (v->gi.ready)
        view_clock_advance(&v->clock, seconds);
    const fg_status status = draw_scene(v);
    if (status != FG_OK)
        return status;
    v->gi.said = v->gi.wanted != 0;
    draw_ui(v);
    if (v->window_shot)
        view_shoot_window(v);
    v->window_shot = false;
    view_window_show(&v->window);
    ++v->frames;
    report_first(v);
    return FG_OK;
}

// ---- the loop --------------------------------------------------------------------------------

// How long to wait for something to happen: nobody looks at a window without the focus closely,
// and nobody at all at one that is minimised.
static double idle(const view *v)
{
    if (v->window.width < 1 || v->window.height < 1)
        return 0.25;
    const bool hurries = v->window.focused || v->h->o->frames || v->gi.wanted;
    return hurries ? 0 : 0.2;
}

static int loop(view *v)
{
    double last = now_ms();
    fg_status status = FG_OK;
    while (status == FG_OK && view_window_poll(&v->window, idle(v)) && !v->quit) {
        const double now = now_ms(), ms = now - last;
        last = now;
        v->now = (now - v->start->started_ms) * 1e-3;
        if (v->window.scale_changed)
            ui_set_scale(v->window.scale);
        if (v->window.width < 1 || v->window.height < 1)
            continue;
        if (v->frames > 0)
            view_history_add(&v->stats.frames, ms);
        status = frame(v, ms * 1e-3);
        v->quit = v->quit || (v->h->o->frames && v->frames >= v->h->o->frames);
    }
    if (status != FG_OK)
        return cli_fail(v->h->c, EXIT_FAILED, "view: the frame failed: %s",
                        v->messages.count ? v->messages.list[0].text : fg_status_name(status));
    const int errors = fg_gl_error_count(v->h->device);
    view_say(v, FG_LOG_DEBUG, "%lld frames, %d OpenGL errors", (long long) v->frames, errors);
    return errors ? cli_fail(v->h->c, EXIT_FAILED, "view: %d OpenGL errors", errors) : EXIT_DONE;
}

// ---- life ------------------------------------------------------------------------------------

static fg_status open_window(view *v)
{
    const options *o = v->h->o;
    const view_window_desc desc = {
        .log = &v->h->c->log,
        .title = "afterglow",
        .width = o->width ? o->width : 1280,
        .height = o->height ? o->height : 720,
        .debug = o->debug || o->verbose,
        .enlarge = !o->width,
        .unthrottled = o->frames > 0,
    };
    return view_window_open(&v->window, &desc);
}

static fg_status open_renderer(view *v)
{
    const setting none = { 0 };
    int size[2];
    view_frame_size(v, size);
    const ag_camera camera = camera_now(v);
    renderer_desc desc =
        host_renderer_desc(v->h, &none, size[0] > 0 ? size[0] : 1, size[1] > 0 ? size[1] : 1);
    desc.camera = &camera;
    return renderer_create(&desc, &v->r);
}

// Everything that needs the context of the window.
static int open_screen(view *v)
{
    const options *o = v->h->o;
    const int code = host_take_context(v->h);
    if (code != EXIT_DONE)
        return code;
    v->ui = true;
    if (!ui_create(v->window.handle))
        return cli_fail(v->h->c, EXIT_FAILED,
                        "view: the panel cannot start: OpenGL cannot be loaded");
    ui_set_scale(v->window.scale);
    view_presenter_create(&v->presenter);
    v->scale_log2 = o->render_scale ? o->render_scale / 2 : fg_gl_software(v->h->device) ? 1 : 0;
    if (v->start->count)
        v->layer = v->start->settings[0].layer;
    return cli_status(v->h->c, open_renderer(v));
}

static int open_all(view *v)
{
    cli *c = v->h->c;
    const char *path = v->start->params;
    view_set set = { 0 };
    if (!view_gi_create(v) || !create_cameras(v))
        return cli_status(c, FG_ERR_MEMORY);
    fg_status status = trace_create(&c->log, v->h->o->trace, &v->events);
    if (status == FG_OK && path)
        status = view_set_load(&c->log, path, &set);
    if (status == FG_OK)
        status = open_window(v);
    int code = status == FG_OK ? open_screen(v) : cli_status(c, status);
    if (code == EXIT_DONE && path)
        code = cli_status(c, view_take_set(v, path, &set));
    view_set_finish(&set);
    return code;
}

// The trace is there where the window was closed, not where it failed.
static int close_all(view *v, int code)
{
    const fg_status status = trace_finish(v->events, v->h->device, v->r, code == EXIT_DONE);
    if (code == EXIT_DONE)
        code = cli_status(v->h->c, status);
    renderer_destroy(v->r);
    view_presenter_finish(&v->presenter);
    if (v->ui)
        ui_destroy();
    host_drop_device(v->h); // while the window's context is there
    view_window_close(&v->window);
    view_gi_finish(v);
    view_graph_finish(&v->graph);
    free(v->camera_names);
    return code;
}

int view_run(host *h, const view_start *start)
{
    view v = {
        .h = h,
        .start = start,
        .clock = { .stepped = h->o->frames > 0 },
        .exposure = (double) h->o->exposure,
        .panel = true,
    };
    const fg_log before = h->c->log;
    snprintf(v.shot_dir, sizeof v.shot_dir, "%s", h->o->output ? h->o->output : ".");
    if (start->params)
        snprintf(v.params_path, sizeof v.params_path, "%s", start->params);
    else
        snprintf(v.params_path, sizeof v.params_path, "%s/view.json", v.shot_dir);
    v.log = before; // up to the first frame a failure is one
    int code = open_all(&v);
    if (code == EXIT_DONE) {
        v.log = h->c->log = (fg_log){ receive, &v, before.level };
        code = loop(&v);
        h->c->log = before;
    }
    return close_all(&v, code);
}
