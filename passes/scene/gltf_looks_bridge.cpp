// SPDX-License-Identifier: MIT
#include "gltf_bridge.h"

#include <climits>
#include <new>

#include <tiny_gltf.h>

static gltf_numbers numbers(const std::vector<double> &v)
{
    if (v.size() > INT_MAX)
        throw std::bad_alloc();
    return { v.data(), static_cast<int>(v.size()) };
}

// An object's member, or nothing; tinygltf asserts on other types.
static const tinygltf::Value *member(const tinygltf::Value *object, const char *name)
{
    if (!object || !object->IsObject() || !object->Has(name))
        return nullptr;
    return &object->Get(name);
}

static const tinygltf::Value *extension(const tinygltf::ExtensionMap &map, const char *name)
{
    const auto it = map.find(name);
    return it == map.end() ? nullptr : &it->second;
}

static double number(const tinygltf::Value *value, double otherwise)
{
    return value && value->IsNumber() ? value->GetNumberAsDouble() : otherwise;
}

static void pair(const tinygltf::Value *value, double out[2])
{
    if (!value || !value->IsArray() || value->ArrayLen() != 2)
        return;
    out[0] = number(&value->Get(0), out[0]);
    out[1] = number(&value->Get(1), out[1]);
}

template <typename Info> static gltf_texture_info texture_info(const Info &from)
{
    gltf_texture_info to = { from.index, from.texCoord, { 0, 0 }, 0, { 1, 1 } };
    const tinygltf::Value *transform = extension(from.extensions, "KHR_texture_transform");
    pair(member(transform, "offset"), to.offset);
    pair(member(transform, "scale"), to.scale);
    to.rotation = number(member(transform, "rotation"), 0);
    const tinygltf::Value *uv = member(transform, "texCoord");
    if (uv && uv->IsInt())
        to.uv = uv->GetNumberAsInt();
    return to;
}

static void copy(const tinygltf::Material &from, gltf_material *to)
{
    const tinygltf::PbrMetallicRoughness &pbr = from.pbrMetallicRoughness;
    to->name = from.name.c_str();
    to->alpha_mode = from.alphaMode.c_str();
    to->alpha_cutoff = from.alphaCutoff;
    to->double_sided = from.doubleSided;
    to->base_color = numbers(pbr.baseColorFactor);
    to->metallic = pbr.metallicFactor;
    to->roughness = pbr.roughnessFactor;
    to->emissive = numbers(from.emissiveFactor);
    to->emissive_strength = number(
        member(extension(from.extensions, "KHR_materials_emissive_strength"), "emissiveStrength"),
        1);
    to->unlit = from.extensions.count("KHR_materials_unlit") > 0;
    to->base_color_tex = texture_info(pbr.baseColorTexture);
    to->metallic_roughness_tex = texture_info(pbr.metallicRoughnessTexture);
    to->emissive_tex = texture_info(from.emissiveTexture);
    to->normal_tex = texture_info(from.normalTexture);
    to->occlusion_tex = texture_info(from.occlusionTexture);
}

static void copy(const tinygltf::Texture &from, gltf_texture *to)
{
    *to = { from.name.c_str(), from.sampler, from.source };
}

static void copy(const tinygltf::Sampler &from, gltf_sampler *to)
{
    *to = { from.magFilter, from.wrapS, from.wrapT };
}

static void copy(const tinygltf::Image &from, gltf_image *to)
{
    *to = { from.name.c_str(), from.uri.c_str(), from.bufferView, from.image.data(),
            from.image.size() };
}

static void copy(const tinygltf::Camera &from, gltf_camera *to)
{
    to->name = from.name.c_str();
    to->type = from.type.c_str();
    to->yfov = from.perspective.yfov;
    to->znear = from.perspective.znear;
    to->zfar = from.perspective.zfar;
    to->xmag = from.orthographic.xmag;
    to->ymag = from.orthographic.ymag;
    to->ortho_near = from.orthographic.znear;
    to->ortho_far = from.orthographic.zfar;
}

static void copy(const tinygltf::Light &from, gltf_light *to)
{
    to->name = from.name.c_str();
    to->type = from.type.c_str();
    to->profile = "";
    to->color = numbers(from.color);
    to->intensity = from.intensity;
    to->range = from.range;
    to->inner = from.spot.innerConeAngle;
    to->outer = from.spot.outerConeAngle;
}

// tinygltf keeps no extras of a light, but all of the file's extension object.
static const char *light_profile(const tinygltf::Model &model, int light)
{
    const tinygltf::Value *lights =
        member(extension(model.extensions, "KHR_lights_punctual"), "lights");
    if (!lights || !lights->IsArray() || static_cast<size_t>(light) >= lights->ArrayLen())
        return "";
    const tinygltf::Value *profile = member(member(&lights->Get(light), "extras"), "profile");
    return profile && profile->IsString() ? profile->Get<std::string>().c_str() : "";
}

template <typename From, typename To>
static void mirror(gltf_model *m, const std::vector<From> &from, To **to, int *count)
{
    *to = static_cast<To *>(gltf_model_alloc(m, from.size(), sizeof(To)));
    if (!*to || from.size() > INT_MAX)
        throw std::bad_alloc();
    for (const From &item : from)
        copy(item, &(*to)[(*count)++]);
}

void gltf_mirror_looks(const gltf_parsed *parsed, gltf_model *out)
{
    const auto &model = *reinterpret_cast<const tinygltf::Model *>(parsed);
    mirror(out, model.materials, &out->materials, &out->materials_count);
    mirror(out, model.textures, &out->textures, &out->textures_count);
    mirror(out, model.samplers, &out->samplers, &out->samplers_count);
    mirror(out, model.images, &out->images, &out->images_count);
    mirror(out, model.cameras, &out->cameras, &out->cameras_count);
    mirror(out, model.lights, &out->lights, &out->lights_count);
    for (int i = 0; i < out->lights_count; i++)
        out->lights[i].profile = light_profile(model, i);
}
