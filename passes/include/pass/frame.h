// SPDX-License-Identifier: MIT
#ifndef PASS_FRAME_H
#define PASS_FRAME_H

#include <fg/graph.h>
#include <pass/gpu_scene.h>
#include <pass/scene.h>

FG_BEGIN

// What every pass of a frame sees: the view, the scene on the GPU, the G-buffer.
//
// Render space: world axes, metres, origin at the camera. Every position on the GPU
// (G-buffer, RSM, VPLs, lights) is in render space, so that precision does not
// depend on where in the world the scene stands; host code adds `origin` back.

// The camera of one frame.
struct ag_view {
    int width, height;
    double origin[3];    // the eye in the world: render space = world - origin
    float view_proj[16]; // render space to clip; reversed Z, infinite far plane: depth is
                         // 1 at znear and 0 at infinity (orthographic: 0 at zfar)
    float inv_view_proj[16];
    float forward[3]; // unit
    float znear;
    bool orthographic;
};

// Errors: FG_ERR_INVALID: a size below 1, a field of view outside (0, pi), znear <= 0.
FG_API FG_NODISCARD fg_status ag_view_from_camera(const fg_log *log, const ag_camera *camera,
                                                  int width, int height, ag_view *out);

// Textures of the frame's size, in render space where it applies. Texel (0, 0) is the lower
// left corner as in OpenGL; captures flip.
typedef struct ag_gbuffer {
    fg_res depth;  // DEPTH32F, reversed Z, 0 where nothing is
    fg_res normal; // RGBA16F: xyz shading normal, unit, turned to the viewer; w 1, 0: nothing here
    fg_res position; // RGBA32F: xyz render space; w 1, 0: nothing here
    fg_res albedo;   // RGBA16F: diffuse albedo = base colour x (1 - metallic), [0, 1]; a unused
    fg_res face;     // RG16: the triangle's unit normal, turned to the viewer, octahedral
                     // (passes/shading/octahedral.glsl)
    fg_res material; // RGBA8: r metallic, g perceptual roughness, b unused. Null without GLOSSY.
    fg_res emissive; // RGBA32F: radiance, W/(m^2 sr). Null without EMISSIVE.
} ag_gbuffer;

FG_END

#endif // PASS_FRAME_H
