/* Executes a recording, or the result of passes on it, four lanes at a time by the table of operations. This
 * reading of the specification belongs to no engine.
 *
 * It records events: the values of each instruction, in the order of execution. In a loop an event has a
 * visit, the pass of the loop, which distinguishes the executions of an instruction. */
#ifndef COMMAND_FUZZ_BISECT_INTERPRET_H
#define COMMAND_FUZZ_BISECT_INTERPRET_H

#include "command/fuzz/bisect/replay.h"
#include "ir/ir.h"

enum { EVENT_CAPACITY = 1 << 20, VISIT_CAPACITY = 4096, LOOP_DEPTH = 64 };

/* Pass `pass`, from 0, of the loop of that number (in the order of the recording), inside of visit
 * `outer`. Visit 0 is outside of all loops. */
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

/* Executes the recording on the four lanes from `lane` on of a replay's first entry, in the image, with the
 * MXCSR of the contract. With `notes`, replaces the recorded events. Returns false if it executed more than
 * any program may. */
bool interpret(struct interpreter *interpreter, const struct ir *ir, const struct replay *replay,
               uint8_t *image, uint32_t lane, bool notes);

/* The same for all lanes of the call, which is of one entry, from `before` on. */
bool interpret_all(struct interpreter *interpreter, const struct ir *ir, const struct replay *replay,
                   uint8_t *image);

/* The events that were recorded. */
struct event_list {
    const struct event *event;
    const struct visit *visit;
    uint32_t count, visits;
    bool cut; /* there were more than there is room for */
};
struct event_list interpreter_events(const struct interpreter *interpreter);

#endif
