/* A recording, or what passes made of it, performed four lanes at a time by the table of operations: the reading that
 * belongs to no engine.
 *
 * It notes events: which instruction gave which values, in the order of execution. In loops an event has a visit, the
 * pass of the loop in which it was, so that one execution of an instruction can be told from another. */
#ifndef FUZZ_INTERPRET_H
#define FUZZ_INTERPRET_H

#include "fuzz/replay.h"
#include "ir/ir.h"

enum { EVENT_CAPACITY = 1 << 20, VISIT_CAPACITY = 4096, LOOP_DEPTH = 64 };

/* Pass `pass`, from 0, of the loop of that number (in the order of the recording), inside of visit `outer`. Visit 0 is
 * outside of all loops. */
struct visit {
    uint32_t outer, loop, pass;
};

struct event {
    uint32_t lane[4];
    uint16_t instruction;
    uint16_t visit;
};

struct interpreter;

/* Null when there is no memory. */
struct interpreter *interpreter_create(void);
void interpreter_free(struct interpreter *interpreter);

/* Performs the recording on the four lanes from `lane` on of a replay's first entry, in the image, under the contract's
 * MXCSR. With `notes`, forgets the events that there are and notes new ones. False if it went on for longer than any
 * program is allowed to. */
bool interpret(struct interpreter *interpreter, const struct ir *ir, const struct replay *replay,
               uint8_t *image, uint32_t lane, bool notes);

/* The same for all lanes of the call, which is of one entry, from `before` on. */
bool interpret_all(struct interpreter *interpreter, const struct ir *ir, const struct replay *replay,
                   uint8_t *image);

/* What was noted. */
struct event_list {
    const struct event *event;
    const struct visit *visit;
    uint32_t count, visits;
    bool cut; /* there were more than there is room for */
};
struct event_list interpreter_events(const struct interpreter *interpreter);

#endif
