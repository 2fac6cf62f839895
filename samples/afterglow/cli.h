// SPDX-License-Identifier: MIT
#ifndef CLI_H
#define CLI_H

#include "reference.h"
#include "renderer.h"

#include <stdio.h>

// The command line: tables of commands and of options, and the rule that every failure is one
// line `afterglow: error: WHAT: WHY` on stderr and an exit code.

typedef enum exit_code {
    EXIT_DONE = 0,
    EXIT_FAILED = 1,
    EXIT_USAGE = 2,
    EXIT_INPUT = 3,
} exit_code;

enum {
    CLI_MAX_GI = 32,
    CLI_MAX_SET = 64,
    CLI_MAX_LIGHTS = 16,
    CLI_MAX_STUDIES = 16,
    CLI_MAX_FOLDERS = 16,
    CLI_MAX_SIZE = 32768
};

typedef struct options {
    const char *const *operands; // what stands without a name; borrowed from argv
    int operand_count;
    const char *gi[CLI_MAX_GI];
    int gi_count;
    const char *set[CLI_MAX_SET]; // "key=value" or "plugin.key=value"
    int set_count;
    const char *study[CLI_MAX_STUDIES];
    int study_count;
    int width, height;                            // 0: not given
    int frame;                                    // -1: not given
    int frames;                                   // 0: not given
    int timing_frames;                            // 0: not given
    int shadow_size, shadow_taps;                 // 0: not given
    const char *layer, *format, *filter, *budget; // NULL: not given
    const char *plugin_dir[CLI_MAX_FOLDERS + 1];  // ends at NULL
    int plugin_dir_count;
    const char *output, *stats, *trace, *shader_dir, *camera, *params;
    int render_scale; // 0: not given; 1, 2 or 4
    bool camera_at_given;
    double eye[3], target[3], fov; // degrees
    ag_light lights[CLI_MAX_LIGHTS];
    int light_count;
    uint64_t seed;
    float exposure;
    int device;
    unsigned debug; // fg_debug bits
    bool needs_all, json, merge, unshadowed_bounce, verbose, help;
    int bounces, spp, threads; // -1: not given
    int shard, shards;         // [1, shards]; shards 0: not given
} options;

// The one error line. The first message wins: it is the nearest to the cause.
typedef struct cli {
    fg_log log; // what libraries are given
    char error[1024];
    bool verbose;
} cli;

void cli_init(cli *c);
// Notes the error, if there is none yet, and returns `code`.
int cli_fail(cli *c, int code, const char *fmt, ...) FG_PRINTF(3, 4);
void cli_warn(const char *fmt, ...) FG_PRINTF(1, 2);
// Turns an error that was noted into a warning: the work goes on without.
void cli_forgive(cli *c);
// The exit code of a library's failure: FG_ERR_INPUT is input refused, the rest failed.
int cli_status(cli *c, fg_status status);
// Prints the line that was noted, if `code` is a failure. Returns `code`.
int cli_end(cli *c, int code);
// Shows "what: 42 %" on a terminal; a fraction of 1 or more ends the line.
void cli_progress(const char *what, double fraction);
// Writes `text` to the file `path`, or to stdout if `path` is NULL.
int cli_print(cli *c, const char *path, const char *text);

// ---- tables ----------------------------------------------------------------------------------

typedef struct command {
    const char *name;
    const char *operands; // "SCENE", "[SCENE]...", "A B"; "" for none
    const char *summary;
    const char *help;         // NULL or further lines
    const char *option_names; // " --gi --size ": those it takes besides the common ones
    int min_operands, max_operands;
    int (*run)(cli *c, const options *o);
} command;

extern const command command_render, command_sequence, command_reference, command_compare,
    command_report, command_stability, command_graph, command_view, command_plugins, command_scenes,
    command_info;

// What an option name stands for.
#define OPTIONS_SCENE " --camera --camera-at --light "
#define OPTIONS_GPU " --device --shader-dir --plugin-dir --debug "
#define OPTIONS_FRAME " --gi --set --size --seed --exposure --shadow-size --shadow-taps --needs "

// Parses the words after the command's name. EXIT_DONE or EXIT_USAGE.
int options_parse(cli *c, const command *cmd, int argc, char **argv, options *out);
void options_help(FILE *f, const command *cmd);

// Parts of option values, for tests too. Each is the whole of `text` or false.
bool parse_int(const char *text, long min, long max, long *out);
bool parse_double(const char *text, double min, double max, double *out);
// `count` numbers separated by commas.
bool parse_list(const char *text, int count, double *out);
// NULL, or why `text` is no light.
const char *parse_light(const char *text, ag_light *out);
const char *parse_camera(const char *text, options *out);

#endif // CLI_H
