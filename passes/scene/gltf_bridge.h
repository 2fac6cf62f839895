// SPDX-License-Identifier: MIT
// C face of gltf_bridge.cpp and the two mirrors: tinygltf parses, nothing else. Its header is
// included nowhere else.
#ifndef GLTF_BRIDGE_H
#define GLTF_BRIDGE_H

#include "gltf_container.h"
#include "gltf_model.h"

FG_BEGIN

typedef struct gltf_parsed gltf_parsed; // tinygltf's model

// Parses what gltf_unpack() gave, and mirrors it. Images stay encoded; one that cannot be read
// has no data, and the first such fault is in `files->fault`. `model` borrows from `*out`;
// gltf_model_finish() is the caller's even after an error.
//
// Errors: FG_ERR_INPUT with the first fault in `files->fault`; FG_ERR_MEMORY. `*out` is NULL then.
fg_status gltf_parse(const gltf_blob *blob, gltf_files *files, gltf_parsed **out,
                     gltf_model *model);
// Whether a file may require this extension.
bool gltf_extension_known(const char *name);
void gltf_parsed_destroy(gltf_parsed *parsed); // accepts NULL

FG_END

#ifdef __cplusplus
// The two halves of the mirror. They throw, under gltf_parse()'s guard.
void gltf_mirror_shapes(const gltf_parsed *parsed, gltf_model *out);
void gltf_mirror_looks(const gltf_parsed *parsed, gltf_model *out);
#endif

#endif // GLTF_BRIDGE_H
