// SPDX-License-Identifier: MIT
#ifndef TESTS_STARVE_BRIDGE_H
#define TESTS_STARVE_BRIDGE_H

#include <fg/base.h>

FG_BEGIN

// After `count` more allocations by C++'s new in this program all fail. -1: none does, as at first.
void starve_after(long count);

FG_END

#endif // TESTS_STARVE_BRIDGE_H
