// SPDX-License-Identifier: MIT
#include <emitter.h>
#include <pass/surface.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double box_min[3] = { -1, -2, -3 }, box_max[3] = { 3, 2, 1 };

static ag_light spot(double inner_degrees, double outer_degrees)
{
    ag_light light = ag_default_light();
    light.kind = AG_LIGHT_SPOT;
    light.direction[1] = -1;
    light.direction[2] = 0;
    light.cos_inner = (float) cos(inner_degrees * pi / 180);
    light.cos_outer = (float) cos(outer_degrees * pi / 180);
    return light;
}

static ag_light turned(ag_light light)
{
    light.direction[0] = 2 / 7.0f;
    light.direction[1] = -3 / 7.0f;
    light.direction[2] = -6 / 7.0f;
    return light;
}

static ag_light of_kind(ag_light_kind kind, bool cosine)
{
    ag_light light = spot(0, 90);
    light.kind = kind;
    light.cosine = cosine;
    return light;
}

static iir_emitter emitter(const ag_light *light)
{
    iir_emitter e;
    assert_true(iir_emitter_from_light(light, box_min, box_max, &e));
    return e;
}

// Flat parts, ramps from the axis on, ramps below the least width of 1e-3 (with full intensity
// never reached, and reached), cones up to all directions.
static const double cones[][2] = {
    { 30, 45 }, { 0, 45 },   { 0, 90 },    { 45, 90 },   { 60, 120 },    { 0, 150 },
    { 0, 180 }, { 90, 180 }, { 45, 45 },   { 0.5, 1 },   { 1, 1 },       { 2, 2 },
    { 90, 90 }, { 0, 0.1 },  { 89, 90.5 }, { 100, 100 }, { 179, 179.9 },
};
enum {
    CONES = sizeof cones / sizeof *cones,
    LIGHTS = CONES + 3,
};

static void all_lights(ag_light lights[LIGHTS])
{
    for (int i = 0; i < CONES; i++)
        lights[i] = spot(cones[i][0], cones[i][1]);
    lights[CONES] = of_kind(AG_LIGHT_SPOT, true);
    lights[CONES + 1] = of_kind(AG_LIGHT_POINT, false);
    lights[CONES + 2] = of_kind(AG_LIGHT_DIRECTIONAL, false);
}

static double random_double(uint64_t *state) // [0, 1)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double) (*state >> 11) * 0x1p-53;
}

