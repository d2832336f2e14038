/* Fragments: pieces of machine code written by hand (asm/), with the places where the joiner fills something
 * in and the registers they read, give and destroy.
 *
 * The structures are laid out by asm/fragment.inc, which is also where the registers' roles are. The table of
 * all fragments is the section `stitch_fragments`; single ones go by name, fragment_<name>, declared below
 * from def/op.def and def/fragment.def. */
#ifndef STITCH_FRAGMENT_H
#define STITCH_FRAGMENT_H

#include <assert.h>
#include <stddef.h>
#include <stdint.h>

enum hole_kind {
    HOLE_WORD,      /* 32 bits: the argument is added to what stands there */
    HOLE_BYTE,      /* 8 bits, likewise */
    HOLE_JUMP,      /* 32 bits: distance to the part whose number is the argument */
    HOLE_CONSTANTS, /* 64 bits: address of the constants */
    HOLE_LITERALS,  /* 32 bits: distance to the literals behind the code */
    HOLE_VECTOR,    /* 32 bits, VEX's second byte to ModRM: numbers of vector registers, flipped in */
    HOLE_INDEX,     /* the same place: a gather's index, a vector register too */
    HOLE_MASK,      /* 8 bits: a vector register's number in the upper four */
    HOLE_ADDRESS,   /* 32 bits: a displacement; ARGUMENT_BASE has the base register's number */
    HOLE_KIND_COUNT
};

struct hole {
    uint16_t offset; /* bytes from the start of the code */
    uint8_t kind;
    uint8_t
        argument; /* 0 to ARGUMENT_COUNT - 1; of a HOLE_VECTOR, the roles of arguments: see vector_bits() */
};

enum { ARGUMENT_COUNT = 8, ARGUMENT_BASE = 7 };

struct fragment {
    const char *name;
    const uint8_t *code;
    const struct hole *hole;
    uint32_t in, out, clobbered; /* bit r: general-purpose register r; bit 16 + n: ymm n */
    uint16_t bytes;
    uint16_t holes;
    uint8_t given, read; /* bit n: argument n is the number of a vector register, given or read */
    uint8_t folded;      /* the argument that the next fragment takes from memory; 0: there is no such */
    uint8_t based;       /* has a HOLE_ADDRESS */
    uint8_t apart;       /* argument 0 is none of the registers read */
    uint8_t in_place;    /* behind it stand forms that change a register (asm/operation.asm, mad) */
    uint8_t pooled;      /* bit n: argument n is a literal, its offset among them */
    const char *file;    /* where it is written down */
    const struct debug_unwind *unwind; /* debug/code.h */
    uint16_t line, unwinds;
};

static_assert(sizeof(struct hole) == 4, "asm/fragment.inc writes it so");
static_assert(sizeof(struct fragment) == 72 && offsetof(struct fragment, bytes) == 36 &&
                  offsetof(struct fragment, line) == 64,
              "asm/fragment.inc writes it so");

/* General-purpose registers by their hardware number, as far as C must know them. */
enum {
    REGISTER_CONSTANTS = 3,
    REGISTER_FRAME = 4,
    REGISTER_FRAME_END = 5,
    REGISTER_CALL = 7,
    REGISTER_BASES = 8,
    REGISTER_VECTORS = 16
};

/* All fragments, in no particular order. */
extern const struct fragment __start_stitch_fragments[] __attribute__((visibility("hidden")));
extern const struct fragment __stop_stitch_fragments[] __attribute__((visibility("hidden")));

/* Fills HOLE_CONSTANTS; asm/constant.asm. */
extern const uint8_t stitch_constants[] __attribute__((visibility("hidden")));

#define FRAGMENT(name, arguments, meaning)                                                                   \
    extern const struct fragment fragment_##name __attribute__((visibility("hidden")));
#define OP(name, result, a, b, c, properties, expression)  FRAGMENT(name, , )
#define OPK(name, result, a, b, c, properties, expression) FRAGMENT(name, , )
#define CAST(name, result, from)
#include "def/fragment.def"
#include "def/op.def"
#undef FRAGMENT
#undef OP
#undef OPK
#undef CAST

/* What def/fragment.def or def/op.def says about a fragment: the names of its arguments, separated by spaces,
 * and what it does. Asked only when listing and testing. */
struct fragment_text {
    const char *arguments;
    const char *meaning;
};
struct fragment_text fragment_text(const struct fragment *fragment);

#endif
