// SPDX-License-Identifier: MIT
// Materials, textures, lights, cameras, animations and skins of glTF files.
#include "gltf_file.h"

#include <math.h>
#include <pass/surface.h>

// Floats of a few operations each.
#define TIGHT 1e-6
#define PNG "data:image/png;base64,"
// 2 x 1 texels: opaque red, half blue.
#define RED_BLUE                                                                                   \
    PNG "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAADklEQVR42mP4z8AAQg0AD3oDfmqBMeEAAAAASUVO" \
        "RK5CYII="

static const double pi = 3.14159265358979323846;

// ---- materials --------------------------------------------------------------------

static void materials_keep_factors_and_extensions(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = load_gltf(
        NULL,
        "\"materials\":[{\"name\":\"lamp\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,"
        "0.3,0.4],\"metallicFactor\":0.5,\"roughnessFactor\":0.25},\"emissiveFactor\":[1,0.5,0],"
        "\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":20}},"
        "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.7,\"doubleSided\":true},{}]",
        &l);
    const ag_material *m = &s->materials[0];
    assert_string_equal(m->name, "lamp");
    assert_near(m->base_color[2], 0.3, TIGHT);
    assert_near(m->base_color[3], 0.4, TIGHT);
    assert_true(m->metallic == 0.5f && m->roughness == 0.25f);
    assert_true(m->emissive[0] == 20 && m->emissive[1] == 10 && m->emissive[2] == 0);
    assert_true(m->alpha == AG_ALPHA_MASK && m->alpha_cutoff == 0.7f && m->double_sided);
    m = &s->materials[1]; // glTF's defaults
    assert_true(m->metallic == 1 && m->roughness == 1 && m->base_color[0] == 1);
    assert_true(m->alpha == AG_ALPHA_OPAQUE && !m->double_sided && m->base_color_tex.texture == -1);
    ag_scene_destroy(s);
}

static void unlit_and_blend_are_said_once_each(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = load_gltf(
        NULL,
        "\"materials\":[{\"extensions\":{\"KHR_materials_unlit\":{}}},{\"alphaMode\":\"BLEND\"},"
        "{\"alphaMode\":\"BLEND\"}]",
        &l);
    assert_int_equal(l.warnings, 2);
    assert_has(l.warning, "1 materials are unlit");
    assert_true(s->materials[0].metallic == 0 && s->materials[1].alpha == AG_ALPHA_OPAQUE);
    ag_scene_destroy(s);
}

static void textures_take_sampler_set_and_colour_space(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = load_gltf(
        NULL,
        "\"images\":[{\"uri\":\"" RED_BLUE "\"}],\"samplers\":[{\"magFilter\":9728,\"wrapS\":33071,"
        "\"wrapT\":33648}],\"textures\":[{\"source\":0,\"sampler\":0},{\"source\":0}],"
        "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":"
        "1}"
        ",\"metallicRoughnessTexture\":{\"index\":0}},\"emissiveTexture\":{\"index\":1}},"
        "{\"emissiveTexture\":{\"index\":1}}]",
        &l);
    assert_int_equal(s->texture_count, 3); // colours clamped, numbers clamped, colours repeated
    const ag_material *m = &s->materials[0];
    const ag_texture *base = &s->textures[m->base_color_tex.texture];
    assert_true(base->width == 2 && base->height == 1 && base->srgb && base->nearest);
    assert_true(base->wrap_u == AG_WRAP_CLAMP && base->wrap_v == AG_WRAP_MIRROR);
    assert_int_equal(m->base_color_tex.uv, 1);
    const uint8_t texels[8] = { 255, 0, 0, 255, 0, 0, 255, 128 };
    assert_memory_equal(base->rgba, texels, sizeof texels);
    assert_false(s->textures[m->metallic_roughness_tex.texture].srgb);
    const ag_texture *emissive = &s->textures[m->emissive_tex.texture];
    assert_true(emissive->srgb && !emissive->nearest && emissive->wrap_u == AG_WRAP_REPEAT);
    assert_memory_equal(emissive->rgba, texels, sizeof texels);
    assert_int_equal(s->materials[1].emissive_tex.texture, m->emissive_tex.texture);
    ag_scene_destroy(s);
}

// In the sample asset of the extension an arrow along the diagonal of a texture that is turned by
// 22.5 degrees points from the corner (0, 0) to (0.421, 1.016) of its square.
static void a_texture_transform_turns_as_the_extension_shows(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = load_gltf(
        NULL,
        "\"images\":[{\"uri\":\"" RED_BLUE "\"}],\"textures\":[{\"source\":0}],\"materials\":[{"
        "\"emissiveTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"rotation\":"
        "0.39269908169872414}}}},{\"emissiveTexture\":{\"index\":0,\"texCoord\":0,\"extensions\":{"
        "\"KHR_texture_transform\":{\"offset\":[3,4],\"scale\":[2,-1],\"texCoord\":1}}}}]",
        &l);
    const float *t = s->materials[0].emissive_tex.transform;
    // Two decimals of the asset's marker.
    assert_near(t[0] * 0.421f + t[1] * 1.016f + t[2], 0.7778, 1e-3);
    assert_near(t[3] * 0.421f + t[4] * 1.016f + t[5], 0.7778, 1e-3);
    t = s->materials[1].emissive_tex.transform;
    const double want[6] = { 2, 0, 3, 0, -1, 4 };
    for (int i = 0; i < 6; i++)
        assert_near(t[i], want[i], TIGHT);
    assert_int_equal(s->materials[1].emissive_tex.uv, 1);
    ag_scene_destroy(s);
}

