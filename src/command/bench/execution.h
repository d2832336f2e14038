/* The lanes and instruction set of the routines that an engine ran, read from the routines themselves:
 * TRIPTYCH_CPU and the processor are respected because the code that ran is decoded. */
#ifndef COMMAND_BENCH_EXECUTION_H
#define COMMAND_BENCH_EXECUTION_H

#include "contract/engine.h"
#include "triptych.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

enum { EXECUTION_TEXT = 40 };

/* Zero: no routine so far. */
struct execution {
    unsigned lanes[UNIT_COUNT];  /* of the widest routine of each unit; 0: none */
    const char *instruction_set; /* the largest of all routines; null: no routine */
};

/* Adds a routine. */
void execution_add(struct execution *execution, const struct routine *routine);
/* Adds all routines of the device. */
void execution_add_device(struct execution *execution, triptych_device *device);
/* Adds what another execution has. */
void execution_add_all(struct execution *execution, const struct execution *other);

/* Prints the lanes: "8", or "16/8/16" (vertex, setup, pixel) where units differ; "" without routines.
 * Returns text. */
const char *execution_lanes(const struct execution *execution, char text[EXECUTION_TEXT]);
/* Returns the instruction set; "" without routines. */
const char *execution_set(const struct execution *execution);

/* Adds the fields "lanes" and "instruction_set", both strings. */
void execution_json(const struct execution *execution, cJSON *object);

/* Adds the field "unit_lanes", the lanes of the units, so that executions can be joined. */
void execution_json_units(const struct execution *execution, cJSON *object);
/* Reads that field; lanes that are missing or not a possible number are 0. */
void execution_units(const cJSON *object, unsigned lanes[UNIT_COUNT]);

#endif
