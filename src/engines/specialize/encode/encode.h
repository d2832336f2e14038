/* The machine-code encoder: turns an instruction and its operands into x86-64 bytes.
 *
 * Vector instructions have a vector length. They are VEX-encoded unless they need EVEX: 512 bits, registers
 * 16 to 31, a mask, or a broadcast operand. General-register instructions have an operand size. The
 * instructions are the rows of src/def/engine/x86.def. A function's name spells its operands in Intel order,
 * destination first: r is a register, m memory, i an immediate. For example:
 *     encode_rrm(e, X86_vaddps, X86_256, 3, 4, address_at(X86_RDI, 64));      vaddps ymm3, ymm4, [rdi + 64]
 *     encode_mr(e, X86_vmovups_store, X86_128, address_at(X86_RSP, 32), 9);   vmovups [rsp + 32], xmm9
 *     encode_gpr_ri(e, X86_add, X86_64, X86_RDI, 16);                                add rdi, 16
 * The caller picks a row whose form has those operands (asserted). The shortest encoding is chosen: two-byte
 * VEX, no displacement or one of 8 bits, 8-bit immediates, short backward jumps.
 *
 * The bytes are written to the memory given to encode_start; nothing is allocated. Each instruction needs
 * ENCODER_SLACK free bytes, because it is stored in whole words. If there are fewer, or if the caller's fixup
 * table is full, the encoder's `failure` is set, and this and all later calls write nothing. It is enough to
 * check the result of encode_finish.
 *
 * Labels are numbers below label_count, for basic blocks and literals. The caller's array has their offsets
 * from `start`. A reference to a label that is not yet bound becomes a fixup, which encode_finish patches.
 * An encoder with a text prints instructions instead of encoding them, in the syntax of NASM (print.c).
 * assemble.h reads such a text.
 *
 * Code is position-independent: every reference is relative to rip, so code may be written through one
 * mapping and run through another. */
#ifndef ENGINES_SPECIALIZE_EMIT_ENCODE_H
#define ENGINES_SPECIALIZE_EMIT_ENCODE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum x86_vector {
#define X86_VECTOR(id, ...)   X86_##id,
#define X86_EVEX_OWN(id, ...) X86_##id,
#include "def/engine/x86.def"
    X86_VECTOR_COUNT
};

enum x86_gpr {
#define X86_GPR(id, ...) X86_##id,
#include "def/engine/x86.def"
    X86_GPR_COUNT
};

enum x86_condition {
#define X86_CONDITION(name, code) X86_IF_##name = code,
#include "def/engine/x86.def"
};

enum gpr {
    X86_RAX,
    X86_RCX,
    X86_RDX,
    X86_RBX,
    X86_RSP,
    X86_RBP,
    X86_RSI,
    X86_RDI,
    X86_R8,
    X86_R9,
    X86_R10,
    X86_R11,
    X86_R12,
    X86_R13,
    X86_R14,
    X86_R15,
};

/* Values are VEX.L, and EVEX.L'L. */
enum vector_length {
    X86_128 = 0,
    X86_256 = 1,
    X86_512 = 2,
};

/* Values are REX.W. */
enum gpr_size {
    X86_32 = 0,
    X86_64 = 1,
};

/* Predicates of vcmpps. The ordered ones are false on NaN; none signals on a quiet NaN. */
enum vector_predicate {
    X86_CMP_EQ = 0x00,
    X86_CMP_UNORD = 0x03,
    X86_CMP_NEQ = 0x04,
    X86_CMP_ORD = 0x07,
    X86_CMP_LT = 0x11,
    X86_CMP_LE = 0x12,
    X86_CMP_NLT = 0x15,
    X86_CMP_NLE = 0x16,
    X86_CMP_GE = 0x1D,
    X86_CMP_GT = 0x1E,
};

/* Predicates of vpcmpd. */
enum integer_predicate {
    X86_VPCMP_EQ = 0,
    X86_VPCMP_LT = 1,
    X86_VPCMP_GT = 6,
};

/* Rounding of vroundps, with the inexact exception suppressed. */
enum vector_rounding {
    X86_ROUND_NEAREST = 0x08,
    X86_ROUND_DOWN = 0x09,
    X86_ROUND_UP = 0x0A,
    X86_ROUND_TRUNCATE = 0x0B,
};

