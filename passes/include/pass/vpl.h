// SPDX-License-Identifier: MIT
#ifndef PASS_VPL_H
#define PASS_VPL_H

#include <pass/rsm.h>

FG_BEGIN

typedef enum ag_vpl_pattern {
    AG_VPL_ALL = 0,    // one VPL a texel
    AG_VPL_REGULAR,    // the middle texel of each block
    AG_VPL_STRATIFIED, // a random texel of each block, the same every frame
} ag_vpl_pattern;

// Turns reflective shadow maps into a list of VPLs: passes "PREFIX.build" and "PREFIX.pack".
//
// Each block of texels makes one VPL. It sits on the texel that the pattern picks (or on the lit
// one nearest to it) and carries the block's summed flux and area, so that the energy does not
// depend on how many there are. Blocks without a lit texel make none; faces through which no light
// goes have no blocks.
//
// Shapes: vpls: ag_vpl[capacity] (pass/vpl_shared.h), valid ones first, in the order of faces and
//         rows; count: uvec4, x valid ones, y blocks.
// Errors: more blocks than a storage block of the device holds, or than 65535 x 256, fail the
//         graph: OpenGL's least is 2.8 million.
typedef struct ag_vpl_pass {
    const ag_gpu_scene *gpu;
    fg_res position, normal, flux, faces, table, blocks, groups;
    fg_res vpls, count;
    int capacity;
    int size, face_count; // of the maps
    ag_vpl_pattern pattern;
    int grid, budget;
    uint32_t seed;
    int total;                         // blocks of this frame
    int32_t rows[1 + AG_MAX_FACES][4]; // how they lie on the faces: passes/vpl/vpl_build.comp
} ag_vpl_pass;

typedef struct ag_vpl_desc {
    const char *prefix; // e.g. "rsm"
    ag_vpl_pattern pattern;
    int grid;      // blocks along every face's edge, a divisor of the RSM's size; 0: by `budget`
    int budget;    // > 0: VPLs of all faces together, split by ag_vpl_split()
    uint32_t seed; // of STRATIFIED
} ag_vpl_desc;     // ALL ignores grid and budget

FG_API void ag_vpl_declare(ag_vpl_pass *pass, fg_graph *g, const ag_rsm_pass *rsm,
                           const ag_vpl_desc *desc);

// Splits a budget of VPLs over faces by their power: `grid`[i] becomes the VPLs along an edge of
// face i, a power of two up to `most`; 0 where it has no power. Returns how many VPLs that makes.
//
// A face whose share of the power is below that of one VPL gets one, beyond the budget: a faint
// lamp takes none from the others. The rest get one, and then, as long as there is room, the face
// whose VPLs carry the most power gets four times as many; of equal ones the first. One face alone
// thus gets the largest power of four within the budget.
FG_API int64_t ag_vpl_split(const double *power, int faces, int64_t budget, int most, int *grid);

// Moves the valid VPLs of a list with holes to the front, keeping their order: pass "PREFIX.pack".
// Reads of `pass`: blocks, ag_vpl[total], area 0: a hole; groups: uint, valid ones of each 256;
// capacity, of vpls: valid ones at most; and, when it runs, total. Fills in vpls and count.
FG_API void ag_vpl_pack_declare(ag_vpl_pass *pass, fg_graph *g, const char *prefix);

// A VPL that the host makes, and the parallelogram that it stands for: its position is the middle.
typedef struct ag_vpl_patch {
    float position[3]; // render space
    float normal[3];   // unit, on the lit side
    float flux[3];     // reflected, W, never negative
    float area;        // m^2; 0 or less: no VPL
    float edges[2][3]; // m, in the plane of the normal
} ag_vpl_patch;

// As ag_vpl_declare()'s shaders would have written it; for buffers that the host fills.
struct ag_vpl; // pass/vpl_shared.h
FG_API void ag_vpl_from_host(const ag_vpl_patch *patch, struct ag_vpl *out);

// VPLs to look at: pass "PREFIX.vpls_layer", left out while nobody reads what it makes.
//
// Shapes: out RGBA16F of the frame's size: direct light through the tone curve, and a dot at each
//         VPL that is not hidden. A dot has its VPL's colour and an area in proportion to its flux,
//         but a radius of one pixel at least.
// Units:  display values in [0, 1].
typedef struct ag_vpl_dots_pass {
    const ag_gpu_scene *gpu;
    fg_res view, direct, depth, vpls, count;
    int capacity;
    fg_res out;
} ag_vpl_dots_pass;

typedef struct ag_vpl_dots_desc {
    const char *prefix;        // e.g. "isr"
    const ag_scene_res *scene; // read now, as all below
    const ag_gbuffer *gbuffer;
    fg_res direct; // RGBA32F, W/(m^2 sr)
} ag_vpl_dots_desc;

FG_API void ag_vpl_dots_declare(ag_vpl_dots_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                                const ag_vpl_pass *vpls, const ag_vpl_dots_desc *desc);

FG_END

#endif // PASS_VPL_H
