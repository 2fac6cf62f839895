// SPDX-License-Identifier: MIT
// Triangles by how many texels their box in a map has: those of up to area.x are drawn at once, and
// those above each of the three have a list of their own, so that neighbours take about as long.
const ivec3 area = ivec3(16, 64, 256);
