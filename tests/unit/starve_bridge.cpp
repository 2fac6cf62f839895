// SPDX-License-Identifier: MIT
#include "starve_bridge.h"

#include <cstdlib>
#include <new>

static long left = -1;

void starve_after(long count)
{
    left = count;
}

void *operator new(std::size_t size)
{
    void *p = left == 0 ? nullptr : std::malloc(size > 0 ? size : 1);
    if (!p)
        throw std::bad_alloc();
    if (left > 0)
        --left;
    return p;
}

void operator delete(void *p) noexcept
{
    std::free(p);
}

void operator delete(void *p, std::size_t) noexcept
{
    std::free(p);
}
