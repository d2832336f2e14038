/* The reports of `triptych inspect` as text for people. */
#ifndef COMMAND_INSPECT_PRINT_H
#define COMMAND_INSPECT_PRINT_H

#include <cjson/cJSON.h>

/* Print what inspection.h makes to standard output. */
void print_draws(const cJSON *draws);
void print_state(const cJSON *state);
void print_history(const cJSON *history);

#endif
