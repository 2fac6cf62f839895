// SPDX-License-Identifier: MIT
#include "gl_priv.h"

// An object of 0 is an optional read that is absent, or one that the graph refused:
// binding it unbinds the unit, so that a shader reads zeros and nothing of another pass.

void fg_gl_sample(const fg_run *run, int unit, fg_res tex, fg_gl_filter filter)
{
    const gl_device *d = gl_device_of(fg_run_device(run));
    if (!d)
        return;
    glBindTextureUnit((GLuint) unit, fg_run_object(run, tex));
    glBindSampler((GLuint) unit, d->samplers[filter]);
}

void fg_gl_image(const fg_run *run, int unit, fg_res tex, int mip, unsigned access,
                 fg_format format)
{
    // Layered binds every layer, face or slice; where there is only one GL ignores it.
    glBindImageTexture((GLuint) unit, fg_run_object(run, tex), mip, GL_TRUE, 0, access,
                       gl_format_get(format)->internal);
}

void fg_gl_storage(const fg_run *run, int binding, fg_res buf)
{
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint) binding, fg_run_object(run, buf));
}

void fg_gl_uniform(const fg_run *run, int binding, fg_res buf)
{
    glBindBufferBase(GL_UNIFORM_BUFFER, (GLuint) binding, fg_run_object(run, buf));
}

void fg_gl_dispatch_2d(int width, int height, int group_x, int group_y)
{
    if (width <= 0 || height <= 0)
        return;
    glDispatchCompute((GLuint) (width + group_x - 1) / (GLuint) group_x,
                      (GLuint) (height + group_y - 1) / (GLuint) group_y, 1);
}

void fg_gl_fullscreen(const fg_run *run)
{
    const gl_device *d = gl_device_of(fg_run_device(run));
    if (!d)
        return;
    glBindVertexArray(d->vao); // the pass may have drawn meshes before
    glDrawArrays(GL_TRIANGLES, 0, 3);
}
