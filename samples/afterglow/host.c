// SPDX-License-Identifier: MIT
#include "host.h"

#include "file.h"
#include "scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void host_init(host *h, cli *c, const options *o)
{
    *h = (host){ .c = c, .o = o };
}

void host_finish(host *h)
{
    ag_scene_destroy(h->scene);
    fg_device_destroy(h->device);
    fg_gl_context_destroy(h->context);
    gi_registry_destroy(h->registry);
    *h = (host){ 0 };
}

// A folder that an option names, if it does, has to be there.
static int check_folder(cli *c, const char *option, const char *path)
{
    struct stat st;
    if (!path || (stat(path, &st) == 0 && S_ISDIR(st.st_mode)))
        return EXIT_DONE;
    return cli_fail(c, EXIT_INPUT, "%s: there is no folder '%.600s'", option, path);
}

int host_open_registry(host *h)
{
    const gi_registry_desc desc = { .log = &h->c->log, .dirs = h->o->plugin_dir, .hot = h->hot };
    for (int i = 0; i < h->o->plugin_dir_count; ++i) {
        const int code = check_folder(h->c, "--plugin-dir", h->o->plugin_dir[i]);
        if (code != EXIT_DONE)
            return code;
    }
    return cli_status(h->c, gi_registry_create(&desc, &h->registry));
}

int host_open_device(host *h)
{
    const fg_status status = fg_gl_context_create(
        &(fg_gl_context_desc){ .log = &h->c->log, .device = h->o->device }, &h->context);
    if (status == FG_ERR_INVALID)
        return cli_fail(h->c, EXIT_USAGE, "--device: there is no device %d", h->o->device);
    return status == FG_OK ? host_take_context(h) : cli_status(h->c, status);
}

int host_take_context(host *h)
{
    const int code = check_folder(h->c, "--shader-dir", h->o->shader_dir);
    if (code != EXIT_DONE)
        return code;
    const fg_gl_device_desc desc = { .log = &h->c->log, .shader_dir = h->o->shader_dir };
    return cli_status(h->c, fg_gl_device_create(&desc, &h->device));
}

void host_drop_device(host *h)
{
    fg_device_destroy(h->device);
    h->device = NULL;
}

// ---- scene -----------------------------------------------------------------------------------

static void unit(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; ++i)
        v[i] /= length;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double scene_diagonal(const ag_scene *scene)
{
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const double side = scene->box_max[i] - scene->box_min[i];
        sum += side > 0 ? side * side : 0;
    }
    return sum > 0 ? sqrt(sum) : 1;
}

static ag_camera camera_at(const options *o, const ag_scene *scene)
{
    ag_camera camera = { .name = "command line" };
    double right[3], up[3] = { 0, 1, 0 }, back[3];
    for (int i = 0; i < 3; ++i)
        back[i] = o->eye[i] - o->target[i];
    unit(back);
    if (fabs(back[1]) > 0.9999) { // straight up or down: the top of the picture is -Z
        up[1] = 0;
        up[2] = -1;
    }
    cross(up, back, right);
    unit(right);
    cross(back, right, up);
    for (int i = 0; i < 3; ++i) {
        camera.world[i] = right[i];
        camera.world[4 + i] = up[i];
        camera.world[8 + i] = back[i];
        camera.world[12 + i] = o->eye[i];
    }
    camera.world[15] = 1;
    camera.yfov = (float) (o->fov * M_PI / 180);
    camera.znear =
        (float) fmax(1e-6, 1e-4 * scene_diagonal(scene)); // depth is reversed: this is free
    return camera;
}

ag_camera host_camera(const host *h)
{
    return h->has_camera ? h->camera : h->scene->cameras[h->camera_index];
}

static int choose_camera(host *h)
{
    h->has_camera = false;
    h->camera_index = 0;
    if (h->o->camera && h->o->camera_at_given)
        return cli_fail(h->c, EXIT_USAGE,
                        "--camera: --camera-at is given too, must be one of them");
    if (h->o->camera) {
        h->camera_index = ag_scene_find_camera(h->scene, h->o->camera);
        if (h->camera_index < 0)
            return cli_fail(h->c, EXIT_USAGE, "--camera: %s has no camera '%s'", h->scene_name,
                            h->o->camera);
    } else if (h->o->camera_at_given) {
        h->camera = camera_at(h->o, h->scene);
        h->has_camera = true;
    } else if (!h->scene->camera_count) {
        h->camera = ag_scene_framing_camera(h->scene);
        h->has_camera = true;
    }
    return EXIT_DONE;
}

