/* Logic operations on the bits that a target stores (OpenGL ES 1.1.12, section 4.1.9). s is the code of the
 * new channel, d the stored one, each of the n bits that the target has for it (def/state/target.def).
 *
 *   CLEAR 0          AND s & d          AND_REVERSE s & ~d    AND_INVERTED ~s & d
 *   COPY s           XOR s ^ d          OR s | d              NOR ~(s | d)
 *   EQUIV ~(s ^ d)   INVERT ~d          OR_REVERSE s | ~d     COPY_INVERTED ~s
 *   SET 2^n - 1      NAND ~(s & d)      OR_INVERTED ~s | d
 *
 * A target of floating point, or one encoded as sRGB, has no codes to operate on: it takes the new colour, as
 * in later versions of OpenGL. */
#ifndef SPEC_PIXEL_LOGIC_H
#define SPEC_PIXEL_LOGIC_H

#include "contract/language.h"

static inline itg logic_not(struct env *e, itg a)
{
    return xor_i(E, a, lit_i(E, -1));
}

/* The operation on all 32 bits. */
static inline itg logic_bits(struct env *e, int operation, itg s, itg d)
{
    itg other;
    switch ((enum logic)operation) {
    case LOGIC_CLEAR: return lit_i(E, 0);
    case LOGIC_AND: return and_i(E, s, d);
    case LOGIC_AND_REVERSE: other = logic_not(E, d); return and_i(E, s, other);
    case LOGIC_AND_INVERTED: other = logic_not(E, s); return and_i(E, other, d);
    case LOGIC_XOR: return xor_i(E, s, d);
    case LOGIC_OR: return or_i(E, s, d);
    case LOGIC_NOR: other = or_i(E, s, d); return logic_not(E, other);
    case LOGIC_EQUIV: other = xor_i(E, s, d); return logic_not(E, other);
    case LOGIC_INVERT: return logic_not(E, d);
    case LOGIC_OR_REVERSE: other = logic_not(E, d); return or_i(E, s, other);
    case LOGIC_COPY_INVERTED: return logic_not(E, s);
    case LOGIC_OR_INVERTED: other = logic_not(E, s); return or_i(E, other, d);
    case LOGIC_NAND: other = and_i(E, s, d); return logic_not(E, other);
    case LOGIC_SET: return lit_i(E, -1);
    case LOGIC_COPY:
    case LOGIC_COUNT: break;
    }
    return s;
}

/* The operation on codes of `bits` bits. */
static inline itg logic_code(struct env *e, int operation, int bits, itg s, itg d)
{
    itg all = logic_bits(E, operation, s, d);
    return and_i(E, all, lit_i(E, (1 << bits) - 1));
}

#endif
