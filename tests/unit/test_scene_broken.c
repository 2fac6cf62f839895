// SPDX-License-Identifier: MIT
// Broken files: each is refused with one line that names the file and the fault. Where
// AFTERGLOW_SCENES names a folder, every glTF file below it loads or is refused like that.
#include "gltf_file.h"

#include <ftw.h>
#include <math.h>

typedef struct broken {
    const char *body, *fault;
} broken;

#define VIEW "\"bufferViews\":[{\"buffer\":0,\"byteLength\":64}]"
#define FLOATS(count, type)                                                                        \
    "{\"bufferView\":0,\"componentType\":5126,\"count\":" #count ",\"type\":\"" type "\"}"
#define POSITIONS FLOATS(3, "VEC3")
#define MESH(members) "\"meshes\":[{\"primitives\":[{" members "}]}]"
#define CURVES                                                                                     \
    "\"nodes\":[{}]," VIEW ",\"accessors\":[" FLOATS(2, "SCALAR") "," FLOATS(2, "VEC3") "]"

static const broken cases[] = {
    // Buffers and views.
    { "\"bufferViews\":[{\"buffer\":3,\"byteLength\":4}]",
      "bufferView 0: buffer 3 does not exist (there are 1)" },
    { "\"bufferViews\":[{\"buffer\":-7,\"byteLength\":4}]", "buffer -7 does not exist" },
    { "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":60,\"byteLength\":8}]",
      "bufferView 0: bytes 60 to 60 + 8 are not within the buffer's 64" },
    { "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":18446744073709551612,\"byteLength\":8}]",
      "are not within the buffer's 64" },
    // Accessors.
    { VIEW ",\"accessors\":[" FLOATS(6, "VEC3") "]",
      "accessor 0: 6 elements of 12 bytes from byte 0 on reach beyond bufferView 0, which has 64" },
    { VIEW ",\"accessors\":[" FLOATS(18446744073709551615, "VEC3") "]", "accessor 0: its count" },
    { VIEW ",\"accessors\":[" FLOATS(0, "VEC3") "]", "accessor 0: its count must be 1" },
    { "\"accessors\":[{\"bufferView\":1,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"}]",
      "accessor 0: bufferView 1 does not exist (there are 0)" },
    { VIEW ",\"accessors\":[{\"bufferView\":0,\"componentType\":5130,\"count\":1,\"type\":"
           "\"SCALAR\"}]",
      "its componentType is none of glTF's" },
    { "\"accessors\":[{\"componentType\":5126,\"count\":4000000000,\"type\":\"VEC3\"}]",
      "its count is absurd for one without a bufferView" },
    { "\"bufferViews\":[{\"buffer\":0,\"byteLength\":64,\"byteStride\":4}],\"accessors\":"
      "[" POSITIONS "]",
      "elements of 12 bytes at a stride of 4" },
    { VIEW ",\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{"
           "\"count\":2,\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{"
           "\"bufferView\":0}}}]",
      "accessor 0: sparse indices must increase, below the count" },
    { VIEW ",\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{"
           "\"count\":1,\"indices\":{\"bufferView\":5,\"componentType\":5121},\"values\":{"
           "\"bufferView\":0}}}]",
      "sparse indices' bufferView 5 does not exist" },
    // Meshes.
    { MESH("\"attributes\":{\"POSITION\":4}"), "POSITION: accessor 4 does not exist" },
    { VIEW ",\"accessors\":[" POSITIONS
           "," FLOATS(2, "VEC3") "]," MESH("\"attributes\":{\"POSITION\":0,\"NORMAL\":1}"),
      "mesh 0 primitive 0: POSITION has 3 elements, other attributes have 2" },
    { VIEW ",\"accessors\":[" FLOATS(3, "VEC2") "]," MESH("\"attributes\":{\"POSITION\":0}"),
      "POSITION is of a type that it may not have" },
    { VIEW ",\"accessors\":[" POSITIONS "]," MESH("\"attributes\":{\"POSITION\":0},\"material\":2"),
      "mesh 0: material 2 does not exist" },
    { VIEW ",\"accessors\":[" POSITIONS "]," MESH("\"attributes\":{\"POSITION\":0},\"mode\":9"),
      "its mode does not exist" },
    { VIEW ",\"accessors\":[" POSITIONS "]," MESH("\"attributes\":{\"POSITION\":0},\"indices\":0"),
      "indices must be unsigned SCALAR" },
    { VIEW ",\"accessors\":[" POSITIONS "," FLOATS(2, "VEC3") "]," MESH(
          "\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1}]"),
      "POSITION has 2 elements, other attributes have 3" },
    { VIEW ",\"accessors\":[" POSITIONS ",{\"bufferView\":0,\"byteOffset\":40,\"componentType\":"
           "5121,\"count\":3,\"type\":\"SCALAR\"}]," MESH(
               "\"attributes\":{\"POSITION\":0},\"indices\":1") ",\"nodes\":[{\"mesh\":0}]",
      "mesh 0 primitive 0: index 1 is 9, there are 3 vertices" },
    // Nodes and scenes.
    { "\"nodes\":[{\"mesh\":1}]", "node 0: mesh 1 does not exist (there are 0)" },
    { "\"nodes\":[{\"children\":[2]}]", "node 0: child 2 does not exist" },
    { "\"nodes\":[{\"children\":[-1]}]", "node 0: a child's index is negative" },
    { "\"nodes\":[{\"children\":[0]}]", "nodes: 1 of 1 are their own ancestors" },
    { "\"nodes\":[{\"children\":[1]},{\"children\":[2]},{\"children\":[0]}]",
      "nodes: 3 of 3 are their own ancestors" },
    { "\"nodes\":[{\"children\":[2]},{\"children\":[2]},{}]", "node 2: it is a child twice" },
    { "\"nodes\":[{\"translation\":[1,2]}]", "node 0: translation has 2 numbers, must have 3" },
    { "\"nodes\":[{\"matrix\":[1]}]", "node 0: matrix has 1 numbers, must have 16" },
    { "\"nodes\":[{\"camera\":0}]", "node 0: camera 0 does not exist" },
    { "\"nodes\":[{\"skin\":0}]", "node 0: skin 0 does not exist" },
    { "\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]",
      "node 0: light 0 does not exist" },
    { "\"nodes\":[{}],\"scenes\":[{\"nodes\":[1]}]", "scene 0: node 1 does not exist" },
    { "\"scene\":1,\"scenes\":[{}]", "scene: 1 does not exist" },
    { "\"nodes\":[{}],\"skins\":[{\"joints\":[3]}]", "skin 0: joint 3 does not exist" },
    { "\"skins\":[{\"joints\":[]}]", "skin 0: it has no joints" },
    // Looks.
    { "\"textures\":[{\"source\":2}]", "texture 0: image 2 does not exist" },
    { "\"textures\":[{\"sampler\":0}]", "texture 0: sampler 0 does not exist" },
    { "\"materials\":[{\"emissiveTexture\":{\"index\":1}}]",
      "material 0: texture 1 does not exist" },
    { "\"materials\":[{\"name\":\"two\\nlines\",\"emissiveFactor\":[-1,0,0]}]",
      "material 'two lines': emission is -1" },
    { "\"images\":[{\"uri\":\"data:image/png;base64,AAAAAAAAAAAA\"}],\"textures\":[{\"source\":0}],"
      "\"materials\":[{\"emissiveTexture\":{\"index\":0}}]",
      "image 0 '': it is neither PNG nor JPEG" },
    { "\"images\":[{\"uri\":\"data:image/"
      "png;base64,iVBORw0KGgoAAAANSUhEUgAATiAAAAABCAYAAAA7tJ6OAAAA"
      "CUlEQVR4nGMAAAABAAFe/335AAAAAElFTkSuQmCC\"}],\"textures\":[{\"source\":0}],\"materials\":[{"
      "\"emissiveTexture\":{\"index\":0}}]",
      "it is larger than 16384 texels a side" },
    // 16384 x 16384 twice, as colours and as numbers: 512 M texels.
    { "\"images\":[{\"uri\":\"data:image/"
      "png;base64,iVBORw0KGgoAAAANSUhEUgAAQAAAAEAACAAAAACMo09YAAAA"
      "CUlEQVR4nGMAAAABAAFe/335AAAAAElFTkSuQmCC\"}],\"textures\":[{\"source\":0}],\"materials\":[{"
      "\"emissiveTexture\":{\"index\":0},\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{"
      "\"index\":0}}}]",
      "all textures together have too many texels" },
    { "\"images\":[{\"uri\":\"gone.png\"}],\"textures\":[{\"source\":0}],\"materials\":[{"
      "\"emissiveTexture\":{\"index\":0}}]",
      "image 0 'gone.png': URI 'gone.png' cannot be read: No such file" },
    { "\"images\":[{\"uri\":\"../up.png\"}],\"textures\":[{\"source\":0}],\"materials\":[{"
      "\"emissiveTexture\":{\"index\":0}}]",
      "URI '../up.png' leaves the file's folder" },
    { "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":4,\"znear\":1}}],\"nodes\":"
      "[{\"camera\":0}]",
      "camera 0 '': field of view must be in (0, pi)" },
    { "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"moon\"}]}},\"nodes\":[{"
      "\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]",
      "light 0: type 'moon' does not exist" },
    { "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":-2}]}"
      "}"
      ",\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]",
      "intensity is negative" },
    // Animations.
    { CURVES ",\"animations\":[{\"samplers\":[{\"input\":0,\"output\":9}],\"channels\":[]}]",
      "animation 0: output accessor 9 does not exist" },
    { CURVES ",\"animations\":[{\"samplers\":[{\"input\":1,\"output\":1}],\"channels\":[]}]",
      "animation 0: a sampler's input must be float SCALAR" },
    { CURVES
      ",\"animations\":[{\"samplers\":[{\"input\":0,\"output\":1}],\"channels\":[{\"sampler\":"
      "1,\"target\":{\"node\":0,\"path\":\"scale\"}}]}]",
      "animation 0: sampler 1 does not exist" },
    { CURVES
      ",\"animations\":[{\"samplers\":[{\"input\":0,\"output\":1}],\"channels\":[{\"sampler\":"
      "0,\"target\":{\"node\":4,\"path\":\"scale\"}}]}]",
      "animation 0: target node 4 does not exist" },
    { CURVES
      ",\"animations\":[{\"samplers\":[{\"input\":0,\"output\":1}],\"channels\":[{\"sampler\":"
      "0,\"target\":{\"node\":0,\"path\":\"rotation\"}}]}]",
      "animation 0: an output's type is not that of its path" },
    { CURVES ",\"animations\":[{\"samplers\":[{\"input\":0,\"output\":1,\"interpolation\":"
             "\"CUBICSPLINE\"}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"
             "\"scale\"}}]}]",
      "animation 0: a sampler's output has not one value a key" },
    { CURVES
      ",\"animations\":[{\"samplers\":[{\"input\":0,\"output\":1,\"interpolation\":\"WOBBLE\""
      "}],\"channels\":[]}]",
      "interpolation 'WOBBLE' does not exist" },
    // The file as a whole.
    { "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]",
      "extension 'KHR_draco_mesh_compression' is required and not supported" },
    { "\"nodes\":[{\"translation\":[1e999,0,0]}]", "glTF: " },
    { "\"nodes\":[", "glTF: " },
};

