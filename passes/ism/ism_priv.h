// SPDX-License-Identifier: MIT
#ifndef ISM_PRIV_H
#define ISM_PRIV_H

#include <pass/ism.h>

struct ag_ism_samples {
    uint32_t buffer;
    int count;
};

#endif // ISM_PRIV_H
