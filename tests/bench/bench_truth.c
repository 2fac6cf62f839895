// SPDX-License-Identifier: MIT
// What pictures of indirect light are measured against.
#include "bench.h"

#include "reference.h"

#include <math.h>

fg_status truth_render(const bench *b, const truth_desc *d, truth *out)
{
    const reference_desc desc = {
        .log = &b->log,
        .scene = b->scene,
        .camera = &b->scene->cameras[b->camera],
        .width = d->size[0],
        .height = d->size[1],
        .bounces = 1,
        .spp = d->spp,
        .seed = d->seed,
        .layer = REFERENCE_INDIRECT,
        .unshadowed_bounce = d->unshadowed,
    };
    *out = (truth){ 0 };
    fg_status status = reference_render_halves(&desc, &out->picture, &out->noise);
    const size_t count = 3 * (size_t) d->size[0] * (size_t) d->size[1];
    double squares = 0;
    for (size_t i = 0; i < count && status == FG_OK; i++)
        squares += (double) out->picture.rgb[i] * (double) out->picture.rgb[i];
    out->rms = sqrt(squares / (double) count);
    return status;
}

void truth_finish(truth *t)
{
    image_finish(&t->picture);
}

fg_status truth_compare(const bench *b, const truth *t, const image *picture, truth_error *out)
{
    const fg_status status = metrics_compare(&b->log, picture, &t->picture, &out->m);
    out->rmse_rms = metrics_without_noise(&out->m, t->rms, t->noise);
    return status;
}

static fg_status write_light(const bench *b, const image *picture, double exposure,
                             const char *path)
{
    image shown = { 0 };
    fg_status status = image_create(&b->log, picture->width, picture->height, &shown);
    const size_t count = 3 * (size_t) picture->width * (size_t) picture->height;
    for (size_t i = 0; i < count && status == FG_OK; i++)
        shown.rgb[i] = (float) (exposure * (double) picture->rgb[i]);
    if (status == FG_OK)
        status = image_write(&b->log, path, &shown, IMAGE_LIGHT);
    image_finish(&shown);
    return status;
}

fg_status truth_write(const bench *b, const truth *t, const image *picture, const char *name)
{
    char path[1024];
    image map = { 0 };
    if (!b->pictures || !(t->rms > 0))
        return FG_OK;
    snprintf(path, sizeof path, "%s/%s.png", b->pictures, name);
    fg_status status = write_light(b, picture, 0.4 / t->rms, path);
    if (status == FG_OK)
        status = metrics_error_map(&b->log, picture, &t->picture, 0.5 * t->rms, &map);
    snprintf(path, sizeof path, "%s/%s_error.png", b->pictures, name);
    if (status == FG_OK)
        status = image_write(&b->log, path, &map, IMAGE_LIGHT);
    image_finish(&map);
    return status;
}
