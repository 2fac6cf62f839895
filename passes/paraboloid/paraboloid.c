// SPDX-License-Identifier: MIT
#include "paraboloid_priv.h"

#include <assert.h>
#include <epoxy/gl.h>
#include <pass/math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static_assert(sizeof(ag_paraboloid_eye_block) == 64, "std430 layout of ag_paraboloid_eye_block");
static_assert(sizeof(shadow_eye) == 48, "std430 layout of shadow_eye");
static_assert(sizeof(shadow_triangle) == 48, "std430 layout of shadow_triangle");
static_assert(sizeof(shadow_corner) == 16, "std430 layout of shadow_corner");

enum {
    DEFAULT_SIZE = 256,
    MIN_SIZE = 16,
    MAX_SIZE = 1024,
    MAX_CAPACITY = 4096,
    MAX_SCRATCH = 1 << 24, // texels
    MAX_LIST = 1 << 18,    // triangles times maps: 4 MiB a class
    UNIT = 4,
    EYES = 4,
    HEADER = 16, // bytes before the eyes
};

// ---- creation -----------------------------------------------------------------------------------

static bool is_sound(const ag_paraboloid_desc *desc, int size)
{
    if (size < MIN_SIZE || size > MAX_SIZE || (size & (size - 1)) != 0)
        fg_logf(desc->log, FG_LOG_ERROR,
                "paraboloid: size is %d, must be a power of two in [%d, %d]", size, MIN_SIZE,
                MAX_SIZE);
    else if (desc->capacity < 1 || desc->capacity > MAX_CAPACITY)
        fg_logf(desc->log, FG_LOG_ERROR, "paraboloid: capacity is %d, must lie in [1, %d]",
                desc->capacity, MAX_CAPACITY);
    else
        return true;
    return false;
}

// Squares of maps in a layer, as small as the device's number of layers allows.
static bool lay_out(ag_paraboloid_maps *m)
{
    GLint layers = 0, edge = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &edge);
    m->edge = 1;
    while ((m->capacity + m->edge * m->edge - 1) / (m->edge * m->edge) > layers)
        m->edge++;
    m->layers = (m->capacity + m->edge * m->edge - 1) / (m->edge * m->edge);
    return m->edge * m->size <= edge;
}

// Whether the device takes the texture, and has it.
static bool create_texture(ag_paraboloid_maps *m)
{
    GLint width = 0;
    const int edge = m->edge * m->size;
    glTexStorage3D(GL_PROXY_TEXTURE_2D_ARRAY, 1, GL_R16F, edge, edge, m->layers);
    glGetTexLevelParameteriv(GL_PROXY_TEXTURE_2D_ARRAY, 0, GL_TEXTURE_WIDTH, &width);
    if (width != edge)
        return false;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &m->texture);
    glTextureStorage3D(m->texture, 1, GL_R16F, edge, edge, m->layers);
    return glGetError() != GL_OUT_OF_MEMORY;
}

static uint64_t texture_bytes(const ag_paraboloid_maps *m)
{
    const uint64_t edge = (uint64_t) m->edge * (uint64_t) m->size;
    return 2 * edge * edge * (uint64_t) m->layers;
}

// An empty one still has room for something: every scene binds the same.
static bool create_buffer(ag_paraboloid_maps *m, paraboloid_buffer which, uint64_t size,
                          const void *data)
{
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    m->sizes[which] = size > 0 ? size : 16;
    if (m->sizes[which] > (uint64_t) most) {
        fg_logf(m->log, FG_LOG_ERROR,
                "paraboloid: a buffer of %.0f MiB, a storage block of the device holds %.0f",
                (double) m->sizes[which] / 1048576, (double) most / 1048576);
        return false;
    }
    glCreateBuffers(1, &m->buffers[which]);
    glNamedBufferStorage(m->buffers[which], (GLsizeiptr) m->sizes[which], size > 0 ? data : NULL,
                         GL_DYNAMIC_STORAGE_BIT);
    if (glGetError() != GL_OUT_OF_MEMORY)
        return true;
    fg_logf(m->log, FG_LOG_ERROR, "paraboloid: the device has no %.0f MiB for a buffer",
            (double) m->sizes[which] / 1048576);
    return false;
}

