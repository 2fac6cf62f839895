// SPDX-License-Identifier: MIT
#include "gpu_scene_priv.h"

#include "scene_vert.h"

#include <pass/math.h>

#include <epoxy/gl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void texture_ref_to_gpu(const ag_texture_ref *ref, const ag_scene *scene,
                               const texture_set *set, ag_gpu_texture_ref *out)
{
    memset(out, 0, sizeof *out);
    out->place[0] = -1;
    if (ref->texture < 0)
        return;
    const ag_texture *t = &scene->textures[ref->texture];
    for (int i = 0; i < 3; i++) {
        out->row_u[i] = ref->transform[i];
        out->row_v[i] = ref->transform[3 + i];
    }
    out->place[0] = set->places[ref->texture][0];
    out->place[1] = set->places[ref->texture][1];
    out->place[2] = ref->uv;
    out->place[3] = (int) t->wrap_u | (int) t->wrap_v << 2;
}

static void material_to_gpu(const ag_material *m, const ag_scene *scene, const texture_set *set,
                            ag_gpu_material *out)
{
    for (int i = 0; i < 4; i++)
        out->base_color[i] = m->base_color[i];
    for (int i = 0; i < 3; i++)
        out->emissive[i] = m->emissive[i];
    out->emissive[3] = m->alpha == AG_ALPHA_MASK ? m->alpha_cutoff : -1;
    out->factors[0] = m->metallic;
    out->factors[1] = m->roughness;
    out->factors[2] = m->double_sided;
    out->factors[3] = 0;
    texture_ref_to_gpu(&m->base_color_tex, scene, set, &out->base_color_tex);
    texture_ref_to_gpu(&m->metallic_roughness_tex, scene, set, &out->metallic_roughness_tex);
    texture_ref_to_gpu(&m->emissive_tex, scene, set, &out->emissive_tex);
}

// By the largest entry, so that no scale overflows a float.
static void normal_rows(const double w[16], float out[3][4])
{
    double m[9], largest = 0;
    ag_mat_normal(w, m);
    for (int i = 0; i < 9; i++)
        largest = fmax(largest, fabs(m[i]));
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++)
            out[r][c] = (float) (m[3 * c + r] / (largest > 0 ? largest : 1));
        out[r][3] = 0;
    }
}

static void instance_to_gpu(const ag_scene *scene, int i, const double origin[3],
                            ag_gpu_instance *out)
{
    static const double identity[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    const ag_instance *instance = &scene->instances[i];
    const ag_primitive *primitive = &scene->primitives[instance->primitive];
    const double *w = primitive->skinned ? identity : instance->world;
    const bool mirrored = instance->mirrored && !primitive->skinned;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++)
            out->rows[r][c] = (float) w[4 * c + r];
        out->rows[r][3] = (float) (w[12 + r] - origin[r]);
    }
    normal_rows(w, out->normal_rows);
    out->info[0] = primitive->material;
    out->info[1] = mirrored;
    out->info[2] = out->info[3] = 0;
}

// An immutable buffer; a size of 0 still makes one, so that every scene binds the same.
static bool create_buffer(ag_gpu_scene *s, int which, uint64_t size, const void *data, bool dynamic)
{
    s->sizes[which] = size > 0 ? size : 16;
    glCreateBuffers(1, &s->buffers[which]);
    glNamedBufferStorage(s->buffers[which], (GLsizeiptr) s->sizes[which], size > 0 ? data : NULL,
                         dynamic ? GL_DYNAMIC_STORAGE_BIT : 0);
    return glGetError() != GL_OUT_OF_MEMORY;
}

static fg_status upload_materials(ag_gpu_scene *s)
{
    const ag_scene *scene = s->scene;
    const size_t count = (size_t) scene->material_count;
    s->materials = calloc(count + 1, sizeof *s->materials);
    if (!s->materials)
        return FG_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        material_to_gpu(&scene->materials[i], scene, &s->textures, &s->materials[i]);
    s->material_revision = scene->material_revision;
    return create_buffer(s, BUFFER_MATERIALS, count * sizeof *s->materials, s->materials, true)
               ? FG_OK
               : FG_ERR_MEMORY;
}

