// SPDX-License-Identifier: MIT
#include "gltf_bridge.h"

#include <climits>
#include <new>

#include <tiny_gltf.h>

static int count_of(size_t n)
{
    if (n > INT_MAX)
        throw std::bad_alloc();
    return static_cast<int>(n);
}

template <typename T> static T *make(gltf_model *m, size_t n)
{
    void *items = gltf_model_alloc(m, n, sizeof(T));
    if (!items)
        throw std::bad_alloc();
    return static_cast<T *>(items);
}

static gltf_ints ints(const std::vector<int> &v)
{
    return { v.data(), count_of(v.size()) };
}

static gltf_numbers numbers(const std::vector<double> &v)
{
    return { v.data(), count_of(v.size()) };
}

static gltf_attributes attributes(gltf_model *m, const std::map<std::string, int> &from)
{
    gltf_attributes to = { make<gltf_attribute>(m, from.size()), count_of(from.size()) };
    int i = 0;
    for (const auto &pair : from)
        to.v[i++] = { pair.first.c_str(), pair.second };
    return to;
}

static void copy(gltf_model *, const tinygltf::Buffer &from, gltf_buffer *to)
{
    *to = { from.data.data(), from.data.size() };
}

static void copy(gltf_model *, const tinygltf::BufferView &from, gltf_view *to)
{
    *to = { from.buffer, from.byteOffset, from.byteLength, from.byteStride };
}

static void copy(gltf_model *, const tinygltf::Accessor &from, gltf_accessor *to)
{
    const bool matrix = from.type >= TINYGLTF_TYPE_MAT2 && from.type <= TINYGLTF_TYPE_MAT4;
    to->view = from.bufferView;
    to->offset = from.byteOffset;
    to->count = from.count;
    to->component_type = from.componentType;
    to->columns = matrix ? from.type - TINYGLTF_TYPE_MAT2 + 2 : 1;
    to->rows = from.type == TINYGLTF_TYPE_SCALAR ? 1 : matrix ? to->columns : from.type;
    to->normalized = from.normalized;
    to->sparse = from.sparse.isSparse;
    if (!to->sparse)
        return;
    to->sparse_count = from.sparse.count;
    to->index_view = from.sparse.indices.bufferView;
    to->index_offset = from.sparse.indices.byteOffset;
    to->index_type = from.sparse.indices.componentType;
    to->value_view = from.sparse.values.bufferView;
    to->value_offset = from.sparse.values.byteOffset;
}

static void copy(gltf_model *m, const tinygltf::Mesh &from, gltf_mesh *to)
{
    to->name = from.name.c_str();
    to->weights = numbers(from.weights);
    to->primitive_count = count_of(from.primitives.size());
    to->primitives = make<gltf_primitive>(m, from.primitives.size());
    for (int i = 0; i < to->primitive_count; i++) {
        const tinygltf::Primitive &p = from.primitives[static_cast<size_t>(i)];
        gltf_primitive *out = &to->primitives[i];
        out->attributes = attributes(m, p.attributes);
        out->target_count = count_of(p.targets.size());
        out->targets = make<gltf_attributes>(m, p.targets.size());
        for (int k = 0; k < out->target_count; k++)
            out->targets[k] = attributes(m, p.targets[static_cast<size_t>(k)]);
        out->material = p.material;
        out->indices = p.indices;
        out->mode = p.mode;
    }
}

// The light that KHR_lights_punctual hangs on a node; -2 where it is none at all.
static int node_light(const tinygltf::Node &node)
{
    const auto it = node.extensions.find("KHR_lights_punctual");
    if (it == node.extensions.end() || !it->second.IsObject())
        return -1;
    const tinygltf::Value &light = it->second.Get("light");
    return light.IsInt() ? light.GetNumberAsInt() : -2;
}

static void copy(gltf_model *, const tinygltf::Node &from, gltf_node *to)
{
    to->name = from.name.c_str();
    to->children = ints(from.children);
    to->mesh = from.mesh;
    to->camera = from.camera;
    to->skin = from.skin;
    to->light = node_light(from);
    to->translation = numbers(from.translation);
    to->rotation = numbers(from.rotation);
    to->scale = numbers(from.scale);
    to->matrix = numbers(from.matrix);
    to->weights = numbers(from.weights);
}

static void copy(gltf_model *, const tinygltf::Scene &from, gltf_scene *to)
{
    to->name = from.name.c_str();
    to->nodes = ints(from.nodes);
}

static void copy(gltf_model *, const tinygltf::Skin &from, gltf_skin *to)
{
    to->name = from.name.c_str();
    to->joints = ints(from.joints);
    to->inverse_bind = from.inverseBindMatrices;
}

static void copy(gltf_model *m, const tinygltf::Animation &from, gltf_animation *to)
{
    to->name = from.name.c_str();
    to->channel_count = count_of(from.channels.size());
    to->channels = make<gltf_channel>(m, from.channels.size());
    for (int i = 0; i < to->channel_count; i++) {
        const tinygltf::AnimationChannel &c = from.channels[static_cast<size_t>(i)];
        to->channels[i] = { c.sampler, c.target_node, c.target_path.c_str() };
    }
    to->curve_count = count_of(from.samplers.size());
    to->curves = make<gltf_curve>(m, from.samplers.size());
    for (int i = 0; i < to->curve_count; i++) {
        const tinygltf::AnimationSampler &s = from.samplers[static_cast<size_t>(i)];
        to->curves[i] = { s.input, s.output, s.interpolation.c_str() };
    }
}

template <typename From, typename To>
static void mirror(gltf_model *m, const std::vector<From> &from, To **to, int *count)
{
    *to = make<To>(m, static_cast<size_t>(count_of(from.size())));
    for (const From &item : from)
        copy(m, item, &(*to)[(*count)++]);
}

void gltf_mirror_shapes(const gltf_parsed *parsed, gltf_model *out)
{
    const auto &model = *reinterpret_cast<const tinygltf::Model *>(parsed);
    mirror(out, model.buffers, &out->buffers, &out->buffers_count);
    mirror(out, model.bufferViews, &out->views, &out->views_count);
    mirror(out, model.accessors, &out->accessors, &out->accessors_count);
    mirror(out, model.meshes, &out->meshes, &out->meshes_count);
    mirror(out, model.nodes, &out->nodes, &out->nodes_count);
    mirror(out, model.scenes, &out->scenes, &out->scenes_count);
    mirror(out, model.skins, &out->skins, &out->skins_count);
    mirror(out, model.animations, &out->animations, &out->animations_count);
    out->version = model.asset.version.c_str();
    out->min_version = model.asset.minVersion.c_str();
    out->default_scene = model.defaultScene;
}
