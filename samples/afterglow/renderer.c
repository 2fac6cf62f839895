// SPDX-License-Identifier: MIT
#include "renderer_priv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const renderer_layer_names[LAYER_COUNT] = {
    "final", "radiance", "direct", "indirect", "albedo", "normal", "position",
};

// ---- what is said ----------------------------------------------------------------------------

// While a frame is tried an error may be a plugin's, which is no error of the frame.
static void hear(void *user, fg_log_level level, const char *msg)
{
    renderer *r = user;
    if (level == FG_LOG_ERROR && !r->heard[0])
        snprintf(r->heard, sizeof r->heard, "%s", msg);
    fg_logf(r->desc.log, level == FG_LOG_ERROR && r->trying ? FG_LOG_INFO : level, "%s", msg);
}

static fg_status refuse(const renderer_desc *desc, const char *what)
{
    fg_logf(desc->log, FG_LOG_ERROR, "renderer: %s", what);
    return FG_ERR_INVALID;
}

static fg_status out_of_memory(const renderer_desc *desc)
{
    fg_logf(desc->log, FG_LOG_ERROR, "renderer: out of memory");
    return FG_ERR_MEMORY;
}

static void note_fault(renderer *r, const gi_plugin *plugin, const char *where, const char *why)
{
    snprintf(r->fault, sizeof r->fault, "plugin '%s' failed %s: %s", plugin->name, where, why);
}

// ---- life ------------------------------------------------------------------------------------

static fg_status check(const renderer_desc *desc)
{
    if (!desc->device || !desc->scene)
        return refuse(desc, "needs a device and a scene");
    if (desc->width < 1 || desc->height < 1)
        return refuse(desc, "the size must be at least 1 x 1");
    if (desc->layers >> LAYER_END)
        return refuse(desc, "there is no such layer");
    if (!(desc->exposure >= 0))
        return refuse(desc, "exposure must not be negative");
    if (!desc->camera && desc->camera_index != 0 &&
        (desc->camera_index < 0 || desc->camera_index >= desc->scene->camera_count))
        return refuse(desc, "there is no camera of that index");
    return FG_OK;
}

static void choose_camera(renderer *r)
{
    const ag_scene *scene = r->desc.scene;
    r->follows = !r->desc.camera && scene->camera_count > 0;
    if (r->desc.camera)
        r->camera = *r->desc.camera;
    else if (!r->follows)
        r->camera = ag_scene_framing_camera(scene);
}

static fg_status create_parts(renderer *r)
{
    const renderer_desc *d = &r->desc;
    const ag_gpu_scene_desc gpu = {
        .log = d->log,
        .device = d->device,
        .scene = d->scene,
        .features = d->needs_all ? ~UINT64_C(0) : 0,
    };
    const fg_graph_desc graph = {
        .device = d->device,
        .log = &r->log,
        .debug = d->debug,
        .seed = d->seed,
        .inspect = d->inspect,
        .inspect_user = d->inspect_user,
    };
    const fg_status status = ag_gpu_scene_create(&gpu, &r->gpu);
    if (status)
        return status;
    r->features = ag_gpu_scene_features(r->gpu);
    r->graph = fg_graph_create(&graph);
    return r->graph ? FG_OK : FG_ERR_MEMORY;
}

fg_status renderer_create(const renderer_desc *desc, renderer **out)
{
    *out = NULL;
    fg_status status = check(desc);
    if (status)
        return status;
    renderer *r = calloc(1, sizeof *r);
    if (!r)
        return out_of_memory(desc);
    r->desc = *desc;
    r->log = (fg_log){ hear, r, desc->log ? desc->log->level : FG_LOG_ERROR };
    r->sides = 1;
    r->side[0].layers = desc->layers ? desc->layers : 1u << LAYER_FINAL;
    choose_camera(r);
    status = create_parts(r);
    if (!status && desc->plugin)
        status = renderer_set_plugin(r, desc->plugin, desc->values);
    if (status) {
        renderer_destroy(r);
        return status;
    }
    *out = r;
    return FG_OK;
}

static void drop_plugin(renderer *r, branch *b)
{
    if (b->plugin)
        b->plugin->destroy(b->self);
    free(b->values);
    b->plugin = NULL;
    b->self = NULL;
    b->values = NULL;
    b->dropped = false;
    r->declared = false;
    r->trim_due = true;
}

void renderer_destroy(renderer *r)
{
    if (!r)
        return;
    fg_graph_destroy(r->graph); // before what its callbacks point to
    for (int i = 0; i < SIDES; i++)
        drop_plugin(r, &r->side[i]);
    ag_gpu_scene_destroy(r->gpu);
    free(r);
}

// ---- between frames --------------------------------------------------------------------------

