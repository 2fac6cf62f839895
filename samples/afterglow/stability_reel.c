// SPDX-License-Identifier: MIT
#include "stability.h"

#include <math.h>
#include <string.h>

fg_status reel_open(stability *s, const room *what, shot view, const char *values, bool all,
                    reel *out)
{
    *out = (reel){ .s = s };
    fg_status status =
        all ? stability_with(s, values, &out->own) : stability_with_known(s, values, &out->own);
    if (status == FG_OK)
        status = stability_room(&s->log, what, &out->scene);
    view.scene = out->scene;
    view.layer = LAYER_INDIRECT;
    view.values = out->own.values;
    return status == FG_OK ? stability_open(s, &view, &out->r) : status;
}

void reel_close(reel *r)
{
    renderer_destroy(r->r);
    ag_scene_destroy(r->scene);
    setting_finish(&r->own);
    *r = (reel){ 0 };
}

fg_status reel_run(reel *r, double time, double step, int count)
{
    fg_status status = FG_OK;
    for (int i = 0; i < count && status == FG_OK; ++i)
        status = renderer_frame(r->r, time + i * step);
    return status;
}

fg_status reel_picture(reel *r, image *out)
{
    *out = (image){ 0 };
    return renderer_read(r->r, LAYER_INDIRECT, out);
}

fg_status reel_mean(reel *r, double *out)
{
    image img;
    const fg_status status = reel_picture(r, &img);
    if (status == FG_OK)
        *out = stability_mean(&img);
    image_finish(&img);
    return status;
}

double reel_counter(const reel *r, const char *name)
{
    enum { MOST = 32 };
    gi_counter counters[MOST];
    const int count = renderer_counters(r->r, counters, MOST);
    for (int i = 0; i < count && i < MOST; ++i)
        if (!strcmp(counters[i].name, name))
            return counters[i].value;
    return (double) NAN;
}

fg_status reel_fresh(stability *s, const room *what, shot view, const char *values, double time,
                     image *out)
{
    reel r;
    *out = (image){ 0 };
    fg_status status = reel_open(s, what, view, values, false, &r);
    if (status == FG_OK)
        status = reel_run(&r, time, 0, 1);
    if (status == FG_OK)
        status = reel_picture(&r, out);
    reel_close(&r);
    return status;
}