static void images_in_views_are_decoded_and_unused_ones_left_alone(void **state)
{
    (void) state;
    static const uint8_t png[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
        0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0xf4,
        0x22, 0x7f, 0x8a, 0x00, 0x00, 0x00, 0x0e, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8,
        0xcf, 0xc0, 0x00, 0x42, 0x0d, 0x00, 0x0f, 0x7a, 0x03, 0x7e, 0x6a, 0x81, 0x31, 0xe1, 0x00,
        0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82,
    };
    bin b = { 0 };
    lines l;
    PUT_U8(&b, 1, 2, 3, 4);
    put(&b, png, sizeof png);
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":4,\"byteLength\":71}],\"images\":[{"
        "\"bufferView\":0,\"mimeType\":\"image/png\"},{\"uri\":\"missing.png\"}],\"textures\":[{"
        "\"source\":0},{\"source\":1}],\"materials\":[{\"emissiveTexture\":{\"index\":0}}]",
        &l);
    assert_int_equal(s->texture_count, 1);
    assert_true(s->textures[0].width == 2 && s->textures[0].rgba[3] == 255);
    ag_scene_destroy(s);
}

static void a_texture_without_an_image_is_left_out(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = load_gltf(
        NULL, "\"textures\":[{}],\"materials\":[{\"emissiveTexture\":{\"index\":0}}]", &l);
    assert_has(l.warning, "texture 0: it has no image");
    assert_int_equal(s->materials[0].emissive_tex.texture, -1);
    ag_scene_destroy(s);
}

// ---- lights and cameras -----------------------------------------------------------

static void lights_hang_on_nodes_and_look_along_minus_z(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = load_gltf(
        NULL,
        "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{"
        "\"lights\":[{\"name\":\"sun\",\"type\":\"directional\",\"color\":[1,0.5,0.25],"
        "\"intensity\":4},{\"type\":\"spot\",\"range\":9,\"spot\":{\"innerConeAngle\":0.2,"
        "\"outerConeAngle\":0.6}},{\"type\":\"spot\",\"spot\":{},\"extras\":{\"profile\":\"cosine\""
        "}},{\"type\":\"point\",\"range\":2}]}},\"nodes\":[{\"rotation\":[-0.70710678,0,0,"
        "0.70710678],\"scale\":[5,5,5],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
        "{\"translation\":[1,2,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}},"
        "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}},"
        "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":3}}}]",
        &l);
    assert_int_equal(s->light_count, 4);
    const ag_light *sun = &s->lights[0], *spot = &s->lights[1];
    assert_string_equal(sun->name, "sun");
    assert_true(sun->kind == AG_LIGHT_DIRECTIONAL && sun->intensity[1] == 2);
    assert_near(sun->direction[1], -1, TIGHT); // -Z turned by -90 degrees about X
    assert_true(spot->kind == AG_LIGHT_SPOT && !spot->cosine && spot->position[2] == 3);
    assert_near(spot->cos_inner, cos(0.2), TIGHT);
    assert_near(spot->cos_outer, cos(0.6), TIGHT);
    assert_true(s->lights[2].cosine);
    assert_near(s->lights[2].cos_outer, cos(pi / 4), TIGHT);
    assert_true(s->lights[3].kind == AG_LIGHT_POINT && s->lights[3].intensity[2] == 1);
    assert_int_equal(l.infos, 1);
    assert_has(l.info, "2 lights have a range; it is ignored");
    ag_scene_destroy(s);
}

static void cones_out_of_range_are_brought_into_it(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = load_gltf(
        NULL,
        "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"spot\":{"
        "\"innerConeAngle\":1,\"outerConeAngle\":0.5}},{\"type\":\"spot\",\"spot\":{"
        "\"outerConeAngle\":4}}]}},\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":"
        "0}"
        "}},{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}}]",
        &l);
    assert_int_equal(l.warnings, 2);
    assert_true(s->lights[0].cos_inner == s->lights[0].cos_outer);
    assert_near(s->lights[1].cos_outer, 0, TIGHT);
    ag_scene_destroy(s);
}

