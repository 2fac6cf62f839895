// SPDX-License-Identifier: MIT
#include "gl_state.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <epoxy/gl.h>

enum { UNITS = 24, IMAGES = 8, BUFFERS = 8 };

typedef struct query {
    GLenum what;
    int values;
    const char *name;
} query;
#define ASK(what, values)                                                                          \
    {                                                                                              \
        what, values, #what                                                                        \
    }

static const query switches[] = {
    ASK(GL_BLEND, 0),
    ASK(GL_CULL_FACE, 0),
    ASK(GL_SCISSOR_TEST, 0),
    ASK(GL_STENCIL_TEST, 0),
    ASK(GL_DEPTH_TEST, 0),
    ASK(GL_DEPTH_CLAMP, 0),
    ASK(GL_DITHER, 0),
    ASK(GL_FRAMEBUFFER_SRGB, 0),
    ASK(GL_COLOR_LOGIC_OP, 0),
    ASK(GL_LINE_SMOOTH, 0),
    ASK(GL_POLYGON_SMOOTH, 0),
    ASK(GL_MULTISAMPLE, 0),
    ASK(GL_POLYGON_OFFSET_FILL, 0),
    ASK(GL_POLYGON_OFFSET_LINE, 0),
    ASK(GL_POLYGON_OFFSET_POINT, 0),
    ASK(GL_PRIMITIVE_RESTART, 0),
    ASK(GL_PRIMITIVE_RESTART_FIXED_INDEX, 0),
    ASK(GL_PROGRAM_POINT_SIZE, 0),
    ASK(GL_RASTERIZER_DISCARD, 0),
    ASK(GL_SAMPLE_ALPHA_TO_COVERAGE, 0),
    ASK(GL_SAMPLE_ALPHA_TO_ONE, 0),
    ASK(GL_SAMPLE_COVERAGE, 0),
    ASK(GL_SAMPLE_MASK, 0),
    ASK(GL_SAMPLE_SHADING, 0),
    ASK(GL_TEXTURE_CUBE_MAP_SEAMLESS, 0),
    ASK(GL_CLIP_DISTANCE0, 0),
    ASK(GL_CLIP_DISTANCE1, 0),
    ASK(GL_CLIP_DISTANCE7, 0),
};

