// SPDX-License-Identifier: MIT
// What cornell and the atrium promise beyond what all built-in scenes do.
#include "test_builtin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// ---- cornell -----------------------------------------------------------------------

// Whether `p`, in metres, is the point `mm`.
static bool is_corner(const float p[3], const float mm[3])
{
    bool same = true;
    for (int k = 0; k < 3; ++k)
        same = same && fabsf(p[k] - mm[k] / 1000.0f) < 1e-6f;
    return same;
}

static void cornell_has_the_published_coordinates(void **state)
{
    (void) state;
    // All distinct corners of the room, the short block and the tall one; millimetres.
    static const float corners[][3] = {
        { 552.8f, 0, 0 },      { 0, 0, 0 },           { 0, 0, 559.2f },
        { 549.6f, 0, 559.2f }, { 556.0f, 548.8f, 0 }, { 556.0f, 548.8f, 559.2f },
        { 0, 548.8f, 559.2f }, { 0, 548.8f, 0 },      { 130, 165, 65 },
        { 82, 165, 225 },      { 240, 165, 272 },     { 290, 165, 114 },
        { 130, 0, 65 },        { 82, 0, 225 },        { 240, 0, 272 },
        { 290, 0, 114 },       { 423, 330, 247 },     { 265, 330, 296 },
        { 314, 330, 456 },     { 472, 330, 406 },     { 423, 0, 247 },
        { 265, 0, 296 },       { 314, 0, 456 },       { 472, 0, 406 },
    };
    ag_scene *s = open_scene("cornell");
    int seen[FG_COUNT(corners)] = { 0 };
    const ag_primitive *last = &s->primitives[s->primitive_count - 1]; // moves: see below
    for (size_t v = 0; v < last->first_vertex; ++v) {
        int which = -1;
        for (int i = 0; i < FG_COUNT(corners) && which < 0; ++i)
            which = is_corner(s->vertices[v].position, corners[i]) ? i : -1;
        if (which < 0)
            fail_msg("vertex %zu is at no published corner", v);
        ++seen[which];
    }
    for (int i = 0; i < FG_COUNT(corners); ++i)
        assert_true(seen[i] > 0);
    // 5 sides and 2 x 5 faces of blocks.
    assert_int_equal(scene_triangles(s) - last->index_count / 3, 30);
    ag_scene_destroy(s);
}

// The tall block's corners are at 330 mm; what rises out of it is inside of it at time 0, and is
// all that moves.
static void cornell_rests_as_published_and_an_inner_block_rises_later(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const int last = s->instance_count - 1;
    const ag_primitive *inner = &s->primitives[s->instances[last].primitive];
    const ag_primitive *tall = &s->primitives[s->instances[last - 1].primitive];
    for (int i = 0; i <= last; ++i)
        assert_int_equal(s->instances[i].moving, i == last);
    for (int k = 0; k < 16; ++k)
        assert_true(s->instances[last].world[k] == (k % 5 ? 0.0 : 1.0));
    for (int k = 0; k < 3; ++k) {
        assert_true(inner->box_min[k] > tall->box_min[k]);
        assert_true(inner->box_max[k] < tall->box_max[k]);
    }
    ag_scene_set_time(s, 10.0);
    const double top = (double) inner->box_max[1] + s->instances[last].world[13];
    const double foot = (double) inner->box_min[1] + s->instances[last].world[13];
    assert_true(top > (double) tall->box_max[1] + 0.05 && foot < (double) tall->box_max[1]);
    ag_scene_destroy(s);
}

static void cornell_lamp_goes_in_a_circle_below_the_ceiling(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const double rest[3] = { 0.278, 0.5478, 0.2795 };
    assert_memory_equal(s->lights[0].position, rest, sizeof rest); // to the bit
    ag_scene_set_time(s, 4.0);                                     // half way round
    assert_true(fabs(s->lights[0].position[0] - (rest[0] - 2 * 0.0695)) < 1e-6);
    assert_true(fabs(s->lights[0].position[2] - rest[2]) < 1e-6);
    for (int i = 0; i < 16; ++i) {
        ag_scene_set_time(s, 0.5 * i);
        assert_true(s->lights[0].position[1] == rest[1]);
        assert_float_equal(s->lights[0].direction[1], -1.0f, 0.0f);
    }
    ag_scene_destroy(s);
}

