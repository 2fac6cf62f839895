// SPDX-License-Identifier: MIT
// What hisr_node.spread holds. Needs hisr_shared.h.
struct node_extent {
    float size;   // root mean square distance of the patch from its position, m
    float reach;  // omega_j max ||V_j||^2, m^2
    float radius; // largest distance from its position, m
    float depth;  // largest distance from its plane, m
    float bend;   // root mean square departure of its normals from their mean, [0, 1)
    float cone;   // largest departure of a normal from the node's, as a chord
};

// Below 1e3 a half float's bits are never a NaN's.
float pack_pair(float a, float b)
{
    return uintBitsToFloat(packHalf2x16(min(vec2(a, b), vec2(1e3))));
}

vec4 pack_extent(node_extent e)
{
    float over = 1.0 / max(e.size, 1e-30);
    return vec4(e.size * e.size, e.reach, pack_pair(e.radius * over, e.depth * over),
                pack_pair(e.bend, e.cone));
}

node_extent unpack_extent(vec4 spread)
{
    float size = sqrt(spread.x);
    vec2 most = unpackHalf2x16(floatBitsToUint(spread.z)) * size;
    vec2 normals = unpackHalf2x16(floatBitsToUint(spread.w));
    return node_extent(size, spread.y, most.x, most.y, normals.x, normals.y);
}