static const query values[] = {
    ASK(GL_BLEND_SRC_RGB, 1),
    ASK(GL_BLEND_DST_RGB, 1),
    ASK(GL_BLEND_SRC_ALPHA, 1),
    ASK(GL_BLEND_DST_ALPHA, 1),
    ASK(GL_BLEND_EQUATION_RGB, 1),
    ASK(GL_BLEND_EQUATION_ALPHA, 1),
    ASK(GL_BLEND_COLOR, 4),
    ASK(GL_COLOR_WRITEMASK, 4),
    ASK(GL_COLOR_CLEAR_VALUE, 4),
    ASK(GL_DEPTH_CLEAR_VALUE, 1),
    ASK(GL_STENCIL_CLEAR_VALUE, 1),
    ASK(GL_CULL_FACE_MODE, 1),
    ASK(GL_FRONT_FACE, 1),
    ASK(GL_POLYGON_MODE, 1),
    ASK(GL_DEPTH_FUNC, 1),
    ASK(GL_DEPTH_WRITEMASK, 1),
    ASK(GL_DEPTH_RANGE, 2),
    ASK(GL_CLIP_ORIGIN, 1),
    ASK(GL_CLIP_DEPTH_MODE, 1),
    ASK(GL_VIEWPORT, 4),
    ASK(GL_SCISSOR_BOX, 4),
    ASK(GL_STENCIL_FUNC, 1),
    ASK(GL_STENCIL_REF, 1),
    ASK(GL_STENCIL_VALUE_MASK, 1),
    ASK(GL_STENCIL_FAIL, 1),
    ASK(GL_STENCIL_PASS_DEPTH_FAIL, 1),
    ASK(GL_STENCIL_PASS_DEPTH_PASS, 1),
    ASK(GL_STENCIL_WRITEMASK, 1),
    ASK(GL_STENCIL_BACK_FUNC, 1),
    ASK(GL_STENCIL_BACK_REF, 1),
    ASK(GL_STENCIL_BACK_VALUE_MASK, 1),
    ASK(GL_STENCIL_BACK_FAIL, 1),
    ASK(GL_STENCIL_BACK_PASS_DEPTH_FAIL, 1),
    ASK(GL_STENCIL_BACK_PASS_DEPTH_PASS, 1),
    ASK(GL_STENCIL_BACK_WRITEMASK, 1),
    ASK(GL_LOGIC_OP_MODE, 1),
    ASK(GL_LINE_WIDTH, 1),
    ASK(GL_POINT_SIZE, 1),
    ASK(GL_POINT_FADE_THRESHOLD_SIZE, 1),
    ASK(GL_POLYGON_OFFSET_FACTOR, 1),
    ASK(GL_POLYGON_OFFSET_UNITS, 1),
    ASK(GL_PRIMITIVE_RESTART_INDEX, 1),
    ASK(GL_PROVOKING_VERTEX, 1),
    ASK(GL_SAMPLE_COVERAGE_VALUE, 1),
    ASK(GL_SAMPLE_COVERAGE_INVERT, 1),
    ASK(GL_MIN_SAMPLE_SHADING_VALUE, 1),
    ASK(GL_PATCH_VERTICES, 1),
    ASK(GL_CLAMP_READ_COLOR, 1),
    ASK(GL_ACTIVE_TEXTURE, 1),
    ASK(GL_CURRENT_PROGRAM, 1),
    ASK(GL_PROGRAM_PIPELINE_BINDING, 1),
    ASK(GL_VERTEX_ARRAY_BINDING, 1),
    ASK(GL_DRAW_FRAMEBUFFER_BINDING, 1),
    ASK(GL_READ_FRAMEBUFFER_BINDING, 1),
    ASK(GL_RENDERBUFFER_BINDING, 1),
    ASK(GL_TRANSFORM_FEEDBACK_BINDING, 1),
    ASK(GL_ARRAY_BUFFER_BINDING, 1),
    ASK(GL_ATOMIC_COUNTER_BUFFER_BINDING, 1),
    ASK(GL_COPY_READ_BUFFER_BINDING, 1),
    ASK(GL_COPY_WRITE_BUFFER_BINDING, 1),
    ASK(GL_DISPATCH_INDIRECT_BUFFER_BINDING, 1),
    ASK(GL_DRAW_INDIRECT_BUFFER_BINDING, 1),
    ASK(GL_PIXEL_PACK_BUFFER_BINDING, 1),
    ASK(GL_PIXEL_UNPACK_BUFFER_BINDING, 1),
    ASK(GL_QUERY_BUFFER_BINDING, 1),
    ASK(GL_SHADER_STORAGE_BUFFER_BINDING, 1),
    ASK(GL_UNIFORM_BUFFER_BINDING, 1),
    ASK(GL_TEXTURE_BUFFER_BINDING, 1),
    ASK(GL_PACK_ALIGNMENT, 1),
    ASK(GL_PACK_ROW_LENGTH, 1),
    ASK(GL_PACK_SKIP_ROWS, 1),
    ASK(GL_PACK_SKIP_PIXELS, 1),
    ASK(GL_PACK_IMAGE_HEIGHT, 1),
    ASK(GL_PACK_SKIP_IMAGES, 1),
    ASK(GL_PACK_SWAP_BYTES, 1),
    ASK(GL_PACK_LSB_FIRST, 1),
    ASK(GL_UNPACK_ALIGNMENT, 1),
    ASK(GL_UNPACK_ROW_LENGTH, 1),
    ASK(GL_UNPACK_SKIP_ROWS, 1),
    ASK(GL_UNPACK_SKIP_PIXELS, 1),
    ASK(GL_UNPACK_IMAGE_HEIGHT, 1),
    ASK(GL_UNPACK_SKIP_IMAGES, 1),
    ASK(GL_UNPACK_SWAP_BYTES, 1),
    ASK(GL_UNPACK_LSB_FIRST, 1),
    ASK(GL_LINE_SMOOTH_HINT, 1),
    ASK(GL_POLYGON_SMOOTH_HINT, 1),
    ASK(GL_TEXTURE_COMPRESSION_HINT, 1),
    ASK(GL_FRAGMENT_SHADER_DERIVATIVE_HINT, 1),
};

