// SPDX-License-Identifier: MIT
#ifndef FG_DUMP_PRIV_H
#define FG_DUMP_PRIV_H

#include "graph_priv.h"

// A text that grows; sticks to `failed` when out of memory.
typedef struct text {
    const fg_allocator *allocator;
    char *bytes;
    uint32_t size, cap;
    bool failed;
} text;

void fg_text_put(text *t, const char *fmt, ...) FG_PRINTF(2, 3);
void fg_text_string(text *t, const char *s); // quoted and escaped as in JSON and DOT
// "RGBA16F 640x360, 5 mips" or "4096 bytes".
void fg_text_shape(text *t, const res_rec *r);

void fg_dump_text(const fg_graph *g, text *t);
void fg_dump_dot(const fg_graph *g, text *t);
void fg_dump_json(const fg_graph *g, text *t);
void fg_dump_trace(const fg_graph *g, text *t);

#endif // FG_DUMP_PRIV_H
