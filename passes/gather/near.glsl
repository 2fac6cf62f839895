// SPDX-License-Identifier: MIT
// A VPL from so near that its patch counts and not its middle alone. Needs vpl_shared.h.

const float near_pi = 3.14159265358979;

// A VPL is near within so many patch areas of squared distance. Beyond, the disc is off by at most
// A_j / (pi d^2) = 8 % and soon by less; a wider reach costs more than it mends (16 takes a quarter
// off the error that is left and makes the gather two to three times slower). One that is seen
// flatter than a half float's normal can tell is in the receiver's own plane and lights nothing.
const float near_areas = 4.0;
const float flat_slope2 = 1e-6;
bool patch_is_near(float d2, float cos_j, float area) // cos_j: times |d|
{
    return d2 < near_areas * area && cos_j * cos_j > flat_slope2 * d2;
}

// 2 pi times the part of an edge in the form factor: the angle it spans, by how upright it stands.
float edge_integral(vec3 a, vec3 b, vec3 n)
{
    vec3 c = cross(a, b);
    float s = length(c);
    return s > 0.0 ? atan(s, dot(a, b)) * dot(c, n) / s : 0.0;
}

// The same of the part above the horizon. Keeps where the outline leaves and enters it.
float clipped_edge(vec3 a, vec3 b, vec3 n, inout vec3 leaving, inout vec3 entering)
{
    float height = dot(n, a), next_height = dot(n, b);
    if (max(height, next_height) <= 0.0)
        return 0.0;
    if (height * next_height < 0.0) { // one end below the horizon
        vec3 cut = mix(a, b, height / (height - next_height));
        if (height < 0.0)
            a = entering = cut;
        else
            b = leaving = cut;
    }
    return edge_integral(a, b, n);
}

// Form factor from the surface element at the origin with normal `n` to the patch of VPL `v` at `d`,
// cut off at the element's horizon. Lambert 1760. `edge`: sqrt(A_j), in the unit of `d`.
// The four edges are no loop: drivers that count the rounds of loops (see gather.c) count none.
float patch_form_factor(vec3 d, vec3 n, ag_vpl v, float edge)
{
    vec3 t, b, leaving = vec3(0.0), entering = vec3(0.0);
    vpl_frame(v.normal.xyz, t, b);
    vec2 eu = unpackHalf2x16(floatBitsToUint(v.normal.w)) * (0.5 * edge);
    vec2 ev = unpackHalf2x16(floatBitsToUint(v.flux.w)) * (0.5 * edge);
    vec3 u = t * eu.x + b * eu.y, w = t * ev.x + b * ev.y;
    vec3 p0 = d - u - w, p1 = d + u - w, p2 = d + u + w, p3 = d - u + w;
    float sum = clipped_edge(p0, p1, n, leaving, entering);
    sum += clipped_edge(p1, p2, n, leaving, entering);
    sum += clipped_edge(p2, p3, n, leaving, entering);
    sum += clipped_edge(p3, p0, n, leaving, entering);
    sum += edge_integral(leaving, entering, n);
    return abs(sum) / (2.0 * near_pi);
}

// Where surfaces meet, a texel of a reflective shadow map that sees both is given to one, and the
// other ends up to a texel short of the corner. Half a texel above the patch's plane that hardly
// shows.
const float texel_lift = 0.5;

// Irradiance of the element over the flux of a near VPL, 1 over the square of d's unit. `area`: A_j
// in it; `cos_j`: times |d|; `lift`: what the element is held off the patch's plane, in its edges.
float patch_share(vec3 d, vec3 n, ag_vpl v, float area, float cos_j, float lift)
{
    float edge = sqrt(area);
    d -= v.normal.xyz * max(lift * edge - cos_j, 0.0);
    return patch_form_factor(d, n, v, edge) / area;
}

// The same of a VPL that stands on its surface: no lift. Its patch reaches through a wall that it
// stands before; the wall's other side does not see the VPL and gets nothing.
float patch_share_on_surface(vec3 d, vec3 n, ag_vpl v, float area)
{
    float cos_j = max(-dot(v.normal.xyz, d), 0.0);
    return dot(n, d) > 0.0 ? patch_share(d, n, v, area, cos_j, 0.0) : 0.0;
}
