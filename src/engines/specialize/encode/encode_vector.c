/* Vector instructions: VEX and EVEX.
 *
 * A row of x86.def is packed into eight bytes that are already at the bit positions of VEX, and two more for
 * EVEX. A prefix with its opcode is composed in a register and stored as one word. A store may write past the
 * end of the instruction, within the slack that encode_room has checked; the next instruction overwrites
 * those bytes. */
#include "engines/specialize/encode/encode_bytes.h"
#include "engines/specialize/encode/operand.h"

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
    LENGTHS_LX = 1 << X86_128,
    LENGTHS_LY = 1 << X86_256,
    LENGTHS_LV = LENGTHS_LX | LENGTHS_LY,
    EVEX_LENGTHS_LX = 1 << X86_128,
    EVEX_LENGTHS_LZ = 1 << X86_512,
    EVEX_LENGTHS_LW = 1 << X86_256 | EVEX_LENGTHS_LZ,
    EVEX_LENGTHS_LV = EVEX_LENGTHS_LX | EVEX_LENGTHS_LW,
};

/* The kinds of operand that ModRM.rm of a row can be. */
enum {
    RM_REGISTER = 1,
    RM_MEMORY = 2,
    RM_WORD = 4, /* memory of four bytes */
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
    MEMORY_M32 = RM_MEMORY | RM_WORD,
    MEMORY_M64 = RM_MEMORY,
    MEMORY_M128 = RM_MEMORY,
    MEMORY_M256 = RM_MEMORY,
    MEMORY_MN = 0,
};

/* EVEX: the unit of an 8-bit displacement as a power of two. From UNIT_V on it grows with the vector length.
 */
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
    BROADCAST_B4 = 2, /* the same for one element */
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
#include "def/engine/x86.def"
};

/* row.map is EVEX.P0 without the high bits of registers; row.w_prefix has W, pp and the bit that is always
 * set. */
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
#include "def/engine/x86.def"
};

/* VEX. */

static uint8_t *put_vex(uint8_t *at, const struct vector_row *row, enum vector_length length, unsigned reg,
                        unsigned vvvv, unsigned x, unsigned b)
{
    assert((reg | vvvv) < 16 && row->lengths >> length & 1);
    unsigned r = ~reg >> 3 & 1;
    unsigned last = row->w_prefix | (~vvvv & 15) << 3 | (unsigned)length << 2;
    if (row->map == MAP_0F && !(x | b | row->w_prefix >> 7)) {
        encode_store32(at, 0xC5 | (r << 7 | last) << 8 | (uint32_t)row->opcode << 16);
        return at + 3;
    }
    unsigned middle = r << 7 | (x ^ 1) << 6 | (b ^ 1) << 5 | row->map;
    encode_store32(at, 0xC4 | middle << 8 | last << 16 | (uint32_t)row->opcode << 24);
    return at + 4;
}

/* The immediate byte is part of the instruction if `trailing` is 1. */
static void vex_register(struct encoder *encoder, const struct vector_row *row, enum vector_length length,
                         unsigned reg, unsigned vvvv, unsigned rm, unsigned immediate, int trailing)
{
    assert(rm < 16 && row->rm & RM_REGISTER && immediate < 256);
    if (!encode_room(encoder, ENCODER_SLACK))
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
    if (!encode_room(encoder, ENCODER_SLACK))
        return;
    uint8_t *at = put_vex(encoder->at, row, length, reg, vvvv, encode_index_extension(address),
                          encode_base_extension(address));
    at = encode_address(encoder, at, reg, address, 0, trailing);
    *at = (uint8_t)immediate;
    encoder->at = at + trailing;
}

/* EVEX. A register operand has five bits. In a destination, higher bits are its mask and whether other lanes
 * become zero. */

enum { OPERAND_BITS = 31, OPERAND_MASK_SHIFT = 8, OPERAND_MASK_BITS = 7, OPERAND_ZERO_SHIFT = 15 };

struct evex_fields {
    unsigned reg, vvvv, x, b;
    unsigned decoration; /* the higher bits of the destination */
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
    encode_store32(at, 0x62 | first << 8 | second << 16 | third << 24);
    at[4] = evex->row.opcode;
    return at + 5;
}

