// SPDX-License-Identifier: MIT
#ifndef TEST_IMAGE_GL_STATE_H
#define TEST_IMAGE_GL_STATE_H

#include <stdbool.h>
#include <stddef.h>

// All of a context's state that OpenGL 4.5 core can be asked for, as far as a host could have set
// it.

enum { GL_STATE_MAX = 4096 };

typedef struct gl_state_item {
    char name[56]; // "GL_BLEND", "GL_SAMPLER_BINDING[3]"
    double value[4];
} gl_state_item;

typedef struct gl_state {
    int count;
    gl_state_item items[GL_STATE_MAX];
} gl_state;

void gl_state_take(gl_state *s);
const gl_state_item *gl_state_find(const gl_state *s, const char *name); // fails the test if absent
bool gl_state_same(const gl_state_item *a, const gl_state_item *b);

// Sets everything to what no library would: objects bound to every target and unit, the other value
// of every switch, functions, masks and pixel transfer that would spoil a picture.
void gl_state_scramble(void);
// Back to what a new context has, and the objects deleted.
void gl_state_clean(void);

#endif // TEST_IMAGE_GL_STATE_H