/* A masked destination: an instruction writes only the lanes that are set in mask register `k` (1 to 7). The
 * other lanes keep their contents, or become zero. */
static inline unsigned masked(unsigned to, unsigned k)
{
    return to | k << 8;
}

static inline unsigned zeroed(unsigned to, unsigned k)
{
    return masked(to, k) | 1u << 15;
}

enum {
    X86_NONE = 0xFF,      /* no base, no index */
    X86_RIP_LABEL = 0xFE, /* base: the address of `label` */
    ENCODER_SLACK = 16,   /* free bytes that an instruction needs; the longest has 15 */
    LABEL_UNBOUND = -1,
};

/* [base + index * scale + displacement], or [label + displacement]. `base` is a gpr, X86_NONE or
 * X86_RIP_LABEL (then without an index). `index` is a gpr other than rsp, X86_NONE, or for gathers a vector
 * register. `scale` is 1, 2, 4 or 8. With `broadcast`, memory is one element, which all lanes read. `mask` is
 * the mask register whose lanes are stored, 0: all. */
struct address {
    uint8_t base;
    uint8_t index;
    uint8_t scale;
    uint8_t broadcast;
    uint8_t mask;
    int32_t displacement;
    uint32_t label;
};

/* A rel32 at `offset` whose label is not yet bound. It becomes target + addend - offset. */
struct fixup {
    uint32_t offset;
    uint32_t label;
    int32_t addend;
};

enum encoder_failure {
    ENCODER_FINE,
    ENCODER_OUT_OF_CODE,   /* the caller's memory is full */
    ENCODER_OUT_OF_FIXUPS, /* the caller's fixup table is full */
    ENCODER_UNBOUND_LABEL, /* a label was used and never bound: an error of the caller */
    ENCODER_OUT_OF_TEXT,   /* the memory for text is full */
};

/* Memory for instructions as text, which has no zero at its end. */
struct encode_text {
    char *start, *at, *limit;
};

struct encoder {
    uint8_t *start;
    uint8_t *at; /* the next byte */
    uint8_t *limit;
    int32_t *labels;
    struct fixup *fixups;
    uint32_t label_count;
    uint32_t fixup_count;
    uint32_t fixup_capacity;
    enum encoder_failure failure;
    struct encode_text *text; /* not null: instructions are printed there, and no bytes are written */
};

static inline struct address address_at(unsigned base, int32_t displacement)
{
    return (struct address){
        .base = (uint8_t)base, .index = X86_NONE, .scale = 1, .displacement = displacement};
}

/* `index` is a gpr, or a vector register's number for a gather. */
static inline struct address address_indexed(unsigned base, unsigned index, unsigned scale,
                                             int32_t displacement)
{
    return (struct address){.base = (uint8_t)base,
                            .index = (uint8_t)index,
                            .scale = (uint8_t)scale,
                            .displacement = displacement};
}

/* `displacement` bytes after the position of `label`, which may be bound later. */
static inline struct address address_label(uint32_t label, int32_t displacement)
{
    return (struct address){
        .base = X86_RIP_LABEL, .index = X86_NONE, .scale = 1, .displacement = displacement, .label = label};
}

/* Starts encoding at `code`, which has `bytes` bytes, under 2 GiB. All `label_count` entries of `labels`
 * become unbound. The arrays belong to the caller and are used until encode_finish. Each forward reference
 * takes one fixup. */
void encode_start(struct encoder *encoder, void *code, size_t bytes, int32_t *labels, uint32_t label_count,
                  struct fixup *fixups, uint32_t fixup_capacity);

/* Adds an unbound label and returns its number, the previous label_count. The caller's array must have room.
 */
uint32_t encode_add_label(struct encoder *encoder);

/* Patches all forward references. Returns 0, or -1 with the reason and `failure` set. */
int encode_finish(struct encoder *encoder, struct error *error);

/* The number of bytes written, which is the offset of the next instruction; of characters, if there is a
 * text. */
static inline size_t encode_size(const struct encoder *encoder)
{
    return (size_t)(encoder->text ? encoder->text->at - encoder->text->start : encoder->at - encoder->start);
}

/* Binds `label`, once, to the next byte. */
void encode_label(struct encoder *encoder, uint32_t label);

/* Appends `count` bytes of data. */
void encode_data(struct encoder *encoder, const void *bytes, size_t count);

