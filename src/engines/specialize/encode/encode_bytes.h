/* Bytes of instructions: what the files of the encoder share. */
#ifndef ENGINES_SPECIALIZE_EMIT_ENCODE_BYTES_H
#define ENGINES_SPECIALIZE_EMIT_ENCODE_BYTES_H

#include "engines/specialize/encode/encode.h"

#include <assert.h>
#include <string.h>

/* Opcode maps, as VEX and EVEX number them. */
enum { MAP_00 = 0, MAP_0F = 1, MAP_0F38 = 2, MAP_0F3A = 3 };

static inline void encode_store32(uint8_t *at, uint32_t value)
{
    memcpy(at, &value, sizeof value);
}

static inline bool encode_fits_byte(int32_t value)
{
    return value == (int8_t)value;
}

/* Sets the failure. After the first one `limit` is before `at`, so the comparison in encode_room fails from
 * then on. */
void encode_fail(struct encoder *encoder, enum encoder_failure failure);

/* Returns true if there is room for `bytes` more bytes, and fails otherwise. */
static inline bool encode_room(struct encoder *encoder, size_t bytes)
{
    if (__builtin_expect(encoder->limit - encoder->at >= (ptrdiff_t)bytes, 1))
        return true;
    encode_fail(encoder, ENCODER_OUT_OF_CODE);
    return false;
}

/* The high bits of base and index, as prefixes have them. */
static inline unsigned encode_base_extension(struct address address)
{
    return address.base < 16 ? address.base >> 3 : 0;
}

static inline unsigned encode_index_extension(struct address address)
{
    return address.index < 16 ? address.index >> 3 : 0;
}

/* Stores a rel32 to `label` + `displacement`, or adds a fixup. `trailing` bytes of the instruction follow it.
 */
void encode_relative(struct encoder *encoder, uint8_t *at, uint32_t label, int32_t displacement,
                     int trailing);

/* Stores ModRM, SIB and displacement, and returns their end. A displacement of one byte counts in units of
 * 1 << unit. Base code 5 with mod 0 means "no base", so rbp and r13 always have a displacement. Base code 4
 * announces a SIB, so rsp and r12 always have one. Index code 4 means "no index".
 *
 * It is the most frequent function of the encoder, so each of its files has a copy for its own calls. */
static inline uint8_t *encode_address(struct encoder *encoder, uint8_t *at, unsigned reg,
                                      struct address address, unsigned unit, int trailing)
{
    unsigned modrm = (reg & 7) << 3;
    if (address.base == X86_RIP_LABEL) {
        assert(address.index == X86_NONE);
        *at++ = (uint8_t)(modrm | 5);
        encode_relative(encoder, at, address.label, address.displacement, trailing);
        return at + 4;
    }
    assert(address.scale && address.scale <= 8 && !(address.scale & (address.scale - 1)));
    unsigned base = address.base & 7, displacement_bytes = 4;
    unsigned index = address.index == X86_NONE ? 4 : address.index & 7;
    if (address.base == X86_NONE) {
        base = 5;
    } else if (address.displacement == 0 && base != 5) {
        displacement_bytes = 0;
    } else if (encode_fits_byte(address.displacement >> unit) &&
               !(address.displacement & ((1 << unit) - 1))) {
        displacement_bytes = 1;
        address.displacement >>= unit;
        modrm |= 0x40;
    } else {
        modrm |= 0x80;
    }
    bool sib = address.index != X86_NONE || address.base == X86_NONE || base == 4;
    at[0] = (uint8_t)(modrm | (sib ? 4 : base));
    at[1] = (uint8_t)((unsigned)__builtin_ctz(address.scale) << 6 | index << 3 | base);
    at += 1 + sib;
    encode_store32(at, (uint32_t)address.displacement);
    return at + displacement_bytes;
}

#endif
