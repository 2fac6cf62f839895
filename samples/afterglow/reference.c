// SPDX-License-Identifier: MIT
#include "reference_priv.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TILE = 16, MAX_THREADS = 256 };

// What the threads share. `lock` guards what follows it.
typedef struct job {
    const reference_desc *desc;
    tracer tracer;
    image *out;
    int columns, tiles; // tiles across, and in all
    pthread_mutex_t lock;
    int taken, done;
    bool failed;
} job;

// ---- what is asked ------------------------------------------------------------------

static bool camera_valid(const ag_camera *camera)
{
    for (int i = 0; i < 16; ++i)
        if (!isfinite(camera->world[i]))
            return false;
    if (camera->orthographic)
        return camera->half_height > 0 && isfinite(camera->half_height) &&
               camera->zfar > camera->znear;
    return camera->yfov > 0 && (double) camera->yfov < 3.14159265358979 && camera->znear > 0;
}

static fg_status refuse(const reference_desc *d, const char *what, int value, const char *rule)
{
    fg_logf(d->log, FG_LOG_ERROR, "reference: %s is %d, must be %s", what, value, rule);
    return FG_ERR_INVALID;
}

static fg_status check(const reference_desc *d)
{
    if (!d->scene || !d->camera || !camera_valid(d->camera)) {
        fg_logf(d->log, FG_LOG_ERROR, "reference: needs a scene and a camera that is finite");
        return FG_ERR_INVALID;
    }
    if (d->bounces < 0 || d->bounces > 64)
        return refuse(d, "bounces", d->bounces, "0 to 64");
    if (d->spp < 1 || d->spp > 1048576)
        return refuse(d, "spp", d->spp, "1 to 1048576");
    if (d->threads < 0)
        return refuse(d, "threads", d->threads, "0 or more");
    if ((int) d->layer < 0 || d->layer > REFERENCE_POSITION)
        return refuse(d, "layer", (int) d->layer, "one of reference_layer");
    if ((int) d->filter < 0 || d->filter > REFERENCE_BOX)
        return refuse(d, "filter", (int) d->filter, "one of reference_filter");
    if (d->unshadowed_bounce && d->bounces < 1)
        return refuse(d, "bounces", d->bounces, "1 or more for unshadowed bounces");
    return FG_OK;
}

// ---- pixels -------------------------------------------------------------------------

// What the camera sees at (x, y), in pixels from the top left corner. Distances along the ray
// are those along the view axis: a perspective camera sees all beyond its near plane.
static bool see(const job *j, double x, double y, point *p, ag_hit *hit)
{
    const ag_camera *c = j->desc->camera;
    const double aspect = (double) j->desc->width / j->desc->height;
    const double sx = (2 * x / j->desc->width - 1) * aspect, sy = 1 - 2 * y / j->desc->height;
    const double half = c->orthographic ? (double) c->half_height : tan((double) c->yfov / 2);
    float from[3], direction[3];
    for (int k = 0; k < 3; ++k) {
        const double across = half * (sx * c->world[k] + sy * c->world[4 + k]);
        from[k] = c->orthographic ? (float) across : 0;
        direction[k] = (float) ((c->orthographic ? 0 : across) - c->world[8 + k]);
    }
    if (!ag_rays_nearest(j->tracer.rays, from, direction, c->znear,
                         c->orthographic ? c->zfar : INFINITY, hit))
        return false;
    point_of(&j->tracer, hit, p);
    return true;
}

static bool wants_indirect(const reference_desc *d)
{
    return d->bounces > 0 && (d->layer == REFERENCE_RADIANCE || d->layer == REFERENCE_INDIRECT);
}

