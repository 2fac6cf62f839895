// SPDX-License-Identifier: MIT
#include "view_params.h"

#include "file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void view_set_finish(view_set *s)
{
    cJSON_Delete(s->sides[0].params);
    cJSON_Delete(s->sides[1].params);
    *s = (view_set){ 0 };
}

// ---- writing ---------------------------------------------------------------------------------

cJSON *view_set_params(const gi_plugin *p, const gi_value *values)
{
    cJSON *params = cJSON_CreateObject();
    const int count = p ? gi_params_count(p) : 0;
    for (int i = 0; i < count; ++i) {
        const gi_param *row = &p->params[i];
        cJSON *value = NULL;
        switch (row->type) {
        case GI_INT: value = cJSON_CreateNumber((double) values[i].i); break;
        case GI_FLOAT: value = cJSON_CreateNumber(values[i].f); break;
        case GI_BOOL: value = cJSON_CreateBool(values[i].i != 0); break;
        case GI_ENUM: value = cJSON_CreateString(row->choices[values[i].i]); break;
        }
        if (!cJSON_AddItemToObject(params, row->name, value)) {
            cJSON_Delete(value);
            cJSON_Delete(params);
            return NULL;
        }
    }
    return params;
}

static void add_side(cJSON *object, const view_set_side *side)
{
    if (!side->plugin[0])
        return;
    cJSON_AddStringToObject(object, "plugin", side->plugin);
    if (side->params)
        cJSON_AddItemToObject(object, "params", cJSON_Duplicate(side->params, true));
}

static void add_camera(cJSON *root, const view_set *s)
{
    if (!s->camera[0] && !s->has_pose)
        return;
    cJSON *camera = cJSON_AddObjectToObject(root, "camera");
    if (s->camera[0]) {
        cJSON_AddStringToObject(camera, "name", s->camera);
        return;
    }
    cJSON_AddItemToObject(camera, "eye", cJSON_CreateDoubleArray(s->eye, 3));
    cJSON_AddNumberToObject(camera, "yaw", s->yaw);
    cJSON_AddNumberToObject(camera, "pitch", s->pitch);
    cJSON_AddNumberToObject(camera, "yfov", s->yfov);
}

char *view_set_print(const view_set *s)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "afterglow", "view");
    if (s->scene[0])
        cJSON_AddStringToObject(root, "scene", s->scene);
    add_side(root, &s->sides[0]);
    if (s->layer[0])
        cJSON_AddStringToObject(root, "layer", s->layer);
    if (s->exposure > 0)
        cJSON_AddNumberToObject(root, "exposure", s->exposure);
    add_camera(root, s);
    if (s->sides[1].plugin[0])
        add_side(cJSON_AddObjectToObject(root, "second"), &s->sides[1]);
    if (s->divider > 0)
        cJSON_AddNumberToObject(root, "divider", s->divider);
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    return text;
}

// ---- reading ---------------------------------------------------------------------------------

typedef struct reader {
    const fg_log *log;
    const char *name; // the file's
} reader;

static bool refuse(const reader *r, const char *key, const char *rule)
{
    fg_logf(r->log, FG_LOG_ERROR, "%s: %s must be %s", r->name, key, rule);
    return false;
}

static bool take_text(const reader *r, const cJSON *item, char out[VIEW_NAME])
{
    const char *text = cJSON_GetStringValue(item);
    if (!text || !text[0] || strlen(text) >= VIEW_NAME)
        return refuse(r, item->string, "a text of 1 to 63 letters");
    snprintf(out, VIEW_NAME, "%s", text);
    return true;
}

static bool take_number(const reader *r, const cJSON *item, double min, double max, double *out)
{
    char rule[64];
    const double value = cJSON_IsNumber(item) ? item->valuedouble : nan("");
    if (value >= min && value <= max) {
        *out = value;
        return true;
    }
    snprintf(rule, sizeof rule, "a number from %g to %g", min, max);
    return refuse(r, item->string, rule);
}

static bool take_params(const reader *r, cJSON *item, view_set_side *out)
{
    if (!cJSON_IsObject(item))
        return refuse(r, item->string, "an object");
    cJSON_Delete(out->params); // of a key that stands there twice
    out->params = cJSON_Duplicate(item, true);
    return out->params || refuse(r, item->string, "smaller: out of memory");
}

static bool take_eye(const reader *r, const cJSON *item, double out[3])
{
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 3)
        return refuse(r, item->string, "three numbers");
    for (int i = 0; i < 3; ++i) {
        const cJSON *number = cJSON_GetArrayItem(item, i);
        if (!cJSON_IsNumber(number) || !(fabs(number->valuedouble) <= 1e12))
            return refuse(r, item->string, "three numbers up to 1e12");
        out[i] = number->valuedouble;
    }
    return true;
}

static bool unknown(const reader *r, const cJSON *item)
{
    fg_logf(r->log, FG_LOG_ERROR, "%s: there is no key '%.60s' in a parameter set", r->name,
            item->string);
    return false;
}

