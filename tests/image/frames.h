// SPDX-License-Identifier: MIT
#ifndef TEST_IMAGE_FRAMES_H
#define TEST_IMAGE_FRAMES_H

// Renderers that go on from frame to frame, small and with all layers of the host.

#include "fixture.h"

enum { W = 40, H = 24, MAX_VALUES = 64 };
enum { ALL_LAYERS = (1 << LAYER_COUNT) - 1 };

ag_scene *lit_room(void); // two boxes under a spot

// What is not given is as above; fails the test with what was said.
renderer *make_with(renderer_desc desc);
renderer *make(ag_scene *scene, const gi_plugin *plugin, const gi_value *values);
void run(renderer *r, double time);
image read_first(renderer *r, renderer_layer layer);
image read_second(renderer *r, renderer_layer layer);

// What a renderer that begins with the plugin shows first.
image fresh(ag_scene *scene, renderer_layer layer, const gi_plugin *plugin, const gi_value *values);
void same(image a, image b); // to the bit; frees both

// Defaults but for one assignment.
void set(const gi_plugin *p, gi_value *values, const char *assignment);

#endif // TEST_IMAGE_FRAMES_H
