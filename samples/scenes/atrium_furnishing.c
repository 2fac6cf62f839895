// SPDX-License-Identifier: MIT
#include "atrium_priv.h"

#include <math.h>

#define PROFILE(array) (const float(*)[2]) array, FG_COUNT(array)

// A turned thing of 20 segments, 40 where it is wider than a metre.
static int add_turned(atrium *a, const char *name, atrium_material material,
                      const float (*profile)[2], int count)
{
    float widest = 0.0f;
    for (int i = 0; i < count; ++i)
        widest = fmaxf(widest, profile[i][0]);
    const shape_lathe_desc d = { .profile = profile,
                                 .count = count,
                                 .segments = widest > 1.0f ? 40 : 20 };
    shape s = { .tiling = 1.0f };
    shape_lathe(&s, &d);
    return kit_part(&a->k, name, &s, a->material[material]);
}

// A fountain of two basins in the middle of the court.
static void add_fountain(atrium *a)
{
    static const float basin[][2] = {
        { 0, -0.05f },    { 1.62f, -0.05f }, { 1.62f, 0.10f }, { 1.50f, 0.13f }, { 1.46f, 0.40f },
        { 1.52f, 0.44f }, { 1.58f, 0.46f },  { 1.58f, 0.54f }, { 1.55f, 0.56f }, { 1.32f, 0.56f },
        { 1.29f, 0.54f }, { 1.27f, 0.12f },  { 0, 0.12f },
    };
    static const float stem[][2] = {
        { 0, 0.1f },      { 0.30f, 0.1f },  { 0.30f, 0.30f }, { 0.17f, 0.42f }, { 0.13f, 0.62f },
        { 0.19f, 0.78f }, { 0.13f, 0.92f }, { 0.12f, 1.02f }, { 0.34f, 1.10f }, { 0.62f, 1.24f },
        { 0.68f, 1.32f }, { 0.66f, 1.34f }, { 0.60f, 1.32f }, { 0.34f, 1.19f }, { 0.12f, 1.17f },
        { 0.08f, 1.40f }, { 0.13f, 1.52f }, { 0.10f, 1.64f }, { 0.04f, 1.68f }, { 0, 1.72f },
    };
    static const float pool[][2] = { { 1.285f, 0.40f }, { 0, 0.40f } };
    static const float bowl[][2] = { { 0.53f, 1.275f }, { 0, 1.275f } };
    const int stone = add_turned(a, "basin", ATRIUM_LIMESTONE, PROFILE(basin));
    const int middle = add_turned(a, "stem", ATRIUM_LIMESTONE, PROFILE(stem));
    const int water = add_turned(a, "pool", ATRIUM_WATER, PROFILE(pool));
    const int upper = add_turned(a, "bowl water", ATRIUM_WATER, PROFILE(bowl));
    const int root = kit_node(&a->k, "fountain", -1, (place){ 0 });
    const int parts[] = { stone, middle, water, upper };
    for (int i = 0; i < FG_COUNT(parts); ++i)
        kit_show(&a->k, "fountain", parts[i], root, (place){ 0 });
}

