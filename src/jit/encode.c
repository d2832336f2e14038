#include "jit/encode.h"

#include <assert.h>
#include <limits.h>
#include <stdbool.h>
#include <string.h>

/* How it works: a row of x86.def is packed into eight bytes that are already in the bit positions VEX wants,
 * EVEX's into two more,
 * and a prefix with its opcode is composed in a register and stored as one word. Stores may run past the
 * instruction's end, never past the slack that `room` has checked, and the next instruction overwrites them.
 */

enum form {
    FORM_RM = 1 << 0,
    FORM_MR = 1 << 1,
    FORM_RMI = 1 << 2,
    FORM_MRI = 1 << 3,
    FORM_VMI = 1 << 4,
    FORM_RVM = 1 << 5,
    FORM_RVMI = 1 << 6,
    FORM_RVMS = 1 << 7,
    FORM_MVR = 1 << 8,
    FORM_GATHER = 1 << 9,
    FORM_M = 1 << 10,
    FORM_NONE = 1 << 11,
};

enum {
    VEX_NP = 0,
    VEX_66 = 1,
    VEX_F3 = 2,
    VEX_F2 = 3,
    LEGACY_NP = 0,
    LEGACY_66 = 0x66,
    LEGACY_F3 = 0xF3,
    LEGACY_F2 = 0xF2,
    MAP_00 = 0,
    MAP_0F = 1,
    MAP_0F38 = 2,
    MAP_0F3A = 3,
    LENGTHS_LX = 1 << X86_128,
    LENGTHS_LY = 1 << X86_256,
    LENGTHS_LV = LENGTHS_LX | LENGTHS_LY,
    EVEX_LENGTHS_LX = 1 << X86_128,
    EVEX_LENGTHS_LZ = 1 << X86_512,
    EVEX_LENGTHS_LW = 1 << X86_256 | EVEX_LENGTHS_LZ,
    EVEX_LENGTHS_LV = EVEX_LENGTHS_LX | EVEX_LENGTHS_LW,
};

/* Which of the two kinds of operand a row lets ModRM.rm be. */
enum {
    RM_REGISTER = 1,
    RM_MEMORY = 2,
    REGISTER_V = RM_REGISTER,
    REGISTER_X = RM_REGISTER,
    REGISTER_Y = RM_REGISTER,
    REGISTER_G = RM_REGISTER,
    REGISTER_H = RM_REGISTER,
    REGISTER_K = RM_REGISTER,
    REGISTER_Q = RM_REGISTER,
    REGISTER_N = 0,
    MEMORY_MV = RM_MEMORY,
    MEMORY_MH = RM_MEMORY,
    MEMORY_MQ = RM_MEMORY,
    MEMORY_M8 = RM_MEMORY,
    MEMORY_M16 = RM_MEMORY,
    MEMORY_M32 = RM_MEMORY,
    MEMORY_M64 = RM_MEMORY,
    MEMORY_M128 = RM_MEMORY,
    MEMORY_M256 = RM_MEMORY,
    MEMORY_MN = 0,
};

/* Of EVEX: the unit of an 8-bit displacement as a power of two; from UNIT_V on it grows with the length. */
enum {
    UNIT_M32 = 2,
    UNIT_M64 = 3,
    UNIT_M128 = 4,
    UNIT_M256 = 5,
    UNIT_V = 16,
    UNIT_MH = UNIT_V + 3,
    UNIT_MV = UNIT_V + 4,
    UNIT_MN = 0,
    BROADCAST_BN = 0,
    BROADCAST_B4 = 2, /* likewise, of one element */
    BROADCAST_B8 = 3,
    MASKING_ZZ = 0,
    MASKING_MM = 1,
    MASKING_ZM = 3
};

struct vector_row {
    uint16_t form;
    uint8_t opcode;
    uint8_t map;
    uint8_t w_prefix; /* VEX.W and VEX.pp in their places */
    uint8_t digit;
    uint8_t lengths;
    uint8_t rm;
};

