// SPDX-License-Identifier: MIT
// scenes_open() finds what it says and refuses the rest with one line.
#include <scenes.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct record {
    int errors;
    char last[1024];
} record;

static void remember(void *user, fg_log_level level, const char *msg)
{
    record *r = user;
    r->errors += level == FG_LOG_ERROR;
    snprintf(r->last, sizeof r->last, "%s", msg);
}

typedef struct folder {
    char root[64];
    record log;
} folder;

static int make_folder(void **state)
{
    folder *f = calloc(1, sizeof *f);
    *state = f;
    if (!f)
        return -1;
    strcpy(f->root, "/tmp/afterglow-scenes-XXXXXX");
    return mkdtemp(f->root) ? setenv("AFTERGLOW_SCENES", f->root, 1) : -1;
}

static void path_in(const folder *f, const char *name, char out[256])
{
    snprintf(out, 256, "%s/%s", f->root, name);
}

static int drop_folder(void **state)
{
    static const char *const files[] = { "hall.gltf", "sub/b.gltf", "sub/a.gltf", "sub/a.txt",
                                         "sub/a.glb", "sub/b.glb",  "broken.gltf" };
    folder *f = *state;
    char path[256];
    for (int i = 0; i < FG_COUNT(files); ++i) {
        path_in(f, files[i], path);
        remove(path);
    }
    path_in(f, "sub", path);
    rmdir(path);
    rmdir(f->root);
    unsetenv("AFTERGLOW_SCENES");
    free(f);
    return 0;
}

static void put_u32(uint32_t value, FILE *file)
{
    for (int i = 0; i < 4; ++i)
        fputc((int) (value >> 8 * i & 255), file);
}

// The header of a .glb file that holds a chunk of JSON alone.
static void put_glb_header(uint32_t size, FILE *file)
{
    fputs("glTF", file);
    put_u32(2, file);
    put_u32(12 + 8 + size, file);
    put_u32(size, file);
    fputs("JSON", file);
}

// A scene with one camera, so that it can be told from others; a .glb where the name says so.
static void write_scene(const folder *f, const char *name, const char *camera)
{
    char path[256], text[512];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
             "\"nodes\":[{\"camera\":0,\"name\":\"%s\"}],\"cameras\":[{\"name\":\"%s\","
             "\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.1}}]}",
             camera, camera);
    const int padded = ((int) strlen(text) + 3) / 4 * 4;
    path_in(f, name, path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    if (strstr(name, ".glb"))
        put_glb_header((uint32_t) padded, file);
    fprintf(file, "%-*s", padded, text);
    assert_int_equal(fclose(file), 0);
}

static void make_sub(const folder *f)
{
    char path[256];
    path_in(f, "sub", path);
    assert_int_equal(mkdir(path, 0700), 0);
}

static void check_opens(folder *f, const char *name, const char *camera)
{
    const fg_log log = { .fn = remember, .user = &f->log, .level = FG_LOG_ERROR };
    ag_scene *s = NULL;
    if (scenes_open(&log, name, &s) != FG_OK)
        fail_msg("%s", f->log.last);
    if (ag_scene_find_camera(s, camera) != 0)
        fail_msg("%s is another scene: no camera %s", name, camera);
    ag_scene_destroy(s);
}

// One error line that contains `a` and `b`.
static void check_refused(folder *f, const char *name, const char *a, const char *b)
{
    const fg_log log = { .fn = remember, .user = &f->log, .level = FG_LOG_ERROR };
    ag_scene *s = (ag_scene *) f;
    f->log = (record){ 0 };
    assert_int_equal(scenes_open(&log, name, &s), FG_ERR_INPUT);
    assert_null(s);
    assert_int_equal(f->log.errors, 1);
    if (!strstr(f->log.last, a) || !strstr(f->log.last, b))
        fail_msg("message \"%s\" lacks \"%s\" or \"%s\"", f->log.last, a, b);
}

