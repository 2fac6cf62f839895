// SPDX-License-Identifier: MIT
#include "hot_bridge.h"

template <typename T> struct __attribute__((visibility("default"))) unique {
    static int calls;
};
template <typename T> int unique<T>::calls = 0;

int hot_unique_calls(void)
{
    return ++unique<int>::calls;
}
