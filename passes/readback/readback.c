// SPDX-License-Identifier: MIT
#include <pass/readback.h>

#include <epoxy/gl.h>
#include <string.h>

fg_status ag_readback_init(ag_readback *r)
{
    const GLbitfield flags = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const GLsizeiptr size = (GLsizeiptr) AG_READBACK_SLOTS * AG_READBACK_BYTES;
    *r = (ag_readback){ 0 };
    glCreateBuffers(1, &r->buffer);
    glNamedBufferStorage(r->buffer, size, NULL, flags);
    r->mapped = glMapNamedBufferRange(r->buffer, 0, size, flags);
    if (r->mapped)
        return FG_OK;
    ag_readback_finish(r);
    return FG_ERR_MEMORY;
}

static void forget(ag_readback *r)
{
    for (int i = 0; i < AG_READBACK_SLOTS; i++) {
        glDeleteSync(r->fences[i]); // NULL is ignored
        r->fences[i] = NULL;
    }
}

void ag_readback_finish(ag_readback *r)
{
    if (!r->buffer)
        return;
    forget(r);
    glDeleteBuffers(1, &r->buffer);
    *r = (ag_readback){ 0 };
}

static bool arrived(const ag_readback *r, int slot)
{
    const GLenum done = glClientWaitSync(r->fences[slot], 0, 0);
    return done == GL_ALREADY_SIGNALED || done == GL_CONDITION_SATISFIED;
}

// Takes every slot whose copy is done, oldest first.
static void collect(ag_readback *r)
{
    for (int i = 0; i < AG_READBACK_SLOTS; i++) {
        const int slot = (r->next + i) % AG_READBACK_SLOTS;
        if (!r->fences[slot] || !arrived(r, slot))
            continue;
        memcpy(r->latest, (const char *) r->mapped + (size_t) slot * AG_READBACK_BYTES, r->size);
        r->valid = true;
        glDeleteSync(r->fences[slot]);
        r->fences[slot] = NULL;
    }
}

static fg_status run_readback(const fg_run *run, void *user)
{
    ag_readback *r = user;
    collect(r);
    if (r->fences[r->next])
        return FG_OK; // the GPU is AG_READBACK_SLOTS frames behind: this frame goes uncounted
    glCopyNamedBufferSubData(fg_run_object(run, r->source), r->buffer, 0,
                             (GLintptr) r->next * AG_READBACK_BYTES, (GLsizeiptr) r->size);
    r->fences[r->next] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    r->next = (r->next + 1) % AG_READBACK_SLOTS;
    return FG_OK;
}

void ag_readback_declare(ag_readback *r, fg_graph *g, const char *name, fg_res source,
                         uint64_t size)
{
    if (size > AG_READBACK_BYTES) {
        fg_fail(g, "%s: %llu bytes to read back, %d is the most", name, (unsigned long long) size,
                AG_READBACK_BYTES);
        return;
    }
    forget(r);
    r->source = source;
    r->size = size;
    r->valid = false;
    const fg_pass_desc copy = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { source, FG_USE_COPY } },
        .effect = FG_EFFECT_INTERNAL,
        .run = run_readback,
        .user = r,
    };
    fg_passes(g, &copy, 1);
}

bool ag_readback_latest(ag_readback *r, void *out)
{
    collect(r);
    if (r->valid)
        memcpy(out, r->latest, r->size);
    return r->valid;
}
