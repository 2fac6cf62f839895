// SPDX-License-Identifier: MIT
#ifndef HTML_H
#define HTML_H

#include <fg/base.h>
#include <stdio.h>

// Pieces of a self-contained page.

void html_text(FILE *f, const char *text); // escaped, also for attributes in double quotes

// <td>: a number, or a dash where it is not finite; text, to the left.
void html_number(FILE *f, double value, const char *format);
void html_cell(FILE *f, const char *text);

// The file as data:TYPE;base64,... Errors as file_read().
FG_NODISCARD fg_status html_data(FILE *f, const fg_log *log, const char *path, const char *type);

// The <svg> element of the file with `prefix` before every id, so that several can stand in one
// page. Writes nothing if there is no such file.
FG_NODISCARD fg_status html_svg(FILE *f, const fg_log *log, const char *path, const char *prefix);

#endif // HTML_H
