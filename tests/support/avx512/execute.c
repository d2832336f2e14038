#define _GNU_SOURCE /* REG_EFL */
#include "tests/support/avx512/avx512_part.h"

#include <string.h>

/* --- Masks ---------------------------------------------------------------------------------------------- */

enum { CARRY = 1, PARITY = 4, ADJUST = 0x10, ZERO = 0x40, SIGN = 0x80, OVERFLOW = 0x800 };

static uint16_t mask_of(const struct avx512_machine *m, unsigned n)
{
    const ZydisDecodedOperand *o = &m->operand[n];
    uint16_t mask;
    if (o->type == ZYDIS_OPERAND_TYPE_MEMORY) {
        memcpy(&mask, avx512_address(m, o), sizeof mask);
        return mask;
    }
    int number = avx512_mask_number(o->reg.value);
    return number >= 0 ? m->mask[number] : (uint16_t)*avx512_general(m, o->reg.value);
}

static void move_mask(struct avx512_machine *m)
{
    const ZydisDecodedOperand *to = &m->operand[0];
    uint16_t mask = mask_of(m, 1);
    if (to->type == ZYDIS_OPERAND_TYPE_MEMORY)
        memcpy(avx512_address(m, to), &mask, sizeof mask);
    else if (avx512_mask_number(to->reg.value) >= 0)
        m->mask[avx512_mask_number(to->reg.value)] = mask;
    else
        *avx512_general(m, to->reg.value) = mask;
}

/* kortest: whether the lanes of both masks are all zeros or all ones. */
static void test_masks(struct avx512_machine *m)
{
    uint16_t both = mask_of(m, 0) | mask_of(m, 1);
    greg_t flags = m->general[REG_EFL] & ~(CARRY | PARITY | ADJUST | ZERO | SIGN | OVERFLOW);
    m->general[REG_EFL] = flags | (both ? 0 : ZERO) | (both == AVX512_ALL ? CARRY : 0);
}

static bool run_mask(struct avx512_machine *m)
{
    uint16_t result;
    switch (m->instruction.mnemonic) {
    case ZYDIS_MNEMONIC_KMOVW: return move_mask(m), true;
    case ZYDIS_MNEMONIC_KORTESTW: return test_masks(m), true;
    case ZYDIS_MNEMONIC_KNOTW: result = (uint16_t)~mask_of(m, 1); break;
    case ZYDIS_MNEMONIC_KANDW: result = mask_of(m, 1) & mask_of(m, 2); break;
    case ZYDIS_MNEMONIC_KANDNW: result = (uint16_t)(~mask_of(m, 1) & mask_of(m, 2)); break;
    case ZYDIS_MNEMONIC_KORW: result = mask_of(m, 1) | mask_of(m, 2); break;
    case ZYDIS_MNEMONIC_KXNORW: result = (uint16_t) ~(mask_of(m, 1) ^ mask_of(m, 2)); break;
    case ZYDIS_MNEMONIC_KXORW: result = mask_of(m, 1) ^ mask_of(m, 2); break;
    default: return false;
    }
    m->mask[avx512_mask_number(m->operand[0].reg.value)] = result;
    return true;
}

/* --- Instructions whose result is a mask ---------------------------------------------------------------- */

static void write_mask(struct avx512_machine *m, uint16_t lanes)
{
    uint16_t result = 0;
    for (unsigned i = 0; i < m->words; i++)
        result |= (uint16_t)(lanes & m->writes & 1u << i);
    m->mask[avx512_mask_number(m->operand[0].reg.value)] = result;
}

static bool compare(int32_t a, int32_t b, uint64_t predicate)
{
    bool result[] = {a == b, a < b, a <= b, false};
    return result[predicate & 3] != (predicate >> 2 & 1);
}