// Uniform in the domain.
static void random_point(const iir_emitter *e, uint64_t *state, double out[3])
{
    const double phi = 2 * pi * random_double(state), u = random_double(state);
    const double z = e->space == IIR_SPHERE ? 2 * u - 1 : 0;
    const double r = e->space == IIR_SPHERE ? sqrt(1 - z * z) : sqrt(u);
    out[0] = r * cos(phi);
    out[1] = r * sin(phi);
    out[2] = z;
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double distance_of(const double a[3], const double b[3])
{
    return length_of((double[3]){ a[0] - b[0], a[1] - b[1], a[2] - b[2] });
}

static void near_by(double got, double want, double tolerance, const char *what)
{
    if (!(fabs(got - want) <= tolerance))
        fail_msg("%s: %.17g is not %.17g (off by %.3g, at most %.3g)", what, got, want, got - want,
                 tolerance);
}

// ---- there and back ---------------------------------------------------------------------------

// How far a point moves where its direction is off by one radian. Along the radius r' <= sqrt(3 /
// (2 H)) for a cone with 1 - cosine of H: the intensity falls from the axis on, so that the power
// within h is at least f h, hence r' = f sin / (2 r T) <= sqrt(f / (2 T)), and T >= f(0) H / 3.
// Across it is r / sine. Of a sphere and of a cosine spot it is one at most.
static double stretch(const iir_emitter *e, const double point[3], const double direction[3])
{
    if (e->kind != AG_LIGHT_SPOT || e->cosine)
        return 1;
    double c = 0;
    for (int k = 0; k < 3; k++)
        c += direction[k] * e->axes[2][k];
    const double sine = sqrt(fmax(1 - c * c, 0));
    return sqrt(1.5 / e->rim) + (c < 0 ? length_of(point) / sine : sqrt(3 / e->rim));
}

static void round_trip(const iir_emitter *e, const double point[3], double distance)
{
    double origin[3], direction[3], place[3], back[3];
    iir_emitter_ray(e, point, origin, direction);
    near_by(length_of(direction), 1, 16 * DBL_EPSILON, "length of a direction");
    for (int k = 0; k < 3; k++)
        place[k] = origin[k] + distance * direction[k];
    if (!iir_emitter_to_domain(e, place, back))
        fail_msg("%.17g %.17g %.17g is not in the domain", point[0], point[1], point[2]);
    // Half a dozen roundings of numbers up to one and of three coordinates each.
    const double reach = e->kind == AG_LIGHT_DIRECTIONAL ? e->radius : distance;
    const double turn = 16 * DBL_EPSILON * (1 + (length_of(origin) + distance) / reach);
    near_by(distance_of(point, back), 0, turn * stretch(e, point, direction), "back again");
}

static void places_map_back_to_their_points(void **state)
{
    (void) state;
    ag_light lights[LIGHTS];
    all_lights(lights);
    uint64_t random = 1;
    for (int l = 0; l < LIGHTS; l++) {
        const ag_light light = turned(lights[l]);
        const iir_emitter e = emitter(&light);
        for (int i = 0; i < 2000; i++) {
            double point[3];
            random_point(&e, &random, point);
            round_trip(&e, point, pow(10, 4 * random_double(&random) - 2));
        }
    }
}

static void points_near_the_axis_keep_their_digits(void **state)
{
    (void) state;
    for (int l = 0; l < CONES; l++) {
        const ag_light light = spot(cones[l][0], cones[l][1]);
        const iir_emitter e = emitter(&light);
        for (int power = 2; power <= 12; power++) {
            const double r = pow(10, -power);
            const double point[3] = { 0.6 * r, -0.8 * r, 0 };
            double origin[3], direction[3], back[3];
            iir_emitter_ray(&e, point, origin, direction);
            assert_true(iir_emitter_direction_to_domain(&e, direction, back));
            // The axis is one of the world's here, and nothing is added to small components.
            near_by(distance_of(point, back), 0, 32 * DBL_EPSILON * r, "near the axis");
        }
    }
}

static void expect_on_rim(const iir_emitter *e, double angle)
{
    const double point[3] = { cos(angle), sin(angle), 0 };
    double origin[3], direction[3], place[3], back[3];
    iir_emitter_ray(e, point, origin, direction);
    for (int k = 0; k < 3; k++) // rounded as hits are
        place[k] = (double) (float) (origin[k] + 3 * direction[k]);
    if (!iir_emitter_to_domain(e, place, back))
        fail_msg("cone %g: the rim is not in the domain", 1 - e->rim);
    near_by(length_of(back), 1, 1e-3, "a point on the rim");
    assert_true(length_of(back) <= 1 + 1e-15);
}

static void the_rim_belongs_to_the_domain(void **state)
{
    (void) state;
    ag_light lights[LIGHTS];
    all_lights(lights);
    for (int l = 0; l < LIGHTS; l++) {
        const ag_light light = turned(lights[l]);
        const iir_emitter e = emitter(&light);
        for (int i = 0; i < 100 && e.space == IIR_DISC; i++)
            expect_on_rim(&e, 0.1 * i);
    }
}

static void outside_of_the_cone_is_no_point(void **state)
{
    (void) state;
    double point[3];
    for (int l = 0; l < CONES; l++) {
        const ag_light light = turned(spot(cones[l][0], cones[l][1]));
        const iir_emitter e = emitter(&light);
        for (int i = -1; i <= 1; i += 2) {
            const double angle = acos((double) light.cos_outer) + 1e-5 * i;
            double place[3];
            if (angle > pi)
                continue;
            for (int k = 0; k < 3; k++)
                place[k] =
                    e.position[k] + 2 * cos(angle) * e.axes[2][k] + 2 * sin(angle) * e.axes[0][k];
            assert_int_equal(iir_emitter_to_domain(&e, place, point), i < 0);
        }
    }
    const ag_light cosine = of_kind(AG_LIGHT_SPOT, true);
    const iir_emitter hemisphere = emitter(&cosine);
    assert_false(iir_emitter_to_domain(&hemisphere, (double[3]){ 1, 1e-5, 0 }, point));
    assert_true(iir_emitter_to_domain(&hemisphere, (double[3]){ 1, -1e-5, 0 }, point));
    const ag_light sun = of_kind(AG_LIGHT_DIRECTIONAL, false);
    const iir_emitter disc = emitter(&sun);
    assert_false(iir_emitter_to_domain(&disc, (double[3]){ 1, 100, 0 }, point)); // behind
    assert_false(iir_emitter_to_domain(&disc, (double[3]){ 6, 0, 0 }, point));
}

static void the_light_itself_is_no_place(void **state)
{
    (void) state;
    double point[3];
    ag_light light = of_kind(AG_LIGHT_POINT, false);
    iir_emitter e = emitter(&light);
    assert_false(iir_emitter_to_domain(&e, light.position, point));
    light = of_kind(AG_LIGHT_SPOT, true);
    e = emitter(&light);
    assert_false(iir_emitter_to_domain(&e, light.position, point));
}

static void both_ends_of_the_axis_map_to_finite_points(void **state)
{
    (void) state;
    double point[3];
    const ag_light light = spot(0, 180);
    const iir_emitter e = emitter(&light);
    assert_true(iir_emitter_direction_to_domain(&e, (double[3]){ 0, -1, 0 }, point));
    near_by(length_of(point), 0, 0, "centre");
    assert_true(iir_emitter_direction_to_domain(&e, (double[3]){ 0, 1, 0 }, point));
    near_by(length_of(point), 1, 0, "rim");
}

// ---- power ------------------------------------------------------------------------------------

// W per sr, or of directional lights per m^2, along a ray.
static double intensity_along(const ag_light *light, const double origin[3],
                              const double direction[3])
{
    double place[3], distance;
    float irradiance[3], to_light[3];
    for (int k = 0; k < 3; k++)
        place[k] = origin[k] + direction[k];
    ag_light_eval(light, place, irradiance, to_light, &distance);
    return (double) irradiance[0];
}

// What the ray through a point moves across itself: of directional lights its origin.
static void moved(const iir_emitter *e, const double from[3], const double step[3], double out[3])
{
    double origin[2][3], direction[2][3];
    for (int i = 0; i < 2; i++) {
        double at[3];
        for (int k = 0; k < 3; k++)
            at[k] = from[k] + (2 * i - 1) * 0.5 * step[k];
        iir_emitter_ray(e, at, origin[i], direction[i]);
    }
    for (int k = 0; k < 3; k++)
        out[k] = origin[1][k] - origin[0][k] + direction[1][k] - direction[0][k];
}

static double across(const double a[3], const double b[3])
{
    return length_of((double[3]){ a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                  a[0] * b[1] - a[1] * b[0] });
}

// Two steps of length `size` in the domain, across each other.
static void two_steps(const iir_emitter *e, const double point[3], double size, double out[2][3])
{
    const double r = hypot(point[0], point[1]);
    memcpy(out[0], (double[3]){ -size * point[1] / r, size * point[0] / r, 0 }, sizeof out[0]);
    memcpy(out[1], (double[3]){ size * point[0] / r, size * point[1] / r, 0 }, sizeof out[1]);
    if (e->space == IIR_SPHERE) {
        out[1][0] *= point[2];
        out[1][1] *= point[2];
        out[1][2] = -size * r;
    }
}

static void equal_areas_get_equal_power(void **state)
{
    (void) state;
    ag_light lights[LIGHTS];
    all_lights(lights);
    uint64_t random = 2;
    for (int l = 0; l < LIGHTS; l++) {
        const iir_emitter e = emitter(&lights[l]);
        const double want = e.power[0] / iir_space_area(e.space);
        for (int i = 0; i < 1000; i++) {
            double point[3], step[2][3], out[2][3], origin[3], direction[3];
            random_point(&e, &random, point);
            const double r = hypot(point[0], point[1]);
            if (r < 0.01 || r > 0.97)
                continue;
            const double size = 0x1p-14;
            two_steps(&e, point, size, step);
            moved(&e, point, step[0], out[0]);
            moved(&e, point, step[1], out[1]);
            iir_emitter_ray(&e, point, origin, direction);
            const double intensity = intensity_along(&lights[l], origin, direction);
            const double got = intensity * across(out[0], out[1]) / (size * size);
            // A central difference is off by step^2 / 24 of the third derivative over the first,
            // which near the axis goes as 1 / r^2 and near the rim as 1 / (1 - r)^2: 1.6e-10 /
            // 1e-4. Rounding: 2^-53 / 2^-14 over a cone's width, 1.7e-3 at least. The intensity is
            // a float; where the ramp is 1e-3 wide, its cosine's 2^-53 / 1e-3 adds nothing to that.
            // Where the kink of the falloff is within the step, up to a step's share of the slope's
            // change.
            near_by(got, want, want * 2e-4, "power for an area");
        }
    }
}

// Midpoint rule over the cosine.
static double quadrature(const ag_light *light)
{
    enum { STEPS = 200000 };
    const double from = light->kind == AG_LIGHT_POINT ? -1
                        : light->cosine               ? 0
                                                      : (double) light->cos_outer;
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double c = from + (1 - from) * (i + 0.5) / STEPS, s = sqrt(1 - c * c);
        const double place[3] = { light->position[0] + s, light->position[1] - c,
                                  light->position[2] };
        double distance;
        float e[3], to_light[3];
        ag_light_eval(light, place, e, to_light, &distance);
        sum += (double) e[0] * 2 * pi * (1 - from) / STEPS;
    }
    return sum;
}

