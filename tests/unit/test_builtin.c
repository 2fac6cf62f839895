// SPDX-License-Identifier: MIT
#include "test_builtin.h"

#include <scenes.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

typedef struct record {
    int errors, others;
    char last[1024];
} record;

static void remember(void *user, fg_log_level level, const char *msg)
{
    record *r = user;
    r->errors += level == FG_LOG_ERROR;
    r->others += level != FG_LOG_ERROR;
    snprintf(r->last, sizeof r->last, "%s", msg);
}

ag_scene *open_scene(const char *name)
{
    record r = { 0 };
    const fg_log log = { .fn = remember, .user = &r, .level = FG_LOG_INFO };
    ag_scene *scene = NULL;
    const fg_status status = scenes_open(&log, name, &scene);
    if (status != FG_OK)
        fail_msg("%s: %s", name, r.last);
    assert_int_equal(r.errors + r.others, 0);
    return scene;
}

mesh primitive_mesh(const ag_scene *s, int i)
{
    const ag_primitive *p = &s->primitives[i];
    return (mesh){ s->vertices + p->first_vertex, p->vertex_count, s->indices + p->first_index,
                   p->index_count };
}

double length3(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}