// The stated default: a point light at the camera that gives a white surface which faces it, as
// far away as the middle of the scene or a quarter of its diagonal, a radiance of 1.
static int add_default_light(host *h)
{
    const ag_camera camera = host_camera(h);
    ag_light light = { .name = "default", .kind = AG_LIGHT_POINT, .direction = { 0, -1, 0 } };
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const double middle = 0.5 * (h->scene->box_min[i] + h->scene->box_max[i]);
        light.position[i] = camera.world[12 + i];
        sum += (middle - light.position[i]) * (middle - light.position[i]);
    }
    const double reach = fmax(sqrt(sum), 0.25 * scene_diagonal(h->scene));
    for (int i = 0; i < 3; ++i)
        light.intensity[i] = (float) (M_PI * reach * reach);
    cli_warn("%s: has no light; a point light of %.4g W/sr is put at the camera", h->scene_name,
             (double) light.intensity[0]);
    return cli_status(h->c, ag_scene_add_light(h->scene, &light));
}

void host_take_scene(host *h, ag_scene *scene, const char *name)
{
    ag_scene_destroy(h->scene);
    h->scene = scene;
    h->scene_name = name;
    h->dark_said = false;
}

int host_open_scene(host *h, const char *name)
{
    ag_scene *scene;
    fg_status status = scenes_open(&h->c->log, name, &scene);
    host_take_scene(h, status == FG_OK ? scene : NULL, name);
    for (int i = 0; status == FG_OK && i < h->o->light_count; ++i)
        status = ag_scene_add_light(h->scene, &h->o->lights[i]);
    if (status != FG_OK)
        return cli_status(h->c, status);
    const int code = choose_camera(h);
    const bool dark = !(h->scene->features & (AG_FEATURE_LIGHT | AG_FEATURE_EMISSIVE));
    if (code != EXIT_DONE || !dark || !h->scene->instance_count || h->as_it_is)
        return code;
    return add_default_light(h);
}

// ---- plugins ---------------------------------------------------------------------------------

void setting_finish(setting *s)
{
    free(s->values);
    *s = (setting){ 0 };
}

static gi_value *new_values(const gi_plugin *plugin)
{
    const int count = gi_params_count(plugin);
    return calloc((size_t) (count > 0 ? count : 1), sizeof(gi_value));
}

bool setting_copy(const setting *from, setting *to)
{
    *to = (setting){ .plugin = from->plugin, .layer = from->layer };
    if (!from->plugin)
        return true;
    to->values = new_values(from->plugin);
    if (to->values)
        memcpy(to->values, from->values,
               (size_t) gi_params_count(from->plugin) * sizeof *to->values);
    return to->values != NULL;
}

const char *setting_name(const setting *s)
{
    return s->plugin ? s->plugin->name : "none";
}

// What of an assignment is for plugin `name`: the text after "name.", all of it without a
// plugin's name in front, NULL if it is for another.
static const char *meant_for(const char *assignment, const char *name)
{
    const size_t length = strlen(name);
    const size_t key = strcspn(assignment, "=");
    const char *dot = memchr(assignment, '.', key);
    if (!dot)
        return assignment;
    if ((size_t) (dot - assignment) == length && !strncmp(assignment, name, length))
        return dot + 1;
    return NULL;
}

static bool has_key(const gi_plugin *p, const char *assignment)
{
    const size_t length = strcspn(assignment, "=");
    for (const gi_param *row = p->params; row && row->name; ++row)
        if (strlen(row->name) == length && !strncmp(row->name, assignment, length))
            return true;
    return false;
}

bool host_has_plugin(const host *h, const char *name)
{
    const char *other;
    for (int i = 0; (other = gi_name(h->registry, i)); ++i)
        if (!strcmp(other, name))
            return true;
    return false;
}

int host_setting(host *h, const char *name, setting *out)
{
    *out = (setting){ 0 };
    if (!name || !strcmp(name, "none"))
        return EXIT_DONE;
    if (!host_has_plugin(h, name))
        return cli_fail(h->c, EXIT_USAGE,
                        "--gi: there is no plugin '%s'; 'afterglow plugins' lists them", name);
    const gi_plugin *plugin = gi_find(h->registry, name);
    if (!plugin) {
        cli_forgive(h->c);
        cli_warn("%s: direct light alone", name);
        h->refused = true;
        return EXIT_DONE;
    }
    *out = (setting){ .plugin = plugin, .values = new_values(plugin) };
    if (!out->values)
        return cli_status(h->c, FG_ERR_MEMORY);
    gi_params_default(plugin, out->values);
    for (int i = 0; i < h->o->set_count; ++i) {
        const char *assignment = meant_for(h->o->set[i], name);
        if (!assignment || !has_key(plugin, assignment))
            continue;
        if (gi_params_set(&h->c->log, plugin, out->values, assignment) != FG_OK) {
            setting_finish(out);
            cli_fail(h->c, EXIT_USAGE, "--set: %s is refused", h->o->set[i]);
            return EXIT_USAGE;
        }
    }
    return EXIT_DONE;
}