static bool is_masked(const ag_scene *scene, int instance)
{
    const ag_primitive *p = &scene->primitives[scene->instances[instance].primitive];
    return scene->materials[p->material].alpha == AG_ALPHA_MASK;
}

// Those without MASK first: a mask costs every fragment its texture and the early depth test.
static int list_draws(const ag_scene *scene, bool masked, draw_command *draws)
{
    int n = 0;
    for (int i = 0; i < scene->instance_count; i++) {
        const ag_primitive *p = &scene->primitives[scene->instances[i].primitive];
        if (is_masked(scene, i) != masked)
            continue;
        draws[n++] = (draw_command){
            .count = p->index_count,
            .instance_count = 1,
            .first_index = p->first_index,
            .base_vertex = (int32_t) p->first_vertex,
            .base_instance = (uint32_t) i,
        };
    }
    return n;
}

static fg_status upload_draws(ag_gpu_scene *s)
{
    const ag_scene *scene = s->scene;
    const size_t count = (size_t) scene->instance_count;
    draw_command *draws = calloc(count + 1, sizeof *draws);
    uint32_t *ids = calloc(count + 1, sizeof *ids);
    for (size_t i = 0; ids && i < count; i++)
        ids[i] = (uint32_t) i;
    if (draws) {
        s->opaque_count = list_draws(scene, false, draws);
        list_draws(scene, true, draws + s->opaque_count);
    }
    const bool done = draws && ids &&
                      create_buffer(s, BUFFER_DRAWS, count * sizeof *draws, draws, false) &&
                      create_buffer(s, BUFFER_DRAW_IDS, count * sizeof *ids, ids, false);
    free(draws);
    free(ids);
    return done ? FG_OK : FG_ERR_MEMORY;
}

static void create_vertex_array(ag_gpu_scene *s)
{
    static const struct {
        int components;
        size_t offset;
    } attributes[] = {
        { 3, offsetof(ag_vertex, position) },
        { 3, offsetof(ag_vertex, normal) },
        { 4, offsetof(ag_vertex, uv) },
        { 4, offsetof(ag_vertex, color) },
    };
    glCreateVertexArrays(1, &s->vertex_array);
    for (GLuint i = 0; i < FG_COUNT(attributes); i++) {
        glEnableVertexArrayAttrib(s->vertex_array, i);
        glVertexArrayAttribFormat(s->vertex_array, i, attributes[i].components, GL_FLOAT, GL_FALSE,
                                  (GLuint) attributes[i].offset);
        glVertexArrayAttribBinding(s->vertex_array, i, 0);
    }
    // gl_BaseInstance is beyond OpenGL 4.5: the command's base instance picks an id here instead.
    glEnableVertexArrayAttrib(s->vertex_array, 4);
    glVertexArrayAttribIFormat(s->vertex_array, 4, 1, GL_UNSIGNED_INT, 0);
    glVertexArrayAttribBinding(s->vertex_array, 4, 1);
    glVertexArrayBindingDivisor(s->vertex_array, 1, 1);
    glVertexArrayVertexBuffer(s->vertex_array, 0, s->buffers[BUFFER_VERTICES], 0,
                              sizeof(ag_vertex));
    glVertexArrayVertexBuffer(s->vertex_array, 1, s->buffers[BUFFER_DRAW_IDS], 0, sizeof(uint32_t));
    glVertexArrayElementBuffer(s->vertex_array, s->buffers[BUFFER_INDICES]);
}

