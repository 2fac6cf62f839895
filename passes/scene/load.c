// SPDX-License-Identifier: MIT
#include "gltf_bridge.h"
#include "gltf_load.h"

#include <stdlib.h>
#include <string.h>

// ---- from the model to the builder --------------------------------------------------

static bool loader_create(gltf_loader *l)
{
    size_t nodes = (size_t) l->m->nodes_count + 1;
    l->parents = calloc(nodes, sizeof *l->parents);
    l->in_scene = calloc(nodes, sizeof *l->in_scene);
    l->nodes = calloc(nodes, sizeof *l->nodes);
    l->materials = calloc((size_t) l->m->materials_count + 1, sizeof *l->materials);
    l->skins = calloc((size_t) l->m->skins_count + 1, sizeof *l->skins);
    l->metal = -1;
    return l->parents && l->in_scene && l->nodes && l->materials && l->skins ? true
                                                                             : gltf_no_memory(l);
}

static void loader_finish(gltf_loader *l)
{
    free(l->parents);
    free(l->in_scene);
    free(l->nodes);
    free(l->materials);
    free(l->skins);
    ag_array_finish(&l->slots);
    ag_array_finish(&l->stamps);
}

// One line for each thing that is not as the file asks, however often it occurs.
static void say_what_is_missing(gltf_loader *l)
{
    const struct {
        int count;
        bool repair;
        const char *text;
    } lines[] = {
        { l->lines_skipped, true, "primitives of points or lines are left out" },
        { l->blends, true, "materials blend; they are opaque here" },
        { l->unlits, true, "materials are unlit; they are lit and diffuse here" },
        { l->unplayed, true, "animation channels (weights, or driven already) are not played" },
        { l->normal_maps, false, "materials have normal maps; they are not used" },
        { l->ranges, false, "lights have a range; it is ignored" },
    };
    for (int i = 0; i < FG_COUNT(lines); i++) {
        if (lines[i].count == 0)
            continue;
        if (lines[i].repair)
            ag_builder_warn(l->b, "%d %s", lines[i].count, lines[i].text);
        else
            ag_builder_info(l->b, "%d %s", lines[i].count, lines[i].text);
    }
}

static void convert(gltf_loader *l)
{
    if (loader_create(l) && gltf_check(l) && gltf_load_materials(l) && gltf_load_nodes(l) &&
        gltf_load_animations(l) && gltf_load_shows(l))
        say_what_is_missing(l);
    loader_finish(l);
}

// ---- from the bytes to the model ----------------------------------------------------

static uint64_t element_limit(const ag_load_desc *desc, const gltf_model *m)
{
    uint64_t bytes = desc->size;
    for (int i = 0; i < m->buffers_count; i++)
        bytes += m->buffers[i].size;
    return desc->max_elements > 0 ? desc->max_elements : (UINT64_C(1) << 22) + 64 * bytes;
}

// Parses, checks and converts into `b`, which keeps the status.
static void load_into(ag_builder *b, const ag_load_desc *desc)
{
    gltf_files files = { .folder = desc->folder, .bytes_left = UINT64_C(1) << 33 };
    gltf_blob blob = { 0 };
    gltf_parsed *parsed = NULL;
    gltf_model model = { 0 };
    fg_status status = gltf_unpack(desc->bytes, desc->size, &blob, files.fault);
    if (status == FG_OK)
        status = gltf_parse(&blob, &files, &parsed, &model);
    free(blob.data);
    if (status == FG_OK) {
        gltf_loader l = {
            .b = b,
            .m = &model,
            .image_fault = files.fault,
            .pixels_left = desc->max_pixels > 0 ? desc->max_pixels : UINT64_C(1) << 28,
            .elements_left = element_limit(desc, &model),
        };
        convert(&l);
    } else {
        ag_builder_refuse(b, status, "%s", status == FG_ERR_MEMORY ? "out of memory" : files.fault);
    }
    gltf_model_finish(&model);
    gltf_parsed_destroy(parsed);
}

fg_status ag_scene_load_memory(const ag_load_desc *desc, ag_scene **out)
{
    *out = NULL;
    ag_builder *b = ag_builder_create(desc->log, desc->name);
    fg_status status = b ? ag_builder_set_label(b, desc->label) : FG_ERR_MEMORY;
    if (status == FG_OK) {
        load_into(b, desc);
        status = ag_scene_build(b, out);
    } else {
        fg_logf(desc->log, FG_LOG_ERROR, "%s: out of memory", desc->label);
    }
    ag_builder_destroy(b);
    // What the builder calls a caller's mistake is the file's here.
    return status == FG_ERR_INVALID ? FG_ERR_INPUT : status;
}

// ---- from the disk to the bytes -----------------------------------------------------

fg_status ag_scene_load(const fg_log *log, const char *path, ag_scene **out)
{
    *out = NULL;
    uint8_t *bytes = NULL;
    size_t size = 0;
    char fault[GLTF_FAULT];
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    char *folder = slash ? strndup(path, slash > path ? (size_t) (slash - path) : 1) : strdup(".");
    char *name = strndup(base, dot && dot > base ? (size_t) (dot - base) : strlen(base));
    fg_status status = FG_ERR_MEMORY;
    if (folder && name)
        status = gltf_read_file(path, &bytes, &size, fault);
    if (status == FG_OK) {
        ag_load_desc desc = { .log = log, .label = path, .name = name, .folder = folder };
        desc.bytes = bytes;
        desc.size = size;
        status = ag_scene_load_memory(&desc, out);
    } else {
        fg_logf(log, FG_LOG_ERROR, "%s: %s", path,
                status == FG_ERR_MEMORY ? "out of memory" : fault);
    }
    free(bytes);
    free(folder);
    free(name);
    return status;
}
