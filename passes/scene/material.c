// SPDX-License-Identifier: MIT
// Materials that move.
#include "scene_priv.h"

#include <float.h>
#include <math.h>

void ag_material_refs(ag_material *m, ag_texture_ref *refs[3])
{
    refs[0] = &m->base_color_tex;
    refs[1] = &m->metallic_roughness_tex;
    refs[2] = &m->emissive_tex;
}

// A cubic between keys of the largest floats swings beyond them.
static float in_range(double v, double least)
{
    return (float) fmin(fmax(v, least), (double) FLT_MAX);
}

// Sets a number; true if it is another one than before.
static bool set(float *number, float to)
{
    bool changed = *number != to;
    *number = to;
    return changed;
}

// Writes nothing but what is driven: other threads may read the rest.
static bool follow(ag_material *m, const ag_material_drive *drive)
{
    bool changed = false;
    ag_texture_ref *refs[3];
    ag_material_refs(m, refs);
    for (int k = 0; k < 3 && drive->driven_paths & 1 << AG_PATH_EMISSIVE; k++)
        changed = set(&m->emissive[k], in_range(drive->emissive[k], 0)) || changed;
    for (int i = 0; i < 3 && drive->driven_paths & 1 << AG_PATH_UV_OFFSET; i++)
        for (int k = 0; k < 2 && refs[i]->texture >= 0; k++) {
            double offset = (double) drive->rest_offset[i][k] + drive->offset[k];
            changed =
                set(&refs[i]->transform[2 + 3 * k], in_range(offset, -(double) FLT_MAX)) || changed;
        }
    return changed;
}

bool ag_materials_follow(ag_scene_private *p, bool first)
{
    bool changed = false;
    ag_material *materials = p->materials.data;
    const ag_material_drive *drives = p->drives.data;
    for (size_t i = 0; i < p->materials.count; i++)
        if (drives[i].driven_paths && (first || materials[i].moving))
            changed = follow(&materials[i], &drives[i]) || changed;
    return changed;
}

bool ag_scene_uv_moves(const ag_scene *scene, int material)
{
    return ((const ag_material_drive *) scene->priv->drives.data)[material].uv_moves;
}
