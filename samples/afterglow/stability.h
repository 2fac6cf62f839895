// SPDX-License-Identifier: MIT
#ifndef STABILITY_H
#define STABILITY_H

#include "host.h"

// Stiff and extreme cases: a table of scenes and settings made by code, each with the figure that
// it yields and the bound that the figure must keep. In every frame of every case all that the
// graph writes is read back: a value that is not finite fails the case, as does a negative one
// in a buffer of light; transient textures are filled with NaN before they are written.

typedef struct stability {
    fg_log log; // errors are kept in `error`, nothing is printed
    char error[512];
    fg_device *device;
    const setting *setting; // the plugin at hand
    const gi_plugin *rsm;   // what gathers in full, to be held against; NULL: not there
    bool own_passes;        // check what the plugin's own passes write alone
    int frames;             // of the long cases
    int warnings;           // that came so far
    long bad;               // values that broke the rule in this case
    char where[128];        // the first of them
    bool poke, poked;       // put a NaN into the G-buffer, and check nothing
    double samples; // pixels or texels that gathered light, of the last picture; NAN: unknown
} stability;

// A frame to take. Zeros mean defaults.
typedef struct shot {
    ag_scene *scene;
    const ag_camera *camera; // NULL: the scene's
    int width, height;       // 0: 48
    int frames;              // 0: 1
    double time, step;       // seconds of the first frame, and from frame to frame
    renderer_layer layer;
    unsigned debug;
    const gi_value *values; // NULL: the setting's
} shot;

// A renderer with every check on, before its first frame. Errors as renderer_create().
FG_NODISCARD fg_status stability_open(stability *s, const shot *what, renderer **out);
// Renders with every check on. Errors as the renderer's. Counters come late: `samples` takes some
// frames.
FG_NODISCARD fg_status stability_render(stability *s, const shot *what, image *out);

typedef struct stability_case {
    int row; // of the list of stiff cases; 0: of none, a parameter at its end
    const char *name;
    const char *figure; // what is measured
    double bound;       // the figure may be at most this
    // Where the technique cannot keep the bound: why, and the size that must not grow. NULL: it
    // must.
    const char *known;
    double known_bound;
    // FG_ERR_UNSUPPORTED: the plugin has nothing to do with the case.
    fg_status (*run)(stability *s, double *measured);
} stability_case;

// End at a NULL name: where light and surfaces are odd, and where the frame is.
extern const stability_case stability_light_cases[], stability_frame_cases[],
    stability_hierarchy_cases[], stability_reuse_cases[], stability_change_cases[];

// The row of `vpls` in the plugin's table; -1: it has none.
int stability_find_vpls(const gi_plugin *p);
// The setting at hand with other values, "depth=0 share=0". FG_ERR_UNSUPPORTED: the plugin has no
// such parameter, or none of that range. The caller finishes `out`.
FG_NODISCARD fg_status stability_with(const stability *s, const char *values, setting *out);
// The same with those of the values that the plugin takes.
FG_NODISCARD fg_status stability_with_known(const stability *s, const char *values, setting *out);

// ---- figures ---------------------------------------------------------------------------------

size_t stability_values(const image *img); // 3 a pixel
double stability_mean(const image *img);
double stability_most(const image *img);
double stability_change(double a, double b); // |a - b| / |b|
long stability_differing(const image *a, const image *b);
// Relative RMSE of `a` against `b`.
FG_NODISCARD fg_status stability_rmse(stability *s, const image *a, const image *b, double *out);

// ---- scenes ----------------------------------------------------------------------------------

// A closed room of 1 m about the origin, its walls seen from inside, and a camera at +z.
typedef struct room {
    double scale;     // 0: 1
    double offset[3]; // metres, after scaling
    float albedo;     // 0: 0.6
    bool black;       // albedo 0
    bool block;       // a box on the floor
    bool block_goes;  // away at 0.5 s
    bool partition;   // a wall across at z = 0
    bool twice;       // every wall is there twice
    bool floor_alone;
    float emission;
    const ag_light *lights; // positions in rooms from its centre, intensities for a room of 1 m
    int light_count;
    int junk;         // 1: triangles that are to be dropped; 2: and slivers and inverted ones
    double travel[3]; // in rooms: the first light moves this far in 1 s
    bool jump;        // at once, at 0.5 s
} room;

FG_NODISCARD fg_status stability_room(const fg_log *log, const room *what, ag_scene **out);
// `count` x `count` boxes over a floor, of `cells` x `cells` x 2 triangles a side.
FG_NODISCARD fg_status stability_field(const fg_log *log, int count, int cells, ag_scene **out);
// One triangle under a lamp, facing the camera.
FG_NODISCARD fg_status stability_triangle(const fg_log *log, ag_scene **out);
ag_light stability_lamp(void); // a spot under the ceiling, 60 degrees, 1 W/sr

// A picture of a room, a figure of that picture, and the number of values that broke the rule.
typedef double (*stability_figure_fn)(const image *img);
FG_NODISCARD fg_status stability_shoot(stability *s, const room *what, shot view, image *out);
FG_NODISCARD fg_status stability_figure(stability *s, const room *what, shot view,
                                        stability_figure_fn figure, double *out);
FG_NODISCARD fg_status stability_checks(stability *s, const room *what, shot view, double *out);

// ---- reels -----------------------------------------------------------------------------------

// Frame after frame of a room, with what may change in between: host's and scene's.
typedef struct reel {
    stability *s;
    setting own;
    ag_scene *scene;
    renderer *r;
} reel;

// The setting at hand with those of `values` that the plugin knows; with all of them, or
// FG_ERR_UNSUPPORTED, if `all`. Whatever comes of it: the caller closes it.
FG_NODISCARD fg_status reel_open(stability *s, const room *what, shot view, const char *values,
                                 bool all, reel *out);
void reel_close(reel *r);
// `count` frames from `time` on, `step` seconds apart.
FG_NODISCARD fg_status reel_run(reel *r, double time, double step, int count);
// What the last frame's indirect light is.
FG_NODISCARD fg_status reel_picture(reel *r, image *out);
FG_NODISCARD fg_status reel_mean(reel *r, double *out);
// NAN: the plugin has none of that name.
double reel_counter(const reel *r, const char *name);
// The indirect light of a renderer's first frame, at `time`.
FG_NODISCARD fg_status reel_fresh(stability *s, const room *what, shot view, const char *values,
                                  double time, image *out);

#endif // STABILITY_H