static void broken_files_are_refused_by_name_and_fault(void **state)
{
    (void) state;
    bin b = { .bytes = { [40] = 0, 9, 0 }, .size = 64 };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        lines l;
        write_gltf(&b, cases[i].body);
        ag_scene *s = load("test.gltf", &l);
        if (s)
            fail_msg("loaded: %s", cases[i].body);
        assert_has(l.error, cases[i].fault);
    }
}

static void uris_that_leave_the_folder_are_refused(void **state)
{
    (void) state;
    const broken uris[] = {
        { "../a.bin", "leaves the file's folder" },
        { "a/../../b.bin", "leaves the file's folder" },
        { "..", "leaves the file's folder" },
        { "%2e%2e/a.bin", "leaves the file's folder" },
        { "a\\\\..\\\\b.bin", "leaves the file's folder" },
        { "/etc/hostname", "is absolute" },
        { "file:///etc/hostname", "has a scheme" },
        { "http://example.org/a.bin", "has a scheme" },
        { "data:application/unknown;base64,AAAA", "is data of a kind that is not read" },
        { "a%00.bin", "has a NUL in it" },
        { "gone.bin", "cannot be read: No such file" },
        { ".", "is not a regular file" },
    };
    for (int i = 0; i < FG_COUNT(uris); i++) {
        char body[256];
        lines l;
        snprintf(body, sizeof body, "\"buffers\":[{\"byteLength\":4,\"uri\":\"%s\"}]",
                 uris[i].body);
        write_gltf(NULL, body);
        assert_null(load("test.gltf", &l));
        assert_has(l.error, uris[i].fault);
    }
}

