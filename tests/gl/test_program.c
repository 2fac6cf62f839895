// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "cells_comp.h"
#include "cells_frag.h"
#include "fullscreen_vert.h"
#include "layers_vert.h"
#include "mismatch_frag.h"
#include "writer_comp.h"

// ---- helpers --------------------------------------------------------------------

static uint32_t build(fixture *f, const fg_gl_shader *shader, const char *defines)
{
    return fg_gl_program(f->device, &(fg_gl_program_desc){ { shader }, defines });
}

// What the program writes.
static int32_t written_by(fixture *f, uint32_t program)
{
    int32_t number = -1;
    uint32_t buffer;
    assert_int_not_equal(program, 0);
    assert_int_equal(f->device->ops->buffer_create(f->device, "number", 4, &buffer), FG_OK);
    glUseProgram(program);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(buffer, 0, sizeof number, &number);
    f->device->ops->buffer_destroy(f->device, buffer);
    return number;
}

// ---- permutations -----------------------------------------------------------------

static void permutation_is_built_once(void **state)
{
    fixture *f = *state;
    char defines[16] = "VALUE=3";
    const uint32_t three = build(f, &writer_comp, "VALUE=3");
    assert_int_equal(build(f, &writer_comp, defines), three); // by text, not by address
    assert_int_not_equal(build(f, &writer_comp, "VALUE=4"), three);
    assert_int_equal(build(f, &writer_comp, "VALUE=3"), three);
}

static void defines_reach_the_shader(void **state)
{
    fixture *f = *state;
    assert_int_equal(written_by(f, build(f, &writer_comp, "VALUE=3")), 3);
    assert_int_equal(written_by(f, build(f, &writer_comp, "A=5;;VALUE=A+B;B=2;")), 7);
    assert_int_equal(written_by(f, build(f, &writer_comp, "VALUE=int(2==2)")), 1);
}

static void many_permutations_stay_apart(void **state)
{
    fixture *f = *state;
    char defines[32];
    uint32_t programs[100];
    for (int i = 0; i < 100; ++i) { // beyond the first size of the table
        snprintf(defines, sizeof defines, "VALUE=%d", i);
        programs[i] = build(f, &writer_comp, defines);
    }
    for (int i = 0; i < 100; ++i) {
        snprintf(defines, sizeof defines, "VALUE=%d", i);
        assert_int_equal(build(f, &writer_comp, defines), programs[i]);
        assert_int_equal(written_by(f, programs[i]), i);
    }
}

static void program_carries_its_label(void **state)
{
    fixture *f = *state;
    char label[128] = "";
    const uint32_t program = build(f, &writer_comp, "VALUE=3");
    glGetObjectLabel(GL_PROGRAM, program, sizeof label, NULL, label);
    assert_string_equal(label, "tests/gl/writer.comp VALUE=3");
}

// ---- failures ---------------------------------------------------------------------

static void failure_names_shader_defines_and_line(void **state)
{
    fixture *f = *state;
    assert_int_equal(build(f, &writer_comp, "OTHER=1"), 0);
    assert_non_null(strstr(f->said, "tests/gl/writer.comp [OTHER=1]: does not compile: "));
    assert_non_null(strstr(f->said, "VALUE")); // the driver's message
    log_takes(f, "12");                        // its line
    assert_int_equal(build(f, &writer_comp, "OTHER=1"), 0);
    assert_string_equal(f->said, ""); // said once
    assert_int_not_equal(build(f, &writer_comp, "VALUE=1"), 0);
}

static void link_failure_is_reported(void **state)
{
    fixture *f = *state;
    assert_int_equal(
        fg_gl_program(f->device, &(fg_gl_program_desc){ { &layers_vert, &mismatch_frag } }), 0);
    log_takes(f, "tests/gl/mismatch.frag []: does not link: ");
}