static void scene_is_found_by_path(void **state)
{
    char path[256];
    write_scene(*state, "hall.gltf", "hall");
    path_in(*state, "hall.gltf", path);
    unsetenv("AFTERGLOW_SCENES");
    check_opens(*state, path, "hall");
}

static void scene_is_found_below_the_folder_with_and_without_its_ending(void **state)
{
    write_scene(*state, "hall.gltf", "hall");
    check_opens(*state, "hall", "hall");
    check_opens(*state, "hall.gltf", "hall");
}

static void scene_folder_gives_its_first_gltf(void **state)
{
    make_sub(*state);
    write_scene(*state, "sub/b.gltf", "second");
    write_scene(*state, "sub/a.gltf", "first");
    write_scene(*state, "sub/a.txt", "text");
    check_opens(*state, "sub", "first");
    check_opens(*state, "sub/b", "second");
}

static void scene_folder_without_gltf_gives_its_first_glb(void **state)
{
    make_sub(*state);
    write_scene(*state, "sub/b.glb", "second");
    write_scene(*state, "sub/a.glb", "first");
    check_opens(*state, "sub", "first");
    write_scene(*state, "sub/b.gltf", "text");
    check_opens(*state, "sub", "text");
}

static void builtin_goes_before_a_file_of_its_name(void **state)
{
    folder *f = *state;
    write_scene(f, "hall.gltf", "hall");
    check_opens(f, "cornell", "front");
}

static void unknown_scene_names_what_was_tried(void **state)
{
    folder *f = *state;
    check_refused(f, "nowhere", "nowhere", f->root);
    unsetenv("AFTERGLOW_SCENES");
    check_refused(f, "nowhere", "nowhere", "AFTERGLOW_SCENES is not set");
    setenv("AFTERGLOW_SCENES", "", 1);
    check_refused(f, "nowhere", "nowhere", "AFTERGLOW_SCENES is not set");
}

static void empty_name_is_refused(void **state)
{
    check_refused(*state, "", "scene", "name is empty");
}

static void folder_without_gltf_is_refused(void **state)
{
    make_sub(*state);
    check_refused(*state, "sub", "sub", "no such scene");
}

static void name_with_dots_is_just_a_path(void **state)
{
    folder *f = *state;
    char path[256];
    make_sub(f);
    write_scene(f, "hall.gltf", "hall");
    path_in(f, "sub/../hall.gltf", path);
    check_opens(f, path, "hall");
    check_opens(f, "sub/../hall", "hall");
    check_refused(f, "../no-such-thing/at-all", "../no-such-thing/at-all", "no such scene");
}

static void absurdly_long_name_is_refused(void **state)
{
    folder *f = *state;
    char name[8000];
    memset(name, 'x', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    check_refused(*state, name, "xxxx: no such scene", f->root);
}

static void broken_file_is_refused_by_the_loader(void **state)
{
    char path[256];
    path_in(*state, "broken.gltf", path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("{ \"asset\": ", file);
    assert_int_equal(fclose(file), 0);
    check_refused(*state, "broken", "broken.gltf", "");
}

#define WITH_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, drop_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_FOLDER(scene_is_found_by_path),
        WITH_FOLDER(scene_is_found_below_the_folder_with_and_without_its_ending),
        WITH_FOLDER(scene_folder_gives_its_first_gltf),
        WITH_FOLDER(scene_folder_without_gltf_gives_its_first_glb),
        WITH_FOLDER(builtin_goes_before_a_file_of_its_name),
        WITH_FOLDER(unknown_scene_names_what_was_tried),
        WITH_FOLDER(empty_name_is_refused),
        WITH_FOLDER(folder_without_gltf_is_refused),
        WITH_FOLDER(name_with_dots_is_just_a_path),
        WITH_FOLDER(absurdly_long_name_is_refused),
        WITH_FOLDER(broken_file_is_refused_by_the_loader),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