static void power_is_the_integral_of_the_intensity(void **state)
{
    (void) state;
    ag_light lights[LIGHTS];
    all_lights(lights);
    for (int l = 0; l < CONES + 2; l++) {
        lights[l].intensity[1] = 2;
        lights[l].intensity[2] = 0;
        const iir_emitter e = emitter(&lights[l]);
        const double want = quadrature(&lights[l]);
        // The rule is off by 1 / (24 n^2) of the integrand's change of slope; the intensities are
        // floats; cosines near 1 are known to 2^-53 of a cone that is 1.5e-6 at least.
        near_by(e.power[0], want, 1e-6 * want, "power");
        near_by(e.power[1], 2 * want, 2e-6 * want, "power of green");
        near_by(e.power[2], 0, 0, "power of blue");
    }
}

// Between two cosines.
static double power_between(const ag_light *light, double inner, double outer)
{
    enum { STEPS = 4000 };
    const double width = (inner - outer) / STEPS;
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double c = inner - width * (i + 0.5), away[3] = { sqrt(1 - c * c), -c, 0 };
        sum += 2 * pi * width * intensity_along(light, light->position, away);
    }
    return sum;
}

static void rings_of_equal_area_get_equal_power(void **state)
{
    (void) state;
    enum { RINGS = 16 };
    for (int l = 0; l < CONES; l++) {
        const ag_light light = spot(cones[l][0], cones[l][1]);
        const iir_emitter e = emitter(&light);
        double before = 1;
        for (int ring = 1; ring <= RINGS; ring++) {
            const double edge[3] = { sqrt(ring / (double) RINGS), 0, 0 };
            double origin[3], direction[3];
            iir_emitter_ray(&e, edge, origin, direction);
            // Of cosines near 1 a cone of 0.1 degrees has 1.5e-6 / 16 in a ring: 2^-53 of one is
            // 1e-9 of that. Otherwise as above, with 4000 steps.
            near_by(power_between(&light, before, -direction[1]), e.power[0] / RINGS,
                    1e-6 * e.power[0], "ring");
            before = -direction[1];
        }
    }
}

