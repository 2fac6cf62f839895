// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Parameter sets and pictures: what the viewer writes and reads.

// ---- parameter sets --------------------------------------------------------------------------

static void take_side(view *v, int side, view_set_side *out)
{
    const setting *s = view_gi_setting(v, side);
    snprintf(out->plugin, sizeof out->plugin, "%s", view_gi_name(v, side));
    if (s->plugin)
        out->params = view_set_params(s->plugin, s->values);
}

static view_set current_set(view *v)
{
    view_set s = { .exposure = v->exposure };
    snprintf(s.scene, sizeof s.scene, "%.63s", v->h->scene_name);
    take_side(v, 0, &s.sides[0]);
    if (v->gi.split) {
        take_side(v, 1, &s.sides[1]);
        s.divider = v->gi.divider;
    }
    char name[VIEW_NAME];
    snprintf(s.layer, sizeof s.layer, "%s", view_layer_name(v, (int) v->layer, name, sizeof name));
    if (v->camera_index >= 0) {
        snprintf(s.camera, sizeof s.camera, "%s", v->h->scene->cameras[v->camera_index].name);
        if (s.camera[0])
            return s;
    }
    view_camera c = v->camera;
    if (v->camera_index >= 0)
        view_camera_take(&c, &v->h->scene->cameras[v->camera_index]);
    s.has_pose = true;
    memcpy(s.eye, c.eye, sizeof s.eye);
    s.yaw = c.yaw * 180 / M_PI;
    s.pitch = c.pitch * 180 / M_PI;
    s.yfov = (double) c.lens.yfov * 180 / M_PI;
    return s;
}

void view_save_set(view *v)
{
    view_set s = current_set(v);
    if (view_set_save(&v->log, v->params_path, &s) == FG_OK)
        view_say(v, FG_LOG_INFO, "saved %s", v->params_path);
    view_set_finish(&s);
}

// A set is taken whole or not at all: everything that can be refused comes first.
typedef struct checked {
    int slot[2];
    gi_value *values[2]; // owned
    int camera, layer;   // -1: not said
} checked;

static fg_status refuse(view *v, const char *path, const char *what, const char *name)
{
    fg_logf(&v->log, FG_LOG_ERROR, "%s: there is no %s '%s' here", path, what, name);
    return FG_ERR_INPUT;
}

static fg_status check_side(view *v, const char *path, const view_set_side *side, int i,
                            checked *out)
{
    out->slot[i] = -1;
    if (!side->plugin[0])
        return FG_OK;
    const int slot = view_gi_find(v, side->plugin);
    if (slot < 0 || !view_gi_load(v, slot))
        return refuse(v, path, "plugin", side->plugin);
    out->slot[i] = slot;
    setting copy;
    if (!setting_copy(&v->gi.slots[slot].sides[i], &copy))
        return FG_ERR_MEMORY;
    out->values[i] = copy.values;
    return copy.plugin ? view_set_values(&v->log, path, side->params, copy.plugin, out->values[i])
                       : FG_OK;
}

static int find_layer(const gi_plugin *p, const char *name)
{
    const size_t length = p ? strlen(p->name) : 0;
    for (int i = 0; i < LAYER_COUNT; ++i)
        if (!strcmp(name, renderer_layer_names[i]))
            return i;
    for (int i = 0; p && i < gi_layers_count(p); ++i)
        if (!strncmp(name, p->name, length) && name[length] == '.' &&
            !strcmp(name + length + 1, p->layers[i].name))
            return LAYER_COUNT + i;
    return -1;
}