static fg_status create_buffers(ag_gpu_scene *s)
{
    const ag_scene *scene = s->scene;
    const size_t faces = (size_t) s->face_count, lights = (size_t) s->light_count;
    const bool skinned = scene->features & AG_FEATURE_SKINS;
    s->instances = calloc((size_t) scene->instance_count + 1, sizeof *s->instances);
    s->lights = calloc(lights + 1, sizeof *s->lights);
    s->faces = calloc(faces + 1, sizeof *s->faces);
    s->face_power = calloc(faces + 1, sizeof *s->face_power);
    if (!s->instances || !s->lights || !s->faces || !s->face_power)
        return FG_ERR_MEMORY;
    const int32_t header[4] = { s->light_count };
    if (!create_buffer(s, BUFFER_VIEW, sizeof s->view, NULL, true) ||
        !create_buffer(s, BUFFER_VERTICES, scene->vertex_count * sizeof(ag_vertex), scene->vertices,
                       skinned) ||
        !create_buffer(s, BUFFER_INDICES, scene->index_count * sizeof(uint32_t), scene->indices,
                       false) ||
        !create_buffer(s, BUFFER_INSTANCES,
                       (size_t) scene->instance_count * sizeof(ag_gpu_instance), NULL, true) ||
        !create_buffer(s, BUFFER_LIGHTS, sizeof header + (lights + 1) * sizeof(ag_gpu_light), NULL,
                       true) ||
        !create_buffer(s, BUFFER_FACES, (faces + 1) * sizeof(ag_gpu_face), NULL, true))
        return FG_ERR_MEMORY;
    glNamedBufferSubData(s->buffers[BUFFER_LIGHTS], 0, sizeof header, header);
    const fg_status status = upload_draws(s);
    return status ? status : upload_materials(s);
}

fg_status ag_gpu_scene_create(const ag_gpu_scene_desc *desc, ag_gpu_scene **out)
{
    const fg_log *log = desc->log;
    const ag_scene *scene = desc->scene;
    fg_status status = FG_OK;
    ag_gpu_scene *s = calloc(1, sizeof *s);
    REQUIRE(s, FG_ERR_MEMORY, "%s: out of memory", scene->name);
    s->log = log;
    s->device = desc->device;
    s->scene = scene;
    s->features = scene->features | desc->features;
    s->light_count = scene->light_count;
    for (int i = 0; i < scene->light_count; i++)
        s->face_count += light_face_count(&scene->lights[i]);
    REQUIRE(s->face_count <= AG_MAX_FACES, FG_ERR_UNSUPPORTED,
            "%s: %d lights need %d shadow faces, %d is the most", scene->name, s->light_count,
            s->face_count, AG_MAX_FACES);
    status = texture_set_init(log, scene, &s->textures);
    if (status)
        goto fail;
    status = create_buffers(s);
    REQUIRE(status == FG_OK, FG_ERR_MEMORY, "%s: out of memory for scene buffers", scene->name);
    create_vertex_array(s);
    *out = s;
    return FG_OK;

fail:
    ag_gpu_scene_destroy(s);
    *out = NULL;
    return status;
}

void ag_gpu_scene_destroy(ag_gpu_scene *s)
{
    if (!s)
        return;
    texture_set_finish(&s->textures);
    glDeleteBuffers(BUFFER_COUNT, s->buffers);
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s->materials);
    free(s->instances);
    free(s->lights);
    free(s->faces);
    free(s->face_power);
    free(s);
}

// ---- frames ------------------------------------------------------------------------------

// The driver orders these uploads with the frames in flight and copies what it must; nothing waits.
static void upload(const ag_gpu_scene *s, int which, uint64_t offset, uint64_t size,
                   const void *data)
{
    if (size > 0)
        glNamedBufferSubData(s->buffers[which], (GLintptr) offset, (GLsizeiptr) size, data);
}

static float scene_scale(const ag_scene *scene)
{
    double sum = 0;
    int exponent = 0;
    for (int i = 0; i < 3; i++) {
        const double edge = scene->box_max[i] - scene->box_min[i];
        sum += edge > 0 ? edge * edge : 0;
    }
    if (sum > 0)
        frexp(sqrt(sum), &exponent);
    exponent = exponent < -60 ? -60 : exponent > 60 ? 60 : exponent;
    return (float) ldexp(1, -exponent);
}

static void update_view(ag_gpu_scene *s, const ag_view *view)
{
    ag_view_block b = { 0 };
    memcpy(b.view_proj, view->view_proj, sizeof b.view_proj);
    memcpy(b.inv_view_proj, view->inv_view_proj, sizeof b.inv_view_proj);
    memcpy(b.forward, view->forward, sizeof view->forward);
    b.forward[3] = view->orthographic;
    b.scale[0] = scene_scale(s->scene);
    b.scale[1] = 1 / b.scale[0];
    b.size[0] = view->width;
    b.size[1] = view->height;
    // Bits, not values: a block that differs in the sign of a zero is uploaded once too often.
    if (s->uploaded && !memcmp((const char *) &b, (const char *) &s->view, sizeof b))
        return;
    s->view = b;
    upload(s, BUFFER_VIEW, 0, sizeof b, &b);
}