static void unknown_stage_is_refused(void **state)
{
    fixture *f = *state;
    static const fg_gl_shader odd = { "tests/gl/a.glsl", "" };
    assert_int_equal(build(f, &odd, NULL), 0);
    log_takes(f, "tests/gl/a.glsl: the extension of a shader must be vert, frag, geom or comp");
    assert_int_equal(fg_gl_program(f->device, &(fg_gl_program_desc){ .defines = "A" }), 0);
    log_takes(f, "gl program: it has no shader");
}

static fg_status run_broken(const fg_run *run, void *user)
{
    (void) user;
    const fg_gl_program_desc desc = { { &writer_comp } };
    return fg_gl_program(fg_run_device(run), &desc) ? FG_OK : FG_ERR_SHADER;
}

static void frame_with_a_broken_shader_fails_by_name(void **state)
{
    fixture *f = *state;
    fg_graph *g = open_graph(f, 0, 0);
    fg_graph_begin(g, &(fg_frame_desc){ .width = 4, .height = 4 });
    const fg_pass_desc one = {
        .name = "broken.pass",
        .kind = FG_KIND_COMPUTE,
        .run = run_broken,
        .effect = FG_EFFECT_EXTERNAL,
    };
    fg_passes(g, &one, 1);
    assert_int_equal(fg_graph_compile(g), FG_OK);
    assert_int_equal(fg_graph_run(g), FG_ERR_SHADER);
    for (int i = 0; i < 100; ++i) // beyond the depth of GL's stack of debug groups
        assert_int_equal(fg_graph_run(g), FG_ERR_SHADER);
    assert_non_null(strstr(f->said, "tests/gl/writer.comp []: does not compile"));
    log_takes(f, "broken.pass");
    fg_graph_destroy(g);
}

// ---- shader_dir ---------------------------------------------------------------------

// Files may be written twice within a tick of the file system's clock: the size tells, or the
// time set by hand.
static void write_later(const char *folder, const char *name, const char *text)
{
    static time_t later = 2000000000;
    char path[600];
    write_text(folder, name, text);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const struct timespec times[2] = { { .tv_sec = later }, { .tv_sec = later } };
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
    ++later;
}

// Writes writer.comp with `lines` after its version.
static void write_shader(const char *folder, const char *lines)
{
    char text[2048];
    const char *body = strchr(writer_comp.text, '\n') + 1;
    snprintf(text, sizeof text, "%.*s%s%s", (int) (body - writer_comp.text), writer_comp.text,
             lines, body);
    write_later(folder, writer_comp.name, text);
}

static void open_shader_dir(fixture *f, char folder[256])
{
    char below[300];
    make_folder(folder);
    snprintf(below, sizeof below, "%s/tests", folder);
    assert_int_equal(mkdir(below, 0777), 0);
    snprintf(below, sizeof below, "%s/tests/gl", folder);
    assert_int_equal(mkdir(below, 0777), 0);
    fixture_open(f, &(fg_gl_device_desc){ .shader_dir = folder });
}

static void shader_is_read_from_disk_and_reloaded(void **state)
{
    fixture f;
    char folder[256];
    (void) state;
    open_shader_dir(&f, folder);
    write_shader(folder, "#define VALUE 1\n");
    assert_int_equal(written_by(&f, build(&f, &writer_comp, NULL)), 1);
    const uint32_t same = build(&f, &writer_comp, NULL);
    assert_int_equal(build(&f, &writer_comp, NULL), same); // unchanged: not built again
    write_shader(folder, "#define VALUE 2\n");
    assert_int_equal(written_by(&f, build(&f, &writer_comp, NULL)), 2);
    remove_folder(folder);
    fixture_close(&f);
}

