// SPDX-License-Identifier: MIT
#include "program_priv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct program {
    const fg_gl_shader *shaders[PROGRAM_STAGES];
    char *defines;
    uint64_t hash;
    GLuint name;        // 0: it did not build
    source_files files; // what to watch, where there is a shader_dir
} program;

struct gl_programs {
    const gl_device *device;
    char *shader_dir, *cache_dir;
    bool binaries;    // the driver gives program binaries
    program **places; // open addressing by hash
    int count, capacity;
};

// The sources of one program while it is built.
typedef struct sources {
    const char *text[PROGRAM_STAGES];
    char *owned[PROGRAM_STAGES]; // those read from disk
    char *defines;               // as #define lines
    int count;
} sources;

uint64_t program_hash(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *b = bytes;
    for (size_t i = 0; i < size; ++i)
        hash = (hash ^ b[i]) * UINT64_C(1099511628211);
    return hash;
}

// ---- table ----------------------------------------------------------------------

static bool same(const program *a, const fg_gl_program_desc *desc, const char *defines)
{
    for (int i = 0; i < PROGRAM_STAGES; ++i) {
        if (a->shaders[i] != desc->shaders[i])
            return false;
        if (!a->shaders[i])
            break;
    }
    return !strcmp(a->defines, defines);
}

static uint64_t hash_of(const fg_gl_program_desc *desc, const char *defines)
{
    uint64_t hash = PROGRAM_HASH_SEED;
    for (int i = 0; i < PROGRAM_STAGES && desc->shaders[i]; ++i)
        hash = program_hash(hash, &desc->shaders[i], sizeof(void *)); // by address
    return program_hash(hash, defines, strlen(defines));
}

static program **place_of(const gl_programs *p, uint64_t hash, const fg_gl_program_desc *desc,
                          const char *defines)
{
    const uint64_t mask = (uint64_t) p->capacity - 1;
    uint64_t at = hash & mask;
    while (p->places[at] && !(p->places[at]->hash == hash && same(p->places[at], desc, defines)))
        at = (at + 1) & mask;
    return &p->places[at];
}

static bool grow(gl_programs *p)
{
    const int capacity = p->capacity ? 2 * p->capacity : 64;
    const uint64_t mask = (uint64_t) capacity - 1;
    program **places = calloc((size_t) capacity, sizeof(void *));
    if (!places)
        return false;
    for (int i = 0; i < p->capacity; ++i) {
        if (!p->places[i])
            continue;
        uint64_t at = p->places[i]->hash & mask;
        while (places[at])
            at = (at + 1) & mask;
        places[at] = p->places[i];
    }
    free(p->places);
    p->places = places;
    p->capacity = capacity;
    return true;
}

static void destroy_program(program *e)
{
    if (!e)
        return;
    glDeleteProgram(e->name);
    source_files_clear(&e->files);
    free(e->defines);
    free(e);
}

static program *create_program(const fg_gl_program_desc *desc, const char *defines, uint64_t hash)
{
    program *e = calloc(1, sizeof *e);
    if (!e)
        return NULL;
    e->hash = hash;
    e->defines = strdup(defines);
    if (!e->defines) {
        free(e);
        return NULL;
    }
    for (int i = 0; i < PROGRAM_STAGES && desc->shaders[i]; ++i)
        e->shaders[i] = desc->shaders[i];
    return e;
}

// ---- sources --------------------------------------------------------------------

// "A=1;B" as "#define A 1\n#define B\n". NULL when out of memory.
static char *define_lines(const char *defines)
{
    static const char word[] = "#define ";
    size_t size = strlen(defines) + sizeof word + 1;
    for (const char *c = defines; *c; ++c)
        size += *c == ';' ? sizeof word : 0;

    char *text = malloc(size), *to = text;
    if (!text)
        return NULL;
    while (*defines) {
        const size_t length = strcspn(defines, ";");
        if (length) {
            to = (char *) memcpy(to, word, sizeof word - 1) + sizeof word - 1;
            memcpy(to, defines, length);
            char *equals = memchr(to, '=', length);
            if (equals)
                *equals = ' ';
            to += length;
            *to++ = '\n';
        }
        defines += length + (defines[length] == ';');
    }
    *to = '\0';
    return text;
}

static void free_sources(sources *s)
{
    for (int i = 0; i < s->count; ++i)
        free(s->owned[i]);
    free(s->defines);
}

