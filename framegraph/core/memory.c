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

static uint64_t mix(uint64_t h, uint64_t word)
{
    h = (h ^ word) * 0xff51afd7ed558ccdu;
    return h ^ h >> 32;
}

static uint64_t load(const char *at, size_t size)
{
    uint64_t word = 0;
    memcpy(&word, at, size);
    return word;
}

uint32_t fg_hash(const void *bytes, size_t size)
{
    const char *at = bytes;
    uint64_t h = 0x9e3779b97f4a7c15u ^ size;
    size_t left = size;
    for (; left > 8; left -= 8, at += 8)
        h = mix(h, load(at, 8));
    // The last eight bytes, some of them again; of fewer, two halves or three bytes that overlap.
    if (size >= 8)
        h = mix(h, load(at + left - 8, 8));
    else if (size >= 4)
        h = mix(h, load(at, 4) << 32 | load(at + size - 4, 4));
    else if (size)
        h = mix(h, load(at, 1) << 16 | load(at + size / 2, 1) << 8 | load(at + size - 1, 1));
    // A product's bits depend only on lower ones: twice, so that the last byte reaches all.
    return (uint32_t) (h * 0xc4ceb9fe1a85ec53u >> 32);
}
