// SPDX-License-Identifier: MIT
#include "cli.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- parts of values -------------------------------------------------------------------------

bool parse_int(const char *text, long min, long max, long *out)
{
    char *end;
    errno = 0;
    const long value = strtol(text, &end, 10);
    if (end == text || *end || errno || value < min || value > max || text[0] == ' ')
        return false;
    *out = value;
    return true;
}

bool parse_double(const char *text, double min, double max, double *out)
{
    return parse_list(text, 1, out) && *out >= min && *out <= max;
}

bool parse_list(const char *text, int count, double *out)
{
    for (int i = 0; i < count; ++i) {
        char *end;
        out[i] = strtod(text, &end);
        if (end == text || !isfinite(out[i]) || *end != (i + 1 < count ? ',' : 0))
            return false;
        text = end + 1;
    }
    return true;
}

// ---- options with a grammar of their own -----------------------------------------------------

static const char *const debug_names[] = { "poison", "no-sharing", "random-order", "keep-all" };
static const unsigned debug_bits[] = { FG_DEBUG_POISON, FG_DEBUG_NO_SHARING, FG_DEBUG_RANDOM_ORDER,
                                       FG_DEBUG_KEEP_ALL };

static bool set_debug(options *o, const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, ",");
        unsigned bit = 0;
        for (int i = 0; i < FG_COUNT(debug_names); ++i)
            if (strlen(debug_names[i]) == length && !strncmp(text, debug_names[i], length))
                bit = debug_bits[i];
        if (!bit)
            return false;
        o->debug |= bit;
        text += length + (text[length] == ',');
    }
    return o->debug != 0;
}

static bool set_size(options *o, const char *text)
{
    char part[16];
    long width, height;
    const char *x = strchr(text, 'x');
    if (!x || (size_t) (x - text) >= sizeof part)
        return false;
    memcpy(part, text, (size_t) (x - text));
    part[x - text] = 0;
    if (!parse_int(part, 1, CLI_MAX_SIZE, &width) || !parse_int(x + 1, 1, CLI_MAX_SIZE, &height))
        return false;
    o->width = (int) width;
    o->height = (int) height;
    return true;
}

static bool set_shard(options *o, const char *text)
{
    char part[16];
    long i, n;
    const char *slash = strchr(text, '/');
    if (!slash || (size_t) (slash - text) >= sizeof part)
        return false;
    memcpy(part, text, (size_t) (slash - text));
    part[slash - text] = 0;
    if (!parse_int(slash + 1, 1, 10000, &n) || !parse_int(part, 0, n, &i))
        return false;
    o->shard = (int) (i ? i : n);
    o->shards = (int) n;
    return true;
}

static bool set_seed(options *o, const char *text)
{
    char *end;
    errno = 0;
    o->seed = strtoull(text, &end, 10);
    return end != text && !*end && !errno && text[0] >= '0' && text[0] <= '9';
}

static bool add_word(const char **words, int *count, int max, const char *text)
{
    if (*count >= max || !*text)
        return false;
    words[(*count)++] = text;
    return true;
}

// ---- the table -------------------------------------------------------------------------------

typedef enum option_id {
    OPT_GI,
    OPT_SET,
    OPT_SIZE,
    OPT_FRAME,
    OPT_FRAMES,
    OPT_TIMING_FRAMES,
    OPT_LAYER,
    OPT_FORMAT,
    OPT_FILTER,
    OPT_BUDGET,
    OPT_STUDY,
    OPT_OUTPUT,
    OPT_STATS,
    OPT_TRACE,
    OPT_PLUGIN_DIR,
    OPT_SHADER_DIR,
    OPT_PARAMS,
    OPT_RENDER_SCALE,
    OPT_CAMERA,
    OPT_CAMERA_AT,
    OPT_LIGHT,
    OPT_SEED,
    OPT_EXPOSURE,
    OPT_SHADOW_SIZE,
    OPT_SHADOW_TAPS,
    OPT_DEVICE,
    OPT_DEBUG,
    OPT_NEEDS,
    OPT_JSON,
    OPT_MERGE,
    OPT_UNSHADOWED,
    OPT_BOUNCES,
    OPT_SPP,
    OPT_THREADS,
    OPT_SHARD,
    OPT_VERBOSE,
    OPT_HELP,
} option_id;