// All of the layer but indirect light.
static void plain_value(const job *j, const point *p, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    if (j->desc->layer == REFERENCE_RADIANCE || j->desc->layer == REFERENCE_DIRECT)
        point_direct(&j->tracer, p, out);
    for (int k = 0; k < 3; ++k) {
        if (j->desc->layer == REFERENCE_ALBEDO)
            out[k] = p->albedo[k];
        if (j->desc->layer == REFERENCE_NORMAL)
            out[k] = p->normal[k];
        if (j->desc->layer == REFERENCE_POSITION)
            out[k] = j->tracer.origin[k] + (double) p->position[k];
    }
}

static bool add_indirect(const job *j, const point *p, sampler s, uint32_t index, hit_list *list,
                         double sum[3])
{
    double sample[3];
    if (!point_indirect(&j->tracer, p, s, index, list, sample))
        return false;
    for (int k = 0; k < 3; ++k)
        sum[k] += sample[k];
    return true;
}

// At the centre of a pixel all but the bounces is the same for every sample.
static bool point_pixel(const job *j, int x, int y, hit_list *list, double out[3])
{
    point p;
    ag_hit hit;
    double bounced[3] = { 0 };
    const sampler s = sampler_of(j->desc->seed, x, y);
    const uint32_t spp = wants_indirect(j->desc) ? (uint32_t) j->desc->spp : 0;
    out[0] = out[1] = out[2] = 0;
    if (!see(j, x + 0.5, y + 0.5, &p, &hit))
        return true;
    plain_value(j, &p, out);
    for (uint32_t i = 0; i < spp; ++i)
        if (!add_indirect(j, &p, s, i, list, bounced))
            return false;
    for (int k = 0; k < 3 && spp; ++k)
        out[k] += bounced[k] / spp;
    return true;
}

static bool box_pixel(const job *j, int x, int y, hit_list *list, double out[3])
{
    const sampler s = sampler_of(j->desc->seed, x, y);
    const uint32_t spp = (uint32_t) j->desc->spp;
    double sum[3] = { 0 };
    for (uint32_t i = 0; i < spp; ++i) {
        point p;
        ag_hit hit;
        double jitter[2], plain[3];
        sampler_pair(s, i, 0, jitter);
        if (!see(j, x + jitter[0], y + jitter[1], &p, &hit))
            continue;
        plain_value(j, &p, plain);
        for (int k = 0; k < 3; ++k)
            sum[k] += plain[k];
        if (wants_indirect(j->desc) && !add_indirect(j, &p, s, i, list, sum))
            return false;
    }
    for (int k = 0; k < 3; ++k)
        out[k] = sum[k] / spp;
    return true;
}

static bool render_tile(const job *j, int tile, hit_list *list)
{
    const int x0 = tile % j->columns * TILE, y0 = tile / j->columns * TILE;
    const int width = j->desc->width, height = j->desc->height;
    const bool box = j->desc->filter == REFERENCE_BOX;
    for (int y = y0; y < y0 + TILE && y < height; ++y)
        for (int x = x0; x < x0 + TILE && x < width; ++x) {
            double rgb[3];
            if (!(box ? box_pixel(j, x, y, list, rgb) : point_pixel(j, x, y, list, rgb)))
                return false;
            float *to = j->out->rgb + 3 * ((size_t) y * (size_t) width + (size_t) x);
            for (int k = 0; k < 3; ++k)
                to[k] = (float) fmin(rgb[k], 3e38);
        }
    return true;
}

// ---- threads ------------------------------------------------------------------------

// The next tile, -1: no more. `finished`: whether the caller has just done one.
static int next_tile(job *j, bool finished)
{
    int tile = -1;
    pthread_mutex_lock(&j->lock);
    if (finished) {
        ++j->done;
        if (j->desc->progress)
            j->desc->progress(j->desc->progress_user, (double) j->done / j->tiles);
    }
    if (j->taken < j->tiles && !j->failed)
        tile = j->taken++;
    pthread_mutex_unlock(&j->lock);
    return tile;
}

