// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <stdio.h>

// ---- helpers --------------------------------------------------------------------

typedef struct shape {
    const char *name;
    fg_tex_desc desc;
} shape;

static const shape shapes[] = {
    { "2d", { .width = 8, .height = 8, .mips = 2, .samples = 1 } },
    { "array", { .width = 8, .height = 8, .layers = 3, .mips = 2, .samples = 1 } },
    { "3d", { .width = 8, .height = 8, .depth = 4, .mips = 2, .samples = 1 } },
    { "cube", { .width = 8, .height = 8, .layers = 6, .cube = true, .mips = 2, .samples = 1 } },
    { "cubes", { .width = 8, .height = 8, .layers = 12, .cube = true, .mips = 2, .samples = 1 } },
    { "samples", { .width = 8, .height = 8, .mips = 1, .samples = 4 } },
    { "sample array", { .width = 8, .height = 8, .layers = 2, .mips = 1, .samples = 4 } },
};

static uint32_t create(fixture *f, const char *label, const fg_tex_desc *desc)
{
    uint32_t object = 0;
    assert_int_equal(f->device->ops->texture_create(f->device, label, desc, &object), FG_OK);
    assert_int_not_equal(object, 0);
    return object;
}

static void clear_all(fixture *f, uint32_t object, const fg_tex_desc *desc, const float value[4])
{
    fg_clear c = { .object = object, .tex = desc, .mips = desc->mips, .poison = !value };
    c.layers = desc->layers ? desc->layers : 1;
    if (value)
        memcpy(c.value, value, sizeof c.value);
    f->device->ops->clear(f->device, &c);
}

static fg_status attach(fixture *f, uint32_t object, const fg_tex_desc *desc)
{
    const fg_attachment a = {
        .object = object,
        .layers = desc->layers ? desc->layers : 1,
        .layered = desc->layers > 1,
    };
    fg_pass_begin begin = {
        .name = "attach",
        .timer = -1,
        .width = desc->width,
        .height = desc->height,
        .framebuffer_key = object,
    };
    if (fg_format_get(desc->format)->depth) {
        begin.depth = a;
    } else {
        begin.color[0] = a;
        begin.color_count = 1;
    }
    const fg_status status = f->device->ops->pass_begin(f->device, &begin);
    if (!status)
        f->device->ops->pass_end(f->device, &begin);
    return status;
}

// ---- creation -------------------------------------------------------------------

static void make_shape(fixture *f, const shape *of, fg_format format)
{
    const fg_format_info *info = fg_format_get(format);
    fg_tex_desc desc = of->desc;
    desc.format = format;
    if (info->depth && desc.depth > 0)
        return; // OpenGL has no 3D depth textures
    const uint32_t object = create(f, of->name, &desc);
    clear_all(f, object, &desc, NULL);
    clear_all(f, object, &desc, (const float[4]){ 1, 0, 0, 1 });
    if (info->color || info->depth)
        assert_int_equal(attach(f, object, &desc), FG_OK);
    f->device->ops->texture_destroy(f->device, object);
    if (fg_gl_error_count(f->device))
        fail_msg("%s %s: %s", info->name, of->name, f->said);
}

static void every_format_makes_every_shape(void **state)
{
    for (int format = 0; format < FG_FORMAT_COUNT; ++format)
        for (int i = 0; i < FG_COUNT(shapes); ++i)
            make_shape(*state, &shapes[i], (fg_format) format);
}

static void textures_and_buffers_carry_their_labels(void **state)
{
    fixture *f = *state;
    char label[64] = "";
    uint32_t buffer;
    const uint32_t texture = create(f, "gbuffer.normal", &shapes[0].desc);
    glGetObjectLabel(GL_TEXTURE, texture, sizeof label, NULL, label);
    assert_string_equal(label, "gbuffer.normal");
    assert_int_equal(f->device->ops->buffer_create(f->device, "vpls", 64, &buffer), FG_OK);
    glGetObjectLabel(GL_BUFFER, buffer, sizeof label, NULL, label);
    assert_string_equal(label, "vpls");
    f->device->ops->texture_destroy(f->device, texture);
    f->device->ops->buffer_destroy(f->device, buffer);
}

static void long_names_are_cut(void **state)
{
    fixture *f = *state;
    char name[5000];
    uint32_t buffer;
    memset(name, 'n', sizeof name);
    name[sizeof name - 1] = '\0';
    const uint32_t texture = create(f, name, &shapes[0].desc);
    assert_int_equal(f->device->ops->buffer_create(f->device, name, 64, &buffer), FG_OK);
    const fg_pass_begin begin = { .name = name, .timer = -1, .kind = FG_KIND_COMPUTE };
    assert_int_equal(f->device->ops->pass_begin(f->device, &begin), FG_OK);
    f->device->ops->pass_end(f->device, &begin);
    f->device->ops->texture_destroy(f->device, texture);
    f->device->ops->buffer_destroy(f->device, buffer);
}

