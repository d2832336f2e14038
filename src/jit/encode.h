/* The machine-code encoder: turns one operation with its operands into x86-64 bytes.
 *
 * Vector instructions take a vector length, and are VEX-encoded unless they need what only EVEX has: 512 bits,
 * registers 16 to 31, a mask, a broadcast operand; general-register instructions take an operand
 * size. What can be encoded is src/def/x86.def and nothing else. A function name spells its operands in Intel
 * order, destination first: r a register, m memory, i an immediate; so
 *     vector_rrm(e, X86_vaddps, X86_256, 3, 4, address_at(X86_RDI, 64));      vaddps ymm3, ymm4, [rdi + 64]
 *     vector_mr(e, X86_vmovups_store, X86_128, address_at(X86_RSP, 32), 9);   vmovups [rsp + 32], xmm9
 *     gpr_ri(e, X86_add, X86_64, X86_RDI, 16);                                add rdi, 16
 * The caller picks a row whose form has those operands (asserted); the shortest encoding is chosen: two-byte
 * VEX, no or 8-bit displacement, 8-bit immediate, short backward jumps.
 *
 * Bytes go straight to the memory given to encoder_start; nothing is allocated. Every instruction needs
 * ENCODER_SLACK free bytes before it starts, so that it can be stored in whole words: when they are not
 * there, or when the caller's fixup table is full, the encoder's sticky `failure` is set, nothing more is
 * written, and all later calls do nothing. Check once, at encoder_finish.
 *
 * Labels are numbers below label_count (basic blocks, pool constants), held in the caller's array as offsets
 * from `start`. A reference to a label not yet bound is noted as a fixup and patched by encoder_finish. Code
 * is position-independent: every reference is relative to rip, so that it may be written through one mapping
 * and run through another. */
#ifndef JIT_ENCODE_H
#define JIT_ENCODE_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

enum x86_vector {
#define X86_VECTOR(id, ...)   X86_##id,
#define X86_EVEX_OWN(id, ...) X86_##id,
#include "def/x86.def"
    X86_VECTOR_COUNT
};

enum x86_gpr {
#define X86_GPR(id, ...) X86_##id,
#include "def/x86.def"
    X86_GPR_COUNT
};

enum x86_condition {
#define X86_CONDITION(name, code) X86_IF_##name = code,
#include "def/x86.def"
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

/* Predicates of vcmpps that the pipeline uses: ordered ones are false on NaN, none signals on a quiet NaN. */
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

/* Rounding of vroundps, with the inexact exception suppressed. */
enum vector_rounding {
    X86_ROUND_NEAREST = 0x08,
    X86_ROUND_DOWN = 0x09,
    X86_ROUND_UP = 0x0A,
    X86_ROUND_TRUNCATE = 0x0B,
};

/* A destination of which an instruction writes the lanes only that mask register `k` (1 to 7) has; the others stay, or
 * become zero. */
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
    ENCODER_SLACK = 16,   /* free bytes an instruction asks for; the longest is 15 */
    LABEL_UNBOUND = -1,
};

/* [base + index * scale + displacement], or [label + displacement]. `base` is a gpr, X86_NONE or
 * X86_RIP_LABEL (then no index); `index` a gpr other than rsp, X86_NONE, or for gathers a vector register;
 * `scale` 1, 2, 4 or 8. With `broadcast` it is one element, which all lanes read; `mask` is the mask register whose lanes
 * are stored, 0: all. */
struct address {
    uint8_t base;
    uint8_t index;
    uint8_t scale;
    uint8_t broadcast;
    uint8_t mask;
    int32_t displacement;
    uint32_t label;
};

/* A rel32 at `offset` that awaits its label: the field becomes target + addend - offset. */
struct fixup {
    uint32_t offset;
    uint32_t label;
    int32_t addend;
};

