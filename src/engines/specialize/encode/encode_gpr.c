/* General-register instructions: [prefix] [REX] [0F] opcode ModRM ... */
#include "engines/specialize/encode/encode_bytes.h"
#include "engines/specialize/encode/operand.h"

enum { LEGACY_NP = 0, LEGACY_66 = 0x66, LEGACY_F3 = 0xF3, LEGACY_F2 = 0xF2 };

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
#include "def/engine/x86.def"
};

const char *const encode_gpr_mnemonic[X86_GPR_COUNT] = {
#define X86_GPR(id, mnemonic, ...) [X86_##id] = #mnemonic,
#include "def/engine/x86.def"
};

void encode_gpr_bits(enum x86_gpr id, enum gpr_size size, unsigned *reg, unsigned *rm)
{
    *reg = *rm = size == X86_64 ? 64 : 32;
    switch (gpr_rows[id].trait) {
    case TRAIT_BYTE: *rm = 8; break;
    case TRAIT_WORD: *rm = 16; break;
    case TRAIT_DWORD: *rm = 32; break;
    case TRAIT_BYTES: *reg = *rm = 8; break;
    case TRAIT_WORDS: *reg = *rm = 16; break;
    case TRAIT_ADDRESS: *rm = 0; break;
    case TRAIT_WIDE:
    case TRAIT_PLUS: *reg = *rm = 64; break;
    default: break;
    }
}

bool encode_gpr_counts(enum x86_gpr id)
{
    return gpr_rows[id].trait == TRAIT_COUNT;
}

bool encode_gpr_has_shape(enum x86_gpr id, const struct x86_operand operands[X86_OPERANDS], unsigned count)
{
    const struct gpr_row *row = &gpr_rows[id];
    bool memory =
        operands[0].kind == X86_OPERAND_MEMORY || (count > 1 && operands[1].kind == X86_OPERAND_MEMORY);
    bool immediate = operands[count - 1].kind == X86_OPERAND_IMMEDIATE;
    if (count == 1)
        return row->single && !(memory && row->trait == TRAIT_PLUS);
    if (immediate)
        return (row->imm8 || row->imm32) && (row->trait == TRAIT_TRIPLE) == (count == 3);
    if (count != 2 || (row->trait == TRAIT_ADDRESS && !memory))
        return false;
    return operands[0].kind == X86_OPERAND_MEMORY ? row->mr : memory ? row->rm : row->rm || row->mr;
}

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

/* Returns 0 if no bit is set: the instruction then has no REX. */
static unsigned rex_of(enum gpr_size size, unsigned reg, unsigned x, unsigned b)
{
    unsigned bits = (unsigned)size << 3 | (reg >> 3) << 2 | x << 1 | b;
    return bits ? 0x40 | bits : 0;
}

/* The size for REX.W. Some rows have one size only. */
static enum gpr_size effective_size(const struct gpr_row *row, enum gpr_size size)
{
    return 1u << row->trait & (1u << TRAIT_BYTES | 1u << TRAIT_WORDS | 1u << TRAIT_WIDE | 1u << TRAIT_PLUS)
               ? X86_32
               : size;
}

/* Byte registers 4 to 7 need a REX: without one they are ah, ch, dh and bh. */
static unsigned byte_rex(unsigned byte_register)
{
    return byte_register >= 4 ? 0x40 : 0;
}

static void legacy_register(struct encoder *encoder, const struct gpr_row *row, unsigned opcode,
                            enum gpr_size size, unsigned reg, unsigned rm, int32_t immediate,
                            unsigned trailing)
{
    assert(opcode && (reg | rm) < 16);
    if (!encode_room(encoder, ENCODER_SLACK))
        return;
    unsigned rex = rex_of(effective_size(row, size), reg, 0, rm >> 3);
    if (row->trait == TRAIT_BYTE || row->trait == TRAIT_BYTES)
        rex |= byte_rex(rm) | (row->trait == TRAIT_BYTES ? byte_rex(reg) : 0);
    uint8_t *at = put_legacy(encoder->at, row, opcode, rex);
    *at++ = (uint8_t)(0xC0 | (reg & 7) << 3 | (rm & 7));
    encode_store32(at, (uint32_t)immediate);
    encoder->at = at + trailing;
}

static void legacy_memory(struct encoder *encoder, const struct gpr_row *row, unsigned opcode,
                          enum gpr_size size, unsigned reg, struct address address, int32_t immediate,
                          unsigned trailing)
{
    assert(opcode && reg < 16 && address.index != X86_RSP);
    if (!encode_room(encoder, ENCODER_SLACK))
        return;
    unsigned rex = rex_of(effective_size(row, size), reg, encode_index_extension(address),
                          encode_base_extension(address));
    if (row->trait == TRAIT_BYTES)
        rex |= byte_rex(reg);
    uint8_t *at = put_legacy(encoder->at, row, opcode, rex);
    at = encode_address(encoder, at, reg, address, 0, (int)trailing);
    encode_store32(at, (uint32_t)immediate);
    encoder->at = at + trailing;
}

struct immediate_shape {
    uint8_t opcode;
    uint8_t bytes;
};

