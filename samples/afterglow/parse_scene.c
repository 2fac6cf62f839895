// SPDX-License-Identifier: MIT
#include "cli.h"

#include <math.h>
#include <string.h>

// Lights and cameras as the command line writes them: parts with colons between.
enum { MAX_PARTS = 5, MAX_TEXT = 256 };

static int split(const char *text, char copy[MAX_TEXT], const char *parts[MAX_PARTS])
{
    int count = 0;
    if (strlen(text) >= MAX_TEXT)
        return 0;
    memcpy(copy, text, strlen(text) + 1);
    for (char *at = copy; at; ++count) {
        if (count == MAX_PARTS)
            return 0;
        parts[count] = at;
        at = strchr(at, ':');
        if (at)
            *at++ = 0;
    }
    return count;
}

static bool unit_vector(const char *text, float out[3])
{
    double v[3];
    if (!parse_list(text, 3, v))
        return false;
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0) || !isfinite(length))
        return false;
    for (int i = 0; i < 3; ++i)
        out[i] = (float) (v[i] / length);
    return true;
}

static bool color(const char *text, float out[3])
{
    double v[3];
    if (!parse_list(text, 3, v))
        return false;
    for (int i = 0; i < 3; ++i) {
        if (v[i] < 0 || v[i] > 1e30)
            return false;
        out[i] = (float) v[i];
    }
    return true;
}

static const char *spot_cone(const char *text, ag_light *light)
{
    double angles[2];
    if (!strcmp(text, "cosine")) {
        light->cosine = true;
        light->cos_inner = 1;
        light->cos_outer = 0;
        return NULL;
    }
    if (!parse_list(text, 2, angles) || angles[0] < 0 || angles[0] >= angles[1] || angles[1] > 90)
        return "the cone must be INNER,OUTER in degrees with 0 <= INNER < OUTER <= 90, or cosine";
    light->cos_inner = (float) cos(angles[0] * M_PI / 180);
    light->cos_outer = (float) cos(angles[1] * M_PI / 180);
    return NULL;
}

static const char *const bad_position = "the position must be three numbers: X,Y,Z";
static const char *const bad_direction = "the direction must be three numbers, not all 0: X,Y,Z";
static const char *const bad_color = "the colour must be three numbers from 0 to 1e30: R,G,B";

const char *parse_light(const char *text, ag_light *out)
{
    char copy[MAX_TEXT];
    const char *part[MAX_PARTS];
    const int count = split(text, copy, part);
    *out = (ag_light){ .name = "command line",
                       .cos_inner = 1,
                       .cos_outer = (float) M_SQRT1_2,
                       .direction = { 0, -1, 0 } };
    if (count == 3 && !strcmp(part[0], "point")) {
        out->kind = AG_LIGHT_POINT;
        if (!parse_list(part[1], 3, out->position))
            return bad_position;
        return color(part[2], out->intensity) ? NULL : bad_color;
    }
    if (count == 3 && !strcmp(part[0], "directional")) {
        out->kind = AG_LIGHT_DIRECTIONAL;
        if (!unit_vector(part[1], out->direction))
            return bad_direction;
        return color(part[2], out->intensity) ? NULL : bad_color;
    }
    if ((count == 4 || count == 5) && !strcmp(part[0], "spot")) {
        out->kind = AG_LIGHT_SPOT;
        if (!parse_list(part[1], 3, out->position))
            return bad_position;
        if (!unit_vector(part[2], out->direction))
            return bad_direction;
        if (!color(part[3], out->intensity))
            return bad_color;
        return count == 5 ? spot_cone(part[4], out) : NULL;
    }
    return "must be point:P:RGB, spot:P:D:RGB[:CONE] or directional:D:RGB";
}

const char *parse_camera(const char *text, options *out)
{
    char copy[MAX_TEXT];
    const char *part[MAX_PARTS];
    const int count = split(text, copy, part);
    out->fov = 60;
    if (count != 2 && count != 3)
        return "must be PX,PY,PZ:TX,TY,TZ or PX,PY,PZ:TX,TY,TZ:FOV";
    if (!parse_list(part[0], 3, out->eye) || !parse_list(part[1], 3, out->target))
        return "position and target must be three numbers each: X,Y,Z";
    if (out->eye[0] == out->target[0] && out->eye[1] == out->target[1] &&
        out->eye[2] == out->target[2])
        return "position and target must differ";
    if (count == 3 &&
        (!parse_double(part[2], 0, 180, &out->fov) || out->fov <= 0 || out->fov >= 180))
        return "the field of view must be between 0 and 180 degrees";
    out->camera_at_given = true;
    return NULL;
}
