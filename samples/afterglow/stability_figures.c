// SPDX-License-Identifier: MIT
#include "metrics.h"
#include "stability.h"

#include <math.h>
#include <string.h>

// ---- figures of pictures ---------------------------------------------------------------------

size_t stability_values(const image *img)
{
    return 3 * (size_t) img->width * (size_t) img->height;
}

double stability_mean(const image *img)
{
    double sum = 0;
    for (size_t i = 0; i < stability_values(img); ++i)
        sum += (double) img->rgb[i];
    return sum / (double) stability_values(img);
}

double stability_most(const image *img)
{
    double most = 0;
    for (size_t i = 0; i < stability_values(img); ++i)
        most = fmax(most, (double) img->rgb[i]);
    return most;
}

double stability_change(double a, double b)
{
    return a == b ? 0 : fabs(a - b) / fmax(fabs(b), 1e-30);
}

static uint32_t bits(float value)
{
    uint32_t out;
    memcpy(&out, &value, sizeof out);
    return out;
}

long stability_differing(const image *a, const image *b)
{
    long count = 0;
    for (size_t i = 0; i < stability_values(a); ++i)
        count += bits(a->rgb[i]) != bits(b->rgb[i]);
    return count;
}

fg_status stability_rmse(stability *s, const image *a, const image *b, double *out)
{
    metrics m;
    const fg_status status = metrics_compare(&s->log, a, b, &m);
    if (status == FG_OK)
        *out = m.rmse_rms;
    return status;
}

// ---- a room, a shot, a figure ----------------------------------------------------------------

fg_status stability_shoot(stability *s, const room *what, shot view, image *out)
{
    fg_status status = stability_room(&s->log, what, &view.scene);
    *out = (image){ 0 };
    if (status == FG_OK)
        status = stability_render(s, &view, out);
    ag_scene_destroy(view.scene);
    return status;
}

fg_status stability_figure(stability *s, const room *what, shot view, stability_figure_fn figure,
                           double *out)
{
    image img;
    const fg_status status = stability_shoot(s, what, view, &img);
    if (status == FG_OK)
        *out = figure(&img);
    image_finish(&img);
    return status;
}

// Only the checks of every buffer count.
fg_status stability_checks(stability *s, const room *what, shot view, double *out)
{
    const fg_status status = stability_figure(s, what, view, stability_most, out);
    *out = (double) s->bad;
    return status;
}
