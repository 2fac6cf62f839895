// SPDX-License-Identifier: MIT
#include "domain_priv.h"

#include <stdlib.h>

fg_status domain_tree_create(domain_tree *t, int capacity)
{
    t->leaves = 1;
    while (t->leaves < capacity)
        t->leaves *= 2;
    t->nodes = malloc(2 * (size_t) t->leaves * sizeof *t->nodes);
    return t->nodes ? FG_OK : FG_ERR_MEMORY;
}

void domain_tree_destroy(domain_tree *t)
{
    free(t->nodes);
}

static int winner(const domain_tree *t, const iir_domain *d, domain_before *before, int node)
{
    const int *pair = &t->nodes[2 * (size_t) node], a = pair[0], b = pair[1];
    if (a < 0 || b < 0)
        return a < 0 ? b : a;
    return before(d->cells, a, b) ? a : b;
}

void domain_tree_fill(domain_tree *t, const iir_domain *d, domain_before *before)
{
    for (int id = 0; id < t->leaves; ++id)
        t->nodes[t->leaves + id] = id < d->capacity && d->twin[id] == DOMAIN_CORNER ? id : -1;
    for (int node = t->leaves - 1; node > 0; --node)
        t->nodes[node] = winner(t, d, before, node);
}

void domain_tree_update(domain_tree *t, const iir_domain *d, domain_before *before, int id)
{
    t->nodes[t->leaves + id] = d->twin[id] == DOMAIN_CORNER ? id : -1;
    for (int node = (t->leaves + id) / 2; node > 0; node /= 2)
        t->nodes[node] = winner(t, d, before, node);
}
