#version 450 core
// SPDX-License-Identifier: MIT
// Irradiance of listed texels of a multiresolution buffer, each from its own cut of the VPL tree.
// In:  position RGBA32F, normal RGBA16F; hisr_node[], hisr_total; texels and their count
// Out: E / pi RGBA32F, W/(m^2 sr), a 1, into the flattened pyramid; nodes taken, receivers
// Permutations and source: gather.glsl.
#include "plugins/hisr/gather.glsl"
