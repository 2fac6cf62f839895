// SPDX-License-Identifier: MIT
// libFuzzer on the glTF loader:
//
//     CC=clang CXX=clang++ meson setup build-fuzz -Dfuzz=true -Dplugins= -Dsamples=false
//     ninja -C build-fuzz
//     python3 tests/fuzz/seeds.py corpus
//     build-fuzz/tests/fuzz/fuzz_scene -dict=tests/fuzz/gltf.dict -max_len=16384 corpus
//
// An input is a .glb as it is, or JSON, a NUL and the bytes of the buffer, which are packed into
// one: the lengths of a container are hard to guess.
#include "gltf_load.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void set32(uint8_t *at, size_t v)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t) (v >> (8 * i));
}

static uint8_t *pack(const uint8_t *json, size_t json_size, const uint8_t *bin, size_t bin_size,
                     size_t *size)
{
    *size = 28 + json_size + bin_size;
    uint8_t *glb = malloc(*size);
    assert(glb);
    memcpy(glb, "glTF\2\0\0\0", 8);
    set32(glb + 8, *size);
    set32(glb + 12, json_size);
    memcpy(glb + 16, "JSON", 4);
    memcpy(glb + 20, json, json_size);
    set32(glb + 20 + json_size, bin_size);
    memcpy(glb + 24 + json_size, "BIN", 4);
    memcpy(glb + 28 + json_size, bin, bin_size);
    return glb;
}

static int errors;

static void count_errors(void *user, fg_log_level level, const char *msg)
{
    (void) user;
    errors += level == FG_LOG_ERROR;
    assert(!strchr(msg, '\n'));
}

// What everything that reads a scene relies on.
static void check(const ag_scene *s)
{
    for (int i = 0; i < s->primitive_count; i++) {
        const ag_primitive *p = &s->primitives[i];
        assert(p->material >= 0 && p->material < s->material_count && p->index_count % 3 == 0);
        assert((size_t) p->first_index + p->index_count <= s->index_count);
        assert((size_t) p->first_vertex + p->vertex_count <= s->vertex_count);
        for (uint32_t k = 0; k < p->index_count; k++)
            assert(s->indices[p->first_index + k] < p->vertex_count);
    }
    for (size_t i = 0; i < s->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            assert(isfinite(s->vertices[i].position[k]) &&
                   fabsf(s->vertices[i].normal[k]) < 1.001f);
    for (int i = 0; i < s->instance_count; i++) {
        assert(s->instances[i].primitive >= 0 && s->instances[i].primitive < s->primitive_count);
        for (int k = 0; k < 16; k++)
            assert(isfinite(s->instances[i].world[k]));
    }
    for (int i = 0; i < s->light_count; i++)
        assert(isfinite(s->lights[i].intensity[0]) && isfinite(s->lights[i].direction[0]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint8_t *nul = size > 0 ? memchr(data, 0, size) : NULL;
    uint8_t *glb = NULL;
    ag_load_desc desc = { .label = "input", .name = "input", .bytes = data, .size = size };
    if (nul && memcmp(data, "glTF", size < 4 ? size : 4) != 0) {
        size_t json = (size_t) (nul - data);
        glb = pack(data, json, nul + 1, size - json - 1, &desc.size);
        desc.bytes = glb;
    }
    fg_log log = { .fn = count_errors, .level = FG_LOG_INFO };
    desc.log = &log;
    desc.max_pixels = 1 << 18;
    desc.max_elements = 1 << 17;
    ag_scene *scene;
    errors = 0;
    fg_status status = ag_scene_load_memory(&desc, &scene);
    if (status == FG_OK) {
        assert(errors == 0);
        check(scene);
        ag_scene_set_time(scene, scene->duration * 0.7);
        check(scene);
        ag_scene_destroy(scene);
    } else {
        assert(status == FG_ERR_INPUT && errors == 1 && !scene);
    }
    free(glb);
    return 0;
}
