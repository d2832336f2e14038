/* Lab 11: products of N x N matrices of binary32 from fragments of machine code. */
#ifndef STITCH_H
#define STITCH_H

#include <stddef.h>
#include <stdint.h>

enum { SIZE_MAXIMUM = 4 };

/* --- Recordings, as in lab 1: record.c, which is given --- */

enum operation {
    OPERATION_LOAD_A,
    OPERATION_LOAD_B,
    OPERATION_MULTIPLY,
    OPERATION_ADD,
    OPERATION_STORE_C,
    OPERATIONS
};

struct recorded {
    enum operation operation;
    int left, right; /* numbers of earlier operations: both of a product or a sum, `left` of a store */
    int element;     /* of a load or a store: the index of the float in a, b or c */
};

enum { RECORDING_MAXIMUM = 512 };

struct recording {
    int count;
    struct recorded at[RECORDING_MAXIMUM];
};

void product_record(struct recording *recording, int size);

/* --- Fragments: fragments.asm ---
 *
 * The code of an operation. While it runs, rdi, rsi and rdx are the addresses of a, b and c, and rcx is that
 * of the frame: an array with a float for the result of each operation. A fragment reads its operands from
 * the frame or from a or b, and writes its result to the frame or to c. It may change xmm0 and xmm1, and no
 * other register. It ends without a jump: the next fragment follows.
 *
 * A hole is a displacement of four bytes, in bytes, that is filled when the fragment is copied. In the
 * fragment it has one of these values, which occur once each. */
enum hole { HOLE_LEFT, HOLE_RIGHT, HOLE_RESULT, HOLE_ELEMENT, HOLES };

#define HOLE_VALUES                                                                                          \
    {                                                                                                        \
        0x11111111, 0x22222222, 0x33333333, 0x44444444                                                       \
    }

/* The holes that the fragment of an operation has, a bit each: 1 << HOLE_LEFT, ... */
extern const unsigned fragment_holes[OPERATIONS];

/* The code of a fragment, from `begin` up to `end`. */
struct fragment {
    const uint8_t *begin, *end;
};

extern const struct fragment fragments[OPERATIONS];

/* --- stitch.c --- */

/* Returns the offset of a hole in the fragment, or -1 if it has none. */
int hole_offset(const struct fragment *fragment, enum hole hole);

/* Joins the fragments of a recording, with their holes filled, and a ret (0xc3), at `code`, which has room
 * for `room` bytes. Returns the number of bytes, or 0 if there is not enough room. */
size_t stitch(const struct recording *recording, uint8_t *code, size_t room);

#endif