static const struct vector_row vector_rows[X86_VECTOR_COUNT] = {
#define X86_VECTOR(id, mnemonic, form, prefix, map, w, opcode, digit, lengths, reg, vvvv, rm, memory)        \
    [X86_##id] = {FORM_##form,                                                                               \
                  opcode,                                                                                    \
                  MAP_##map,                                                                                 \
                  w << 7 | VEX_##prefix,                                                                     \
                  digit,                                                                                     \
                  LENGTHS_##lengths,                                                                         \
                  REGISTER_##rm | MEMORY_##memory},
#include "def/x86.def"
};

/* EVEX.P0 but for registers' high bits in `row.map`, W, pp and the bit that is always set in `row.w_prefix`. */
struct evex_row {
    struct vector_row row;
    uint8_t unit;
    uint8_t broadcast;
    uint8_t masking;
};

static const struct evex_row evex_rows[X86_VECTOR_COUNT] = {
#define X86_EVEX(id, mnemonic, form, prefix, map, w, opcode, digit, lengths, reg, vvvv, rm, memory,          \
                 broadcast, masking)                                                                         \
    [X86_##id] = {{FORM_##form, opcode, MAP_##map, w << 7 | 4 | VEX_##prefix, digit, EVEX_LENGTHS_##lengths, \
                   REGISTER_##rm | MEMORY_##memory},                                                         \
                  UNIT_##memory,                                                                             \
                  BROADCAST_##broadcast,                                                                     \
                  MASKING_##masking},
#include "def/x86.def"
};

enum trait {
    TRAIT_PLAIN,
    TRAIT_BYTE,
    TRAIT_WORD,
    TRAIT_DWORD,
    TRAIT_BYTES,
    TRAIT_WORDS,
    TRAIT_ADDRESS,
    TRAIT_COUNT,
    TRAIT_WIDE,
    TRAIT_PLUS,
    TRAIT_TRIPLE,
};

struct gpr_row {
    uint8_t prefix;
    uint8_t map;
    uint8_t rm;
    uint8_t mr;
    uint8_t imm8;
    uint8_t imm32;
    uint8_t single;
    uint8_t digit;
    uint8_t trait;
};

static const struct gpr_row gpr_rows[X86_GPR_COUNT] = {
#define X86_GPR(id, mnemonic, prefix, map, rm, mr, imm8, imm32, single, digit, trait)                        \
    [X86_##id] = {LEGACY_##prefix, MAP_##map, rm, mr, imm8, imm32, single, digit, TRAIT_##trait},
#include "def/x86.def"
};

static void store32(uint8_t *at, uint32_t value)
{
    memcpy(at, &value, sizeof value);
}

/* After the first failure `limit` lies before `at`, so that this one comparison also keeps it sticky. */
static void fail(struct encoder *encoder, enum encoder_failure failure)
{
    if (!encoder->failure)
        encoder->failure = failure;
    encoder->limit = encoder->start;
}

static bool room(struct encoder *encoder, size_t bytes)
{
    if (__builtin_expect(encoder->limit - encoder->at >= (ptrdiff_t)bytes, 1))
        return true;
    fail(encoder, ENCODER_OUT_OF_CODE);
    return false;
}

/* Addresses and labels. */

/* Stores a rel32 to `label` + `displacement`, or notes it for later. `trailing` bytes of the instruction
 * follow. */
static void put_relative(struct encoder *encoder, uint8_t *at, uint32_t label, int32_t displacement,
                         int trailing)
{
    assert(label < encoder->label_count);
    int32_t addend = displacement - 4 - trailing;
    int32_t offset = (int32_t)(at - encoder->start);
    if (encoder->labels[label] != LABEL_UNBOUND) {
        store32(at, (uint32_t)(encoder->labels[label] + addend - offset));
    } else if (encoder->fixup_count < encoder->fixup_capacity) {
        encoder->fixups[encoder->fixup_count++] = (struct fixup){(uint32_t)offset, label, addend};
    } else {
        fail(encoder, ENCODER_OUT_OF_FIXUPS);
    }
}

/* The high bits of base and index, as the prefix wants them. */
static unsigned base_extension(struct address address)
{
    return address.base < 16 ? address.base >> 3 : 0;
}

static unsigned index_extension(struct address address)
{
    return address.index < 16 ? address.index >> 3 : 0;
}

static bool fits_byte(int32_t value)
{
    return value == (int8_t)value;
}

/* ModRM, SIB and displacement. Base code 5 with mod 0 means "no base", so rbp and r13 always carry a
 * displacement; base code 4 announces a SIB, so rsp and r12 always carry one; index code 4 means "no index".
 * A displacement of one byte counts in units of 1 << unit.
 */
static uint8_t *put_address(struct encoder *encoder, uint8_t *at, unsigned reg, struct address address,
                            unsigned unit, int trailing)
{
    unsigned modrm = (reg & 7) << 3;
    if (address.base == X86_RIP_LABEL) {
        assert(address.index == X86_NONE);
        *at++ = (uint8_t)(modrm | 5);
        put_relative(encoder, at, address.label, address.displacement, trailing);
        return at + 4;
    }
    assert(address.scale && address.scale <= 8 && !(address.scale & (address.scale - 1)));
    unsigned base = address.base & 7, displacement_bytes = 4;
    unsigned index = address.index == X86_NONE ? 4 : address.index & 7;
    if (address.base == X86_NONE) {
        base = 5;
    } else if (address.displacement == 0 && base != 5) {
        displacement_bytes = 0;
    } else if (fits_byte(address.displacement >> unit) && !(address.displacement & ((1 << unit) - 1))) {
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
    store32(at, (uint32_t)address.displacement);
    return at + displacement_bytes;
}

/* VEX. */

static uint8_t *put_vex(uint8_t *at, const struct vector_row *row, enum vector_length length, unsigned reg,
                        unsigned vvvv, unsigned x, unsigned b)
{
    assert((reg | vvvv) < 16 && row->lengths >> length & 1);
    unsigned r = ~reg >> 3 & 1;
    unsigned last = row->w_prefix | (~vvvv & 15) << 3 | (unsigned)length << 2;
    if (row->map == MAP_0F && !(x | b | row->w_prefix >> 7)) {
        store32(at, 0xC5 | (r << 7 | last) << 8 | (uint32_t)row->opcode << 16);
        return at + 3;
    }
    unsigned middle = r << 7 | (x ^ 1) << 6 | (b ^ 1) << 5 | row->map;
    store32(at, 0xC4 | middle << 8 | last << 16 | (uint32_t)row->opcode << 24);
    return at + 4;
}

/* With `trailing` 1 the immediate byte is part of the instruction, with 0 it is not. */
static void vex_register(struct encoder *encoder, const struct vector_row *row, enum vector_length length,
                         unsigned reg, unsigned vvvv, unsigned rm, unsigned immediate, int trailing)
{
    assert(rm < 16 && row->rm & RM_REGISTER && immediate < 256);
    if (!room(encoder, ENCODER_SLACK))
        return;
    uint8_t *at = put_vex(encoder->at, row, length, reg, vvvv, 0, rm >> 3);
    at[0] = (uint8_t)(0xC0 | (reg & 7) << 3 | (rm & 7));
    at[1] = (uint8_t)immediate;
    encoder->at = at + 1 + trailing;
}

static void vex_memory(struct encoder *encoder, const struct vector_row *row, enum vector_length length,
                       unsigned reg, unsigned vvvv, struct address address, unsigned immediate, int trailing)
{
    assert(row->rm & RM_MEMORY && immediate < 256);
    assert(address.index != X86_RSP || row->form == FORM_GATHER);
    if (!room(encoder, ENCODER_SLACK))
        return;
    uint8_t *at =
        put_vex(encoder->at, row, length, reg, vvvv, index_extension(address), base_extension(address));
    at = put_address(encoder, at, reg, address, 0, trailing);
    *at = (uint8_t)immediate;
    encoder->at = at + trailing;
}

/* EVEX. Registers have five bits; above them a destination says its mask, and whether other lanes become zero. */

enum { OPERAND_BITS = 31, OPERAND_MASK_SHIFT = 8, OPERAND_MASK_BITS = 7, OPERAND_ZERO_SHIFT = 15 };

struct evex_fields {
    unsigned reg, vvvv, x, b;
    unsigned decoration; /* of the destination */
    unsigned broadcast;
};

static uint8_t *put_evex(uint8_t *at, const struct evex_row *evex, enum vector_length length,
                         const struct evex_fields *f)
{
    unsigned mask = f->decoration >> OPERAND_MASK_SHIFT & OPERAND_MASK_BITS;
    unsigned zero = f->decoration >> OPERAND_ZERO_SHIFT & 1;
    assert(evex->row.lengths >> length & 1 && (f->reg | f->vvvv) <= OPERAND_BITS);
    assert(!mask || evex->masking & MASKING_MM);
    assert(!zero || (mask && evex->masking == MASKING_ZM));
    assert(!f->broadcast || evex->broadcast);
    unsigned first =
        (~f->reg >> 3 & 1) << 7 | (f->x ^ 1) << 6 | (f->b ^ 1) << 5 | (~f->reg >> 4 & 1) << 4 | evex->row.map;
    unsigned second = evex->row.w_prefix | (~f->vvvv & 15) << 3;
    unsigned third = zero << 7 | (unsigned)length << 5 | f->broadcast << 4 | (~f->vvvv >> 4 & 1) << 3 | mask;
    store32(at, 0x62 | first << 8 | second << 16 | third << 24);
    at[4] = evex->row.opcode;
    return at + 5;
}

static void evex_register(struct encoder *encoder, const struct evex_row *evex, enum vector_length length,
                          unsigned reg, unsigned vvvv, unsigned rm, unsigned immediate, int trailing)
{
    assert(evex->row.rm & RM_REGISTER && immediate < 256);
    if (!room(encoder, ENCODER_SLACK))
        return;
    const struct evex_fields fields = {.reg = reg & OPERAND_BITS,
                                       .vvvv = vvvv & OPERAND_BITS,
                                       .x = rm >> 4 & 1,
                                       .b = rm >> 3 & 1,
                                       .decoration = reg | vvvv | rm};
    uint8_t *at = put_evex(encoder->at, evex, length, &fields);
    at[0] = (uint8_t)(0xC0 | (reg & 7) << 3 | (rm & 7));
    at[1] = (uint8_t)immediate;
    encoder->at = at + 1 + trailing;
}

static unsigned displacement_unit(const struct evex_row *evex, enum vector_length length, unsigned broadcast)
{
    if (broadcast)
        return evex->broadcast;
    return evex->unit < UNIT_V ? evex->unit : evex->unit - UNIT_V + (unsigned)length;
}

static void evex_memory(struct encoder *encoder, const struct evex_row *evex, enum vector_length length,
                        unsigned reg, unsigned vvvv, struct address address, unsigned immediate, int trailing)
{
    assert(evex->row.rm & RM_MEMORY && immediate < 256 && address.index != X86_RSP);
    if (!room(encoder, ENCODER_SLACK))
        return;
    const struct evex_fields fields = {.reg = reg & OPERAND_BITS,
                                       .vvvv = vvvv & OPERAND_BITS,
                                       .x = index_extension(address),
                                       .b = base_extension(address),
                                       .decoration =
                                           reg | vvvv | (unsigned)address.mask << OPERAND_MASK_SHIFT,
                                       .broadcast = address.broadcast};
    uint8_t *at = put_evex(encoder->at, evex, length, &fields);
    at = put_address(encoder, at, reg, address, displacement_unit(evex, length, address.broadcast), trailing);
    *at = (uint8_t)immediate;
    encoder->at = at + trailing;
}

/* The shorter of the two encodings that can say it. */

static void put_register(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned reg,
                         unsigned vvvv, unsigned rm, unsigned immediate, int trailing)
{
    if (length == X86_512 || (reg | vvvv | rm) > 15 || !vector_rows[id].form)
        evex_register(encoder, &evex_rows[id], length, reg, vvvv, rm, immediate, trailing);
    else
        vex_register(encoder, &vector_rows[id], length, reg, vvvv, rm, immediate, trailing);
}

static void put_memory(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned reg,
                       unsigned vvvv, struct address address, unsigned immediate, int trailing)
{
    if (length == X86_512 || (reg | vvvv) > 15 || address.broadcast || address.mask || !vector_rows[id].form)
        evex_memory(encoder, &evex_rows[id], length, reg, vvvv, address, immediate, trailing);
    else
        vex_memory(encoder, &vector_rows[id], length, reg, vvvv, address, immediate, trailing);
}

/* What both encodings of an instruction have in common: the form and the digit. */
static const struct vector_row *vector_row(enum x86_vector id, unsigned forms)
{
    const struct vector_row *row = vector_rows[id].form ? &vector_rows[id] : &evex_rows[id].row;
    assert(row->form & forms);
    (void)forms;
    return row;
}

int vector_broadcasts(enum x86_vector id)
{
    return evex_rows[id].broadcast;
}

void vector_none(struct encoder *encoder, enum x86_vector id)
{
    const struct vector_row *row = vector_row(id, FORM_NONE);
    if (room(encoder, ENCODER_SLACK))
        encoder->at = put_vex(encoder->at, row, X86_128, 0, 0, 0, 0);
}

void vector_m(struct encoder *encoder, enum x86_vector id, struct address address)
{
    const struct vector_row *row = vector_row(id, FORM_M);
    vex_memory(encoder, row, X86_128, row->digit, 0, address, 0, 0);
}

void vector_rr(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
               unsigned from)
{
    const struct vector_row *row = vector_row(id, FORM_RM | FORM_MR);
    if (row->form == FORM_RM)
        put_register(encoder, id, length, to, 0, from, 0, 0);
    else
        put_register(encoder, id, length, from, 0, to, 0, 0);
}

void vector_rm(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
               struct address from)
{
    vector_row(id, FORM_RM);
    put_memory(encoder, id, length, to, 0, from, 0, 0);
}

void vector_mr(struct encoder *encoder, enum x86_vector id, enum vector_length length, struct address to,
               unsigned from)
{
    vector_row(id, FORM_MR);
    put_memory(encoder, id, length, from, 0, to, 0, 0);
}

void vector_rri(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                unsigned from, unsigned immediate)
{
    const struct vector_row *row = vector_row(id, FORM_RMI | FORM_MRI | FORM_VMI);
    if (row->form == FORM_RMI)
        put_register(encoder, id, length, to, 0, from, immediate, 1);
    else if (row->form == FORM_MRI)
        put_register(encoder, id, length, from, 0, to, immediate, 1);
    else
        put_register(encoder, id, length, row->digit, to, from, immediate, 1);
}

void vector_rmi(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                struct address from, unsigned immediate)
{
    const struct vector_row *row = vector_row(id, FORM_RMI | FORM_VMI);
    if (row->form == FORM_RMI)
        put_memory(encoder, id, length, to, 0, from, immediate, 1);
    else
        put_memory(encoder, id, length, row->digit, to, from, immediate, 1);
}

void vector_mri(struct encoder *encoder, enum x86_vector id, enum vector_length length, struct address to,
                unsigned from, unsigned immediate)
{
    vector_row(id, FORM_MRI);
    put_memory(encoder, id, length, from, 0, to, immediate, 1);
}

void vector_rrr(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                unsigned first, unsigned second)
{
    vector_row(id, FORM_RVM);
    put_register(encoder, id, length, to, first, second, 0, 0);
}

void vector_rrm(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                unsigned first, struct address second)
{
    vector_row(id, FORM_RVM);
    put_memory(encoder, id, length, to, first, second, 0, 0);
}

void vector_rrri(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                 unsigned first, unsigned second, unsigned immediate)
{
    vector_row(id, FORM_RVMI);
    put_register(encoder, id, length, to, first, second, immediate, 1);
}

void vector_rrmi(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                 unsigned first, struct address second, unsigned immediate)
{
    vector_row(id, FORM_RVMI);
    put_memory(encoder, id, length, to, first, second, immediate, 1);
}

void vector_rrrr(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                 unsigned first, unsigned second, unsigned third)
{
    assert(third < 16);
    vex_register(encoder, vector_row(id, FORM_RVMS), length, to, first, second, third << 4, 1);
}

void vector_rrmr(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                 unsigned first, struct address second, unsigned third)
{
    assert(third < 16);
    vex_memory(encoder, vector_row(id, FORM_RVMS), length, to, first, second, third << 4, 1);
}

void vector_mrr(struct encoder *encoder, enum x86_vector id, enum vector_length length, struct address to,
                unsigned mask, unsigned from)
{
    vex_memory(encoder, vector_row(id, FORM_MVR), length, from, mask, to, 0, 0);
}

void vector_gather(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                   struct address from, unsigned mask)
{
    assert(from.index < 16 && to != mask && to != from.index && mask != from.index);
    vex_memory(encoder, vector_row(id, FORM_GATHER), length, to, mask, from, 0, 0);
}

/* Registers above 15, and 512 bits, take six bytes either way. */
void vector_copy(struct encoder *encoder, enum vector_length length, unsigned to, unsigned from)
{
    vector_rr(encoder, from >= 8 && to < 8 ? X86_vmovaps_store : X86_vmovaps, length, to, from);
}

/* General registers: [prefix] [REX] [0F] opcode ModRM ... */

static uint8_t *put_legacy(uint8_t *at, const struct gpr_row *row, unsigned opcode, unsigned rex)
{
    *at = row->prefix;
    at += row->prefix != 0;
    *at = (uint8_t)rex;
    at += rex != 0;
    *at = 0x0F;
    at += row->map == MAP_0F;
    *at = (uint8_t)opcode;
    return at + 1;
}

/* 0 when no extension bit is set: then the instruction carries no REX. */
static unsigned rex_of(enum gpr_size size, unsigned reg, unsigned x, unsigned b)
{
    unsigned bits = (unsigned)size << 3 | (reg >> 3) << 2 | x << 1 | b;
    return bits ? 0x40 | bits : 0;
}

/* The size that REX.W must express: some rows have one size only. */
static enum gpr_size effective_size(const struct gpr_row *row, enum gpr_size size)
{
    return 1u << row->trait & (1u << TRAIT_BYTES | 1u << TRAIT_WORDS | 1u << TRAIT_WIDE | 1u << TRAIT_PLUS)
               ? X86_32
               : size;
}

/* Without a REX, byte registers 4 to 7 are ah, ch, dh and bh. */
static unsigned byte_rex(unsigned byte_register)
{
    return byte_register >= 4 ? 0x40 : 0;
}

static void legacy_register(struct encoder *encoder, const struct gpr_row *row, unsigned opcode,
                            enum gpr_size size, unsigned reg, unsigned rm, int32_t immediate,
                            unsigned trailing)
{
    assert(opcode && (reg | rm) < 16);
    if (!room(encoder, ENCODER_SLACK))
        return;
    unsigned rex = rex_of(effective_size(row, size), reg, 0, rm >> 3);
    if (row->trait == TRAIT_BYTE || row->trait == TRAIT_BYTES)
        rex |= byte_rex(rm) | (row->trait == TRAIT_BYTES ? byte_rex(reg) : 0);
    uint8_t *at = put_legacy(encoder->at, row, opcode, rex);
    *at++ = (uint8_t)(0xC0 | (reg & 7) << 3 | (rm & 7));
    store32(at, (uint32_t)immediate);
    encoder->at = at + trailing;
}

static void legacy_memory(struct encoder *encoder, const struct gpr_row *row, unsigned opcode,
                          enum gpr_size size, unsigned reg, struct address address, int32_t immediate,
                          unsigned trailing)
{
    assert(opcode && reg < 16 && address.index != X86_RSP);
    if (!room(encoder, ENCODER_SLACK))
        return;
    unsigned rex = rex_of(effective_size(row, size), reg, index_extension(address), base_extension(address));
    if (row->trait == TRAIT_BYTES)
        rex |= byte_rex(reg);
    uint8_t *at = put_legacy(encoder->at, row, opcode, rex);
    at = put_address(encoder, at, reg, address, 0, (int)trailing);
    store32(at, (uint32_t)immediate);
    encoder->at = at + trailing;
}

struct immediate_shape {
    uint8_t opcode;
    uint8_t bytes;
};

static struct immediate_shape immediate_shape(const struct gpr_row *row, int32_t immediate)
{
    assert(row->trait != TRAIT_COUNT || (immediate >= 0 && immediate < 64));
    if (row->imm8 && fits_byte(immediate))
        return (struct immediate_shape){row->imm8, 1};
    return (struct immediate_shape){row->imm32, 4};
}

void gpr_rr(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to, enum gpr from)
{
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait != TRAIT_ADDRESS);
    if (row->rm)
        legacy_register(encoder, row, row->rm, size, to, from, 0, 0);
    else
        legacy_register(encoder, row, row->mr, size, from, to, 0, 0);
}

void gpr_rm(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to, struct address from)
{
    legacy_memory(encoder, &gpr_rows[id], gpr_rows[id].rm, size, to, from, 0, 0);
}

void gpr_mr(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, struct address to, enum gpr from)
{
    legacy_memory(encoder, &gpr_rows[id], gpr_rows[id].mr, size, from, to, 0, 0);
}

void gpr_ri(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to, int32_t immediate)
{
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait != TRAIT_TRIPLE);
    if (id == X86_mov) {
        gpr_constant(encoder, to, size == X86_64 ? (uint64_t)(int64_t)immediate : (uint32_t)immediate);
        return;
    }
    struct immediate_shape shape = immediate_shape(row, immediate);
    legacy_register(encoder, row, shape.opcode, size, row->digit, to, immediate, shape.bytes);
}

void gpr_mi(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, struct address to,
            int32_t immediate)
{
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait != TRAIT_TRIPLE);
    struct immediate_shape shape = immediate_shape(row, immediate);
    legacy_memory(encoder, row, shape.opcode, size, row->digit, to, immediate, shape.bytes);
}

