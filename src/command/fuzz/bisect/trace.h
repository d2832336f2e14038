/* Traces the emulator: every value that its reading of the specification computes.
 *
 * The binding is the emulator's own (emu/emulate/bind.h), compiled again with its hook in place. Effects are
 * not recorded; each value has the line of the specification that computed it. */
#ifndef COMMAND_FUZZ_BISECT_TRACE_H
#define COMMAND_FUZZ_BISECT_TRACE_H

#include "contract/binding.h"

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
