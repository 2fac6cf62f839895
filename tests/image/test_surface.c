// SPDX-License-Identifier: MIT
// Materials and textures as the G-buffer shows them: a square that fills an orthographic view.
#include "fixture.h"

#include <math.h>
#include <pass/surface.h>
#include <stdio.h>
#include <string.h>

enum { SIZE = 16 };

// A square from (-1, -1) to (1, 1) at z = 0 that faces +z, uv (0, 0) at its top left corner, as
// glTF has it, times `repeat`, plus 0.25 in u and v if `shift`.
typedef struct square_desc {
    ag_material material;
    const ag_texture *textures; // added in this order, so that indices are known
    int texture_count;
    float repeat, offset;
    const double *matrix; // of the node; NULL: identity
    float normal[3];      // zero: +z
} square_desc;

static ag_scene *driven_square(const square_desc *d, const ag_channel_desc *channels, int count)
{
    static const uint32_t indices[] = { 0, 1, 2, 0, 2, 3 };
    static const float xy[4][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
    ag_vertex v[4];
    memset(v, 0, sizeof v);
    for (int i = 0; i < 4; i++) {
        v[i].position[0] = xy[i][0];
        v[i].position[1] = xy[i][1];
        memcpy(v[i].normal, d->normal, sizeof d->normal);
        for (int set = 0; set < 2; set++) {
            v[i].uv[set][0] = (xy[i][0] + 1) / 2 * d->repeat + d->offset;
            v[i].uv[set][1] = (1 - xy[i][1]) / 2 * d->repeat + d->offset;
        }
        v[i].uv[1][0] = 1 - v[i].uv[1][0]; // the second set runs the other way
        for (int c = 0; c < 4; c++)
            v[i].color[c] = 1;
    }
    ag_builder *b = ag_builder_create(test_log(), "square");
    for (int i = 0; i < d->texture_count; i++)
        assert_int_equal(ag_builder_texture(b, &d->textures[i]), i);
    const ag_primitive_desc primitive = {
        .name = "square",
        .vertices = v,
        .vertex_count = 4,
        .indices = indices,
        .index_count = 6,
        .material = ag_builder_material(b, &d->material),
    };
    const ag_node_desc node = { .name = "square", .parent = -1, .matrix = d->matrix };
    ag_builder_show(b, ag_builder_node(b, &node), ag_builder_primitive(b, &primitive), -1);
    ag_camera camera = plain_camera("front");
    camera.orthographic = true;
    camera.half_height = 1;
    camera.znear = 0;
    camera.zfar = 4;
    camera.world[14] = 2;
    ag_builder_camera(b, -1, &camera);
    for (int i = 0; i < count; i++)
        ag_builder_channel(b, &channels[i]);
    return finish_scene(b);
}

static ag_scene *square_scene(const square_desc *d)
{
    return driven_square(d, NULL, 0);
}

// red green / blue white, top row first
static const uint8_t four[16] = {
    255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255
};

static ag_texture four_texels(void)
{
    return (ag_texture){
        .name = "four", .width = 2, .height = 2, .rgba = four, .srgb = true, .nearest = true
    };
}

static const float *pixel(const image *img, int x, int y)
{
    return img->rgb + 3 * ((size_t) y * img->width + x);
}

static void expect_color(const image *img, int x, int y, const char *rgb)
{
    const float *p = pixel(img, x, y);
    for (int c = 0; c < 3; c++)
        if ((p[c] > 0.5f) != (rgb[c] == '1') || (p[c] > 0.01f && p[c] < 0.99f))
            fail_msg("pixel %d, %d is %g %g %g, not %s", x, y, (double) p[0], (double) p[1],
                     (double) p[2], rgb);
}

static square_desc textured(const ag_texture *texture)
{
    square_desc d = { .material = ag_default_material(),
                      .textures = texture,
                      .texture_count = 1,
                      .repeat = 1,
                      .normal = { 0, 0, 1 } };
    d.material.base_color_tex.texture = 0;
    return d;
}

static image albedo_of(const square_desc *d)
{
    ag_scene *scene = square_scene(d);
    image img = render_layer(scene, SIZE, SIZE, LAYER_ALBEDO, NULL, NULL);
    ag_scene_destroy(scene);
    return img;
}

static void first_texel_is_the_top_left_one(void **state)
{
    (void) state;
    const ag_texture t = four_texels();
    const square_desc d = textured(&t);
    image img = albedo_of(&d);
    expect_color(&img, 3, 3, "100");
    expect_color(&img, 12, 3, "010");
    expect_color(&img, 3, 12, "001");
    expect_color(&img, 12, 12, "111");
    image_finish(&img);
}

static void each_wrap_mode_does_what_it_says(void **state)
{
    (void) state;
    // uv runs from -1 to 2 in three squares; u at y of the first row. Columns 2, 7 and 13
    // are the middles of the outer halves.
    static const char *const want[3][4] = {
        // u: -0.9 (texel 0), -0.1 (texel 1), 1.1 (texel 0), 1.9 (texel 1) by repeat
        { "100", "010", "100", "010" },
        { "100", "100", "010", "010" }, // clamp
        { "010", "100", "010", "100" }, // mirror
    };
    for (int mode = 0; mode < 3; mode++) {
        ag_texture t = four_texels();
        t.wrap_u = (ag_wrap) mode;
        t.wrap_v = AG_WRAP_CLAMP;
        square_desc d = textured(&t);
        d.repeat = 3;
        d.offset = -1;
        image img = albedo_of(&d);
        static const int columns[4] = { 0, 4, 11, 15 };
        for (int i = 0; i < 4; i++)
            expect_color(&img, columns[i], 1, want[mode][i]);
        expect_color(&img, 0, 14, mode == 2 ? "111" : "001");
        image_finish(&img);
    }
}

static void uv_set_and_transform_are_applied(void **state)
{
    (void) state;
    const ag_texture t = four_texels();
    square_desc d = textured(&t);
    d.material.base_color_tex.uv = 1; // mirrored in u
    image img = albedo_of(&d);
    expect_color(&img, 3, 3, "010");
    expect_color(&img, 12, 3, "100");
    image_finish(&img);

    d.material.base_color_tex.uv = 0;
    const float turned[6] = { 0, 1, 0, 1, 0, 0 }; // u' = v, v' = u
    memcpy(d.material.base_color_tex.transform, turned, sizeof turned);
    img = albedo_of(&d);
    expect_color(&img, 12, 3, "001");
    expect_color(&img, 3, 12, "010");
    image_finish(&img);
}

static void base_color_is_decoded_from_srgb(void **state)
{
    (void) state;
    static const uint8_t grey[4] = { 188, 188, 188, 255 };
    ag_texture t = { .name = "grey", .width = 1, .height = 1, .rgba = grey, .srgb = true };
    square_desc d = textured(&t);
    image img = albedo_of(&d);
    // (188 / 255 + 0.055) / 1.055 to the 2.4th. OpenGL lets a decoder be off by 0.5 / 255; half
    // floats keep 11 bits.
    if (fabsf(pixel(&img, 5, 5)[0] - 0.5028865f) > 0.0025f)
        fail_msg("0.5029 comes out as %g", (double) pixel(&img, 5, 5)[0]);
    image_finish(&img);
    t.srgb = false;
    img = albedo_of(&d);
    assert_true(fabsf(pixel(&img, 5, 5)[0] - 188 / 255.0f) < 5e-4f);
    image_finish(&img);
}

static void far_texture_is_its_mean(void **state)
{
    (void) state;
    enum { N = 256 };
    static uint8_t checks[N * N * 4];
    for (int i = 0; i < N * N; i++)
        memset(checks + 4 * (size_t) i, (i + i / N) % 2 ? 255 : 0, 3);
    for (int i = 0; i < N * N; i++)
        checks[4 * i + 3] = 255;
    const ag_texture t = {
        .name = "checks", .width = N, .height = N, .rgba = checks, .srgb = true
    };
    const square_desc d = textured(&t);
    image img = albedo_of(&d); // 16 texels a pixel
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        assert_true(fabsf(img.rgb[i] - 0.5f) < 0.01f); // mips are averaged in linear light, 8 bits
    image_finish(&img);
}

static void masked_texels_are_not_there(void **state)
{
    (void) state;
    static const uint8_t half[8] = { 255, 255, 255, 127, 255, 255, 255, 129 };
    const ag_texture t = { .name = "half", .width = 2, .height = 1, .rgba = half, .nearest = true };
    square_desc d = textured(&t);
    d.material.alpha = AG_ALPHA_MASK;
    d.material.alpha_cutoff = 0.5f;
    image img = albedo_of(&d);
    expect_color(&img, 3, 5, "000");
    expect_color(&img, 12, 5, "111");
    image_finish(&img);
    d.material.alpha = AG_ALPHA_OPAQUE;
    img = albedo_of(&d);
    expect_color(&img, 3, 5, "111");
    image_finish(&img);
}

static void masked_texels_cast_no_shadow(void **state)
{
    (void) state;
    static const uint8_t half[8] = { 255, 255, 255, 0, 255, 255, 255, 255 };
    static const double floor[3][3] = { { -4, -1, 4 }, { 8, 0, 0 }, { 0, 0, -8 } };
    const ag_texture t = {
        .name = "half",
        .width = 2,
        .height = 1,
        .rgba = half,
        .nearest = true,
        .wrap_u = AG_WRAP_CLAMP,
    };
    ag_builder *b = ag_builder_create(test_log(), "screen");
    ag_material screen = ag_default_material();
    screen.base_color_tex.texture = ag_builder_texture(b, &t);
    screen.alpha = AG_ALPHA_MASK;
    screen.alpha_cutoff = 0.5f;
    ag_vertex v[4];
    memset(v, 0, sizeof v);
    for (int i = 0; i < 4; i++) { // x and z in [-1, 1] at y = 0, u along x
        v[i].position[0] = i == 1 || i == 2 ? 1 : -1;
        v[i].position[2] = i < 2 ? 1 : -1;
        v[i].uv[0][0] = i == 1 || i == 2 ? 1 : 0;
        for (int c = 0; c < 4; c++)
            v[i].color[c] = 1;
    }
    static const uint32_t indices[] = { 0, 1, 2, 0, 2, 3 };
    const ag_primitive_desc primitive = {
        .name = "screen",
        .vertices = v,
        .vertex_count = 4,
        .indices = indices,
        .index_count = 6,
        .material = ag_builder_material(b, &screen),
    };
    const ag_node_desc node = { .name = "screen", .parent = -1 };
    ag_builder_show(b, ag_builder_node(b, &node), ag_builder_primitive(b, &primitive), -1);
    add_quad(b, -1, floor[0], floor[1], floor[2]);
    ag_light light = ceiling_spot(58);
    light.position[0] = light.position[2] = 0;
    light.position[1] = 3;
    ag_builder_light(b, -1, &light);
    ag_camera camera = { .name = "below", .yfov = 1, .znear = 0.01f };
    // Under the screen, looking down: x right, -z up.
    camera.world[0] = camera.world[9] = camera.world[15] = 1;
    camera.world[6] = -1;
    camera.world[13] = -0.2;
    ag_builder_camera(b, -1, &camera);
    ag_scene *scene = finish_scene(b);
    image img = render_layer(scene, SIZE, SIZE, LAYER_DIRECT, NULL, NULL);
    assert_true(pixel(&img, 3, 8)[0] > 0.01f); // through the absent half
    assert_true(pixel(&img, 12, 8)[0] == 0);
    image_finish(&img);
    ag_scene_destroy(scene);
}

static void many_sizes_are_resampled_and_said_so(void **state)
{
    (void) state;
    enum { COUNT = AG_MAX_TEXTURE_BINS + 4 };
    static uint8_t pixels[COUNT * COUNT * 4];
    ag_texture textures[COUNT];
    for (int i = 0; i < COUNT * COUNT; i++) {
        static const uint8_t rgba[4] = { 255, 0, 255, 255 };
        memcpy(pixels + 4 * (size_t) i, rgba, 4);
    }
    for (int i = 0; i < COUNT; i++) {
        textures[i] =
            (ag_texture){ .name = "t", .width = i + 1, .height = 1, .rgba = pixels, .srgb = true };
    }
    square_desc d = textured(textures);
    d.texture_count = COUNT;
    d.material.base_color_tex.texture = COUNT - 1;
    image img = albedo_of(&d);
    expect_color(&img, 1, 1, "101");
    expect_color(&img, 14, 14, "101");
    assert_non_null(strstr(warnings_text(), "textures of many sizes are resampled to"));
    image_finish(&img);
}

// Cofactor and winding of mirrored, sheared and tiny nodes; the normal faces the viewer.
// A texture may take the metal away that the factor alone would leave: then the map has light to
// reflect.
static void metal_of_a_texture_counts_for_vpls(void **state)
{
    (void) state;
    for (int metal = 0; metal < 2; metal++) {
        const uint8_t texel[4] = { 0, 255, metal ? 255 : 0, 255 };
        const ag_texture texture = { .name = "metal", .width = 1, .height = 1, .rgba = texel };
        square_desc d = textured(&texture);
        d.material.base_color_tex.texture = -1;
        d.material.metallic_roughness_tex.texture = 0;
        d.material.metallic = 1;
        ag_scene *scene = square_scene(&d);
        const ag_light light = { .kind = AG_LIGHT_POINT,
                                 .position = { 0, 0, 1 },
                                 .intensity = { 1, 1, 1 } };
        assert_int_equal(ag_scene_add_light(scene, &light), FG_OK);
        const char *const settings[] = { "rsm_size=16", "pattern=all", NULL };
        capture c[] = { { .resource = "rsm.count" }, { 0 } };
        image img = render_captured(scene, SIZE, SIZE, LAYER_INDIRECT, settings, c);
        const uint32_t *count = c[0].bytes;
        assert_true(metal ? count[0] == 0 : count[0] > 16);
        image_finish(&img);
        captures_finish(c);
        ag_scene_destroy(scene);
    }
}

static void normals_survive_any_node(void **state)
{
    (void) state;
    static const double matrices[][16] = {
        { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 },
        { -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 },    // mirrored in x
        { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1 },    // and in z
        { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1e-12, 0, 0, 0, 0, 1 }, // flat
        { 1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1 },   // sheared along the normal
        { -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1 },   // turned about y: its back
    };
    for (int i = 0; i < FG_COUNT(matrices); i++) {
        square_desc d = { .material = ag_default_material(),
                          .repeat = 1,
                          .normal = { 0, 0, 1 },
                          .matrix = matrices[i] };
        ag_scene *scene = square_scene(&d);
        image img = render_layer(scene, SIZE, SIZE, LAYER_NORMAL, NULL, NULL);
        const float *n = pixel(&img, 8, 8);
        if (fabsf(n[0]) > 1e-3f || fabsf(n[1]) > 1e-3f || fabsf(n[2] - 1) > 1e-3f)
            fail_msg("matrix %d: normal %g %g %g", i, (double) n[0], (double) n[1], (double) n[2]);
        image_finish(&img);
        ag_scene_destroy(scene);
    }
}

// ---- materials that move ----------------------------------------------------------------

static ag_scene *moving_square(const square_desc *d)
{
    static const float times[] = { 0, 1, 2 }, slide[] = { 0, 0, 0.5f, 0, 0.5f, 0.5f };
    static const float glow[] = { 0, 0, 0, 0.25f, 0.5f, 1, 0, 0, 0 };
    const ag_channel_desc channels[] = {
        { .path = AG_PATH_UV_OFFSET, AG_INTERPOLATE_STEP, 3, times, slide },
        { .path = AG_PATH_EMISSIVE, AG_INTERPOLATE_STEP, 3, times, glow },
    };
    return driven_square(d, channels, FG_COUNT(channels));
}

// One renderer, so that what it keeps must follow: the atlas' four texels are the frames.
static void the_picture_follows_a_material_that_moves(void **state)
{
    (void) state;
    static const struct {
        double time;
        const char *albedo;
        float emission[3];
    } frames[] = { { 0, "100", { 0 } },
                   { 1, "010", { 0.25f, 0.5f, 1 } },
                   { 2, "100", { 0 } }, // the loop's end is its beginning
                   { 5.5, "010", { 0.25f, 0.5f, 1 } },
                   { 0, "100", { 0 } } };
    const ag_texture t = four_texels();
    square_desc d = textured(&t);
    const float corner[6] = { 0.5f, 0, 0, 0, 0.5f, 0 };
    memcpy(d.material.base_color_tex.transform, corner, sizeof corner);
    ag_scene *scene = moving_square(&d);
    const renderer_desc desc = {
        .log = test_log(),
        .device = device(),
        .scene = scene,
        .width = SIZE,
        .height = SIZE,
        .layers = 1u << LAYER_ALBEDO | 1u << LAYER_RADIANCE,
    };
    renderer *r;
    assert_int_equal(renderer_create(&desc, &r), FG_OK);
    for (int i = 0; i < FG_COUNT(frames); i++) {
        image albedo, radiance;
        assert_int_equal(renderer_frame(r, frames[i].time), FG_OK);
        assert_int_equal(renderer_read(r, LAYER_ALBEDO, &albedo), FG_OK);
        assert_int_equal(renderer_read(r, LAYER_RADIANCE, &radiance), FG_OK);
        for (int p = 0; p < SIZE * SIZE; p += 5)
            expect_color(&albedo, p % SIZE, p / SIZE, frames[i].albedo);
        // No light shines: all radiance is the surface's own, and a half float holds it exactly.
        assert_memory_equal(pixel(&radiance, 3, 4), frames[i].emission, sizeof frames[i].emission);
        image_finish(&albedo);
        image_finish(&radiance);
    }
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void expect_host_albedo(const ag_scene *scene, const square_desc *d, const image *img, int x,
                               int y)
{
    const float u = ((float) x + 0.5f) / SIZE * d->repeat + d->offset;
    const float v = ((float) y + 0.5f) / SIZE * d->repeat + d->offset;
    const float uv[2][2] = { { u, v }, { 1 - u, v } }, white[4] = { 1, 1, 1, 1 };
    ag_surface s;
    ag_surface_eval(scene, &scene->materials[scene->primitives[0].material], uv, white, &s);
    // Filtering units weigh texels in steps of 1/256.
    for (int c = 0; c < 3; c++)
        if (fabsf(pixel(img, x, y)[c] - s.albedo[c]) > 0.006f)
            fail_msg("pixel %d, %d: %g, host %g", x, y, (double) pixel(img, x, y)[c],
                     (double) s.albedo[c]);
}

// The host's own evaluation of surfaces, which the reference uses, gives the same albedo.
static void albedo_agrees_with_the_host(void **state)
{
    (void) state;
    static uint8_t noise[8 * 4 * 4];
    for (int i = 0; i < (int) sizeof noise; i++)
        noise[i] = (uint8_t) (i * 37 + i / 7 * 101);
    ag_texture textures[2] = {
        { .name = "color", .width = 8, .height = 4, .rgba = noise, .srgb = true },
        { .name = "metal", .width = 8, .height = 4, .rgba = noise + 4, .wrap_u = AG_WRAP_MIRROR },
    };
    textures[1].height = 3;
    square_desc d = textured(textures);
    d.texture_count = 2;
    d.material.metallic = 0.7f;
    d.material.metallic_roughness_tex.texture = 1;
    d.repeat = 1.3f;
    d.offset = -0.2f;
    ag_scene *scene = square_scene(&d);
    image img = render_layer(scene, SIZE, SIZE, LAYER_ALBEDO, NULL, NULL);
    for (int i = 0; i < SIZE * SIZE; i++)
        expect_host_albedo(scene, &d, &img, i % SIZE, i / SIZE);
    image_finish(&img);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_texel_is_the_top_left_one),
        cmocka_unit_test(each_wrap_mode_does_what_it_says),
        cmocka_unit_test(uv_set_and_transform_are_applied),
        cmocka_unit_test(base_color_is_decoded_from_srgb),
        cmocka_unit_test(far_texture_is_its_mean),
        cmocka_unit_test(masked_texels_are_not_there),
        cmocka_unit_test(masked_texels_cast_no_shadow),
        cmocka_unit_test(many_sizes_are_resampled_and_said_so),
        cmocka_unit_test(metal_of_a_texture_counts_for_vpls),
        cmocka_unit_test(normals_survive_any_node),
        cmocka_unit_test(the_picture_follows_a_material_that_moves),
        cmocka_unit_test(albedo_agrees_with_the_host),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
