/* Text tables with aligned columns, for people. Cells are collected first and printed when widths are known.
 */
#ifndef TOOL_TABLE_H
#define TOOL_TABLE_H

#include <stdio.h>

enum { TABLE_COLUMNS = 20, TABLE_CELL = 96 };

enum table_alignment { TABLE_LEFT, TABLE_RIGHT };

/* Zero is an empty table. When memory is refused it prints what it has, and the report is incomplete (tool.h). */
struct table {
    unsigned columns, cells, capacity;
    enum table_alignment alignment[TABLE_COLUMNS];
    char heading[TABLE_COLUMNS][TABLE_CELL];
    char (*cell)[TABLE_CELL];
    int incomplete;
};

void table_column(struct table *table, const char *heading, enum table_alignment alignment);

/* The next cell, row by row. */
void table_cell(struct table *table, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints the table, each line behind `indent` spaces, and empties it for other columns. */
void table_print(struct table *table, unsigned indent, FILE *out);

#endif