// The text of one shader: from disk if there is a shader_dir that has it. NULL: logged.
static const char *get_text(const gl_programs *p, program *e, sources *s, int i)
{
    const fg_gl_shader *shader = e->shaders[i];
    if (!p->shader_dir)
        return shader->text;
    if (!source_exists(p->shader_dir, shader->name)) {
        // A plugin built elsewhere has its shaders elsewhere.
        fg_logf(p->device->log, FG_LOG_WARN, "%s: not below %s, the embedded text is used",
                shader->name, p->shader_dir);
        return shader->text;
    }
    s->owned[i] = source_read(p->shader_dir, shader->name, &e->files, p->device->log);
    return s->owned[i];
}

static bool get_sources(gl_programs *p, program *e, sources *s)
{
    *s = (sources){ .defines = define_lines(e->defines) };
    if (!s->defines) {
        fg_logf(p->device->log, FG_LOG_ERROR, "%s: out of memory", e->shaders[0]->name);
        return false;
    }
    source_files_clear(&e->files);
    for (int i = 0; i < PROGRAM_STAGES && e->shaders[i]; ++i) {
        ++s->count;
        s->text[i] = get_text(p, e, s, i);
        if (!s->text[i])
            return false;
    }
    return true;
}

static program_key key_of(const gl_programs *p, const program *e, const sources *s)
{
    program_key key;
    for (int half = 0; half < 2; ++half) {
        uint64_t h = program_hash(PROGRAM_HASH_SEED, &half, sizeof half);
        for (int i = 0; i < s->count; ++i) {
            h = program_hash(h, e->shaders[i]->name, strlen(e->shaders[i]->name) + 1);
            h = program_hash(h, s->text[i], strlen(s->text[i]) + 1);
        }
        h = program_hash(h, s->defines, strlen(s->defines) + 1);
        h = program_hash(h, p->device->renderer, strlen(p->device->renderer) + 1);
        key.half[half] = program_hash(h, p->device->version, strlen(p->device->version) + 1);
    }
    return key;
}

// ---- building -------------------------------------------------------------------

static GLenum stage_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    if (dot && !strcmp(dot, ".vert"))
        return GL_VERTEX_SHADER;
    if (dot && !strcmp(dot, ".frag"))
        return GL_FRAGMENT_SHADER;
    if (dot && !strcmp(dot, ".geom"))
        return GL_GEOMETRY_SHADER;
    return dot && !strcmp(dot, ".comp") ? GL_COMPUTE_SHADER : GL_NONE;
}

// One line, whatever the driver wrote.
static void flatten(char *text)
{
    size_t length = strlen(text);
    while (length && (text[length - 1] == '\n' || text[length - 1] == ' '))
        text[--length] = '\0';
    for (char *c = text; *c; ++c)
        if (*c == '\n' || *c == '\r' || *c == '\t')
            *c = ' ';
}

// Says that `what` of the program failed. `object` is a shader or, for a link, the program.
static void log_failure(const gl_programs *p, const program *e, const char *what, GLuint object,
                        bool link)
{
    char text[900] = "";
    if (link)
        glGetProgramInfoLog(object, sizeof text, NULL, text);
    else
        glGetShaderInfoLog(object, sizeof text, NULL, text);
    flatten(text);
    fg_logf(p->device->log, FG_LOG_ERROR, "%s [%s]: does not %s: %s", what, e->defines,
            link ? "link" : "compile", text);
}

static GLuint compile(const gl_programs *p, const program *e, const sources *s, int i)
{
    const char *name = e->shaders[i]->name;
    const GLenum stage = stage_of(name);
    GLint done = 0;

    if (stage == GL_NONE) {
        fg_logf(p->device->log, FG_LOG_ERROR,
                "%s: the extension of a shader must be vert, frag, geom or comp", name);
        return 0;
    }
    const char *body = strchr(s->text[i], '\n');
    body = body ? body + 1 : s->text[i] + strlen(s->text[i]);
    const char *parts[] = { s->text[i], s->defines, "#line 2\n", body };
    const GLint lengths[] = { (GLint) (body - s->text[i]), -1, -1, -1 };
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, FG_COUNT(parts), parts, lengths);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done)
        return shader;
    log_failure(p, e, name, shader, false);
    glDeleteShader(shader);
    return 0;
}

