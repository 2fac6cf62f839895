#version 450 core
// SPDX-License-Identifier: MIT
// Irradiance of those texels of a multiresolution buffer that the stencil test leaves, each from its own
// cut of the VPL tree.
// In:  position RGBA32F, normal RGBA16F; hisr_node[], hisr_total
// Out: E / pi RGBA32F, W/(m^2 sr), a 1, into the flattened pyramid; nodes taken, receivers
// Permutations and source: gather.glsl; Nichols, Shopf, Wyman 2009, sec. 3.2.1, early stencil culling.
#define FRAGMENT 1
#define BLOCK 1
#include "plugins/hisr/gather.glsl"
