// SPDX-License-Identifier: MIT
// Modules whose files change while they are in use. MODULES is the folder of gi_hot1.so,
// gi_hot2.so,
// ..., which modules/hot.c makes; they are copied to gi_hot.so in a folder of the test's own.
#include "last_log.h"

#include <gi/registry.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dirent.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

static const fg_log log_last = { .fn = remember, .level = FG_LOG_ERROR };

typedef struct rig {
    char first[64], second[64]; // folders, in the order of the search
    char file[128];             // first/gi_hot.so
    gi_registry *registry;
} rig;

static double touched; // when a file was last changed

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

// The first `size` bytes of module `from`; into the file that is there, or in its place.
static void put(const char *from, const char *to, bool rename_it, size_t size)
{
    char path[256], beside[256], buffer[4096];
    touched = seconds();
    snprintf(path, sizeof path, "%s/gi_%s.so", MODULES, from);
    snprintf(beside, sizeof beside, "%s.new", to);
    FILE *in = fopen(path, "rb"), *out = fopen(rename_it ? beside : to, "wb");
    assert_true(in && out);
    for (size_t n; size > 0 && (n = fread(buffer, 1, sizeof buffer, in)) > 0;) {
        n = n < size ? n : size;
        assert_int_equal(fwrite(buffer, 1, n, out), n);
        size -= n;
    }
    fclose(in);
    assert_int_equal(fclose(out), 0);
    if (rename_it)
        assert_int_equal(rename(beside, to), 0);
}

static int setup(void **state)
{
    rig *r = calloc(1, sizeof *r);
    snprintf(r->first, sizeof r->first, "/tmp/hot.XXXXXX");
    snprintf(r->second, sizeof r->second, "/tmp/hot.XXXXXX");
    assert_true(mkdtemp(r->first) && mkdtemp(r->second));
    const char *const dirs[] = { r->first, r->second, NULL };
    snprintf(r->file, sizeof r->file, "%s/gi_hot.so", r->first);
    put("hot1", r->file, false, SIZE_MAX);
    const gi_registry_desc desc = {
        .log = &log_last, .dirs = dirs, .only_dirs = true, .hot = true
    };
    assert_int_equal(gi_registry_create(&desc, &r->registry), FG_OK);
    last[0] = '\0';
    lines = 0;
    *state = r;
    return 0;
}

// Removes the folder; returns how many files were in it.
static int empty(const char *folder)
{
    int n = 0;
    char path[512];
    DIR *d = opendir(folder);
    assert_non_null(d);
    for (struct dirent *e; (e = readdir(d));) {
        if (!strcmp(e->d_name, ".") || !strcmp(e->d_name, ".."))
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        assert_int_equal(unlink(path), 0);
        ++n;
    }
    closedir(d);
    assert_int_equal(rmdir(folder), 0);
    return n;
}

static int teardown(void **state)
{
    rig *r = *state;
    gi_registry_destroy(r->registry);
    empty(r->first);
    empty(r->second);
    free(r);
    return 0;
}

static int version(const gi_plugin *p)
{
    gi_counter c[2];
    assert_non_null(p);
    assert_int_equal(p->counters(NULL, c, 2), 2);
    return (int) c[0].value;
}

// Waits until gi_changed() says so. It says so after a quarter of a second without a change.
static void wait_for_change(const rig *r, const char *name)
{
    while (!gi_changed(r->registry, name)) {
        if (seconds() - touched > 60)
            fail_msg("the change of %s was not seen", name);
        nanosleep(&(struct timespec){ .tv_nsec = 5000000 }, NULL);
    }
    // The clock of files goes on in steps of up to 10 ms.
    assert_true(seconds() - touched > 0.25 - 0.02);
}

static void replaced(const rig *r, bool rename_it, const char *from, int to)
{
    const gi_plugin *old = gi_find(r->registry, "hot");
    const int before = version(old);
    put(from, r->file, rename_it, SIZE_MAX);
    assert_int_equal(version(old), before); // its pages are not the file's
    wait_for_change(r, "hot");
    assert_ptr_equal(gi_find(r->registry, "hot"), old);
    assert_int_equal(gi_reload(r->registry, "hot"), FG_OK);
    assert_int_equal(version(gi_find(r->registry, "hot")), to);
    assert_int_equal(version(old), before); // still mapped
    assert_false(gi_changed(r->registry, "hot"));
    assert_string_equal(last, "");
}

static void a_file_written_over_in_place_is_loaded_again(void **state)
{
    const rig *r = *state;
    replaced(r, false, "hot2", 2);
    assert_int_equal(gi_params_count(gi_find(r->registry, "hot")), 2);
}

static void a_file_renamed_over_is_loaded_again(void **state)
{
    replaced(*state, true, "hot2", 2);
    replaced(*state, true, "hot1", 1);
}

