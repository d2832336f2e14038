#include "tests/support/avx512/avx512_part.h"

#include <immintrin.h>
#include <string.h>
#include <sys/mman.h>
#include <unity.h>

/* The instructions whose opcode means the same for each lane of 128 bits with a VEX prefix. */
static const uint16_t twins[] = {
    ZYDIS_MNEMONIC_VADDPS,       ZYDIS_MNEMONIC_VSUBPS,       ZYDIS_MNEMONIC_VMULPS,
    ZYDIS_MNEMONIC_VDIVPS,       ZYDIS_MNEMONIC_VMINPS,       ZYDIS_MNEMONIC_VMAXPS,
    ZYDIS_MNEMONIC_VSQRTPS,      ZYDIS_MNEMONIC_VANDPS,       ZYDIS_MNEMONIC_VANDNPS,
    ZYDIS_MNEMONIC_VORPS,        ZYDIS_MNEMONIC_VXORPS,       ZYDIS_MNEMONIC_VRNDSCALEPS,
    ZYDIS_MNEMONIC_VCVTPS2DQ,    ZYDIS_MNEMONIC_VCVTTPS2DQ,   ZYDIS_MNEMONIC_VCVTDQ2PS,
    ZYDIS_MNEMONIC_VFMADD132PS,  ZYDIS_MNEMONIC_VFMADD213PS,  ZYDIS_MNEMONIC_VFMADD231PS,
    ZYDIS_MNEMONIC_VFMSUB132PS,  ZYDIS_MNEMONIC_VFMSUB213PS,  ZYDIS_MNEMONIC_VFMSUB231PS,
    ZYDIS_MNEMONIC_VFNMADD132PS, ZYDIS_MNEMONIC_VFNMADD213PS, ZYDIS_MNEMONIC_VFNMADD231PS,
    ZYDIS_MNEMONIC_VFNMSUB132PS, ZYDIS_MNEMONIC_VFNMSUB213PS, ZYDIS_MNEMONIC_VFNMSUB231PS,
    ZYDIS_MNEMONIC_VUNPCKLPS,    ZYDIS_MNEMONIC_VUNPCKHPS,    ZYDIS_MNEMONIC_VPUNPCKLQDQ,
    ZYDIS_MNEMONIC_VPUNPCKHQDQ,  ZYDIS_MNEMONIC_VSHUFPS,      ZYDIS_MNEMONIC_VPERMILPS,
    ZYDIS_MNEMONIC_VPSHUFD,      ZYDIS_MNEMONIC_VPSHUFB,      ZYDIS_MNEMONIC_VPANDD,
    ZYDIS_MNEMONIC_VPANDND,      ZYDIS_MNEMONIC_VPORD,        ZYDIS_MNEMONIC_VPXORD,
    ZYDIS_MNEMONIC_VPADDD,       ZYDIS_MNEMONIC_VPSUBD,       ZYDIS_MNEMONIC_VPMULLD,
    ZYDIS_MNEMONIC_VPMINSD,      ZYDIS_MNEMONIC_VPMAXSD,      ZYDIS_MNEMONIC_VPMINUD,
    ZYDIS_MNEMONIC_VPMAXUD,      ZYDIS_MNEMONIC_VPABSD,       ZYDIS_MNEMONIC_VPSLLD,
    ZYDIS_MNEMONIC_VPSRLD,       ZYDIS_MNEMONIC_VPSRAD,       ZYDIS_MNEMONIC_VPSLLVD,
    ZYDIS_MNEMONIC_VPSRLVD,      ZYDIS_MNEMONIC_VPSRAVD,      ZYDIS_MNEMONIC_VPMADDWD,
    ZYDIS_MNEMONIC_VPADDW,       ZYDIS_MNEMONIC_VPSUBW,       ZYDIS_MNEMONIC_VPMULLW,
    ZYDIS_MNEMONIC_VPMULHUW,     ZYDIS_MNEMONIC_VPMULHRSW,    ZYDIS_MNEMONIC_VPMINUW,
    ZYDIS_MNEMONIC_VPMAXUW,      ZYDIS_MNEMONIC_VPSLLW,       ZYDIS_MNEMONIC_VPSRLW,
    ZYDIS_MNEMONIC_VPSRAW,       ZYDIS_MNEMONIC_VCMPPS,       ZYDIS_MNEMONIC_VPCMPEQD,
    ZYDIS_MNEMONIC_VPCMPGTD,     ZYDIS_MNEMONIC_VCVTPH2PS,    ZYDIS_MNEMONIC_VCVTPS2PH,
};

/* The operands of an instruction by the field of its encoding. */
enum field { FIELD_REG, FIELD_VVVV, FIELD_RM, FIELDS };

static bool is_twin(const struct avx512_machine *m)
{
    for (unsigned n = 0; n < sizeof twins / sizeof *twins; n++)
        if (twins[n] == m->instruction.mnemonic)
            return true;
    return false;
}

static enum field field_of(const struct avx512_machine *m, const ZydisDecodedOperand *operand)
{
    switch (operand->encoding) {
    case ZYDIS_OPERAND_ENCODING_MODRM_REG: return FIELD_REG;
    case ZYDIS_OPERAND_ENCODING_NDSNDD: return FIELD_VVVV;
    case ZYDIS_OPERAND_ENCODING_MODRM_RM: return FIELD_RM;
    default: avx512_fail(m, "an operand is in another field");
    }
}