static bool create_buffers(ag_paraboloid_maps *m, const paraboloid_triangles *t)
{
    const uint64_t corners = 3 * (uint64_t) (t->count - t->opaque), list = (uint64_t) m->list;
    const uint64_t texels = (uint64_t) m->size * (uint64_t) m->size * (uint64_t) m->batch;
    const uint64_t capacity = (uint64_t) m->capacity;
    const struct {
        uint64_t size;
        const void *data;
    } made[PARABOLOID_BUFFERS] = {
        [PARABOLOID_TRIANGLES] = { (uint64_t) t->count * sizeof *t->triangles, t->triangles },
        [PARABOLOID_CORNERS] = { corners * sizeof *t->corners, t->corners },
        [PARABOLOID_TEXTURES] = { (uint64_t) t->texture_count * sizeof *t->textures, t->textures },
        [PARABOLOID_ALPHAS] = { (t->alpha_count + 3) / 4 * 4, t->alphas },
        [PARABOLOID_LISTS] = { PARABOLOID_CLASSES * list * 4 * sizeof(uint32_t), NULL },
        [PARABOLOID_COUNTS] = { 4 * sizeof(uint32_t), NULL },
        [PARABOLOID_GROUPS] = { sizeof(uint32_t[PARABOLOID_CLASSES][4]), NULL },
        [PARABOLOID_DRAWN] = { capacity * sizeof *m->fresh, NULL },
        [PARABOLOID_SCRATCH] = { texels * sizeof(uint32_t), NULL },
        [PARABOLOID_EYES] = { HEADER + capacity * sizeof *m->eyes, NULL },
    };
    for (int i = 0; i < PARABOLOID_BUFFERS; i++)
        if (!create_buffer(m, (paraboloid_buffer) i, made[i].size, made[i].data))
            return false;
    const int32_t header[4] = { m->size, 0, 0, 0 };
    const uint32_t zero = 0;
    glNamedBufferSubData(m->buffers[PARABOLOID_EYES], 0, sizeof header, header);
    glClearNamedBufferData(m->buffers[PARABOLOID_SCRATCH], GL_R32UI, GL_RED_INTEGER,
                           GL_UNSIGNED_INT, &zero);
    return true;
}

static bool create_views(ag_paraboloid_maps *m)
{
    static const struct {
        paraboloid_buffer buffer;
        GLenum format; // 16 bytes
    } of[PARABOLOID_VIEWS] = {
        [PARABOLOID_VIEW_TRIANGLES] = { PARABOLOID_TRIANGLES, GL_RGBA32F },
        [PARABOLOID_VIEW_EYES] = { PARABOLOID_DRAWN, GL_RGBA32F },
        [PARABOLOID_VIEW_LISTS] = { PARABOLOID_LISTS, GL_RGBA32UI },
    };
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    glCreateTextures(GL_TEXTURE_BUFFER, PARABOLOID_VIEWS, m->views);
    for (int i = 0; i < PARABOLOID_VIEWS; i++) {
        const uint64_t texels = m->sizes[of[i].buffer] / 16;
        if (texels > (uint64_t) most) {
            fg_logf(m->log, FG_LOG_ERROR,
                    "paraboloid: a buffer of %llu texels, one of the device's textures holds %d",
                    (unsigned long long) texels, most);
            return false;
        }
        glTextureBuffer(m->views[i], of[i].format, m->buffers[of[i].buffer]);
    }
    return true;
}

static fg_status create_objects(ag_paraboloid_maps *m, const ag_scene *scene)
{
    paraboloid_triangles t;
    fg_status status = paraboloid_triangles_init(&t, m->log, scene);
    if (status == FG_OK) {
        const int64_t pairs = (int64_t) m->batch * (t.count > 0 ? t.count : 1);
        m->list = pairs < MAX_LIST ? (int) pairs : MAX_LIST;
        m->triangles = t.count;
        m->opaque = t.opaque;
        m->unit = t.unit;
        memcpy(m->centre, t.centre, sizeof m->centre);
        status = create_buffers(m, &t) && create_views(m) ? FG_OK : FG_ERR_UNSUPPORTED;
    } else if (status == FG_ERR_MEMORY) {
        fg_logf(m->log, FG_LOG_ERROR, "paraboloid: out of memory for the triangles of %s",
                scene->name);
    }
    paraboloid_triangles_finish(&t);
    if (status)
        return status;
    if (!lay_out(m) || !create_texture(m)) {
        fg_logf(m->log, FG_LOG_ERROR,
                "paraboloid: the device has no texture for %d maps of %d x "
                "%d, %.0f MiB",
                m->capacity, m->size, m->size, (double) texture_bytes(m) / 1048576);
        return FG_ERR_UNSUPPORTED;
    }
    return FG_OK;
}

