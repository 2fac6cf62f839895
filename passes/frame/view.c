// SPDX-License-Identifier: MIT
#include <pass/frame.h>
#include <pass/math.h>

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static const char *fault(const ag_camera *c)
{
    if (c->orthographic)
        return !(c->half_height > 0)   ? "half height must be above 0"
               : !(c->zfar > c->znear) ? "the far plane must lie beyond the near one"
               : !isfinite(c->zfar)    ? "the far plane must be finite"
                                       : NULL;
    return !(c->yfov > 0 && (double) c->yfov < pi) ? "field of view must lie in (0, pi)"
           : !(c->znear > 0)                       ? "the near plane must lie before the eye"
                                                   : NULL;
}

static void set_matrices(const ag_camera *c, double aspect, ag_view *v)
{
    static const double eye[3] = { 0 };
    const double forward[3] = { -c->world[8], -c->world[9], -c->world[10] };
    double look[16], proj[16];
    ag_mat_look_to(eye, forward, c->world + 4, look);
    if (c->orthographic)
        ag_mat_orthographic((double) c->half_height * aspect, (double) c->half_height,
                            (double) c->znear, (double) c->zfar, proj);
    else
        ag_mat_perspective((double) c->yfov, aspect, (double) c->znear, (double) INFINITY, proj);
    ag_mat_mul(proj, look, proj);
    ag_mat_to_float(proj, v->view_proj);
    if (!ag_mat_inverse(proj, look)) // beyond what doubles hold: an identity, still finite
        ag_mat_identity(look);
    ag_mat_to_float(look, v->inv_view_proj);
    for (int i = 0; i < 3; i++)
        v->forward[i] = (float) forward[i];
}

fg_status ag_view_from_camera(const fg_log *log, const ag_camera *camera, int width, int height,
                              ag_view *out)
{
    if (width < 1 || height < 1) {
        fg_logf(log, FG_LOG_ERROR, "view: size is %d x %d, must be at least 1 x 1", width, height);
        return FG_ERR_INVALID;
    }
    const char *why = fault(camera);
    if (why) {
        fg_logf(log, FG_LOG_ERROR, "camera %s: %s (yfov %g, half height %g, znear %g, zfar %g)",
                camera->name, why, (double) camera->yfov, (double) camera->half_height,
                (double) camera->znear, (double) camera->zfar);
        return FG_ERR_INVALID;
    }
    memset(out, 0, sizeof *out);
    out->width = width;
    out->height = height;
    out->znear = camera->znear;
    out->orthographic = camera->orthographic;
    for (int i = 0; i < 3; i++)
        out->origin[i] = camera->world[12 + i];
    set_matrices(camera, (double) width / height, out);
    return FG_OK;
}