// Every layer that there is with the plugin: "final, radiance, ..., isr.level".
static void list_layers(const gi_plugin *p, char *text, size_t size)
{
    size_t used = 0;
    for (int i = 0; i < LAYER_COUNT && used < size; ++i)
        used += (size_t) snprintf(text + used, size - used, "%s%s", i ? ", " : "",
                                  renderer_layer_names[i]);
    for (int i = 0; p && i < gi_layers_count(p) && used < size; ++i)
        used += (size_t) snprintf(text + used, size - used, ", %s.%s", p->name, p->layers[i].name);
}

// A plugin's layer goes by its name, too, where no other has it.
static int choose_layer(const host *h, setting *s)
{
    const char *name = h->o->layer;
    char known[512];
    s->layer = LAYER_FINAL;
    if (!name)
        return EXIT_DONE;
    for (int i = 0; i < LAYER_COUNT; ++i)
        if (!strcmp(name, renderer_layer_names[i])) {
            s->layer = (renderer_layer) i;
            return EXIT_DONE;
        }
    const size_t length = strlen(setting_name(s));
    const bool full = !strncmp(name, setting_name(s), length) && name[length] == '.';
    for (int i = 0; s->plugin && i < gi_layers_count(s->plugin); ++i)
        if (!strcmp(full ? name + length + 1 : name, s->plugin->layers[i].name)) {
            s->layer = (renderer_layer) (LAYER_PLUGIN + i);
            return EXIT_DONE;
        }
    list_layers(s->plugin, known, sizeof known);
    return cli_fail(h->c, EXIT_USAGE, "--layer: is '%s', with --gi %s there is %s", name,
                    setting_name(s), known);
}

int host_check_set(host *h, const setting *settings, int count)
{
    for (int i = 0; i < h->o->set_count; ++i) {
        const char *text = h->o->set[i];
        bool taken = h->refused;
        if (!strchr(text, '='))
            return cli_fail(h->c, EXIT_USAGE, "--set: is '%s', must be KEY=VALUE", text);
        for (int k = 0; k < count; ++k) {
            const gi_plugin *p = settings[k].plugin;
            const char *assignment = p ? meant_for(text, p->name) : NULL;
            taken = taken || (assignment && has_key(p, assignment));
        }
        if (!taken)
            return cli_fail(h->c, EXIT_USAGE, "--set: %s has no parameter '%.*s'",
                            count == 1 ? setting_name(settings) : "no plugin that runs",
                            (int) strcspn(text, "="), text);
    }
    return EXIT_DONE;
}

// The plugins that can be had; a warning for each that cannot.
static int sound_names(host *h, const char *names[CLI_MAX_GI])
{
    const char *name;
    int n = 0;
    for (int i = 0; n < CLI_MAX_GI && (name = gi_name(h->registry, i)); ++i) {
        if (gi_find(h->registry, name))
            names[n++] = name;
        else
            cli_forgive(h->c);
    }
    return n;
}

int host_settings(host *h, bool all, setting *out, int *count)
{
    const char *names[CLI_MAX_GI];
    int n = 0, code = EXIT_DONE;
    for (; n < h->o->gi_count; ++n)
        names[n] = h->o->gi[n];
    if (!n && all)
        n = sound_names(h, names);
    else if (!n)
        names[n++] = "none";
    *count = 0;
    for (int i = 0; i < n && code == EXIT_DONE; ++i) {
        code = host_setting(h, names[i], &out[*count]);
        *count += code == EXIT_DONE;
        if (code == EXIT_DONE)
            code = choose_layer(h, &out[*count - 1]);
    }
    if (code == EXIT_DONE)
        code = host_check_set(h, out, *count);
    if (code == EXIT_DONE)
        return code;
    while (*count > 0)
        setting_finish(&out[--*count]);
    return code;
}

int host_open(host *h, setting *out, int *count)
{
    int code = host_open_registry(h);
    if (code == EXIT_DONE)
        code = host_settings(h, false, out, count);
    if (code == EXIT_DONE)
        code = host_open_scene(h, h->o->operands[0]);
    return code == EXIT_DONE ? host_open_device(h) : code;
}

