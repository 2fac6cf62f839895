// SPDX-License-Identifier: MIT
#include "last_log.h"

#include <gi/registry.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// MODULES is the folder of the MODULE_COUNT modules that modules/module.c makes.
static const fg_log log_last = { .fn = remember, .level = FG_LOG_ERROR };

static gi_registry *modules(void)
{
    static const char *const dirs[] = { MODULES, NULL };
    gi_registry *r = NULL;
    last[0] = '\0';
    assert_int_equal(
        gi_registry_create(&(gi_registry_desc){ .log = &log_last, .dirs = dirs, .only_dirs = true },
                           &r),
        FG_OK);
    return r;
}

static void refused(const char *name, const char *why)
{
    gi_registry *r = modules();
    assert_null(gi_find(r, name));
    assert_non_null(strstr(last, name));
    if (!strstr(last, why))
        fail_msg("'%s' does not say '%s'", last, why);
    gi_registry_destroy(r);
}

static void names_are_sorted_and_nothing_is_loaded_for_them(void **state)
{
    (void) state;
    gi_registry *r = modules();
    int n = 0;
    for (; gi_name(r, n); ++n) {
        if (n)
            assert_true(strcmp(gi_name(r, n - 1), gi_name(r, n)) < 0);
    }
    assert_int_equal(n, MODULE_COUNT);
    assert_string_equal(last, "");
    assert_null(gi_name(r, -1));
    gi_registry_destroy(r);
}

static void a_sound_module_is_found_by_its_name(void **state)
{
    (void) state;
    gi_registry *r = modules();
    const gi_plugin *p = gi_find(r, "sound");
    assert_non_null(p);
    assert_string_equal(p->name, "sound");
    assert_ptr_equal(gi_find(r, "sound"), p);
    gi_registry_destroy(r);
}

static void an_unknown_name_is_refused_and_the_known_ones_are_named(void **state)
{
    (void) state;
    refused("nothing", "not found; there are ");
    refused("nothing", "sound");
    refused("../sound", "not found");
}

static void another_abi_is_refused(void **state)
{
    (void) state;
    refused("wrong_abi", "was built for ABI 3, this host has ABI 2");
}

static void a_missing_symbol_is_refused(void **state)
{
    (void) state;
    refused("no_symbol", "has no symbol gi_plugin_entry");
}

static void another_name_than_the_files_is_refused(void **state)
{
    (void) state;
    refused("wrong_name", "calls itself 'else'");
}

static void an_incomplete_table_is_refused(void **state)
{
    (void) state;
    refused("no_create", "lacks create");
    refused("no_table", "gives no table");
}

static void a_default_outside_its_range_is_refused(void **state)
{
    (void) state;
    refused("bad_default", "parameter 'size' has a default outside its range");
}

static void broken_layers_are_refused(void **state)
{
    (void) state;
    refused("twin_layers", "layer 'level' is there twice");
    refused("many_layers", "layer 'i' is one too many");
    refused("dotted_layer", "layer 'a.b' must be called by 1 to 31 letters without a '.'");
    refused("mute_layer", "layer 'level' has no help");
}

static void layers_are_counted(void **state)
{
    (void) state;
    gi_registry *r = modules();
    assert_int_equal(gi_layers_count(gi_find(r, "sound")), 8);
    assert_int_equal(gi_layers_count(&(gi_plugin){ 0 }), 0);
    gi_registry_destroy(r);
}

static void the_first_folder_of_a_name_wins(void **state)
{
    (void) state;
    static const char *const dirs[] = { "/nonexistent", MODULES, MODULES "/.", NULL };
    gi_registry *r = NULL;
    assert_int_equal(gi_registry_create(&(gi_registry_desc){ .dirs = dirs, .only_dirs = true }, &r),
                     FG_OK);
    int n = 0;
    while (gi_name(r, n))
        ++n;
    assert_int_equal(n, MODULE_COUNT);
    gi_registry_destroy(r);
}

static void the_environment_adds_folders(void **state)
{
    (void) state;
    gi_registry *r = NULL;
    setenv("AFTERGLOW_PLUGIN_PATH", "/nonexistent::" MODULES, 1);
    assert_int_equal(gi_registry_create(&(gi_registry_desc){ 0 }, &r), FG_OK);
    unsetenv("AFTERGLOW_PLUGIN_PATH");
    assert_non_null(gi_find(r, "sound"));
    gi_registry_destroy(r);
}

// ---- parameters ---------------------------------------------------------------------

enum { SIZE, COUNT, REACH, SHADOWS, COLOUR, PARAMS };