static bool run_to_mask(struct avx512_machine *m)
{
    struct avx512_vector a, b = {{0}};
    uint16_t lanes = 0;
    if (m->operand[0].type != ZYDIS_OPERAND_TYPE_REGISTER || avx512_mask_number(m->operand[0].reg.value) < 0)
        return false;
    if (avx512_twin(m, &a)) {
        for (unsigned i = 0; i < m->words; i++)
            lanes |= (uint16_t)((a.word[i] >> 31) << i);
        return write_mask(m, lanes), true;
    }
    a = avx512_operand(m, &m->operand[1]);
    if (m->instruction.mnemonic != ZYDIS_MNEMONIC_VPMOVD2M)
        b = avx512_operand(m, &m->operand[2]);
    for (unsigned i = 0; i < m->words; i++) {
        bool lane = false;
        switch (m->instruction.mnemonic) {
        case ZYDIS_MNEMONIC_VPMOVD2M: lane = a.word[i] >> 31; break;
        case ZYDIS_MNEMONIC_VPTESTMD: lane = a.word[i] & b.word[i]; break;
        case ZYDIS_MNEMONIC_VPTESTNMD: lane = !(a.word[i] & b.word[i]); break;
        case ZYDIS_MNEMONIC_VPCMPD:
            lane = compare((int32_t)a.word[i], (int32_t)b.word[i], m->operand[3].imm.value.u);
            break;
        default: return false;
        }
        lanes |= (uint16_t)(lane << i);
    }
    return write_mask(m, lanes), true;
}

/* --- Instructions of one lane --------------------------------------------------------------------------- */

static uint32_t scalar(const struct avx512_machine *m, unsigned n)
{
    const ZydisDecodedOperand *o = &m->operand[n];
    uint32_t word;
    if (o->type == ZYDIS_OPERAND_TYPE_REGISTER)
        return avx512_vector_number(o->reg.value) < 0 ? (uint32_t)*avx512_general(m, o->reg.value)
                                                      : avx512_operand(m, o).word[0];
    memcpy(&word, avx512_address(m, o), sizeof word);
    return word;
}

static void extract_word(struct avx512_machine *m)
{
    const ZydisDecodedOperand *to = &m->operand[0];
    uint32_t word = avx512_operand(m, &m->operand[1]).word[m->operand[2].imm.value.u & 3];
    if (to->type == ZYDIS_OPERAND_TYPE_MEMORY)
        memcpy(avx512_address(m, to), &word, sizeof word);
    else
        *avx512_general(m, to->reg.value) = word;
}

static struct avx512_vector insert_word(const struct avx512_machine *m)
{
    struct avx512_vector result = avx512_operand(m, &m->operand[1]);
    const unsigned immediate = (unsigned)m->operand[3].imm.value.u;
    const bool memory = m->operand[2].type == ZYDIS_OPERAND_TYPE_MEMORY;
    result.word[immediate >> 4 & 3] =
        memory ? scalar(m, 2) : avx512_operand(m, &m->operand[2]).word[immediate >> 6];
    for (unsigned i = 0; i < AVX512_LANE; i++)
        if (immediate >> i & 1)
            result.word[i] = 0;
    return result;
}

/* Of the operations that move less than a vector, the result; nothing outside of it is kept. */
static bool run_scalar(struct avx512_machine *m)
{
    struct avx512_vector result = {{0}}, other;
    switch (m->instruction.mnemonic) {
    case ZYDIS_MNEMONIC_VEXTRACTPS: return extract_word(m), true;
    case ZYDIS_MNEMONIC_VINSERTPS: result = insert_word(m); break;
    case ZYDIS_MNEMONIC_VMOVD: result.word[0] = scalar(m, 1); break;
    case ZYDIS_MNEMONIC_VMOVSS:
        if (m->operand[0].type == ZYDIS_OPERAND_TYPE_MEMORY) {
            result = avx512_operand(m, &m->operand[1]);
            return avx512_result(m, &result), true;
        }
        result.word[0] = m->writes & 1 ? scalar(m, 1) : 0;
        m->writes |= AVX512_ALL << 1;
        break;
    case ZYDIS_MNEMONIC_VMOVQ:
        other = avx512_operand(m, &m->operand[1]);
        memcpy(result.word, other.word, 2 * sizeof(uint32_t));
        break;
    case ZYDIS_MNEMONIC_VMOVHPS:
        result = avx512_operand(m, &m->operand[1]);
        other = avx512_operand(m, &m->operand[2]);
        memcpy(result.word + 2, other.word, 2 * sizeof(uint32_t));
        break;
    default: return false;
    }
    m->words = AVX512_LANE;
    return avx512_result(m, &result), true;
}

