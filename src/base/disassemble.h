/* Machine code back to text, by a decoder that shares nothing with the encoder (Zydis): listings of generated
 * and stitched routines, and the tests' second opinion. */
#ifndef BASE_DISASSEMBLE_H
#define BASE_DISASSEMBLE_H

#include <stddef.h>
#include <stdint.h>

/* One instruction: `length` bytes at `offset` from the start of the code, in Intel syntax. `text` is valid
 * only during the call. */
typedef void disassemble_line(void *context, size_t offset, size_t length, const char *text);

/* Decodes `count` bytes and calls `line` for each instruction, in order, without gaps. Targets and
 * rip-relative operands are printed as absolute addresses of code that runs at `address`. A byte that starts
 * no instruction, or one that is cut off by the end, becomes a line `db 0x..` of length 1. Returns the number
 * of lines. */
size_t disassemble(const void *code, size_t count, uint64_t address, disassemble_line *line, void *context);

#endif
