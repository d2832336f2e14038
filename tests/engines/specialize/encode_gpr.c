/* Every encoding of a general-purpose instruction in src/def/engine/x86.def, decoded by a disassembler, as
 * tests/engines/specialize/encode.c describes it for vector instructions; and the encodings of constants. */
#include "engines/specialize/encode/encode.h"
#include "tests/support/routine/decoded.h"
#include "tests/support/system/seed.h"

#include <stdbool.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static bool is(const char *text, const char *other)
{
    return !strcmp(text, other);
}

/* General-register rows. */

struct gpr_expectation {
    enum x86_gpr id;
    const char *name, *mnemonic, *trait;
    uint8_t rm, mr, imm8, imm32, single;
};

static const struct gpr_expectation gpr_rows[] = {
#define X86_GPR(id, mnemonic, prefix, map, rm, mr, imm8, imm32, single, digit, trait)                        \
    {X86_##id, #id, #mnemonic, #trait, rm, mr, imm8, imm32, single},
#include "def/engine/x86.def"
};

struct gpr_choice {
    const struct gpr_expectation *row;
    enum gpr_size size;
    unsigned reg;
};

static bool has_immediate(const struct gpr_expectation *row)
{
    return row->imm8 || row->imm32;
}

static unsigned rm_bits(const struct gpr_choice *c)
{
    const char *trait = c->row->trait;
    if (is(trait, "BYTE") || is(trait, "BYTES"))
        return 8;
    if (is(trait, "WORD") || is(trait, "WORDS"))
        return 16;
    if (is(trait, "DWORD"))
        return 32;
    return c->size == X86_64 || is(trait, "WIDE") || is(trait, "PLUS") ? 64 : 32;
}

static unsigned reg_bits(const struct gpr_choice *c)
{
    if (is(c->row->trait, "BYTES") || is(c->row->trait, "WORDS"))
        return rm_bits(c);
    return c->size == X86_64 ? 64 : 32;
}

static void require_gpr(unsigned operand, unsigned bits, unsigned number)
{
    switch (bits) {
    case 64: decoded_require_register(operand, ZYDIS_REGISTER_RAX, number); break;
    case 32: decoded_require_register(operand, ZYDIS_REGISTER_EAX, number); break;
    case 16: decoded_require_register(operand, ZYDIS_REGISTER_AX, number); break;
    case 8:
        if (number < 4)
            decoded_require_register(operand, ZYDIS_REGISTER_AL, number);
        else
            decoded_require_register(operand, ZYDIS_REGISTER_SPL, number - 4);
        break;
    default: TEST_FAIL();
    }
}

static void require_gpr_memory(const struct gpr_choice *c, unsigned operand, struct address address)
{
    decoded_require_memory(operand, address, ZYDIS_REGISTER_RAX,
                           is(c->row->trait, "ADDRESS") ? 0 : rm_bits(c));
}

static void require_gpr_immediate(const struct gpr_choice *c, unsigned operand, int32_t immediate)
{
    bool byte = c->row->imm8 && immediate == (int8_t)immediate;
    decoded_require(decoded_at.operands[operand].type == ZYDIS_OPERAND_TYPE_IMMEDIATE, "kind of operand");
    decoded_require((int32_t)decoded_at.operands[operand].imm.value.u == immediate, "immediate");
    if (c->size == X86_64 && !is(c->row->trait, "COUNT"))
        decoded_require(decoded_at.operands[operand].imm.value.s == immediate, "sign of the immediate");
    decoded_require(decoded_at.decoded.raw.imm[0].size == (byte ? 8 : 32), "immediate size");
}

/* There is a REX only if one of its bits is needed, or if a byte register would be ah to bh without it. */
static void require_rex(const struct gpr_choice *c, bool extended, bool new_byte_register)
{
    const char *trait = c->row->trait;
    bool wide = c->size == X86_64 && !is(trait, "WIDE") && !is(trait, "PLUS") && !is(trait, "BYTES") &&
                !is(trait, "WORDS");
    bool has = decoded_at.decoded.attributes & ZYDIS_ATTRIB_HAS_REX;
    decoded_require(has == (wide || extended || new_byte_register), "REX");
}

static void check_gpr_registers(const struct gpr_choice *c, unsigned to, unsigned from)
{
    encode_gpr_rr(decoded_begin(), c->row->id, c->size, to, from);
    decoded_finish(c->row->mnemonic, 2);
    bool store = !c->row->rm, new_byte = false;
    require_gpr(0, store ? rm_bits(c) : reg_bits(c), to);
    require_gpr(1, store ? reg_bits(c) : rm_bits(c), from);
    if (rm_bits(c) == 8)
        new_byte = from >= 4 || (reg_bits(c) == 8 && to >= 4);
    require_rex(c, to >= 8 || from >= 8, new_byte);
}

static bool extends(struct address address)
{
    return (address.base < 16 && address.base >= 8) || (address.index < 16 && address.index >= 8);
}

static void check_gpr_load(void *context, struct address address)
{
    struct gpr_choice *c = context;
    c->reg = (c->reg + 5) % 16;
    encode_gpr_rm(decoded_begin(), c->row->id, c->size, c->reg, address);
    decoded_finish(c->row->mnemonic, 2);
    require_gpr(0, reg_bits(c), c->reg);
    require_gpr_memory(c, 1, address);
    require_rex(c, c->reg >= 8 || extends(address), false);
}

static void check_gpr_store(void *context, struct address address)
{
    struct gpr_choice *c = context;
    c->reg = (c->reg + 5) % 16;
    encode_gpr_mr(decoded_begin(), c->row->id, c->size, address, c->reg);
    decoded_finish(c->row->mnemonic, 2);
    require_gpr_memory(c, 0, address);
    require_gpr(1, reg_bits(c), c->reg);
    require_rex(c, c->reg >= 8 || extends(address), reg_bits(c) == 8 && c->reg >= 4);
}

static void check_gpr_single_memory(void *context, struct address address)
{
    struct gpr_choice *c = context;
    encode_gpr_m(decoded_begin(), c->row->id, c->size, address);
    decoded_finish(c->row->mnemonic, 1);
    require_gpr_memory(c, 0, address);
    require_rex(c, extends(address), false);
}

static const int32_t immediates[] = {0,    1,   31,   32,         63,        -1,       127,
                                     -128, 128, -129, 0x12345678, INT32_MAX, INT32_MIN};
enum { IMMEDIATES = sizeof immediates / sizeof *immediates };

static bool takes_immediate(const struct gpr_choice *c, int32_t immediate)
{
    return !is(c->row->trait, "COUNT") || (immediate >= 0 && immediate < (c->size == X86_64 ? 64 : 32));
}

static void check_gpr_memory_immediate(void *context, struct address address)
{
    struct gpr_choice *c = context;
    bool triple = is(c->row->trait, "TRIPLE");
    c->reg = (c->reg + 5) % 16;
    for (unsigned i = 0; i < IMMEDIATES; i++) {
        if (!takes_immediate(c, immediates[i]))
            continue;
        if (triple)
            encode_gpr_rmi(decoded_begin(), c->row->id, c->size, c->reg, address, immediates[i]);
        else
            encode_gpr_mi(decoded_begin(), c->row->id, c->size, address, immediates[i]);
        decoded_finish(c->row->mnemonic, 2 + triple);
        if (triple)
            require_gpr(0, reg_bits(c), c->reg);
        require_gpr_memory(c, triple, address);
        require_gpr_immediate(c, 1 + triple, immediates[i]);
        require_rex(c, extends(address) || (triple && c->reg >= 8), false);
    }
}

static void check_gpr_register_immediate(const struct gpr_choice *c, unsigned to, unsigned from)
{
    bool triple = is(c->row->trait, "TRIPLE");
    for (unsigned i = 0; i < IMMEDIATES; i++) {
        if (!takes_immediate(c, immediates[i]))
            continue;
        if (triple)
            encode_gpr_rri(decoded_begin(), c->row->id, c->size, to, from, immediates[i]);
        else
            encode_gpr_ri(decoded_begin(), c->row->id, c->size, to, immediates[i]);
        decoded_finish(c->row->mnemonic, 2 + triple);
        require_gpr(0, reg_bits(c), to);
        if (triple)
            require_gpr(1, rm_bits(c), from);
        require_gpr_immediate(c, 1 + triple, immediates[i]);
        require_rex(c, to >= 8 || (triple && from >= 8), false);
    }
}

typedef void gpr_test(struct gpr_choice *choice);

static void for_each_gpr_row(gpr_test *test)
{
    for (unsigned i = 0; i < X86_GPR_COUNT; i += test_stride_of(7))
        for (unsigned size = X86_32; size <= X86_64; size++) {
            decoded_at.row = gpr_rows[i].name;
            test(&(struct gpr_choice){.row = &gpr_rows[i], .size = size});
        }
}

static void all_gpr_registers(struct gpr_choice *c)
{
    const struct gpr_expectation *row = c->row;
    for (unsigned to = 0; to < 16; to++) {
        for (unsigned from = 0; from < 16; from++) {
            if ((row->rm || row->mr) && !is(row->trait, "ADDRESS"))
                check_gpr_registers(c, to, from);
            if (has_immediate(row) && row->id != X86_mov && (from == 0 || is(row->trait, "TRIPLE")))
                check_gpr_register_immediate(c, to, from);
        }
        if (row->single) {
            encode_gpr_r(decoded_begin(), row->id, c->size, to);
            decoded_finish(row->mnemonic, 1);
            require_gpr(0, rm_bits(c), to);
            require_rex(c, to >= 8, false);
        }
    }
}

static void all_gpr_addresses(struct gpr_choice *c)
{
    if (c->row->rm)
        decoded_for_each_address(check_gpr_load, c);
    if (c->row->mr)
        decoded_for_each_address(check_gpr_store, c);
    if (c->row->single && !is(c->row->trait, "PLUS"))
        decoded_for_each_address(check_gpr_single_memory, c);
    if (has_immediate(c->row))
        decoded_for_each_address(check_gpr_memory_immediate, c);
}

static void gpr_rows_take_all_registers(void)
{
    for_each_gpr_row(all_gpr_registers);
}

static void gpr_rows_take_all_addresses(void)
{
    for_each_gpr_row(all_gpr_addresses);
}

/* The decoded mov sets all 64 bits of the register to the value, with the least number of bytes. */
static void check_constant(unsigned to, uint64_t value)
{
    decoded_finish("mov", 2);
    const ZydisDecodedOperand *source = &decoded_at.operands[1];
    bool zero_extends = value <= UINT32_MAX, sign_extends = (int64_t)value == (int32_t)value;
    decoded_require(source->type == ZYDIS_OPERAND_TYPE_IMMEDIATE, "kind of operand");
    require_gpr(0, zero_extends ? 32 : 64, to);
    decoded_require((zero_extends ? (uint32_t)source->imm.value.u : source->imm.value.u) == value,
                    "immediate");
    decoded_require(decoded_at.length == (zero_extends ? 5u + (to >= 8) : sign_extends ? 7u : 10u), "length");
}

static void constants_use_the_shortest_mov(void)
{
    static const uint64_t values[] = {0,
                                      1,
                                      0x7FFFFFFF,
                                      0x80000000,
                                      0xFFFFFFFF,
                                      0x100000000,
                                      0x123456789ABCDEF0,
                                      0xFFFFFFFF80000000,
                                      0xFFFFFFFF7FFFFFFF,
                                      UINT64_MAX,
                                      INT64_MAX,
                                      1ull << 63};
    decoded_at.row = "encode_gpr_constant";
    for (unsigned to = 0; to < 16; to++) {
        for (unsigned i = 0; i < sizeof values / sizeof *values; i++) {
            encode_gpr_constant(decoded_begin(), to, values[i]);
            check_constant(to, values[i]);
        }
        for (unsigned i = 0; i < IMMEDIATES; i++) {
            encode_gpr_ri(decoded_begin(), X86_mov, X86_64, to, immediates[i]);
            check_constant(to, (uint64_t)(int64_t)immediates[i]);
            encode_gpr_ri(decoded_begin(), X86_mov, X86_32, to, immediates[i]);
            check_constant(to, (uint32_t)immediates[i]);
        }
    }
}

int main(void)
{
    ZydisDecoderInit(&decoded_at.decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    UNITY_BEGIN();
    decoded_run(gpr_rows_take_all_registers, "gpr_rows_take_all_registers",
                "gpr_rows_take_all_registers_by_text", __LINE__);
    decoded_run(gpr_rows_take_all_addresses, "gpr_rows_take_all_addresses",
                "gpr_rows_take_all_addresses_by_text", __LINE__);
    decoded_run(constants_use_the_shortest_mov, "constants_use_the_shortest_mov",
                "constants_use_the_shortest_mov_by_text", __LINE__);
    return UNITY_END();
}
