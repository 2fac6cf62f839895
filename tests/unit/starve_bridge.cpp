// SPDX-License-Identifier: MIT
#include "starve_bridge.h"

#include <cstdlib>
#include <new>

static long left = -1;
static void *last;

// CGAL 5.5 loses a block of simplices when the list of its blocks, which it lengthens next, cannot
// grow. The leak checker, where there is one, is not to speak of it.
extern "C" void __lsan_ignore_object(const void *) __attribute__((weak));

void starve_after(long count)
{
    left = count;
}

void *operator new(std::size_t size)
{
    void *p = left == 0 ? nullptr : std::malloc(size > 0 ? size : 1);
    if (!p) {
        if (last && __lsan_ignore_object)
            __lsan_ignore_object(last);
        throw std::bad_alloc();
    }
    if (left > 0)
        --left;
    last = left >= 0 ? p : nullptr;
    return p;
}

void operator delete(void *p) noexcept
{
    last = p == last ? nullptr : last;
    std::free(p);
}

void operator delete(void *p, std::size_t) noexcept
{
    last = p == last ? nullptr : last;
    std::free(p);
}
