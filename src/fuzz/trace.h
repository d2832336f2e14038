/* What the emulator computes, value by value: its reading of the specification with everything written down.
 *
 * The binding is the emulator's own (emu/bind.h), compiled once more with its hook in place. Effects are not written down;
 * each value has the line of the specification that made it. */
#ifndef FUZZ_TRACE_H
#define FUZZ_TRACE_H

#include "def/binding.h"

#include <stdbool.h>

struct traced {
    uint32_t lane[4];
    uint16_t line;
};

enum { TRACE_CAPACITY = 1 << 21 };

struct trace {
    struct traced *value;
    uint32_t count, capacity;
    bool full; /* what came after TRACE_CAPACITY values, or after memory was refused, is missing */
};

/* Performs the unit on four lanes whose memory begins at the bases, under the contract's MXCSR. */
void trace_emulate(struct trace *trace, enum unit unit, const union key *key,
                   const uint8_t *const base[BASE_COUNT]);
void trace_free(struct trace *trace);

#endif
