/* `triptych list states`: the tables of states for programs, for people, and as docs/states.md. */
#ifndef TOOL_STATES_H
#define TOOL_STATES_H

#include <cjson/cJSON.h>
#include <stdio.h>

/* Adds an object per state to the array. */
void states_list(cJSON *rows);

/* Three tables, the kinds with their words, and counts. */
void states_print(FILE *out);

/* The whole page. */
void states_print_markdown(FILE *out);

#endif