static void cornell_camera_is_the_published_one(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const ag_camera *c = &s->cameras[0];
    assert_string_equal(c->name, "front");
    // 35 mm lens, 25 mm film: 39.3 degrees.
    assert_true(fabs((double) c->yfov - 2.0 * atan(12.5 / 35.0)) < 1e-6);
    const double want[3] = { 0.278, 0.273, -0.8 }, forward[3] = { 0, 0, 1 };
    for (int k = 0; k < 3; ++k) {
        assert_true(fabs(c->world[12 + k] - want[k]) < 1e-12);
        assert_true(fabs(c->world[8 + k] + forward[k]) < 1e-12);
    }
    ag_scene_destroy(s);
}

static void cornell_walls_face_the_room(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const double middle[3] = { 0.278, 0.45, 0.28 };    // above both blocks
    for (int i = 0; i + 1 < s->primitive_count; ++i) { // but the one that moves
        const mesh m = primitive_mesh(s, i);
        for (size_t k = 0; k < m.vertex_count && m.index_count == 6; ++k) {
            double side = 0.0;
            for (int j = 0; j < 3; ++j)
                side += (double) m.vertices[k].normal[j] *
                        (middle[j] - (double) m.vertices[k].position[j]);
            assert_true(side > 0.0);
        }
        if (m.index_count == 30) // a block: open below, so its volume is measured from the floor
            assert_true(mesh_volume(&m) > 0.001);
    }
    ag_scene_destroy(s);
}

static void cornell_is_open_in_front_alone(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const soup w = soup_of(s);
    const double from[3] = { 0.278, 0.45, 0.28 };
    static const double ways[6][3] = { { 1, 0, 0 },  { -1, 0, 0 }, { 0, 1, 0 },
                                       { 0, -1, 0 }, { 0, 0, 1 },  { 0, 0, -1 } };
    for (int i = 0; i < 6; ++i)
        assert_int_equal(soup_nearest(&w, from, ways[i], 1e9) >= 1e9, i == 5);
    free(w.corners);
    ag_scene_destroy(s);
}

static void cornell_lamp_is_a_spot_below_the_ceiling(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    assert_int_equal(s->light_count, 1);
    const ag_light *l = &s->lights[0];
    assert_int_equal(l->kind, AG_LIGHT_SPOT);
    assert_float_equal(l->direction[1], -1.0f, 1e-6f);
    assert_true(l->position[1] < 0.5488 && l->position[1] > 0.54);
    // In the published lamp's opening.
    assert_true(l->position[0] > 0.213 && l->position[0] < 0.343);
    assert_true(l->position[2] > 0.227 && l->position[2] < 0.332);
    assert_true(l->cos_inner > l->cos_outer && l->cos_outer > 0.0f);
    ag_scene_destroy(s);
}

// ---- atrium ------------------------------------------------------------------------

static void atrium_has_about_100k_triangles(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    assert_in_range(scene_triangles(s), 90000, 120000);
    assert_int_equal(s->light_count, 1);
    assert_true(s->texture_count >= 6);
    for (int i = 0; i < s->texture_count; ++i) {
        assert_int_equal(s->textures[i].width, 512);
        assert_int_equal(s->textures[i].height, 512);
        assert_true(s->textures[i].srgb);
    }
    static const char *const names[] = { "court", "gallery", "aisle", "above" };
    for (int i = 0; i < FG_COUNT(names); ++i)
        assert_int_equal(ag_scene_find_camera(s, names[i]), i);
    ag_scene_destroy(s);
}

static void atrium_is_as_large_as_a_palace_court(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    // Court 18 x 9, galleries of 3 and walls of 0.58 with their coping; two storeys and a roof.
    assert_true(fabs(s->box_max[0] - s->box_min[0] - (18 + 2 * 3.58)) < 0.01);
    assert_true(fabs(s->box_max[2] - s->box_min[2] - (9 + 2 * 3.58)) < 0.01);
    assert_true(fabs(s->box_max[1] - 10.66) < 0.01);
    ag_scene_destroy(s);
}

static void atrium_court_is_open_to_the_sky_and_its_galleries_are_not(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    const soup w = soup_of(s);
    static const double up[3] = { 0, 1, 0 };
    const double court[3] = { 2.5, 0.5, 0.5 }, lower[3] = { 1, 1.7, 6 }, upper[3] = { 1, 6, 6 };
    assert_true(soup_nearest(&w, court, up, 1e9) >= 1e9);
    const double vault = 1.7 + soup_nearest(&w, lower, up, 1e9);
    const double ceiling = 6.0 + soup_nearest(&w, upper, up, 1e9);
    assert_true(vault > 3.5 && vault < 4.2);
    assert_true(ceiling > 8.3 && ceiling < 8.7);
    free(w.corners);
    ag_scene_destroy(s);
}

