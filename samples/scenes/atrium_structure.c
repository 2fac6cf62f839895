// SPDX-License-Identifier: MIT
#include "atrium_priv.h"

#include <math.h>

#define PROFILE(array) (const float(*)[2]) array, FG_COUNT(array)

static const double quarter = 1.57079632679489661923;

static void add_lathe(shape *s, const float (*profile)[2], int count, int segments)
{
    const shape_lathe_desc d = { .profile = profile, .count = count, .segments = segments };
    shape_lathe(s, &d);
}

static void add_lobed(shape *s, const float (*profile)[2], int count, int segments, int lobes,
                      float depth)
{
    const shape_lathe_desc d = { .profile = profile,
                                 .count = count,
                                 .segments = segments,
                                 .lobes = lobes,
                                 .lobe_depth = depth };
    shape_lathe(s, &d);
}

static void add_frame(shape *s, float half_x, float half_z, const float (*profile)[2], int count)
{
    const shape_frame_desc d = {
        .half_x = half_x, .half_z = half_z, .profile = profile, .count = count
    };
    shape_frame(s, &d);
}

// A ring of the building, given by its profile outwards from the arcades' axes, shown at once.
static void show_ring(atrium *a, const char *name, atrium_material material,
                      const float (*profile)[2], int count)
{
    shape s = { .tiling = 0.5f };
    if (material == ATRIUM_TERRACOTTA)
        s.tiling = 1.0f / 1.2f;
    add_frame(&s, atrium_half_x, atrium_half_z, profile, count);
    kit_show(&a->k, name, kit_part(&a->k, name, &s, a->material[material]), -1, (place){ 0 });
}

// Shows a part wherever an arcade of `storey` has a column, or also (`ends`) at the side's ends.
static void show_at_columns(atrium *a, const char *name, int part, int storey, bool ends)
{
    for (int side = 0; side < 4; ++side) {
        const int bays = atrium_bays(side);
        for (int k = ends ? 0 : 1; k < (ends ? bays + 1 : bays); ++k) {
            const place at = { atrium_bay_centre(side, k) - 0.5 * (double) atrium_bay,
                               atrium_floor[storey], atrium_distance(side), 0 };
            kit_show(&a->k, name, part, a->side[side], at);
        }
    }
}

// A fluted column, 2.75 m with its abacus.
static void add_lower_columns(atrium *a)
{
    static const float base[][2] = {
        { 0, 0.11f },       { 0.262f, 0.11f },  { 0.278f, 0.125f }, { 0.284f, 0.155f },
        { 0.278f, 0.185f }, { 0.262f, 0.2f },   { 0.232f, 0.205f }, { 0.222f, 0.235f },
        { 0.234f, 0.262f }, { 0.250f, 0.275f }, { 0.250f, 0.295f }, { 0.236f, 0.31f },
        { 0, 0.31f },
    };
    static const float shaft[][2] = {
        { 0, 0.30f },      { 0.208f, 0.30f }, { 0.206f, 0.95f },
        { 0.195f, 1.65f }, { 0.178f, 2.32f }, { 0, 2.32f },
    };
    static const float neck[][2] = {
        { 0, 2.29f },     { 0.186f, 2.29f }, { 0.2f, 2.305f },
        { 0.2f, 2.325f }, { 0.186f, 2.34f }, { 0, 2.34f },
    };
    static const float bell[][2] = {
        { 0, 2.335f },     { 0.185f, 2.335f }, { 0.2f, 2.42f },   { 0.205f, 2.46f },
        { 0.235f, 2.55f }, { 0.29f, 2.605f },  { 0.30f, 2.625f }, { 0, 2.63f },
    };
    static const float plinth[][2] = {
        { 0, -0.02f }, { 0.295f, -0.02f }, { 0.295f, 0.115f }, { 0, 0.115f }
    };
    static const float abacus[][2] = {
        { 0, 2.62f },      { 0.27f, 2.62f },  { 0.29f, 2.65f },
        { 0.30f, 2.655f }, { 0.30f, 2.755f }, { 0, 2.755f },
    };
    shape s = { 0 };
    add_frame(&s, 0, 0, PROFILE(plinth));
    add_lathe(&s, PROFILE(base), 24);
    add_lobed(&s, PROFILE(shaft), 64, 16, 0.13f);
    add_lathe(&s, PROFILE(neck), 24);
    add_lobed(&s, PROFILE(bell), 32, 8, 0.16f);
    add_frame(&s, 0, 0, PROFILE(abacus));
    show_at_columns(a, "column", kit_part(&a->k, "column", &s, a->material[ATRIUM_LIMESTONE]), 0,
                    false);
}

