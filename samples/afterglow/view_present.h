// SPDX-License-Identifier: MIT
#ifndef VIEW_PRESENT_H
#define VIEW_PRESENT_H

#include "image.h"

#include <fg/gl.h>

// Layers drawn into the window, encoded as a PNG of them is.

typedef struct view_presenter {
    unsigned samplers[2], vao; // OpenGL's names; samplers: nearest, linear
} view_presenter;

void view_presenter_create(view_presenter *p);
void view_presenter_finish(view_presenter *p); // accepts a zeroed one

// One side of what is shown; texture 0: black.
typedef struct view_picture {
    uint32_t texture;
    bool whole; // of the frame: fills the window. Else it keeps its own proportions
} view_picture;

typedef struct view_present_desc {
    view_picture left, right;
    int width, height; // of the window, pixels
    double divider;    // of the width: where the right one begins; 1: nowhere
    bool data;         // as IMAGE_DATA
    double origin[3];  // added to what is there: of positions in render space, else 0
} view_present_desc;

// Leaves framebuffer 0 bound, without blending, depth test and sRGB encoding by the driver.
FG_NODISCARD fg_status view_present(const view_presenter *p, fg_device *device,
                                    const view_present_desc *desc);

// The window as it is drawn, for image_write() with IMAGE_DATA. Waits for the GPU.
FG_NODISCARD fg_status view_present_read(const fg_log *log, int width, int height, image *out);

#endif // VIEW_PRESENT_H