static void cameras_are_rigid_whatever_their_node_is_scaled_by(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = load_gltf(
        NULL,
        "\"cameras\":[{\"name\":\"main\",\"type\":\"perspective\",\"perspective\":{\"yfov\":0.9,"
        "\"znear\":0.2,\"zfar\":50}},{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":3,"
        "\"ymag\":2,\"znear\":0.5,\"zfar\":9}}],\"nodes\":[{\"camera\":0,\"translation\":[0,1,5],"
        "\"scale\":[3,3,-3]},{\"camera\":1}]",
        &l);
    assert_int_equal(s->camera_count, 2);
    const ag_camera *c = &s->cameras[ag_scene_find_camera(s, "main")];
    assert_true(!c->orthographic && c->yfov == 0.9f && c->znear == 0.2f && c->world[14] == 5);
    assert_near(c->world[10], -1, TIGHT); // the mirrored axis stays where it looks from
    assert_near(c->world[5], 1, TIGHT);
    assert_near(c->world[0], -1, TIGHT); // and the frame right-handed
    c = &s->cameras[1];
    assert_true(c->orthographic && c->half_height == 2 && c->znear == 0.5f && c->zfar == 9);
    ag_scene_destroy(s);
}

// ---- animations and skins ---------------------------------------------------------

static void animations_drive_their_nodes(void **state)
{
    (void) state;
    lines l;
    bin b = { 0 };
    PUT_FLOATS(&b, 0, 2);
    PUT_FLOATS(&b, 0, 0, 0, 4, 0, 0);
    PUT_U16(&b, 0, 0, 0, 32767, 0, 32767, 0, 0); // signed: no turn, then half a turn about Y
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\"},"
        "{\"bufferView\":0,\"byteOffset\":8,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":32,\"componentType\":5122,\"count\":2,\"type\":\"VEC4\","
        "\"normalized\":true}],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":"
        "\"directional\"}]}},\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
        "\"animations\":[{\"samplers\":[{\"input\":0,\"output\":1},{\"input\":0,\"output\":2,"
        "\"interpolation\":\"STEP\"}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"
        "\"translation\"}},{\"sampler\":1,\"target\":{\"node\":0,\"path\":\"rotation\"}},"
        "{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}},"
        "{\"sampler\":0,\"target\":{\"path\":\"translation\"}}]}]",
        &l);
    assert_true(s->duration == 2 && s->lights[0].moving);
    assert_has(l.warning, "1 animation channels");
    ag_scene_set_time(s, 1.5);
    assert_near(s->lights[0].position[0], 3, TIGHT);
    assert_near(s->lights[0].direction[2], -1, TIGHT);
    ag_scene_destroy(s);
}

static void of_two_animations_of_one_node_the_first_plays(void **state)
{
    (void) state;
    lines l;
    bin b = { 0 };
    PUT_FLOATS(&b, 0, 2, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 9, 0);
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":56}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\"},"
        "{\"bufferView\":0,\"byteOffset\":8,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":32,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}]"
        ","
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}],"
        "\"nodes\":[{\"camera\":0}],\"animations\":[{\"samplers\":[{\"input\":0,\"output\":1}],"
        "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}]},"
        "{\"samplers\":[{\"input\":0,\"output\":2}],\"channels\":[{\"sampler\":0,\"target\":{"
        "\"node\":0,\"path\":\"translation\"}}]}]",
        &l);
    ag_scene_set_time(s, 1);
    assert_true(s->cameras[0].world[12] == 2 && s->cameras[0].world[13] == 0);
    assert_int_equal(l.warnings, 1);
    ag_scene_destroy(s);
}

static void skins_put_their_vertices_into_the_world(void **state)
{
    (void) state;
    lines l;
    bin b = { 0 };
    PUT_FLOATS(&b, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    PUT_U8(&b, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0);         // joints
    PUT_U8(&b, 255, 0, 0, 0, 255, 0, 0, 0, 127, 127, 0, 0); // weights
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":60}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5121,\"count\":3,\"type\":\"VEC4\"},"
        "{\"bufferView\":0,\"byteOffset\":48,\"componentType\":5121,\"count\":3,\"type\":\"VEC4\","
        "\"normalized\":true}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}],\"skins\":[{\"joints\":[2,1]}],\"nodes\":[{\"mesh\":0,"
        "\"skin\":0,\"translation\":[50,50,50]},{\"translation\":[0,0,8]},{\"translation\":[4,0,0]}"
        "]",
        &l);
    assert_true(s->primitives[0].skinned);
    const double want[3][3] = { { 4, 0, 0 }, { 1, 0, 8 }, { 2, 1, 4 } };
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            assert_near(s->vertices[i].position[k], want[i][k], TIGHT);
    ag_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(materials_keep_factors_and_extensions),
        cmocka_unit_test(unlit_and_blend_are_said_once_each),
        cmocka_unit_test(textures_take_sampler_set_and_colour_space),
        cmocka_unit_test(a_texture_transform_turns_as_the_extension_shows),
        cmocka_unit_test(images_in_views_are_decoded_and_unused_ones_left_alone),
        cmocka_unit_test(a_texture_without_an_image_is_left_out),
        cmocka_unit_test(lights_hang_on_nodes_and_look_along_minus_z),
        cmocka_unit_test(cones_out_of_range_are_brought_into_it),
        cmocka_unit_test(cameras_are_rigid_whatever_their_node_is_scaled_by),
        cmocka_unit_test(animations_drive_their_nodes),
        cmocka_unit_test(of_two_animations_of_one_node_the_first_plays),
        cmocka_unit_test(skins_put_their_vertices_into_the_world),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