static void broken_reload_keeps_the_last_good_program(void **state)
{
    fixture f;
    char folder[256];
    (void) state;
    open_shader_dir(&f, folder);
    write_shader(folder, "#define VALUE 1\n");
    const uint32_t good = build(&f, &writer_comp, NULL);
    write_shader(folder, "#define VALUE no_such_name\n");
    assert_int_equal(build(&f, &writer_comp, NULL), good);
    assert_non_null(strstr(f.said, "tests/gl/writer.comp []: does not compile"));
    log_takes(&f, "tests/gl/writer.comp []: the program built before stays in use");
    assert_int_equal(build(&f, &writer_comp, NULL), good);
    assert_string_equal(f.said, ""); // tried once
    assert_int_equal(written_by(&f, good), 1);
    write_shader(folder, "#define VALUE 3\n");
    assert_int_equal(written_by(&f, build(&f, &writer_comp, NULL)), 3);
    remove_folder(folder);
    fixture_close(&f);
}

static void includes_are_found_beside_then_below_the_root_and_once(void **state)
{
    fixture f;
    char folder[256];
    (void) state;
    open_shader_dir(&f, folder);
    write_later(folder, "both.glsl", "#define VALUE 100\n");
    write_later(folder, "tests/gl/both.glsl", "#define VALUE (10 + ROOT)\n");
    write_later(folder, "root.glsl",
                "#include \"tests/gl/both.glsl\"\n#ifdef ROOT\n#error twice\n#endif\n"
                "#define ROOT 4\n");
    write_shader(folder, "#include \"both.glsl\"\n  #include  \"root.glsl\"\n"
                         "#include \"root.glsl\"\n");
    assert_int_equal(written_by(&f, build(&f, &writer_comp, NULL)), 14);
    write_later(folder, "root.glsl", "#define ROOT 5\n"); // a change of an include is one
    assert_int_equal(written_by(&f, build(&f, &writer_comp, NULL)), 15);
    remove_folder(folder);
    fixture_close(&f);
}

static void missing_include_is_named_with_its_line(void **state)
{
    fixture f;
    char folder[256];
    (void) state;
    open_shader_dir(&f, folder);
    write_shader(folder, "\n#include \"gone.glsl\"\n");
    assert_int_equal(build(&f, &writer_comp, NULL), 0);
    log_takes(&f, "tests/gl/writer.comp:3: no file gone.glsl");
    remove_folder(folder);
    fixture_close(&f);
}

static void shader_that_is_not_below_shader_dir_is_the_embedded_one(void **state)
{
    fixture f;
    char folder[256];
    (void) state;
    open_shader_dir(&f, folder);
    assert_int_equal(written_by(&f, build(&f, &writer_comp, "VALUE=-5")), -5);
    log_takes(&f, "tests/gl/writer.comp: not below ");
    remove_folder(folder);
    fixture_close(&f);
}

static void expansion_at_run_time_is_that_of_the_build(void **state)
{
    fixture f;
    (void) state;
    fixture_open(&f, &(fg_gl_device_desc){ .shader_dir = SOURCE_ROOT });
    const fg_gl_program_desc cells = { { &fullscreen_vert, &cells_frag }, "SEED=2" };
    assert_int_not_equal(fg_gl_program(f.device, &cells), 0);
    assert_int_not_equal(build(&f, &cells_comp, "SEED=2"), 0);
    fixture_close(&f); // the embedded text would have left a warning
}

// ---- binaries -----------------------------------------------------------------------

// The one file in `folder`; false if there is none.
static bool only_file(const char *folder, char path[600])
{
    int files = 0;
    DIR *dir = opendir(folder);
    for (struct dirent *e = dir ? readdir(dir) : NULL; e; e = readdir(dir)) {
        if (e->d_name[0] == '.')
            continue;
        snprintf(path, 600, "%s/%s", folder, e->d_name);
        ++files;
    }
    if (dir)
        closedir(dir);
    assert_true(files <= 1);
    return files == 1;
}

static bool driver_has_binaries(void)
{
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    return formats > 0;
}

static int links;
static PFNGLLINKPROGRAMPROC real_link;

static void GLAPIENTRY counting_link(GLuint program)
{
    ++links;
    real_link(program);
}