// Orange trees and bushes in clay pots.
static void add_plants(atrium *a)
{
    static const float pot[][2] = {
        { 0, 0 },          { 0.24f, 0 },     { 0.25f, 0.03f }, { 0.33f, 0.38f },
        { 0.345f, 0.46f }, { 0.39f, 0.48f }, { 0.40f, 0.55f }, { 0.385f, 0.57f },
        { 0.345f, 0.57f }, { 0.33f, 0.50f }, { 0, 0.50f },
    };
    static const float trunk[][3] = {
        { 0, 0.45f, 0 }, { 0.03f, 0.9f, 0.01f }, { -0.01f, 1.4f, 0.03f }, { 0, 1.9f, 0 }
    };
    static const double trees[][2] = { { -4.6, 3.0 }, { 4.6, 2.4 }, { 4.6, -2.4 }, { -4.6, -3.0 } };
    static const double bushes[][2] = {
        { -7.5, 3.55 }, { 7.5, 3.55 }, { 7.5, -3.55 }, { -1.5, -3.55 }, { 1.5, 3.55 },
    };
    const shape_tube_desc stem = { .path = trunk, .count = 4, .radius = 0.045f, .segments = 8 };
    const int clay = add_turned(a, "pot", ATRIUM_CLAY, PROFILE(pot));
    shape s = { 0 }, crown = { 0 }, bush = { 0 };
    shape_tube(&s, &stem);
    shape_crown(&crown,
                &(shape_crown_desc){ { 0, 2.25f, 0 }, { 0.75f, 0.8f, 0.75f }, 0.34f, 260, 7u });
    shape_crown(&bush,
                &(shape_crown_desc){ { 0, 0.75f, 0 }, { 0.42f, 0.38f, 0.42f }, 0.34f, 110, 8u });
    const int wood = kit_part(&a->k, "trunk", &s, a->material[ATRIUM_WOOD]);
    const int leaves = kit_part(&a->k, "crown", &crown, a->material[ATRIUM_LEAVES]);
    const int low = kit_part(&a->k, "bush", &bush, a->material[ATRIUM_LEAVES]);
    for (int i = 0; i < FG_COUNT(trees); ++i) {
        const int node =
            kit_show(&a->k, "tree", clay, -1, (place){ trees[i][0], 0, trees[i][1], 1.1 * i });
        kit_show(&a->k, "trunk", wood, node, (place){ 0 });
        kit_show(&a->k, "crown", leaves, node, (place){ 0 });
    }
    for (int i = 0; i < FG_COUNT(bushes); ++i) {
        const int node = kit_show(&a->k, "bush pot", clay, -1,
                                  (place){ bushes[i][0], 0, bushes[i][1], 0.8 * i });
        kit_show(&a->k, "bush", low, node, (place){ 0 });
    }
}

// Ivy up a corner pier and over the arches beside it; local to a long side.
static void add_ivy(atrium *a)
{
    uint32_t state = 77u;
    shape s = { 0 };
    for (int i = 0; i < 620; ++i) {
        // Thick along the foot and the string course, thinner away from the pier.
        const float climb = shape_draw(&state), spread = shape_draw(&state) * shape_draw(&state);
        const float y = 0.2f + 6.2f * climb;
        const float reach = 0.5f + 3.2f * expf(-2.5f * (climb - 0.62f) * (climb - 0.62f) * 9.0f);
        const float x = -8.75f + reach * spread;
        const bool over_arch =
            y < 4.2f && x > -8.6f && hypotf(x + 7.5f, fmaxf(y - 2.9f, 0.0f)) < 1.42f;
        if (over_arch || y > 4.5f + 0.95f * (x + 9.9f))
            continue;
        const float out = y > 4.2f && y < 4.6f ? -0.44f : y > 4.5f ? -0.22f : -0.32f;
        const float at[3] = { x, y, x < -8.5f ? out - 0.12f : out };
        shape_card(&s, at, (float[3]){ 0, 0.15f, -1 }, 0.26f, &state);
    }
    const int part = kit_part(&a->k, "ivy", &s, a->material[ATRIUM_LEAVES]);
    kit_show(&a->k, "ivy", part, a->side[0], (place){ 0, 0, atrium_distance(0), 0 });
    kit_show(&a->k, "ivy", part, a->side[2], (place){ 0, 0, atrium_distance(2), 0 });
}

