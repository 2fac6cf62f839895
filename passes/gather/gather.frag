#version 450 core
// SPDX-License-Identifier: MIT
// Irradiance of those texels of a multiresolution buffer that the stencil test leaves, from all VPLs.
// In:  position RGBA32F, normal RGBA16F; ag_vpl[], count; VISIBILITY: imperfect shadow maps
// Out: E / pi RGBA32F, W/(m^2 sr); a 1, into the flattened pyramid
// Permutations and source: gather.glsl; Nichols, Shopf, Wyman 2009, sec. 3.2.1, early stencil culling.
#define FRAGMENT 1
#define BLOCK_X 1
#define BLOCK_Y 1
#include "passes/gather/gather.glsl"
