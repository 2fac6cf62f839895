// SPDX-License-Identifier: MIT
// Goods, and the racks that are full of them.
#include "factory_priv.h"

#include <math.h>

// A box of which each side shows the whole texture.
static void add_carton(shape *s, const float middle[3], const float size[3])
{
    const size_t first = s->vertex_count;
    const float half[3] = { 0.5f * size[0], size[1], 0.5f * size[2] };
    shape_box(s, (float[3]){ middle[0] - half[0], middle[1], middle[2] - half[2] },
              (float[3]){ middle[0] + half[0], middle[1] + half[1], middle[2] + half[2] });
    // shape_box() writes four vertices a face, left to right, then bottom to top.
    for (size_t i = first; i < s->vertex_count; ++i) {
        const size_t corner = (i - first) % 4;
        s->vertices[i].uv[0][0] = corner & 1 ? 1.0f : 0.0f;
        s->vertices[i].uv[0][1] = corner & 2 ? 0.0f : 1.0f;
    }
}

static int pallet_part(factory *f)
{
    shape s = { .tiling = 1.0f };
    for (int i = 0; i < 5; ++i) {
        const float z = -0.40f + 0.176f * (float) i;
        shape_box(&s, (float[3]){ -0.6f, 0.118f, z }, (float[3]){ 0.6f, 0.14f, z + 0.096f });
    }
    for (int i = 0; i < 3; ++i) {
        const float x = -0.6f + 0.53f * (float) i;
        shape_box(&s, (float[3]){ x, 0, -0.4f }, (float[3]){ x + 0.14f, 0.118f, 0.4f });
    }
    return factory_part(f, "pallet", &s, FACTORY_PALLET);
}

// Cartons in layers on 1.2 x 0.8 m.
static int stack_part(factory *f, int which)
{
    static const int layout[4][3] = {
        { 3, 2, 2 }, { 2, 2, 2 }, { 4, 2, 3 }, { 2, 1, 1 }
    }; // x, z, up
    const int *n = layout[which];
    const float size[3] = { 1.16f / (float) n[0], (which == 3 ? 0.72f : 0.98f) / (float) n[2],
                            0.78f / (float) n[1] };
    uint32_t state = 5u + 7u * (uint32_t) which;
    shape s = { 0 };
    for (int y = 0; y < n[2]; ++y)
        for (int i = 0; i < n[0] * n[1]; ++i) {
            // The top layer has been taken from.
            if (y == n[2] - 1 && n[2] > 1 && shape_draw(&state) < 0.3f)
                continue;
            const int column = i % n[0], row = i / n[0];
            const float at[3] = { -0.58f + size[0] * ((float) column + 0.5f), size[1] * (float) y,
                                  -0.39f + size[2] * ((float) row + 0.5f) };
            const float wide = size[0] - 0.012f - 0.01f * shape_draw(&state);
            const float deep = size[2] - 0.012f - 0.01f * shape_draw(&state);
            const float own[3] = { wide, size[1] - 0.003f, deep };
            add_carton(&s, at, own);
        }
    return factory_part(f, "stack", &s, which == 2 ? FACTORY_WHITE_CARTON : FACTORY_CARTON);
}

static int crate_part(factory *f)
{
    shape s = { 0 };
    shape_round_box(&s, (float[3]){ -0.29f, 0, -0.19f }, (float[3]){ 0.29f, 0.29f, 0.19f }, 0.02f,
                    2);
    shape_box(&s, (float[3]){ -0.305f, 0.27f, -0.205f }, (float[3]){ 0.305f, 0.31f, 0.205f });
    for (int i = 0; i < 4; ++i) {
        const float x = -0.21f + 0.14f * (float) i;
        shape_box(&s, (float[3]){ x - 0.01f, 0.02f, -0.20f },
                  (float[3]){ x + 0.01f, 0.27f, 0.20f });
    }
    return factory_part(f, "crate", &s, FACTORY_CRATE);
}

static void make_goods(factory *f)
{
    shape s = { 0 };
    add_carton(&s, (float[3]){ 0 }, (float[3]){ 0.62f, 0.46f, 0.52f });
    f->goods.carton = factory_part(f, "carton", &s, FACTORY_CARTON);
    add_carton(&s, (float[3]){ 0 }, (float[3]){ 0.78f, 0.60f, 0.60f });
    f->goods.white_carton = factory_part(f, "white carton", &s, FACTORY_WHITE_CARTON);
    f->goods.crate = crate_part(f);
    f->goods.pallet = pallet_part(f);
    for (int i = 0; i < 4; ++i)
        f->goods.stacks[i] = stack_part(f, i);
}

// ---- racks --------------------------------------------------------------------------

static const float rack_bay = 2.75f, rack_level = 1.75f;
enum { RACK_BAYS = 11, RACK_LEVELS = 3 };

