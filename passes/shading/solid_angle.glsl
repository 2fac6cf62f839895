// SPDX-License-Identifier: MIT
// Solid angle of the rectangle [lo, hi] on the plane one unit before the eye, steradians.
//
// Two triangles by tan(omega / 2) = a . (b x c) / (1 + a . b + b . c + c . a), unit vectors. Taken
// with the plane's own vectors the triple product is the rectangle's area, so that a tiny texel
// does not come out of a difference of large numbers.
// Source: van Oosterom, Strackee. The Solid Angle of a Plane Triangle. IEEE Trans. Biomed. Eng.
//         30(2), 1983.

// Of x >= 0. Drivers' atan() is off by as much as 2e-5 of the value (Mesa's polynomial): three
// halvings of the angle bring x below 0.2, where five terms of the series do.
float exact_atan(float x)
{
    for (int i = 0; i < 3; i++)
        x = x / (1.0 + sqrt(1.0 + x * x));
    float s = x * x;
    float series = 1.0 - s * (1.0 / 3.0 - s * (1.0 / 5.0 - s * (1.0 / 7.0 - s / 9.0)));
    return 8.0 * x * series;
}

float triangle_solid_angle(vec3 a, vec3 b, vec3 c, float twice_area)
{
    float la = length(a), lb = length(b), lc = length(c);
    float den = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2.0 * exact_atan(twice_area / den); // below pi: den > 0
}

float rectangle_solid_angle(vec2 lo, vec2 hi)
{
    vec2 size = hi - lo;
    float twice_area = size.x * size.y;
    vec3 a = vec3(lo, 1.0), b = vec3(hi.x, lo.y, 1.0), c = vec3(hi, 1.0), d = vec3(lo.x, hi.y, 1.0);
    return triangle_solid_angle(a, b, c, twice_area) + triangle_solid_angle(a, c, d, twice_area);
}
