// SPDX-License-Identifier: MIT
// tinygltf reads the JSON and checks next to nothing of what it says; this does, before
// anything is converted.
#include "gltf_bridge.h"
#include "gltf_load.h"

#include <stdlib.h>
#include <string.h>

bool gltf_refers(gltf_loader *l, const char *what, int i, const char *field, int index, int count)
{
    if (index >= -1 && index < count)
        return true;
    ag_builder_refuse(l->b, FG_ERR_INPUT, "%s %d: %s %d does not exist (there are %d)", what, i,
                      field, index, count);
    return false;
}

bool gltf_spend(gltf_loader *l, size_t n, const char *what, int i)
{
    if (n <= l->elements_left) {
        l->elements_left -= n;
        return true;
    }
    ag_builder_refuse(l->b, FG_ERR_INPUT,
                      "%s %d: %zu more elements are more than a file of this size may have", what,
                      i, n);
    return false;
}

bool gltf_no_memory(gltf_loader *l)
{
    ag_builder_refuse(l->b, FG_ERR_MEMORY, "out of memory");
    return false;
}

static bool refuse(gltf_loader *l, const char *what, int i, const char *why)
{
    ag_builder_refuse(l->b, FG_ERR_INPUT, "%s %d: %s", what, i, why);
    return false;
}

// ---- the file ---------------------------------------------------------------------

static bool check_version(gltf_loader *l)
{
    const char *needed = l->m->min_version[0] ? l->m->min_version : l->m->version;
    bool two = strncmp(needed, "2.", 2) == 0;
    if (two && (l->m->min_version[0] == '\0' || strcmp(needed, "2.0") == 0))
        return true;
    ag_builder_refuse(l->b, FG_ERR_INPUT, "asset: version '%.20s' is needed, 2.0 is read", needed);
    return false;
}

bool gltf_extension_known(const char *name)
{
    static const char *const known[] = {
        "KHR_lights_punctual",   "KHR_materials_emissive_strength", "KHR_materials_unlit",
        "KHR_mesh_quantization", "KHR_texture_transform",
    };
    for (int i = 0; i < FG_COUNT(known); i++)
        if (strcmp(name, known[i]) == 0)
            return true;
    return false;
}

// ---- bytes ------------------------------------------------------------------------

static bool check_views(gltf_loader *l)
{
    const gltf_model *m = l->m;
    for (int i = 0; i < m->views_count; i++) {
        const gltf_view *v = &m->views[i];
        if (v->buffer == -1)
            return refuse(l, "bufferView", i, "it has no buffer");
        if (!gltf_refers(l, "bufferView", i, "buffer", v->buffer, m->buffers_count))
            return false;
        size_t size = m->buffers[v->buffer].size;
        if (v->length >= 1 && v->offset <= size && v->length <= size - v->offset)
            continue;
        ag_builder_refuse(l->b, FG_ERR_INPUT,
                          "bufferView %d: bytes %zu to %zu + %zu are not within the buffer's %zu",
                          i, v->offset, v->offset, v->length, size);
        return false;
    }
    return true;
}

typedef struct run {
    size_t offset, count, size, stride; // bytes, but for count
} run;

// Whether a run of elements lies in a view.
static bool fits(gltf_loader *l, int accessor, int view, run r)
{
    size_t length = l->m->views[view].length;
    if (r.stride < r.size) {
        ag_builder_refuse(l->b, FG_ERR_INPUT,
                          "accessor %d: elements of %zu bytes at a stride of %zu", accessor, r.size,
                          r.stride);
        return false;
    }
    if (r.offset <= length && r.size <= length - r.offset &&
        (r.count - 1) <= (length - r.offset - r.size) / r.stride)
        return true;
    ag_builder_refuse(l->b, FG_ERR_INPUT,
                      "accessor %d: %zu elements of %zu bytes from byte %zu on reach beyond "
                      "bufferView %d, which has %zu",
                      accessor, r.count, r.size, r.offset, view, length);
    return false;
}