static void a_module_that_cannot_be_unloaded_is_loaded_again(void **state)
{
    const rig *r = *state;
    gi_counter c[2];
    put("unique1", r->file, false, SIZE_MAX);
    replaced(r, false, "unique2", 2);
    gi_find(r->registry, "hot")->counters(NULL, c, 2);
    // What C++ makes unique is the old one's still: before this it was counted up four times.
    assert_true(c[1].value > 4);
}

static void nothing_is_left_in_the_folder(void **state)
{
    rig *r = *state;
    gi_find(r->registry, "hot");
    assert_int_equal(empty(r->first), 1);
    assert_int_equal(mkdir(r->first, 0700), 0);
}

static void nothing_has_changed_at_first(void **state)
{
    const rig *r = *state;
    assert_false(gi_changed(r->registry, "hot")); // nobody has asked for it
    assert_int_equal(version(gi_find(r->registry, "hot")), 1);
    assert_false(gi_changed(r->registry, "hot"));
    assert_false(gi_changed(r->registry, "nothing"));
    // Loading again what has not changed is allowed, and gives state of its own.
    const gi_plugin *old = gi_find(r->registry, "hot");
    assert_int_equal(gi_reload(r->registry, "hot"), FG_OK);
    assert_true(gi_find(r->registry, "hot") != old);
}

// Puts what cannot be loaded in place of a sound module; the sound one stays until a later file.
static void not_loadable(const rig *r, const char *from, size_t size, const char *why)
{
    const gi_plugin *old = gi_find(r->registry, "hot");
    put(from, r->file, false, size);
    wait_for_change(r, "hot");
    lines = 0;
    assert_int_equal(gi_reload(r->registry, "hot"), FG_ERR_INPUT);
    assert_int_equal(lines, 1);
    if (!strstr(last, why) || !strstr(last, r->file))
        fail_msg("'%s' does not say '%s'", last, why);
    assert_ptr_equal(gi_find(r->registry, "hot"), old);
    assert_false(gi_changed(r->registry, "hot")); // once is enough
    last[0] = '\0';
    replaced(r, false, "hot2", 2);
}

static void a_half_written_file_leaves_the_module_before(void **state)
{
    not_loadable(*state, "hot2", 100000, "is cut short");
}

static void a_file_that_has_only_just_begun_leaves_the_module_before(void **state)
{
    not_loadable(*state, "hot2", 10, "is no shared object");
}

static void an_empty_file_leaves_the_module_before(void **state)
{
    not_loadable(*state, "hot2", 0, "is no shared object");
}

static void a_missing_symbol_leaves_the_module_before(void **state)
{
    not_loadable(*state, "unresolved", SIZE_MAX, "nobody_defines_this");
}

static void another_abi_is_refused_until_a_later_file(void **state)
{
    const rig *r = *state;
    const gi_plugin *old = gi_find(r->registry, "hot");
    put("other_abi", r->file, true, SIZE_MAX);
    wait_for_change(r, "hot");
    assert_int_equal(gi_reload(r->registry, "hot"), FG_ERR_UNSUPPORTED);
    assert_int_equal(lines, 1);
    assert_non_null(strstr(last, "plugin hot: was built for ABI 3, this host has ABI 2"));
    assert_null(gi_find(r->registry, "hot"));
    assert_int_equal(version(old), 1); // an instance can still be destroyed
    assert_false(gi_changed(r->registry, "hot"));
    put("hot2", r->file, true, SIZE_MAX);
    wait_for_change(r, "hot");
    assert_int_equal(gi_reload(r->registry, "hot"), FG_OK);
    assert_int_equal(version(gi_find(r->registry, "hot")), 2);
}

static void a_file_that_is_gone_is_seen_and_its_return_too(void **state)
{
    const rig *r = *state;
    const gi_plugin *old = gi_find(r->registry, "hot");
    touched = seconds();
    assert_int_equal(unlink(r->file), 0);
    wait_for_change(r, "hot");
    assert_int_equal(gi_reload(r->registry, "hot"), FG_ERR_INPUT);
    assert_non_null(strstr(last, "No such file"));
    assert_ptr_equal(gi_find(r->registry, "hot"), old);
    assert_false(gi_changed(r->registry, "hot"));
    assert_int_equal(gi_rescan(r->registry), FG_OK);
    assert_string_equal(gi_name(r->registry, 0), "hot");
    put("hot2", r->file, false, SIZE_MAX);
    wait_for_change(r, "hot");
    assert_int_equal(gi_reload(r->registry, "hot"), FG_OK);
    assert_int_equal(version(gi_find(r->registry, "hot")), 2);
}