void gpr_rri(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to, enum gpr from,
             int32_t immediate)
{
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait == TRAIT_TRIPLE);
    struct immediate_shape shape = immediate_shape(row, immediate);
    legacy_register(encoder, row, shape.opcode, size, to, from, immediate, shape.bytes);
}

void gpr_rmi(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to, struct address from,
             int32_t immediate)
{
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait == TRAIT_TRIPLE);
    struct immediate_shape shape = immediate_shape(row, immediate);
    legacy_memory(encoder, row, shape.opcode, size, to, from, immediate, shape.bytes);
}

void gpr_r(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr operand)
{
    const struct gpr_row *row = &gpr_rows[id];
    if (row->trait != TRAIT_PLUS) {
        legacy_register(encoder, row, row->single, size, row->digit, operand, 0, 0);
    } else if (room(encoder, ENCODER_SLACK)) {
        unsigned rex = rex_of(X86_32, 0, 0, operand >> 3);
        encoder->at = put_legacy(encoder->at, row, row->single | (operand & 7), rex);
    }
}

void gpr_m(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, struct address operand)
{
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait != TRAIT_PLUS);
    legacy_memory(encoder, row, row->single, size, row->digit, operand, 0, 0);
}

void gpr_constant(struct encoder *encoder, enum gpr to, uint64_t value)
{
    if (!room(encoder, ENCODER_SLACK))
        return;
    if (value > UINT32_MAX && (int64_t)value == (int32_t)value) {
        legacy_register(encoder, &gpr_rows[X86_mov], gpr_rows[X86_mov].imm32, X86_64, 0, to, (int32_t)value,
                        4);
        return;
    }
    bool wide = value > UINT32_MAX;
    uint8_t *at = encoder->at;
    *at = (uint8_t)rex_of(wide ? X86_64 : X86_32, 0, 0, to >> 3);
    at += *at != 0;
    *at++ = (uint8_t)(0xB8 | (to & 7));
    memcpy(at, &value, sizeof value);
    encoder->at = at + (wide ? 8 : 4);
}

