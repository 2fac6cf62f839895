#version 450 core
// SPDX-License-Identifier: MIT
// Irradiance of every pixel from all VPLs.
// In:  position RGBA32F, normal RGBA16F; ag_vpl[], count
//      LIST: texels of a multiresolution buffer, their count
//      VISIBILITY: imperfect or paraboloid shadow maps
// Out: E / pi RGBA32F, W/(m^2 sr); a 1. LIST: into the flattened pyramid
// Permutations and source: gather.glsl.
#include "passes/gather/gather.glsl"