static void what_is_no_file_is_refused(void **state)
{
    (void) state;
    lines l;
    assert_null(load("nothing.gltf", &l));
    assert_has(l.error, "cannot be read: No such file");
    mkdir(path_of("folder.gltf"), 0700);
    assert_null(load("folder.gltf", &l));
    assert_has(l.error, "is not a regular file");
    assert_int_equal(mkfifo(path_of("pipe.gltf"), 0600), 0);
    assert_null(load("pipe.gltf", &l)); // and nobody waits for a writer
    assert_has(l.error, "is not a regular file");
    write_file("empty.gltf", "", 0);
    assert_null(load("empty.gltf", &l));
    assert_has(l.error, "0 bytes");
}

static void deep_nesting_is_refused_before_it_is_parsed(void **state)
{
    (void) state;
    enum { DEPTH = 100000 };
    char *text = malloc((size_t) 2 * DEPTH + 100);
    assert_non_null(text);
    int n = sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"extras\":");
    assert_in_range(n, 1, 99);
    memset(text + n, '[', DEPTH);
    memset(text + n + DEPTH, ']', DEPTH);
    text[n + 2 * DEPTH] = '}';
    write_file("deep.gltf", text, (size_t) n + (size_t) 2 * DEPTH + 1);
    free(text);
    lines l;
    assert_null(load("deep.gltf", &l));
    assert_has(l.error, "nested more than 200 deep");
}

