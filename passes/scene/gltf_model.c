// SPDX-License-Identifier: MIT
#include "gltf_model.h"

#include <stdlib.h>

typedef struct gltf_block {
    struct gltf_block *next;
    max_align_t items[];
} gltf_block;

void *gltf_model_alloc(gltf_model *m, size_t count, size_t item_size)
{
    if (count > (SIZE_MAX - sizeof(gltf_block)) / item_size)
        return NULL;
    gltf_block *block = calloc(1, sizeof *block + count * item_size);
    if (!block)
        return NULL;
    block->next = m->blocks;
    m->blocks = block;
    return block->items;
}

void gltf_model_finish(gltf_model *m)
{
    for (gltf_block *block = m->blocks, *next; block; block = next) {
        next = block->next;
        free(block);
    }
    *m = (gltf_model){ 0 };
}