fg_status ag_paraboloid_create(const ag_paraboloid_desc *desc, ag_paraboloid_maps **out)
{
    const int size = desc->size ? desc->size : DEFAULT_SIZE, fit = MAX_SCRATCH / (size * size);
    *out = NULL;
    if (!is_sound(desc, size))
        return FG_ERR_INVALID;
    ag_paraboloid_maps *m = calloc(1, sizeof *m);
    const size_t count = (size_t) desc->capacity;
    if (m) {
        const int some = fit < PARABOLOID_BATCH ? fit : PARABOLOID_BATCH;
        m->log = desc->log;
        m->size = size;
        m->capacity = desc->capacity;
        m->batch = some < m->capacity ? some : m->capacity;
        m->slots = calloc(count, sizeof *m->slots);
        m->eyes = calloc(count, sizeof *m->eyes);
        m->fresh = calloc(count, sizeof *m->fresh);
        m->fresh_slots = calloc(count, sizeof *m->fresh_slots);
    }
    if (!m || !m->slots || !m->eyes || !m->fresh || !m->fresh_slots) {
        fg_logf(desc->log, FG_LOG_ERROR, "paraboloid: out of memory");
        ag_paraboloid_destroy(m);
        return FG_ERR_MEMORY;
    }
    const fg_status status = create_objects(m, desc->scene);
    if (status) {
        ag_paraboloid_destroy(m);
        return status;
    }
    *out = m;
    return FG_OK;
}

void ag_paraboloid_destroy(ag_paraboloid_maps *m)
{
    if (!m)
        return;
    glDeleteBuffers(PARABOLOID_BUFFERS, m->buffers);
    glDeleteTextures(1, &m->texture);
    glDeleteTextures(PARABOLOID_VIEWS, m->views);
    free(m->slots);
    free(m->eyes);
    free(m->fresh);
    free(m->fresh_slots);
    free(m);
}

// ---- a frame ------------------------------------------------------------------------------------

// First column, first row and layer of a slot.
static void place_of(const ag_paraboloid_maps *m, int slot, float place[3])
{
    const int in_layer = slot % (m->edge * m->edge), layer = slot / (m->edge * m->edge);
    const int column = in_layer % m->edge, row = in_layer / m->edge;
    place[0] = (float) (column * m->size);
    place[1] = (float) (row * m->size);
    place[2] = (float) layer;
}

static void take(paraboloid_slot *slot, const ag_paraboloid_eye *eye)
{
    double n[3], t[3], b[3];
    for (int k = 0; k < 3; k++)
        n[k] = (double) eye->normal[k];
    ag_frame_about(n, t, b);
    for (int k = 0; k < 3; k++) {
        slot->position[k] = eye->position[k];
        slot->frame[0][k] = (float) t[k];
        slot->frame[1][k] = (float) b[k];
        slot->frame[2][k] = eye->normal[k];
    }
    slot->asked = true;
}

static void look_up(const ag_paraboloid_maps *m, int index, const ag_view *view,
                    ag_paraboloid_eye_block *out)
{
    const paraboloid_slot *slot = &m->slots[index];
    float *const axes[3] = { out->tangent, out->bitangent, out->normal };
    float place[3];
    place_of(m, index, place);
    for (int k = 0; k < 3; k++) {
        out->position[k] = (float) (slot->position[k] - view->origin[k]);
        memcpy(axes[k], slot->frame[k], sizeof slot->frame[k]);
        axes[k][3] = place[k];
    }
    out->position[3] = (float) m->unit;
}