// A slender smooth column, 2.45 m.
static void add_upper_columns(atrium *a)
{
    static const float round[][2] = {
        { 0, 0.09f },       { 0.185f, 0.09f },  { 0.198f, 0.105f }, { 0.198f, 0.135f },
        { 0.185f, 0.15f },  { 0.160f, 0.16f },  { 0.156f, 0.18f },  { 0.172f, 0.195f },
        { 0.172f, 0.215f }, { 0.150f, 0.225f }, { 0.145f, 0.9f },   { 0.134f, 1.6f },
        { 0.126f, 2.08f },  { 0.144f, 2.09f },  { 0.144f, 2.12f },  { 0.128f, 2.13f },
        { 0.134f, 2.2f },   { 0.170f, 2.28f },  { 0.205f, 2.33f },  { 0, 2.34f },
    };
    static const float plinth[][2] = {
        { 0, -0.02f }, { 0.21f, -0.02f }, { 0.21f, 0.1f }, { 0, 0.1f }
    };
    static const float abacus[][2] = {
        { 0, 2.33f }, { 0.225f, 2.33f }, { 0.24f, 2.37f }, { 0.24f, 2.455f }, { 0, 2.455f }
    };
    shape s = { 0 };
    add_frame(&s, 0, 0, PROFILE(plinth));
    add_lathe(&s, PROFILE(round), 20);
    add_frame(&s, 0, 0, PROFILE(abacus));
    const int part = kit_part(&a->k, "upper column", &s, a->material[ATRIUM_LIMESTONE]);
    show_at_columns(a, "upper column", part, 1, false);
}

// Square piers through both storeys where two arcades meet.
static void add_piers(atrium *a)
{
    static const float pier[][2] = {
        { 0, 0 },         { 0.42f, 0 },     { 0.42f, 0.35f }, { 0.37f, 0.41f }, { 0.34f, 0.43f },
        { 0.34f, 2.68f }, { 0.37f, 2.72f }, { 0.37f, 2.78f }, { 0.42f, 2.83f }, { 0.42f, 2.92f },
        { 0.34f, 2.95f }, { 0.34f, 4.55f }, { 0.38f, 4.57f }, { 0.38f, 4.85f }, { 0.32f, 4.90f },
        { 0.30f, 6.72f }, { 0.33f, 6.76f }, { 0.33f, 6.82f }, { 0.38f, 6.87f }, { 0.38f, 6.96f },
        { 0.30f, 6.99f }, { 0.30f, 8.62f }, { 0, 8.62f },
    };
    shape s = { .tiling = 0.5f };
    add_frame(&s, 0, 0, PROFILE(pier));
    const int part = kit_part(&a->k, "pier", &s, a->material[ATRIUM_ASHLAR]);
    for (int i = 0; i < 4; ++i) {
        const double x = (double) atrium_half_x, z = (double) atrium_half_z;
        const place at = { i & 1 ? x : -x, 0.1, i & 2 ? z : -z, 0 };
        kit_show(&a->k, "pier", part, -1, at);
    }
}

// The pierced walls on the columns, with a moulded ring around every arch.
static void add_arcades(atrium *a)
{
    static const float radius[2] = { 1.2f, 1.24f }, top[2] = { 4.4f, 8.6f };
    static const float thickness[2] = { 0.45f, 0.36f };
    for (int i = 0; i < 4; ++i) {
        const int storey = i / 2;
        const shape_arcade_desc wall = { .bays = i % 2 ? 3 : 6,
                                         .bay = atrium_bay,
                                         .radius = radius[storey],
                                         .rise = radius[storey],
                                         .spring = atrium_spring[storey],
                                         .top = top[storey],
                                         .thickness = thickness[storey],
                                         .segments = 20 };
        const shape_archivolt_desc ring = { .inner = wall.radius - 0.025f,
                                            .outer = wall.radius + 0.16f,
                                            .spring = wall.spring - 0.002f,
                                            .thickness = wall.thickness + 0.07f,
                                            .segments = 20 };
        shape s = { .tiling = 0.5f }, trim = { .tiling = 1.0f };
        shape_arcade(&s, &wall);
        for (int k = 0; k < wall.bays; ++k) {
            const size_t first = trim.vertex_count;
            shape_archivolt(&trim, &ring);
            shape_move(&trim, first, (float[3]){ (float) atrium_bay_centre(i % 2, k), 0, 0 }, 0);
        }
        const int part = kit_part(&a->k, "arcade", &s, a->material[ATRIUM_ASHLAR]);
        const int rings = kit_part(&a->k, "archivolts", &trim, a->material[ATRIUM_LIMESTONE]);
        for (int side = i % 2; side < 4; side += 2) {
            const place at = { 0, 0, atrium_distance(side), 0 };
            kit_show(&a->k, "arcade", part, a->side[side], at);
            kit_show(&a->k, "archivolts", rings, a->side[side], at);
        }
    }
}

