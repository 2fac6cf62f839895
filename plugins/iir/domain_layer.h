// SPDX-License-Identifier: MIT
#ifndef IIR_DOMAIN_LAYER_H
#define IIR_DOMAIN_LAYER_H

#include "core/manage.h"
#include "domain_shared.h"

#include <fg/graph.h>

// The sampling domain of the first light that has one, to look at: pass "iir.domain_layer", left
// out while nobody reads it. A cell has its VPL's colour, blue where the ray left the scene; a
// point is white, red when it is new.
//
// Shapes: out RGBA16F [512 x 512], display values.
typedef struct iir_domain_layer {
    iir_dot *dots; // [capacity], owned
    int capacity, count;
    bool on_sphere;
    const iir_result *result; // of the frame that runs
    fg_res buffer, out;
} iir_domain_layer;

FG_NODISCARD fg_status iir_domain_layer_init(iir_domain_layer *l, int capacity); // FG_ERR_MEMORY
void iir_domain_layer_finish(iir_domain_layer *l);                               // a zeroed one too
// `result` is borrowed, and read when the pass runs.
void iir_domain_layer_declare(iir_domain_layer *l, fg_graph *g, const iir_result *result);

#endif // IIR_DOMAIN_LAYER_H