static void powers_are_those_of_closed_forms(void **state)
{
    (void) state;
    ag_light light = of_kind(AG_LIGHT_POINT, false);
    near_by(emitter(&light).power[0], 4 * pi, 1e-14, "point");
    light = of_kind(AG_LIGHT_SPOT, true);
    near_by(emitter(&light).power[0], pi, 1e-14, "cosine");
    light = spot(0, 90); // (cos)^2 over a hemisphere; cosf(90 degrees) is 4e-8 off
    near_by(emitter(&light).power[0], 2 * pi / 3, 1e-6, "squared cosine");
    light = spot(180, 180); // full but for the last 1e-3, which keeps a third
    near_by(emitter(&light).power[0], 2 * pi * (2 - 1e-3 * 2 / 3), 1e-14, "all around");
    light = of_kind(AG_LIGHT_DIRECTIONAL, false);
    near_by(emitter(&light).power[0], pi * 12, 1e-13, "across a box of half edges 2");
}

static void what_gives_no_light_has_no_emitter(void **state)
{
    (void) state;
    iir_emitter e;
    ag_light light = spot(0, 0);
    light.cos_inner = light.cos_outer = 1;
    assert_false(iir_emitter_from_light(&light, box_min, box_max, &e));
    light = of_kind(AG_LIGHT_POINT, false);
    memset(light.intensity, 0, sizeof light.intensity);
    assert_false(iir_emitter_from_light(&light, box_min, box_max, &e));
    light = of_kind(AG_LIGHT_DIRECTIONAL, false);
    assert_false(iir_emitter_from_light(&light, box_max, box_min, &e)); // an empty scene's box
    assert_false(iir_emitter_from_light(&light, box_max, box_max, &e));
    light = of_kind(AG_LIGHT_POINT, false);
    assert_true(iir_emitter_from_light(&light, box_max, box_min, &e));
}