static bool take_camera(const reader *r, const cJSON *object, view_set *out)
{
    unsigned have = 0;
    if (!cJSON_IsObject(object))
        return refuse(r, object->string, "an object");
    for (const cJSON *item = object->child; item; item = item->next) {
        bool good;
        if (!strcmp(item->string, "name")) {
            good = take_text(r, item, out->camera);
        } else if (!strcmp(item->string, "eye")) {
            good = take_eye(r, item, out->eye);
            have |= 1;
        } else if (!strcmp(item->string, "yaw")) {
            good = take_number(r, item, -1e4, 1e4, &out->yaw);
            have |= 2;
        } else if (!strcmp(item->string, "pitch")) {
            good = take_number(r, item, -90, 90, &out->pitch);
            have |= 4;
        } else if (!strcmp(item->string, "yfov")) {
            good = take_number(r, item, 0.1, 179, &out->yfov);
            have |= 8;
        } else {
            good = unknown(r, item);
        }
        if (!good)
            return false;
    }
    out->has_pose = have == 15;
    if (out->has_pose == (out->camera[0] != 0) || (have && !out->has_pose))
        return refuse(r, "camera", "a name, or eye, yaw, pitch and yfov");
    return true;
}

static bool take_side(const reader *r, const cJSON *object, view_set_side *out)
{
    bool good = cJSON_IsObject(object) || refuse(r, object->string, "an object");
    for (cJSON *item = good ? object->child : NULL; item && good; item = item->next) {
        if (!strcmp(item->string, "plugin"))
            good = take_text(r, item, out->plugin);
        else if (!strcmp(item->string, "params"))
            good = take_params(r, item, out);
        else
            good = unknown(r, item);
    }
    if (good && !out->plugin[0])
        return refuse(r, object->string, "an object with a plugin");
    return good;
}

static bool take_key(const reader *r, cJSON *item, view_set *out)
{
    const char *key = item->string;
    if (!strcmp(key, "afterglow"))
        return true; // seen by the caller
    if (!strcmp(key, "scene"))
        return take_text(r, item, out->scene);
    if (!strcmp(key, "plugin"))
        return take_text(r, item, out->sides[0].plugin);
    if (!strcmp(key, "params"))
        return take_params(r, item, &out->sides[0]);
    if (!strcmp(key, "layer"))
        return take_text(r, item, out->layer);
    if (!strcmp(key, "exposure"))
        return take_number(r, item, 1e-9, 1e9, &out->exposure);
    if (!strcmp(key, "divider"))
        return take_number(r, item, 0.01, 0.99, &out->divider);
    if (!strcmp(key, "camera"))
        return take_camera(r, item, out);
    if (!strcmp(key, "second"))
        return take_side(r, item, &out->sides[1]);
    return unknown(r, item);
}

fg_status view_set_parse(const fg_log *log, const char *name, const char *text, view_set *out)
{
    const reader r = { log, name };
    *out = (view_set){ 0 };
    cJSON *root = cJSON_ParseWithOpts(text, NULL, true);
    const char *kind = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(root, "afterglow"));
    bool good = cJSON_IsObject(root);
    if (!good)
        fg_logf(log, FG_LOG_ERROR, "%s: is not JSON of a parameter set", name);
    else if (!kind || strcmp(kind, "view") != 0)
        good = refuse(&r, "\"afterglow\"", "there and \"view\": this is no parameter set");
    for (cJSON *item = good ? root->child : NULL; item && good; item = item->next)
        good = take_key(&r, item, out);
    if (good && out->sides[0].params && !out->sides[0].plugin[0])
        good = refuse(&r, "plugin", "given where params are");
    cJSON_Delete(root);
    if (!good)
        view_set_finish(out);
    return good ? FG_OK : FG_ERR_INPUT;
}

// As --set has it.
static bool print_value(const cJSON *item, char *text, size_t size)
{
    int length = -1;
    if (cJSON_IsString(item))
        length = snprintf(text, size, "%.60s=%s", item->string, item->valuestring);
    else if (cJSON_IsBool(item))
        length = snprintf(text, size, "%.60s=%d", item->string, cJSON_IsTrue(item) ? 1 : 0);
    else if (cJSON_IsNumber(item))
        length = snprintf(text, size, "%.60s=%.17g", item->string, item->valuedouble);
    return length >= 0 && (size_t) length < size;
}

fg_status view_set_values(const fg_log *log, const char *name, const cJSON *params,
                          const gi_plugin *p, gi_value *values)
{
    const size_t count = (size_t) gi_params_count(p);
    gi_value *fresh = malloc((count + 1) * sizeof *fresh);
    fg_status status = fresh ? FG_OK : FG_ERR_MEMORY;
    if (fresh)
        gi_params_default(p, fresh);
    for (const cJSON *item = params ? params->child : NULL; item && !status; item = item->next) {
        char text[256];
        if (!print_value(item, text, sizeof text) || gi_params_set(log, p, fresh, text) != FG_OK) {
            fg_logf(log, FG_LOG_ERROR, "%s: parameter '%.60s' of %s is refused", name, item->string,
                    p->name);
            status = FG_ERR_INPUT;
        }
    }
    if (!status)
        memcpy(values, fresh, count * sizeof *values);
    free(fresh);
    return status;
}

fg_status view_set_save(const fg_log *log, const char *path, const view_set *s)
{
    return file_write_text(log, path, view_set_print(s));
}

fg_status view_set_load(const fg_log *log, const char *path, view_set *out)
{
    char *text = NULL;
    size_t size = 0;
    *out = (view_set){ 0 };
    fg_status status = file_read(log, path, VIEW_SET_MAX_BYTES, &text, &size);
    if (!status && strlen(text) != size) {
        fg_logf(log, FG_LOG_ERROR, "%s: is not JSON of a parameter set", path);
        status = FG_ERR_INPUT;
    }
    if (!status)
        status = view_set_parse(log, path, text, out);
    free(text);
    return status;
}
