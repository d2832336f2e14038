/* An assembler for the text that an encoder prints: a part of the syntax of NASM. Mnemonics, operands and
 * encodings are the rows of def/engine/x86.def. A line is
 *
 *     [LABEL:] [MNEMONIC [OPERAND, ...]] [; comment]
 *
 * Labels are L and a number below the encoder's label_count. Directives: `dd` with constants, `align`, `bits
 * 64`. Of several encodings of an instruction the shortest is chosen, of equal ones the first row. Jumps are
 * short if they go back to a label within reach, as the encoder's are; `near` may precede a label that is not
 * yet bound. */
#ifndef ENGINES_SPECIALIZE_EMIT_ASSEMBLE_H
#define ENGINES_SPECIALIZE_EMIT_ASSEMBLE_H

#include "engines/specialize/encode/operand.h"

enum { MNEMONIC_BUCKETS = 512, MNEMONICS = 2 * X86_VECTOR_COUNT + X86_GPR_COUNT };

/* The rows of x86.def by a hash of their mnemonics; all zero: not filled yet. */
struct mnemonics {
    bool filled;
    uint16_t bucket[MNEMONIC_BUCKETS]; /* 1 + the first row, 0: none */
    uint16_t next[MNEMONICS]; /* 1 + the next row of the bucket, in the order of the table, 0: none */
};

/* A text that is being read. */
struct assembler {
    const char *start, *at, *end;
    unsigned line; /* the number of lines read */
    struct encoder *encoder;
    struct mnemonics *mnemonics;
    struct error *error;
};

/* Reads one line and appends its bytes to the encoder, which has no text. Returns 0, or -1 with the reason:
 * the line's number, what was found, what was expected. Before the first call, `at` equals `start`. */
int encode_assemble_line(struct assembler *assembler);

/* For assemble.c: encodes an instruction (match.c). Returns 0, or -1 with the reason. */
int encode_match(struct assembler *assembler, const char *mnemonic, size_t length,
                 const struct x86_operand operands[X86_OPERANDS], unsigned count);

/* Reports an error of the current line. Returns -1. */
int encode_assemble_fail(struct assembler *assembler, const char *found, size_t length, const char *expected);

#endif
