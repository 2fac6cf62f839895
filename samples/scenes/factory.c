// SPDX-License-Identifier: MIT
#include "factory_priv.h"

#include "builtin.h"

// Base colours multiply the texture, linear.
static const kit_look looks[FACTORY_MATERIALS] = {
    [FACTORY_FLOOR] = { "floor",
                        PATTERN_CONCRETE,
                        { 0.74f, 0.74f, 0.76f },
                        .roughness = 0.45f,
                        .size = 512 },
    [FACTORY_SHEET] = { "sheet", PATTERN_SHEET, { 1.0f, 1.0f, 0.98f }, .roughness = 0.6f },
    [FACTORY_CONCRETE] = { "concrete", PATTERN_CONCRETE, { 0.9f, 0.9f, 0.9f }, .size = 512 },
    [FACTORY_ROOF] = { "roof", PATTERN_SHEET, { 0.85f, 0.85f, 0.85f } },
    [FACTORY_STEEL] = { "steel", -1, { 0.16f, 0.24f, 0.34f }, .roughness = 0.5f, .metallic = 0.2f },
    [FACTORY_LINES] = { "line paint", -1, { 0.66f, 0.50f, 0.06f }, .roughness = 0.6f },
    [FACTORY_RACK] = { "rack", -1, { 0.07f, 0.15f, 0.42f }, .roughness = 0.5f },
    [FACTORY_BEAM] = { "rack beam", -1, { 0.70f, 0.26f, 0.04f }, .roughness = 0.5f },
    [FACTORY_PALLET] = { "pallet", PATTERN_WOOD, { 1, 1, 0.95f } },
    [FACTORY_CARTON] = { "carton", PATTERN_CARTON, { 0.60f, 0.41f, 0.24f } },
    [FACTORY_WHITE_CARTON] = { "white carton", PATTERN_CARTON, { 0.80f, 0.79f, 0.75f } },
    [FACTORY_CRATE] = { "crate", -1, { 0.06f, 0.22f, 0.48f }, .roughness = 0.4f },
    [FACTORY_BELT] = { "belt", PATTERN_BELT, { 1, 1, 1 }, .roughness = 0.8f },
    [FACTORY_FRAME] = { "frame", -1, { 0.52f, 0.54f, 0.55f }, .roughness = 0.4f, .metallic = 0.3f },
    [FACTORY_MACHINE] = { "machine", -1, { 0.20f, 0.40f, 0.33f }, .roughness = 0.4f },
    [FACTORY_RUBBER] = { "rubber", -1, { 0.09f, 0.09f, 0.09f } },
    [FACTORY_HAZARD] = { "hazard", PATTERN_HAZARD, { 1, 1, 1 }, .size = 128 },
    [FACTORY_ROBOT] = { "robot", -1, { 0.78f, 0.27f, 0.03f }, .roughness = 0.3f },
    [FACTORY_CRANE] = { "crane", -1, { 0.70f, 0.50f, 0.05f }, .roughness = 0.4f },
    [FACTORY_CART] = { "cart", -1, { 0.62f, 0.64f, 0.66f }, .roughness = 0.3f },
    [FACTORY_LAMP] = { "lamp", -1, { 0.7f, 0.7f, 0.7f }, .emissive = { 9, 8.6f, 7.8f } },
    [FACTORY_BEACON] = { "beacon", -1, { 0.55f, 0.20f, 0.04f }, .emissive = { 6, 2, 0.2f } },
    [FACTORY_DAY] = { "daylight", -1, { 0.3f, 0.3f, 0.3f }, .emissive = { 0.75f, 0.95f, 1.2f } },
};

int factory_part(factory *f, const char *name, shape *s, factory_material material)
{
    return kit_part(&f->k, name, s, f->material[material]);
}

int factory_put(factory *f, const char *name, shape *s, factory_material material, place at)
{
    return kit_show(&f->k, name, factory_part(f, name, s, material), -1, at);
}

// Along one line, around its end, back along the other and through the middle.
static const kit_stop stops[] = {
    { { -17.0, 1.8, 6.0 }, { -8.0, 1.5, 2.0 } },    { { -11.5, 1.8, 6.1 }, { -3.0, 1.4, 1.0 } },
    { { -5.5, 1.75, 6.1 }, { 2.0, 1.4, 0.5 } },     { { 0.5, 1.75, 6.0 }, { 7.5, 1.6, 1.0 } },
    { { 6.5, 1.8, 6.0 }, { 14.0, 2.0, 2.0 } },      { { 12.0, 1.9, 5.8 }, { 17.0, 2.0, -2.0 } },
    { { 15.7, 2.0, 3.0 }, { 12.0, 1.8, -6.0 } },    { { 15.9, 2.0, -2.0 }, { 6.0, 1.8, -5.0 } },
    { { 13.0, 1.9, -5.8 }, { 3.0, 1.6, -3.0 } },    { { 7.0, 1.8, -6.1 }, { -2.0, 1.3, -2.0 } },
    { { 1.0, 1.75, -6.1 }, { -7.5, 1.4, -1.5 } },   { { -5.0, 1.75, -6.0 }, { -13.0, 1.6, -2.0 } },
    { { -12.0, 1.8, -6.4 }, { -17.0, 2.0, -3.0 } }, { { -15.6, 1.9, -5.9 }, { -17.5, 2.2, 4.0 } },
    { { -17.5, 2.0, -2.6 }, { -12.0, 2.0, 6.5 } },  { { -17.9, 2.0, 1.6 }, { -9.0, 1.9, 5.0 } },
    { { -17.7, 1.9, 4.4 }, { -8.0, 1.7, 3.4 } },
};

static void add_cameras(factory *f)
{
    const kit_walk_desc walk = { .name = "path",
                                 .stops = stops,
                                 .count = FG_COUNT(stops),
                                 .seconds = factory_period,
                                 .yfov = 1.05f };
    kit *k = &f->k;
    kit_camera(k, "hall", (double[]){ -9.9, 3.3, 6.7 }, (double[]){ 3.0, 1.8, -1.4 }, 1.05f);
    kit_camera(k, "belt", (double[]){ -9.2, 1.55, -4.5 }, (double[]){ -2.0, 0.95, -2.2 }, 1.0f);
    kit_camera(k, "robots", (double[]){ 2.6, 2.3, 5.6 }, (double[]){ -1.6, 1.2, -0.6 }, 1.0f);
    kit_camera(k, "racks", (double[]){ 13.5, 1.7, -7.6 }, (double[]){ 2.0, 2.3, -9.6 }, 1.05f);
    kit_camera(k, "above", (double[]){ 17.5, 7.0, -9.0 }, (double[]){ 0.0, 1.0, 0.5 }, 1.0f);
    kit_walk(k, &walk);
}

fg_status factory_build(const fg_log *log, ag_scene **out)
{
    factory f;
    *out = NULL;
    if (!kit_begin(&f.k, log, "factory"))
        return FG_ERR_MEMORY;
    kit_materials(&f.k, looks, FACTORY_MATERIALS, f.material);
    factory_add_hall(&f);
    factory_add_store(&f);
    factory_add_lines(&f);
    factory_add_robots(&f);
    factory_add_lights(&f);
    add_cameras(&f);
    return kit_end(&f.k, out);
}
