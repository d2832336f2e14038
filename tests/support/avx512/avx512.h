/* Executes code for AVX-512 on a processor without it, so that routines of 16 lanes are tested everywhere.
 *
 * The processor refuses an instruction of AVX-512 with the signal SIGILL. The handler executes it, then steps
 * with the trap flag through the code until it is left: instructions that the processor has run on it, those
 * of AVX-512 in the handler. The lower halves of registers 0 to 15 are the processor's. The upper halves,
 * registers 16 to 31 and the masks are kept here. When the code is left, they have no defined value.
 *
 * Instructions that work within lanes of 128 bits are executed with AVX2, each half with the instruction of
 * the same opcode in a VEX prefix, so that the processor rounds and compares. The others are in execute.c.
 * Source: Intel SDM, volume 2. The set is that of def/engine/x86.def; any other instruction ends the process.
 *
 * Where the processor has AVX-512, no signal occurs and nothing is different. */
#ifndef TESTS_SUPPORT_AVX512_AVX512_H
#define TESTS_SUPPORT_AVX512_AVX512_H

#include "machine/code.h"

#include <stdbool.h>
#include <stddef.h>

/* From now on, code in the arena may contain instructions of AVX-512. Not thread-safe: one arena, one thread.
 * Needs AVX2 and FMA. */
void avx512_begin(const struct code_arena *arena);
void avx512_end(void); /* does nothing before avx512_begin() */

/* Returns true if code for AVX-512 can be executed now, by the processor or here. */
bool avx512_runs(void);

/* The instructions that were executed here since avx512_begin(). */
size_t avx512_executed(void);

#endif
