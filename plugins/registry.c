// SPDX-License-Identifier: MIT
#include <gi/registry.h>

#include "linked.h" // generated: GI_LINKED(X) names the techniques that are linked in
#include "module_priv.h"

#include <dirent.h>
#include <dlfcn.h>
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
    const gi_plugin *plugin; // checked; NULL until first use, and after a refusal
    bool tried;              // the file was opened, and was then as `loaded` says
    module_stamp loaded;
    module_stamp seen; // by gi_changed(), first at `seen_since`
    int64_t seen_since;
} entry;

typedef struct entries {
    entry *items;
    int count;
} entries;

struct gi_registry {
    const fg_log *log;
    char **dirs; // ends at NULL
    bool only_dirs, hot;
    entries all;    // sorted by name
    void **retired; // modules that another has taken the place of; still mapped
    int retired_count;
};

// ---- finding --------------------------------------------------------------------

static entry *find(const entries *all, const char *name)
{
    for (int i = 0; i < all->count; ++i)
        if (!strcmp(all->items[i].name, name))
            return &all->items[i];
    return NULL;
}

static void free_entry(entry *e)
{
    if (e->module)
        dlclose(e->module);
    free(e->name);
    free(e->path);
}

static void free_entries(entries *all)
{
    for (int i = 0; i < all->count; ++i)
        free_entry(&all->items[i]);
    free(all->items);
    *all = (entries){ 0 };
}

// Takes what `e` owns, also when it fails.
static fg_status append(entries *all, entry *e)
{
    entry *grown = realloc(all->items, (size_t) (all->count + 1) * sizeof *grown);
    if (!grown) {
        free_entry(e);
        return FG_ERR_MEMORY;
    }
    all->items = grown;
    all->items[all->count++] = *e;
    return FG_OK;
}

// The first of a name wins. Takes `path`, also when it fails.
static fg_status add(entries *all, const char *name, size_t length, char *path,
                     gi_plugin_entry_fn fn)
{
    entry e = { .name = strndup(name, length), .entry = fn };
    e.path = path;
    if (e.name && !find(all, e.name))
        return append(all, &e);
    const fg_status status = e.name ? FG_OK : FG_ERR_MEMORY;
    free_entry(&e);
    return status;
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
static fg_status scan(entries *all, const char *dir)
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
            status = add(all, file->d_name + strlen(MODULE_PREFIX), length, path, NULL);
    }
    if (d)
        closedir(d);
    return status;
}

static fg_status scan_environment(entries *all)
{
    const char *path = getenv("AFTERGLOW_PLUGIN_PATH");
    fg_status status = FG_OK;
    while (path && *path && status == FG_OK) {
        const size_t length = strcspn(path, ":");
        char *dir = strndup(path, length);
        if (!dir)
            return FG_ERR_MEMORY;
        if (length)
            status = scan(all, dir);
        free(dir);
        path += length + (path[length] == ':');
    }
    return status;
}

// Beside this library: its own folder in a build tree, afterglow/plugins below it where it is
// installed. Then where it was to be installed, for a host that has it linked statically.
static fg_status scan_default(entries *all)
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
            status = scan(all, dir);
            free(dir);
        }
    }
    return status == FG_OK ? scan(all, GI_PLUGIN_DIR) : status;
}

static fg_status add_linked(entries *all)
{
    fg_status status = FG_OK;
    (void) all;
#define GI_ADD(name)                                                                               \
    if (status == FG_OK)                                                                           \
        status = add(all, #name, strlen(#name), NULL, gi_plugin_entry_##name);
    GI_LINKED(GI_ADD)
#undef GI_ADD
    return status;
}

static fg_status scan_all(const gi_registry *r, entries *all)
{
    fg_status status = add_linked(all);
    for (int i = 0; status == FG_OK && r->dirs[i]; ++i)
        status = scan(all, r->dirs[i]);
    if (status == FG_OK && !r->only_dirs)
        status = scan_environment(all);
    if (status == FG_OK && !r->only_dirs)
        status = scan_default(all);
    if (status != FG_OK)
        fg_logf(r->log, FG_LOG_ERROR, "plugins: out of memory while searching");
    return status;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const entry *) a)->name, ((const entry *) b)->name);
}

static void sort(entries *all)
{
    if (all->count)
        qsort(all->items, (size_t) all->count, sizeof *all->items, by_name);
}

// ---- life ---------------------------------------------------------------------------

static void free_dirs(char **dirs)
{
    for (int i = 0; dirs && dirs[i]; ++i)
        free(dirs[i]);
    free(dirs);
}

static char **copy_dirs(const char *const *dirs)
{
    size_t n = 0;
    while (dirs && dirs[n])
        ++n;
    char **copy = calloc(n + 1, sizeof *copy);
    for (size_t i = 0; copy && i < n; ++i) {
        copy[i] = strdup(dirs[i]);
        if (copy[i])
            continue;
        free_dirs(copy);
        return NULL;
    }
    return copy;
}

