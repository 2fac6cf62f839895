// SPDX-License-Identifier: MIT
#include "study.h"

#include <stdlib.h>
#include <string.h>

// ---- settings --------------------------------------------------------------------------------

// Sets every word of `text` after the first. False: `refused` is the first that is not taken.
static bool set_words(const char *text, setting *s, char *refused, size_t size)
{
    const char *word = text + strcspn(text, " ");
    while (*(word += strspn(word, " "))) {
        const int length = (int) strcspn(word, " ");
        snprintf(refused, size, "%.*s", length, word);
        if (gi_params_set(NULL, s->plugin, s->values, refused) != FG_OK)
            return false;
        word += length;
    }
    return true;
}

bool study_setting(const studies_desc *d, const char *text, setting *out)
{
    char name[64], refused[96] = "";
    *out = (setting){ 0 };
    snprintf(name, sizeof name, "%.*s", (int) strcspn(text, " "), text);
    if (!host_has_plugin(d->h, name) || host_setting(d->h, name, out) != EXIT_DONE ||
        !out->plugin) {
        report_note(d->doc, "studies: there is no plugin '%s'", name);
        return false;
    }
    if (set_words(text, out, refused, sizeof refused))
        return true;
    report_note(d->doc, "studies: %s does not take %s: without what asks for it", name, refused);
    setting_finish(out);
    return false;
}

double study_error(const cJSON *error, bool over_max)
{
    const char *const corrected = "rmse_rms_corrected";
    if (over_max)
        return json_number(error, "rmse_max");
    return json_number(error, cJSON_HasObjectItem(error, corrected) ? corrected : "rmse_rms");
}

// ---- pictures --------------------------------------------------------------------------------

void baselines_finish(baselines *b)
{
    for (int i = 0; i < b->count; ++i) {
        free(b->keys[i]);
        image_finish(&b->pictures[i]);
    }
    free(b->keys);
    free(b->pictures);
    *b = (baselines){ 0 };
}

static fg_status render(const studies_desc *d, const tour *t, double time, const setting *s,
                        image *out)
{
    renderer *r = NULL;
    renderer_desc desc = host_renderer_desc(d->h, s, d->width, d->height);
    desc.layers = 1u << LAYER_INDIRECT;
    desc.strict = true;
    fg_status status = host_renderer(d->h, &desc, &r);
    if (status == FG_OK)
        status = tour_pose(t, r, time);
    if (status == FG_OK)
        status = renderer_frame(r, time);
    if (status == FG_OK)
        status = renderer_read(r, LAYER_INDIRECT, out);
    renderer_destroy(r);
    return status;
}

// A new entry without a picture.
static image *append(baselines *b, const char *key)
{
    const size_t count = (size_t) b->count + 1;
    char *copy = strdup(key);
    char **keys = realloc(b->keys, count * sizeof *keys);
    if (keys)
        b->keys = keys;
    image *pictures = realloc(b->pictures, count * sizeof *pictures);
    if (pictures)
        b->pictures = pictures;
    if (!copy || !keys || !pictures) {
        free(copy);
        return NULL;
    }
    b->keys[b->count] = copy;
    b->pictures[b->count] = (image){ 0 };
    return &b->pictures[b->count++];
}

static fg_status make(const baselines *b, const tour *t, double time, const char *text,
                      image *picture)
{
    const char *why;
    setting s;
    fg_status status = FG_OK;
    cli_progress(text, 0);
    if (study_setting(b->d, text, &s) && host_serves(b->d->h, s.plugin, &why))
        status = render(b->d, t, time, &s, picture);
    setting_finish(&s);
    cli_progress(text, 1);
    return status;
}

fg_status baselines_get(baselines *b, const tour *t, double time, const char *text,
                        const char *setting_text, const image **out)
{
    char whole[400], key[512];
    if (!strncmp(text, "self ", 5))
        snprintf(whole, sizeof whole, "%s %s", setting_text, text + 5);
    else
        snprintf(whole, sizeof whole, "%s", text);
    snprintf(key, sizeof key, "%s at %.9g s%s", whole, time, t->on ? " of the tour" : "");
    int i = 0;
    while (i < b->count && strcmp(b->keys[i], key) != 0)
        ++i;
    fg_status status = FG_OK;
    if (i == b->count) {
        image *picture = append(b, key);
        status = picture ? make(b, t, time, whole, picture) : FG_ERR_MEMORY;
    }
    if (status == FG_OK)
        *out = b->pictures[i].rgb ? &b->pictures[i] : NULL;
    return status;
}
