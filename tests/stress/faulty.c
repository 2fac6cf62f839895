// SPDX-License-Identifier: MIT
// Plugins with one fault each, by FAULT: some that the stability table has to find, and some that
// cost them their place in the frame.
#include <gi/plugin.h>

#include <math.h>

#define SOUND 0
#define NOT_FINITE 1
#define NEGATIVE 2
#define CHANGING 3
#define UNWRITTEN 4
#define BROKEN 5     // its declaration
#define UPDATELESS 6 // fails in update
#define FAILING 7    // a pass fails
#define REACHING 8   // a pass touches what it did not declare
#define LATE 9       // a pass fails in the third frame
#define UNSTARTED 10 // fails in create

static int created; // what makes one run differ from the next
static uint64_t frame_index;
static fg_res stranger;

static fg_status create(const gi_env *env, const gi_value *values, void **self)
{
    (void) values;
    *self = FAULT == UNSTARTED ? NULL : &created;
    ++created;
    if (FAULT == UNSTARTED)
        fg_logf(env->log, FG_LOG_ERROR, FAULT_NAME ": it is too cold");
    return FAULT == UNSTARTED ? FG_ERR_UNSUPPORTED : FG_OK;
}

static fg_status update(void *self, const gi_frame *frame)
{
    (void) self;
    frame_index = frame->index;
    return FAULT == UPDATELESS ? FG_ERR_IO : FG_OK;
}

static fg_status run(const fg_run *r, void *user)
{
    (void) user;
    if (FAULT == REACHING)
        fg_run_object(r, stranger);
    return FAULT == FAILING || (FAULT == LATE && frame_index >= 2) ? FG_ERR_DEVICE : FG_OK;
}

static void declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    (void) self;
    (void) in;
    const fg_res light =
        fg_texture(g, FAULT_NAME ".indirect", &(fg_tex_desc){ .format = FG_RGBA32F });
    const float value = FAULT == NOT_FINITE ? INFINITY
                        : FAULT == NEGATIVE ? -1
                        : FAULT == CHANGING ? (float) created
                                            : 0.5f;
    const fg_pass_desc pass = {
        .name = FAULT_NAME ".fill",
        .reads = { { FAULT == BROKEN ? light : in->gbuffer.position } },
        .writes = { { light, .load = FAULT == UNWRITTEN ? FG_LOAD_DISCARD : FG_LOAD_CLEAR,
                      .clear = { value, value, value, 1 } } },
        .run = run,
    };
    fg_passes(g, &pass, 1);
    stranger = in->gbuffer.normal;
    out->indirect = light;
    out->layers[0] = light;
}

static void destroy(void *self)
{
    (void) self;
}

static const gi_param no_params[] = { { .name = NULL } };
static const gi_layer layers[] = { { "light", "what it makes" }, { NULL } };
static const gi_plugin plugin = {
    .abi = GI_PLUGIN_ABI,
    .name = FAULT_NAME,
    .source = "none",
    .summary = "for tests",
    .params = no_params,
    .layers = layers,
    .create = create,
    .update = update,
    .declare = declare,
    .destroy = destroy,
};

FG_API const gi_plugin *gi_plugin_entry(void);
const gi_plugin *gi_plugin_entry(void)
{
    return &plugin;
}
