// SPDX-License-Identifier: MIT
#include "view_present.h"

#include "view_frag.h"
#include "view_fullscreen_vert.h"

#include <epoxy/gl.h>
#include <stdlib.h>

void view_presenter_create(view_presenter *p)
{
    glCreateVertexArrays(1, &p->vao);
    glCreateSamplers(FG_COUNT(p->samplers), p->samplers);
    for (int i = 0; i < FG_COUNT(p->samplers); ++i) {
        glSamplerParameteri(p->samplers[i], GL_TEXTURE_MIN_FILTER, i ? GL_LINEAR : GL_NEAREST);
        glSamplerParameteri(p->samplers[i], GL_TEXTURE_MAG_FILTER, i ? GL_LINEAR : GL_NEAREST);
        glSamplerParameteri(p->samplers[i], GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glSamplerParameteri(p->samplers[i], GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
}

void view_presenter_finish(view_presenter *p)
{
    if (p->vao)
        glDeleteVertexArrays(1, &p->vao);
    if (p->samplers[0])
        glDeleteSamplers(FG_COUNT(p->samplers), p->samplers);
    *p = (view_presenter){ 0 };
}

// Where in the window a picture stands: x, y, width, height.
static void place(const view_picture *picture, const view_present_desc *d, float area[4])
{
    int width = 0, height = 0;
    area[0] = area[1] = 0;
    area[2] = (float) d->width;
    area[3] = (float) d->height;
    if (picture->whole || !picture->texture)
        return;
    glGetTextureLevelParameteriv(picture->texture, 0, GL_TEXTURE_WIDTH, &width);
    glGetTextureLevelParameteriv(picture->texture, 0, GL_TEXTURE_HEIGHT, &height);
    if (width < 1 || height < 1)
        return;
    const float wide = (float) d->width / (float) width, high = (float) d->height / (float) height;
    const float zoom = wide < high ? wide : high;
    area[2] = zoom * (float) width;
    area[3] = zoom * (float) height;
    area[0] = 0.5f * ((float) d->width - area[2]);
    area[1] = 0.5f * ((float) d->height - area[3]);
}

// A texture as large as the window is shown texel by pixel; others are interpolated.
static void bind(const view_presenter *p, unsigned unit, const view_picture *picture, int width)
{
    int texels = 0;
    if (picture->texture)
        glGetTextureLevelParameteriv(picture->texture, 0, GL_TEXTURE_WIDTH, &texels);
    glBindSampler(unit, p->samplers[texels != width]);
    glBindTextureUnit(unit, picture->texture);
}

static void set_state(const view_present_desc *d)
{
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, d->width, d->height);
    glDisable(GL_FRAMEBUFFER_SRGB); // the shader encodes
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT); // images that a compute pass has written
}

fg_status view_present(const view_presenter *p, fg_device *device, const view_present_desc *d)
{
    const fg_gl_program_desc desc = { .shaders = { &fullscreen_vert, &view_frag } };
    const uint32_t program = fg_gl_program(device, &desc);
    float left[4], right[4];
    if (!program)
        return FG_ERR_SHADER;
    set_state(d);
    place(&d->left, d, left);
    place(&d->right, d, right);
    bind(p, 0, &d->left, d->width);
    bind(p, 1, &d->right, d->width);
    glProgramUniform4fv(program, 0, 1, left);
    glProgramUniform4fv(program, 1, 1, right);
    glProgramUniform1f(program, 2, (float) (d->divider * d->width));
    glProgramUniform1i(program, 3, d->data);
    glProgramUniform3f(program, 4, (float) d->origin[0], (float) d->origin[1],
                       (float) d->origin[2]);
    glBindVertexArray(p->vao);
    glUseProgram(program);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glUseProgram(0);
    glBindSampler(0, 0);
    glBindSampler(1, 0);
    return FG_OK;
}

fg_status view_present_read(const fg_log *log, int width, int height, image *out)
{
    const size_t row = 4 * (size_t) width;
    unsigned char *bytes = malloc(row * (size_t) height);
    fg_status status = bytes ? image_create(log, width, height, out) : FG_ERR_MEMORY;
    if (status == FG_OK) {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glPixelStorei(GL_PACK_ROW_LENGTH, 0);
        glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes);
    }
    for (int y = 0; status == FG_OK && y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                out->rgb[3 * ((size_t) y * (size_t) width + (size_t) x) + (size_t) c] =
                    (float) bytes[row * (size_t) (height - 1 - y) + 4 * (size_t) x + (size_t) c] /
                        127.5f -
                    1; // what IMAGE_DATA writes as that byte
    free(bytes);
    return status;
}
