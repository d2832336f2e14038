/* Vertex fetch: attributes of W vertices from the application's buffers into lanes.
 *
 * A vertex index times the stream's stride is the byte offset, of any alignment. Indices were checked against
 * the buffers when the draw was recorded. Memory is read in words of 32 bits; the last one may extend past
 * the attribute (contract/job.h). def/state/vertex_type.def defines the types; components that it does not
 * have are those of (0, 0, 0, 1) (Direct3D 9, vertex declarations). A missing attribute is `absent` in every
 * component: a missing normal is (0, 0, 0), a missing diffuse colour opaque white, missing texture
 * coordinates are (0, 0). */
#ifndef SPEC_VERTEX_FETCH_H
#define SPEC_VERTEX_FETCH_H

#include "contract/language.h"
#include "spec/math/vector.h"

/* The source of a fetch: a format, and the offset in the job of the struct attribute_job with its address. */
struct fetched {
    int format, job;
};

static inline flt fetch_float(struct env *e, const struct fetched *from, itg offset, int component)
{
    return gather_f(E, BASE_JOB, from->job + (int)offsetof(struct attribute_job, data), offset, 1,
                    4 * component);
}

static inline itg fetch_word(struct env *e, const struct fetched *from, itg offset, int word)
{
    return gather_i(E, BASE_JOB, from->job + (int)offsetof(struct attribute_job, data), offset, 1, 4 * word);
}

/* `bits` bits of a word, from bit `shift` on. */
static inline itg fetch_unsigned(struct env *e, itg packed, int shift, int bits)
{
    itg down = shift ? ushr_i(E, packed, shift) : packed;
    return shift + bits < 32 ? and_i(E, down, lit_i(E, (1 << bits) - 1)) : down;
}

static inline itg fetch_signed(struct env *e, itg packed, int shift, int bits)
{
    int above = 32 - bits - shift;
    itg up = above ? shl_i(E, packed, above) : packed;
    return bits < 32 ? shr_i(E, up, 32 - bits) : up;
}

/* An unsigned integer of 32 bits as the nearest binary32. Only the sum is rounded. */
static inline flt wide_to_float(struct env *e, itg word)
{
    itg high = ushr_i(E, word, 16);
    itg low = and_i(E, word, lit_i(E, 0xffff));
    flt high_count = float_f(E, high);
    flt low_count = float_f(E, low);
    flt scaled = mul_f(E, high_count, lit_f(E, 0x1p16f));
    return add_f(E, scaled, low_count);
}

/* A binary16 as binary32, exactly. Denormals become normal numbers; a NaN stays a NaN. The exponent's bias is
 * 112 less than that of binary32. The exponent 31, of infinities and NaNs, becomes 255. */
static inline flt half_to_float(struct env *e, itg half)
{
    itg magnitude = and_i(E, half, lit_i(E, 0x7fff));
    itg shifted = shl_i(E, magnitude, 13);
    itg normal = add_i(E, shifted, lit_i(E, 112 << 23));
    itg extreme = add_i(E, shifted, lit_i(E, 224 << 23));
    flt count = float_f(E, magnitude);
    flt denormal = mul_f(E, count, lit_f(E, 0x1p-24f));
    msk infinite = gt_i(E, magnitude, lit_i(E, 0x7bff));
    itg large = select_i(E, infinite, extreme, normal);
    msk small = gt_i(E, lit_i(E, 0x0400), magnitude);
    itg small_bits = bits_i(E, denormal);
    itg bits = select_i(E, small, small_bits, large);
    itg sign_bit = and_i(E, half, lit_i(E, 0x8000));
    itg sign = shl_i(E, sign_bit, 16);
    itg signed_bits = or_i(E, bits, sign);
    return bits_f(E, signed_bits);
}

/* The component of a packed type whose lowest bit in its word is `shift`. */
static inline flt fetch_field(struct env *e, const struct vertex_type *type, itg packed, int shift)
{
    itg field = type->encoding == ENCODING_SIGNED ? fetch_signed(E, packed, shift, type->bits)
                                                  : fetch_unsigned(E, packed, shift, type->bits);
    if (type->encoding == ENCODING_HALF)
        return half_to_float(E, field);
    bool wide = type->encoding == ENCODING_UNSIGNED && type->bits == 32;
    flt value = wide ? wide_to_float(E, field) : float_f(E, field);
    return type->scale != 1 ? mul_f(E, value, lit_f(E, type->scale)) : value;
}

static inline struct vector4 fetch_color(struct env *e, const struct fetched *from, itg offset)
{
    static const uint8_t shift[4] = {16, 8, 0, 24};
    struct vector4 r;
    itg packed = fetch_word(E, from, offset, 0);
    for (int c = 0; c < 4; c++)
        r.v[c] = fetch_field(E, &key_vertex_types[ATTRIBUTE_FORMAT_COLOR], packed, shift[c]);
    return r;
}

/* The components that the type has. */
static inline void fetch_packed(struct env *e, const struct fetched *from, itg offset, struct vector4 *r)
{
    const struct vertex_type *type = &key_vertex_types[from->format];
    itg packed = fetch_word(E, from, offset, 0);
    for (int c = 0; c < type->components; c++) {
        int bit = type->bits * c;
        if (bit && bit % 32 == 0)
            packed = fetch_word(E, from, offset, bit / 32);
        r->v[c] = fetch_field(E, type, packed, bit % 32);
    }
}

/* All four components of an attribute that is present. */
static inline struct vector4 fetch_element(struct env *e, const struct fetched *from)
{
    struct vector4 r;
    const struct vertex_type *type = &key_vertex_types[from->format];
    itg index = load_i(E, BASE_INPUT, 0);
    itg stride = uniform_i(E, BASE_JOB, from->job + (int)offsetof(struct attribute_job, stride));
    itg offset = mul_i(E, index, stride);
    if (type->encoding == ENCODING_COLOR)
        return fetch_color(E, from, offset);
    for (int c = type->components; c < 4; c++)
        r.v[c] = lit_f(E, c == 3 ? 1.0f : 0.0f);
    if (type->encoding != ENCODING_FLOAT)
        fetch_packed(E, from, offset, &r);
    else
        for (int c = 0; c < type->components; c++)
            r.v[c] = fetch_float(E, from, offset, c);
    return r;
}

static inline struct vector4 fetch(struct env *e, const struct vertex_key *k, int attribute, float absent)
{
    struct vector4 r;
    struct fetched from = {k->attribute[attribute], (int)offsetof(struct job, attribute[attribute])};
    if (from.format != ATTRIBUTE_FORMAT_NONE)
        return fetch_element(E, &from);
    for (int c = 0; c < 4; c++)
        r.v[c] = lit_f(E, absent);
    return r;
}

/* Returns true if the fourth component of a position can be other than 1. */
static inline bool has_fourth(const struct vertex_key *k, int attribute)
{
    return key_vertex_types[k->attribute[attribute]].components == 4;
}

#endif