static fg_status check_set(view *v, const char *path, const view_set *s, checked *out)
{
    fg_status status = FG_OK;
    for (int i = 0; i < 2 && !status; ++i)
        status = check_side(v, path, &s->sides[i], i, out);
    if (status)
        return status;
    const int shown = out->slot[0] >= 0 ? out->slot[0] : v->gi.side[0];
    out->layer = s->layer[0] ? find_layer(v->gi.slots[shown].sides[0].plugin, s->layer) : -1;
    out->camera = s->camera[0] ? ag_scene_find_camera(v->h->scene, s->camera) : -1;
    if (s->layer[0] && out->layer < 0)
        return refuse(v, path, "layer", s->layer);
    if (s->camera[0] && out->camera < 0)
        return refuse(v, path, "camera", s->camera);
    return FG_OK;
}

static void take_camera(view *v, const view_set *s, int index)
{
    if (index >= 0)
        view_follow_camera(v, index);
    if (!s->has_pose)
        return;
    view_own_camera(v);
    memcpy(v->camera.eye, s->eye, sizeof s->eye);
    v->camera.orbiting = false;
    v->camera.yaw = s->yaw * M_PI / 180;
    v->camera.pitch = s->pitch * M_PI / 180;
    v->camera.lens.orthographic = false;
    v->camera.lens.yfov = (float) (s->yfov * M_PI / 180);
}

static void take_checked(view *v, const view_set *s, checked *c)
{
    for (int i = 0; i < 2; ++i) {
        if (c->slot[i] < 0)
            continue;
        setting *kept = &v->gi.slots[c->slot[i]].sides[i];
        gi_value *old = kept->values;
        kept->values = c->values[i];
        c->values[i] = old;
        v->gi.side[i] = c->slot[i];
    }
    if (s->sides[0].plugin[0])
        v->gi.split = s->sides[1].plugin[0] != 0;
    if (s->divider > 0)
        v->gi.divider = s->divider;
    if (s->exposure > 0)
        v->exposure = s->exposure;
    if (c->layer >= 0)
        view_layer_set(v, (renderer_layer) c->layer);
    take_camera(v, s, c->camera);
    view_gi_touch(v, 3);
}

fg_status view_take_set(view *v, const char *path, const view_set *s)
{
    checked c = { .slot = { -1, -1 } };
    const fg_status status = check_set(v, path, s, &c);
    if (!status)
        take_checked(v, s, &c);
    free(c.values[0]);
    free(c.values[1]);
    return status;
}

void view_load_set(view *v)
{
    view_set s;
    if (view_set_load(&v->log, v->params_path, &s) == FG_OK &&
        view_take_set(v, v->params_path, &s) == FG_OK)
        view_say(v, FG_LOG_INFO, "loaded %s", v->params_path);
    view_set_finish(&s);
}

// ---- pictures --------------------------------------------------------------------------------

// The first name that is free: DIR/SCENE-PLUGIN-0001.png.
static void shot_path(view *v, const char *kind, char *path, size_t size)
{
    const char *scene = strrchr(v->h->scene_name, '/');
    scene = scene ? scene + 1 : v->h->scene_name;
    do {
        snprintf(path, size, "%s/%.60s-%s-%04d%s.png", v->shot_dir, scene, view_gi_name(v, 0),
                 ++v->shots, kind);
    } while (access(path, F_OK) == 0 && v->shots < 9999);
}

static void write_shot(view *v, const char *path, image *picture, image_kind kind)
{
    if (image_write(&v->log, path, picture, kind) == FG_OK)
        view_say(v, FG_LOG_INFO, "wrote %s", path);
    image_finish(picture);
}

void view_shoot_frame(view *v)
{
    char path[1200];
    image picture = { 0 };
    if (renderer_read(v->r, v->shown, &picture) != FG_OK)
        return;
    shot_path(v, "", path, sizeof path);
    write_shot(v, path, &picture, host_layer_kind(v->shown));
}

void view_shoot_window(view *v)
{
    char path[1200];
    image picture = { 0 };
    if (view_present_read(&v->log, v->window.width, v->window.height, &picture) != FG_OK)
        return;
    shot_path(v, "-window", path, sizeof path);
    write_shot(v, path, &picture, IMAGE_DATA);
}