static void evex_register(struct encoder *encoder, const struct evex_row *evex, enum vector_length length,
                          unsigned reg, unsigned vvvv, unsigned rm, unsigned immediate, int trailing)
{
    assert(evex->row.rm & RM_REGISTER && immediate < 256);
    if (!encode_room(encoder, ENCODER_SLACK))
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
    if (!encode_room(encoder, ENCODER_SLACK))
        return;
    const struct evex_fields fields = {.reg = reg & OPERAND_BITS,
                                       .vvvv = vvvv & OPERAND_BITS,
                                       .x = encode_index_extension(address),
                                       .b = encode_base_extension(address),
                                       .decoration =
                                           reg | vvvv | (unsigned)address.mask << OPERAND_MASK_SHIFT,
                                       .broadcast = address.broadcast};
    uint8_t *at = put_evex(encoder->at, evex, length, &fields);
    at = encode_address(encoder, at, reg, address, displacement_unit(evex, length, address.broadcast),
                        trailing);
    *at = (uint8_t)immediate;
    encoder->at = at + trailing;
}

/* The shorter encoding of the two that are possible. */

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

/* The row with the form and the digit, which both encodings of an instruction share. */
static const struct vector_row *vector_row(enum x86_vector id, unsigned forms)
{
    const struct vector_row *row = vector_rows[id].form ? &vector_rows[id] : &evex_rows[id].row;
    assert(row->form & forms);
    (void)forms;
    return row;
}

bool encode_broadcasts(enum x86_vector id)
{
    return evex_rows[id].broadcast != 0;
}

bool encode_reads_word(enum x86_vector id)
{
    return vector_rows[id].rm & RM_WORD;
}

void encode_none(struct encoder *encoder, enum x86_vector id)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, X86_128, NULL);
        return;
    }
    const struct vector_row *row = vector_row(id, FORM_NONE);
    if (encode_room(encoder, ENCODER_SLACK))
        encoder->at = put_vex(encoder->at, row, X86_128, 0, 0, 0, 0);
}

void encode_m(struct encoder *encoder, enum x86_vector id, struct address address)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, X86_128, (const struct x86_operand[]){x86_operand_memory(address)});
        return;
    }
    const struct vector_row *row = vector_row(id, FORM_M);
    vex_memory(encoder, row, X86_128, row->digit, 0, address, 0, 0);
}

void encode_rr(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
               unsigned from)
{
    if (encoder->text) {
        encode_print_vector(
            encoder, id, length,
            (const struct x86_operand[]){x86_operand_register(to), x86_operand_register(from)});
        return;
    }
    const struct vector_row *row = vector_row(id, FORM_RM | FORM_MR);
    if (row->form == FORM_RM)
        put_register(encoder, id, length, to, 0, from, 0, 0);
    else
        put_register(encoder, id, length, from, 0, to, 0, 0);
}

void encode_rm(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
               struct address from)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_register(to), x86_operand_memory(from)});
        return;
    }
    vector_row(id, FORM_RM);
    put_memory(encoder, id, length, to, 0, from, 0, 0);
}

void encode_mr(struct encoder *encoder, enum x86_vector id, enum vector_length length, struct address to,
               unsigned from)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_memory(to), x86_operand_register(from)});
        return;
    }
    vector_row(id, FORM_MR);
    put_memory(encoder, id, length, from, 0, to, 0, 0);
}

void encode_rri(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                unsigned from, unsigned immediate)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_register(to), x86_operand_register(from),
                                                         x86_operand_immediate(immediate)});
        return;
    }
    const struct vector_row *row = vector_row(id, FORM_RMI | FORM_MRI | FORM_VMI);
    if (row->form == FORM_RMI)
        put_register(encoder, id, length, to, 0, from, immediate, 1);
    else if (row->form == FORM_MRI)
        put_register(encoder, id, length, from, 0, to, immediate, 1);
    else
        put_register(encoder, id, length, row->digit, to, from, immediate, 1);
}