// Groin vaults over the lower gallery, parted by arches across it.
static void add_vaults(atrium *a)
{
    const float half = 0.5f * atrium_bay;
    const shape_vault_desc vault = {
        .half_x = half, .half_z = half, .spring = atrium_spring[0], .rise = 1.25f, .segments = 16
    };
    const shape_arcade_desc rib = { .bays = 1,
                                    .bay = atrium_gallery,
                                    .radius = 1.24f,
                                    .rise = 1.12f,
                                    .spring = atrium_spring[0],
                                    .top = 4.25f,
                                    .thickness = 0.34f,
                                    .segments = 16 };
    shape s = { .tiling = 0.4f }, r = { .tiling = 0.5f };
    shape_vault(&s, &vault);
    shape_arcade(&r, &rib);
    const int web = kit_part(&a->k, "vault", &s, a->material[ATRIUM_WHITEWASH]);
    const int arch = kit_part(&a->k, "rib", &r, a->material[ATRIUM_ASHLAR]);
    for (int side = 0; side < 4; ++side) {
        const double z = atrium_distance(side) + 0.5 * (double) atrium_gallery;
        const int bays = atrium_bays(side);
        for (int k = 0; k <= bays; ++k) {
            const double x = atrium_bay_centre(side, k), left = x - (double) half;
            kit_show(&a->k, "rib", arch, a->side[side], (place){ left, 0, z, quarter });
            // The last one is the corner that follows the side.
            kit_show(&a->k, "vault", web, a->side[side], (place){ x, 0, z, 0 });
        }
    }
}

// Floors, slabs, walls and mouldings: all that runs around the court.
static void add_rings(atrium *a)
{
    static const float ground[][2] = {
        { -0.40f, -0.1f }, { 3.02f, -0.1f }, { 3.02f, 0.15f }, { -0.40f, 0.15f }
    };
    static const float kerb[][2] = { { -0.55f, -0.1f },
                                     { -0.05f, -0.1f },
                                     { -0.05f, 0.156f },
                                     { -0.53f, 0.156f },
                                     { -0.55f, 0.136f } };
    static const float slab[][2] = {
        { -0.15f, 4.2f }, { 3.02f, 4.2f }, { 3.02f, 4.5f }, { -0.15f, 4.5f }
    };
    static const float course[][2] = {
        { 0.1f, 4.28f },   { -0.25f, 4.28f }, { -0.27f, 4.34f }, { -0.33f, 4.37f },
        { -0.36f, 4.43f }, { -0.36f, 4.51f }, { 0.1f, 4.51f },
    };
    static const float cornice[][2] = {
        { 0.15f, 8.5f },   { -0.22f, 8.5f },  { -0.25f, 8.58f },
        { -0.33f, 8.62f }, { -0.36f, 8.72f }, { -0.46f, 8.78f },
        { -0.52f, 8.86f }, { -0.52f, 8.96f }, { 0.15f, 8.96f },
    };
    static const float lining[][2] = {
        { 3.0f, -0.2f }, { 3.14f, -0.2f }, { 3.14f, 8.9f }, { 3.0f, 8.9f }
    };
    static const float outside[][2] = {
        { 3.1f, -0.2f }, { 3.5f, -0.2f }, { 3.5f, 10.55f }, { 3.1f, 10.55f }
    };
    static const float coping[][2] = {
        { 3.02f, 10.5f }, { 3.58f, 10.5f }, { 3.58f, 10.58f }, { 3.3f, 10.66f }, { 3.02f, 10.58f }
    };
    static const float dado[][2] = {
        { 3.01f, 0.1f }, { 2.92f, 0.1f },  { 2.92f, 0.3f },  { 2.95f, 0.33f },
        { 2.95f, 1.0f }, { 2.91f, 1.03f }, { 2.91f, 1.09f }, { 3.01f, 1.11f },
    };
    static const float skirting[][2] = {
        { 3.01f, 4.4f }, { 2.95f, 4.4f }, { 2.95f, 4.72f }, { 3.01f, 4.75f }
    };
    static const float ceiling[][2] = {
        { 0, 8.62f }, { 3.05f, 8.62f }, { 3.05f, 8.72f }, { 0, 8.72f }
    };
    static const float wedge[][2] = {
        { -0.60f, 8.95f }, { 3.12f, 8.95f }, { 3.12f, 10.18f }, { -0.60f, 9.03f }
    };
    show_ring(a, "gallery floor", ATRIUM_TERRACOTTA, PROFILE(ground));
    show_ring(a, "kerb", ATRIUM_LIMESTONE, PROFILE(kerb));
    show_ring(a, "upper floor", ATRIUM_TERRACOTTA, PROFILE(slab));
    show_ring(a, "string course", ATRIUM_LIMESTONE, PROFILE(course));
    show_ring(a, "cornice", ATRIUM_LIMESTONE, PROFILE(cornice));
    show_ring(a, "wall lining", ATRIUM_PLASTER, PROFILE(lining));
    show_ring(a, "outer wall", ATRIUM_BRICK, PROFILE(outside));
    show_ring(a, "coping", ATRIUM_LIMESTONE, PROFILE(coping));
    show_ring(a, "dado", ATRIUM_LIMESTONE, PROFILE(dado));
    show_ring(a, "skirting", ATRIUM_LIMESTONE, PROFILE(skirting));
    show_ring(a, "ceiling", ATRIUM_WOOD, PROFILE(ceiling));
    show_ring(a, "roof body", ATRIUM_WOOD, PROFILE(wedge));
}

