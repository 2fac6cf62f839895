// SPDX-License-Identifier: MIT
// What well-formed glTF files become.
#include "gltf_file.h"

#include <math.h>

// Floats of a few operations each.
#define TIGHT 1e-6

#define MESH_OF(attributes)                                                                        \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{" attributes "}}]}],"                           \
    "\"nodes\":[{\"mesh\":0}]"
#define TRIANGLE 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f
#define POSITIONS "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}"

static bin triangle(void)
{
    bin b = { 0 };
    PUT_FLOATS(&b, TRIANGLE);
    return b;
}

static void assert_floats(const float *is, int n, const double *want)
{
    for (int i = 0; i < n; i++)
        assert_near(is[i], want[i], TIGHT);
}

// ---- geometry ---------------------------------------------------------------------

static void a_triangle_without_indices_or_normals_is_flat(void **state)
{
    (void) state;
    lines l;
    bin b = triangle();
    ag_scene *s = load_gltf(&b,
                            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                            "\"accessors\":[" POSITIONS "]," MESH_OF("\"POSITION\":0"),
                            &l);
    assert_string_equal(s->name, "test");
    assert_int_equal(s->vertex_count, 3);
    assert_floats(s->vertices[1].position, 3, (const double[]){ 1, 0, 0 });
    assert_floats(s->vertices[1].normal, 3, (const double[]){ 0, 0, 1 });
    assert_floats(s->vertices[1].color, 4, (const double[]){ 1, 1, 1, 1 });
    // glTF's default material is a metal.
    assert_true(s->materials[0].metallic == 1 && l.infos == 1);
    ag_scene_destroy(s);
}

static void interleaved_vertices_are_read_by_their_stride(void **state)
{
    (void) state;
    lines l;
    bin b = { 0 };
    for (int i = 0; i < 3; i++) {
        PUT_FLOATS(&b, (float) (i == 1), (float) (i == 2), 5);
        PUT_FLOATS(&b, 0, 0, -1);
        PUT_FLOATS(&b, (float) i, 0.5f);
    }
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":96,\"byteStride\":32}],\"accessors\":"
        "[" POSITIONS ",{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":3,"
        "\"type\":\"VEC3\"},{\"bufferView\":0,\"byteOffset\":24,\"componentType\":5126,"
        "\"count\":3,\"type\":\"VEC2\"}]," MESH_OF("\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_1\":2"),
        &l);
    assert_floats(s->vertices[2].position, 3, (const double[]){ 0, 1, 5 });
    assert_floats(s->vertices[2].normal, 3, (const double[]){ 0, 0, -1 });
    assert_floats(s->vertices[2].uv[1], 2, (const double[]){ 2, 0.5 });
    assert_floats(s->vertices[2].uv[0], 2, (const double[]){ 0, 0 });
    ag_scene_destroy(s);
}

static void sparse_accessors_replace_elements(void **state)
{
    (void) state;
    for (int with_base = 0; with_base < 2; with_base++) {
        lines l;
        bin b = triangle();
        PUT_U16(&b, 0, 2);
        PUT_FLOATS(&b, 7, 7, 7, 3, 4, 5);
        char body[1024];
        snprintf(body, sizeof body,
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36"
                 ",\"byteLength\":4},{\"buffer\":0,\"byteOffset\":40,\"byteLength\":24}],"
                 "\"accessors\":[{%s\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\""
                 ":{\"count\":2,\"indices\":{\"bufferView\":1,\"componentType\":5123},\"values\":{"
                 "\"bufferView\":2}}}]," MESH_OF("\"POSITION\":0"),
                 with_base ? "\"bufferView\":0," : "");
        ag_scene *s = load_gltf(&b, body, &l);
        assert_floats(s->vertices[0].position, 3, (const double[]){ 7, 7, 7 });
        assert_floats(s->vertices[1].position, 3, (const double[]){ with_base, 0, 0 });
        assert_floats(s->vertices[2].position, 3, (const double[]){ 3, 4, 5 });
        ag_scene_destroy(s);
    }
}

