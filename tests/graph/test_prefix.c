// SPDX-License-Identifier: MIT
// Names that begin with a prefix: one piece of code declared twice in a frame.
#include "rig.h"

// A technique with a step that keeps state of its own and one that remembers last frame.
static fg_res technique(rig *r)
{
    const fg_res a = rig_tex(r, "gi.a"), out = rig_tex(r, "gi.out");
    const fg_res old = fg_texture(
        r->g, "gi.old", &(fg_tex_desc){ .format = FG_RGBA16F, .history = FG_HISTORY_CLEAR });
    PASSES(r, PASS(r, "gi.make", .writes = { { a } }),
           PASS(r, "gi.light", .reads = { { a }, { fg_last_frame(r->g, old) } },
                .writes = { { out }, { old } }),
           PASS(r, "gi.count", .reads = { { a } }, .effect = FG_EFFECT_INTERNAL));
    return out;
}

static void show(rig *r, const char *name, fg_res what)
{
    PASSES(r, PASS(r, name, SHOW, .reads = { { what } }));
}

static void declare_both(rig *r)
{
    rig_begin(r);
    const fg_res first = technique(r);
    fg_prefix(r->g, "b:");
    const fg_res second = technique(r);
    fg_prefix(r->g, "");
    show(r, "show.first", first);
    show(r, "show.second", second);
}

static void one_technique_can_be_declared_twice(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    declare_both(r);
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "gi.make gi.light gi.count b:gi.make b:gi.light b:gi.count "
                                  "show.first show.second ");
    rig_close(r);
}

static void dumps_show_the_longer_names(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    declare_both(r);
    rig_must_compile(r);
    for (int format = FG_DUMP_TEXT; format <= FG_DUMP_JSON; format++) {
        char *text = rig_dump(r, (fg_dump) format);
        assert_non_null(strstr(text, "b:gi.light"));
        assert_non_null(strstr(text, "b:gi.out"));
        assert_null(strstr(text, "b:show"));
        fg_dump_free(r->g, text);
    }
    rig_close(r);
}

static void groups_of_internal_passes_stay_apart(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res first = technique(r);
    fg_prefix(r->g, "b:");
    technique(r); // nobody reads what it makes
    fg_prefix(r->g, NULL);
    show(r, "show", first);
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "gi.make gi.light gi.count show ");
    assert_non_null(rig_why(r, "b:gi.count"));
    rig_close(r);
}

static void histories_of_both_go_their_own_ways(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    declare_both(r);
    rig_must_compile(r);
    rig_must_run(r);
    const int both = fg_null_live_objects(r->dev);
    rig_begin(r); // the second goes, and its history with it
    show(r, "show.first", technique(r));
    rig_must_compile(r);
    fg_graph_trim(r->g);
    rig_must_run(r);
    assert_true(fg_null_live_objects(r->dev) <= both - 3); // two of the history, one of "b:gi.out"
    rig_close(r);
}

static void passes_are_switched_by_the_longer_name(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    declare_both(r);
    rig_must_compile(r);
    assert_int_equal(fg_pass_enable(r->g, "b:gi.make", false), FG_OK);
    rig_must_run(r);
    assert_string_equal(r->trace,
                        "gi.make gi.light gi.count b:gi.light b:gi.count show.first show.second ");
    rig_close(r);
}

static void messages_say_the_longer_name(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    fg_prefix(r->g, "b:");
    fg_texture(r->g, "odd", &(fg_tex_desc){ .format = FG_RGBA16F, .width = -1 });
    const fg_res never = rig_tex(r, "never");
    PASSES(r, { .name = "mute", SHOW }, PASS(r, "show", SHOW, .reads = { { never, .mip = 9 } }));
    rig_must_fail(r, FG_ERR_INVALID, "texture 'b:odd': size is -1x0");
    rig_must_have_said(r, "pass 'b:mute': needs a run callback");
    rig_must_have_said(r, "pass 'b:show': mips 9..9");
    rig_must_have_said(r, "of 'b:never' are out of range");
    rig_close(r);
}

static void a_declaration_ends_the_prefix(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    fg_prefix(r->g, "b:");
    show(r, "show", technique(r));
    rig_must_compile(r);
    assert_string_equal(fg_graph_pass(r->g, 3), "b:show");
    rig_begin(r);
    show(r, "show", technique(r));
    rig_must_compile(r);
    assert_string_equal(fg_graph_pass(r->g, 3), "show");
    rig_begin(r);
    fg_prefix(r->g, "b:");
    rig_begin(r); // the one before was given up
    show(r, "show", technique(r));
    rig_must_compile(r);
    assert_string_equal(fg_graph_pass(r->g, 3), "show");
    rig_close(r);
}

static void equal_declarations_with_a_prefix_compile_once(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    for (int i = 0; i < 3; i++) {
        declare_both(r);
        rig_must_compile(r);
        rig_must_run(r);
    }
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    rig_close(r);
}

static void prefixes_are_checked(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    fg_prefix(r->g, "b:");
    rig_must_have_said(r, "declared outside a declaration");
    rig_begin(r);
    fg_prefix(r->g, "left.");
    PASSES(r, PASS(r, "show", SHOW));
    rig_must_fail(r, FG_ERR_INVALID, "fg_prefix(): 'left.' must have at most 31 bytes and no '.'");
    rig_begin(r);
    fg_prefix(r->g, "0123456789012345678901234567890"); // 31
    PASSES(r, PASS(r, "show", SHOW));
    rig_must_compile(r);
    assert_string_equal(fg_graph_pass(r->g, 0), "0123456789012345678901234567890show");
    rig_begin(r);
    fg_prefix(r->g, "01234567890123456789012345678901");
    PASSES(r, PASS(r, "show", SHOW));
    rig_must_fail(r, FG_ERR_INVALID, "must have at most 31 bytes");
    rig_begin(r);
    fg_prefix(r->g, "b:");
    PASSES(r, PASS(r, "", SHOW)); // still has no name
    rig_must_fail(r, FG_ERR_INVALID, "pass 0: has no name");
    rig_close(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_technique_can_be_declared_twice),
        cmocka_unit_test(dumps_show_the_longer_names),
        cmocka_unit_test(groups_of_internal_passes_stay_apart),
        cmocka_unit_test(histories_of_both_go_their_own_ways),
        cmocka_unit_test(passes_are_switched_by_the_longer_name),
        cmocka_unit_test(messages_say_the_longer_name),
        cmocka_unit_test(a_declaration_ends_the_prefix),
        cmocka_unit_test(equal_declarations_with_a_prefix_compile_once),
        cmocka_unit_test(prefixes_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
