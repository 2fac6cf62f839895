// SPDX-License-Identifier: MIT
#include "rig.h"

#include <stdio.h>

static void hear(void *user, fg_log_level level, const char *msg)
{
    rig *r = user;
    const size_t at = strlen(r->said);
    (void) level;
    snprintf(r->said + at, sizeof r->said - at, "%s\n", msg);
}

rig *rig_open_with(fg_graph_desc desc, const fg_null_desc *null)
{
    rig *r = calloc(1, sizeof *r);
    assert_non_null(r);
    r->log = (fg_log){ hear, r, FG_LOG_DEBUG };
    r->dev = fg_null_create(null);
    assert_non_null(r->dev);
    desc.device = r->dev;
    desc.log = &r->log;
    r->g = fg_graph_create(&desc);
    assert_non_null(r->g);
    return r;
}

rig *rig_open(unsigned debug)
{
    return rig_open_with((fg_graph_desc){ .debug = debug }, &(fg_null_desc){ .record = true });
}

void rig_close(rig *r)
{
    fg_graph_destroy(r->g);
    assert_int_equal(fg_null_live_objects(r->dev), 0);
    assert_int_equal(fg_null_live_bytes(r->dev), 0);
    fg_device_destroy(r->dev);
    free(r);
}

void rig_forget(rig *r)
{
    r->said[0] = r->trace[0] = '\0';
    fg_null_clear_log(r->dev);
}

void rig_begin(rig *r)
{
    rig_forget(r);
    fg_graph_begin(r->g, &(fg_frame_desc){ .width = 64, .height = 64 });
}

fg_res rig_tex(rig *r, const char *name)
{
    return fg_texture(r->g, name, &(fg_tex_desc){ .format = FG_RGBA16F });
}

fg_res rig_buf(rig *r, const char *name)
{
    return fg_buffer(r->g, name, &(fg_buf_desc){ .size = 256 });
}

fg_status rig_note(const fg_run *run, void *user)
{
    rig *r = user;
    const size_t at = strlen(r->trace);
    snprintf(r->trace + at, sizeof r->trace - at, "%s ", fg_run_pass(run));
    return FG_OK;
}

void rig_must_compile(rig *r)
{
    const fg_status status = fg_graph_compile(r->g);
    if (status != FG_OK)
        fail_msg("%s: %s", fg_status_name(status), r->said);
}

void rig_must_run(rig *r)
{
    r->trace[0] = '\0';
    fg_null_clear_log(r->dev);
    const fg_status status = fg_graph_run(r->g);
    if (status != FG_OK)
        fail_msg("%s: %s", fg_status_name(status), r->said);
}

void rig_must_have_said(const rig *r, const char *text)
{
    if (!strstr(r->said, text))
        fail_msg("expected: %s\nbut heard: %s", text, r->said);
}

void rig_must_fail(rig *r, fg_status status, const char *text)
{
    assert_int_equal(fg_graph_compile(r->g), status);
    rig_must_have_said(r, text);
}

const char *rig_why(const rig *r, const char *pass)
{
    const char *name, *why;
    for (int i = 0; (name = fg_graph_left_out(r->g, i, &why)); i++)
        if (!strcmp(name, pass))
            return why;
    return NULL;
}

char *rig_dump(const rig *r, fg_dump format)
{
    char *text = fg_graph_dump(r->g, format);
    assert_non_null(text);
    return text;
}

int rig_count(const char *text, const char *part)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, part)); at += strlen(part))
        count++;
    return count;
}