static void *work(void *user)
{
    job *j = user;
    hit_list list = { 0 };
    for (int tile = next_tile(j, false); tile >= 0; tile = next_tile(j, true))
        if (!render_tile(j, tile, &list)) {
            pthread_mutex_lock(&j->lock);
            j->failed = true;
            pthread_mutex_unlock(&j->lock);
            break;
        }
    free(list.hits);
    return NULL;
}

// This thread works too; where others cannot be had it works alone.
static void run(job *j)
{
    pthread_t others[MAX_THREADS];
    long threads = j->desc->threads ? j->desc->threads : sysconf(_SC_NPROCESSORS_ONLN);
    int started = 0;
    threads = threads > MAX_THREADS ? MAX_THREADS : threads;
    while (started < threads - 1 && pthread_create(others + started, NULL, work, j) == 0)
        ++started;
    work(j);
    while (started > 0)
        pthread_join(others[--started], NULL);
}

fg_status reference_render(const reference_desc *desc, image *out)
{
    ag_rays *rays;
    *out = (image){ 0 };
    fg_status status = check(desc);
    if (status == FG_OK)
        status = image_create(desc->log, desc->width, desc->height, out);
    if (status != FG_OK)
        return status;
    job j = { .desc = desc, .out = out };
    ag_rays_desc rays_desc = { .log = desc->log, .scene = desc->scene, .threads = desc->threads };
    memcpy(j.tracer.origin, desc->camera->world + 12, sizeof j.tracer.origin);
    memcpy(rays_desc.origin, j.tracer.origin, sizeof rays_desc.origin);
    status = ag_rays_create(&rays_desc, &rays);
    if (status == FG_OK) {
        j.tracer.scene = desc->scene;
        j.tracer.rays = rays;
        j.tracer.bounces = desc->bounces;
        j.tracer.unshadowed = desc->unshadowed_bounce;
        j.columns = (desc->width + TILE - 1) / TILE;
        j.tiles = j.columns * ((desc->height + TILE - 1) / TILE);
        pthread_mutex_init(&j.lock, NULL);
        j.failed = !lights_prepare(&j.tracer);
        if (!j.failed)
            run(&j);
        lights_finish(&j.tracer);
        pthread_mutex_destroy(&j.lock);
        ag_rays_destroy(rays);
    }
    if (j.failed) {
        fg_logf(desc->log, FG_LOG_ERROR, "reference: out of memory");
        status = FG_ERR_MEMORY;
    }
    if (status != FG_OK)
        image_finish(out);
    return status;
}

// ---- twice --------------------------------------------------------------------------

// Of one of the two: where the progress of both is.
typedef struct half {
    const reference_desc *desc;
    int number;
} half;

static void half_progress(void *user, double fraction)
{
    const half *h = user;
    h->desc->progress(h->desc->progress_user, (h->number + fraction) / 2);
}

static fg_status render_half(const reference_desc *desc, int number, image *out)
{
    half h = { desc, number };
    reference_desc d = *desc;
    d.spp = (int) (((int64_t) desc->spp + 1) / 2);
    d.seed = 2 * desc->seed + (uint64_t) number;
    d.progress = desc->progress ? half_progress : NULL;
    d.progress_user = &h;
    return reference_render(&d, out);
}

fg_status reference_render_halves(const reference_desc *desc, image *out, double *noise)
{
    image other = { 0 };
    double sum = 0;
    *noise = 0;
    fg_status status = render_half(desc, 0, out);
    if (status == FG_OK)
        status = render_half(desc, 1, &other);
    const size_t count = 3 * (size_t) out->width * (size_t) out->height;
    for (size_t i = 0; status == FG_OK && i < count; ++i) {
        const double diff = (double) out->rgb[i] - (double) other.rgb[i];
        sum += diff * diff;
        out->rgb[i] = 0.5f * (out->rgb[i] + other.rgb[i]);
    }
    if (status == FG_OK)
        *noise = 0.5 * sqrt(sum / (double) count);
    else
        image_finish(out);
    image_finish(&other);
    return status;
}