typedef struct option {
    option_id id;
    const char *name;
    const char *letter; // another name, or NULL
    const char *value;  // what its value is called; NULL: a flag
    const char *rule;   // "must be ...", for the error line
    const char *help;
} option;

static const option table[] = {
    { OPT_GI, "--gi", NULL, "NAME", "a name, at most 32 times",
      "plugin for indirect light; none: direct light alone" },
    { OPT_SET, "--set", NULL, "KEY=VALUE", "KEY=VALUE, at most 64 times",
      "a parameter of the plugin; with several plugins of each that has it, or NAME.KEY=VALUE" },
    { OPT_SIZE, "--size", NULL, "WxH", "two whole numbers from 1 to 32768, as in 640x480",
      "pixels (512x512; view: 1280x720; report: its budget's)" },
    { OPT_FRAME, "--frame", NULL, "N", "a whole number from 0 to 1000000",
      "run frames 0 to N of the animation, 1/60 s apart, and take the last (0)" },
    { OPT_FRAMES, "--frames", NULL, "N", "a whole number from 1 to 1000000", "how many frames" },
    { OPT_TIMING_FRAMES, "--timing-frames", NULL, "N", "a whole number from 1 to 10000",
      "frames that --stats times after the one that is taken (5)" },
    { OPT_LAYER, "--layer", NULL, "L", "",
      "radiance, direct, indirect, albedo, normal, position; of a rendered frame final or a "
      "plugin's own" },
    { OPT_FORMAT, "--format", NULL, "F", "", "how to write it" },
    { OPT_FILTER, "--filter", NULL, "F", "",
      "point: pixel centres, as a rasteriser samples; or box" },
    { OPT_BUDGET, "--budget", NULL, "B", "", "quick (256x256, a handful of settings) or full" },
    { OPT_STUDY, "--study", NULL, "NAME", "a name, at most 16 times",
      "this study of the full report alone, at either budget; may be given again" },
    { OPT_OUTPUT, "--output", "-o", "FILE", "",
      "where the result goes; FILE is a folder where there are several" },
    { OPT_STATS, "--stats", NULL, "FILE", "",
      "JSON: frame and per-pass times, counters, memory, what was left out" },
    { OPT_TRACE, "--trace", NULL, "FILE", "",
      "every frame's passes on CPU and GPU, for ui.perfetto.dev or chrome://tracing" },
    { OPT_PLUGIN_DIR, "--plugin-dir", NULL, "DIR", "a folder, at most 16 times",
      "a folder to look for plugins in first; may be given again, the first that has one wins" },
    { OPT_SHADER_DIR, "--shader-dir", NULL, "DIR", "",
      "read shaders below this folder, a source tree, instead of those built in" },
    { OPT_PARAMS, "--params", NULL, "FILE", "",
      "a parameter set to begin with, as 'view' saves it" },
    { OPT_RENDER_SCALE, "--render-scale", NULL, "N", "1, 2 or 4",
      "the frame has a 1/N of the window's pixels a side (1; without a GPU 2)" },
    { OPT_CAMERA, "--camera", NULL, "NAME", "", "a camera of the scene, instead of its first" },
    { OPT_CAMERA_AT, "--camera-at", NULL, "PX,PY,PZ:TX,TY,TZ[:FOV]", "",
      "a camera at P that looks at T; vertical field of view in degrees (60)" },
    { OPT_LIGHT, "--light", NULL, "LIGHT", "", "adds a light; see below" },
    { OPT_SEED, "--seed", NULL, "N", "a whole number from 0 to 18446744073709551615",
      "seed of all randomness (0)" },
    { OPT_EXPOSURE, "--exposure", NULL, "X", "a number from 1e-9 to 1e9",
      "factor before the tone curve (1)" },
    { OPT_SHADOW_SIZE, "--shadow-size", NULL, "N", "a whole number from 1 to 8192",
      "texels along a side of direct light's shadow maps (2048; of 5 maps on 1024, of 25 on 512)" },
    { OPT_SHADOW_TAPS, "--shadow-taps", NULL, "N", "4 or 16",
      "texels that a lookup of direct light's shadows filters (4)" },
    { OPT_DEVICE, "--device", NULL, "N", "a whole number from 0 to 64",
      "the n-th device that 'afterglow info' lists; 0: the first that works" },
    { OPT_DEBUG, "--debug", NULL, "LIST",
      "some of poison,no-sharing,random-order,keep-all with commas between",
      "poison, no-sharing, random-order, keep-all: debug switches of the graph" },
    { OPT_NEEDS, "--needs", NULL, "all", "all",
      "all: nothing is left out for what the scene lacks" },
    { OPT_JSON, "--json", NULL, NULL, "", "print JSON" },
    { OPT_MERGE, "--merge", NULL, NULL, "", "join the reports in the folders given" },
    { OPT_UNSHADOWED, "--unshadowed-bounce", NULL, NULL, "",
      "every surface along a bounce ray counts, none hides another" },
    { OPT_BOUNCES, "--bounces", NULL, "N", "a whole number from 0 to 64",
      "transports from surface to surface; 0: direct light alone (1)" },
    { OPT_SPP, "--spp", NULL, "N", "a whole number from 1 to 1048576",
      "samples a pixel (64; report: its budget's)" },
    { OPT_THREADS, "--threads", NULL, "N", "a whole number from 0 to 1024", "0: all (0)" },
    { OPT_SHARD, "--shard", NULL, "I/N", "I/N with I from 1 to N, or 0 for N",
      "measure every N-th setting only, from the I-th on; 1/N to N/N are the whole" },
    { OPT_VERBOSE, "--verbose", "-v", NULL, "", "say more on stderr" },
    { OPT_HELP, "--help", "-h", NULL, "", "this text" },
};

