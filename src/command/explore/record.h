/* The recording of a routine, with the place of the specification that recorded each instruction: its line,
 * the lines of the calls that led to it, and the step of the shader.
 *
 * The binding is the recorder's own (ir/bind.h), compiled again with a hook in E. The calls are known from
 * the addresses of the stack frames in which E is evaluated, so record.c is compiled without inlining. */
#ifndef COMMAND_EXPLORE_RECORD_H
#define COMMAND_EXPLORE_RECORD_H

#include "ir/ir.h"

enum { EXPLORE_NO_PLACE = UINT32_MAX };

/* A line of the specification, as reached by one chain of calls. */
struct explore_place {
    const char *file; /* from "spec/" on */
    const char *function;
    uint32_t line;
    uint32_t caller;         /* the place of the call, which has a lower number; EXPLORE_NO_PLACE: none */
    uint32_t child, sibling; /* the first place called from here; the next one of the same caller; 0: none */
};

struct explore_recording {
    struct ir *ir;
    uint32_t *place; /* by instruction: its place; that of instruction 0 is EXPLORE_NO_PLACE */
    struct explore_place *places;
    uint32_t place_count, place_capacity;
};

/* Records the specification of the unit for the key. Returns 0, or -1 with the reason. Free the recording in
 * both cases. */
int explore_record(struct explore_recording *recording, enum unit unit, const union key *key,
                   struct error *error);
void explore_record_free(struct explore_recording *recording);

#endif