/* --- Code ----------------------------------------------------------------------------------------------- */

/* A page with a function of the three registers in memory: it loads ymm0 to ymm2, for the fields in their
 * order, executes one instruction, and stores them. */
typedef void function(uint32_t registers[FIELDS][AVX512_HALF]);

enum { PAGE = 4096 };
static uint8_t *page;

void avx512_prepare_twins(void)
{
    if (page)
        return;
    void *mapped = mmap(NULL, PAGE, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    TEST_ASSERT_TRUE(mapped != MAP_FAILED);
    page = mapped;
}

static uint8_t *put(uint8_t *to, const void *bytes, size_t count)
{
    memcpy(to, bytes, count);
    return to + count;
}

/* vex.256 of the map, the prefix and the opcode of the EVEX encoding. */
static uint8_t *put_twin(uint8_t *to, const struct avx512_machine *m, bool has_vvvv)
{
    const ZydisDecodedInstruction *i = &m->instruction;
    const unsigned digit = i->raw.modrm.reg;
    const bool extends = i->opcode >= 0x71 && i->opcode <= 0x72 && i->opcode_map == ZYDIS_OPCODE_MAP_0F;
    const uint8_t code[] = {0xc4, (uint8_t)(0xe0 | i->raw.evex.mmm),
                            (uint8_t)((has_vvvv ? (~FIELD_VVVV & 15) << 3 : 15 << 3) | 4 | i->raw.evex.pp),
                            i->opcode, (uint8_t)(0xc0 | (extends ? digit : FIELD_REG) << 3 | FIELD_RM)};
    to = put(to, code, sizeof code);
    if (i->raw.imm[0].size)
        *to++ = (uint8_t)i->raw.imm[0].value.u;
    return to;
}

static function *make(const struct avx512_machine *m, bool has_vvvv)
{
    static const uint8_t load[] = {0xc5, 0xfc, 0x10, 0x07,                /* ymm0 at rdi */
                                   0xc5, 0xfc, 0x10, 0x4f, 0x20,          /* ymm1 at rdi + 32 */
                                   0xc5, 0xfc, 0x10, 0x57, 0x40},         /* ymm2 at rdi + 64 */
        store[] = {0xc5, 0xfc, 0x11, 0x07, 0xc5, 0xfc, 0x11, 0x4f, 0x20,  /* and back */
                   0xc5, 0xfc, 0x11, 0x57, 0x40, 0xc5, 0xf8, 0x77, 0xc3}; /* vzeroupper, ret */
    uint8_t *to = put(page, load, sizeof load);
    to = put_twin(to, m, has_vvvv);
    put(to, store, sizeof store);
    function *made;
    memcpy(&made, &page, sizeof made);
    return made;
}

/* --- Halves --------------------------------------------------------------------------------------------- */

/* With the interrupted program's rounding, and its flags afterwards. */
static void call(struct avx512_machine *m, function *twin, uint32_t registers[FIELDS][AVX512_HALF])
{
    const unsigned saved = _mm_getcsr();
    _mm_setcsr(*m->mxcsr);
    twin(registers);
    *m->mxcsr = _mm_getcsr();
    _mm_setcsr(saved);
}

bool avx512_twin(struct avx512_machine *m, struct avx512_vector *result)
{
    if (!is_twin(m))
        return false;
    const bool widens = m->instruction.mnemonic == ZYDIS_MNEMONIC_VCVTPH2PS,
               narrows = m->instruction.mnemonic == ZYDIS_MNEMONIC_VCVTPS2PH;
    struct avx512_vector field[FIELDS] = {{{0}}};
    const bool compares =
        m->operand[0].type == ZYDIS_OPERAND_TYPE_REGISTER && avx512_mask_number(m->operand[0].reg.value) >= 0;
    enum field to = compares ? FIELD_REG : field_of(m, &m->operand[0]);
    bool has_vvvv = to == FIELD_VVVV;
    if (!compares && !narrows)
        field[to] = avx512_read(m, (unsigned)avx512_vector_number(m->operand[0].reg.value));
    for (unsigned n = 1; n < 4 && m->operand[n].encoding != ZYDIS_OPERAND_ENCODING_NONE; n++) {
        if (m->operand[n].type == ZYDIS_OPERAND_TYPE_IMMEDIATE)
            continue;
        enum field from = field_of(m, &m->operand[n]);
        field[from] = avx512_operand(m, &m->operand[n]);
        has_vvvv |= from == FIELD_VVVV;
    }
    function *twin = make(m, has_vvvv);
    const unsigned read = widens ? AVX512_LANE : AVX512_HALF, write = narrows ? AVX512_LANE : AVX512_HALF;
    memset(result, 0, sizeof *result);
    for (unsigned half = 0; half * AVX512_HALF < m->words; half++) {
        uint32_t registers[FIELDS][AVX512_HALF];
        for (unsigned f = 0; f < FIELDS; f++)
            memcpy(registers[f], field[f].word + half * (f == FIELD_RM ? read : AVX512_HALF),
                   sizeof registers[f]);
        call(m, twin, registers);
        memcpy(result->word + half * write, registers[to], write * sizeof(uint32_t));
    }
    return true;
}
