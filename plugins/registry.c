// SPDX-License-Identifier: MIT
#include <gi/registry.h>

#include "linked.h" // generated: GI_LINKED(X) names the techniques that are linked in

#include <assert.h>
#include <dirent.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MODULE_PREFIX "gi_"
#define MODULE_SUFFIX ".so"

typedef struct entry {
    char *name;
    char *path;               // NULL: linked in
    gi_plugin_entry_fn entry; // linked in
    void *module;
    const gi_plugin *plugin; // checked; NULL until first use
} entry;

struct gi_registry {
    const fg_log *log;
    entry *entries; // sorted by name
    int count;
};

// ---- finding --------------------------------------------------------------------

static bool has(const gi_registry *r, const char *name)
{
    for (int i = 0; i < r->count; ++i) {
        if (!strcmp(r->entries[i].name, name))
            return true;
    }
    return false;
}

// The first of a name wins. Takes `path`, also when it fails.
static fg_status add(gi_registry *r, const char *name, size_t length, char *path,
                     gi_plugin_entry_fn fn)
{
    char *copy = strndup(name, length);
    if (copy && has(r, copy)) {
        free(copy);
        free(path);
        return FG_OK;
    }
    entry *grown = realloc(r->entries, (size_t) (r->count + 1) * sizeof *grown);
    if (grown)
        r->entries = grown;
    if (!copy || !grown) {
        free(copy);
        free(path);
        return FG_ERR_MEMORY;
    }
    r->entries[r->count++] = (entry){ .name = copy, .path = path, .entry = fn };
    return FG_OK;
}

static bool is_module(const char *file, size_t *length)
{
    const size_t all = strlen(file);
    const size_t ends = strlen(MODULE_PREFIX) + strlen(MODULE_SUFFIX);
    if (all <= ends || strncmp(file, MODULE_PREFIX, strlen(MODULE_PREFIX)) != 0 ||
        strcmp(file + all - strlen(MODULE_SUFFIX), MODULE_SUFFIX) != 0)
        return false;
    *length = all - ends;
    return true;
}

// A folder that is not there holds no plugin; that is no error.
static fg_status scan(gi_registry *r, const char *dir)
{
    fg_status status = FG_OK;
    DIR *d = opendir(dir);
    const struct dirent *file;
    while (d && status == FG_OK && (file = readdir(d))) {
        size_t length;
        char *path;
        if (!is_module(file->d_name, &length))
            continue;
        if (asprintf(&path, "%s/%s", dir, file->d_name) < 0)
            status = FG_ERR_MEMORY;
        else
            status = add(r, file->d_name + strlen(MODULE_PREFIX), length, path, NULL);
    }
    if (d)
        closedir(d);
    return status;
}

static fg_status scan_environment(gi_registry *r)
{
    const char *path = getenv("AFTERGLOW_PLUGIN_PATH");
    fg_status status = FG_OK;
    while (path && *path && status == FG_OK) {
        const size_t length = strcspn(path, ":");
        char *dir = strndup(path, length);
        if (!dir)
            return FG_ERR_MEMORY;
        if (length)
            status = scan(r, dir);
        free(dir);
        path += length + (path[length] == ':');
    }
    return status;
}

// Beside this library: its own folder in a build tree, afterglow/plugins below it where it is
// installed. Then where it was to be installed, for a host that has it linked statically.
static fg_status scan_default(gi_registry *r)
{
    static const char here = 0; // an address in this library
    Dl_info info;
    fg_status status = FG_OK;
    if (dladdr(&here, &info) && info.dli_fname) {
        const char *slash = strrchr(info.dli_fname, '/');
        const int length = slash ? (int) (slash - info.dli_fname) : 1;
        const char *folder = slash ? info.dli_fname : ".";
        static const char *const below[] = { "", "/afterglow/plugins" };
        for (int i = 0; i < FG_COUNT(below) && status == FG_OK; ++i) {
            char *dir;
            if (asprintf(&dir, "%.*s%s", length, folder, below[i]) < 0)
                return FG_ERR_MEMORY;
            status = scan(r, dir);
            free(dir);
        }
    }
    return status == FG_OK ? scan(r, GI_PLUGIN_DIR) : status;
}

static fg_status add_linked(gi_registry *r)
{
    fg_status status = FG_OK;
    (void) r;
#define GI_ADD(name)                                                                               \
    if (status == FG_OK)                                                                           \
        status = add(r, #name, strlen(#name), NULL, gi_plugin_entry_##name);
    GI_LINKED(GI_ADD)
#undef GI_ADD
    return status;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const entry *) a)->name, ((const entry *) b)->name);
}

fg_status gi_registry_create(const gi_registry_desc *desc, gi_registry **out)
{
    fg_status status = FG_ERR_MEMORY;
    gi_registry *r = calloc(1, sizeof *r);
    *out = NULL;
    if (!r)
        goto fail;
    r->log = desc->log;
    status = add_linked(r);
    for (int i = 0; status == FG_OK && desc->dirs && desc->dirs[i]; ++i)
        status = scan(r, desc->dirs[i]);
    if (status == FG_OK && !desc->only_dirs)
        status = scan_environment(r);
    if (status == FG_OK && !desc->only_dirs)
        status = scan_default(r);
    if (status != FG_OK)
        goto fail;
    if (r->count)
        qsort(r->entries, (size_t) r->count, sizeof *r->entries, by_name);
    *out = r;
    return FG_OK;

fail:
    fg_logf(desc->log, FG_LOG_ERROR, "plugins: out of memory while searching");
    gi_registry_destroy(r);
    return status;
}

