// SPDX-License-Identifier: MIT
#include "report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const truth_names[REPORT_TRUTHS] = { "path1", "path1_unshadowed" };

void truths_finish(truths *t)
{
    for (int i = 0; i < REPORT_TRUTHS; ++i)
        image_finish(&t->picture[i]);
}

static size_t value_count(const image *img)
{
    return 3 * (size_t) img->width * (size_t) img->height;
}

static void show_progress(void *user, double fraction)
{
    cli_progress(user, fraction);
}

static fg_status trace(host *h, const truths_desc *d, int truth, image *out, double *noise)
{
    char what[96];
    const ag_camera camera = host_camera(h);
    snprintf(what, sizeof what, "%s: %s", h->scene_name, truth_names[truth]);
    const reference_desc desc = {
        .log = &h->c->log,
        .scene = h->scene,
        .camera = &camera,
        .width = d->width,
        .height = d->height,
        .bounces = 1,
        .spp = d->spp[truth],
        .seed = h->o->seed,
        .layer = REFERENCE_INDIRECT,
        .unshadowed_bounce = truth == 1,
        .progress = show_progress,
        .progress_user = what,
    };
    const fg_status status = reference_render_halves(&desc, out, noise);
    cli_progress(what, 1);
    return status;
}

static void moments(const image *img, double *mean, double *rms)
{
    double sum = 0, squares = 0;
    const size_t n = value_count(img);
    for (size_t i = 0; i < n; ++i) {
        const double v = (double) img->rgb[i];
        sum += v;
        squares += v * v;
    }
    *mean = sum / (double) n;
    *rms = sqrt(squares / (double) n);
}

// The 98th percentile is shown as white.
static double choose_exposure(const image *img)
{
    const size_t n = value_count(img);
    double *values = malloc(n * sizeof *values);
    if (!values)
        return 1;
    for (size_t i = 0; i < n; ++i)
        values[i] = (double) img->rgb[i];
    const double white = timing_quantile(values, (int) n, 0.98);
    free(values);
    return white > 0 ? 1 / white : 1;
}

static fg_status write_picture(host *h, const char *folder, const char *name, const image *img,
                               double exposure)
{
    char path[4096];
    image shown = { 0 };
    fg_status status = image_create(&h->c->log, img->width, img->height, &shown);
    if (status != FG_OK)
        return status;
    for (size_t i = 0; i < value_count(img); ++i)
        shown.rgb[i] = (float) ((double) img->rgb[i] * exposure);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    status = image_write(&h->c->log, path, &shown, IMAGE_LIGHT);
    image_finish(&shown);
    return status;
}

static fg_status add_truth(host *h, const char *folder, cJSON *list, int truth, truths *t)
{
    char scene[64], name[160], path[4096];
    double mean, rms;
    moments(&t->picture[truth], &mean, &rms);
    report_file_name(scene, sizeof scene, h->scene_name);
    snprintf(name, sizeof name, "images/%s_%s.png", scene, truth_names[truth]);
    snprintf(path, sizeof path, "%s/images/%s_%s.exr", folder, scene, truth_names[truth]);
    t->rms[truth] = rms;
    t->scale[truth] = rms > 0 ? 0.5 * rms : 1;
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddStringToObject(entry, "name", truth_names[truth]);
    cJSON_AddNumberToObject(entry, "mean", mean);
    cJSON_AddNumberToObject(entry, "rms", rms);
    cJSON_AddNumberToObject(entry, "error_map_scale", t->scale[truth]);
    cJSON_AddStringToObject(entry, "image", name);
    cJSON_AddItemToArray(list, entry);
    const fg_status status = image_write(&h->c->log, path, &t->picture[truth], IMAGE_LIGHT);
    if (status != FG_OK)
        return status;
    return write_picture(h, folder, name, &t->picture[truth], t->exposure);
}

int truths_render(host *h, const truths_desc *desc, truths *out)
{
    fg_status status = FG_OK;
    cJSON *list = cJSON_AddArrayToObject(desc->scene_json, "references");
    *out = (truths){ 0 };
    for (int i = 0; i < REPORT_TRUTHS && status == FG_OK; ++i) {
        status = trace(h, desc, i, &out->picture[i], &out->noise[i]);
        if (status != FG_OK)
            break;
        if (i == 0)
            out->exposure = choose_exposure(&out->picture[0]);
        status = add_truth(h, desc->folder, list, i, out);
        cJSON *entry = cJSON_GetArrayItem(list, i);
        const int half = (desc->spp[i] + 1) / 2;
        cJSON_AddNumberToObject(entry, "spp", 2.0 * half);
        cJSON_AddNumberToObject(entry, "noise", out->noise[i]);
    }
    cJSON_AddNumberToObject(desc->scene_json, "exposure", out->exposure);
    return cli_status(h->c, status);
}

cJSON *truth_error(const truths *t, int truth, const metrics *e)
{
    const double corrected = metrics_without_noise(e, t->rms[truth], t->noise[truth]);
    cJSON *json = record_error(truth_names[truth], e);
    cJSON_AddNumberToObject(json, "noise", t->noise[truth]);
    cJSON_AddItemToObject(json, "rmse_rms_corrected",
                          isfinite(corrected) ? cJSON_CreateNumber(corrected) : cJSON_CreateNull());
    return json;
}