static fg_status start_plugin(renderer *r, branch *b, const gi_plugin *plugin, gi_value *values)
{
    const gi_env env = {
        .log = &r->log,
        .device = r->desc.device,
        .scene = r->desc.scene,
        .gpu_scene = r->gpu,
    };
    char names[64];
    drop_plugin(r, b);
    // What an instance before it has left, of the same names: the next frame is its first.
    snprintf(names, sizeof names, "%s%s.", b == r->side ? "" : RENDERER_SECOND, plugin->name);
    fg_graph_forget(r->graph, names);
    r->heard[0] = 0;
    const fg_status status = plugin->create(&env, values, &b->self);
    b->frames = 0;
    b->dropped = status != FG_OK;
    if (status) {
        b->self = NULL;
        note_fault(r, plugin, "to start", r->heard[0] ? r->heard : fg_status_name(status));
        return status;
    }
    b->plugin = plugin;
    b->values = values;
    return FG_OK;
}

// A copy of the values, or the defaults.
static gi_value *copy_values(const gi_plugin *plugin, const gi_value *values)
{
    const size_t count = (size_t) gi_params_count(plugin);
    gi_value *own = calloc(count + 1, sizeof *own);
    if (own && values)
        memcpy(own, values, count * sizeof *own);
    else if (own)
        gi_params_default(plugin, own);
    return own;
}

// Gives a side another plugin or other values.
static fg_status set_side(renderer *r, branch *b, const gi_plugin *plugin, const gi_value *values)
{
    r->fault[0] = 0;
    r->declared = false;
    if (!plugin) {
        drop_plugin(r, b);
        return FG_OK;
    }
    gi_value *own = copy_values(plugin, values);
    if (!own)
        return out_of_memory(&r->desc);
    if (plugin == b->plugin && plugin->set && plugin->set(b->self, own) == FG_OK) {
        free(b->values);
        b->values = own;
        r->trim_due = true;
        return FG_OK;
    }
    const fg_status status = start_plugin(r, b, plugin, own);
    if (status)
        free(own);
    return status;
}

fg_status renderer_set_plugin(renderer *r, const gi_plugin *plugin, const gi_value *values)
{
    return set_side(r, &r->side[0], plugin, values);
}

static fg_status set_layers(renderer *r, branch *b, unsigned layers)
{
    if (layers >> LAYER_END)
        return refuse(&r->desc, "there is no such layer");
    if (layers == 0)
        layers = 1u << LAYER_FINAL;
    if (layers != b->layers)
        r->declared = false;
    b->layers = layers;
    return FG_OK;
}

fg_status renderer_set_layers(renderer *r, unsigned layers)
{
    return set_layers(r, &r->side[0], layers);
}

fg_status renderer_set_split(renderer *r, const renderer_side *second)
{
    branch *b = &r->side[1];
    const int sides = second ? 2 : 1;
    if (sides != r->sides)
        r->declared = false;
    r->sides = sides;
    if (!second) {
        if (b->plugin)
            drop_plugin(r, b);
        b->dropped = false;
        return FG_OK;
    }
    const fg_status status = set_layers(r, b, second->layers);
    if (status)
        return status;
    gi_value *values = second->plugin ? copy_values(second->plugin, second->values) : NULL;
    if (second->plugin && !values)
        return out_of_memory(&r->desc);
    const bool same =
        second->plugin == b->plugin &&
        (!values ||
         !memcmp(values, b->values, (size_t) gi_params_count(second->plugin) * sizeof *values));
    free(values);
    return same && !b->dropped ? FG_OK : set_side(r, b, second->plugin, second->values);
}

fg_status renderer_resize(renderer *r, int width, int height)
{
    if (width < 1 || height < 1)
        return refuse(&r->desc, "the size must be at least 1 x 1");
    if (width == r->desc.width && height == r->desc.height)
        return FG_OK;
    r->desc.width = width;
    r->desc.height = height;
    r->declared = false;
    fg_graph_trim(r->graph); // what the size before last has left
    return FG_OK;
}

void renderer_set_camera(renderer *r, const ag_camera *camera)
{
    r->camera = *camera;
    r->follows = false;
}

fg_status renderer_set_exposure(renderer *r, float exposure)
{
    if (!(exposure >= 0))
        return refuse(&r->desc, "exposure must not be negative");
    r->desc.exposure = exposure;
    for (int i = 0; i < r->sides; i++)
        r->side[i].tone.exposure = exposure > 0 ? exposure : 1;
    return FG_OK;
}

// ---- a frame ---------------------------------------------------------------------------------

// Goes on without the plugins of these sides (a bit each). `why` of each, or NULL: what was heard.
static void drop_sides(renderer *r, unsigned sides, const char *where, const char *const *why)
{
    for (int i = 0; i < r->sides; i++) {
        branch *b = &r->side[i];
        if (!(sides >> i & 1))
            continue;
        note_fault(r, b->plugin, where, why[i]);
        fg_logf(r->desc.log, FG_LOG_WARN, "%s; direct light alone", r->fault);
        drop_plugin(r, b);
        b->dropped = true;
    }
}