static bool set_number(const char *text, long min, long max, int *out)
{
    long value;
    if (!parse_int(text, min, max, &value))
        return false;
    *out = (int) value;
    return true;
}

static bool set_text(const char *text, const char **out)
{
    *out = text;
    return *text != 0;
}

static bool set_exposure(options *o, const char *text)
{
    double value;
    if (!parse_double(text, 1e-9, 1e9, &value))
        return false;
    o->exposure = (float) value;
    return true;
}

static bool set_taps(const char *text, int *out)
{
    return set_number(text, 4, 16, out) && (*out == 4 || *out == 16);
}

static bool set_scale(const char *text, int *out)
{
    return set_number(text, 1, 4, out) && *out != 3;
}

static bool set_flag(bool *flag)
{
    *flag = true;
    return true;
}

static bool apply_number(options *o, option_id id, const char *v)
{
    switch (id) {
    case OPT_SIZE: return set_size(o, v);
    case OPT_FRAME: return set_number(v, 0, 1000000, &o->frame);
    case OPT_FRAMES: return set_number(v, 1, 1000000, &o->frames);
    case OPT_TIMING_FRAMES: return set_number(v, 1, 10000, &o->timing_frames);
    case OPT_SEED: return set_seed(o, v);
    case OPT_EXPOSURE: return set_exposure(o, v);
    case OPT_SHADOW_SIZE: return set_number(v, 1, 8192, &o->shadow_size);
    case OPT_SHADOW_TAPS: return set_taps(v, &o->shadow_taps);
    case OPT_RENDER_SCALE: return set_scale(v, &o->render_scale);
    case OPT_DEVICE: return set_number(v, 0, 64, &o->device);
    case OPT_BOUNCES: return set_number(v, 0, 64, &o->bounces);
    case OPT_SPP: return set_number(v, 1, 1048576, &o->spp);
    case OPT_THREADS: return set_number(v, 0, 1024, &o->threads);
    case OPT_SHARD: return set_shard(o, v);
    default: return false;
    }
}

