// SPDX-License-Identifier: MIT
#ifndef TEST_BUILTIN_H
#define TEST_BUILTIN_H

#include "test_mesh.h"

// What the tests of the built-in scenes share.

// Fails the test where the scene does not open or the log gets a line. ag_scene_destroy() it.
ag_scene *open_scene(const char *name);
mesh primitive_mesh(const ag_scene *s, int i); // borrows from the scene
double length3(const double v[3]);

#endif // TEST_BUILTIN_H