static const query indexed[] = {
    ASK(GL_TEXTURE_BINDING_1D, UNITS),
    ASK(GL_TEXTURE_BINDING_2D, UNITS),
    ASK(GL_TEXTURE_BINDING_3D, UNITS),
    ASK(GL_TEXTURE_BINDING_1D_ARRAY, UNITS),
    ASK(GL_TEXTURE_BINDING_2D_ARRAY, UNITS),
    ASK(GL_TEXTURE_BINDING_CUBE_MAP, UNITS),
    ASK(GL_TEXTURE_BINDING_CUBE_MAP_ARRAY, UNITS),
    ASK(GL_TEXTURE_BINDING_RECTANGLE, UNITS),
    ASK(GL_TEXTURE_BINDING_BUFFER, UNITS),
    ASK(GL_TEXTURE_BINDING_2D_MULTISAMPLE, UNITS),
    ASK(GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY, UNITS),
    ASK(GL_SAMPLER_BINDING, UNITS),
    ASK(GL_IMAGE_BINDING_NAME, IMAGES),
    ASK(GL_IMAGE_BINDING_LEVEL, IMAGES),
    ASK(GL_IMAGE_BINDING_LAYERED, IMAGES),
    ASK(GL_IMAGE_BINDING_LAYER, IMAGES),
    ASK(GL_IMAGE_BINDING_ACCESS, IMAGES),
    ASK(GL_IMAGE_BINDING_FORMAT, IMAGES),
    ASK(GL_SHADER_STORAGE_BUFFER_BINDING, BUFFERS),
    ASK(GL_SHADER_STORAGE_BUFFER_START, BUFFERS),
    ASK(GL_SHADER_STORAGE_BUFFER_SIZE, BUFFERS),
    ASK(GL_UNIFORM_BUFFER_BINDING, BUFFERS),
    ASK(GL_UNIFORM_BUFFER_START, BUFFERS),
    ASK(GL_UNIFORM_BUFFER_SIZE, BUFFERS),
    ASK(GL_ATOMIC_COUNTER_BUFFER_BINDING, 1),
    ASK(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 4),
    ASK(GL_SAMPLE_MASK_VALUE, 1),
};

// ---- asking -----------------------------------------------------------------------------

static gl_state_item *add(gl_state *s, const char *name, int index)
{
    assert_true(s->count < GL_STATE_MAX);
    gl_state_item *item = &s->items[s->count++];
    *item = (gl_state_item){ .name = "" };
    if (index < 0)
        snprintf(item->name, sizeof item->name, "%s", name);
    else
        snprintf(item->name, sizeof item->name, "%s[%d]", name, index);
    return item;
}