static void add_fresh(ag_paraboloid_maps *m, int index)
{
    const paraboloid_slot *slot = &m->slots[index];
    shadow_eye *e = &m->fresh[m->fresh_count];
    float place[3];
    place_of(m, index, place);
    for (int k = 0; k < 3; k++) {
        e->position[k] = (float) ((slot->position[k] - m->centre[k]) * m->unit);
        e->tangent[k] = slot->frame[0][k];
        e->normal[k] = slot->frame[2][k];
    }
    e->position[3] = place[0];
    e->tangent[3] = place[1];
    e->normal[3] = place[2];
    m->fresh_slots[m->fresh_count++] = index;
}

void ag_paraboloid_set(ag_paraboloid_maps *m, const ag_paraboloid_eye *eyes, int count,
                       const ag_view *view)
{
    m->eye_count = m->fresh_count = 0;
    if (count > m->capacity)
        fg_logf(m->log, FG_LOG_ERROR, "paraboloid: %d eyes, at most %d", count, m->capacity);
    for (int i = 0; i < count && i < m->capacity; i++) {
        const ag_paraboloid_eye *eye = &eyes[i];
        if (eye->slot < 0 || eye->slot >= m->capacity) {
            fg_logf(m->log, FG_LOG_ERROR, "paraboloid: slot of eye %d is %d, must lie in [0, %d)",
                    i, eye->slot, m->capacity);
            m->eyes[m->eye_count++] = (ag_paraboloid_eye_block){ { 0 } };
            continue;
        }
        if (eye->fresh)
            take(&m->slots[eye->slot], eye);
        if (m->slots[eye->slot].asked)
            add_fresh(m, eye->slot);
        look_up(m, eye->slot, view, &m->eyes[m->eye_count++]);
    }
}

static fg_status run_maps(const fg_run *run, void *user)
{
    ag_paraboloid_maps *m = ((ag_paraboloid_pass *) user)->owner;
    m->drawn = 0;
    if (m->eye_count > 0)
        glNamedBufferSubData(m->buffers[PARABOLOID_EYES], HEADER,
                             (GLsizeiptr) ((size_t) m->eye_count * sizeof *m->eyes), m->eyes);
    if (m->fresh_count == 0)
        return FG_OK;
    const fg_status status = paraboloid_draw(run, m);
    if (status)
        return status;
    for (int i = 0; i < m->fresh_count; i++)
        m->slots[m->fresh_slots[i]].asked = false;
    m->drawn = m->fresh_count;
    m->fresh_count = 0;
    return FG_OK;
}

void ag_paraboloid_declare(ag_paraboloid_pass *pass, fg_graph *g, ag_paraboloid_maps *m,
                           const char *prefix)
{
    char name[64];
    const fg_tex_desc texture = {
        .format = FG_R16F,
        .width = m->edge * m->size,
        .height = m->edge * m->size,
        .layers = m->layers,
    };
    const fg_buf_desc eyes = { .size = m->sizes[PARABOLOID_EYES] };
    snprintf(name, sizeof name, "%s.shadow", prefix);
    const fg_res maps = fg_import_texture(g, name, &texture, m->texture);
    snprintf(name, sizeof name, "%s.shadow_eyes", prefix);
    const fg_res list = fg_import_buffer(g, name, &eyes, m->buffers[PARABOLOID_EYES]);
    *pass = (ag_paraboloid_pass){ .owner = m, .maps = fg_next(maps), .eyes = fg_next(list) };
    snprintf(name, sizeof name, "%s.shadow_maps", prefix);
    const fg_pass_desc draw = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .writes = { { pass->maps, FG_USE_IMAGE }, { pass->eyes, FG_USE_COPY } },
        .run = run_maps,
        .user = pass,
    };
    fg_passes(g, &draw, 1);
}

int ag_paraboloid_drawn(const ag_paraboloid_maps *m)
{
    return m->drawn;
}

uint64_t ag_paraboloid_bytes(const ag_paraboloid_maps *m)
{
    uint64_t sum = texture_bytes(m);
    for (int i = 0; i < PARABOLOID_BUFFERS; i++)
        sum += m->sizes[i];
    return sum;
}

void ag_paraboloid_bind(const fg_run *run, const ag_paraboloid_pass *pass)
{
    fg_gl_sample(run, UNIT, pass->maps, FG_GL_NEAREST);
    fg_gl_storage(run, EYES, pass->eyes);
}
