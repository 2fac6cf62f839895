// SPDX-License-Identifier: MIT
#include "frames.h"

ag_scene *lit_room(void)
{
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    return room_scene(&room, &light);
}

renderer *make_with(renderer_desc desc)
{
    renderer *r = NULL;
    desc.log = test_log();
    desc.device = device();
    desc.width = desc.width ? desc.width : W;
    desc.height = desc.height ? desc.height : H;
    desc.layers = desc.layers ? desc.layers : ALL_LAYERS;
    log_clear();
    if (renderer_create(&desc, &r))
        fail_msg("%s", log_text());
    return r;
}

renderer *make(ag_scene *scene, const gi_plugin *plugin, const gi_value *values)
{
    return make_with((renderer_desc){ .scene = scene, .plugin = plugin, .values = values });
}

void run(renderer *r, double time)
{
    if (renderer_frame(r, time))
        fail_msg("%s", log_text());
}

image read_first(renderer *r, renderer_layer layer)
{
    image img = { 0 };
    if (renderer_read(r, layer, &img) || !img.rgb)
        fail_msg("%s", log_text());
    return img;
}

image read_second(renderer *r, renderer_layer layer)
{
    image img = { 0 };
    if (renderer_second_read(r, layer, &img) || !img.rgb)
        fail_msg("%s", log_text());
    return img;
}

image fresh(ag_scene *scene, renderer_layer layer, const gi_plugin *plugin, const gi_value *values)
{
    renderer *r = make(scene, plugin, values);
    run(r, 0);
    assert_null(renderer_fault(r));
    image img = read_first(r, layer);
    renderer_destroy(r);
    return img;
}

void same(image a, image b)
{
    assert_int_equal(a.width, b.width);
    assert_int_equal(a.height, b.height);
    assert_true(same_bits(a.rgb, b.rgb, sizeof(float) * 3 * (size_t) a.width * (size_t) a.height));
    image_finish(&a);
    image_finish(&b);
}

void set(const gi_plugin *p, gi_value *values, const char *assignment)
{
    assert_true(gi_params_count(p) <= MAX_VALUES);
    gi_params_default(p, values);
    assert_int_equal(gi_params_set(test_log(), p, values, assignment), FG_OK);
}
