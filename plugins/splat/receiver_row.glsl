// SPDX-License-Identifier: MIT
// Where the i-th receiver stands in the images that list them: rows of 4096.
ivec2 receiver_row(uint i)
{
    return ivec2(i & 4095u, i >> 12);
}