/* Control flow, data, padding. */

static void branch(struct encoder *encoder, unsigned short_opcode, uint32_t label)
{
    assert(label < encoder->label_count);
    if (!room(encoder, ENCODER_SLACK))
        return;
    uint8_t *at = encoder->at;
    int32_t target = encoder->labels[label];
    ptrdiff_t distance = target - (at + 2 - encoder->start);
    if (target != LABEL_UNBOUND && distance >= INT8_MIN) {
        at[0] = (uint8_t)short_opcode;
        at[1] = (uint8_t)distance;
        encoder->at = at + 2;
        return;
    }
    bool conditional = short_opcode != 0xEB;
    *at = 0x0F;
    at += conditional;
    *at++ = (uint8_t)(conditional ? short_opcode + 0x10 : 0xE9);
    put_relative(encoder, at, label, 0, 0);
    encoder->at = at + 4;
}

void encode_jump(struct encoder *encoder, uint32_t label)
{
    branch(encoder, 0xEB, label);
}

void encode_jump_if(struct encoder *encoder, enum x86_condition condition, uint32_t label)
{
    branch(encoder, 0x70 | (unsigned)condition, label);
}

void encode_return(struct encoder *encoder)
{
    encode_data(encoder, &(uint8_t){0xC3}, 1);
}

