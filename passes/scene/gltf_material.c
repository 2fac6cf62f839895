// SPDX-License-Identifier: MIT
// Materials, and of the textures what they use.
#include "gltf_image.h"
#include "gltf_load.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// One of the scene's textures: an image as a sampler reads it, colours or numbers.
typedef struct slot {
    int image;
    ag_wrap wrap_u, wrap_v;
    bool nearest, srgb;
    int next; // of the same image, -1: none
    const char *name;
} slot;

typedef struct slots {
    ag_array items;    // slot
    int *by_image;     // its first slot, -1: none
    int *picture_of;   // by image
    ag_array pictures; // gltf_picture
    ag_array images;   // int: the image of each picture
} slots;

// ---- which textures are used ------------------------------------------------------

static ag_wrap wrap_mode(int gl)
{
    return gl == 33071 ? AG_WRAP_CLAMP : gl == 33648 ? AG_WRAP_MIRROR : AG_WRAP_REPEAT;
}

static int add_slot(gltf_loader *l, slots *s, const gltf_texture *t, bool srgb)
{
    slot new = { .image = t->image, .srgb = srgb, .name = t->name };
    if (t->sampler >= 0) {
        const gltf_sampler *sampler = &l->m->samplers[t->sampler];
        new.wrap_u = wrap_mode(sampler->wrap_s);
        new.wrap_v = wrap_mode(sampler->wrap_t);
        new.nearest = sampler->mag_filter == 9728;
    }
    const slot *items = s->items.data;
    for (int i = s->by_image[t->image]; i >= 0; i = items[i].next)
        if (items[i].wrap_u == new.wrap_u && items[i].wrap_v == new.wrap_v &&items[i].nearest ==
                                                 new.nearest &&items[i].srgb == new.srgb)
            return i;
    slot *item = ag_array_push(&s->items, 1, sizeof *item);
    if (!item)
        return gltf_no_memory(l) ? 0 : -1;
    new.next = s->by_image[t->image];
    *item = new;
    s->by_image[t->image] = (int) s->items.count - 1;
    return s->by_image[t->image];
}

// The slot of a texture reference, which becomes the scene's texture of the same number. False
// after a refusal.
static bool use_texture(gltf_loader *l, slots *s, const gltf_texture_info *info, bool srgb,
                        ag_texture_ref *out)
{
    if (info->texture < 0)
        return true;
    const gltf_texture *t = &l->m->textures[info->texture];
    if (t->image < 0) {
        ag_builder_warn(l->b, "texture %d: it has no image that is read; it is left out",
                        info->texture);
        return true;
    }
    if (info->uv > 1) {
        ag_builder_warn(l->b, "texture %d: UV set %d is not read; it is left out", info->texture,
                        info->uv);
        return true;
    }
    out->texture = add_slot(l, s, t, srgb);
    out->uv = info->uv;
    // KHR_texture_transform: translation x rotation x scale, the rotation as its example has it.
    double c = cos(info->rotation), n = sin(info->rotation);
    double transform[6] = { c * info->scale[0],  n * info->scale[1], info->offset[0],
                            -n * info->scale[0], c * info->scale[1], info->offset[1] };
    for (int i = 0; i < 6; i++)
        out->transform[i] = (float) transform[i];
    return out->texture >= 0;
}

// ---- images -----------------------------------------------------------------------

static bool refuse_image(gltf_loader *l, int image, const char *why)
{
    const gltf_image *of = &l->m->images[image];
    ag_builder_refuse(l->b, FG_ERR_INPUT, "image %d '%.60s': %s", image,
                      of->uri[0] ? of->uri : of->name, why);
    return false;
}

static bool add_picture(gltf_loader *l, slots *s, int image)
{
    const gltf_image *of = &l->m->images[image];
    gltf_picture *p = ag_array_push(&s->pictures, 1, sizeof *p);
    int *number = ag_array_push(&s->images, 1, sizeof *number);
    if (!p || !number)
        return gltf_no_memory(l);
    *number = image;
    s->picture_of[image] = (int) s->pictures.count - 1;
    p->bytes = of->data;
    p->size = of->size;
    if (of->view >= 0) {
        const gltf_view *view = &l->m->views[of->view];
        p->bytes = l->m->buffers[view->buffer].data + view->offset;
        p->size = view->length;
    }
    if (p->size == 0)
        return refuse_image(l, image, l->image_fault[0] ? l->image_fault : "it has no data");
    const char *fault = gltf_picture_probe(p);
    return fault ? refuse_image(l, image, fault) : true;
}

// Every slot takes a copy of its image's pixels.
static bool find_pictures(gltf_loader *l, slots *s)
{
    const slot *items = s->items.data;
    for (size_t i = 0; i < s->items.count; i++) {
        int image = items[i].image;
        if (s->picture_of[image] < 0 && !add_picture(l, s, image))
            return false;
        const gltf_picture *p = (gltf_picture *) s->pictures.data + s->picture_of[image];
        uint64_t pixels = (uint64_t) p->width * (uint64_t) p->height;
        if (pixels > l->pixels_left)
            return refuse_image(l, image, "all textures together have too many texels");
        l->pixels_left -= pixels;
    }
    return true;
}

