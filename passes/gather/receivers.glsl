// SPDX-License-Identifier: MIT
// Which receivers an invocation of the gather has: the pixel (FRAGMENT), texels of a multiresolution
// buffer's list (LIST), pixels of the frame, or of one tile of a split one (SPLIT). Included by
// gather.glsl.
//
// Receivers of one invocation lie `group` pixels, or 64 texels of the list, apart, so that neighbours
// load neighbours. place_of(): where a receiver's sum stands.
#ifdef FRAGMENT
layout(location = 3) uniform ivec2 base; // size of level 0 in the pyramid

bool is_there(int i)
{
    return true;
}

ivec2 place_of(int i)
{
    return ivec2(gl_FragCoord.xy);
}

void fetch_receiver(int i, out vec3 position, out vec3 normal)
{
    multires_receiver(multires_at_place(place_of(i), base), position, normal);
}
#elif defined(LIST)
layout(std430, binding = 2) readonly buffer texel_buffer
{
    uint texels[];
};
layout(std430, binding = 3) readonly buffer texel_count_buffer
{
    uvec4 texel_count;
};
layout(location = 3) uniform ivec2 base; // size of level 0 in the pyramid

uint receiver(int i)
{
    uint group_index = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return (group_index * group * group + gl_LocalInvocationIndex) * block + i;
}

bool is_there(int i)
{
    return receiver(i) < texel_count.x;
}

multires_texel texel_of(int i)
{
    return multires_unpack(texels[min(receiver(i), texel_count.x - 1u)]);
}

ivec2 place_of(int i)
{
    return multires_place(texel_of(i), base);
}

void fetch_receiver(int i, out vec3 position, out vec3 normal)
{
    multires_receiver(texel_of(i), position, normal);
}
#else
#ifdef SPLIT
// Work groups of tile z lie within it.
layout(location = 3) uniform ivec3 tiles; // xy: pixels of one; z: n
ivec2 corner()
{
    int t = int(gl_WorkGroupID.z), j = t / tiles.z;
    return ivec2(t - j * tiles.z, j) * tiles.xy;
}

ivec2 extent()
{
    return tiles.xy;
}
#else
ivec2 corner()
{
    return ivec2(0);
}

ivec2 extent()
{
    return view.size.xy;
}
#endif

ivec2 receiver(int i)
{
    ivec2 base = ivec2(gl_WorkGroupID.xy) * group * ivec2(BLOCK_X, BLOCK_Y);
    return base + ivec2(gl_LocalInvocationID.xy) + group * ivec2(i % BLOCK_X, i / BLOCK_X);
}

bool is_there(int i)
{
    return all(lessThan(receiver(i), extent()));
}

ivec2 place_of(int i)
{
    return corner() + min(receiver(i), extent() - 1);
}

void fetch_receiver(int i, out vec3 position, out vec3 normal)
{
    position = texelFetch(position_map, place_of(i), 0).xyz;
    normal = texelFetch(normal_map, place_of(i), 0).xyz;
}
#endif

// VPLs that light these receivers: x first, y one past the last. Of a split image each tile has a run
// of the list, the first count % n^2 tiles one more: sec. 5.1 of Laine et al. 2007.
ivec2 run_of_vpls(int count)
{
#ifdef SPLIT
    int all_tiles = tiles.z * tiles.z, t = int(gl_WorkGroupID.z);
    int each = count / all_tiles, longer = count - each * all_tiles, first = t * each + min(t, longer);
    return ivec2(first, first + each + (t < longer ? 1 : 0));
#else
    return ivec2(0, count);
#endif
}

// By how much a receiver's sum is to be multiplied for those that its VPLs stand for.
float share_of_vpls()
{
#ifdef SPLIT
    return float(tiles.z * tiles.z);
#else
    return 1.0;
#endif
}