// Tall jars along the galleries.
static void add_jars(atrium *a)
{
    static const float jar[][2] = {
        { 0, 0 },          { 0.15f, 0 },      { 0.17f, 0.02f },  { 0.16f, 0.06f },
        { 0.20f, 0.16f },  { 0.27f, 0.32f },  { 0.315f, 0.50f }, { 0.32f, 0.62f },
        { 0.285f, 0.76f }, { 0.21f, 0.88f },  { 0.145f, 0.95f }, { 0.13f, 1.00f },
        { 0.14f, 1.04f },  { 0.19f, 1.08f },  { 0.195f, 1.11f }, { 0.17f, 1.115f },
        { 0.115f, 1.05f }, { 0.105f, 0.98f }, { 0.12f, 0.93f },  { 0.24f, 0.78f },
        { 0.27f, 0.55f },  { 0, 0.10f },
    };
    const int part = add_turned(a, "jar", ATRIUM_CLAY, PROFILE(jar));
    const int blue = add_turned(a, "glazed jar", ATRIUM_BLUE, PROFILE(jar));
    for (int side = 0; side < 4; ++side) {
        for (int k = 0; k < atrium_bays(side); k += 2) {
            const place low = { atrium_bay_centre(side, k) + 0.85, atrium_floor[0],
                                atrium_distance(side) + 2.45, 0.4 * k };
            const place high = { atrium_bay_centre(side, k) - 0.9, atrium_floor[1],
                                 atrium_distance(side) + 2.4, 0.3 * k };
            kit_show(&a->k, "jar", k % 4 ? blue : part, a->side[side], low);
            if (side % 2 == 0)
                kit_show(&a->k, "jar", part, a->side[side], high);
        }
    }
}

// A pair of curtains on a rod between two columns, drawn aside.
static void add_curtains(atrium *a)
{
    static const struct {
        int side, bay, storey;
        atrium_material cloth;
    } where[] = {
        { 0, 1, 0, ATRIUM_RED },   { 0, 3, 0, ATRIUM_GREEN }, { 0, 4, 0, ATRIUM_BLUE },
        { 2, 1, 0, ATRIUM_GREEN }, { 2, 4, 0, ATRIUM_RED },   { 1, 0, 1, ATRIUM_RED },
        { 1, 1, 1, ATRIUM_BLUE },  { 1, 2, 1, ATRIUM_RED },   { 2, 2, 1, ATRIUM_GREEN },
        { 0, 0, 1, ATRIUM_BLUE },  { 0, 5, 1, ATRIUM_GREEN }, { 3, 1, 0, ATRIUM_BLUE },
    };
    static const float rod[2][3] = { { -1.5f, 0, 0 }, { 1.5f, 0, 0 } };
    const shape_tube_desc bar = { .path = rod, .count = 2, .radius = 0.022f, .segments = 8 };
    const shape_cloth_desc cloth = { .width = 1.15f,
                                     .height = 2.6f,
                                     .folds = 5,
                                     .depth = 0.065f,
                                     .gather = 0.35f,
                                     .nu = 40,
                                     .nv = 6 };
    shape s = { 0 };
    shape_tube(&s, &bar);
    const int brass = kit_part(&a->k, "rod", &s, a->material[ATRIUM_BRASS]);
    int part[ATRIUM_MATERIALS];
    for (int m = ATRIUM_RED; m <= ATRIUM_BLUE; ++m) {
        s.tiling = 1.0f / 0.6f;
        shape_cloth(&s, &cloth);
        part[m] = kit_part(&a->k, "curtain", &s, a->material[m]);
    }
    for (int i = 0; i < FG_COUNT(where); ++i) {
        const place at = { atrium_bay_centre(where[i].side, where[i].bay),
                           (double) atrium_spring[where[i].storey] - 0.06,
                           atrium_distance(where[i].side) + 0.36, 0 };
        const int node = kit_show(&a->k, "curtain rod", brass, a->side[where[i].side], at);
        kit_show(&a->k, "curtain", part[where[i].cloth], node, (place){ -0.68, 0, 0, 0 });
        kit_show(&a->k, "curtain", part[where[i].cloth], node, (place){ 0.68, 0, 0, 0 });
    }
}