static bool add_textures(gltf_loader *l, slots *s)
{
    gltf_picture *pictures = s->pictures.data;
    const slot *items = s->items.data;
    gltf_picture_decode_all(pictures, (int) s->pictures.count);
    for (size_t i = 0; i < s->pictures.count; i++)
        if (!pictures[i].rgba)
            return refuse_image(l, ((int *) s->images.data)[i],
                                pictures[i].fault ? pictures[i].fault : "it cannot be decoded");
    for (size_t i = 0; i < s->items.count; i++) {
        gltf_picture *p = &pictures[s->picture_of[items[i].image]];
        ag_texture t = {
            .width = p->width,
            .height = p->height,
            .rgba = p->rgba,
            .srgb = items[i].srgb,
            .nearest = items[i].nearest,
            .wrap_u = items[i].wrap_u,
            .wrap_v = items[i].wrap_v,
        };
        const gltf_image *image = &l->m->images[items[i].image];
        ag_name_copy(t.name, items[i].name[0] ? items[i].name
                             : image->name[0] ? image->name
                                              : image->uri);
        // The last slot of an image takes its pixels, the others copies.
        bool last = s->by_image[items[i].image] == (int) i;
        int made = last ? ag_builder_texture_take(l->b, &t, p->rgba) : ag_builder_texture(l->b, &t);
        if (last)
            p->rgba = NULL;
        if (made < 0)
            return false;
    }
    return true;
}

// ---- materials --------------------------------------------------------------------

static float component(gltf_numbers n, int i, double otherwise)
{
    return (float) (i < n.count ? n.v[i] : otherwise);
}

static void alpha_mode(gltf_loader *l, int i, const gltf_material *from, ag_material *to)
{
    to->alpha_cutoff = (float) from->alpha_cutoff;
    if (strcmp(from->alpha_mode, "MASK") == 0)
        to->alpha = AG_ALPHA_MASK;
    else if (strcmp(from->alpha_mode, "BLEND") == 0)
        l->blends++;
    else if (strcmp(from->alpha_mode, "OPAQUE") != 0)
        ag_builder_warn(l->b, "material %d: alphaMode '%.20s' does not exist; it is opaque", i,
                        from->alpha_mode);
}

static bool convert(gltf_loader *l, slots *s, int i, ag_material *to)
{
    const gltf_material *from = &l->m->materials[i];
    *to = ag_default_material();
    ag_name_copy(to->name, from->name);
    for (int k = 0; k < 4; k++)
        to->base_color[k] = component(from->base_color, k, 1);
    // An unlit surface has no glTF counterpart in a lit world: it is a diffuse one here.
    to->metallic = from->unlit ? 0 : (float) from->metallic;
    to->roughness = from->unlit ? 1 : (float) from->roughness;
    for (int k = 0; k < 3; k++)
        to->emissive[k] =
            (float) ((double) component(from->emissive, k, 0) * from->emissive_strength);
    to->double_sided = from->double_sided;
    alpha_mode(l, i, from, to);
    l->unlits += from->unlit;
    l->normal_maps += from->normal_tex.texture >= 0;
    return use_texture(l, s, &from->base_color_tex, true, &to->base_color_tex) &&
           (from->unlit ||
            use_texture(l, s, &from->metallic_roughness_tex, false, &to->metallic_roughness_tex)) &&
           use_texture(l, s, &from->emissive_tex, true, &to->emissive_tex);
}

static bool load(gltf_loader *l, slots *s, ag_material *materials)
{
    int count = l->m->materials_count;
    for (int i = 0; i < count; i++)
        if (!convert(l, s, i, &materials[i]))
            return false;
    if (!find_pictures(l, s) || !add_textures(l, s))
        return false;
    for (int i = 0; i < count; i++) {
        l->materials[i] = ag_builder_material(l->b, &materials[i]);
        if (l->materials[i] < 0)
            return false;
    }
    return true;
}

bool gltf_load_materials(gltf_loader *l)
{
    size_t images = (size_t) l->m->images_count;
    slots s = { .by_image = malloc((images + 1) * sizeof(int)),
                .picture_of = malloc((images + 1) * sizeof(int)) };
    ag_material *materials = calloc((size_t) l->m->materials_count + 1, sizeof *materials);
    bool ok = s.by_image && s.picture_of && materials;
    if (ok) {
        memset(s.by_image, 0xff, images * sizeof(int));
        memset(s.picture_of, 0xff, images * sizeof(int));
        ok = load(l, &s, materials);
    } else {
        gltf_no_memory(l);
    }
    for (size_t i = 0; i < s.pictures.count; i++)
        free(((gltf_picture *) s.pictures.data)[i].rgba);
    ag_array_finish(&s.items);
    ag_array_finish(&s.pictures);
    ag_array_finish(&s.images);
    free(s.by_image);
    free(s.picture_of);
    free(materials);
    return ok;
}