static void refuses(fixture *f, const fg_tex_desc *desc, fg_status expected, const char *said)
{
    uint32_t object = 77;
    assert_int_equal(f->device->ops->texture_create(f->device, "huge", desc, &object), expected);
    assert_int_equal(object, 0);
    log_takes(f, said);
}

static void sizes_beyond_the_limits_are_refused(void **state)
{
    fixture *f = *state;
    const fg_device_limits *l = f->device->ops->limits(f->device);
    char said[128];
    fg_tex_desc desc = { .width = l->max_texture_size + 1, .height = 1, .mips = 1, .samples = 1 };
    snprintf(said, sizeof said, "huge: width is %d, this device allows at most %d", desc.width,
             l->max_texture_size);
    refuses(f, &desc, FG_ERR_UNSUPPORTED, said);
    desc = (fg_tex_desc){ .width = 1, .height = 1, .mips = 1, .samples = 1 };
    desc.layers = l->max_layers + 1;
    refuses(f, &desc, FG_ERR_UNSUPPORTED, "huge: layers is");
    desc = (fg_tex_desc){ .width = 1, .height = 1, .mips = 1, .samples = 1 };
    desc.depth = l->max_3d_size + 1;
    refuses(f, &desc, FG_ERR_UNSUPPORTED, "huge: depth is");
    desc = (fg_tex_desc){ .width = 1, .height = 1, .mips = 1, .samples = 1024 };
    refuses(f, &desc, FG_ERR_UNSUPPORTED, "huge: samples is 1024");
}

static void texture_larger_than_memory_is_refused(void **state)
{
    fixture *f = *state;
    const fg_device_limits *l = f->device->ops->limits(f->device);
    const fg_tex_desc desc = {
        .format = FG_RGBA32F,
        .width = l->max_texture_size,
        .height = l->max_texture_size,
        .layers = l->max_layers,
        .mips = 1,
        .samples = 1,
    };
    refuses(f, &desc, FG_ERR_MEMORY, "huge: ");
}

static void buffer_larger_than_memory_is_refused(void **state)
{
    fixture *f = *state;
    uint32_t object = 77;
    const uint64_t size = UINT64_C(1) << 60;
    assert_int_equal(f->device->ops->buffer_create(f->device, "huge", size, &object),
                     FG_ERR_MEMORY);
    assert_int_equal(object, 0);
    log_takes(f, "huge: a buffer of 1099511627776.0 MiB, the device has");
}

static void GLAPIENTRY storage_without_memory(GLuint buffer, GLsizeiptr size, const void *data,
                                              GLbitfield flags)
{
    (void) size, (void) data, (void) flags;
    glDeleteBuffers(1, &buffer);
}

static GLenum GLAPIENTRY no_memory_once(void)
{
    static int calls;
    return calls++ == 1 ? GL_OUT_OF_MEMORY : GL_NO_ERROR;
}

static void driver_without_memory_is_a_status_and_no_error(void **state)
{
    // What a driver has no memory for differs; all say it through glGetError, so that is played.
    fixture *f = *state;
    uint32_t object = 77;
    const PFNGLNAMEDBUFFERSTORAGEPROC storage = epoxy_glNamedBufferStorage;
    const PFNGLGETERRORPROC error = epoxy_glGetError;
    epoxy_glNamedBufferStorage = storage_without_memory;
    epoxy_glGetError = no_memory_once; // the first call reads what was there before
    const fg_status status = f->device->ops->buffer_create(f->device, "large", 64, &object);
    epoxy_glNamedBufferStorage = storage;
    epoxy_glGetError = error;
    assert_int_equal(status, FG_ERR_MEMORY);
    assert_int_equal(object, 0);
    log_takes(f, "large: the driver has no memory for a buffer of 64 bytes");
}

// ---- clears ---------------------------------------------------------------------

static void expect_texel(const fg_format_info *info, const float *got, const float *expected,
                         float tolerance)
{
    for (int i = 0; i < info->channels; ++i)
        if (!(fabsf(got[i] - expected[i]) <= tolerance))
            fail_msg("%s: channel %d is %g, not %g", info->name, i, (double) got[i],
                     (double) expected[i]);
}