// ---- directional lights -----------------------------------------------------------------------

static void expect_disc_before(double scale, double offset)
{
    const ag_light light = turned(of_kind(AG_LIGHT_DIRECTIONAL, false));
    double lo[3], hi[3];
    iir_emitter e;
    for (int k = 0; k < 3; k++) {
        lo[k] = scale * (box_min[k] + offset);
        hi[k] = scale * (box_max[k] + offset);
    }
    assert_true(iir_emitter_from_light(&light, lo, hi, &e));
    for (int corner = 0; corner < 8; corner++) {
        double place[3], point[3], along = 0;
        for (int k = 0; k < 3; k++) {
            place[k] = corner >> k & 1 ? hi[k] : lo[k];
            along += (place[k] - e.position[k]) * e.axes[2][k];
        }
        assert_true(along > 0.06 * e.radius);
        assert_true(iir_emitter_to_domain(&e, place, point));
    }
    round_trip(&e, (double[3]){ 0.3, -0.5, 0 }, e.radius);
}

static void a_directional_disc_lies_before_the_scene_at_any_scale(void **state)
{
    (void) state;
    for (int power = -4; power <= 4; power++) {
        expect_disc_before(pow(10, power), 0);
        expect_disc_before(pow(10, power), 100);
    }
}

// ---- sections ---------------------------------------------------------------------------------

static void a_section_carries_its_share_of_the_power(void **state)
{
    (void) state;
    ag_light lights[LIGHTS];
    all_lights(lights);
    uint64_t random = 3;
    for (int l = 0; l < LIGHTS; l++) {
        const iir_emitter e = emitter(&lights[l]);
        const double all = iir_space_area(e.space), area = 1e-5 * all;
        for (int i = 0; i < 200; i++) {
            double point[3], origin[3], direction[3];
            random_point(&e, &random, point);
            if (e.space == IIR_DISC && length_of(point) > 0.95)
                continue;
            iir_emitter_ray(&e, point, origin, direction);
            const double intensity = intensity_along(&lights[l], origin, direction);
            const double section = iir_emitter_section(&e, point, area, 1);
            // The mean over a ring 3e-3 to either side differs from the middle by the square of
            // (3e-3 / 0.05), where the falloff's power of r - 1 is 2/3 at most, over 3; across the
            // kink where a falloff begins by 3e-3 of a slope of 2 over the ramp's width in r.
            near_by(section * intensity, e.power[0] * 1e-5, e.power[0] * 1e-5 * 2e-2, "section");
        }
    }
}