/* --- Lanes of 128 and 256 bits -------------------------------------------------------------------------- */

/* Extracts or inserts a part of `words` words. */
static void extract_part(struct avx512_machine *m, unsigned words)
{
    struct avx512_vector from = avx512_operand(m, &m->operand[1]), result = {{0}};
    unsigned part = (unsigned)m->operand[2].imm.value.u & (m->words / words - 1);
    memcpy(result.word, from.word + part * words, words * sizeof(uint32_t));
    m->words = words;
    avx512_result(m, &result);
}

static void insert_part(struct avx512_machine *m, unsigned words)
{
    struct avx512_vector result = avx512_operand(m, &m->operand[1]), part = avx512_operand(m, &m->operand[2]);
    unsigned to = (unsigned)m->operand[3].imm.value.u & (m->words / words - 1);
    memcpy(result.word + to * words, part.word, words * sizeof(uint32_t));
    avx512_result(m, &result);
}

static void shuffle_parts(struct avx512_machine *m)
{
    struct avx512_vector a = avx512_operand(m, &m->operand[1]), b = avx512_operand(m, &m->operand[2]), result;
    const unsigned parts = m->words / AVX512_LANE, bits = parts / 2;
    unsigned choices = (unsigned)m->operand[3].imm.value.u;
    for (unsigned part = 0; part < parts; part++, choices >>= bits)
        memcpy(result.word + part * AVX512_LANE,
               (part < parts / 2 ? &a : &b)->word + (choices & (parts - 1)) * AVX512_LANE,
               AVX512_LANE * sizeof(uint32_t));
    avx512_result(m, &result);
}

static bool run_part(struct avx512_machine *m)
{
    switch (m->instruction.mnemonic) {
    case ZYDIS_MNEMONIC_VEXTRACTF32X4: return extract_part(m, AVX512_LANE), true;
    case ZYDIS_MNEMONIC_VEXTRACTF64X4: return extract_part(m, AVX512_HALF), true;
    case ZYDIS_MNEMONIC_VINSERTF32X4: return insert_part(m, AVX512_LANE), true;
    case ZYDIS_MNEMONIC_VINSERTF64X4: return insert_part(m, AVX512_HALF), true;
    case ZYDIS_MNEMONIC_VSHUFF32X4: return shuffle_parts(m), true;
    default: return false;
    }
}

/* --- Words of the whole vector -------------------------------------------------------------------------- */

static uint32_t ternary(uint32_t a, uint32_t b, uint32_t c, uint64_t table)
{
    uint32_t result = 0;
    for (unsigned bit = 0; bit < 32; bit++) {
        unsigned row = (a >> bit & 1) << 2 | (b >> bit & 1) << 1 | (c >> bit & 1);
        result |= (uint32_t)(table >> row & 1) << bit;
    }
    return result;
}

static uint32_t rotate(uint32_t word, uint64_t bits)
{
    bits &= 31;
    return bits ? word << bits | word >> (32 - bits) : word;
}

static uint32_t of_two(const struct avx512_vector *a, const struct avx512_vector *b, uint32_t index,
                       unsigned words)
{
    return (index & words ? b : a)->word[index & (words - 1)];
}