// Half a step of the coarsest channel: what rounding to the nearest may lose.
static float tolerance_of(fg_format format)
{
    switch (format) {
    case FG_RGBA8:
    case FG_RG8:
    case FG_R8: return 0.5f / 255.0f;
    case FG_SRGB8_ALPHA8: return 1.0f / 255.0f; // a step more: the power function is inexact
    case FG_RGB10_A2: return 0.5f / 1023.0f;
    case FG_RG16: return 0.5f / 65535.0f;
    case FG_RG16_SNORM: return 0.5f / 32767.0f;
    default: return 0.0f;
    }
}

static void colour_clears_to_its_value_in_every_mip(void **state)
{
    fixture *f = *state;
    const float value[4] = { 0.5f, 0.25f, 1.0f, 1.0f }; // exact in every float format
    for (int format = 0; format < FG_FORMAT_COUNT; ++format) {
        const fg_format_info *info = fg_format_get((fg_format) format);
        if (info->depth || info->is_integer)
            continue;
        fg_tex_desc desc = shapes[0].desc;
        desc.format = (fg_format) format;
        const uint32_t object = create(f, info->name, &desc);
        float expected[4] = { value[0], value[1], value[2], value[3] };
        if (desc.format == FG_SRGB8_ALPHA8)
            for (int i = 0; i < 2; ++i) // IEC 61966-2-1: what reads back is encoded
                expected[i] = 1.055f * powf(value[i], 1.0f / 2.4f) - 0.055f;
        clear_all(f, object, &desc, value);
        for (int mip = 0; mip < 2; ++mip) {
            float got[64 * 4];
            const int texels = mip ? 16 : 64;
            glGetTextureImage(object, mip, GL_RGBA, GL_FLOAT, sizeof got, got);
            for (int i = 0; i < texels; ++i)
                expect_texel(info, got + 4 * (size_t) i, expected,
                             tolerance_of(desc.format) + 1e-6f);
        }
        f->device->ops->texture_destroy(f->device, object);
    }
}

static void integer_clears_to_whole_numbers(void **state)
{
    fixture *f = *state;
    const fg_format formats[] = { FG_RGBA32UI, FG_RG32UI, FG_R32UI, FG_R16UI, FG_R8UI };
    for (int k = 0; k < FG_COUNT(formats); ++k) {
        uint32_t got[64 * 4];
        fg_tex_desc desc = shapes[0].desc;
        desc.format = formats[k];
        const uint32_t object = create(f, "whole", &desc);
        clear_all(f, object, &desc, (const float[4]){ 3, 200, 7, 9 });
        glGetTextureImage(object, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, sizeof got, got);
        const uint32_t expected[4] = { 3, 200, 7, 9 };
        for (int i = 0; i < 64 * 4; ++i)
            if (i % 4 < fg_format_get(formats[k])->channels)
                assert_int_equal(got[i], expected[i % 4]);
        f->device->ops->texture_destroy(f->device, object);
    }
}

static void read_depth(uint32_t object, float *to, int count)
{
    glGetTextureImage(object, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                      (GLsizei) ((size_t) count * sizeof *to), to);
}

static void depth_clears_and_poisons(void **state)
{
    fixture *f = *state;
    for (int format = FG_DEPTH32F; format <= FG_DEPTH32F_STENCIL8; ++format) {
        float got[64];
        fg_tex_desc desc = shapes[0].desc;
        desc.format = (fg_format) format;
        const uint32_t object = create(f, "depth", &desc);
        clear_all(f, object, &desc, (const float[4]){ 0.25f });
        read_depth(object, got, 64);
        for (int i = 0; i < 64; ++i) // a step of 16 bits: OpenGL leaves the rounding open
            assert_true(fabsf(got[i] - 0.25f) <= 1.0f / 65535.0f);
        clear_all(f, object, &desc, NULL);
        read_depth(object, got, 64);
        for (int i = 0; i < 64; ++i) // fixed formats have the bytes 0xcd in 16 or 24 bits
            assert_true(fabsf(got[i] - 0xcdcd / 65535.0f) <= 1e-5f);
        f->device->ops->texture_destroy(f->device, object);
    }
}

static void poison_is_nan_in_float_formats(void **state)
{
    fixture *f = *state;
    for (int format = 0; format < FG_FORMAT_COUNT; ++format) {
        const fg_format_info *info = fg_format_get((fg_format) format);
        float got[64 * 4];
        if (info->depth || !info->is_float)
            continue;
        fg_tex_desc desc = shapes[0].desc;
        desc.format = (fg_format) format;
        const uint32_t object = create(f, info->name, &desc);
        clear_all(f, object, &desc, NULL);
        glGetTextureImage(object, 0, GL_RGBA, GL_FLOAT, sizeof got, got);
        for (int i = 0; i < 64 * 4; ++i)
            if (i % 4 < info->channels && !isnan(got[i]))
                fail_msg("%s: channel %d is %g", info->name, i % 4, (double) got[i]);
        f->device->ops->texture_destroy(f->device, object);
    }
}