static void add_court_floor(atrium *a)
{
    const float x = atrium_half_x, z = atrium_half_z;
    const float corners[4][3] = { { -x, 0, z }, { x, 0, z }, { x, 0, -z }, { -x, 0, -z } };
    shape s = { .tiling = 1.0f / 1.2f };
    shape_quad(&s, corners);
    kit_show(&a->k, "court", kit_part(&a->k, "court", &s, a->material[ATRIUM_PAVING]), -1,
             (place){ 0 });
}

static const float roof_eave = -0.62f, roof_ridge = 3.11f; // offsets from the arcades

// Height of the tiles' middle line.
static float roof_height(float out)
{
    return 9.09f + 1.16f * (out - roof_eave) / (roof_ridge - roof_eave);
}

// One side of the roof: rows of half-round tiles, from the eaves or the hip (v 0) to the ridge.
static void roof_point(const void *user, float u, float v, float p[3], float uv[2])
{
    const float half = *(const float *) user; // of the arcade
    const float x = (1.0f - 2.0f * u) * (half + roof_ridge - 0.01f);
    const float start = fmaxf(roof_eave, fabsf(x) - half);
    p[0] = x;
    p[2] = start + (roof_ridge - start) * v;
    p[1] = roof_height(p[2]) + 0.045f * cosf(2.0f * 3.14159265f * x / 0.26f);
    uv[0] = x;
    uv[1] = p[2];
}

// Round tiles over the four hips.
static void add_hips(atrium *a)
{
    shape s = { .tiling = 1.0f };
    for (int i = 0; i < 4; ++i) {
        const float x = i & 1 ? 1.0f : -1.0f, z = i & 2 ? 1.0f : -1.0f;
        float path[2][3];
        for (int k = 0; k < 2; ++k) {
            const float out = k ? roof_ridge : roof_eave;
            path[k][0] = x * (atrium_half_x + out);
            path[k][1] = roof_height(out) + 0.02f;
            path[k][2] = z * (atrium_half_z + out);
        }
        const shape_tube_desc hip = {
            .path = (const float(*)[3]) path, .count = 2, .radius = 0.1f, .segments = 10
        };
        shape_tube(&s, &hip);
    }
    kit_show(&a->k, "hips", kit_part(&a->k, "hips", &s, a->material[ATRIUM_CLAY]), -1,
             (place){ 0 });
}