bool host_serves(const host *h, const gi_plugin *plugin, const char **why)
{
    const uint64_t lacking = plugin && !h->o->needs_all ? plugin->needs & ~h->scene->features : 0;
    for (int i = 0; i < AG_FEATURE_COUNT; ++i)
        if (lacking >> i & 1) {
            *why = ag_feature_names[i];
            return false;
        }
    return true;
}

renderer_desc host_renderer_desc(const host *h, const setting *s, int width, int height)
{
    return (renderer_desc){
        .log = &h->c->log,
        .device = h->device,
        .scene = h->scene,
        .camera = h->has_camera ? &h->camera : NULL,
        .camera_index = h->camera_index,
        .width = width,
        .height = height,
        .plugin = s->plugin,
        .values = s->values,
        .exposure = h->o->exposure,
        .needs_all = h->o->needs_all,
        .debug = h->o->debug,
        .seed = h->o->seed,
        .shadow_size = h->o->shadow_size,
        .shadow_taps = h->o->shadow_taps,
    };
}

fg_status host_switch(host *h, renderer *r, const setting *s)
{
    const fg_status status = renderer_set_plugin(r, s->plugin, s->values);
    h->fell_back = status != FG_OK;
    if (status == FG_OK || !renderer_fault(r))
        return status;
    h->c->error[0] = 0; // the fault tells it
    cli_warn("%s; direct light alone", renderer_fault(r));
    return FG_OK;
}

fg_status host_frame(host *h, renderer *r, double time)
{
    const fg_status status = renderer_frame(r, time);
    if (status == FG_OK && renderer_fault(r) && !h->fell_back) {
        cli_forgive(h->c); // what the device has said, of a shader for one
        h->fell_back = true;
    }
    return status;
}

// Frames are lit by punctual lights; what surfaces send is for plugins that ask for it.
static void warn_dark(host *h, const gi_plugin *plugin)
{
    const uint64_t features = h->scene->features;
    if (h->dark_said || !(features & AG_FEATURE_EMISSIVE) || features & AG_FEATURE_LIGHT ||
        (plugin && plugin->needs & AG_FEATURE_AREA_LIGHT))
        return;
    cli_warn("%s: nothing shines but surfaces, which light no others here; --light adds a light",
             h->scene_name);
    h->dark_said = true;
}

fg_status host_renderer(host *h, const renderer_desc *desc, renderer **out)
{
    renderer_desc bare = *desc;
    bare.plugin = NULL;
    bare.values = NULL;
    warn_dark(h, desc->plugin);
    const fg_status status = renderer_create(&bare, out);
    if (status != FG_OK || !desc->plugin)
        return status;
    return host_switch(h, *out,
                       &(setting){ .plugin = desc->plugin, .values = (gi_value *) desc->values });
}

// ---- layers and outputs ----------------------------------------------------------------------

image_kind host_layer_kind(renderer_layer layer)
{
    return layer == LAYER_NORMAL || layer == LAYER_POSITION ? IMAGE_DATA : IMAGE_LIGHT;
}

int host_check_output(cli *c, const options *o, bool picture)
{
    if (!o->output)
        return cli_fail(c, EXIT_USAGE, "-o: is missing; it names the file to write");
    if (picture && !image_writable(o->output))
        return cli_fail(c, EXIT_USAGE, "-o: is '%s', must end in .png, .exr or .pfm", o->output);
    return cli_status(c, file_check(&c->log, o->output));
}

int host_check_trace(cli *c, const options *o)
{
    if (!o->trace)
        return EXIT_DONE;
    if (o->output && !strcmp(o->trace, o->output))
        return cli_fail(c, EXIT_USAGE, "--trace: is '%s', which is where the picture goes",
                        o->trace);
    if (o->stats && !strcmp(o->trace, o->stats))
        return cli_fail(c, EXIT_USAGE, "--trace: is '%s', which is where --stats goes", o->trace);
    return cli_status(c, file_check(&c->log, o->trace));
}

int host_check_folder(cli *c, const options *o)
{
    char probe[4096];
    if (!o->output)
        return cli_fail(c, EXIT_USAGE, "-o: is missing; it names the folder to write to");
    const fg_status status = file_make_folder(&c->log, o->output);
    if (status != FG_OK)
        return cli_status(c, status);
    snprintf(probe, sizeof probe, "%s/probe", o->output);
    return cli_status(c, file_check(&c->log, probe));
}