static void poison_is_cd_bytes_in_other_formats(void **state)
{
    fixture *f = *state;
    const fg_format formats[] = { FG_RGBA8, FG_SRGB8_ALPHA8, FG_RGB10_A2,  FG_RG16,
                                  FG_RG8,   FG_R8,           FG_RG16_SNORM };
    const GLenum pixels[] = { GL_RGBA, GL_RGBA, GL_RGBA, GL_RG, GL_RG, GL_RED, GL_RG };
    const GLenum types[] = { GL_UNSIGNED_BYTE,  GL_UNSIGNED_BYTE, GL_UNSIGNED_INT_2_10_10_10_REV,
                             GL_UNSIGNED_SHORT, GL_UNSIGNED_BYTE, GL_UNSIGNED_BYTE,
                             GL_SHORT };
    for (int k = 0; k < FG_COUNT(formats); ++k) {
        uint8_t got[64 * 4] = { 0 };
        fg_tex_desc desc = shapes[0].desc;
        desc.format = formats[k];
        const uint32_t object = create(f, "bytes", &desc);
        clear_all(f, object, &desc, NULL);
        glGetTextureImage(object, 0, pixels[k], types[k], sizeof got, got);
        for (int i = 0; i < 64 * fg_format_get(formats[k])->bytes; ++i)
            if (got[i] != 0xcd)
                fail_msg("%s: byte %d is %#x", fg_format_get(formats[k])->name, i, got[i]);
        f->device->ops->texture_destroy(f->device, object);
    }
}

static void clear_stays_in_its_mips_and_layers(void **state)
{
    fixture *f = *state;
    float got[3 * 64];
    fg_tex_desc desc = shapes[1].desc;
    desc.format = FG_R32F;
    const uint32_t object = create(f, "part", &desc);
    clear_all(f, object, &desc, (const float[4]){ 1 });
    const fg_clear part = {
        .object = object,
        .tex = &desc,
        .mip = 1,
        .mips = 1,
        .layer = 1,
        .layers = 2,
        .value = { 5 },
    };
    f->device->ops->clear(f->device, &part);
    glGetTextureImage(object, 0, GL_RED, GL_FLOAT, sizeof got, got);
    for (int i = 0; i < 3 * 64; ++i)
        assert_true(got[i] == 1.0f);
    glGetTextureImage(object, 1, GL_RED, GL_FLOAT, sizeof got, got);
    for (int i = 0; i < 3 * 16; ++i)
        assert_true(got[i] == (i < 16 ? 1.0f : 5.0f));
    f->device->ops->texture_destroy(f->device, object);
}

static void one_face_of_a_cube_is_cleared(void **state)
{
    fixture *f = *state;
    float got[6 * 64];
    fg_tex_desc desc = shapes[3].desc;
    desc.format = FG_R32F;
    const uint32_t object = create(f, "face", &desc);
    clear_all(f, object, &desc, (const float[4]){ 1 });
    const fg_clear face = {
        .object = object,
        .tex = &desc,
        .mips = 1,
        .layer = 4,
        .layers = 1,
        .value = { 9 },
    };
    f->device->ops->clear(f->device, &face);
    glGetTextureImage(object, 0, GL_RED, GL_FLOAT, sizeof got, got);
    for (int i = 0; i < 6 * 64; ++i)
        assert_true(got[i] == (i / 64 == 4 ? 9.0f : 1.0f));
    f->device->ops->texture_destroy(f->device, object);
}

static void buffers_clear_to_the_last_byte(void **state)
{
    fixture *f = *state;
    const int size = 4 * 5 + 3;
    uint8_t got[23];
    uint32_t object;
    assert_int_equal(f->device->ops->buffer_create(f->device, "odd", (uint64_t) size, &object),
                     FG_OK);
    fg_clear c = { .object = object, .size = (uint64_t) size, .poison = true };
    f->device->ops->clear(f->device, &c);
    glGetNamedBufferSubData(object, 0, size, got);
    for (int i = 0; i < size; ++i)
        assert_int_equal(got[i], 0xcd);
    c.poison = false;
    f->device->ops->clear(f->device, &c);
    glGetNamedBufferSubData(object, 0, size, got);
    for (int i = 0; i < size; ++i)
        assert_int_equal(got[i], 0);
    f->device->ops->buffer_destroy(f->device, object);
}