// A few hundred bytes must not ask for hours or gigabytes: a thousand primitives of one index
// accessor that lies about nothing, 64 k indices each.
static void many_uses_of_one_accessor_are_bounded(void **state)
{
    (void) state;
    char *text = malloc(1 << 20);
    assert_non_null(text);
    int n = sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"accessors\":[{\"componentType\":5126,"
                          "\"count\":64000,\"type\":\"VEC3\"}],\"nodes\":[{\"mesh\":0}],"
                          "\"meshes\":[{\"primitives\":[");
    for (int i = 0; i < 1000; i++)
        n += sprintf(text + n, "%s{\"attributes\":{\"POSITION\":0}}", i ? "," : "");
    n += sprintf(text + n, "]}]}");
    write_file("many.gltf", text, (size_t) n);
    free(text);
    lines l;
    assert_null(load("many.gltf", &l));
    assert_has(l.error, "more elements are more than a file of this size may have");
}

static void positions_that_are_not_finite_cost_only_their_triangles(void **state)
{
    (void) state;
    lines l;
    bin b = { 0 };
    PUT_FLOATS(&b, 0, 0, 0, 1, 0, 0, 0, 1, 0, NAN, 0, 0, INFINITY, 0, 0, 0, 5, 0);
    ag_scene *s = load_gltf(
        &b,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":72}],\"accessors\":[" FLOATS(
            6, "VEC3") "]," MESH("\"attributes\":{\"POSITION\":0}") ",\"nodes\":[{\"mesh\":0}]",
        &l);
    assert_int_equal(s->index_count, 3);
    assert_has(l.warning, "1 triangles with non-finite vertices are dropped");
    ag_scene_destroy(s);
}

// ---- .glb -------------------------------------------------------------------------

static void set32(uint8_t *at, uint32_t v)
{
    memcpy(at, &v, sizeof v);
}