void gi_registry_destroy(gi_registry *r)
{
    if (!r)
        return;
    for (int i = 0; i < r->count; ++i) {
        if (r->entries[i].module)
            dlclose(r->entries[i].module);
        free(r->entries[i].name);
        free(r->entries[i].path);
    }
    free(r->entries);
    free(r);
}

const char *gi_name(gi_registry *r, int i)
{
    return i >= 0 && i < r->count ? r->entries[i].name : NULL;
}

int gi_layers_count(const gi_plugin *p)
{
    int n = 0;
    while (p->layers && p->layers[n].name)
        ++n;
    return n;
}

// ---- loading --------------------------------------------------------------------

static bool check_param(const fg_log *log, const gi_plugin *p, const gi_param *row)
{
    const char *fault = NULL;
    if (row->type < GI_INT || row->type > GI_ENUM) {
        fault = "is of no known type";
    } else if (row->type == GI_ENUM) {
        int n = 0;
        while (row->choices && row->choices[n])
            ++n;
        if (n == 0 || !(row->def >= 0) || row->def >= n)
            fault = "has no choice for its default";
    } else if (row->type != GI_BOOL && !(row->min <= row->def && row->def <= row->max)) {
        fault = "has a default outside its range";
    }
    for (const gi_param *other = p->params; !fault && other != row; ++other) {
        if (!strcmp(other->name, row->name))
            fault = "is there twice";
    }
    if (fault)
        fg_logf(log, FG_LOG_ERROR, "plugin %s: parameter '%s' %s", p->name, row->name, fault);
    return !fault;
}

static bool check_layers(const fg_log *log, const gi_plugin *p)
{
    enum { MAX_NAME = 31 };
    for (int i = 0; p->layers && p->layers[i].name; ++i) {
        const char *name = p->layers[i].name, *fault = NULL;
        if (i == GI_MAX_LAYERS)
            fault = "is one too many";
        else if (!name[0] || strlen(name) > MAX_NAME || strchr(name, '.'))
            fault = "must be called by 1 to 31 letters without a '.'";
        else if (!p->layers[i].help)
            fault = "has no help";
        for (int k = 0; !fault && k < i; ++k)
            if (!strcmp(p->layers[k].name, name))
                fault = "is there twice";
        if (fault) {
            fg_logf(log, FG_LOG_ERROR, "plugin %s: layer '%s' %s", p->name, name, fault);
            return false;
        }
    }
    return true;
}

// The first field is the ABI number in every version; nothing else is read before it is right.
static bool check(const fg_log *log, const entry *e, const gi_plugin *p)
{
    if (!p) {
        fg_logf(log, FG_LOG_ERROR, "plugin %s: its entry gives no table", e->name);
        return false;
    }
    if (p->abi != GI_PLUGIN_ABI) {
        fg_logf(log, FG_LOG_ERROR, "plugin %s: was built for ABI %d, this host has ABI %d", e->name,
                p->abi, GI_PLUGIN_ABI);
        return false;
    }
    if (!p->name || strcmp(p->name, e->name) != 0) {
        fg_logf(log, FG_LOG_ERROR, "plugin %s: calls itself '%s'; the file's name must be its own",
                e->name, p->name ? p->name : "");
        return false;
    }
    if (!p->create || !p->declare || !p->destroy || !p->source || !p->summary) {
        fg_logf(log, FG_LOG_ERROR,
                "plugin %s: its table lacks create, declare, destroy, source or summary", e->name);
        return false;
    }
    for (const gi_param *row = p->params; row && row->name; ++row) {
        if (!check_param(log, p, row))
            return false;
    }
    return check_layers(log, p);
}

static const gi_plugin *load(gi_registry *r, entry *e)
{
    if (e->path) {
        e->module = dlopen(e->path, RTLD_NOW | RTLD_LOCAL);
        if (!e->module) {
            fg_logf(r->log, FG_LOG_ERROR, "plugin %s: cannot be loaded: %s", e->name, dlerror());
            return NULL;
        }
        // POSIX gives functions as data pointers; the copy keeps ISO C out of it.
        void *symbol = dlsym(e->module, GI_PLUGIN_SYMBOL);
        memcpy(&e->entry, &symbol, sizeof symbol);
    }
    const gi_plugin *p = NULL;
    if (!e->entry)
        fg_logf(r->log, FG_LOG_ERROR, "plugin %s: %s has no symbol %s", e->name, e->path,
                GI_PLUGIN_SYMBOL);
    else if (p = e->entry(), !check(r->log, e, p))
        p = NULL;
    if (!p && e->module) {
        dlclose(e->module);
        e->module = NULL;
        e->entry = NULL;
    }
    return p;
}

static void log_unknown(gi_registry *r, const char *name)
{
    char known[512] = "";
    size_t used = 0;
    for (int i = 0; i < r->count && used < sizeof known; ++i)
        used += (size_t) snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                                  r->entries[i].name);
    fg_logf(r->log, FG_LOG_ERROR, "plugin '%s': not found; there %s %s", name,
            r->count == 1 ? "is" : "are", r->count ? known : "none");
}

const gi_plugin *gi_find(gi_registry *r, const char *name)
{
    for (int i = 0; i < r->count; ++i) {
        entry *e = &r->entries[i];
        if (strcmp(e->name, name) != 0)
            continue;
        if (!e->plugin)
            e->plugin = load(r, e);
        return e->plugin;
    }
    log_unknown(r, name);
    return NULL;
}
