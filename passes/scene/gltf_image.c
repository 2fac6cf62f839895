// SPDX-License-Identifier: MIT
#include "gltf_image.h"

#include "scene_priv.h"

#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <stb_image.h>

enum { MAX_THREADS = 16 };

const char *gltf_picture_probe(gltf_picture *p)
{
    static const uint8_t png[] = { 0x89, 'P', 'N', 'G' }, jpeg[] = { 0xff, 0xd8, 0xff };
    int channels;
    // stb_image reads further formats, which glTF has not.
    bool known = p->size > 4 && (memcmp(p->bytes, png, sizeof png) == 0 ||
                                 memcmp(p->bytes, jpeg, sizeof jpeg) == 0);
    if (!known)
        return "it is neither PNG nor JPEG";
    if (p->size > INT_MAX)
        return "it has 2 GiB or more";
    if (!stbi_info_from_memory(p->bytes, (int) p->size, &p->width, &p->height, &channels))
        return "its header is broken";
    if (p->width < 1 || p->height < 1 || p->width > AG_MAX_SCENE_TEXTURE_SIDE ||
        p->height > AG_MAX_SCENE_TEXTURE_SIDE)
        return "it is larger than 16384 texels a side";
    return NULL;
}

static void decode(gltf_picture *p)
{
    int width, height, channels;
    p->rgba = stbi_load_from_memory(p->bytes, (int) p->size, &width, &height, &channels, 4);
    if (!p->rgba) {
        p->fault = stbi_failure_reason();
    } else if (width != p->width || height != p->height) {
        free(p->rgba);
        p->rgba = NULL;
        p->fault = "its size is not what its header said";
    }
}

typedef struct queue {
    gltf_picture *pictures;
    int count;
    atomic_int next;
} queue;

static void *work(void *user)
{
    queue *q = user;
    for (int i; (i = atomic_fetch_add(&q->next, 1)) < q->count;)
        decode(&q->pictures[i]);
    return NULL;
}

void gltf_picture_decode_all(gltf_picture *pictures, int count)
{
    queue q = { .pictures = pictures, .count = count };
    pthread_t threads[MAX_THREADS];
    long wanted = sysconf(_SC_NPROCESSORS_ONLN) - 1;
    int started = 0;
    while (started < wanted && started < MAX_THREADS && started + 1 < count &&
           pthread_create(&threads[started], NULL, work, &q) == 0)
        started++;
    work(&q);
    for (int i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
}
