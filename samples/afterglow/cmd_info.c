// SPDX-License-Identifier: MIT
#include "record.h"

#include <math.h>
#include <stdlib.h>

static const char *const light_kinds[] = { "point", "spot", "directional" };

static cJSON *vector_json(const double *v, int count)
{
    return cJSON_CreateDoubleArray(v, count);
}

static cJSON *light_json(const ag_light *light)
{
    double direction[3], intensity[3];
    for (int i = 0; i < 3; ++i) {
        direction[i] = (double) light->direction[i];
        intensity[i] = (double) light->intensity[i];
    }
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", light->name);
    cJSON_AddStringToObject(object, "kind",
                            light->cosine ? "cosine spot" : light_kinds[light->kind]);
    if (light->kind != AG_LIGHT_DIRECTIONAL)
        cJSON_AddItemToObject(object, "position", vector_json(light->position, 3));
    if (light->kind != AG_LIGHT_POINT)
        cJSON_AddItemToObject(object, "direction", vector_json(direction, 3));
    cJSON_AddItemToObject(object, "intensity", vector_json(intensity, 3));
    cJSON_AddBoolToObject(object, "moving", light->moving);
    return object;
}

static cJSON *camera_json(const ag_camera *camera)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", camera->name);
    cJSON_AddStringToObject(object, "kind", camera->orthographic ? "orthographic" : "perspective");
    cJSON_AddItemToObject(object, "position", vector_json(&camera->world[12], 3));
    if (!camera->orthographic)
        cJSON_AddNumberToObject(object, "fov", (double) camera->yfov * 180 / M_PI);
    cJSON_AddBoolToObject(object, "moving", camera->moving);
    return object;
}

static double triangle_count(const ag_scene *scene)
{
    uint64_t count = 0;
    for (int i = 0; i < scene->instance_count; ++i)
        count += scene->primitives[scene->instances[i].primitive].index_count / 3;
    return (double) count;
}

static cJSON *scene_json(const host *h)
{
    const ag_scene *scene = h->scene;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "scene", h->scene_name);
    cJSON_AddNumberToObject(object, "triangles", triangle_count(scene));
    cJSON_AddNumberToObject(object, "vertices", (double) scene->vertex_count);
    cJSON_AddNumberToObject(object, "primitives", scene->primitive_count);
    cJSON_AddNumberToObject(object, "instances", scene->instance_count);
    cJSON_AddNumberToObject(object, "materials", scene->material_count);
    cJSON_AddNumberToObject(object, "textures", scene->texture_count);
    cJSON_AddNumberToObject(object, "duration", scene->duration);
    cJSON_AddNumberToObject(object, "warnings", scene->warning_count);
    cJSON_AddItemToObject(object, "box_min", vector_json(scene->box_min, 3));
    cJSON_AddItemToObject(object, "box_max", vector_json(scene->box_max, 3));
    cJSON_AddItemToObject(object, "features", record_features(scene->features));
    cJSON *lights = cJSON_AddArrayToObject(object, "lights");
    for (int i = 0; i < scene->light_count; ++i)
        cJSON_AddItemToArray(lights, light_json(&scene->lights[i]));
    cJSON *cameras = cJSON_AddArrayToObject(object, "cameras");
    for (int i = 0; i < scene->camera_count; ++i)
        cJSON_AddItemToArray(cameras, camera_json(&scene->cameras[i]));
    return object;
}

static void print_scene(const host *h)
{
    const ag_scene *s = h->scene;
    printf("%s\n  %.0f triangles, %zu vertices, %d primitives, %d instances\n", h->scene_name,
           triangle_count(s), s->vertex_count, s->primitive_count, s->instance_count);
    printf("  %d materials, %d textures, animation %.3g s\n", s->material_count, s->texture_count,
           s->duration);
    if (s->instance_count)
        printf("  box %.4g %.4g %.4g to %.4g %.4g %.4g m\n", s->box_min[0], s->box_min[1],
               s->box_min[2], s->box_max[0], s->box_max[1], s->box_max[2]);
    printf("  features:");
    for (int i = 0; i < AG_FEATURE_COUNT; ++i)
        if (s->features >> i & 1)
            printf(" %s", ag_feature_names[i]);
    printf("\n");
    for (int i = 0; i < s->light_count; ++i) {
        const ag_light *l = &s->lights[i];
        printf("  light '%s': %s at %.4g %.4g %.4g, %.4g %.4g %.4g %s%s\n", l->name,
               l->cosine ? "cosine spot" : light_kinds[l->kind], l->position[0], l->position[1],
               l->position[2], (double) l->intensity[0], (double) l->intensity[1],
               (double) l->intensity[2], l->kind == AG_LIGHT_DIRECTIONAL ? "W/m2" : "W/sr",
               l->moving ? ", moving" : "");
    }
    for (int i = 0; i < s->camera_count; ++i) {
        const ag_camera *k = &s->cameras[i];
        printf("  camera '%s': %s at %.4g %.4g %.4g%s\n", k->name,
               k->orthographic ? "orthographic" : "perspective", k->world[12], k->world[13],
               k->world[14], k->moving ? ", moving" : "");
    }
}

static cJSON *device_json(int n, const fg_gl_device_info *info)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "device", n);
    cJSON_AddStringToObject(object, "name", info->name);
    cJSON_AddStringToObject(object, "renderer", info->renderer);
    cJSON_AddStringToObject(object, "version", info->version);
    cJSON_AddBoolToObject(object, "software", info->software);
    return object;
}

static cJSON *devices(bool print)
{
    fg_gl_device_info info;
    cJSON *array = cJSON_CreateArray();
    for (int n = 1; fg_gl_get_device_info(n, &info); ++n) {
        cJSON_AddItemToArray(array, device_json(n, &info));
        if (print)
            printf("device %d: %s: %s%s%s\n", n, info.name,
                   info.renderer[0] ? info.renderer : "no OpenGL 4.5 core",
                   info.version[0] ? ", " : "", info.version);
    }
    return array;
}

static int run(cli *c, const options *o)
{
    host h;
    cJSON *json = NULL;
    int code = EXIT_DONE;
    host_init(&h, c, o);
    h.as_it_is = true;
    if (o->operand_count) {
        code = host_open_scene(&h, o->operands[0]);
        if (code == EXIT_DONE && !o->json)
            print_scene(&h);
        json = code == EXIT_DONE ? scene_json(&h) : NULL;
    } else {
        json = devices(!o->json);
        if (!cJSON_GetArraySize(json))
            cli_warn("info: EGL has no device");
    }
    if (code == EXIT_DONE && o->json) {
        char *text = cJSON_Print(json);
        if (text)
            printf("%s\n", text);
        else
            code = cli_status(c, FG_ERR_MEMORY);
        free(text);
    }
    cJSON_Delete(json);
    host_finish(&h);
    return code;
}

const command command_info = {
    .name = "info",
    .operands = "[SCENE]",
    .summary = "Says what a scene contains; without one, which devices there are",
    .option_names = OPTIONS_SCENE " --json ",
    .max_operands = 1,
    .run = run,
};
