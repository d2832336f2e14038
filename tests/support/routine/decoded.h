/* Disassembles an instruction that the encoder wrote, and fails the test if a requirement is not met. */
#ifndef TESTS_SUPPORT_ROUTINE_DECODED_H
#define TESTS_SUPPORT_ROUTINE_DECODED_H

#include "engines/specialize/encode/encode.h"

#include <Zydis/Zydis.h>
#include <stdbool.h>
#include <stdint.h>

/* The instruction under test is at offset HERE, between a bound label and one that is bound after it. */
enum {
    DECODED_ROOM = 512,
    DECODED_HERE = 160,
    DECODED_BEHIND = 0,
    DECODED_AHEAD = 1,
    DECODED_LABELS = 2,
    DECODED_FIXUPS = 4,
    DECODED_BEHIND_OFFSET = 16,
    DECODED_AHEAD_OFFSET = 400
};

extern struct decoded {
    uint8_t code[DECODED_ROOM];
    int32_t labels[DECODED_LABELS];
    struct fixup fixups[DECODED_FIXUPS];
    struct encoder encoder;
    unsigned length; /* of the instruction, according to the encoder */
    ZydisDecoder decoder;
    ZydisDecodedInstruction decoded;
    ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
    /* The encoder prints the instruction, and the assembler reads it. */
    bool by_text;
    char text[DECODED_ROOM];
    struct encode_text line;
    int unit;        /* of a displacement of one byte */
    const char *row; /* its id, for messages */
} decoded_at;

void decoded_require(bool condition, const char *what);

struct encoder *decoded_begin(void);

/* Runs a test of the encoder, and again by way of text. */
void decoded_run(void (*test)(void), const char *name, const char *name_by_text, int line);

/* Decodes the bytes since `begin`. The bytes after them are not an instruction, so a wrong length is
 * detected. */
void decoded_finish(const char *mnemonic, unsigned operand_count);

/* The expected operand. */

void decoded_require_register(unsigned operand, ZydisRegister first, unsigned number);

/* `index_first` is rax, or the first of the gather's index registers. `bits` 0: memory that is not accessed.
 */
void decoded_require_memory(unsigned operand, struct address address, ZydisRegister index_first,
                            unsigned bits);

void decoded_require_immediate(unsigned operand, int64_t value, bool is_signed);

/* Addresses: every base with every displacement class, every base, index and scale, no base, and both labels.
 */

typedef void decoded_address_function(void *context, struct address address);

/* Every other displacement with every other scale, alternating from call to call; all of them in a long run.
 */
void decoded_for_each_indexed(decoded_address_function *function, void *context, bool vector_index);

void decoded_for_each_address(decoded_address_function *function, void *context);

#endif
