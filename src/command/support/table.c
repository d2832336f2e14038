#include "command/support/table.h"
#include "command/support/tool.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void table_column(struct table *table, const char *heading, enum table_alignment alignment)
{
    table->alignment[table->columns] = alignment;
    snprintf(table->heading[table->columns++], TABLE_HEADING, "%s", heading);
}

static int grow(struct table *table)
{
    unsigned capacity = table->capacity ? 2 * table->capacity : 64;
    char **cell = realloc(table->cell, capacity * sizeof *cell);
    if (!cell)
        return -1;
    table->cell = cell;
    table->capacity = capacity;
    return 0;
}

static char *print_cell(const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = malloc((size_t)length + 1);
    if (text)
        vsnprintf(text, (size_t)length + 1, format, arguments);
    return text;
}

void table_cell(struct table *table, const char *format, ...)
{
    table->incomplete |= table->cells == table->capacity && grow(table);
    if (table->incomplete)
        return;
    va_list arguments;
    va_start(arguments, format);
    char *text = print_cell(format, arguments);
    va_end(arguments);
    table->incomplete = !text;
    if (text)
        table->cell[table->cells++] = text;
}

static void print_row(const struct table *table, char *const *cell, const int *width, unsigned indent,
                      FILE *out)
{
    fprintf(out, "%*s", (int)indent, "");
    for (unsigned i = 0; i < table->columns; i++) {
        /* Avoids spaces at the end of a line. */
        bool last_left = table->alignment[i] == TABLE_LEFT && i + 1 == table->columns;
        int field = last_left ? 0 : table->alignment[i] == TABLE_LEFT ? -width[i] : width[i];
        fprintf(out, "%s%*s", i ? "  " : "", field, cell[i]);
    }
    fputc('\n', out);
}

void table_print(struct table *table, unsigned indent, FILE *out)
{
    int width[TABLE_COLUMNS] = {0};
    char *headings[TABLE_COLUMNS] = {0};
    unsigned rows = table->columns ? table->cells / table->columns : 0;
    for (unsigned i = 0; i < table->columns; i++) {
        headings[i] = table->heading[i];
        width[i] = (int)strlen(headings[i]);
        for (unsigned row = 0; row < rows; row++) {
            int length = (int)strlen(table->cell[row * table->columns + i]);
            width[i] = length > width[i] ? length : width[i];
        }
    }
    print_row(table, headings, width, indent, out);
    for (unsigned row = 0; row < rows; row++)
        print_row(table, table->cell + row * table->columns, width, indent, out);
    if (table->incomplete)
        tool_report_mark_incomplete();
    for (unsigned i = 0; i < table->cells; i++)
        free(table->cell[i]);
    free(table->cell);
    *table = (struct table){0};
}