void gl_state_take(gl_state *s)
{
    s->count = 0;
    for (size_t i = 0; i < sizeof switches / sizeof *switches; ++i)
        add(s, switches[i].name, -1)->value[0] = glIsEnabled(switches[i].what);
    for (int i = 0; i < 8; ++i)
        add(s, "GL_BLEND", i)->value[0] = glIsEnabledi(GL_BLEND, (GLuint) i);
    for (size_t i = 0; i < sizeof values / sizeof *values; ++i) {
        GLdouble value[16] = { 0 };
        glGetDoublev(values[i].what, value);
        memcpy(add(s, values[i].name, -1)->value, value, (size_t) values[i].values * sizeof *value);
    }
    for (size_t i = 0; i < sizeof indexed / sizeof *indexed; ++i)
        for (int k = 0; k < indexed[i].values; ++k) {
            GLint64 value = 0;
            glGetInteger64i_v(indexed[i].what, (GLuint) k, &value);
            add(s, indexed[i].name, k)->value[0] = (double) value;
        }
    for (int i = 0; i < 4; ++i) {
        glGetDoublei_v(GL_VIEWPORT, (GLuint) i, add(s, "GL_VIEWPORT", i)->value);
        glGetDoublei_v(GL_SCISSOR_BOX, (GLuint) i, add(s, "GL_SCISSOR_BOX", i)->value);
        glGetDoublei_v(GL_DEPTH_RANGE, (GLuint) i, add(s, "GL_DEPTH_RANGE", i)->value);
    }
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

const gl_state_item *gl_state_find(const gl_state *s, const char *name)
{
    for (int i = 0; i < s->count; ++i)
        if (!strcmp(s->items[i].name, name))
            return &s->items[i];
    fail_msg("nobody asked for %s", name);
    return NULL;
}

bool gl_state_same(const gl_state_item *a, const gl_state_item *b)
{
    bool same = true;
    for (int i = 0; i < 4; ++i)
        same = same && a->value[i] == b->value[i];
    return same;
}

// ---- setting ----------------------------------------------------------------------------

static struct {
    gl_state fresh; // of the switches
    GLuint textures[9], sampler, buffer, array, program, pipeline, framebuffer, renderbuffer,
        feedback;
    GLuint target;
} own;

static const GLenum targets[] = { GL_TEXTURE_2D,        GL_TEXTURE_3D,
                                  GL_TEXTURE_2D_ARRAY,  GL_TEXTURE_CUBE_MAP,
                                  GL_TEXTURE_1D,        GL_TEXTURE_1D_ARRAY,
                                  GL_TEXTURE_RECTANGLE, GL_TEXTURE_CUBE_MAP_ARRAY,
                                  GL_TEXTURE_BUFFER };

static void create_textures(void)
{
    for (size_t i = 0; i < sizeof targets / sizeof *targets; ++i)
        glCreateTextures(targets[i], 1, &own.textures[i]);
    glTextureStorage2D(own.textures[0], 1, GL_RGBA32F, 4, 4);
    glTextureStorage3D(own.textures[1], 1, GL_RGBA8, 4, 4, 4);
    glTextureStorage3D(own.textures[2], 1, GL_RGBA8, 4, 4, 4);
    glTextureStorage2D(own.textures[3], 1, GL_RGBA8, 4, 4);
    glTextureStorage1D(own.textures[4], 1, GL_RGBA8, 4);
    glTextureStorage2D(own.textures[5], 1, GL_RGBA8, 4, 4);
    glTextureStorage2D(own.textures[6], 1, GL_RGBA8, 4, 4);
    glTextureStorage3D(own.textures[7], 1, GL_RGBA8, 4, 4, 6);
    glTextureBuffer(own.textures[8], GL_RGBA8, own.buffer);
    glCreateTextures(GL_TEXTURE_2D, 1, &own.target);
    glTextureStorage2D(own.target, 1, GL_RGBA8, 4, 4);
}

static void create_objects(void)
{
    static const char *const text = "#version 450 core\nvoid main() { gl_Position = vec4(0); }\n";
    glCreateBuffers(1, &own.buffer);
    glNamedBufferStorage(own.buffer, 65536, NULL, GL_DYNAMIC_STORAGE_BIT);
    create_textures();
    glCreateSamplers(1, &own.sampler);
    glSamplerParameteri(own.sampler, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(own.sampler, GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
    glCreateVertexArrays(1, &own.array);
    glCreateProgramPipelines(1, &own.pipeline);
    glCreateFramebuffers(1, &own.framebuffer);
    glNamedFramebufferTexture(own.framebuffer, GL_COLOR_ATTACHMENT0, own.target, 0);
    glCreateRenderbuffers(1, &own.renderbuffer);
    glCreateTransformFeedbacks(1, &own.feedback);
    own.program = glCreateProgram();
    const GLuint shader = glCreateShader(GL_VERTEX_SHADER);
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glAttachShader(own.program, shader);
    glLinkProgram(own.program);
    glDeleteShader(shader);
}

static void bind_objects(void)
{
    static const GLenum buffers[] = {
        GL_ARRAY_BUFFER,      GL_ATOMIC_COUNTER_BUFFER,    GL_COPY_READ_BUFFER,
        GL_COPY_WRITE_BUFFER, GL_DISPATCH_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER,
        GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER,      GL_QUERY_BUFFER,
        GL_TEXTURE_BUFFER,    GL_SHADER_STORAGE_BUFFER,    GL_UNIFORM_BUFFER,
    };
    for (GLuint i = 0; i < UNITS; ++i) {
        for (size_t k = 0; k < sizeof targets / sizeof *targets; ++k)
            glBindTextureUnit(i, own.textures[k]);
        glBindSampler(i, own.sampler);
    }
    for (GLuint i = 0; i < IMAGES; ++i)
        glBindImageTexture(i, own.textures[0], 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA32F);
    for (GLuint i = 0; i < BUFFERS; ++i) {
        glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, own.buffer, 256, 512);
        glBindBufferRange(GL_UNIFORM_BUFFER, i, own.buffer, 256, 512);
    }
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i)
        glBindBuffer(buffers[i], own.buffer);
    glActiveTexture(GL_TEXTURE5);
    glBindProgramPipeline(own.pipeline);
    glUseProgram(own.program);
    glBindVertexArray(own.array);
    glBindFramebuffer(GL_FRAMEBUFFER, own.framebuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, own.renderbuffer);
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, own.feedback);
}

static void set_pixel_transfer(int alignment, int length, GLboolean swap)
{
    static const GLenum numbers[] = { GL_PACK_ROW_LENGTH,     GL_PACK_SKIP_ROWS,
                                      GL_PACK_SKIP_PIXELS,    GL_PACK_IMAGE_HEIGHT,
                                      GL_PACK_SKIP_IMAGES,    GL_UNPACK_ROW_LENGTH,
                                      GL_UNPACK_SKIP_ROWS,    GL_UNPACK_SKIP_PIXELS,
                                      GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_IMAGES };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i)
        glPixelStorei(numbers[i], length);
    glPixelStorei(GL_PACK_ALIGNMENT, alignment);
    glPixelStorei(GL_UNPACK_ALIGNMENT, alignment);
    glPixelStorei(GL_PACK_SWAP_BYTES, swap);
    glPixelStorei(GL_UNPACK_SWAP_BYTES, swap);
}