static fg_status update_plugins(renderer *r, double time)
{
    for (int i = 0; i < r->sides; i++) {
        branch *b = &r->side[i];
        if (!b->plugin || !b->plugin->update)
            continue;
        const gi_frame frame = { .view = &r->view, .index = b->frames, .time = time };
        r->heard[0] = 0;
        r->trying = !r->desc.strict;
        const fg_status status = b->plugin->update(b->self, &frame);
        r->trying = false;
        if (status && r->desc.strict)
            return status;
        const char *const heard = r->heard[0] ? r->heard : fg_status_name(status);
        const char *const why[SIDES] = { heard, heard };
        if (status)
            drop_sides(r, 1u << i, "in update", why);
    }
    return FG_OK;
}

// Declares, if need be, and runs the frame without the plugins of the sides whose bit is set.
static fg_status attempt(renderer *r, unsigned without)
{
    fg_status status = FG_OK;
    r->heard[0] = 0;
    for (int i = 0; i < r->sides; i++) {
        const bool muted = without >> i & 1;
        r->declared = r->declared && muted == r->side[i].muted;
        r->side[i].muted = muted;
    }
    if (!r->declared) {
        status = renderer_declare(r);
        // Now the graph knows what it still needs; the new memory is not there yet.
        if (!status && (r->trim_due || without)) {
            fg_graph_trim(r->graph);
            r->trim_due = false;
        }
    }
    return status ? status : fg_graph_run(r->graph);
}

// What came of the frame without some sides, which index it: a bit each.
typedef struct trial {
    fg_status status;
    char why[512];
} trial;

// Drops what the frame had to succeed without. What the plugin did wrong was heard in the first
// trial; of two that are at fault, in the trial where each was without the other.
static void settle(renderer *r, unsigned without, const trial *of)
{
    const char *const why[SIDES] = { of[without == 3 ? 2 : 0].why, of[without == 3 ? 1 : 0].why };
    if (!without)
        return;
    drop_sides(r, without, "in its frame", why);
    r->declared = true; // as it ran, and trimmed
    r->trim_due = false;
}

// A frame that fails is tried without one plugin, the other, both: what makes it succeed was at
// fault.
static fg_status run_frame(renderer *r)
{
    static const unsigned order[] = { 0, 2, 1, 3 };
    trial of[4] = { { 0 } };
    unsigned live = 0, without = 0;
    r->layer_failed = false;
    for (int i = 0; i < r->sides; i++)
        live |= r->side[i].plugin ? 1u << i : 0;
    r->trying = live && !r->desc.strict;
    for (int i = 0; i < FG_COUNT(order); i++) {
        if (order[i] & ~(r->trying ? live : 0))
            continue;
        without = order[i];
        trial *t = &of[without];
        t->status = attempt(r, without);
        if (!t->status || r->layer_failed)
            break;
        snprintf(t->why, sizeof t->why, "%s", r->heard[0] ? r->heard : fg_status_name(t->status));
    }
    const bool tried = r->trying;
    r->trying = false;
    for (int i = 0; i < r->sides; i++)
        r->side[i].muted = false;
    if (!of[without].status) {
        settle(r, without, of);
        return FG_OK;
    }
    r->declared = false;
    if (tried && !r->layer_failed)
        fg_logf(r->desc.log, FG_LOG_ERROR, "%s", of[0].why);
    return of[0].status;
}

fg_status renderer_frame(renderer *r, double time)
{
    ag_scene *scene = r->desc.scene;
    if (time != scene->time)
        ag_scene_set_time(scene, time);
    const ag_camera *camera = r->follows ? &scene->cameras[r->desc.camera_index] : &r->camera;
    fg_status status =
        ag_view_from_camera(r->desc.log, camera, r->desc.width, r->desc.height, &r->view);
    if (!status)
        status = ag_gpu_scene_update(r->gpu, &r->view);
    if (!status)
        status = update_plugins(r, time);
    if (!status)
        status = run_frame(r);
    for (int i = 0; i < r->sides; i++)
        r->side[i].frames++;
    return status;
}

const char *renderer_fault(const renderer *r)
{
    return r->fault[0] ? r->fault : NULL;
}

fg_graph *renderer_graph(renderer *r)
{
    return r->graph;
}

const gi_plugin *renderer_plugin(const renderer *r, int side)
{
    return side < r->sides ? r->side[side].plugin : NULL;
}

int renderer_counters(renderer *r, gi_counter *out, int max)
{
    const branch *b = &r->side[0];
    return b->plugin && b->plugin->counters ? b->plugin->counters(b->self, out, max) : 0;
}