/* Of each lane, the result from those of the destination, which is `d`, and of the two sources. */
static bool compute(const struct avx512_machine *m, const struct avx512_vector *d,
                    const struct avx512_vector *a, const struct avx512_vector *b, unsigned i,
                    uint32_t *result)
{
    switch (m->instruction.mnemonic) {
    case ZYDIS_MNEMONIC_VMOVUPS:
    case ZYDIS_MNEMONIC_VMOVAPS: *result = a->word[i]; return true;
    case ZYDIS_MNEMONIC_VBROADCASTF32X4: *result = a->word[i % AVX512_LANE]; return true;
    case ZYDIS_MNEMONIC_VPTERNLOGD:
        *result = ternary(d->word[i], a->word[i], b->word[i], m->operand[3].imm.value.u);
        return true;
    case ZYDIS_MNEMONIC_VPROLD: *result = rotate(a->word[i], m->operand[2].imm.value.u); return true;
    case ZYDIS_MNEMONIC_VPERMD:
    case ZYDIS_MNEMONIC_VPERMPS: *result = b->word[a->word[i] & (m->words - 1)]; return true;
    case ZYDIS_MNEMONIC_VPERMI2PS: *result = of_two(a, b, d->word[i], m->words); return true;
    case ZYDIS_MNEMONIC_VPERMT2PS: *result = of_two(d, b, a->word[i], m->words); return true;
    default: return false;
    }
}

static bool run_words(struct avx512_machine *m)
{
    struct avx512_vector d = {{0}}, a = avx512_operand(m, &m->operand[1]), b = {{0}}, result;
    if (m->operand[0].type == ZYDIS_OPERAND_TYPE_REGISTER)
        d = avx512_read(m, (unsigned)avx512_vector_number(m->operand[0].reg.value));
    if (m->operand[2].type == ZYDIS_OPERAND_TYPE_MEMORY ||
        (m->operand[2].type == ZYDIS_OPERAND_TYPE_REGISTER &&
         avx512_vector_number(m->operand[2].reg.value) >= 0))
        b = avx512_operand(m, &m->operand[2]);
    for (unsigned i = 0; i < m->words; i++)
        if (!compute(m, &d, &a, &b, i, &result.word[i]))
            return false;
    return avx512_result(m, &result), true;
}

/* The mask chooses between two sources. */
static void blend(struct avx512_machine *m)
{
    struct avx512_vector a = avx512_operand(m, &m->operand[1]), b = avx512_operand(m, &m->operand[2]);
    for (unsigned i = 0; i < m->words; i++)
        if (!(m->writes >> i & 1))
            b.word[i] = m->zeroes ? 0 : a.word[i];
    m->writes = AVX512_ALL;
    avx512_result(m, &b);
}

static bool run_broadcast(struct avx512_machine *m)
{
    struct avx512_vector result;
    switch (m->instruction.mnemonic) {
    case ZYDIS_MNEMONIC_VPBROADCASTD:
    case ZYDIS_MNEMONIC_VBROADCASTSS: break;
    case ZYDIS_MNEMONIC_VPMOVM2D:
        for (unsigned i = 0; i < m->words; i++)
            result.word[i] = mask_of(m, 1) >> i & 1 ? UINT32_MAX : 0;
        return avx512_result(m, &result), true;
    default: return false;
    }
    for (unsigned i = 0; i < m->words; i++)
        result.word[i] = scalar(m, 1);
    return avx512_result(m, &result), true;
}

static bool run_twin(struct avx512_machine *m)
{
    struct avx512_vector result;
    if (!avx512_twin(m, &result))
        return false;
    if (m->instruction.mnemonic == ZYDIS_MNEMONIC_VCVTPS2PH)
        m->words /= 2;
    return avx512_result(m, &result), true;
}

/* --- All ------------------------------------------------------------------------------------------------ */

/* An instruction of masks has a VEX prefix. */
bool avx512_is_own(const struct avx512_machine *m)
{
    if (m->instruction.encoding == ZYDIS_INSTRUCTION_ENCODING_EVEX)
        return true;
    for (unsigned n = 0; n < m->instruction.operand_count; n++)
        if (m->operand[n].type == ZYDIS_OPERAND_TYPE_REGISTER &&
            avx512_mask_number(m->operand[n].reg.value) >= 0)
            return true;
    return false;
}

void avx512_execute(struct avx512_machine *m)
{
    if (m->instruction.mnemonic == ZYDIS_MNEMONIC_VBLENDMPS)
        blend(m);
    else if (!run_mask(m) && !run_to_mask(m) && !run_scalar(m) && !run_part(m) && !run_broadcast(m) &&
             !run_twin(m) && !run_words(m))
        avx512_fail(m, "cannot be executed");
}
