// SPDX-License-Identifier: MIT
#include <gi/registry.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int gi_params_count(const gi_plugin *p)
{
    int n = 0;
    while (p->params && p->params[n].name)
        ++n;
    return n;
}

void gi_params_default(const gi_plugin *p, gi_value *values)
{
    const int n = gi_params_count(p);
    for (int i = 0; i < n; ++i) {
        if (p->params[i].type == GI_FLOAT)
            values[i].f = p->params[i].def;
        else
            values[i].i = (int64_t) p->params[i].def;
    }
}

static bool parse_int(const gi_param *row, const char *text, gi_value *out)
{
    char *end;
    errno = 0;
    const long long i = strtoll(text, &end, 10);
    if (end == text || *end || errno || (double) i < row->min || (double) i > row->max)
        return false;
    out->i = i;
    return !row->power_of_two || (i > 0 && (i & (i - 1)) == 0);
}

static bool parse_float(const gi_param *row, const char *text, gi_value *out)
{
    char *end;
    const double f = strtod(text, &end);
    if (end == text || *end || !isfinite(f) || f < row->min || f > row->max)
        return false;
    out->f = f;
    return true;
}

static bool parse_bool(const char *text, gi_value *out)
{
    static const char *const words[] = { "0", "1", "false", "true", "off", "on" };
    for (int i = 0; i < FG_COUNT(words); ++i) {
        if (!strcmp(text, words[i])) {
            out->i = i & 1;
            return true;
        }
    }
    return false;
}

static bool parse_enum(const gi_param *row, const char *text, gi_value *out)
{
    for (int i = 0; row->choices[i]; ++i) {
        if (!strcmp(text, row->choices[i])) {
            out->i = i;
            return true;
        }
    }
    return false;
}

static bool parse(const gi_param *row, const char *text, gi_value *out)
{
    switch (row->type) {
    case GI_INT: return parse_int(row, text, out);
    case GI_FLOAT: return parse_float(row, text, out);
    case GI_BOOL: return parse_bool(text, out);
    case GI_ENUM: return parse_enum(row, text, out);
    }
    return false;
}

// "a power of two in [1, 1024] texels", "one of none, disc, constant"
static void describe(const gi_param *row, char *text, size_t size)
{
    const bool bare = !row->unit || !strcmp(row->unit, "1");
    size_t used = 0;
    switch (row->type) {
    case GI_INT:
        snprintf(text, size, "%s in [%lld, %lld]%s%s",
                 row->power_of_two ? "a power of two" : "a whole number", (long long) row->min,
                 (long long) row->max, bare ? "" : " ", bare ? "" : row->unit);
        return;
    case GI_FLOAT:
        snprintf(text, size, "a number in [%g, %g]%s%s", row->min, row->max, bare ? "" : " ",
                 bare ? "" : row->unit);
        return;
    case GI_BOOL: snprintf(text, size, "on or off"); return;
    case GI_ENUM:
        for (int i = 0; row->choices[i] && used < size; ++i)
            used += (size_t) snprintf(text + used, size - used, "%s%s", i ? ", " : "one of ",
                                      row->choices[i]);
        return;
    }
}

fg_status gi_params_set(const fg_log *log, const gi_plugin *p, gi_value *values,
                        const char *assignment)
{
    const char *equals = strchr(assignment, '=');
    if (!equals) {
        fg_logf(log, FG_LOG_ERROR, "%s: '%s' is not of the form KEY=VALUE", p->name, assignment);
        return FG_ERR_INVALID;
    }
    const size_t length = (size_t) (equals - assignment);
    const int n = gi_params_count(p);
    for (int i = 0; i < n; ++i) {
        const gi_param *row = &p->params[i];
        char rule[256];
        gi_value value;
        if (strlen(row->name) != length || memcmp(row->name, assignment, length) != 0)
            continue;
        if (parse(row, equals + 1, &value)) {
            values[i] = value;
            return FG_OK;
        }
        describe(row, rule, sizeof rule);
        fg_logf(log, FG_LOG_ERROR, "%s: %s is '%s', must be %s", p->name, row->name, equals + 1,
                rule);
        return FG_ERR_INVALID;
    }
    fg_logf(log, FG_LOG_ERROR, "%s: has no parameter '%.*s'", p->name, (int) length, assignment);
    return FG_ERR_INVALID;
}

int gi_params_print(const gi_plugin *p, const gi_value *values, int i, char *text, size_t size)
{
    const gi_param *row = &p->params[i];
    switch (row->type) {
    case GI_INT: return snprintf(text, size, "%lld", (long long) values[i].i);
    case GI_FLOAT: return snprintf(text, size, "%.17g", values[i].f);
    case GI_BOOL: return snprintf(text, size, "%s", values[i].i ? "on" : "off");
    case GI_ENUM: return snprintf(text, size, "%s", row->choices[values[i].i]);
    }
    return 0;
}
