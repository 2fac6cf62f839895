// SPDX-License-Identifier: MIT
#include "gltf_container.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_JSON_DEPTH = 200 };
static const uint32_t glb_magic = 0x46546c67, json_chunk = 0x4e4f534a, bin_chunk = 0x004e4942;

static fg_status fail(char fault[GLTF_FAULT], const char *fmt, ...) FG_PRINTF(2, 3);

static fg_status fail(char fault[GLTF_FAULT], const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    vsnprintf(fault, GLTF_FAULT, fmt, args);
    va_end(args);
    return FG_ERR_INPUT;
}

// ---- files ------------------------------------------------------------------------

// A pipe must not make the caller wait, a folder must not look like an empty file.
static int open_regular(const char *path, size_t *size, char fault[GLTF_FAULT])
{
    int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    struct stat info;
    if (file < 0 || fstat(file, &info) != 0) {
        fail(fault, "cannot be read: %s", strerror(errno));
        goto fail;
    }
    if (!S_ISREG(info.st_mode)) {
        fail(fault, "is not a regular file");
        goto fail;
    }
    if (info.st_size > (off_t) UINT32_MAX) {
        fail(fault, "has %lld bytes, at most 4294967295 are read", (long long) info.st_size);
        goto fail;
    }
    *size = (size_t) info.st_size;
    return file;

fail:
    if (file >= 0)
        close(file);
    return -1;
}

bool gltf_read_and_close(int file, uint8_t *out, size_t size)
{
    size_t done = 0;
    while (done < size) {
        ssize_t n = read(file, out + done, size - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            break;
        done += (size_t) n;
    }
    close(file);
    return done == size;
}

fg_status gltf_read_file(const char *path, uint8_t **out, size_t *size, char fault[GLTF_FAULT])
{
    int file = open_regular(path, size, fault);
    if (file < 0)
        return FG_ERR_INPUT;
    *out = malloc(*size + 1);
    if (!*out) {
        close(file);
        return FG_ERR_MEMORY;
    }
    if (gltf_read_and_close(file, *out, *size))
        return FG_OK;
    free(*out);
    *out = NULL;
    return fail(fault, "cannot be read to its end");
}

// What makes a URI something else than a file in the folder or below, or NULL.
static const char *uri_fault(const char *uri, size_t length)
{
    if (length == 0 || strlen(uri) != length)
        return "has a NUL in it";
    if (uri[0] == '/' || uri[0] == '\\')
        return "is absolute";
    size_t scheme = 0;
    while (isalnum((unsigned char) uri[scheme]) ||
           (scheme > 0 && strchr("+-.", uri[scheme]) && uri[scheme] != '\0'))
        scheme++;
    if (uri[scheme] == ':')
        return strncmp(uri, "data:", 5) == 0 ? "is data of a kind that is not read"
                                             : "has a scheme; only files beside are read";
    for (const char *part = uri; part; part = strpbrk(part, "/\\")) {
        part += *part == '/' || *part == '\\';
        if (strncmp(part, "..", 2) == 0 && (part[2] == '\0' || part[2] == '/' || part[2] == '\\'))
            return "leaves the file's folder";
    }
    return NULL;
}

int gltf_open_uri(gltf_files *files, const char *uri, size_t length, size_t *size)
{
    char fault[GLTF_FAULT] = "", path[4096];
    int file = -1;
    if (length == 0 && files->fault[0] == '\0')
        fail(files->fault, "a buffer or image has no URI");
    const char *wrong = uri_fault(uri, length);
    if (!wrong && !files->folder)
        wrong = "is a file; none is read here";
    if (wrong)
        fail(fault, "%s", wrong);
    else if ((size_t) snprintf(path, sizeof path, "%s/%s", files->folder, uri) >= sizeof path)
        fail(fault, "is too long");
    else
        file = open_regular(path, size, fault);
    if (file >= 0 && *size > files->bytes_left) {
        fail(fault, "makes the files beside too large together");
        close(file);
        file = -1;
    }
    if (file >= 0)
        files->bytes_left -= *size;
    else if (files->fault[0] == '\0')
        fail(files->fault, "URI '%.100s' %s", uri, fault);
    return file;
}

// ---- JSON before it is parsed ------------------------------------------------------

static bool is_digit(uint8_t c)
{
    return c >= '0' && c <= '9';
}

// Some writers give integers a fraction of zeros, which JSON allows and tinygltf reads as no
// number at all: blanks it at `i`, just behind a digit. Long ones stay: they would not fit.
static void blank_zero_fraction(uint8_t *json, size_t size, size_t i)
{
    size_t first = i, end = i + 1;
    while (first > 0 && is_digit(json[first - 1]))
        first--;
    while (end < size && json[end] == '0')
        end++;
    bool ends = end == size || (!is_digit(json[end]) && json[end] != 'e' && json[end] != 'E');
    if (end > i + 1 && ends && i - first > 0 && i - first < 10)
        memset(json + i, ' ', end - i);
}

// tinygltf recurses as deep as the text nests.
static fg_status prepare_json(uint8_t *json, size_t size, char fault[GLTF_FAULT])
{
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < size; i++) {
        uint8_t c = json[i];
        if (in_string) {
            i += c == '\\';
            in_string = c != '"';
            continue;
        }
        in_string = c == '"';
        depth += (c == '{' || c == '[') - (c == '}' || c == ']');
        if (depth > MAX_JSON_DEPTH)
            return fail(fault, "JSON: nested more than %d deep", MAX_JSON_DEPTH);
        if (c == '.')
            blank_zero_fraction(json, size, i);
    }
    return FG_OK;
}

