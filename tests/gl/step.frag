#version 450 core
// SPDX-License-Identifier: MIT
// In and out as step.comp.
#include "step.glsl"
#ifdef TO_UINT
layout(location = 0) out uint color;
#else
layout(location = 0) out float color;
#endif

void main()
{
    uint number = step_number(ivec2(gl_FragCoord.xy));
#ifdef TO_UINT
    color = number;
#else
    color = float(number);
#endif
}
