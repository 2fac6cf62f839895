// SPDX-License-Identifier: MIT
// A number of each cell that neighbours do not share: exact in 32-bit floats below 4096^2.
float cell_number(ivec2 at)
{
    return float(at.x + 4096 * at.y);
}
