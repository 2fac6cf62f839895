// SPDX-License-Identifier: MIT
#include "room.h"

#include <math.h>

fg_status room_create(const fg_log *log, ag_scene **out)
{
    static const ag_vertex corners[] = {
        { { -2, 0, 2 }, { 0, 1, 0 }, .color = { 1, 1, 1, 1 } },
        { { 2, 0, 2 }, { 0, 1, 0 }, .color = { 1, 1, 1, 1 } },
        { { 2, 0, -2 }, { 0, 1, 0 }, .color = { 1, 1, 1, 1 } },
        { { -2, 0, -2 }, { 0, 1, 0 }, .color = { 1, 1, 1, 1 } },
    };
    static const uint32_t indices[] = { 0, 1, 2, 0, 2, 3 };
    ag_builder *b = ag_builder_create(log, "floor and wall");
    if (!b)
        return FG_ERR_MEMORY;
    ag_material red = ag_default_material();
    red.base_color[1] = red.base_color[2] = 0.2f;
    const ag_primitive_desc quad = {
        .name = "quad",
        .vertices = corners,
        .vertex_count = FG_COUNT(corners),
        .indices = indices,
        .index_count = FG_COUNT(indices),
        .material = ag_builder_material(b, &red),
    };
    const int primitive = ag_builder_primitive(b, &quad);
    const ag_node_desc floor = { .name = "floor", .parent = -1 };
    const ag_node_desc wall = { .name = "wall",
                                .parent = -1,
                                .translation = { 0, 0, -2 },
                                .rotation = { sqrt(0.5), 0, 0, sqrt(0.5) } };
    const ag_light light = { .name = "lamp",
                             .position = { 0.5, 1.5, 0 },
                             .direction = { 0, -1, 0 },
                             .intensity = { 5, 5, 5 } };
    ag_builder_show(b, ag_builder_node(b, &floor), primitive, -1);
    ag_builder_show(b, ag_builder_node(b, &wall), primitive, -1);
    const ag_camera camera = { .name = "eye",
                               .world = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 3.5, 1 },
                               .yfov = 0.9f,
                               .znear = 0.01f };
    ag_builder_light(b, -1, &light);
    ag_builder_camera(b, -1, &camera);
    const fg_status status = ag_scene_build(b, out);
    ag_builder_destroy(b);
    return status;
}