void encode_rmi(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                struct address from, unsigned immediate)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_register(to), x86_operand_memory(from),
                                                         x86_operand_immediate(immediate)});
        return;
    }
    const struct vector_row *row = vector_row(id, FORM_RMI | FORM_VMI);
    if (row->form == FORM_RMI)
        put_memory(encoder, id, length, to, 0, from, immediate, 1);
    else
        put_memory(encoder, id, length, row->digit, to, from, immediate, 1);
}

void encode_mri(struct encoder *encoder, enum x86_vector id, enum vector_length length, struct address to,
                unsigned from, unsigned immediate)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_memory(to), x86_operand_register(from),
                                                         x86_operand_immediate(immediate)});
        return;
    }
    vector_row(id, FORM_MRI);
    put_memory(encoder, id, length, from, 0, to, immediate, 1);
}

void encode_rrr(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                unsigned first, unsigned second)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_register(to),
                                                         x86_operand_register(first),
                                                         x86_operand_register(second)});
        return;
    }
    vector_row(id, FORM_RVM);
    put_register(encoder, id, length, to, first, second, 0, 0);
}

void encode_rrm(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                unsigned first, struct address second)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_register(to),
                                                         x86_operand_register(first),
                                                         x86_operand_memory(second)});
        return;
    }
    vector_row(id, FORM_RVM);
    put_memory(encoder, id, length, to, first, second, 0, 0);
}

void encode_rrri(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                 unsigned first, unsigned second, unsigned immediate)
{
    if (encoder->text) {
        encode_print_vector(
            encoder, id, length,
            (const struct x86_operand[]){x86_operand_register(to), x86_operand_register(first),
                                         x86_operand_register(second), x86_operand_immediate(immediate)});
        return;
    }
    vector_row(id, FORM_RVMI);
    put_register(encoder, id, length, to, first, second, immediate, 1);
}

void encode_rrmi(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                 unsigned first, struct address second, unsigned immediate)
{
    if (encoder->text) {
        encode_print_vector(
            encoder, id, length,
            (const struct x86_operand[]){x86_operand_register(to), x86_operand_register(first),
                                         x86_operand_memory(second), x86_operand_immediate(immediate)});
        return;
    }
    vector_row(id, FORM_RVMI);
    put_memory(encoder, id, length, to, first, second, immediate, 1);
}

void encode_rrrr(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                 unsigned first, unsigned second, unsigned third)
{
    if (encoder->text) {
        encode_print_vector(
            encoder, id, length,
            (const struct x86_operand[]){x86_operand_register(to), x86_operand_register(first),
                                         x86_operand_register(second), x86_operand_register(third)});
        return;
    }
    assert(third < 16);
    vex_register(encoder, vector_row(id, FORM_RVMS), length, to, first, second, third << 4, 1);
}

void encode_rrmr(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                 unsigned first, struct address second, unsigned third)
{
    if (encoder->text) {
        encode_print_vector(
            encoder, id, length,
            (const struct x86_operand[]){x86_operand_register(to), x86_operand_register(first),
                                         x86_operand_memory(second), x86_operand_register(third)});
        return;
    }
    assert(third < 16);
    vex_memory(encoder, vector_row(id, FORM_RVMS), length, to, first, second, third << 4, 1);
}

void encode_mrr(struct encoder *encoder, enum x86_vector id, enum vector_length length, struct address to,
                unsigned mask, unsigned from)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_memory(to), x86_operand_register(mask),
                                                         x86_operand_register(from)});
        return;
    }
    vex_memory(encoder, vector_row(id, FORM_MVR), length, from, mask, to, 0, 0);
}

void encode_gather(struct encoder *encoder, enum x86_vector id, enum vector_length length, unsigned to,
                   struct address from, unsigned mask)
{
    if (encoder->text) {
        encode_print_vector(encoder, id, length,
                            (const struct x86_operand[]){x86_operand_register(to), x86_operand_memory(from),
                                                         x86_operand_register(mask)});
        return;
    }
    assert(from.index < 16 && to != mask && to != from.index && mask != from.index);
    vex_memory(encoder, vector_row(id, FORM_GATHER), length, to, mask, from, 0, 0);
}
