// SPDX-License-Identifier: MIT
// Small glTF files made by the tests, in a folder of their own.
#ifndef GLTF_FILE_H
#define GLTF_FILE_H

#include "scene_log.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static char gltf_folder[] = "/tmp/afterglow-gltf-XXXXXX";

static inline int make_folder(void **state)
{
    (void) state;
    return mkdtemp(gltf_folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
    (void) state;
    char command[256];
    snprintf(command, sizeof command, "rm -r %s", gltf_folder);
    return system(command);
}

static inline const char *path_of(const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", gltf_folder, name);
    return path;
}

static inline void write_file(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(path_of(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

// The bytes of a file's one buffer.
typedef struct bin {
    uint8_t bytes[4096];
    size_t size;
} bin;

static inline void put(bin *b, const void *bytes, size_t size)
{
    assert_true(b->size + size <= sizeof b->bytes);
    memcpy(b->bytes + b->size, bytes, size);
    b->size += size;
}
#define PUT_FLOATS(b, ...)                                                                         \
    put(b, (const float[]){ __VA_ARGS__ }, sizeof((const float[]){ __VA_ARGS__ }))
#define PUT_U16(b, ...)                                                                            \
    put(b, (const uint16_t[]){ __VA_ARGS__ }, sizeof((const uint16_t[]){ __VA_ARGS__ }))
#define PUT_U8(b, ...)                                                                             \
    put(b, (const uint8_t[]){ __VA_ARGS__ }, sizeof((const uint8_t[]){ __VA_ARGS__ }))

static inline void base64(const bin *b, char *out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < b->size; i += 3) {
        uint32_t three = 0;
        for (size_t k = 0; k < 3; k++)
            three = three << 8 | (i + k < b->size ? b->bytes[i + k] : 0);
        for (size_t k = 0; k < 4; k++)
            *out++ = i + k > b->size ? '=' : digits[three >> (18 - 6 * k) & 63];
    }
    *out = '\0';
}

// Writes test.gltf: the members in `body` and, where `b` is given, its bytes as the one buffer.
static inline void write_gltf(const bin *b, const char *body)
{
    static char text[1 << 16], data[8192];
    int n;
    if (b) {
        base64(b, data);
        n = snprintf(text, sizeof text,
                     "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu,\"uri\":"
                     "\"data:application/octet-stream;base64,%s\"}]%s%s}",
                     b->size, data, body[0] ? "," : "", body);
    } else {
        n = snprintf(text, sizeof text, "{\"asset\":{\"version\":\"2.0\"}%s%s}", body[0] ? "," : "",
                     body);
    }
    assert_true(n > 0 && (size_t) n < sizeof text);
    write_file("test.gltf", text, (size_t) n);
}

// Loads a file of the folder; NULL where it is refused. A refusal is one line that begins with
// the file's path, of status FG_ERR_INPUT.
static inline ag_scene *load(const char *name, lines *l)
{
    fg_log log = log_to(l);
    ag_scene *scene;
    fg_status status = ag_scene_load(&log, path_of(name), &scene);
    if (status == FG_OK) {
        assert_non_null(scene);
        assert_int_equal(l->errors, 0);
        assert_int_equal(l->warnings, scene->warning_count);
        return scene;
    }
    assert_int_equal(status, FG_ERR_INPUT);
    assert_null(scene);
    assert_int_equal(l->errors, 1);
    assert_memory_equal(l->error, path_of(name), strlen(path_of(name)));
    assert_null(strchr(l->error, '\n'));
    return NULL;
}

static inline ag_scene *load_gltf(const bin *b, const char *body, lines *l)
{
    write_gltf(b, body);
    ag_scene *scene = load("test.gltf", l);
    if (!scene)
        fail_msg("refused: %s", l->error);
    return scene;
}

#endif // GLTF_FILE_H
