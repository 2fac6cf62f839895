// SPDX-License-Identifier: MIT
#ifndef PASS_READBACK_H
#define PASS_READBACK_H

#include <fg/graph.h>

FG_BEGIN

// Brings a small buffer to the host some frames late, without waiting for the GPU. Pass `name`,
// kept with its group (FG_EFFECT_INTERNAL).
enum { AG_READBACK_SLOTS = 4, AG_READBACK_BYTES = 64 };
typedef struct ag_readback {
    fg_res source;
    uint64_t size;
    uint32_t buffer;
    void *mapped;
    void *fences[AG_READBACK_SLOTS]; // GLsync
    int next;
    uint8_t latest[AG_READBACK_BYTES];
    bool valid; // `latest` holds something
} ag_readback;

FG_API FG_NODISCARD fg_status ag_readback_init(ag_readback *r); // FG_ERR_MEMORY
FG_API void ag_readback_finish(ag_readback *r);                 // accepts a zeroed one
// `size` bytes from the start of `source`, at most AG_READBACK_BYTES.
FG_API void ag_readback_declare(ag_readback *r, fg_graph *g, const char *name, fg_res source,
                                uint64_t size);
// Takes what has arrived; false while nothing has. `out` holds `size` bytes.
FG_API bool ag_readback_latest(ag_readback *r, void *out);

FG_END

#endif // PASS_READBACK_H