// Builds the writer on a device of its own; returns how many links it took.
static int links_for(const char *folder, const char *defines, int value)
{
    fixture f;
    fixture_open(&f, &(fg_gl_device_desc){ .cache_dir = folder });
    glLinkProgram(0); // resolves the entry point
    assert_int_equal(glGetError(), GL_INVALID_VALUE);
    f.provoked = fg_gl_error_count(f.device);
    f.said[0] = '\0';
    links = 0;
    real_link = epoxy_glLinkProgram;
    epoxy_glLinkProgram = counting_link;
    const uint32_t program = build(&f, &writer_comp, defines);
    epoxy_glLinkProgram = real_link;
    assert_int_equal(written_by(&f, program), value);
    fixture_close(&f);
    return links;
}

static void cached_binary_saves_the_link(void **state)
{
    char folder[256], path[600];
    const bool binaries = driver_has_binaries();
    (void) state;
    make_folder(folder);
    assert_int_equal(links_for(folder, "VALUE=9", 9), 1);
    assert_int_equal(only_file(folder, path), binaries);
    assert_int_equal(links_for(folder, "VALUE=9", 9), binaries ? 0 : 1);
    assert_int_equal(links_for(folder, "VALUE=8", 8), 1);
    remove_folder(folder);
}

static void damage(const char *path, long at, bool cut)
{
    if (cut) {
        assert_int_equal(truncate(path, at), 0);
        return;
    }
    FILE *f = fopen(path, "r+b");
    assert_non_null(f);
    assert_int_equal(fseek(f, at, SEEK_SET), 0);
    const int byte = fgetc(f);
    assert_int_equal(fseek(f, at, SEEK_SET), 0);
    fputc(byte ^ 0x55, f);
    fclose(f);
}

static void damaged_binary_is_built_anew(void **state)
{
    char folder[256], path[600];
    (void) state;
    make_folder(folder);
    links_for(folder, "VALUE=9", 9);
    if (only_file(folder, path)) {
        // Magic, key, sum, format, length, contents; cut in the header, in the contents, to
        // nothing.
        static const long bytes[] = { 0, 8, 24, 32, 36, 60 };
        static const long cuts[] = { 50, 10, 0 };
        for (int i = 0; i < FG_COUNT(bytes); ++i) {
            damage(path, bytes[i], false);
            assert_int_equal(links_for(folder, "VALUE=9", 9), 1);
            assert_int_equal(links_for(folder, "VALUE=9", 9), 0); // mended
        }
        for (int i = 0; i < FG_COUNT(cuts); ++i) {
            damage(path, cuts[i], true);
            assert_int_equal(links_for(folder, "VALUE=9", 9), 1);
        }
    }
    remove_folder(folder);
}

static void cache_that_cannot_be_written_is_a_warning(void **state)
{
    fixture f;
    (void) state;
    fixture_open(&f, &(fg_gl_device_desc){ .cache_dir = "/proc/no/such/folder" });
    assert_int_equal(written_by(&f, build(&f, &writer_comp, "VALUE=6")), 6);
    if (driver_has_binaries())
        log_takes(&f, "cannot be written");
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(f) cmocka_unit_test_setup_teardown(f, open_gl, close_gl)
        TEST(permutation_is_built_once),
        TEST(defines_reach_the_shader),
        TEST(many_permutations_stay_apart),
        TEST(program_carries_its_label),
        TEST(failure_names_shader_defines_and_line),
        TEST(link_failure_is_reported),
        TEST(unknown_stage_is_refused),
        TEST(frame_with_a_broken_shader_fails_by_name),
        cmocka_unit_test(shader_is_read_from_disk_and_reloaded),
        cmocka_unit_test(broken_reload_keeps_the_last_good_program),
        cmocka_unit_test(includes_are_found_beside_then_below_the_root_and_once),
        cmocka_unit_test(missing_include_is_named_with_its_line),
        cmocka_unit_test(shader_that_is_not_below_shader_dir_is_the_embedded_one),
        cmocka_unit_test(expansion_at_run_time_is_that_of_the_build),
        TEST(cached_binary_saves_the_link),
        TEST(damaged_binary_is_built_anew),
        cmocka_unit_test(cache_that_cannot_be_written_is_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
