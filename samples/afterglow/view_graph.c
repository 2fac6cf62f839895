// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include "ui_bridge.h"

#include <stdlib.h>
#include <string.h>

// The compiled graph as a chart: a column for each pass in the order of execution, a row for each
// resource, a bar from its first use to its last. Bars of one colour lie in the same memory.

void view_graph_finish(view_graph *g)
{
    free(g->rows);
    free(g->passes);
    g->rows = NULL;
    g->passes = NULL;
    g->row_count = g->pass_count = 0;
}

// ---- reading ---------------------------------------------------------------------------------

static void copy_text(char *to, size_t size, const cJSON *object, const char *key)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
    snprintf(to, size, "%s", text ? text : "");
}

static double number(const cJSON *object, const char *key)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    return cJSON_IsNumber(item) ? item->valuedouble : 0;
}

static void take_row(view_graph *g, const cJSON *resource)
{
    view_graph_row *row = &g->rows[g->row_count];
    if (!cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(resource, "used")))
        return;
    copy_text(row->name, sizeof row->name, resource, "name");
    copy_text(row->shape, sizeof row->shape, resource, "shape");
    copy_text(row->memory, sizeof row->memory, resource, "memory");
    row->bytes = number(resource, "bytes");
    row->first = (int) number(resource, "first");
    row->last = (int) number(resource, "last");
    row->slot = (int) number(resource, "slot");
    ++g->row_count;
}

static int compare_rows(const void *a, const void *b)
{
    const view_graph_row *x = a, *y = b;
    return x->first != y->first ? x->first - y->first : x->last - y->last;
}

static void take(view_graph *g, const cJSON *root)
{
    const cJSON *passes = cJSON_GetObjectItemCaseSensitive(root, "passes"), *item;
    const cJSON *resources = cJSON_GetObjectItemCaseSensitive(root, "resources");
    view_graph_finish(g);
    g->rows = calloc((size_t) cJSON_GetArraySize(resources) + 1, sizeof *g->rows);
    g->passes = calloc((size_t) cJSON_GetArraySize(passes) + 1, sizeof *g->passes);
    if (!g->rows || !g->passes) {
        view_graph_finish(g);
        return;
    }
    for (item = passes ? passes->child : NULL; item; item = item->next)
        copy_text(g->passes[g->pass_count++], VIEW_NAME, item, "name");
    for (item = resources ? resources->child : NULL; item; item = item->next)
        take_row(g, item);
    qsort(g->rows, (size_t) g->row_count, sizeof *g->rows, compare_rows);
}

// A picture is made once for a graph, not in every frame.
static void refresh(view *v)
{
    view_graph *g = &v->graph;
    const int compiles = v->stats.graph.compiles;
    if (!g->stale && g->compiles == compiles && g->rows)
        return;
    char *text = fg_graph_dump(renderer_graph(v->r), FG_DUMP_JSON);
    cJSON *root = text ? cJSON_Parse(text) : NULL;
    if (root)
        take(g, root);
    cJSON_Delete(root);
    if (text)
        fg_dump_free(renderer_graph(v->r), text);
    g->compiles = compiles;
    g->stale = false;
}

// ---- drawing ---------------------------------------------------------------------------------

static uint32_t bar_color(const view_graph_row *row)
{
    static const uint32_t colors[] = { 0xd9923bff, 0x5b8fc7ff, 0x76a85aff, 0xb56a9aff, 0x4fa3a0ff,
                                       0xc96b52ff, 0x8b83cfff, 0xa99a4aff, 0x6f9f86ff, 0xbf7f6fff };
    if (!strcmp(row->memory, "import"))
        return 0x5c5852ff;
    return colors[row->slot % FG_COUNT(colors)];
}

typedef struct chart {
    float em, left, top, column, row;
} chart;

static void draw_columns(const view_graph *g, const chart *c)
{
    char text[16];
    const float bottom = c->top + c->row * (float) g->row_count;
    for (int i = 0; i < g->pass_count; ++i) {
        const float x = c->left + c->column * (float) i;
        if (i % 2)
            ui_draw_rect(x, 0, c->column, bottom, 0xffffff0a);
        snprintf(text, sizeof text, "%d", i + 1);
        ui_draw_text(x + 0.5f * (c->column - ui_text_width(text)), 0, 0xf2b15cff, text);
    }
}

static void draw_row(const view_graph *g, const chart *c, int i)
{
    const view_graph_row *row = &g->rows[i];
    const float y = c->top + c->row * (float) i;
    const float x = c->left + c->column * (float) row->first;
    const float width = c->column * (float) (row->last - row->first + 1);
    char text[320];
    const int last = row->last < g->pass_count ? row->last : g->pass_count - 1;
    ui_draw_text(0, y, 0xe8e6e1ff, row->name);
    ui_draw_rect(x + 1, y + 2, width - 2, c->row - 4, bar_color(row));
    if (!ui_canvas_over(0, y, c->left + c->column * (float) g->pass_count, c->row))
        return;
    snprintf(text, sizeof text, "%s\n%s, %.0f bytes, %s\n%s to %s\nmemory %d", row->name,
             row->shape, row->bytes, row->memory, g->passes[row->first], g->passes[last],
             row->slot);
    ui_hint(text);
}

static void draw_chart(const view_graph *g)
{
    const float em = ui_unit();
    chart c = { .em = em, .top = 1.6f * em, .row = 1.4f * em, .column = 2 * em };
    for (int i = 0; i < g->row_count; ++i) {
        const float width = ui_text_width(g->rows[i].name) + em;
        c.left = width > c.left ? width : c.left;
    }
    ui_canvas_begin(c.left + c.column * (float) g->pass_count,
                    c.top + c.row * (float) g->row_count);
    draw_columns(g, &c);
    for (int i = 0; i < g->row_count; ++i)
        draw_row(g, &c, i);
    ui_canvas_end();
}

static void list_passes(const view_graph *g)
{
    char text[VIEW_NAME + 8];
    const float em = ui_unit(), widths[] = { 18 * em, 18 * em, 18 * em };
    if (!ui_table_begin("passes", widths, FG_COUNT(widths)))
        return;
    for (int i = 0; i < g->pass_count; ++i) {
        ui_table_next();
        snprintf(text, sizeof text, "%d %s", i + 1, g->passes[i]);
        ui_text(UI_ACCENT, text);
    }
    ui_table_end();
}

void view_graph_panel(view *v)
{
    const float em = ui_unit();
    const float x = 32 * em, width = (float) v->window.width - x - em;
    const ui_window window = {
        .title = "Graph: lifetimes in the order of execution",
        .x = width > 20 * em ? x : em,
        .y = 2 * em,
        .width = width > 20 * em ? width : (float) v->window.width - 2 * em,
        .height = (float) v->window.height - 4 * em,
        .flags = UI_SIDEWAYS,
    };
    if (!v->graph.shown)
        return;
    refresh(v);
    if (ui_window_begin(&window, &v->graph.shown)) {
        list_passes(&v->graph);
        ui_separator();
        draw_chart(&v->graph);
        ui_text(UI_DIM, "One colour: the same memory. Grey: the host's.");
    }
    ui_window_end();
}
