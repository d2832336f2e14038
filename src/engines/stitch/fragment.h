/* Fragments: pieces of machine code written by hand (asm/), with holes that the joiner fills, and with the
 * registers that they read, write and destroy.
 *
 * asm/stitch/fragment.inc defines the layout of the structures and the roles of the registers. The table
 * of all fragments is the section `stitch_fragments`. Each fragment also has a name, fragment_<name>,
 * declared below from def/op.def and def/engine/fragment.def. */
#ifndef ENGINES_STITCH_FRAGMENT_H
#define ENGINES_STITCH_FRAGMENT_H

#include <assert.h>
#include <stddef.h>
#include <stdint.h>

enum hole_kind {
    HOLE_WORD,      /* 32 bits: the argument is added to its value */
    HOLE_BYTE,      /* 8 bits: the same */
    HOLE_JUMP,      /* 32 bits: distance to the part whose number is the argument */
    HOLE_CONSTANTS, /* 64 bits: address of the constants */
    HOLE_LITERALS,  /* 32 bits: distance to the literals after the code */
    HOLE_VECTOR,    /* 32 bits, the second byte of VEX to ModRM: numbers of vector registers */
    HOLE_INDEX,     /* the same bytes: the vector register of a gather's index */
    HOLE_MASK,      /* 8 bits: a vector register's number in the upper four bits */
    HOLE_ADDRESS,   /* 32 bits: a displacement; argument ARGUMENT_BASE is the number of the base register */
    HOLE_KIND_COUNT
};

struct hole {
    uint16_t offset; /* bytes from the start of the code */
    uint8_t kind;
    uint8_t
        argument; /* 0 to ARGUMENT_COUNT - 1; of a HOLE_VECTOR, the roles of arguments: see vector_bits() */
};

enum { ARGUMENT_COUNT = 8, ARGUMENT_BASE = 7 };

/* A part's arguments: by number, or by the fragment's names for them (def/engine/fragment.def). */
union arguments {
    int32_t value[ARGUMENT_COUNT];
#define FIELDS(...) __VA_OPT__(int32_t __VA_ARGS__;)
#define FRAGMENT(name, arguments, meaning)                                                                   \
    struct {                                                                                                 \
        FIELDS arguments                                                                                     \
    } name;
#include "def/engine/fragment.def"
#undef FRAGMENT
#undef FIELDS
};

/* The number of an argument. */
#define ARGUMENT(fragment, name) ((unsigned)(offsetof(union arguments, fragment.name) / sizeof(int32_t)))

struct fragment {
    const char *name;
    const uint8_t *code;
    const struct hole *hole;
    uint32_t in, out, clobbered; /* bit r: general-purpose register r; bit 16 + n: ymm n */
    uint16_t bytes;
    uint16_t holes;
    uint8_t given, read; /* bit n: argument n is a vector register that is written or read */
    uint8_t
        folded; /* the argument that the next fragment reads from memory; 0: the fragment has no such form */
    uint8_t based;    /* has a HOLE_ADDRESS */
    uint8_t apart;    /* the result needs a register that is not an operand's */
    uint8_t in_place; /* forms that overwrite an operand follow it (asm/stitch/operation.asm, mad) */
    uint8_t pooled;   /* bit n: argument n is the offset of a literal */
    const char *file; /* the file and line of its source */
    const struct debug_unwind *unwind; /* debug/code.h */
    uint16_t line, unwinds;
};

static_assert(sizeof(struct hole) == 4, "asm/stitch/fragment.inc writes it so");
static_assert(sizeof(struct fragment) == 72 && offsetof(struct fragment, bytes) == 36 &&
                  offsetof(struct fragment, line) == 64,
              "asm/stitch/fragment.inc writes it so");

/* The general-purpose registers that C code names, by hardware number. */
enum {
    REGISTER_CONSTANTS = 3,
    REGISTER_FRAME = 4,
    REGISTER_FRAME_END = 5,
    REGISTER_CALL = 7,
    REGISTER_BASES = 8,
    REGISTER_VECTORS = 16
};

/* All fragments, in the order of the linker. */
extern const struct fragment __start_stitch_fragments[] __attribute__((visibility("hidden")));
extern const struct fragment __stop_stitch_fragments[] __attribute__((visibility("hidden")));

/* Fills HOLE_CONSTANTS; asm/stitch/constant.asm. */
extern const uint8_t stitch_constants[] __attribute__((visibility("hidden")));

#define FRAGMENT(name, arguments, meaning)                                                                   \
    extern const struct fragment fragment_##name __attribute__((visibility("hidden")));
#define OP(name, result, a, b, c, properties, expression)  FRAGMENT(name, , )
#define OPK(name, result, a, b, c, properties, expression) FRAGMENT(name, , )
#define CAST(name, result, from)
#include "def/engine/fragment.def"
#include "def/op.def"
#undef FRAGMENT
#undef OP
#undef OPK
#undef CAST

/* The text of def/engine/fragment.def or def/op.def for a fragment: the names of its arguments, separated
 * by ", ", and its meaning. Only for listings and tests. */
struct fragment_text {
    const char *arguments;
    const char *meaning;
};
struct fragment_text stitch_fragment_text(const struct fragment *fragment);

#endif