static GLuint link(const gl_programs *p, const program *e, const sources *s)
{
    const GLuint name = glCreateProgram();
    GLuint shaders[PROGRAM_STAGES] = { 0 };
    GLint done = 1;

    for (int i = 0; i < s->count && done; ++i) {
        shaders[i] = compile(p, e, s, i);
        done = shaders[i] != 0;
        if (done)
            glAttachShader(name, shaders[i]);
    }
    if (done) {
        if (p->binaries)
            glProgramParameteri(name, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
        glLinkProgram(name);
        glGetProgramiv(name, GL_LINK_STATUS, &done);
        if (!done)
            log_failure(p, e, e->shaders[s->count - 1]->name, name, true);
    }
    for (int i = 0; i < s->count && shaders[i]; ++i) {
        glDetachShader(name, shaders[i]);
        glDeleteShader(shaders[i]);
    }
    if (done)
        return name;
    glDeleteProgram(name);
    return 0;
}

static void label_program(const gl_programs *p, const program *e, GLuint name)
{
    char label[200];
    snprintf(label, sizeof label, "%s%s%s", e->shaders[0]->name, *e->defines ? " " : "",
             e->defines);
    gl_label(p->device, GL_PROGRAM, name, label);
}

static GLuint build(gl_programs *p, program *e)
{
    sources s;
    GLuint name = 0;
    if (get_sources(p, e, &s)) {
        const bool binary = p->binaries && p->cache_dir;
        const program_key key = key_of(p, e, &s);
        name = binary ? binary_load(p->cache_dir, key, p->device->log) : 0;
        if (!name) {
            name = link(p, e, &s);
            if (name && binary)
                binary_save(p->cache_dir, key, name, p->device->log);
        }
        if (name)
            label_program(p, e, name);
    }
    free_sources(&s);
    return name;
}

static void rebuild(gl_programs *p, program *e)
{
    const GLuint name = build(p, e);
    if (!name) {
        if (e->name)
            fg_logf(p->device->log, FG_LOG_WARN, "%s [%s]: the program built before stays in use",
                    e->shaders[0]->name, e->defines);
        return;
    }
    glDeleteProgram(e->name);
    e->name = name;
    fg_logf(p->device->log, FG_LOG_INFO, "%s [%s]: rebuilt", e->shaders[0]->name, e->defines);
}

// ---- life -----------------------------------------------------------------------

gl_programs *gl_programs_create(const gl_device *d, const fg_gl_device_desc *desc)
{
    GLint formats = 0;
    gl_programs *p = calloc(1, sizeof *p);
    if (!p)
        return NULL;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    p->device = d;
    p->binaries = formats > 0;
    p->shader_dir = desc->shader_dir ? strdup(desc->shader_dir) : NULL;
    p->cache_dir = desc->cache_dir ? strdup(desc->cache_dir) : NULL;
    const bool copied = (!desc->shader_dir || p->shader_dir) && (!desc->cache_dir || p->cache_dir);
    if (!copied || !grow(p)) {
        gl_programs_destroy(p);
        return NULL;
    }
    return p;
}

void gl_programs_destroy(gl_programs *p)
{
    if (!p)
        return;
    for (int i = 0; i < p->capacity; ++i)
        destroy_program(p->places[i]);
    free(p->places);
    free(p->shader_dir);
    free(p->cache_dir);
    free(p);
}

uint32_t gl_programs_get(gl_programs *p, const fg_gl_program_desc *desc)
{
    const fg_log *log = p->device->log;
    const char *defines = desc->defines ? desc->defines : "";
    if (!desc->shaders[0]) {
        fg_logf(log, FG_LOG_ERROR, "gl program: it has no shader");
        return 0;
    }
    const uint64_t hash = hash_of(desc, defines);
    program **place = place_of(p, hash, desc, defines);
    if (*place) {
        if (p->shader_dir && source_files_changed(&(*place)->files))
            rebuild(p, *place);
        return (*place)->name;
    }
    program *e = create_program(desc, defines, hash);
    if (!e || (4 * (p->count + 1) > 3 * p->capacity && !grow(p))) {
        destroy_program(e);
        fg_logf(log, FG_LOG_ERROR, "%s: out of memory", desc->shaders[0]->name);
        return 0;
    }
    *place_of(p, hash, desc, defines) = e;
    ++p->count;
    e->name = build(p, e);
    return e->name;
}

uint32_t fg_gl_program(fg_device *dev, const fg_gl_program_desc *desc)
{
    gl_device *d = gl_device_of(dev);
    return d ? gl_programs_get(d->programs, desc) : 0;
}
