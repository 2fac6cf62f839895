// SPDX-License-Identifier: MIT
#ifndef TEST_IMAGE_FIXTURE_H
#define TEST_IMAGE_FIXTURE_H

// A headless device for one test program, small scenes and frames of them.

#include "renderer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

// cmocka group setup and teardown. Teardown fails if OpenGL reported an error meanwhile.
int device_setup(void **state);
int device_teardown(void **state);
fg_device *device(void);

// Where all messages of a test go; errors are kept for asserting on. Cleared by log_clear().
const fg_log *test_log(void);
const char *log_text(void);
const char *warnings_text(void); // likewise
void log_clear(void);

// A room of `edge` metres about `centre`, open to nobody: six diffuse walls seen from inside.
typedef struct room_desc {
    double edge; // 0: 1
    double centre[3];
    float albedo[6][3]; // -x +x -y +y -z +z; all zero: 0.5
    bool boxes;         // two blocks on the floor
} room_desc;

// At the origin, looking along -z, 1.5 radians up and down.
ag_camera plain_camera(const char *name);

// A builder with the room in it and a camera at its +z wall that looks along -z.
ag_builder *room_builder(const room_desc *desc);
// `light`'s position is in edges from the centre. NULL: no light.
ag_scene *room_scene(const room_desc *desc, const ag_light *light);
ag_scene *finish_scene(ag_builder *b);

// A spot under the middle of the ceiling that looks down, in edges.
ag_light ceiling_spot(float outer_degrees);

// One quad with corners p, p + u, p + u + v, p + v; its normal is u x v.
void add_quad(ag_builder *b, int material, const double p[3], const double u[3], const double v[3]);

// Power in W of a spot within its cone, by quadrature.
double spot_power(const ag_light *light);

const gi_plugin *plugin_named(const char *name);
const gi_plugin *plugin_rsm(void);

// What a frame wrote under one name: float rgba of a texture's layers in turn, or a buffer's bytes.
typedef struct capture {
    const char *resource; // "rsm.flux"
    float *texels;        // or
    void *bytes;
    size_t size; // bytes of either
    int width, height, layers;
} capture;

// A frame as render_layer() makes it, with what it wrote on the way; `captures` ends at a NULL
// name.
image render_captured(ag_scene *scene, int width, int height, renderer_layer layer,
                      const char *const *settings, capture *captures);
void captures_finish(capture *captures);

// The same with any plugin (NULL: none); what follows the first four may be left zero.
typedef struct shot {
    ag_scene *scene;
    int width, height;
    renderer_layer layer;
    const gi_plugin *plugin;
    const char *const *settings; // "key=value", NULL ends
    capture *captures;           // ends at a NULL name
    int shadow_size, shadow_taps;
} shot;
image shot_take(const shot *s);

// One frame with the settings ("key=value", NULL ends); fails the test if it does not succeed.
image render_layer(ag_scene *scene, int width, int height, renderer_layer layer,
                   const gi_plugin *plugin, const char *const *settings);

// A sphere of radius 1 m about the origin, seen from inside: `rings` x 2 `rings` quads with smooth
// normals, and a point light of 1 W/sr in the middle. The camera stands at the centre.
ag_scene *sphere_scene(int rings, float albedo);

double image_mean(const image *img); // over all channels

// Whether floats are the same to the bit: NaN may equal NaN, -0 is not 0.
bool same_bits(const void *a, const void *b, size_t size);

#endif // TEST_IMAGE_FIXTURE_H
