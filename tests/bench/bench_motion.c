// SPDX-License-Identifier: MIT
// Lights and cameras on their way, and pictures along it.
#include "bench.h"

#include <math.h>
#include <string.h>

motion motion_begin(const bench *b)
{
    const bool cornell = !strcmp(b->scene_name, "cornell");
    return (motion){
        .scene = b->scene,
        .by_itself = !cornell && (b->scene->features & AG_FEATURE_MOVING_LIGHT) != 0,
        .step = cornell ? 0.005 : 0.026,
        .light = b->scene->lights[0],
        .camera = b->scene->cameras[b->camera],
    };
}

// Whether an animation has moved the light.
static bool play(const motion *m, int frame)
{
    if (m->by_itself)
        ag_scene_set_time(m->scene, frame / 30.0);
    return m->by_itself;
}

fg_status motion_line(motion *m, int frame, double steps)
{
    ag_light light = m->light;
    if (play(m, frame))
        return FG_OK;
    light.position[0] += m->step * steps;
    return ag_scene_add_light(m->scene, &light);
}

// Two sines whose periods have no common multiple of a few hundred frames, so that the way does not
// repeat: 0.8 and 0.6 of a step a frame at most.
fg_status motion_round(motion *m, int frame)
{
    const double reach[2] = { 30 * m->step, 22 * m->step };
    const double x = sin(0.8 * m->step / reach[0] * frame),
                 z = sin(0.6 * m->step / reach[1] * frame + 1);
    ag_light light = m->light;
    if (play(m, frame))
        return FG_OK;
    light.position[0] += reach[0] * x;
    light.position[2] += reach[1] * z;
    light.direction[0] += 0.2f * (float) z;
    light.direction[2] += 0.2f * (float) x;
    return ag_scene_add_light(m->scene, &light);
}

fg_status motion_camera(motion *m, int frame)
{
    ag_camera camera = m->camera;
    const double way = 20 * m->step * sin(frame / 20.0);
    for (int k = 0; k < 3; k++)
        camera.world[12 + k] += way * camera.world[k];
    return ag_scene_add_camera(m->scene, &camera);
}

fg_status motion_end(motion *m)
{
    ag_scene_set_time(m->scene, 0);
    fg_status status = ag_scene_add_camera(m->scene, &m->camera);
    if (status == FG_OK && !m->by_itself)
        status = ag_scene_add_light(m->scene, &m->light);
    return status;
}

// ---- pictures --------------------------------------------------------------------------------

void changes_add(changes *c, const image picture[2], const image due[2])
{
    const size_t count = 3 * (size_t) picture->width * (size_t) picture->height;
    double excess = 0, change = 0;
    for (size_t i = 0; i < count; i++) {
        const double own = (double) picture[1].rgb[i] - (double) picture[0].rgb[i];
        const double expected = (double) due[1].rgb[i] - (double) due[0].rgb[i];
        excess += fabs(own - expected);
        change += fabs(own);
    }
    c->excess += excess / (double) count;
    c->change += change / (double) count;
    c->count++;
}