static bool apply_word(options *o, option_id id, const char *v)
{
    switch (id) {
    case OPT_GI: return add_word(o->gi, &o->gi_count, CLI_MAX_GI, v);
    case OPT_SET: return add_word(o->set, &o->set_count, CLI_MAX_SET, v);
    case OPT_STUDY: return add_word(o->study, &o->study_count, CLI_MAX_STUDIES, v);
    case OPT_LAYER: return set_text(v, &o->layer);
    case OPT_FORMAT: return set_text(v, &o->format);
    case OPT_FILTER: return set_text(v, &o->filter);
    case OPT_BUDGET: return set_text(v, &o->budget);
    case OPT_OUTPUT: return set_text(v, &o->output);
    case OPT_STATS: return set_text(v, &o->stats);
    case OPT_TRACE: return set_text(v, &o->trace);
    case OPT_PLUGIN_DIR: return add_word(o->plugin_dir, &o->plugin_dir_count, CLI_MAX_FOLDERS, v);
    case OPT_SHADER_DIR: return set_text(v, &o->shader_dir);
    case OPT_PARAMS: return set_text(v, &o->params);
    case OPT_CAMERA: return set_text(v, &o->camera);
    case OPT_DEBUG: return set_debug(o, v);
    case OPT_NEEDS: return o->needs_all = !strcmp(v, "all");
    case OPT_JSON: return set_flag(&o->json);
    case OPT_MERGE: return set_flag(&o->merge);
    case OPT_UNSHADOWED: return set_flag(&o->unshadowed_bounce);
    case OPT_VERBOSE: return set_flag(&o->verbose);
    case OPT_HELP: return set_flag(&o->help);
    default: return apply_number(o, id, v);
    }
}

// ---- parsing ---------------------------------------------------------------------------------

// `list` has names with a space before and after each.
static bool listed(const char *list, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = list; at && (at = strstr(at, name)); at += length)
        if (at > list && at[-1] == ' ' && at[length] == ' ')
            return true;
    return false;
}

static bool takes(const command *cmd, const option *opt)
{
    return opt->id == OPT_HELP || opt->id == OPT_VERBOSE || listed(cmd->option_names, opt->name);
}

// The option called `word`, up to its '='.
static const option *find_option(const command *cmd, const char *word, const char **value)
{
    const size_t length = strcspn(word, "=");
    *value = word[length] ? word + length + 1 : NULL;
    for (int i = 0; i < FG_COUNT(table); ++i) {
        const option *opt = &table[i];
        const bool same = strlen(opt->name) == length && !strncmp(word, opt->name, length);
        if ((same || (opt->letter && !strcmp(word, opt->letter))) && takes(cmd, opt))
            return opt;
    }
    return NULL;
}

static int bad_value(cli *c, const option *opt, const char *value)
{
    return cli_fail(c, EXIT_USAGE, "%s: is '%s', must be %s", opt->name, value,
                    opt->rule[0] ? opt->rule : "a name that is not empty");
}

static int apply(cli *c, options *o, const option *opt, const char *value)
{
    const char *why = NULL;
    if (opt->id == OPT_CAMERA_AT) {
        why = parse_camera(value, o);
    } else if (opt->id == OPT_LIGHT) {
        if (o->light_count >= CLI_MAX_LIGHTS)
            return cli_fail(c, EXIT_USAGE, "--light: more than %d lights", CLI_MAX_LIGHTS);
        why = parse_light(value, &o->lights[o->light_count]);
        o->light_count += !why;
    } else if (!apply_word(o, opt->id, value)) {
        return bad_value(c, opt, value);
    }
    return why ? cli_fail(c, EXIT_USAGE, "%s: is '%s', %s", opt->name, value, why) : EXIT_DONE;
}