/* Appends nops up to the next multiple of `alignment`, a power of two, from `start`. */
void encode_align(struct encoder *encoder, unsigned alignment);

/* Appends `count` bytes of nops. For tests: the padding by itself. */
void encode_nops(struct encoder *encoder, unsigned count);

/* Returns true if an instruction has an encoding with a broadcast operand. */
bool encode_broadcasts(enum x86_vector);

/* Returns true if the instruction's memory operand has four bytes. */
bool encode_reads_word(enum x86_vector);

/* Vector instructions. A register operand is the number of a vector register, 0 to 31, or of a mask register
 * or a gpr if the row has one there. Each comment lists the forms of x86.def that the function accepts. */
void encode_none(struct encoder *, enum x86_vector);                                               /* NONE */
void encode_m(struct encoder *, enum x86_vector, struct address);                                  /* M */
void encode_rr(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned from); /* RM MR */
void encode_rm(struct encoder *, enum x86_vector, enum vector_length, unsigned to,
               struct address from); /* RM */
void encode_mr(struct encoder *, enum x86_vector, enum vector_length, struct address to,
               unsigned from); /* MR */
void encode_rri(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned from,
                unsigned immediate); /* RMI MRI VMI */
void encode_rmi(struct encoder *, enum x86_vector, enum vector_length, unsigned to, struct address from,
                unsigned immediate); /* RMI VMI */
void encode_mri(struct encoder *, enum x86_vector, enum vector_length, struct address to, unsigned from,
                unsigned immediate); /* MRI */
void encode_rrr(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                unsigned second); /* RVM */
void encode_rrm(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                struct address second); /* RVM */
void encode_rrri(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                 unsigned second, unsigned immediate); /* RVMI */
void encode_rrmi(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                 struct address second, unsigned immediate); /* RVMI */
void encode_rrrr(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                 unsigned second, unsigned third); /* RVMS */
void encode_rrmr(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                 struct address second, unsigned third); /* RVMS */
/* For tests: they encode every row of def/engine/x86.def. */
void encode_mrr(struct encoder *, enum x86_vector, enum vector_length, struct address to, unsigned mask,
                unsigned from); /* MVR */

/* Loads the lanes of `to` whose sign in `mask` is set, and clears `mask`. `to`, `mask` and the index must be
 * different. */
void encode_gather(struct encoder *, enum x86_vector, enum vector_length, unsigned to, struct address from,
                   unsigned mask); /* GATHER */

/* Copies a whole register with vmovaps, by the opcode with the shorter encoding. With registers above 15, or
 * 512 bits, both take six bytes, and it is the first row. */
static inline void encode_copy(struct encoder *encoder, enum vector_length length, unsigned to, unsigned from)
{
    bool store = length != X86_512 && from >= 8 && from < 16 && to < 8;
    encode_rr(encoder, store ? X86_vmovaps_store : X86_vmovaps, length, to, from);
}

/* General-register instructions. */
void encode_gpr_rr(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, enum gpr from);
void encode_gpr_rm(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, struct address from);
void encode_gpr_mr(struct encoder *, enum x86_gpr, enum gpr_size, struct address to, enum gpr from);
void encode_gpr_ri(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, int32_t immediate);
void encode_gpr_mi(struct encoder *, enum x86_gpr, enum gpr_size, struct address to, int32_t immediate);
void encode_gpr_rri(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, enum gpr from,
                    int32_t immediate);
/* For tests: they encode every row of def/engine/x86.def. */
void encode_gpr_rmi(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, struct address from,
                    int32_t immediate);
void encode_gpr_r(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr);
/* For tests: they encode every row of def/engine/x86.def. */
void encode_gpr_m(struct encoder *, enum x86_gpr, enum gpr_size, struct address);

/* Sets all 64 bits of `to` with the shortest mov, without changing flags. For tests: they encode every row of
 * def/engine/x86.def. */
void encode_gpr_constant(struct encoder *, enum gpr to, uint64_t value);

/* Control flow. Backward jumps within 128 bytes take two bytes. */
void encode_jump(struct encoder *, uint32_t label);
void encode_jump_if(struct encoder *, enum x86_condition, uint32_t label);
void encode_call(struct encoder *, uint32_t label);
void encode_return(struct encoder *);

#endif