static void update_skins(const ag_gpu_scene *s)
{
    const ag_scene *scene = s->scene;
    for (int i = 0; i < scene->primitive_count; i++) {
        const ag_primitive *p = &scene->primitives[i];
        if (p->skinned)
            upload(s, BUFFER_VERTICES, p->first_vertex * sizeof(ag_vertex),
                   p->vertex_count * sizeof(ag_vertex), scene->vertices + p->first_vertex);
    }
}

static void update_materials(ag_gpu_scene *s)
{
    const ag_scene *scene = s->scene;
    for (int i = 0; i < scene->material_count; i++) {
        ag_gpu_material now;
        if (!scene->materials[i].moving)
            continue;
        material_to_gpu(&scene->materials[i], scene, &s->textures, &now);
        if (!memcmp((const char *) &now, (const char *) &s->materials[i], sizeof now))
            continue;
        s->materials[i] = now;
        upload(s, BUFFER_MATERIALS, (uint64_t) i * sizeof now, sizeof now, &now);
    }
    s->material_revision = scene->material_revision;
}

fg_status ag_gpu_scene_update(ag_gpu_scene *s, const ag_view *view)
{
    const ag_scene *scene = s->scene;
    const fg_log *log = s->log;
    fg_status status = FG_OK;
    REQUIRE(scene->light_count == s->light_count, FG_ERR_INVALID,
            "%s: has %d lights now, had %d when it was uploaded", scene->name, scene->light_count,
            s->light_count);
    bool moved = !s->uploaded;
    for (int i = 0; i < 3; i++)
        moved = moved || s->origin[i] != view->origin[i];
    const bool geometry = !s->uploaded || s->geometry_revision != scene->geometry_revision;
    const bool lights = !s->uploaded || s->light_revision != scene->light_revision;
    update_view(s, view);
    if (s->material_revision != scene->material_revision)
        update_materials(s);
    if (geometry && s->uploaded && (scene->features & AG_FEATURE_SKINS))
        update_skins(s);
    if (moved || geometry) {
        for (int i = 0; i < scene->instance_count; i++)
            instance_to_gpu(scene, i, view->origin, &s->instances[i]);
        upload(s, BUFFER_INSTANCES, 0, (size_t) scene->instance_count * sizeof *s->instances,
               s->instances);
    }
    if (moved || geometry || lights) { // directional lights look at the scene's box
        lights_to_gpu(scene, view->origin, s->lights, s->faces);
        upload(s, BUFFER_LIGHTS, 4 * sizeof(int32_t), (size_t) s->light_count * sizeof *s->lights,
               s->lights);
        upload(s, BUFFER_FACES, 0, (size_t) s->face_count * sizeof *s->faces, s->faces);
    }
    if (geometry || lights)
        lights_to_power(scene, s->face_power);
    memcpy(s->origin, view->origin, sizeof s->origin);
    s->geometry_revision = scene->geometry_revision;
    s->light_revision = scene->light_revision;
    s->uploaded = true;
    return FG_OK;

fail:
    return status;
}

ag_scene_res ag_gpu_scene_import(const ag_gpu_scene *s, fg_graph *g)
{
    static const char *const names[BUFFER_COUNT] = {
        "scene.view",      "scene.vertices",  "scene.indices", "scene.draw_ids", "scene.draws",
        "scene.instances", "scene.materials", "scene.lights",  "scene.faces",
    };
    fg_res r[BUFFER_COUNT];
    for (int i = 0; i < BUFFER_COUNT; i++)
        r[i] = fg_import_buffer(g, names[i], &(fg_buf_desc){ .size = s->sizes[i] }, s->buffers[i]);
    return (ag_scene_res){
        .view = r[BUFFER_VIEW],
        .vertices = r[BUFFER_VERTICES],
        .indices = r[BUFFER_INDICES],
        .draw_ids = r[BUFFER_DRAW_IDS],
        .draws = r[BUFFER_DRAWS],
        .instances = r[BUFFER_INSTANCES],
        .materials = r[BUFFER_MATERIALS],
        .lights = r[BUFFER_LIGHTS],
        .faces = r[BUFFER_FACES],
    };
}

