/* Texture sampling as subroutines (option `calls`): each noted sampling of a recording becomes a call, and
 * samplings that are equal but for their inputs become one subroutine.
 *
 * The routine and its subroutines are programs of their own while passes run, so no pass moves a value from
 * one to another. Afterwards the subroutines follow the routine in one program, for which registers are
 * allocated and code is written:
 *
 *   put 0 %12; put 1 %13         arguments
 *   call subroutine 0
 *   %14 take 0; %15 take 1       results
 *   ...
 *   subroutine 0
 *   %31 take 0; %32 take 1
 *   ...
 *   put 0 %90; put 1 %91
 *   leave
 *
 * Samplings that differ by the texture only, not by its kind and filters, share a subroutine too: a caller
 * moves the job, so that the description of its texture is where the subroutine reads that of another.
 * Subroutines call none. A sampling stays where it is if it has more than SUBROUTINE_INPUTS inputs or
 * SUBROUTINE_OUTPUTS results, if it shares a variable with other code, or if there are SUBROUTINES others. */
#ifndef ENGINES_SPECIALIZE_PASSES_SUBROUTINE_H
#define ENGINES_SPECIALIZE_PASSES_SUBROUTINE_H

#include "engines/specialize/passes/pass.h"

enum { SUBROUTINES = 64, SUBROUTINE_INPUTS = 24, SUBROUTINE_OUTPUTS = 16 };

/* Which samplings become calls: none; all; those whose subroutine has two callers or more. */
enum calls { CALLS_INLINE, CALLS_SAMPLING, CALLS_SHARED };

struct subroutine {
    uint32_t sampling; /* its instructions are those of this one */
    uint32_t callers;
    bool moved; /* a caller moves the job */
};

/* A sampling of the recording. Values are those of the recording. */
struct sampling_site {
    uint16_t callee; /* 1 + the number of its subroutine; 0: it stays where it is */
    uint16_t inputs;
    uint16_t input[SUBROUTINE_INPUTS]; /* in the order of their first use; literals are none */
    int32_t job;                       /* by how many bytes the caller moves the job */
};

/* The memory of a build with calls. */
struct subroutines {
    uint32_t count;
    struct subroutine of[SUBROUTINES];
    struct sampling_site site[IR_SAMPLINGS];
    uint16_t around[IR_CAPACITY]; /* of each instruction: 1 + the number of its sampling; 0: none */
    uint8_t result[IR_CAPACITY];  /* of each value of a sampling: it is used outside */
    uint8_t elsewhere[VARIABLES]; /* of each variable: it is used outside of samplings */
    uint16_t set_in[VARIABLES];   /* of each variable: 1 + the sampling that has set it last */
    uint16_t map[IR_CAPACITY];    /* from the recording to the new program */
    struct ir recording, body;
};

/* Replaces samplings of the recording `ir` by calls. `fixed`: callers do not move the job. Returns the number
 * of subroutines. */
uint32_t pass_find_subroutines(struct ir *ir, struct subroutines *subroutines, enum calls calls, bool fixed);

/* Makes subroutine `number` the program subroutines->body. */
void pass_take_subroutine(struct subroutines *subroutines, uint32_t number);

/* Appends subroutines->body to the program as subroutine `number`. */
void pass_append_subroutine(struct ir *ir, const struct subroutines *subroutines, uint32_t number,
                            uint16_t map[IR_CAPACITY]);

/* Does what pass_run_all does for a program with calls, and appends the subroutines before the required
 * passes. The observer is called for each program before its passes, with PASS_COUNT as the pass and the
 * number of its instructions. These are the routine, each subroutine, and all in one. */
void pass_run_with_subroutines(struct ir *ir, struct pass_memory *memory, struct subroutines *subroutines,
                               uint32_t selected, pass_observer *observer, void *context);

#endif
