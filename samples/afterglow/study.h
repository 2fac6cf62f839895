// SPDX-License-Identifier: MIT
#ifndef STUDY_H
#define STUDY_H

#include "batch.h"

// Studies: the figures of the papers, measured and drawn again in one run. A study is a row of a
// table: curves, each a plugin at a setting; a parameter that is swept along every curve; what
// pictures are compared with; what is drawn. In the report's document a study of a scene is
//
//   { "scene", "name", "title", "index", "x": { "parameter", "label" } or null, "baselines": [],
//     "points": [ run records with "curve", "x", "stages": [ { "stage", "ms" } ],
//                 "errors": [one per baseline; null where that could not be had; along a path the
//                            mean over the frames that are compared],
//                 along a path "path": { "seconds": [], "ms": [],
//                     "counters": { name: [] }, "errors": [one per baseline: []] }, with null where
//                     there is no figure of a frame } ] }

enum {
    STUDY_CURVES = 8,
    STUDY_VALUES = 12,
    STUDY_BASELINES = 3,
    STUDY_PANELS = 3,
    STUDY_COUNTERS = 4,
};

typedef struct study_curve {
    const char *setting; // "isr source=regular vpls=256": a plugin, then what is set
    const char *label;   // what the figure calls it
    double speed;        // along a path, of the animation's clock; 0: 1
    double scale;        // of the frame's edges; 0: 1
} study_curve;

typedef enum panel_kind {
    PANEL_NONE = 0,
    PANEL_LINES,  // over x
    PANEL_BARS,   // one group a curve, one bar a value of x
    PANEL_STAGES, // one bar a curve, stacked by stage
    PANEL_PATH,   // along the animation
} panel_kind;

enum { PANEL_MS = -1, PANEL_COUNTER = -2 };
typedef struct study_panel {
    panel_kind kind;
    int of; // all but STAGES: error against this baseline, PANEL_MS; PATH: PANEL_COUNTER
    const char *caption;
    const char *counter, *label; // of PANEL_COUNTER, and what the axis says
} study_panel;

// Frames along the scene's animation.
typedef struct study_path {
    int frames[2];   // quick, full; 0: no path
    double rate;     // frames a second of the animation; 0: the frames are once through all of it
    bool tour;       // what stands still is moved: see tour
    int compared[2]; // quick, full: frames with a picture that is compared, the last one among them
    const char *counters[STUDY_COUNTERS + 1]; // that are noted at every frame
} study_path;

// Arrays end at the first zero.
typedef struct study {
    const char *name; // as --study has it
    const char *title;
    study_curve curves[STUDY_CURVES + 1];
    const char *x, *x_label; // the parameter that is swept; NULL: none
    bool x_log;
    const char *values[STUDY_VALUES + 1];
    // The name of a truth; a setting as a curve's; "self KEY=VALUE...": the curve's but for that.
    const char *baselines[STUDY_BASELINES + 1];
    study_panel panels[STUDY_PANELS + 1];
    study_path path;
    bool joined; // scenes are rows of one table at the end of the page, too
} study;

extern const study studies[]; // ends at a NULL name
const study *study_find(const char *name);

typedef struct studies_desc {
    host *h;              // the scene is open
    const budget *budget; // of repetitions
    int width, height;
    bool full;
    const setting *plugins; // that are measured
    int plugin_count;
    const truths *truths; // NULL: none
    int scene_number;
    cJSON *doc;
} studies_desc;

// Wrong usage if --study names what is none.
int studies_check(cli *c, const options *o);
// Whether the study is to be run: full runs all, --study those it names and nothing else.
bool study_wanted(const options *o, bool full, const study *s);
bool studies_need_truths(const options *o, bool full);

// Runs what is wanted and this shard's, and appends to "studies" of the document. What cannot be
// had (a plugin, a parameter, an animation) is left out with a note.
FG_NODISCARD fg_status studies_measure(const studies_desc *d);

// Adds "stages": the passes of the record's plugin by what they are for, and as the first stage
// all else of the frame.
void study_add_stages(cJSON *record);
extern const char *const study_stages[]; // ends at NULL
double study_stage_ms(const cJSON *point, const char *stage);
// Whether any point spends time there.
bool study_has_stage(const cJSON *points, const char *stage);
// Of a point: the technique's own stages but for the reflective shadow maps, which all share.
double study_own_ms(const cJSON *point);

// ---- along a path ----------------------------------------------------------------------------

// Where light and camera are. What does not move by itself is moved, both to come back after 8 s:
// the camera turns 0.15 rad to either side, the first light, where none moves, goes around a level
// circle an eighth as wide as the scene (a directional one turns 0.2 rad to either side).
typedef struct tour {
    host *h;
    bool on; // else the scene's own animation alone
    bool moves_light, moves_camera;
    ag_light light;
    ag_camera camera;
    double radius; // m
} tour;

tour tour_begin(host *h, bool on);
// Before renderer_frame(r, time).
FG_NODISCARD fg_status tour_pose(const tour *t, renderer *r, double time);
FG_NODISCARD fg_status tour_end(const tour *t); // all is where it was

// ---- pictures of errors ----------------------------------------------------------------------

// What a study's pictures are compared with, by setting; each is rendered once a scene.
typedef struct baselines {
    const studies_desc *d;
    char **keys;
    image *pictures; // without pixels where it could not be had
    int count;
} baselines;

void baselines_finish(baselines *b);
// The picture of baseline `text`, at `time` of the tour, for a point: the curve's setting with `x`
// set to `value`. NULL where it cannot be had, with a note.
FG_NODISCARD fg_status baselines_get(baselines *b, const tour *t, double time, const char *text,
                                     const char *setting, const image **out);
// The truth of that name; -1: none.
int study_truth(const char *name);
// The plugin at "PLUGIN KEY=VALUE...". False where that cannot be had, with a note.
bool study_setting(const studies_desc *d, const char *text, setting *out);

// Relative RMSE of an entry of "errors": over the maximum, or over RMS and without the noise of the
// truth, where it was compared with one. NAN for null.
double study_error(const cJSON *error, bool over_max);

// ---- writing ---------------------------------------------------------------------------------

// The file of a panel without its ending, below the report's folder.
void study_stem(char *out, size_t size, const cJSON *item, int panel);
FG_NODISCARD fg_status study_plots(const fg_log *log, const char *folder, cJSON *doc);
// The studies of a scene; `prefix` goes before the ids of its pictures.
FG_NODISCARD fg_status study_html(FILE *f, const fg_log *log, const char *folder, const cJSON *doc,
                                  const char *scene, const char *prefix);
// Tables of all scenes, of the studies that are joined.
void study_tables_html(FILE *f, const cJSON *doc);

#endif // STUDY_H
