/* The search for a regular expression in lines as a kernel: one line in each lane.
 *
 * The state is the set of active positions, as bits of up to four words. The code depends on the whole
 * automaton: how positions follow each other, and how the class of a byte is found. */
#ifndef CLIENTS_MATCHER_MATCHER_H
#define CLIENTS_MATCHER_MATCHER_H

#include "bench/clients/kernel.h"
#include "bench/clients/matcher/automaton.h"

#include <stddef.h>

struct matcher_job {
    const uint8_t *text;
    const uint32_t *table; /* the automaton's */
};

extern const struct kernel_text matcher_kernel;
enum { MATCHER_STRIDE = 4 };

void matcher_record(struct ir *ir, const void *automaton);
void matcher_execute(const void *automaton, const struct kernel_arguments *call, unsigned stride);

/* Sets found[n] to 1 if line n contains a match, else to 0. Line n begins at text + line[n] and ends at a
 * newline, after whose last there are at least 3 readable bytes. The arrays have room for a multiple of
 * KERNEL_ELEMENTS lines; the elements after the last line are overwritten. `lines` is at least 1. */
void matcher_kernel_lines(const struct kernel *kernel, const struct automaton *automaton, const uint8_t *text,
                          int32_t *line, uint32_t lines, uint32_t *found);

#endif