static void set_functions(void)
{
    glBlendFuncSeparate(GL_DST_COLOR, GL_SRC_COLOR, GL_ZERO, GL_DST_ALPHA);
    glBlendEquationSeparate(GL_FUNC_REVERSE_SUBTRACT, GL_MAX);
    glBlendColor(0.1f, 0.2f, 0.3f, 0.4f);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
    glClearColor(0.5f, 0.25f, 0.125f, 1);
    glClearDepth(0.25);
    glClearStencil(7);
    glCullFace(GL_FRONT_AND_BACK);
    glFrontFace(GL_CW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    glDepthFunc(GL_NEVER);
    glDepthMask(GL_FALSE);
    glDepthRange(0.75, 0.25);
    glClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glViewport(1, 2, 3, 4);
    glScissor(1, 1, 1, 1);
    glStencilFuncSeparate(GL_FRONT, GL_NEVER, 3, 0x0f);
    glStencilFuncSeparate(GL_BACK, GL_LESS, 5, 0xf0);
    glStencilOpSeparate(GL_FRONT, GL_INVERT, GL_ZERO, GL_INCR);
    glStencilOpSeparate(GL_BACK, GL_DECR, GL_INVERT, GL_ZERO);
    glStencilMask(0);
    glLogicOp(GL_NOR);
    glLineWidth(1);
    glPointSize(5);
    glPointParameterf(GL_POINT_FADE_THRESHOLD_SIZE, 3);
    glPolygonOffset(10, 100);
    glPrimitiveRestartIndex(2);
    glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
    glSampleCoverage(0.25f, GL_TRUE);
    glSampleMaski(0, 0);
    glMinSampleShading(0.5f);
    glPatchParameteri(GL_PATCH_VERTICES, 7);
    glClampColor(GL_CLAMP_READ_COLOR, GL_TRUE);
    glHint(GL_POLYGON_SMOOTH_HINT, GL_NICEST);
    glHint(GL_LINE_SMOOTH_HINT, GL_NICEST);
    glHint(GL_TEXTURE_COMPRESSION_HINT, GL_NICEST);
    glHint(GL_FRAGMENT_SHADER_DERIVATIVE_HINT, GL_NICEST);
}

void gl_state_scramble(void)
{
    gl_state_take(&own.fresh);
    create_objects();
    bind_objects();
    set_functions();
    set_pixel_transfer(8, 3, GL_TRUE);
    for (size_t i = 0; i < sizeof switches / sizeof *switches; ++i)
        if (glIsEnabled(switches[i].what))
            glDisable(switches[i].what);
        else
            glEnable(switches[i].what);
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

static void reset_functions(void)
{
    glBlendFunc(GL_ONE, GL_ZERO);
    glBlendEquation(GL_FUNC_ADD);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDepthRange(0, 1);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glStencilFunc(GL_ALWAYS, 0, ~0u);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glStencilMask(~0u);
    glPointSize(1);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    glClampColor(GL_CLAMP_READ_COLOR, GL_FIXED_ONLY);
}

void gl_state_clean(void)
{
    for (size_t i = 0; i < sizeof switches / sizeof *switches; ++i)
        if (own.fresh.items[i].value[0] != 0)
            glEnable(switches[i].what);
        else
            glDisable(switches[i].what);
    reset_functions();
    set_pixel_transfer(4, 0, GL_FALSE);
    glUseProgram(0); // names that are deleted are unbound
    glBindVertexArray(0);
    glActiveTexture(GL_TEXTURE0);
    glDeleteTextures((GLsizei) (sizeof own.textures / sizeof *own.textures), own.textures);
    glDeleteTextures(1, &own.target);
    glDeleteSamplers(1, &own.sampler);
    glDeleteVertexArrays(1, &own.array);
    glDeleteProgram(own.program);
    glDeleteProgramPipelines(1, &own.pipeline);
    glDeleteFramebuffers(1, &own.framebuffer);
    glDeleteRenderbuffers(1, &own.renderbuffer);
    glDeleteTransformFeedbacks(1, &own.feedback);
    glDeleteBuffers(1, &own.buffer);
    assert_int_equal(glGetError(), GL_NO_ERROR);
}