// From the middle out, at a distance of 2. The light falls from the axis on: the same area is a
// wider section.
static void expect_sections(const iir_emitter *e, double area, double most)
{
    const double scale = e->kind == AG_LIGHT_DIRECTIONAL ? 1 : 4;
    double before = 0;
    for (int i = 0; i <= 100; i++) {
        const double r = i / 100.0;
        const double point[3] = { r, 0, e->space == IIR_SPHERE ? sqrt(1 - r * r) : 0 };
        const double got = iir_emitter_section(e, point, area, 2) / scale;
        assert_true(got > 0 && got <= most * (1 + 1e-12));
        assert_true(got >= before * (1 - 1e-6));
        before = got;
    }
}

static void sections_stay_within_the_cone(void **state)
{
    (void) state;
    ag_light lights[LIGHTS];
    all_lights(lights);
    for (int l = 0; l < LIGHTS; l++) {
        const iir_emitter e = emitter(&lights[l]);
        const double all = iir_space_area(e.space);
        const double most = e.kind == AG_LIGHT_POINT         ? 4 * pi
                            : e.kind == AG_LIGHT_DIRECTIONAL ? pi * e.radius * e.radius
                                                             : 2 * pi * e.rim;
        for (int power = 0; power <= 20; power++)
            expect_sections(&e, all * pow(10, -power), most);
        const double centre[3] = { 0, 0, e.space == IIR_SPHERE };
        near_by(iir_emitter_section(&e, centre, all, 1), most, 1e-12 * most, "all of it");
    }
}

// Nusselt: an area at the rim is the projection of what lies behind it.
static void at_the_rim_of_a_cosine_spot_the_section_is_the_rings_mean(void **state)
{
    (void) state;
    const ag_light light = of_kind(AG_LIGHT_SPOT, true);
    const iir_emitter e = emitter(&light);
    const double area = pi / 256, inner = 1 - 1.0 / 16;
    const double solid_angle = 2 * pi * sqrt(1 - inner * inner), ring = pi * (1 - inner * inner);
    near_by(iir_emitter_section(&e, (double[3]){ 1, 0, 0 }, area, 3), 9 * solid_angle * area / ring,
            1e-13, "rim");
}

static void equality_is_exact(void **state)
{
    (void) state;
    ag_light lights[LIGHTS];
    all_lights(lights);
    for (int l = 0; l < LIGHTS; l++) {
        ag_light light = lights[l];
        const iir_emitter e = emitter(&light);
        iir_emitter other = emitter(&light);
        assert_true(iir_emitter_equal(&e, &other));
        light.intensity[0] = nextafterf(light.intensity[0], 2);
        other = emitter(&light);
        assert_false(iir_emitter_equal(&e, &other));
        light = turned(lights[l]);
        light.position[1] += 1e-15;
        other = emitter(&light);
        assert_false(iir_emitter_equal(&e, &other));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_map_back_to_their_points),
        cmocka_unit_test(points_near_the_axis_keep_their_digits),
        cmocka_unit_test(the_rim_belongs_to_the_domain),
        cmocka_unit_test(outside_of_the_cone_is_no_point),
        cmocka_unit_test(the_light_itself_is_no_place),
        cmocka_unit_test(both_ends_of_the_axis_map_to_finite_points),
        cmocka_unit_test(equal_areas_get_equal_power),
        cmocka_unit_test(power_is_the_integral_of_the_intensity),
        cmocka_unit_test(rings_of_equal_area_get_equal_power),
        cmocka_unit_test(powers_are_those_of_closed_forms),
        cmocka_unit_test(what_gives_no_light_has_no_emitter),
        cmocka_unit_test(a_directional_disc_lies_before_the_scene_at_any_scale),
        cmocka_unit_test(a_section_carries_its_share_of_the_power),
        cmocka_unit_test(sections_stay_within_the_cone),
        cmocka_unit_test(at_the_rim_of_a_cosine_spot_the_section_is_the_rings_mean),
        cmocka_unit_test(equality_is_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