static void integers_are_normalised_where_it_is_said(void **state)
{
    (void) state;
    lines l;
    bin b = { 0 };
    const int16_t positions[9] = { 0, 0, 0, 100, 0, 0, 0, -50, 0 };
    const int8_t normals[12] = { 0, 0, 127, 0, 0, 0, -128, 0, 0, 127, 0, 0 }; // 4 apart
    put(&b, positions, sizeof positions);
    PUT_U8(&b, 0, 0);
    put(&b, normals, sizeof normals);
    PUT_U8(&b, 255, 0, 51, 255, 255, 0, 51, 0, 255, 0, 51, 0);
    PUT_U16(&b, 65535, 0, 0, 65535, 0, 0);
    ag_scene *s = load_gltf(
        &b,
        "\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
        "\"extensionsRequired\":[\"KHR_mesh_quantization\"],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":18},{\"buffer\":0,\"byteOffset\":20,"
        "\"byteLength\":12,\"byteStride\":4},{\"buffer\":0,\"byteOffset\":32,\"byteLength\":12},"
        "{\"buffer\":0,\"byteOffset\":44,\"byteLength\":12}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5122,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5120,\"count\":3,\"type\":\"VEC3\",\"normalized\":"
        "true},"
        "{\"bufferView\":2,\"componentType\":5121,\"count\":3,\"type\":\"VEC4\",\"normalized\":"
        "true},"
        "{\"bufferView\":3,\"componentType\":5123,\"count\":3,\"type\":\"VEC2\",\"normalized\":"
        "true}"
        "]," MESH_OF("\"POSITION\":0,\"NORMAL\":1,\"COLOR_0\":2,\"TEXCOORD_0\":3"),
        &l);
    assert_floats(s->vertices[1].position, 3, (const double[]){ 100, 0, 0 });
    assert_floats(s->vertices[2].position, 3, (const double[]){ 0, -50, 0 });
    assert_floats(s->vertices[0].normal, 3, (const double[]){ 0, 0, 1 });
    assert_floats(s->vertices[1].normal, 3, (const double[]){ 0, 0, -1 });
    assert_floats(s->vertices[0].color, 4, (const double[]){ 1, 0, 0.2, 1 });
    assert_floats(s->vertices[0].uv[0], 2, (const double[]){ 1, 0 });
    assert_floats(s->vertices[1].uv[0], 2, (const double[]){ 0, 1 });
    assert_true(s->features & AG_FEATURE_VERTEX_COLOR);
    ag_scene_destroy(s);
}

static void strips_and_fans_keep_their_winding(void **state)
{
    (void) state;
    // A square around the origin: as a strip in Z order, as a fan in a circle.
    const float strip[] = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0 };
    const float fan[] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 };
    for (int mode = 5; mode <= 6; mode++) {
        lines l;
        bin b = { 0 };
        put(&b, mode == 5 ? strip : fan, sizeof strip);
        PUT_U8(&b, 0, 1, 2, 3);
        char body[512];
        snprintf(body, sizeof body,
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":"
                 "48,\"byteLength\":4}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
                 "\"count\":4,\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5121,"
                 "\"count\":4,\"type\":\"SCALAR\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                 "\"POSITION\":0},\"indices\":1,\"mode\":%d}]}],\"nodes\":[{\"mesh\":0}]",
                 mode);
        ag_scene *s = load_gltf(&b, body, &l);
        assert_int_equal(s->index_count, 6);
        for (size_t i = 0; i < s->vertex_count; i++) // all wound counter-clockwise
            assert_floats(s->vertices[i].normal, 3, (const double[]){ 0, 0, 1 });
        ag_scene_destroy(s);
    }
}

static void points_and_lines_are_left_out_with_one_warning(void **state)
{
    (void) state;
    lines l;
    bin b = triangle();
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[" POSITIONS "],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0},{\"attributes\":"
        "{"
        "\"POSITION\":0},\"mode\":3},{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]",
        &l);
    assert_int_equal(s->instance_count, 1);
    assert_int_equal(l.warnings, 1);
    assert_has(l.warning, "2 primitives of points or lines are left out");
    ag_scene_destroy(s);
}

