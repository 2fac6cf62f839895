// SPDX-License-Identifier: MIT
// A host that has set all of OpenGL's state: frames are the same, and what the library changes is
// what fg/gl.h says.
#include "fixture.h"

#include "gl_state.h"

#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

// ---- what fg/gl.h says ------------------------------------------------------------------

// After a frame these are as a new context has them.
static const char *const reset[] = {
    "GL_BLEND",
    "GL_CULL_FACE",
    "GL_SCISSOR_TEST",
    "GL_STENCIL_TEST",
    "GL_DEPTH_TEST",
    "GL_DEPTH_CLAMP",
    "GL_DITHER",
    "GL_FRAMEBUFFER_SRGB",
    "GL_COLOR_LOGIC_OP",
    "GL_LINE_SMOOTH",
    "GL_POLYGON_SMOOTH",
    "GL_MULTISAMPLE",
    "GL_POLYGON_OFFSET_FILL",
    "GL_POLYGON_OFFSET_LINE",
    "GL_POLYGON_OFFSET_POINT",
    "GL_PRIMITIVE_RESTART",
    "GL_PRIMITIVE_RESTART_FIXED_INDEX",
    "GL_PROGRAM_POINT_SIZE",
    "GL_RASTERIZER_DISCARD",
    "GL_SAMPLE_ALPHA_TO_COVERAGE",
    "GL_SAMPLE_ALPHA_TO_ONE",
    "GL_SAMPLE_COVERAGE",
    "GL_SAMPLE_MASK",
    "GL_SAMPLE_SHADING",
    "GL_CLIP_DISTANCE0",
    "GL_CLIP_DISTANCE1",
    "GL_CLIP_DISTANCE7",
    "GL_BLEND_SRC_RGB",
    "GL_BLEND_DST_RGB",
    "GL_BLEND_SRC_ALPHA",
    "GL_BLEND_DST_ALPHA",
    "GL_BLEND_EQUATION_RGB",
    "GL_BLEND_EQUATION_ALPHA",
    "GL_COLOR_WRITEMASK",
    "GL_FRONT_FACE",
    "GL_POLYGON_MODE",
    "GL_PROVOKING_VERTEX",
    "GL_DEPTH_FUNC",
    "GL_DEPTH_WRITEMASK",
    "GL_DEPTH_RANGE",
    "GL_CLIP_ORIGIN",
    "GL_CLIP_DEPTH_MODE",
    "GL_STENCIL_FUNC",
    "GL_STENCIL_REF",
    "GL_STENCIL_VALUE_MASK",
    "GL_STENCIL_FAIL",
    "GL_STENCIL_PASS_DEPTH_FAIL",
    "GL_STENCIL_PASS_DEPTH_PASS",
    "GL_STENCIL_WRITEMASK",
    "GL_STENCIL_BACK_FUNC",
    "GL_STENCIL_BACK_REF",
    "GL_STENCIL_BACK_VALUE_MASK",
    "GL_STENCIL_BACK_FAIL",
    "GL_STENCIL_BACK_PASS_DEPTH_FAIL",
    "GL_STENCIL_BACK_PASS_DEPTH_PASS",
    "GL_STENCIL_BACK_WRITEMASK",
    "GL_POINT_SIZE",
    "GL_UNPACK_ALIGNMENT",
    "GL_UNPACK_ROW_LENGTH",
    "GL_UNPACK_SKIP_ROWS",
    "GL_UNPACK_SKIP_PIXELS",
    "GL_UNPACK_SKIP_IMAGES",
    "GL_UNPACK_IMAGE_HEIGHT",
    "GL_UNPACK_SWAP_BYTES",
    "GL_UNPACK_LSB_FIRST",
    "GL_PIXEL_UNPACK_BUFFER_BINDING",
    "GL_CURRENT_PROGRAM",
    "GL_VERTEX_ARRAY_BINDING",
    "GL_DRAW_FRAMEBUFFER_BINDING",
    "GL_READ_FRAMEBUFFER_BINDING",
};

// These it leaves as passes had them.
static const char *const clobbered[] = {
    "GL_VIEWPORT",
    "GL_TEXTURE_BINDING_",
    "GL_SAMPLER_BINDING",
    "GL_IMAGE_BINDING_",
    "GL_SHADER_STORAGE_BUFFER_",
    "GL_UNIFORM_BUFFER_",
    "GL_DRAW_INDIRECT_BUFFER_BINDING",
    "GL_DISPATCH_INDIRECT_BUFFER_BINDING",
    "GL_QUERY_BUFFER_BINDING",
    "GL_TEXTURE_CUBE_MAP_SEAMLESS", // on
};

static size_t name_length(const char *name)
{
    return strcspn(name, "[");
}

static bool is_reset(const char *name)
{
    for (int i = 0; i < FG_COUNT(reset); ++i)
        if (strlen(reset[i]) == name_length(name) && !strncmp(name, reset[i], strlen(reset[i])))
            return true;
    return false;
}

static bool is_clobbered(const char *name)
{
    for (int i = 0; i < FG_COUNT(clobbered); ++i)
        if (!strncmp(name, clobbered[i], strlen(clobbered[i])))
            return true;
    return false;
}

// ---- frames -----------------------------------------------------------------------------

enum { SIZE = 32 };

// Every plugin, with the settings that use other state; small, as what is asked is not how well.
#define MAPS "rsm_size=32"
static const char *const rsm[] = { MAPS, "vpls=16", NULL };
static const char *const lists[] = { MAPS, NULL };
static const char *const stencil[] = { MAPS, "cull=stencil", NULL };
static const char *const few[] = { "max_lights=16", "map_size=32", NULL };
static const struct {
    const char *plugin;
    const char *const *settings;
} cases[] = {
    { "rsm", rsm },      { "isr", lists },   { "isr", stencil }, { "hisr", lists },
    { "hisr", stencil }, { "splat", lists }, { "iir", few },
};