static void a_rescan_finds_what_has_appeared_in_order(void **state)
{
    const rig *r = *state;
    char path[256];
    const char *name = gi_name(r->registry, 0);
    snprintf(path, sizeof path, "%s/gi_another.so", r->second);
    put("hot1", path, false, SIZE_MAX);
    assert_null(gi_name(r->registry, 1));
    assert_int_equal(gi_rescan(r->registry), FG_OK);
    assert_string_equal(gi_name(r->registry, 0), "another");
    assert_ptr_equal(gi_name(r->registry, 1), name); // where it was
    assert_null(gi_name(r->registry, 2));
    assert_null(gi_find(r->registry, "another"));
    assert_non_null(strstr(last, "calls itself 'hot'"));
}

static void an_earlier_folder_takes_over_after_a_rescan(void **state)
{
    const rig *r = *state;
    char path[256];
    snprintf(path, sizeof path, "%s/gi_hot.so", r->second);
    assert_int_equal(rename(r->file, path), 0);
    assert_int_equal(gi_rescan(r->registry), FG_OK);
    assert_int_equal(version(gi_find(r->registry, "hot")), 1); // the second folder's
    put("hot2", r->file, false, SIZE_MAX);
    assert_false(gi_changed(r->registry, "hot"));
    assert_int_equal(gi_rescan(r->registry), FG_OK);
    wait_for_change(r, "hot");
    assert_int_equal(gi_reload(r->registry, "hot"), FG_OK);
    assert_int_equal(version(gi_find(r->registry, "hot")), 2);
}

// A copy's name would be longer than a file's may be: the folder for temporary files has it.
static void a_folder_that_takes_no_copy_is_done_without(void **state)
{
    const rig *r = *state;
    char name[246], path[512];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    snprintf(path, sizeof path, "%s/gi_%s.so", r->second, name);
    put("hot1", path, false, SIZE_MAX);
    assert_int_equal(gi_rescan(r->registry), FG_OK);
    assert_null(gi_find(r->registry, name));
    assert_non_null(strstr(last, "calls itself 'hot'")); // it was loaded, that is
    setenv("TMPDIR", "/nonexistent", 1);
    assert_null(gi_find(r->registry, name));
    unsetenv("TMPDIR");
    assert_non_null(strstr(last, "cannot be copied: No such file or directory"));
}

static void what_is_no_file_is_refused(void **state)
{
    const rig *r = *state;
    assert_int_equal(unlink(r->file), 0);
    assert_int_equal(mkfifo(r->file, 0600), 0);
    assert_null(gi_find(r->registry, "hot"));
    assert_non_null(strstr(last, "is no regular file"));
    assert_int_equal(unlink(r->file), 0);
    assert_int_equal(mkdir(r->file, 0700), 0);
    assert_null(gi_find(r->registry, "hot"));
    assert_non_null(strstr(last, "is no regular file"));
    assert_int_equal(rmdir(r->file), 0);
}

static void only_a_hot_registry_loads_again(void **state)
{
    const rig *r = *state;
    gi_registry *cold;
    const char *const dirs[] = { r->first, NULL };
    const gi_registry_desc desc = { .log = &log_last, .dirs = dirs, .only_dirs = true };
    assert_int_equal(gi_registry_create(&desc, &cold), FG_OK);
    assert_int_equal(version(gi_find(cold, "hot")), 1);
    put("hot2", r->file, true, SIZE_MAX);
    assert_false(gi_changed(cold, "hot"));
    assert_int_equal(gi_reload(cold, "hot"), FG_ERR_INVALID);
    assert_non_null(strstr(last, "the registry is not hot"));
    assert_int_equal(gi_reload(r->registry, "nothing"), FG_ERR_INVALID);
    assert_non_null(strstr(last, "'nothing': not found"));
    gi_registry_destroy(cold);
}

#define WITH_RIG(test) cmocka_unit_test_setup_teardown(test, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_RIG(a_file_written_over_in_place_is_loaded_again),
        WITH_RIG(a_file_renamed_over_is_loaded_again),
        WITH_RIG(a_module_that_cannot_be_unloaded_is_loaded_again),
        WITH_RIG(nothing_is_left_in_the_folder),
        WITH_RIG(nothing_has_changed_at_first),
        WITH_RIG(a_half_written_file_leaves_the_module_before),
        WITH_RIG(a_file_that_has_only_just_begun_leaves_the_module_before),
        WITH_RIG(an_empty_file_leaves_the_module_before),
        WITH_RIG(a_missing_symbol_leaves_the_module_before),
        WITH_RIG(another_abi_is_refused_until_a_later_file),
        WITH_RIG(a_file_that_is_gone_is_seen_and_its_return_too),
        WITH_RIG(a_rescan_finds_what_has_appeared_in_order),
        WITH_RIG(an_earlier_folder_takes_over_after_a_rescan),
        WITH_RIG(a_folder_that_takes_no_copy_is_done_without),
        WITH_RIG(what_is_no_file_is_refused),
        WITH_RIG(only_a_hot_registry_loads_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