fg_status gi_registry_create(const gi_registry_desc *desc, gi_registry **out)
{
    *out = NULL;
    gi_registry *r = calloc(1, sizeof *r);
    char **dirs = copy_dirs(desc->dirs);
    if (!r || !dirs) {
        fg_logf(desc->log, FG_LOG_ERROR, "plugins: out of memory");
        free(r);
        free_dirs(dirs);
        return FG_ERR_MEMORY;
    }
    *r = (gi_registry){
        .log = desc->log, .dirs = dirs, .only_dirs = desc->only_dirs, .hot = desc->hot
    };
    const fg_status status = scan_all(r, &r->all);
    if (status != FG_OK) {
        gi_registry_destroy(r);
        return status;
    }
    sort(&r->all);
    *out = r;
    return FG_OK;
}

void gi_registry_destroy(gi_registry *r)
{
    if (!r)
        return;
    free_entries(&r->all);
    for (int i = r->retired_count; i > 0; --i)
        dlclose(r->retired[i - 1]);
    free(r->retired);
    free_dirs(r->dirs);
    free(r);
}

const char *gi_name(gi_registry *r, int i)
{
    return i >= 0 && i < r->all.count ? r->all.items[i].name : NULL;
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

// Opens the file; what was there before stays where this fails.
static fg_status open_module(gi_registry *r, entry *e)
{
    void *module = module_open(r->log, e->name, e->path, r->hot, &e->loaded);
    e->tried = true;
    if (!module)
        return FG_ERR_INPUT;
    if (e->module) {
        void **grown = realloc(r->retired, (size_t) (r->retired_count + 1) * sizeof *grown);
        if (!grown) {
            fg_logf(r->log, FG_LOG_ERROR, "plugin %s: out of memory", e->name);
            dlclose(module);
            return FG_ERR_MEMORY;
        }
        r->retired = grown;
        r->retired[r->retired_count++] = e->module;
    }
    // POSIX gives functions as data pointers; the copy keeps ISO C out of it.
    void *symbol = dlsym(module, GI_PLUGIN_SYMBOL);
    memcpy(&e->entry, &symbol, sizeof symbol);
    e->module = module;
    e->plugin = NULL;
    return FG_OK;
}

static fg_status load(gi_registry *r, entry *e)
{
    const fg_status status = e->path ? open_module(r, e) : FG_OK;
    if (status != FG_OK)
        return status;
    const gi_plugin *p = NULL;
    if (!e->entry)
        fg_logf(r->log, FG_LOG_ERROR, "plugin %s: %s has no symbol %s", e->name, e->path,
                GI_PLUGIN_SYMBOL);
    else if (p = e->entry(), !check(r->log, e, p))
        p = NULL;
    e->plugin = p;
    if (p)
        return FG_OK;
    if (e->module) { // nobody has seen anything of it
        dlclose(e->module);
        e->module = NULL;
        e->entry = NULL;
    }
    return FG_ERR_UNSUPPORTED;
}

static void log_unknown(gi_registry *r, const char *name)
{
    char known[512] = "";
    size_t used = 0;
    for (int i = 0; i < r->all.count && used < sizeof known; ++i)
        used += (size_t) snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                                  r->all.items[i].name);
    fg_logf(r->log, FG_LOG_ERROR, "plugin '%s': not found; there %s %s", name,
            r->all.count == 1 ? "is" : "are", r->all.count ? known : "none");
}

const gi_plugin *gi_find(gi_registry *r, const char *name)
{
    entry *e = find(&r->all, name);
    if (!e) {
        log_unknown(r, name);
        return NULL;
    }
    return e->plugin || load(r, e) == FG_OK ? e->plugin : NULL;
}

// ---- loading again ------------------------------------------------------------------

bool gi_changed(gi_registry *r, const char *name)
{
    entry *e = find(&r->all, name);
    if (!r->hot || !e || !e->tried)
        return false;
    const module_stamp now = module_look(e->path);
    if (!module_same(&now, &e->seen) || !e->seen_since) {
        e->seen = now;
        e->seen_since = module_now();
    }
    return !module_same(&now, &e->loaded) && module_settled(&now, e->seen_since);
}

fg_status gi_reload(gi_registry *r, const char *name)
{
    entry *e = find(&r->all, name);
    if (!e) {
        log_unknown(r, name);
        return FG_ERR_INVALID;
    }
    if (!r->hot || !e->path) {
        fg_logf(r->log, FG_LOG_ERROR, "plugin %s: cannot be loaded again: %s", name,
                e->path ? "the registry is not hot" : "it is linked in");
        return FG_ERR_INVALID;
    }
    return load(r, e);
}

fg_status gi_rescan(gi_registry *r)
{
    entries fresh = { 0 };
    fg_status status = scan_all(r, &fresh);
    for (int i = 0; status == FG_OK && i < fresh.count; ++i) {
        entry *now = &fresh.items[i], *e = find(&r->all, now->name);
        if (!e) {
            entry taken = *now;
            *now = (entry){ .name = NULL };
            status = append(&r->all, &taken);
        } else if (now->path && e->path && strcmp(now->path, e->path) != 0) {
            char *old = e->path; // another folder has it now
            e->path = now->path;
            now->path = old;
        }
    }
    free_entries(&fresh);
    sort(&r->all);
    return status;
}
