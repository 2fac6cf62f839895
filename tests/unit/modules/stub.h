// SPDX-License-Identifier: MIT
// A technique that cannot be created, for modules that are only looked at.
#ifndef STUB_H
#define STUB_H

#include <gi/plugin.h>

static fg_status create(const gi_env *env, const gi_value *values, void **self)
{
    (void) env;
    (void) values;
    *self = NULL;
    return FG_ERR_UNSUPPORTED;
}

static void declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    (void) self;
    (void) g;
    (void) in;
    (void) out;
}

static void destroy(void *self)
{
    (void) self;
}

#endif // STUB_H