// ---- .glb -------------------------------------------------------------------------

static uint32_t read32(const uint8_t *p)
{
    return (uint32_t) p[0] | (uint32_t) p[1] << 8 | (uint32_t) p[2] << 16 | (uint32_t) p[3] << 24;
}

static void write32(uint8_t *p, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t) (v >> (8 * i));
}

typedef struct glb_chunks {
    const uint8_t *json, *bin;
    size_t json_size, bin_size;
} glb_chunks;

static fg_status find_chunks(const uint8_t *bytes, size_t size, glb_chunks *out,
                             char fault[GLTF_FAULT])
{
    uint32_t length = read32(bytes + 8);
    if (read32(bytes + 4) != 2)
        return fail(fault, "GLB: version %u, must be 2", read32(bytes + 4));
    if (length != size)
        return fail(fault, "GLB: its header says %u bytes, there are %zu", length, size);
    int number = 0;
    for (size_t at = 12; at < size; number++) {
        if (size - at < 8)
            return fail(fault, "GLB: chunk %d: its header is cut off", number);
        uint32_t chunk_size = read32(bytes + at), type = read32(bytes + at + 4);
        if (chunk_size > size - at - 8)
            return fail(fault, "GLB: chunk %d: %u bytes, the file has only %zu more", number,
                        chunk_size, size - at - 8);
        const uint8_t *data = bytes + at + 8;
        if ((number == 0) != (type == json_chunk))
            return fail(fault, "GLB: chunk %d: the first chunk and no other must be JSON", number);
        if (type == bin_chunk && number != 1)
            return fail(fault, "GLB: chunk %d: only the second chunk may be BIN", number);
        if (number == 0) {
            out->json = data;
            out->json_size = chunk_size;
        } else if (type == bin_chunk) {
            out->bin = data;
            out->bin_size = chunk_size;
        }
        at += 8 + (size_t) chunk_size;
    }
    return out->json ? FG_OK : fail(fault, "GLB: it has no JSON chunk");
}

static fg_status pack(const glb_chunks *chunks, gltf_blob *out, char fault[GLTF_FAULT])
{
    size_t json_size = (chunks->json_size + 3) & ~(size_t) 3;
    size_t bin_size = (chunks->bin_size + 3) & ~(size_t) 3;
    size_t size = 20 + json_size + (bin_size > 0 ? 8 + bin_size : 0);
    if (size > UINT32_MAX)
        return fail(fault, "GLB: its chunks have 4 GiB or more");
    uint8_t *to = calloc(1, size);
    if (!to)
        return FG_ERR_MEMORY;
    *out = (gltf_blob){ .data = to, .size = size, .binary = true };
    write32(to, glb_magic);
    write32(to + 4, 2);
    write32(to + 8, (uint32_t) size);
    write32(to + 12, (uint32_t) json_size);
    write32(to + 16, json_chunk);
    memset(to + 20, ' ', json_size);
    memcpy(to + 20, chunks->json, chunks->json_size);
    if (chunks->bin && bin_size > 0) {
        write32(to + 20 + json_size, (uint32_t) bin_size);
        write32(to + 24 + json_size, bin_chunk);
        memcpy(to + 28 + json_size, chunks->bin, chunks->bin_size);
    }
    return prepare_json(to + 20, json_size, fault);
}

fg_status gltf_unpack(const uint8_t *bytes, size_t size, gltf_blob *out, char fault[GLTF_FAULT])
{
    fg_status status;
    *out = (gltf_blob){ 0 };
    if (size >= 12 && read32(bytes) == glb_magic) {
        glb_chunks chunks = { 0 };
        status = find_chunks(bytes, size, &chunks, fault);
        if (status == FG_OK && chunks.json)
            status = pack(&chunks, out, fault);
    } else if (size == 0 || size > UINT32_MAX) {
        status = fail(fault, "JSON: %zu bytes, must be 1 to 4294967295", size);
    } else {
        out->data = malloc(size);
        out->size = size;
        if (!out->data)
            return FG_ERR_MEMORY;
        memcpy(out->data, bytes, size);
        status = prepare_json(out->data, size, fault);
    }
    if (status != FG_OK) {
        free(out->data);
        *out = (gltf_blob){ 0 };
    }
    return status;
}
