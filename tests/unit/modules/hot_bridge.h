// SPDX-License-Identifier: MIT
#ifndef HOT_BRIDGE_H
#define HOT_BRIDGE_H

#include <fg/base.h>

FG_BEGIN

// Counts up in a variable that C++ makes unique in the process: the module that has it is never
// unloaded, whoever closes it.
int hot_unique_calls(void);

FG_END

#endif // HOT_BRIDGE_H
