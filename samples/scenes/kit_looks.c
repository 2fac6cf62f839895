// SPDX-License-Identifier: MIT
#include "kit.h"

#include <stdio.h>
#include <string.h>

// The texture of a pattern, painted when it is first asked for.
static int texture_of(kit *k, const kit_look *look, int what, int texture[PATTERN_COUNT])
{
    if (what < 0)
        return -1;
    if (texture[what] < 0)
        texture[what] = kit_texture(k, look->name, (pattern) what, look->size ? look->size : 256);
    return texture[what];
}

void kit_materials(kit *k, const kit_look *looks, int count, int *material)
{
    int texture[PATTERN_COUNT];
    memset(texture, 0xff, sizeof texture); // -1: not painted yet
    for (int i = 0; i < count; ++i) {
        const kit_look *look = &looks[i];
        ag_material m = ag_default_material();
        snprintf(m.name, sizeof m.name, "%s", look->name);
        memcpy(m.base_color, look->color, sizeof look->color);
        memcpy(m.emissive, look->emissive, sizeof look->emissive);
        if (look->roughness > 0.0f)
            m.roughness = look->roughness;
        m.metallic = look->metallic;
        const bool glows = look->emissive[0] + look->emissive[1] + look->emissive[2] > 0.0f;
        const int painted = texture_of(k, look, look->texture, texture);
        *(glows ? &m.emissive_tex : &m.base_color_tex) = (ag_texture_ref){ .texture = painted };
        if (!glows && painted >= 0 && pattern_is_masked((pattern) look->texture)) {
            m.alpha = AG_ALPHA_MASK;
            m.alpha_cutoff = 0.5f;
        }
        material[i] = ag_builder_material(k->builder, &m);
    }
}