static struct immediate_shape immediate_shape(const struct gpr_row *row, int32_t immediate)
{
    assert(row->trait != TRAIT_COUNT || (immediate >= 0 && immediate < 64));
    if (row->imm8 && encode_fits_byte(immediate))
        return (struct immediate_shape){row->imm8, 1};
    return (struct immediate_shape){row->imm32, 4};
}

void encode_gpr_rr(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to, enum gpr from)
{
    if (encoder->text) {
        encode_print_gpr(encoder, id, size,
                         (const struct x86_operand[]){x86_operand_register(to), x86_operand_register(from)},
                         2);
        return;
    }
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait != TRAIT_ADDRESS);
    if (row->rm)
        legacy_register(encoder, row, row->rm, size, to, from, 0, 0);
    else
        legacy_register(encoder, row, row->mr, size, from, to, 0, 0);
}

void encode_gpr_rm(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to,
                   struct address from)
{
    if (encoder->text) {
        encode_print_gpr(encoder, id, size,
                         (const struct x86_operand[]){x86_operand_register(to), x86_operand_memory(from)}, 2);
        return;
    }
    legacy_memory(encoder, &gpr_rows[id], gpr_rows[id].rm, size, to, from, 0, 0);
}

void encode_gpr_mr(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, struct address to,
                   enum gpr from)
{
    if (encoder->text) {
        encode_print_gpr(encoder, id, size,
                         (const struct x86_operand[]){x86_operand_memory(to), x86_operand_register(from)}, 2);
        return;
    }
    legacy_memory(encoder, &gpr_rows[id], gpr_rows[id].mr, size, from, to, 0, 0);
}

void encode_gpr_ri(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to,
                   int32_t immediate)
{
    if (encoder->text) {
        encode_print_gpr(
            encoder, id, size,
            (const struct x86_operand[]){x86_operand_register(to), x86_operand_immediate(immediate)}, 2);
        return;
    }
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait != TRAIT_TRIPLE);
    if (id == X86_mov) {
        encode_gpr_constant(encoder, to, size == X86_64 ? (uint64_t)(int64_t)immediate : (uint32_t)immediate);
        return;
    }
    struct immediate_shape shape = immediate_shape(row, immediate);
    legacy_register(encoder, row, shape.opcode, size, row->digit, to, immediate, shape.bytes);
}

void encode_gpr_mi(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, struct address to,
                   int32_t immediate)
{
    if (encoder->text) {
        encode_print_gpr(
            encoder, id, size,
            (const struct x86_operand[]){x86_operand_memory(to), x86_operand_immediate(immediate)}, 2);
        return;
    }
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait != TRAIT_TRIPLE);
    struct immediate_shape shape = immediate_shape(row, immediate);
    legacy_memory(encoder, row, shape.opcode, size, row->digit, to, immediate, shape.bytes);
}

void encode_gpr_rri(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to, enum gpr from,
                    int32_t immediate)
{
    if (encoder->text) {
        encode_print_gpr(encoder, id, size,
                         (const struct x86_operand[]){x86_operand_register(to), x86_operand_register(from),
                                                      x86_operand_immediate(immediate)},
                         3);
        return;
    }
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait == TRAIT_TRIPLE);
    struct immediate_shape shape = immediate_shape(row, immediate);
    legacy_register(encoder, row, shape.opcode, size, to, from, immediate, shape.bytes);
}

void encode_gpr_rmi(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr to,
                    struct address from, int32_t immediate)
{
    if (encoder->text) {
        encode_print_gpr(encoder, id, size,
                         (const struct x86_operand[]){x86_operand_register(to), x86_operand_memory(from),
                                                      x86_operand_immediate(immediate)},
                         3);
        return;
    }
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait == TRAIT_TRIPLE);
    struct immediate_shape shape = immediate_shape(row, immediate);
    legacy_memory(encoder, row, shape.opcode, size, to, from, immediate, shape.bytes);
}

void encode_gpr_r(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, enum gpr operand)
{
    if (encoder->text) {
        encode_print_gpr(encoder, id, size, (const struct x86_operand[]){x86_operand_register(operand)}, 1);
        return;
    }
    const struct gpr_row *row = &gpr_rows[id];
    if (row->trait != TRAIT_PLUS) {
        legacy_register(encoder, row, row->single, size, row->digit, operand, 0, 0);
    } else if (encode_room(encoder, ENCODER_SLACK)) {
        unsigned rex = rex_of(X86_32, 0, 0, operand >> 3);
        encoder->at = put_legacy(encoder->at, row, row->single | (operand & 7), rex);
    }
}

void encode_gpr_m(struct encoder *encoder, enum x86_gpr id, enum gpr_size size, struct address operand)
{
    if (encoder->text) {
        encode_print_gpr(encoder, id, size, (const struct x86_operand[]){x86_operand_memory(operand)}, 1);
        return;
    }
    const struct gpr_row *row = &gpr_rows[id];
    assert(row->trait != TRAIT_PLUS);
    legacy_memory(encoder, row, row->single, size, row->digit, operand, 0, 0);
}

void encode_gpr_constant(struct encoder *encoder, enum gpr to, uint64_t value)
{
    if (encoder->text) {
        encode_print_gpr(
            encoder, X86_mov, X86_64,
            (const struct x86_operand[]){x86_operand_register(to), x86_operand_immediate((int64_t)value)}, 2);
        return;
    }
    if (!encode_room(encoder, ENCODER_SLACK))
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