// Long cloths over the upper balustrades.
static void add_banners(atrium *a)
{
    static const atrium_material cloths[3] = { ATRIUM_RED, ATRIUM_BLUE, ATRIUM_GREEN };
    const shape_cloth_desc cloth = {
        .width = 1.1f, .height = 1.9f, .folds = 2, .depth = 0.03f, .gather = 0.0f, .nu = 20, .nv = 6
    };
    for (int i = 0; i < 3; ++i) {
        shape s = { .tiling = 1.0f / 0.6f };
        shape_cloth(&s, &cloth);
        const int part = kit_part(&a->k, "banner", &s, a->material[cloths[i]]);
        for (int side = 0; side < 4; ++side) {
            const int bay = side % 2 ? i : 2 * i + 1;
            if (side % 2 && i != 1)
                continue;
            const place at = { atrium_bay_centre(side, bay), 5.43, atrium_distance(side) - 0.42,
                               0 };
            kit_show(&a->k, "banner", part, a->side[side], at);
        }
    }
}

// Panelled doors in stone frames on the back walls.
static void add_doors(atrium *a)
{
    shape leaf = { .tiling = 1.0f }, surround = { .tiling = 0.5f };
    shape_box(&leaf, (float[3]){ -0.6f, -0.02f, 2.9f }, (float[3]){ 0.6f, 2.1f, 3.05f });
    for (int i = 0; i < 6; ++i) {
        const int row = i / 2;
        const float x = i % 2 ? 0.06f : -0.52f, y = 0.15f + 0.64f * (float) row;
        shape_box(&leaf, (float[3]){ x, y, 2.87f }, (float[3]){ x + 0.46f, y + 0.54f, 2.95f });
    }
    for (int i = 0; i < 2; ++i) {
        const float x = i ? 0.58f : -0.8f;
        shape_box(&surround, (float[3]){ x, -0.02f, 2.80f }, (float[3]){ x + 0.22f, 2.12f, 3.05f });
    }
    shape_box(&surround, (float[3]){ -0.86f, 2.08f, 2.76f }, (float[3]){ 0.86f, 2.34f, 3.05f });
    shape_box(&surround, (float[3]){ -0.94f, 2.32f, 2.70f }, (float[3]){ 0.94f, 2.40f, 3.05f });
    const int wood = kit_part(&a->k, "door", &leaf, a->material[ATRIUM_WOOD]);
    const int stone = kit_part(&a->k, "surround", &surround, a->material[ATRIUM_LIMESTONE]);
    for (int i = 0; i < 16; ++i) {
        // Three to a long side, one to a short one, on both storeys.
        const int storey = i / 8, slot = i % 8, side = slot < 6 ? 2 * (slot / 3) : 2 * slot - 11;
        const int bay = slot < 6 ? 1 + 2 * (slot % 3) : 1;
        const place at = { atrium_bay_centre(side, bay), atrium_floor[storey],
                           atrium_distance(side), 0 };
        const int node = kit_show(&a->k, "door", wood, a->side[side], at);
        kit_show(&a->k, "surround", stone, node, (place){ 0 });
    }
}

// Stone benches between the doors.
static void add_benches(atrium *a)
{
    shape s = { .tiling = 1.0f };
    shape_box(&s, (float[3]){ -0.8f, 0.38f, -0.22f }, (float[3]){ 0.8f, 0.47f, 0.22f });
    shape_box(&s, (float[3]){ -0.62f, -0.02f, -0.17f }, (float[3]){ -0.42f, 0.39f, 0.17f });
    shape_box(&s, (float[3]){ 0.42f, -0.02f, -0.17f }, (float[3]){ 0.62f, 0.39f, 0.17f });
    const int part = kit_part(&a->k, "bench", &s, a->material[ATRIUM_LIMESTONE]);
    for (int side = 0; side < 4; side += 2) {
        for (int k = 0; k < atrium_bays(side); k += 2) {
            const place at = { atrium_bay_centre(side, k) - 0.35, atrium_floor[0],
                               atrium_distance(side) + 2.55, 0 };
            kit_show(&a->k, "bench", part, a->side[side], at);
        }
    }
}

void atrium_add_furnishing(atrium *a)
{
    add_fountain(a);
    add_plants(a);
    add_ivy(a);
    add_jars(a);
    add_curtains(a);
    add_banners(a);
    add_doors(a);
    add_benches(a);
}
