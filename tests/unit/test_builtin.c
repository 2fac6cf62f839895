// SPDX-License-Identifier: MIT
#include "test_builtin.h"

#include "scene_log.h"

#include <math.h>
#include <scenes.h>

ag_scene *open_scene(const char *name)
{
    lines said;
    const fg_log log = log_to(&said);
    ag_scene *scene = NULL;
    const fg_status status = scenes_open(&log, name, &scene);
    if (status != FG_OK)
        fail_msg("%s: %s", name, said.error);
    assert_int_equal(said.errors + said.warnings + said.infos, 0);
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
