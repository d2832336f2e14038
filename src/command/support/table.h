/* Text tables with aligned columns, for people. Cells are collected first, and printed when the widths are
 * known. */
#ifndef COMMAND_SUPPORT_TABLE_H
#define COMMAND_SUPPORT_TABLE_H

#include <stdbool.h>
#include <stdio.h>

enum { TABLE_COLUMNS = 24, TABLE_HEADING = 96 };

enum table_alignment { TABLE_LEFT, TABLE_RIGHT };

/* A zero table is empty. When memory is refused, the table prints the cells that it has, and the report is
 * marked incomplete (tool.h). */
struct table {
    unsigned columns, cells, capacity;
    enum table_alignment alignment[TABLE_COLUMNS];
    char heading[TABLE_COLUMNS][TABLE_HEADING];
    char **cell;
    bool incomplete;
};

void table_column(struct table *table, const char *heading, enum table_alignment alignment);

/* Adds the next cell, row by row, of any length. */
void table_cell(struct table *table, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints the table, each line after `indent` spaces. Then empties it; the columns must be defined again. */
void table_print(struct table *table, unsigned indent, FILE *out);

#endif