static bool check_sparse(gltf_loader *l, int i)
{
    const gltf_accessor *a = &l->m->accessors[i];
    size_t index_size = gltf_component_size(a->index_type), size = gltf_element_size(a);
    int views = l->m->views_count;
    if (a->sparse_count < 1 || (size_t) a->sparse_count > a->count)
        return refuse(l, "accessor", i, "sparse count must be 1 to the accessor's count");
    if (a->index_type != 5121 && a->index_type != 5123 && a->index_type != 5125)
        return refuse(l, "accessor", i, "sparse indices must be unsigned integers");
    if (a->index_view < 0 || a->value_view < 0 || a->index_offset < 0 || a->value_offset < 0)
        return refuse(l, "accessor", i, "sparse bufferViews and offsets must not be negative");
    if (!gltf_refers(l, "accessor", i, "sparse indices' bufferView", a->index_view, views) ||
        !gltf_refers(l, "accessor", i, "sparse values' bufferView", a->value_view, views))
        return false;
    size_t count = (size_t) a->sparse_count;
    run indices = { (size_t) a->index_offset, count, index_size, index_size };
    run values = { (size_t) a->value_offset, count, gltf_element_extent(a), size };
    if (!fits(l, i, a->index_view, indices) || !fits(l, i, a->value_view, values))
        return false;
    gltf_reader r = gltf_reader_open(l->m, i);
    uint32_t last = 0;
    for (size_t k = 0; k < count; k++) {
        uint32_t index = gltf_read_sparse_index(&r, k);
        if (index >= a->count || (k > 0 && index <= last))
            return refuse(l, "accessor", i, "sparse indices must increase, below the count");
        last = index;
    }
    return true;
}

static bool check_accessor(gltf_loader *l, int i)
{
    const gltf_accessor *a = &l->m->accessors[i];
    size_t size = gltf_element_size(a);
    if (size == 0)
        return refuse(l, "accessor", i, "its componentType is none of glTF's");
    if (a->count < 1 || a->count > UINT32_MAX)
        return refuse(l, "accessor", i, "its count must be 1 to 4294967295");
    if (!gltf_refers(l, "accessor", i, "bufferView", a->view, l->m->views_count))
        return false;
    if (a->view == -1 && a->count > l->elements_left)
        return refuse(l, "accessor", i, "its count is absurd for one without a bufferView");
    if (a->view >= 0) {
        size_t stride = l->m->views[a->view].stride;
        run r = { a->offset, a->count, gltf_element_extent(a), stride > 0 ? stride : size };
        if (!fits(l, i, a->view, r))
            return false;
    }
    return !a->sparse || check_sparse(l, i);
}

static bool check_accessors(gltf_loader *l)
{
    for (int i = 0; i < l->m->accessors_count; i++)
        if (!check_accessor(l, i))
            return false;
    return true;
}

// ---- looks ------------------------------------------------------------------------

static bool check_textures(gltf_loader *l)
{
    const gltf_model *m = l->m;
    for (int i = 0; i < m->images_count; i++)
        if (!gltf_refers(l, "image", i, "bufferView", m->images[i].view, m->views_count))
            return false;
    for (int i = 0; i < m->textures_count; i++)
        if (!gltf_refers(l, "texture", i, "image", m->textures[i].image, m->images_count) ||
            !gltf_refers(l, "texture", i, "sampler", m->textures[i].sampler, m->samplers_count))
            return false;
    for (int i = 0; i < m->materials_count; i++) {
        const gltf_material *mat = &m->materials[i];
        const gltf_texture_info *infos[] = { &mat->base_color_tex, &mat->metallic_roughness_tex,
                                             &mat->emissive_tex,   &mat->normal_tex,
                                             &mat->occlusion_tex,  NULL };
        for (int k = 0; infos[k]; k++) {
            if (!gltf_refers(l, "material", i, "texture", infos[k]->texture, m->textures_count))
                return false;
            if (infos[k]->uv < 0)
                return refuse(l, "material", i, "a texCoord is negative");
        }
    }
    return true;
}

bool gltf_check(gltf_loader *l)
{
    return check_version(l) && check_views(l) && check_accessors(l) && check_textures(l) &&
           gltf_check_meshes(l) && gltf_check_nodes(l) && gltf_check_animations(l);
}
