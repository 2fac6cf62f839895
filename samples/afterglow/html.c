// SPDX-License-Identifier: MIT
#include "html.h"

#include "file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_PART = 64 << 20 };

void html_text(FILE *f, const char *text)
{
    for (; *text; ++text)
        switch (*text) {
        case '<': fputs("&lt;", f); break;
        case '>': fputs("&gt;", f); break;
        case '&': fputs("&amp;", f); break;
        case '"': fputs("&quot;", f); break;
        default: fputc(*text, f); break;
        }
}

void html_number(FILE *f, double value, const char *format)
{
    char text[64];
    snprintf(text, sizeof text, format, value);
    fprintf(f, "<td>%s</td>", isfinite(value) ? text : "&ndash;");
}

void html_cell(FILE *f, const char *text)
{
    fputs("<td class=\"text\">", f);
    html_text(f, text);
    fputs("</td>", f);
}

static void base64(FILE *f, const unsigned char *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const size_t left = size - i;
        const unsigned bits = (unsigned) data[i] << 16 |
                              (left > 1 ? (unsigned) data[i + 1] << 8 : 0) |
                              (left > 2 ? data[i + 2] : 0);
        fputc(digits[bits >> 18], f);
        fputc(digits[bits >> 12 & 63], f);
        fputc(left > 1 ? digits[bits >> 6 & 63] : '=', f);
        fputc(left > 2 ? digits[bits & 63] : '=', f);
    }
}

fg_status html_data(FILE *f, const fg_log *log, const char *path, const char *type)
{
    char *data;
    size_t size;
    const fg_status status = file_read(log, path, MAX_PART, &data, &size);
    if (status != FG_OK)
        return status;
    fprintf(f, "data:%s;base64,", type);
    base64(f, (const unsigned char *) data, size);
    free(data);
    return FG_OK;
}

// What names an id: the text up to and with the point where the prefix goes.
static const char *const id_marks[] = { " id=\"", " id='", "href=\"#", "href='#", "url(#" };

static size_t mark_at(const char *text)
{
    for (int i = 0; i < FG_COUNT(id_marks); ++i) {
        const size_t length = strlen(id_marks[i]);
        if (!strncmp(text, id_marks[i], length))
            return length;
    }
    return 0;
}

fg_status html_svg(FILE *f, const fg_log *log, const char *path, const char *prefix)
{
    char *text;
    size_t size;
    if (access(path, R_OK))
        return FG_OK;
    const fg_status status = file_read(log, path, MAX_PART, &text, &size);
    if (status != FG_OK)
        return status;
    const char *at = strstr(text, "<svg");
    while (at && *at) {
        const size_t length = mark_at(at);
        if (length) {
            fwrite(at, 1, length, f);
            fputs(prefix, f);
            at += length;
        } else {
            fputc(*at++, f);
        }
    }
    free(text);
    return FG_OK;
}
