// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include <math.h>

static void next_camera(view *v)
{
    const int count = v->h->scene->camera_count;
    if (count > 0)
        view_follow_camera(v, (v->camera_index + 1) % count);
    else
        view_say(v, FG_LOG_WARN, "the scene has no cameras");
}

static void toggle_orbit(view *v)
{
    view_own_camera(v);
    if (v->camera.orbiting) {
        v->camera.orbiting = false;
        return;
    }
    const ag_camera camera = view_camera_get(&v->camera);
    const double distance = view_camera_pick(v->h->scene, &camera);
    if (distance > 0)
        view_camera_orbit(&v->camera, distance);
    else
        view_say(v, FG_LOG_WARN, "nothing is in the middle to turn around");
}

static void expose(view *v, double thirds)
{
    v->exposure = fmax(1e-9, fmin(1e9, v->exposure * pow(2, thirds / 3)));
}

static void rescale(view *v, int step)
{
    const int scale = v->scale_log2 + step;
    v->scale_log2 = scale < 0 ? 0 : scale > 2 ? 2 : scale;
}

static void next_layer(view *v, int step)
{
    const int count = view_layer_count(v);
    view_layer_set(v, (renderer_layer) (((int) v->layer + step + count) % count));
}

static void restart(view *v)
{
    view_clock_reset(&v->clock);
    fg_status status = renderer_set_plugin(v->r, NULL, NULL);
    if (status == FG_OK)
        status = renderer_set_split(v->r, NULL);
    v->gi.shows_split = false;
    if (status == FG_OK)
        view_gi_nudge(v, v->gi.split ? 3 : 1); // its shaders are there: in this very frame
}

static void close_all(view *v)
{
    v->help = v->graph.shown = false;
    view_window_capture(&v->window, false);
}

static void do_gi(view *v, view_action action)
{
    switch (action) {
    case VIEW_NEXT_PLUGIN: view_gi_next(v, 0, 1); break;
    case VIEW_PREVIOUS_PLUGIN: view_gi_next(v, 0, -1); break;
    case VIEW_NEXT_SECOND: view_gi_next(v, 1, 1); break;
    case VIEW_PREVIOUS_SECOND: view_gi_next(v, 1, -1); break;
    case VIEW_SPLIT: view_gi_split(v, !v->gi.split); break;
    case VIEW_NEXT_LAYER: next_layer(v, 1); break;
    case VIEW_PREVIOUS_LAYER: next_layer(v, -1); break;
    default: break;
    }
}

static void do_view(view *v, view_action action)
{
    switch (action) {
    case VIEW_PAUSE: v->clock.paused = !v->clock.paused; break;
    case VIEW_STEP: view_clock_step(&v->clock); break;
    case VIEW_RESET: restart(v); break;
    case VIEW_NEXT_CAMERA: next_camera(v); break;
    case VIEW_ORBIT: toggle_orbit(v); break;
    case VIEW_CAPTURE: view_window_capture(&v->window, !v->window.captured); break;
    case VIEW_BRIGHTER: expose(v, 1); break;
    case VIEW_DARKER: expose(v, -1); break;
    case VIEW_COARSER: rescale(v, 1); break;
    case VIEW_FINER: rescale(v, -1); break;
    default: do_gi(v, action); break;
    }
}

void view_do(view *v, view_action action)
{
    switch (action) {
    case VIEW_HELP: v->help = !v->help; break;
    case VIEW_PANEL: v->panel = !v->panel; break;
    case VIEW_GRAPH: v->graph.shown = !v->graph.shown; break;
    case VIEW_SHOT: view_shoot_frame(v); break;
    case VIEW_WINDOW_SHOT: v->window_shot = true; break;
    case VIEW_SAVE: view_save_set(v); break;
    case VIEW_LOAD: view_load_set(v); break;
    case VIEW_CLOSE: close_all(v); break;
    case VIEW_QUIT: v->quit = true; break;
    default: do_view(v, action); break;
    }
}