static void a_primitive_without_positions_is_left_out(void **state)
{
    (void) state;
    lines l;
    bin b = triangle();
    ag_scene *s = load_gltf(&b,
                            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                            "\"accessors\":[" POSITIONS "]," MESH_OF("\"NORMAL\":0"),
                            &l);
    assert_int_equal(s->instance_count, 0);
    assert_has(l.warning, "mesh 0 primitive 0: it has no POSITION");
    ag_scene_destroy(s);
}

static void morph_targets_take_the_weights_at_rest(void **state)
{
    (void) state;
    lines l;
    bin b = triangle();
    PUT_FLOATS(&b, 0, 0, 0, 0, 0, 8, 0, 0, 0);
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
        "\"byteLength\":36}],\"accessors\":[" POSITIONS ",{\"bufferView\":1,\"componentType\":5126,"
        "\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"weights\":[0.25],\"primitives\":[{"
        "\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1}]}]}],"
        "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"weights\":[0.5]}]",
        &l);
    assert_int_equal(s->instance_count, 2);
    const double z[] = { 2, 4 };
    for (int i = 0; i < 2; i++) {
        const ag_primitive *p = &s->primitives[s->instances[i].primitive];
        assert_near(s->vertices[p->first_vertex + 1].position[2], z[i], TIGHT);
    }
    ag_scene_destroy(s);
}

static void primitives_that_share_vertices_take_only_theirs(void **state)
{
    (void) state;
    lines l;
    bin b = { 0 };
    for (int i = 0; i < 30; i++)
        PUT_FLOATS(&b, (float) i, (float) (i * i), 0);
    PUT_U8(&b, 27, 28, 29, 0, 1, 2);
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":360},{\"buffer\":0,\"byteOffset\":360,"
        "\"byteLength\":6}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":30,"
        "\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5121,\"count\":3,\"type\":"
        "\"SCALAR\"},{\"bufferView\":1,\"byteOffset\":3,\"componentType\":5121,\"count\":3,\"type\""
        ":\"SCALAR\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}"
        ",{\"attributes\":{\"POSITION\":0},\"indices\":2}]}],\"nodes\":[{\"mesh\":0}]",
        &l);
    assert_int_equal(s->vertex_count, 6);
    assert_true(s->primitives[0].box_min[0] == 27 && s->primitives[1].box_max[0] == 2);
    ag_scene_destroy(s);
}

// ---- nodes and scenes -------------------------------------------------------------

static void only_the_default_scene_is_shown(void **state)
{
    (void) state;
    lines l;
    bin b = triangle();
    // Nodes in an order where children come first; node 0 belongs to the other scene.
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[" POSITIONS "],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0},"
        "{\"mesh\":0,\"translation\":[0,1,0]},{\"children\":[1],\"scale\":[2,2,2]}],"
        "\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"name\":\"second\",\"nodes\":[2]}]",
        &l);
    assert_int_equal(s->instance_count, 1);
    assert_true(s->instances[0].world[13] == 2);
    ag_scene_destroy(s);
}

static void a_scale_of_zero_hides_a_node(void **state)
{
    (void) state;
    lines l;
    bin b = triangle();
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[" POSITIONS "],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"nodes\":[{\"mesh\":0,\"scale\":[0,0,0]},{\"mesh\":0}]",
        &l);
    assert_int_equal(s->instance_count, 1);
    ag_scene_destroy(s);
}