void encode_label(struct encoder *encoder, uint32_t label)
{
    assert(label < encoder->label_count && encoder->labels[label] == LABEL_UNBOUND);
    encoder->labels[label] = (int32_t)encoder_size(encoder);
}

void encode_data(struct encoder *encoder, const void *bytes, size_t count)
{
    if (!room(encoder, count))
        return;
    memcpy(encoder->at, bytes, count);
    encoder->at += count;
}

void encode_nops(struct encoder *encoder, unsigned count)
{
    /* The forms that Intel recommends; row n - 1 is one instruction of n bytes. */
    enum { LONGEST = 9 };
    static const uint8_t nops[LONGEST][LONGEST] = {
        {0x90},
        {0x66, 0x90},
        {0x0F, 0x1F, 0x00},
        {0x0F, 0x1F, 0x40, 0x00},
        {0x0F, 0x1F, 0x44, 0x00, 0x00},
        {0x66, 0x0F, 0x1F, 0x44, 0x00, 0x00},
        {0x0F, 0x1F, 0x80, 0x00, 0x00, 0x00, 0x00},
        {0x0F, 0x1F, 0x84, 0x00, 0x00, 0x00, 0x00, 0x00},
        {0x66, 0x0F, 0x1F, 0x84, 0x00, 0x00, 0x00, 0x00, 0x00},
    };
    while (count) {
        unsigned length = count < LONGEST ? count : LONGEST;
        encode_data(encoder, nops[length - 1], length);
        count -= length;
    }
}