static void add_roof(atrium *a)
{
    for (int i = 0; i < 2; ++i) {
        const float half = i ? atrium_half_z : atrium_half_x;
        const shape_sheet_desc tiles = { .point = roof_point,
                                         .user = &half,
                                         .nu = (int) ((half + roof_ridge) * 2.0f / 0.065f),
                                         .nv = 1 };
        shape s = { .tiling = 1.0f };
        shape_sheet(&s, &tiles);
        const int part = kit_part(&a->k, "roof", &s, a->material[ATRIUM_CLAY]);
        for (int side = i; side < 4; side += 2) {
            const place at = { 0, 0, atrium_distance(side), 0 };
            kit_show(&a->k, "roof", part, a->side[side], at);
        }
    }
}

// Rails with seven balusters between two columns.
static void add_balustrades(atrium *a)
{
    static const float turned[][2] = {
        { 0, 0.10f },      { 0.052f, 0.10f }, { 0.052f, 0.15f }, { 0.030f, 0.19f },
        { 0.066f, 0.33f }, { 0.056f, 0.46f }, { 0.029f, 0.66f }, { 0.050f, 0.73f },
        { 0.050f, 0.80f }, { 0, 0.80f },
    };
    shape s = { 0 };
    shape_box(&s, (float[3]){ -1.36f, -0.01f, -0.11f }, (float[3]){ 1.36f, 0.105f, 0.11f });
    shape_box(&s, (float[3]){ -1.38f, 0.79f, -0.09f }, (float[3]){ 1.38f, 0.86f, 0.09f });
    shape_box(&s, (float[3]){ -1.38f, 0.85f, -0.125f }, (float[3]){ 1.38f, 0.93f, 0.125f });
    for (int i = 0; i < 7; ++i) {
        const size_t first = s.vertex_count;
        add_lathe(&s, PROFILE(turned), 9);
        shape_move(&s, first, (float[3]){ 0.345f * (float) (i - 3), 0, 0 }, 0);
    }
    const int part = kit_part(&a->k, "balustrade", &s, a->material[ATRIUM_LIMESTONE]);
    for (int side = 0; side < 4; ++side) {
        for (int k = 0; k < atrium_bays(side); ++k) {
            const place at = { atrium_bay_centre(side, k), atrium_floor[1], atrium_distance(side),
                               0 };
            kit_show(&a->k, "balustrade", part, a->side[side], at);
        }
    }
}

// Beams under the upper gallery's ceiling; those of the long sides run on over the corners.
static void add_beams(atrium *a)
{
    for (int i = 0; i < 2; ++i) {
        const float half = i ? atrium_half_z : atrium_half_x + atrium_gallery;
        shape s = { .tiling = 1.0f };
        for (int n = 0; n < (int) (2.0f * half / 0.75f); ++n) {
            const float x = 0.375f + 0.75f * (float) n - half;
            shape_box(&s, (float[3]){ x - 0.07f, 8.38f, 0.05f },
                      (float[3]){ x + 0.07f, 8.64f, 3.05f });
        }
        const int part = kit_part(&a->k, "beams", &s, a->material[ATRIUM_WOOD]);
        for (int side = i; side < 4; side += 2) {
            const place at = { 0, 0, atrium_distance(side), 0 };
            kit_show(&a->k, "beams", part, a->side[side], at);
        }
    }
}

// Pilasters on the back walls of both storeys, opposite the columns.
static void add_pilasters(atrium *a)
{
    static const float top[2] = { 2.9f, 8.5f };
    for (int storey = 0; storey < 2; ++storey) {
        const float h = top[storey] - (float) atrium_floor[storey];
        shape s = { .tiling = 0.5f };
        shape_box(&s, (float[3]){ -0.19f, -0.02f, 2.86f }, (float[3]){ 0.19f, h, 3.05f });
        shape_box(&s, (float[3]){ -0.24f, -0.02f, 2.80f }, (float[3]){ 0.24f, 0.28f, 3.05f });
        shape_box(&s, (float[3]){ -0.25f, h - 0.14f, 2.79f },
                  (float[3]){ 0.25f, h - 0.02f, 3.05f });
        const int part = kit_part(&a->k, "pilaster", &s, a->material[ATRIUM_ASHLAR]);
        show_at_columns(a, "pilaster", part, storey, true);
    }
}

void atrium_add_structure(atrium *a)
{
    add_court_floor(a);
    add_rings(a);
    add_piers(a);
    add_lower_columns(a);
    add_upper_columns(a);
    add_arcades(a);
    add_vaults(a);
    add_balustrades(a);
    add_beams(a);
    add_pilasters(a);
    add_roof(a);
    add_hips(a);
}