// ---- views ----------------------------------------------------------------------

static void view_shows_the_same_bits(void **state)
{
    fixture *f = *state;
    for (int i = 0; i < FG_COUNT(shapes); ++i) {
        fg_tex_desc desc = shapes[i].desc;
        if (desc.samples > 1)
            continue; // cannot be read back
        const int texels = 64 * (desc.depth ? desc.depth : desc.layers ? desc.layers : 1);
        uint32_t got[64 * 12], view;
        desc.format = FG_R32F;
        const uint32_t object = create(f, "of", &desc);
        clear_all(f, object, &desc, (const float[4]){ 1 });
        desc.format = FG_R32UI;
        assert_int_equal(f->device->ops->view_create(f->device, "view", object, &desc, &view),
                         FG_OK);
        f->device->ops->texture_destroy(f->device, object); // the view keeps the memory
        glGetTextureImage(view, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof got, got);
        for (int k = 0; k < texels; ++k)
            assert_int_equal(got[k], 0x3f800000); // 1.0f
        f->device->ops->texture_destroy(f->device, view);
    }
}

static void view_of_another_class_is_refused(void **state)
{
    fixture *f = *state;
    uint32_t view = 77;
    fg_tex_desc desc = shapes[0].desc;
    desc.format = FG_R32F;
    const uint32_t object = create(f, "of", &desc);
    desc.format = FG_RGBA32F;
    assert_int_equal(f->device->ops->view_create(f->device, "view", object, &desc, &view),
                     FG_ERR_UNSUPPORTED);
    assert_int_equal(view, 0);
    log_takes(f, "view: the driver refused a view RGBA32F");
    f->provoked = 1;
    f->device->ops->texture_destroy(f->device, object);
}

// ---- framebuffers ---------------------------------------------------------------

static void framebuffer_goes_with_its_texture(void **state)
{
    // Names come again on some drivers: a framebuffer of the old texture must not be found.
    fixture *f = *state;
    float got[64];
    fg_tex_desc desc = shapes[0].desc;
    desc.format = FG_R32F;
    for (int round = 1; round < 4; ++round) {
        const uint32_t object = create(f, "again", &desc);
        assert_int_equal(attach(f, object, &desc), FG_OK);
        glClearBufferfv(GL_COLOR, 0, (const float[4]){ (float) round });
        read_floats(object, got, 64);
        assert_true(got[0] == (float) round && got[63] == (float) round);
        count_deleted_framebuffers();
        f->device->ops->texture_destroy(f->device, object);
        assert_int_equal(deleted_framebuffers(), 1);
    }
}

static void impossible_framebuffer_is_refused_by_name(void **state)
{
    fixture *f = *state;
    fg_tex_desc desc = shapes[0].desc;
    desc.format = FG_R32F;
    const uint32_t object = create(f, "colour", &desc);
    fg_pass_begin begin = { .name = "wrong.depth", .timer = -1, .framebuffer_key = 1 };
    begin.width = begin.height = 8;
    begin.depth = (fg_attachment){ .object = object, .layers = 1 };
    assert_int_equal(f->device->ops->pass_begin(f->device, &begin), FG_ERR_DEVICE);
    log_takes(f, "wrong.depth: its framebuffer is refused");
    f->device->ops->texture_destroy(f->device, object);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(f) cmocka_unit_test_setup_teardown(f, open_gl, close_gl)
        TEST(every_format_makes_every_shape),
        TEST(textures_and_buffers_carry_their_labels),
        TEST(long_names_are_cut),
        TEST(sizes_beyond_the_limits_are_refused),
        TEST(texture_larger_than_memory_is_refused),
        TEST(buffer_larger_than_memory_is_refused),
        TEST(driver_without_memory_is_a_status_and_no_error),
        TEST(colour_clears_to_its_value_in_every_mip),
        TEST(integer_clears_to_whole_numbers),
        TEST(depth_clears_and_poisons),
        TEST(poison_is_nan_in_float_formats),
        TEST(poison_is_cd_bytes_in_other_formats),
        TEST(clear_stays_in_its_mips_and_layers),
        TEST(one_face_of_a_cube_is_cleared),
        TEST(buffers_clear_to_the_last_byte),
        TEST(view_shows_the_same_bits),
        TEST(view_of_another_class_is_refused),
        TEST(framebuffer_goes_with_its_texture),
        TEST(impossible_framebuffer_is_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