static double light_distance(const ag_light *a, const ag_light *b)
{
    double d[3];
    for (int k = 0; k < 3; ++k)
        d[k] = a->position[k] - b->position[k];
    return length3(d);
}

static void atrium_light_sweeps_slowly_and_comes_back(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    const ag_light start = s->lights[0];
    assert_true(start.moving);
    ag_scene_set_time(s, 1.0);
    const double moved = light_distance(&start, &s->lights[0]);
    assert_true(moved > 0.1 && moved < 3.0); // metres in a second
    ag_scene_set_time(s, s->duration);
    assert_true(light_distance(&start, &s->lights[0]) < 1e-4);
    ag_scene_destroy(s);
}

static void atrium_lamps_swing_on_their_hooks(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    int moving = 0;
    double before[16][16] = { 0 };
    for (int i = 0; i < s->instance_count; ++i) {
        if (s->instances[i].moving && moving < 16)
            memcpy(before[moving++], s->instances[i].world, sizeof before[0]);
    }
    assert_int_equal(moving, 4);
    ag_scene_set_time(s, 0.6); // a quarter of a swing
    for (int i = 0, k = 0; i < s->instance_count; ++i) {
        if (!s->instances[i].moving)
            continue;
        double turned = 0.0;
        for (int j = 0; j < 12; ++j)
            turned = fmax(turned, fabs(s->instances[i].world[j] - before[k][j]));
        assert_true(turned > 0.02); // about the sine of the angle
        for (int j = 12; j < 15; ++j)
            assert_true(fabs(s->instances[i].world[j] - before[k][j]) < 1e-12);
        ++k;
    }
    ag_scene_destroy(s);
}

// Twice the area of a triangle in the world, and of its picture in the texture.
static void triangle_areas(const mesh *m, size_t first, double *in_world, double *in_texture)
{
    double e[2][3], f[2][2], area[3];
    const ag_vertex *v[3];
    for (size_t j = 0; j < 3; ++j)
        v[j] = &m->vertices[m->indices[first + j]];
    for (int j = 0; j < 2; ++j) {
        for (int c = 0; c < 3; ++c)
            e[j][c] = (double) (v[j + 1]->position[c] - v[0]->position[c]);
        for (int c = 0; c < 2; ++c)
            f[j][c] = (double) (v[j + 1]->uv[0][c] - v[0]->uv[0][c]);
    }
    for (int c = 0; c < 3; ++c) {
        const int x = (c + 1) % 3, y = (c + 2) % 3;
        area[c] = e[0][x] * e[1][y] - e[0][y] * e[1][x];
    }
    *in_world += length3(area);
    *in_texture += fabs(f[0][0] * f[1][1] - f[0][1] * f[1][0]);
}

// No stretched or missing texture coordinates.
static void atrium_texture_density_is_even(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    for (int i = 0; i < s->primitive_count; ++i) {
        const ag_material *m = &s->materials[s->primitives[i].material];
        const mesh p = primitive_mesh(s, i);
        double in_world = 0.0, in_texture = 0.0;
        for (size_t k = 0; k < p.index_count; k += 3)
            triangle_areas(&p, k, &in_world, &in_texture);
        const double density = in_texture / in_world; // textures a square metre
        if (m->base_color_tex.texture >= 0 && (density < 0.1 || density > 20.0))
            fail_msg("%s: %g textures a square metre", m->name, density);
    }
    ag_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cornell_has_the_published_coordinates),
        cmocka_unit_test(cornell_rests_as_published_and_an_inner_block_rises_later),
        cmocka_unit_test(cornell_lamp_goes_in_a_circle_below_the_ceiling),
        cmocka_unit_test(cornell_camera_is_the_published_one),
        cmocka_unit_test(cornell_walls_face_the_room),
        cmocka_unit_test(cornell_is_open_in_front_alone),
        cmocka_unit_test(cornell_lamp_is_a_spot_below_the_ceiling),
        cmocka_unit_test(atrium_has_about_100k_triangles),
        cmocka_unit_test(atrium_is_as_large_as_a_palace_court),
        cmocka_unit_test(atrium_court_is_open_to_the_sky_and_its_galleries_are_not),
        cmocka_unit_test(atrium_light_sweeps_slowly_and_comes_back),
        cmocka_unit_test(atrium_lamps_swing_on_their_hooks),
        cmocka_unit_test(atrium_texture_density_is_even),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
