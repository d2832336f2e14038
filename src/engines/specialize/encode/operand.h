/* Operands of instructions, and the rows of def/engine/x86.def as text: what the printer (print.c) and the
 * assembler (assemble.c, match.c) share. Neither is used unless an encoder has a text. */
#ifndef ENGINES_SPECIALIZE_EMIT_OPERAND_H
#define ENGINES_SPECIALIZE_EMIT_OPERAND_H

#include "engines/specialize/encode/encode.h"

/* The encoder only distinguishes registers, memory and immediates: a row decides which register a number
 * names. Text has names. */
enum x86_operand_kind {
    X86_OPERAND_NONE,
    X86_OPERAND_REGISTER, /* of the kind that the row has there */
    X86_OPERAND_XMM,
    X86_OPERAND_YMM,
    X86_OPERAND_ZMM,
    X86_OPERAND_MASK,
    X86_OPERAND_GPR8,
    X86_OPERAND_GPR16,
    X86_OPERAND_GPR32,
    X86_OPERAND_GPR64,
    X86_OPERAND_MEMORY,
    X86_OPERAND_IMMEDIATE
};

enum { X86_OPERANDS = 4 };

struct x86_operand {
    uint8_t kind;    /* enum x86_operand_kind */
    uint8_t index;   /* of memory: the kind of its index register, X86_OPERAND_NONE: without one */
    uint16_t bits;   /* of memory: its stated size, 0: none */
    unsigned number; /* of a register, with its decorations (masked, zeroed) */
    int64_t immediate;
    struct address address;
};

static inline struct x86_operand x86_operand_register(unsigned number)
{
    return (struct x86_operand){.kind = X86_OPERAND_REGISTER, .number = number};
}

static inline struct x86_operand x86_operand_memory(struct address address)
{
    return (struct x86_operand){.kind = X86_OPERAND_MEMORY, .address = address};
}

static inline struct x86_operand x86_operand_immediate(int64_t value)
{
    return (struct x86_operand){.kind = X86_OPERAND_IMMEDIATE, .immediate = value};
}

/* The VEX or the EVEX encoding of a row. */
struct vector_form {
    const char *mnemonic; /* null: the row has no such encoding */
    const char *fields;   /* of the operands in their order: R, V, M, I or S, as in x86.def */
    char reg, vvvv, rm;   /* classes of registers, as in x86.def */
    uint8_t lengths;      /* bit l: enum vector_length l */
    int16_t memory;       /* bits; -1, -2, -4: the vector length, a half, a quarter of it; 0: none */
    uint8_t broadcast;    /* bits of an element that memory may be, 0: none */
    bool masks, zeroes;   /* lanes outside of a mask can keep their contents, can become zero */
};

extern const struct vector_form encode_vex_form[X86_VECTOR_COUNT], encode_evex_form[X86_VECTOR_COUNT];

/* The kind of register that a field of a form has, X86_OPERAND_NONE if it has none. */
enum x86_operand_kind encode_field_kind(const struct vector_form *form, char field,
                                        enum vector_length length);

/* The bits of memory of a form. */
unsigned encode_memory_bits(const struct vector_form *form, enum vector_length length);

/* Returns true if an instruction with these operands has an EVEX encoding. */
bool encode_needs_evex(enum x86_vector, enum vector_length, const struct x86_operand operands[X86_OPERANDS],
                       unsigned count);

/* Mnemonics, shapes and sizes of the rows of general-register instructions (encode_gpr.c). */
extern const char *const encode_gpr_mnemonic[X86_GPR_COUNT];

/* The sizes in bits of the operand in ModRM.reg and of the one in ModRM.rm; 0 for memory that is not
 * accessed. */
void encode_gpr_bits(enum x86_gpr, enum gpr_size, unsigned *reg, unsigned *rm);

/* Returns true if a row's immediate is an unsigned count. */
bool encode_gpr_counts(enum x86_gpr);

/* Returns true if a row has the shape of these operands: registers, memory and immediates in their order. */
bool encode_gpr_has_shape(enum x86_gpr, const struct x86_operand operands[X86_OPERANDS], unsigned count);

/* The printer. Each writes one line to encoder->text. */
void encode_print_vector(struct encoder *, enum x86_vector, enum vector_length,
                         const struct x86_operand *operands);
void encode_print_gpr(struct encoder *, enum x86_gpr, enum gpr_size, const struct x86_operand *operands,
                      unsigned count);
void encode_print_jump(struct encoder *, const char *condition, uint32_t label);
void encode_print_call(struct encoder *, uint32_t label);
void encode_print_label(struct encoder *, uint32_t label);
void encode_print_words(struct encoder *, const void *bytes, size_t count);
void encode_print_directive(struct encoder *, const char *name, unsigned number);

#endif