// Parses argv[*i] and, where it takes one, its value.
static int parse_option(cli *c, const command *cmd, char **argv, int *i, options *o)
{
    const char *value;
    const option *opt = find_option(cmd, argv[*i], &value);
    if (!opt)
        return cli_fail(c, EXIT_USAGE, "%s: unknown option; 'afterglow %s --help' lists them",
                        argv[*i], cmd->name);
    if (!opt->value)
        return value ? cli_fail(c, EXIT_USAGE, "%s: takes no value", opt->name)
                     : apply(c, o, opt, "");
    if (!value) {
        value = argv[*i + 1]; // argv ends at NULL
        if (!value || !strncmp(value, "--", 2))
            return cli_fail(c, EXIT_USAGE, "%s: its value %s is missing", opt->name, opt->value);
        ++*i;
    }
    return apply(c, o, opt, value);
}

int options_parse(cli *c, const command *cmd, int argc, char **argv, options *out)
{
    const char **operands = (const char **) argv;
    bool named = true;
    *out = (options){
        .operands = operands,
        .frame = -1,
        .bounces = -1,
        .spp = -1,
        .threads = 0,
        .exposure = 1,
    };
    for (int i = 0; i < argc; ++i) {
        if (named && !strcmp(argv[i], "--")) {
            named = false;
        } else if (named && argv[i][0] == '-' && argv[i][1]) {
            const int code = parse_option(c, cmd, argv, &i, out);
            if (code != EXIT_DONE)
                return code;
        } else {
            operands[out->operand_count++] = argv[i]; // never ahead of the word being read
        }
    }
    if (out->help)
        return EXIT_DONE;
    if (out->operand_count < cmd->min_operands)
        return cli_fail(c, EXIT_USAGE, "%s: %s is missing", cmd->name, cmd->operands);
    if (cmd->max_operands >= 0 && out->operand_count > cmd->max_operands)
        return cli_fail(c, EXIT_USAGE, "%s: one word too many", operands[cmd->max_operands]);
    return EXIT_DONE;
}

void options_help(FILE *f, const command *cmd)
{
    fprintf(f, "usage: afterglow %s [OPTION]...%s%s\n\n%s.\n", cmd->name,
            cmd->operands[0] ? " " : "", cmd->operands, cmd->summary);
    if (cmd->help)
        fprintf(f, "\n%s\n", cmd->help);
    fprintf(f, "\noptions:\n");
    for (int i = 0; i < FG_COUNT(table); ++i) {
        const option *opt = &table[i];
        char name[64];
        if (!takes(cmd, opt))
            continue;
        snprintf(name, sizeof name, "%s%s%s%s%s", opt->letter ? opt->letter : "",
                 opt->letter ? ", " : "", opt->name, opt->value ? " " : "",
                 opt->value ? opt->value : "");
        fprintf(f, "  %-24s", name);
        if (strlen(name) > 24)
            fprintf(f, "\n%26s", "");
        fprintf(f, " %s\n", opt->help);
    }
    if (listed(cmd->option_names, "--light"))
        fprintf(
            f,
            "\nLIGHT is one of\n"
            "  point:PX,PY,PZ:R,G,B\n"
            "  spot:PX,PY,PZ:DX,DY,DZ:R,G,B[:INNER,OUTER]   half angles in degrees (0,45)\n"
            "  spot:PX,PY,PZ:DX,DY,DZ:R,G,B:cosine          180 degrees, fading as the cosine\n"
            "  directional:DX,DY,DZ:R,G,B\n"
            "P is where it is (m), D the way its light goes, RGB W/sr (directional: W/m2).\n"
            "A scene in which nothing shines gets a point light at the camera, with a warning.\n");
}