uint64_t ag_gpu_scene_features(const ag_gpu_scene *s)
{
    return s->features;
}

static uint32_t draw_program(const ag_gpu_scene *s, const ag_scene_draw *draw, uint64_t features)
{
    static const struct {
        uint64_t feature;
        const char *define;
    } table[] = {
        { AG_FEATURE_TEXTURES, "TEXTURES=1;" },
        { AG_FEATURE_ALPHA_MASK, "MASK=1;" },
        { AG_FEATURE_GLOSSY, "GLOSSY=1;" },
        { AG_FEATURE_EMISSIVE, "EMISSIVE=1;" },
    };
    const char *more = draw->defines ? draw->defines : "";
    char text[128];
    int used = snprintf(text, sizeof text, "%s%s", more, *more ? ";" : "");
    for (int i = 0; i < FG_COUNT(table) && used < (int) sizeof text; i++)
        if (features & table[i].feature)
            used += snprintf(text + used, sizeof text - (size_t) used, "%s", table[i].define);
    if (features & AG_FEATURE_TEXTURES && used < (int) sizeof text)
        used += snprintf(text + used, sizeof text - (size_t) used, "BINS=%d",
                         s->textures.bin_count > 0 ? s->textures.bin_count : 1);
    assert(used < (int) sizeof text);
    const fg_gl_program_desc desc = { .shaders = { &scene_vert, draw->fragment }, .defines = text };
    return fg_gl_program(s->device, &desc);
}

// Draws `count` commands from `first` on.
static fg_status draw_commands(const ag_gpu_scene *s, const ag_scene_draw *draw, uint64_t features,
                               int first, int count)
{
    if (count == 0)
        return FG_OK;
    const uint32_t program = draw_program(s, draw, features & draw->features & s->features);
    if (!program)
        return FG_ERR_SHADER;
    for (int i = 0; i < draw->integer_count; i++)
        glProgramUniform1i(program, i, draw->integers[i]);
    glUseProgram(program);
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                                (const void *) ((size_t) first * sizeof(draw_command)), count, 0);
    return FG_OK;
}

fg_status ag_gpu_scene_draw(const ag_gpu_scene *s, const fg_run *run, const ag_scene_res *res,
                            const ag_scene_draw *draw)
{
    fg_gl_uniform(run, 0, res->view);
    fg_gl_storage(run, 0, res->instances);
    fg_gl_storage(run, 1, res->materials);
    for (int b = 0; b < s->textures.bin_count; b++) {
        glBindTextureUnit((GLuint) b, s->textures.bins[b].texture);
        glBindSampler((GLuint) b, s->textures.bins[b].sampler);
    }
    glBindVertexArray(s->vertex_array);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, fg_run_object(run, res->draws));
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    const int all = s->scene->instance_count;
    fg_status status =
        draw_commands(s, draw, ~(uint64_t) AG_FEATURE_ALPHA_MASK, 0, s->opaque_count);
    if (status == FG_OK)
        status = draw_commands(s, draw, ~(uint64_t) 0, s->opaque_count, all - s->opaque_count);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
    return status;
}

int ag_gpu_scene_face_count(const ag_gpu_scene *s)
{
    return s->face_count;
}

int ag_gpu_scene_light_of_face(const ag_gpu_scene *s, int face)
{
    int light = 0;
    while (face >= light_face_count(&s->scene->lights[light]))
        face -= light_face_count(&s->scene->lights[light++]);
    return light;
}

uint64_t ag_gpu_scene_bytes(const ag_gpu_scene *s)
{
    uint64_t sum = s->textures.bytes;
    for (int i = 0; i < BUFFER_COUNT; i++)
        sum += s->sizes[i];
    return sum;
}
