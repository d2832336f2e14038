#include "command/support/table.h"
#include "command/support/tool.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void table_column(struct table *table, const char *heading, enum table_alignment alignment)
{
    table->alignment[table->columns] = alignment;
    snprintf(table->heading[table->columns++], TABLE_CELL, "%s", heading);
}

static int grow(struct table *table)
{
    unsigned capacity = table->capacity ? 2 * table->capacity : 64;
    void *cell = realloc(table->cell, capacity * sizeof *table->cell);
    if (!cell)
        return -1;
    table->cell = cell;
    table->capacity = capacity;
    return 0;
}

void table_cell(struct table *table, const char *format, ...)
{
    table->incomplete |= table->cells == table->capacity && grow(table);
    if (table->incomplete)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(table->cell[table->cells++], TABLE_CELL, format, arguments);
    va_end(arguments);
}

static void print_row(const struct table *table, const char (*cell)[TABLE_CELL], const int *width,
                      unsigned indent, FILE *out)
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
    unsigned rows = table->columns ? table->cells / table->columns : 0;
    for (unsigned i = 0; i < table->columns; i++) {
        width[i] = (int)strlen(table->heading[i]);
        for (unsigned row = 0; row < rows; row++) {
            int length = (int)strlen(table->cell[row * table->columns + i]);
            width[i] = length > width[i] ? length : width[i];
        }
    }
    print_row(table, table->heading, width, indent, out);
    for (unsigned row = 0; row < rows; row++)
        print_row(table, table->cell + row * table->columns, width, indent, out);
    if (table->incomplete)
        tool_report_mark_incomplete();
    free(table->cell);
    *table = (struct table){0};
}