// Two uprights with their braces, across the rack at x = 0; 1.0 m deep.
static int upright_part(factory *f)
{
    const float top = 5.4f;
    shape s = { 0 };
    for (int i = 0; i < 2; ++i) {
        const float z = i ? 0.45f : -0.50f;
        shape_box(&s, (float[3]){ -0.05f, 0, z }, (float[3]){ 0.05f, top, z + 0.05f });
    }
    for (int i = 0; i < 6; ++i) {
        const float y = 0.3f + 0.85f * (float) i, up = i % 2 ? 0.75f : 0.0f;
        const float brace[2][3] = { { 0, y + up, -0.475f }, { 0, y + 0.75f - up, 0.475f } };
        shape_tube(&s, &(shape_tube_desc){ brace, 2, 0.018f, 6 });
    }
    return factory_part(f, "upright", &s, FACTORY_RACK);
}

// The beams of one bay from x = 0 on, all levels above the ground.
static int beams_part(factory *f)
{
    shape s = { 0 };
    for (int level = 1; level <= RACK_LEVELS; ++level)
        for (int i = 0; i < 2; ++i) {
            const float y = rack_level * (float) level - 0.12f, z = i ? 0.46f : -0.51f;
            shape_box(&s, (float[3]){ 0.05f, y, z },
                      (float[3]){ rack_bay - 0.05f, y + 0.12f, z + 0.05f });
        }
    return factory_part(f, "beams", &s, FACTORY_BEAM);
}

// Two pallets a bay and level, some places empty.
static void fill_bay(factory *f, int rack, float x, uint32_t *state)
{
    for (int i = 0; i < 2 * (RACK_LEVELS + 1); ++i) {
        const int level = i / 2;
        const float off = 0.04f * (shape_draw(state) - 0.5f);
        const float yaw = 0.05f * (shape_draw(state) - 0.5f);
        const place at = { (double) x + 0.72 + 1.31 * (i % 2),
                           (double) (rack_level * (float) level), (double) off, (double) yaw };
        if (shape_draw(state) < 0.14f)
            continue;
        const int node = kit_show(&f->k, "pallet", f->goods.pallet, rack, at);
        const int which = (int) (3.6f * shape_draw(state));
        const int stack = f->goods.stacks[which > 3 ? 3 : which];
        kit_show(&f->k, "stack", stack, node, (place){ 0, 0.14, 0, 0 });
    }
}

static void add_racks(factory *f)
{
    const int upright = upright_part(f), beams = beams_part(f);
    const float length = rack_bay * RACK_BAYS;
    uint32_t state = 29u;
    for (int side = 0; side < 2; ++side) {
        const place at = { side ? -1.0 : 0.6, 0, side ? 10.55 : -10.55, 0 };
        const int rack = kit_node(&f->k, "rack", -1, at);
        // The gate keeps the far end of the one beside it free.
        for (int i = 0; i <= RACK_BAYS - side; ++i) {
            const float x = -0.5f * length + rack_bay * (float) i;
            kit_show(&f->k, "upright", upright, rack, (place){ (double) x, 0, 0, 0 });
            if (i == RACK_BAYS - side)
                continue;
            kit_show(&f->k, "beams", beams, rack, (place){ (double) x, 0, 0, 0 });
            fill_bay(f, rack, x, &state);
        }
    }
}

// Pallets set down between the lines and beside the gate.
static void add_floor_stock(factory *f)
{
    static const place where[] = {
        { -9.0, 0, 0.5, 0.1 },  { -9.1, 0, -0.6, -0.05 }, { -7.4, 0, 0.1, 1.5 },
        { 8.6, 0, 0.6, 0.0 },   { 8.5, 0, -0.5, 0.12 },   { 7.0, 0, 0.0, 1.6 },
        { 16.6, 0, 10.6, 0.0 }, { 18.1, 0, 10.7, 0.1 },   { 17.3, 0, -11.0, 0.2 },
        { 18.6, 0, -9.9, 1.4 }, { -18.4, 0, -9.8, 0.3 },  { -18.6, 0, 9.9, 1.2 },
        { -18.5, 0, 8.4, 0.1 }, { -1.2, 0, 0.3, 0.4 },
    };
    for (int i = 0; i < FG_COUNT(where); ++i) {
        const int node = kit_show(&f->k, "pallet", f->goods.pallet, -1, where[i]);
        kit_show(&f->k, "stack", f->goods.stacks[i % 4], node, (place){ 0, 0.14, 0, 0 });
        if (i % 3 == 0)
            kit_show(&f->k, "crate", f->goods.crate, node, (place){ 0.95, -0.0, 0.35, 0.4 });
    }
}

void factory_add_store(factory *f)
{
    make_goods(f);
    add_racks(f);
    add_floor_stock(f);
}