static void broken_containers_are_refused(void **state)
{
    (void) state;
    const char json[] = "{\"asset\":{\"version\":\"2.0\"}}   "; // 32 bytes
    uint8_t sound[12 + 8 + 32 + 8 + 4] = { 0 };
    set32(sound, 0x46546c67);
    set32(sound + 4, 2);
    set32(sound + 8, sizeof sound);
    set32(sound + 12, 32);
    set32(sound + 16, 0x4e4f534a);
    memset(sound + 20, ' ', 32);
    memcpy(sound + 20, json, sizeof json - 1);
    set32(sound + 52, 4);
    set32(sound + 56, 0x004e4942);
    const struct {
        size_t at;
        uint32_t value;
        size_t size;
        const char *fault;
    } faults[] = {
        { 4, 1, sizeof sound, "GLB: version 1, must be 2" },
        { 8, 1000, sizeof sound, "its header says 1000 bytes, there are 64" },
        { 8, 60, 60, "chunk 1: 4 bytes, the file has only 0 more" },
        { 12, 0xfffffff0, sizeof sound, "chunk 0: 4294967280 bytes, the file has only 44 more" },
        { 16, 0x004e4942, sizeof sound, "the first chunk and no other must be JSON" },
        { 56, 0x4e4f534a, sizeof sound, "the first chunk and no other must be JSON" },
        { 8, 12, 12, "it has no JSON chunk" },
        { 8, 56, 56, "chunk 1: its header is cut off" },
    };
    lines l;
    write_file("test.glb", sound, sizeof sound);
    ag_scene *s = load("test.glb", &l);
    assert_non_null(s);
    ag_scene_destroy(s);
    for (int i = 0; i < FG_COUNT(faults); i++) {
        uint8_t copy[sizeof sound];
        memcpy(copy, sound, sizeof sound);
        set32(copy + faults[i].at, faults[i].value);
        write_file("test.glb", copy, faults[i].size);
        assert_null(load("test.glb", &l));
        assert_has(l.error, faults[i].fault);
    }
}

// Every length of a sound file but its own.
static void truncated_files_are_refused(void **state)
{
    (void) state;
    bin b = { .size = 64 };
    static uint8_t text[4096];
    write_gltf(&b, VIEW ",\"accessors\":[" POSITIONS "]," MESH("\"attributes\":{\"POSITION\":0}"));
    FILE *file = fopen(path_of("test.gltf"), "rb");
    assert_non_null(file);
    size_t size = fread(text, 1, sizeof text, file);
    assert_int_equal(fclose(file), 0);
    for (size_t n = 0; n < size; n++) {
        lines l;
        write_file("cut.gltf", text, n);
        assert_null(load("cut.gltf", &l));
    }
}

// ---- files of others ----------------------------------------------------------------

static int loaded, refused;

static int load_found(const char *path, const struct stat *info, int type, struct FTW *at)
{
    (void) info;
    (void) at;
    const char *dot = strrchr(path, '.');
    if (type != FTW_F || !dot || (strcmp(dot, ".gltf") != 0 && strcmp(dot, ".glb") != 0))
        return 0;
    lines l;
    fg_log log = log_to(&l);
    ag_scene *scene;
    fg_status status = ag_scene_load(&log, path, &scene);
    loaded += status == FG_OK;
    refused += status == FG_ERR_INPUT;
    if (status != FG_OK && (status != FG_ERR_INPUT || scene || l.errors != 1))
        fail_msg("%s: status %d, %d error lines", path, (int) status, l.errors);
    if (status == FG_OK)
        ag_scene_set_time(scene, scene->duration / 3);
    ag_scene_destroy(status == FG_OK ? scene : NULL);
    return 0;
}

static void files_of_others_load_or_are_refused_with_one_line(void **state)
{
    (void) state;
    const char *folder = getenv("AFTERGLOW_SCENES");
    // Without the variable this walks over what the tests above have left.
    assert_int_equal(nftw(folder ? folder : gltf_folder, load_found, 16, FTW_PHYS), 0);
    assert_true(loaded + refused > 0);
    print_message("%d loaded, %d refused\n", loaded, refused);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_files_are_refused_by_name_and_fault),
        cmocka_unit_test(uris_that_leave_the_folder_are_refused),
        cmocka_unit_test(what_is_no_file_is_refused),
        cmocka_unit_test(deep_nesting_is_refused_before_it_is_parsed),
        cmocka_unit_test(many_uses_of_one_accessor_are_bounded),
        cmocka_unit_test(positions_that_are_not_finite_cost_only_their_triangles),
        cmocka_unit_test(broken_containers_are_refused),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(files_of_others_load_or_are_refused_with_one_line),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
