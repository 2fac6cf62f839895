// SPDX-License-Identifier: MIT
// A host outside the tree: sees only the installed headers and libraries. Runs a graph on the null
// device, and finds the installed techniques.
#include <fg/device.h>
#include <gi/registry.h>

#include <stdio.h>
#include <string.h>

static fg_status run_pass(const fg_run *run, void *user)
{
    ++*(int *) user;
    return fg_run_pass(run) ? FG_OK : FG_ERR_INVALID;
}

static int run_graph(void)
{
    int runs = 0;
    fg_device *device = fg_null_create(&(fg_null_desc){ 0 });
    fg_graph *g = fg_graph_create(&(fg_graph_desc){ .device = device });
    fg_graph_begin(g, &(fg_frame_desc){ .width = 64, .height = 64 });
    const fg_res hdr = fg_texture(g, "hdr", &(fg_tex_desc){ 0 });
    const fg_pass_desc passes[] = {
        { .name = "sky", .writes = { { hdr } }, .run = run_pass, .user = &runs },
        { .name = "show",
          .reads = { { hdr } },
          .run = run_pass,
          .user = &runs,
          .effect = FG_EFFECT_EXTERNAL },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    const bool ran = fg_graph_compile(g) == FG_OK && fg_graph_run(g) == FG_OK;
    fg_graph_destroy(g);
    fg_device_destroy(device);
    return ran && runs == 2 ? 0 : 1;
}

int main(void)
{
    gi_registry *registry;
    if (run_graph() || gi_registry_create(&(gi_registry_desc){ 0 }, &registry))
        return 1;
    const gi_plugin *rsm = gi_find(registry, "rsm");
    printf("%s: %s\n", rsm ? rsm->name : "no rsm", rsm ? rsm->summary : "");
    const bool found = rsm && !strcmp(rsm->name, "rsm");
    gi_registry_destroy(registry);
    return found ? 0 : 1;
}
