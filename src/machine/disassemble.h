/* Disassembly by Zydis, which shares no code with the encoder: listings of generated and stitched routines,
 * and an independent check for tests. */
#ifndef MACHINE_DISASSEMBLE_H
#define MACHINE_DISASSEMBLE_H

#include <stddef.h>
#include <stdint.h>

/* Receives one instruction: `length` bytes at `offset` from the start of the code, in Intel syntax. `text` is
 * valid during the call. */
typedef void disassemble_line(void *context, size_t offset, size_t length, const char *text);

/* Decodes `count` bytes and calls `line` for each instruction, in order, without gaps. Targets and
 * rip-relative operands are printed as absolute addresses of code that runs at `address`. A byte that starts
 * no valid instruction, or one cut off by the end, becomes a line `db 0x..` of length 1. Returns the number
 * of lines. */
size_t disassemble(const void *code, size_t count, uint64_t address, disassemble_line *line, void *context);

/* The least instruction set with every instruction of the code: "AVX-512" if any has an EVEX encoding, else
 * "AVX2" if any has a VEX encoding, else "SSE2". Bytes that start no valid instruction are skipped. */
const char *disassemble_set(const void *code, size_t count);

/* The numbers of instructions of code. */
struct disassemble_counts {
    uint32_t instructions; /* without nops */
    uint32_t reads;        /* instructions that read a memory operand */
    uint32_t writes;       /* instructions that write one */
    uint32_t frame;        /* of both, those in the stack frame: relative to rsp or rbp */
};

/* Counts the instructions of the code. Bytes that start no valid instruction are skipped. */
struct disassemble_counts disassemble_count(const void *code, size_t count);

#endif