// A textured room under a spot.
static ag_scene *make_scene(void)
{
    enum { EDGE = 5 }; // rows that alignment and skipping would shift
    static uint8_t texels[EDGE][EDGE][4];
    const ag_light light = ceiling_spot(60);
    ag_builder *b = room_builder(&(room_desc){ .boxes = true });
    for (int i = 0; i < EDGE * EDGE; ++i)
        memcpy(texels[i / EDGE][i % EDGE],
               (uint8_t[]){ (uint8_t) (9 * i), (uint8_t) (255 - 7 * i), 80, 255 }, 4);
    const ag_texture texture = {
        .name = "tiles", .width = EDGE, .height = EDGE, .rgba = texels[0][0]
    };
    ag_material tiled = ag_default_material();
    tiled.base_color_tex.texture = ag_builder_texture(b, &texture);
    const int material = ag_builder_material(b, &tiled);
    add_quad(b, material, (double[]){ -0.4, -0.45, -0.4 }, (double[]){ 0, 0, 0.8 },
             (double[]){ 0.8, 0, 0 });
    ag_builder_light(b, -1, &light);
    return finish_scene(b);
}

static renderer *make_renderer(ag_scene *scene)
{
    renderer *r = NULL;
    const renderer_desc desc = { .log = test_log(),
                                 .device = device(),
                                 .scene = scene,
                                 .width = SIZE,
                                 .height = SIZE,
                                 .layers = 1u << LAYER_FINAL | 1u << LAYER_INDIRECT };
    assert_int_equal(renderer_create(&desc, &r), FG_OK);
    return r;
}

static void set_plugin(renderer *r, int which)
{
    const gi_plugin *p = plugin_named(cases[which].plugin);
    gi_value *values = calloc((size_t) gi_params_count(p) + 1, sizeof *values);
    gi_params_default(p, values);
    for (int i = 0; cases[which].settings[i]; ++i)
        assert_int_equal(gi_params_set(test_log(), p, values, cases[which].settings[i]), FG_OK);
    assert_int_equal(renderer_set_plugin(r, p, values), FG_OK);
    free(values);
}

static void two_frames(renderer *r)
{
    for (int i = 0; i < 2; ++i)
        assert_int_equal(renderer_frame(r, 0), FG_OK);
    assert_null(renderer_fault(r));
}

// Fails where the call has changed what it should not, or left what it should reset.
static void check(const gl_state *fresh, const gl_state *before, bool frame, const char *call)
{
    static gl_state after;
    int wrong = 0;
    gl_state_take(&after);
    for (int i = 0; i < after.count; ++i) {
        const gl_state_item *now = &after.items[i];
        const bool must_reset = frame && is_reset(now->name);
        const gl_state_item *expected = must_reset ? &fresh->items[i] : &before->items[i];
        if (gl_state_same(now, expected) || (frame && !must_reset && is_clobbered(now->name)))
            continue;
        print_message("%s: %s is %g, should be %g\n", call, now->name, now->value[0],
                      expected->value[0]);
        ++wrong;
    }
    assert_int_equal(wrong, 0);
}

// The viewport and what is bound are not reset: what is not in either list is left alone.
static void a_frame(int which, gl_state *fresh, gl_state *before)
{
    static const renderer_layer layers[] = { LAYER_FINAL, LAYER_INDIRECT };
    ag_scene *scene = make_scene();
    image plain[2] = { 0 }, scrambled[2] = { 0 };
    renderer *r = make_renderer(scene);
    set_plugin(r, which);
    two_frames(r);
    for (int i = 0; i < 2; ++i)
        assert_int_equal(renderer_read(r, layers[i], &plain[i]), FG_OK);
    assert_true(image_mean(&plain[1]) > 0);
    renderer_destroy(r);

    gl_state_take(fresh);
    gl_state_scramble();
    gl_state_take(before);
    r = make_renderer(scene);
    check(fresh, before, false, "create");
    set_plugin(r, which);
    check(fresh, before, false, "gi create");
    two_frames(r);
    check(fresh, before, true, "frame");
    gl_state_clean();
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(renderer_read(r, layers[i], &scrambled[i]), FG_OK);
        assert_true(same_bits(plain[i].rgb, scrambled[i].rgb, sizeof(float) * 3 * SIZE * SIZE));
        image_finish(&plain[i]);
        image_finish(&scrambled[i]);
    }
    gl_state_scramble();
    gl_state_take(before);
    renderer_destroy(r);
    check(fresh, before, false, "destroy");
    gl_state_clean();
    ag_scene_destroy(scene);
}

static void frames_are_the_same_and_change_what_is_said(void **state)
{
    static gl_state fresh, before;
    (void) state;
    for (int i = 0; i < FG_COUNT(cases); ++i) {
        print_message("%s, %s\n", cases[i].plugin,
                      cases[i].settings[1] ? cases[i].settings[1] : "");
        a_frame(i, &fresh, &before);
    }
}

static void every_name_that_is_said_is_asked_for(void **state)
{
    static gl_state now;
    (void) state;
    gl_state_take(&now);
    for (int i = 0; i < FG_COUNT(reset); ++i)
        gl_state_find(&now, reset[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_name_that_is_said_is_asked_for),
        cmocka_unit_test(frames_are_the_same_and_change_what_is_said),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
