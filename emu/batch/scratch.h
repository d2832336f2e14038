/* Scratch memory for running batches, shared by all routines of the process.
 *
 * Each running call needs one block, and routines run on many threads simultaneously. Blocks are reused, most
 * recently used first, and freed with the last routine. While a routine exists, so does at least one block:
 * if the system refuses memory for another one, a call waits until a block is given back. Calls cannot
 * fail. */
#ifndef EMU_BATCH_SCRATCH_H
#define EMU_BATCH_SCRATCH_H

#include <stdbool.h>
#include <stdint.h>

/* Every routine holds the memory from its build to its end. Returns false when the system refuses the first
 * block. */
bool batch_scratch_hold(void);
void batch_scratch_release(void);

/* A block for one call, 64-byte aligned, with room for any schedule. Give it back. */
uint8_t *batch_scratch_take(void);
void batch_scratch_give(uint8_t *block);

#endif
