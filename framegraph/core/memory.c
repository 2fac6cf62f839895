// SPDX-License-Identifier: MIT
#include "graph_priv.h"

#include <stdlib.h>
#include <string.h>

static void *resize(const fg_allocator *a, void *ptr, size_t size)
{
    if (a->fn)
        return a->fn(a->user, ptr, size);
    if (size)
        return realloc(ptr, size);
    free(ptr);
    return NULL;
}

void *fg_alloc(const fg_allocator *a, size_t size)
{
    return resize(a, NULL, size);
}

bool fg_grow(const fg_allocator *a, void **array, uint32_t *cap, uint64_t need, size_t size)
{
    uint64_t want = *cap ? *cap : 16;
    while (want < need)
        want *= 2;
    if (want > NONE || want > SIZE_MAX / size)
        return false;
    void *ptr = resize(a, *array, (size_t) want * size);
    if (!ptr)
        return false;
    *array = ptr;
    *cap = (uint32_t) want;
    return true;
}

void fg_release(const fg_allocator *a, void *ptr)
{
    if (ptr)
        resize(a, ptr, 0);
}

uint32_t fg_hash(const void *bytes, size_t size)
{
    const char *at = bytes;
    uint64_t h = 0x9e3779b97f4a7c15u ^ size, word;
    for (; size >= 8; size -= 8, at += 8) {
        memcpy(&word, at, 8);
        h = (h ^ word) * 0xff51afd7ed558ccdu;
        h ^= h >> 32;
    }
    word = 0;
    memcpy(&word, at, size);
    h = (h ^ word) * 0xff51afd7ed558ccdu;
    return (uint32_t) (h ^ h >> 32);
}