void encode_align(struct encoder *encoder, unsigned alignment)
{
    assert(alignment && !(alignment & (alignment - 1)));
    encode_nops(encoder, (unsigned)-encoder_size(encoder) & (alignment - 1));
}

void encoder_start(struct encoder *encoder, void *code, size_t bytes, int32_t *labels, uint32_t label_count,
                   struct fixup *fixups, uint32_t fixup_capacity)
{
    assert(bytes <= INT32_MAX);
    *encoder = (struct encoder){
        .start = code,
        .at = code,
        .limit = (uint8_t *)code + bytes,
        .labels = labels,
        .fixups = fixups,
        .label_count = label_count,
        .fixup_capacity = fixup_capacity,
    };
    for (uint32_t label = 0; label < label_count; label++)
        labels[label] = LABEL_UNBOUND;
}

uint32_t encoder_add_label(struct encoder *encoder)
{
    encoder->labels[encoder->label_count] = LABEL_UNBOUND;
    return encoder->label_count++;
}

int encoder_finish(struct encoder *encoder, struct error *error)
{
    if (encoder->failure == ENCODER_OUT_OF_CODE)
        return error_set(error, "machine code does not fit: no room after %zu bytes", encoder_size(encoder));
    if (encoder->failure == ENCODER_OUT_OF_FIXUPS)
        return error_set(error, "machine code has more than %u forward references", encoder->fixup_capacity);
    for (uint32_t i = 0; i < encoder->fixup_count; i++) {
        struct fixup fixup = encoder->fixups[i];
        int32_t target = encoder->labels[fixup.label];
        if (target == LABEL_UNBOUND) {
            fail(encoder, ENCODER_UNBOUND_LABEL);
            return error_set(error, "machine code refers to label %u, which is bound nowhere", fixup.label);
        }
        store32(encoder->start + fixup.offset, (uint32_t)(target + fixup.addend - (int32_t)fixup.offset));
    }
    return 0;
}