enum encoder_failure {
    ENCODER_FINE,
    ENCODER_OUT_OF_CODE,   /* start again with a larger span */
    ENCODER_OUT_OF_FIXUPS, /* start again with more fixups */
    ENCODER_UNBOUND_LABEL, /* a label was used and never bound: the caller's mistake */
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

/* `displacement` bytes after the place where `label` is, or will be, bound. */
static inline struct address address_label(uint32_t label, int32_t displacement)
{
    return (struct address){
        .base = X86_RIP_LABEL, .index = X86_NONE, .scale = 1, .displacement = displacement, .label = label};
}

/* Starts encoding at `code` (`bytes` of room, under 2 GiB). All `label_count` entries of `labels` become
 * unbound. The arrays belong to the caller and live until encoder_finish; one fixup is used per forward
 * reference. */
void encoder_start(struct encoder *encoder, void *code, size_t bytes, int32_t *labels, uint32_t label_count,
                   struct fixup *fixups, uint32_t fixup_capacity);

/* A label more, unbound: its number is the label_count there was. The caller's array must have room. */
uint32_t encoder_add_label(struct encoder *encoder);

/* Patches all forward references. Returns 0, or -1 with the reason; `failure` then tells which. */
int encoder_finish(struct encoder *encoder, struct error *error);

/* Bytes written so far: also the offset of the next instruction. */
static inline size_t encoder_size(const struct encoder *encoder)
{
    return (size_t)(encoder->at - encoder->start);
}

/* Binds `label`, once, to the next byte. */
void encode_label(struct encoder *encoder, uint32_t label);

/* Appends `count` bytes of data, as for a constant pool. */
void encode_data(struct encoder *encoder, const void *bytes, size_t count);

/* Multi-byte nops up to the next multiple of `alignment` (a power of two) from `start`. */
void encode_align(struct encoder *encoder, unsigned alignment);

/* `count` bytes of multi-byte nops. */
void encode_nops(struct encoder *encoder, unsigned count);

/* Whether an instruction has an encoding whose memory operand is broadcast. */
int vector_broadcasts(enum x86_vector);

/* Vector instructions. A register operand is a vector's number 0 to 31, or a mask register's or a gpr's where the row
 * says so. In comments, the forms of x86.def that each accepts. */
void vector_none(struct encoder *, enum x86_vector);                                               /* NONE */
void vector_m(struct encoder *, enum x86_vector, struct address);                                  /* M */
void vector_rr(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned from); /* RM MR */
void vector_rm(struct encoder *, enum x86_vector, enum vector_length, unsigned to,
               struct address from); /* RM */
void vector_mr(struct encoder *, enum x86_vector, enum vector_length, struct address to,
               unsigned from); /* MR */
void vector_rri(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned from,
                unsigned immediate); /* RMI MRI VMI */
void vector_rmi(struct encoder *, enum x86_vector, enum vector_length, unsigned to, struct address from,
                unsigned immediate); /* RMI VMI */
void vector_mri(struct encoder *, enum x86_vector, enum vector_length, struct address to, unsigned from,
                unsigned immediate); /* MRI */
void vector_rrr(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                unsigned second); /* RVM */
void vector_rrm(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                struct address second); /* RVM */
void vector_rrri(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                 unsigned second, unsigned immediate); /* RVMI */
void vector_rrmi(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                 struct address second, unsigned immediate); /* RVMI */
void vector_rrrr(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                 unsigned second, unsigned third); /* RVMS */
void vector_rrmr(struct encoder *, enum x86_vector, enum vector_length, unsigned to, unsigned first,
                 struct address second, unsigned third); /* RVMS */
void vector_mrr(struct encoder *, enum x86_vector, enum vector_length, struct address to, unsigned mask,
                unsigned from); /* MVR */

/* Loads the lanes of `to` whose `mask` sign is set, and clears `mask`. `to`, `mask` and the index must
 * differ. */
void vector_gather(struct encoder *, enum x86_vector, enum vector_length, unsigned to, struct address from,
                   unsigned mask); /* GATHER */

/* Copies a whole register with vmovaps, in the direction whose encoding is shorter. */
void vector_copy(struct encoder *, enum vector_length, unsigned to, unsigned from);

/* General-register instructions. */
void gpr_rr(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, enum gpr from);
void gpr_rm(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, struct address from);
void gpr_mr(struct encoder *, enum x86_gpr, enum gpr_size, struct address to, enum gpr from);
void gpr_ri(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, int32_t immediate);
void gpr_mi(struct encoder *, enum x86_gpr, enum gpr_size, struct address to, int32_t immediate);
void gpr_rri(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, enum gpr from, int32_t immediate);
void gpr_rmi(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr to, struct address from,
             int32_t immediate);
void gpr_r(struct encoder *, enum x86_gpr, enum gpr_size, enum gpr);
void gpr_m(struct encoder *, enum x86_gpr, enum gpr_size, struct address);

/* Sets all 64 bits of `to` with the shortest mov; flags stay. Use it for function addresses too. */
void gpr_constant(struct encoder *, enum gpr to, uint64_t value);

/* Control flow. Backward jumps within reach take two bytes. */
void encode_jump(struct encoder *, uint32_t label);
void encode_jump_if(struct encoder *, enum x86_condition, uint32_t label);
void encode_return(struct encoder *);

#endif