static void defaults_come_from_the_table(void **state)
{
    (void) state;
    gi_registry *r = modules();
    const gi_plugin *p = gi_find(r, "sound");
    gi_value v[PARAMS];
    assert_int_equal(gi_params_count(p), PARAMS);
    gi_params_default(p, v);
    assert_int_equal(v[SIZE].i, 256);
    assert_int_equal(v[COUNT].i, 0);
    assert_true(v[REACH].f == 0.1);
    assert_int_equal(v[SHADOWS].i, 1);
    assert_int_equal(v[COLOUR].i, 1);
    gi_registry_destroy(r);
}

static void what_print_writes_set_reads(void **state)
{
    (void) state;
    static const char *const good[] = { "size=1",    "size=1024",   "count=-3",   "reach=0.3",
                                        "reach=1e1", "shadows=off", "colour=blue" };
    gi_registry *r = modules();
    const gi_plugin *p = gi_find(r, "sound");
    for (int i = 0; i < FG_COUNT(good); ++i) {
        gi_value v[PARAMS], again[PARAMS];
        gi_params_default(p, v);
        gi_params_default(p, again);
        assert_int_equal(gi_params_set(&log_last, p, v, good[i]), FG_OK);
        for (int k = 0; k < PARAMS; ++k) {
            char text[128], assignment[192];
            gi_params_print(p, v, k, text, sizeof text);
            snprintf(assignment, sizeof assignment, "%s=%s", p->params[k].name, text);
            assert_int_equal(gi_params_set(&log_last, p, again, assignment), FG_OK);
        }
        assert_memory_equal(v, again, sizeof v);
    }
    gi_registry_destroy(r);
}

static void bad_assignments_are_refused_by_plugin_key_value_and_rule(void **state)
{
    (void) state;
    static const char *const bad[][2] = {
        { "size", "sound: 'size' is not of the form KEY=VALUE" },
        { "nope=1", "sound: has no parameter 'nope'" },
        { "siz=1", "sound: has no parameter 'siz'" },
        { "=1", "sound: has no parameter ''" },
        { "size=100", "sound: size is '100', must be a power of two in [1, 1024] texels" },
        { "size=0", "sound: size is '0', must be a power of two in [1, 1024] texels" },
        { "size=2048", "sound: size is '2048'" },
        { "size=99999999999999999999", "sound: size is '99999999999999999999'" },
        { "size=8x", "sound: size is '8x'" },
        { "size=", "sound: size is ''" },
        { "count=8", "sound: count is '8', must be a whole number in [-3, 7]" },
        { "reach=nan", "sound: reach is 'nan', must be a number in [0, 10] m" },
        { "reach=inf", "sound: reach is 'inf'" },
        { "reach=-0.1", "sound: reach is '-0.1'" },
        { "shadows=maybe", "sound: shadows is 'maybe', must be on or off" },
        { "colour=pink", "sound: colour is 'pink', must be one of red, green, blue" },
    };
    gi_registry *r = modules();
    const gi_plugin *p = gi_find(r, "sound");
    gi_value before[PARAMS], v[PARAMS];
    gi_params_default(p, before);
    for (int i = 0; i < FG_COUNT(bad); ++i) {
        memcpy(v, before, sizeof v);
        assert_int_equal(gi_params_set(&log_last, p, v, bad[i][0]), FG_ERR_INVALID);
        if (!strstr(last, bad[i][1]))
            fail_msg("'%s' does not say '%s'", last, bad[i][1]);
        assert_memory_equal(v, before, sizeof v);
    }
    gi_registry_destroy(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_sorted_and_nothing_is_loaded_for_them),
        cmocka_unit_test(a_sound_module_is_found_by_its_name),
        cmocka_unit_test(an_unknown_name_is_refused_and_the_known_ones_are_named),
        cmocka_unit_test(another_abi_is_refused),
        cmocka_unit_test(a_missing_symbol_is_refused),
        cmocka_unit_test(another_name_than_the_files_is_refused),
        cmocka_unit_test(an_incomplete_table_is_refused),
        cmocka_unit_test(a_default_outside_its_range_is_refused),
        cmocka_unit_test(broken_layers_are_refused),
        cmocka_unit_test(layers_are_counted),
        cmocka_unit_test(the_first_folder_of_a_name_wins),
        cmocka_unit_test(the_environment_adds_folders),
        cmocka_unit_test(defaults_come_from_the_table),
        cmocka_unit_test(what_print_writes_set_reads),
        cmocka_unit_test(bad_assignments_are_refused_by_plugin_key_value_and_rule),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
