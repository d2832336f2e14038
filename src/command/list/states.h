/* `triptych list states`: the tables of states as JSON, as text, and as the page docs/states.md. */
#ifndef COMMAND_LIST_STATES_H
#define COMMAND_LIST_STATES_H

#include <cjson/cJSON.h>
#include <stdio.h>

/* Adds an object for each state to the array. */
void states_list(cJSON *rows);

/* Prints the three tables, the kinds with their words, and totals. */
void states_print(FILE *out);

/* Prints the page docs/states.md. */
void states_print_markdown(FILE *out);

#endif