static void a_chain_of_many_nodes_is_no_trouble(void **state)
{
    (void) state;
    enum { DEPTH = 50000 };
    char *text = malloc((size_t) DEPTH * 32 + 100);
    assert_non_null(text);
    int n = sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"translation\":[1,0,0]}");
    for (int i = 1; i < DEPTH; i++) // node i holds node i - 1
        n += sprintf(text + n, ",{\"children\":[%d]}", i - 1);
    n += sprintf(text + n, "]}");
    write_file("chain.gltf", text, (size_t) n);
    free(text);
    lines l;
    ag_scene *s = load("chain.gltf", &l);
    assert_non_null(s);
    ag_scene_destroy(s);
}

static void integers_written_as_floats_are_read(void **state)
{
    (void) state;
    lines l;
    bin b = triangle();
    PUT_FLOATS(&b, TRIANGLE);
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0.0,\"byteOffset\":36.0,\"byteLength\":36.00}],\"accessors\":"
        "["
        "{\"bufferView\":0,\"componentType\":5126.0,\"count\":3.0,\"type\":\"VEC3\",\"name\":"
        "\"v1.0\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0.0}}]}],"
        "\"nodes\":[{\"mesh\":0.0,\"translation\":[1.50,2.0,10.05]}]",
        &l);
    assert_int_equal(s->instance_count, 1);
    const double *w = s->instances[0].world;
    assert_true(w[12] == 1.5 && w[13] == 2 && w[14] == 10.05);
    ag_scene_destroy(s);
}

static void a_glb_loads_and_unknown_chunks_are_passed_over(void **state)
{
    (void) state;
    const char json[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[" POSITIONS
        "]," MESH_OF("\"POSITION\":0") "}   ";
    bin b = { 0 };
    uint32_t json_size = (uint32_t) (sizeof json - 1) & ~3u;
    const uint32_t header[5] = { 0x46546c67, 2, 12 + 8 + json_size + 8 + 36 + 8 + 4, json_size,
                                 0x4e4f534a };
    const uint32_t bin_header[2] = { 36, 0x004e4942 }, other[3] = { 4, 0x12345678, 0 };
    put(&b, header, sizeof header);
    put(&b, json, json_size);
    put(&b, bin_header, sizeof bin_header);
    PUT_FLOATS(&b, TRIANGLE);
    put(&b, other, sizeof other);
    write_file("test.glb", b.bytes, b.size);
    lines l;
    ag_scene *s = load("test.glb", &l);
    assert_non_null(s);
    assert_int_equal(s->index_count, 3);
    ag_scene_destroy(s);
}

static void files_beside_are_read_with_their_escapes(void **state)
{
    (void) state;
    lines l;
    bin b = triangle();
    mkdir(path_of("my data"), 0700);
    write_file("my data/a.bin", b.bytes, b.size);
    write_gltf(NULL, "\"buffers\":[{\"byteLength\":36,\"uri\":\"my%20data/a.bin\"}],"
                     "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                     "\"accessors\":[" POSITIONS "]," MESH_OF("\"POSITION\":0"));
    ag_scene *s = load("test.gltf", &l);
    assert_non_null(s);
    assert_int_equal(s->index_count, 3);
    ag_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_triangle_without_indices_or_normals_is_flat),
        cmocka_unit_test(interleaved_vertices_are_read_by_their_stride),
        cmocka_unit_test(sparse_accessors_replace_elements),
        cmocka_unit_test(integers_are_normalised_where_it_is_said),
        cmocka_unit_test(strips_and_fans_keep_their_winding),
        cmocka_unit_test(points_and_lines_are_left_out_with_one_warning),
        cmocka_unit_test(a_primitive_without_positions_is_left_out),
        cmocka_unit_test(morph_targets_take_the_weights_at_rest),
        cmocka_unit_test(primitives_that_share_vertices_take_only_theirs),
        cmocka_unit_test(only_the_default_scene_is_shown),
        cmocka_unit_test(a_scale_of_zero_hides_a_node),
        cmocka_unit_test(a_chain_of_many_nodes_is_no_trouble),
        cmocka_unit_test(integers_written_as_floats_are_read),
        cmocka_unit_test(a_glb_loads_and_unknown_chunks_are_passed_over),
        cmocka_unit_test(files_beside_are_read_with_their_escapes),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
