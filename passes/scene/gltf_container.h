// SPDX-License-Identifier: MIT
// The outside of a glTF file, before any JSON is read: its bytes, the chunks of a .glb, the
// files beside it.
#ifndef GLTF_CONTAINER_H
#define GLTF_CONTAINER_H

#include <fg/base.h>

FG_BEGIN

enum { GLTF_FAULT = 320 }; // bytes of a fault's text

// What may be read beside the file, and the first thing that was wrong with it.
typedef struct gltf_files {
    const char *folder;     // NULL: nothing may be read
    uint64_t bytes_left;    // of all files together
    char fault[GLTF_FAULT]; // "" where nothing was wrong
} gltf_files;

// Reads a regular file of at most 4 GiB - 1. Errors: FG_ERR_INPUT with `fault` written;
// FG_ERR_MEMORY. `*out` is freed by free().
fg_status gltf_read_file(const char *path, uint8_t **out, size_t *size, char fault[GLTF_FAULT]);

// Opens the file that a decoded relative URI of `length` bytes names; -1 and the fault where it
// leaves the folder, is missing or too large.
int gltf_open_uri(gltf_files *files, const char *uri, size_t length, size_t *size);
// Reads all of it and closes it.
bool gltf_read_and_close(int file, uint8_t *out, size_t size);

// A file as tinygltf is given it: checked chunks, unknown ones left out, integers that are
// written as 12.0 written as 12.
typedef struct gltf_blob {
    uint8_t *data; // free()
    size_t size;
    bool binary;
} gltf_blob;

// Errors: FG_ERR_INPUT with `fault` written; FG_ERR_MEMORY.
fg_status gltf_unpack(const uint8_t *bytes, size_t size, gltf_blob *out, char fault[GLTF_FAULT]);

FG_END

#endif // GLTF_CONTAINER_H
