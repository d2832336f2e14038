/* The holes that the joiner fills, checked by an independent disassembler. A fragment joined with random
 * arguments has the same instructions as with none, and differs only as its descriptor specifies:
 * registers by role, displacements, immediates, the distance of a jump, the addresses of constants and
 * literals. */
#include "machine/code.h"
#include "engines/stitch/plan.h"
#include "engines/stitch/stitch.h"
#include "tests/support/system/seed.h"

#include <Zydis/Zydis.h>
#include <stdio.h>
#include <string.h>
#include <unity.h>

enum { ROUNDS = 60, ROOM = 4096, GENERAL = 16, TAIL = 3 };

static struct code_arena *arena;
static struct plan *plan;
static uint64_t seed;
static ZydisDecoder decoder;

/* A fragment joined with arguments: its bytes, and the offsets of the parts after it. */
struct joined {
    union arguments arguments;
    uint8_t code[ROOM];
    uint32_t behind[TAIL], literals;
};

/* One of its instructions. */
struct decoded {
    ZydisDecodedInstruction instruction;
    ZydisDecodedOperand operand[ZYDIS_MAX_OPERAND_COUNT];
};

static uint32_t random_word(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)(seed * 0x2545f4914f6cdd1dull >> 32);
}

/* --- Joining ----------------------------------------------------------------------------------------- */

/* Any number, unless only a few are valid: a base is r8 to r14 without r12, whose encoding is longer, and
 * a gather's base includes its scale. */
static int32_t random_argument(const struct fragment *f, int n)
{
    static const uint8_t bases[] = {0, 1, 2, 3, 5, 6};
    for (unsigned h = 0; h < f->holes; h++) {
        const struct hole *hole = &f->hole[h];
        if (hole->kind == HOLE_JUMP && hole->argument == n)
            return 1 + (int32_t)(random_word() % TAIL);
        if (hole->kind == HOLE_BYTE && hole->argument == n) {
            int sib = f->apart && (f->code[hole->offset - 1] & 7) == 4;
            return bases[random_word() % sizeof bases] + (sib ? (int32_t)(random_word() % 4) * 64 : 0);
        }
    }
    return n == ARGUMENT_BASE && f->based ? (int32_t)(random_word() % 16) : (int32_t)random_word();
}

/* Vector registers are different, because a gather with equal registers is not a valid instruction. The
 * last is reserved for fragments. */
static union arguments random_arguments(const struct fragment *f)
{
    union arguments result;
    unsigned next = random_word() % 15;
    for (int n = 0; n < ARGUMENT_COUNT; n++)
        if ((f->given | f->read) >> n & 1)
            result.value[n] = (int32_t)(next = (next + 1 + random_word() % 3) % 15);
        else
            result.value[n] = random_argument(f, n);
    return result;
}

/* Zero words leave the assembler's output unchanged, and so do these registers. */
static union arguments no_arguments(const struct fragment *f)
{
    union arguments none = {{0}};
    for (int n = 0; n < ARGUMENT_COUNT; n++)
        if ((f->given | f->read) >> n & 1)
            none.value[n] = n;
    for (unsigned h = 0; h < f->holes; h++)
        if (f->hole[h].kind == HOLE_JUMP)
            none.value[f->hole[h].argument] = 1;
    if (f->based)
        none.value[ARGUMENT_BASE] = REGISTER_FRAME;
    return none;
}

/* The fragment is followed by parts of different lengths as targets of jumps, and by a literal. */
static void join(const struct fragment *f, struct joined *joined)
{
    static const uint8_t filler[32] = {0x90, 0x90, 0x90, 0x90, 0x90};
    static const struct fragment tail[TAIL] = {{.name = "a", .code = filler, .bytes = 1},
                                               {.name = "b", .code = filler, .bytes = 5},
                                               {.name = "c", .code = filler, .bytes = 2}};
    struct code_span span;
    struct error error = {{0}};
    plan_enter(plan);
    plan->count = 0;
    plan->literals = 1;
    plan_append(plan, f, joined->arguments);
    for (int t = 0; t < TAIL; t++)
        plan_append(plan, &tail[t], (union arguments){{0}});
    TEST_ASSERT_EQUAL_MESSAGE(0, plan_join(plan, arena, &span, &error), error.text);
    TEST_ASSERT_LESS_THAN_MESSAGE(ROOM, f->bytes, f->name);
    memcpy(joined->code, span.executable, f->bytes);
    for (int t = 0; t < TAIL; t++)
        joined->behind[t] = plan->part[1 + t].offset;
    joined->literals = plan->literals_offset;
    code_free(arena, &span);
}

/* --- Expected differences ---------------------------------------------------------------------------- */

struct check {
    const struct fragment *fragment;
    const struct joined *before, *joined;
    uint32_t at; /* of the instruction in the fragment */
    struct decoded plain, filled;
};

static void fail(const struct check *c, const char *what)
{
    char text[200];
    snprintf(text, sizeof text, "%s, instruction at %u: wrong %s", c->fragment->name, (unsigned)c->at, what);
    TEST_FAIL_MESSAGE(text);
}

static void require(const struct check *c, int good, const char *what)
{
    if (!good)
        fail(c, what);
}

static int register_number(ZydisRegister r)
{
    return r == ZYDIS_REGISTER_NONE ? -1 : ZydisRegisterGetId(r);
}

/* The hole of a kind in this instruction, or null. `bytes` is the distance from the hole to the end of the
 * instruction. */
static const struct hole *find_hole(const struct check *c, enum hole_kind kind, unsigned from, unsigned to)
{
    for (unsigned h = 0; h < c->fragment->holes; h++) {
        const struct hole *hole = &c->fragment->hole[h];
        if (hole->kind == kind && hole->offset >= c->at + from && hole->offset < c->at + to)
            return hole;
    }
    return NULL;
}

static int32_t argument(const struct check *c, unsigned n)
{
    return c->joined->arguments.value[n];
}

/* The changed bits of an argument's number. */
static int32_t change(const struct check *c, unsigned n)
{
    return c->before->arguments.value[n] ^ c->joined->arguments.value[n];
}

/* The bits that are flipped in the register of an operand. */
static int32_t flipped(const struct check *c, ZydisOperandEncoding encoding)
{
    const struct hole *vector = find_hole(c, HOLE_VECTOR, 0, c->plain.instruction.length);
    const struct hole *mask = find_hole(c, HOLE_MASK, 0, c->plain.instruction.length);
    unsigned roles = vector ? vector->argument : 0xff;
    switch (encoding) {
    case ZYDIS_OPERAND_ENCODING_MODRM_REG: return (roles & 3) == 3 ? 0 : change(c, roles & 3);
    case ZYDIS_OPERAND_ENCODING_NDSNDD: return (roles >> 2 & 7) > 3 ? 0 : change(c, roles >> 2 & 7);
    case ZYDIS_OPERAND_ENCODING_MODRM_RM: return roles >> 5 > 3 ? 0 : change(c, roles >> 5);
    case ZYDIS_OPERAND_ENCODING_IS4: return mask ? change(c, mask->argument) : 0;
    default: return 0;
    }
}

/* A byte hole in ModRM or SIB adds to the number of a base register. */
static int32_t added_to_base(const struct check *c)
{
    const ZydisDecodedInstruction *i = &c->plain.instruction;
    const struct hole *hole = i->raw.sib.offset
                                  ? find_hole(c, HOLE_BYTE, i->raw.sib.offset, i->raw.sib.offset + 1u)
                                  : find_hole(c, HOLE_BYTE, i->raw.modrm.offset, i->raw.modrm.offset + 1u);
    return hole && i->raw.modrm.offset ? argument(c, hole->argument) : 0;
}

static void check_register(const struct check *c, const ZydisDecodedOperand *plain,
                           const ZydisDecodedOperand *filled)
{
    int vector = ZydisRegisterGetClass(plain->reg.value) == ZYDIS_REGCLASS_YMM ||
                 ZydisRegisterGetClass(plain->reg.value) == ZYDIS_REGCLASS_XMM;
    int expected = register_number(plain->reg.value);
    if (vector)
        expected ^= flipped(c, plain->encoding);
    require(c, ZydisRegisterGetClass(plain->reg.value) == ZydisRegisterGetClass(filled->reg.value),
            "class of register");
    require(c, register_number(filled->reg.value) == expected, "register");
}

static int32_t expected_displacement(const struct check *c, const ZydisDecodedOperand *plain)
{
    const ZydisDecodedInstruction *i = &c->plain.instruction;
    const struct hole *word = find_hole(c, HOLE_WORD, i->raw.disp.offset, i->raw.disp.offset + 1u);
    const struct hole *address = find_hole(c, HOLE_ADDRESS, i->raw.disp.offset, i->raw.disp.offset + 1u);
    const struct hole *literals = find_hole(c, HOLE_LITERALS, i->raw.disp.offset, i->raw.disp.offset + 1u);
    if (literals)
        return (int32_t)(c->joined->literals - (c->at + i->raw.disp.offset + 4u));
    if (address)
        return argument(c, address->argument);
    return (int32_t)((uint32_t)plain->mem.disp.value + (word ? (uint32_t)argument(c, word->argument) : 0));
}

static void check_memory(const struct check *c, const ZydisDecodedOperand *plain,
                         const ZydisDecodedOperand *filled)
{
    const struct hole *index = find_hole(c, HOLE_INDEX, 0, c->plain.instruction.length);
    const struct hole *address = find_hole(c, HOLE_ADDRESS, 0, c->plain.instruction.length);
    int base = register_number(plain->mem.base) + (added_to_base(c) & 7);
    int scale = plain->mem.scale << (added_to_base(c) >> 6);
    int indexed = register_number(plain->mem.index);
    if (address)
        base = argument(c, ARGUMENT_BASE);
    if (index)
        indexed ^= change(c, index->argument);
    require(c,
            plain->mem.base == ZYDIS_REGISTER_RIP ? filled->mem.base == ZYDIS_REGISTER_RIP
                                                  : register_number(filled->mem.base) == base,
            "base");
    require(c, register_number(filled->mem.index) == indexed && filled->mem.scale == scale, "index");
    require(c, (int32_t)filled->mem.disp.value == expected_displacement(c, plain), "displacement");
}

static void check_immediate(const struct check *c, const ZydisDecodedOperand *plain,
                            const ZydisDecodedOperand *filled, unsigned n)
{
    const ZydisDecodedInstruction *i = &c->plain.instruction;
    unsigned offset = i->raw.imm[n].offset;
    const struct hole *word = find_hole(c, HOLE_WORD, offset, offset + 1u),
                      *byte = find_hole(c, HOLE_BYTE, offset, offset + 1u),
                      *jump = find_hole(c, HOLE_JUMP, offset, offset + 1u),
                      *constants = find_hole(c, HOLE_CONSTANTS, offset, offset + 1u);
    uint64_t expected = plain->imm.value.u, mask = i->raw.imm[n].size == 8 ? 0xff : 0xffffffff;
    if (word || byte)
        expected += (uint32_t)argument(c, (word ? word : byte)->argument);
    if (jump)
        expected = c->joined->behind[argument(c, jump->argument) - 1] - (c->at + i->length);
    if (constants) {
        mask = UINT64_MAX;
        expected = (uint64_t)(uintptr_t)stitch_constants;
    }
    require(c, ((filled->imm.value.u ^ expected) & mask) == 0, "immediate");
}

static void check_instruction(const struct check *c)
{
    const ZydisDecodedInstruction *plain = &c->plain.instruction, *filled = &c->filled.instruction;
    unsigned immediates = 0;
    require(c, plain->mnemonic == filled->mnemonic && plain->length == filled->length, "instruction");
    require(c, plain->operand_count_visible == filled->operand_count_visible, "number of operands");
    for (unsigned n = 0; n < plain->operand_count_visible; n++) {
        const ZydisDecodedOperand *p = &c->plain.operand[n], *f = &c->filled.operand[n];
        require(c, p->type == f->type && p->size == f->size && p->actions == f->actions, "operand");
        if (p->type == ZYDIS_OPERAND_TYPE_REGISTER)
            check_register(c, p, f);
        else if (p->type == ZYDIS_OPERAND_TYPE_MEMORY)
            check_memory(c, p, f);
        else
            check_immediate(c, p, f, immediates++);
    }
}

/* Every hole is in a field that holes of its kind fill. */
static void check_fragment(const struct fragment *f, const struct joined *plain, const struct joined *filled)
{
    struct check c = {.fragment = f, .before = plain, .joined = filled};
    for (c.at = 0; c.at < f->bytes; c.at += c.plain.instruction.length) {
        require(&c,
                ZYAN_SUCCESS(ZydisDecoderDecodeFull(&decoder, plain->code + c.at, f->bytes - c.at,
                                                    &c.plain.instruction, c.plain.operand)),
                "encoding before");
        require(&c,
                ZYAN_SUCCESS(ZydisDecoderDecodeFull(&decoder, filled->code + c.at, f->bytes - c.at,
                                                    &c.filled.instruction, c.filled.operand)),
                "encoding");
        check_instruction(&c);
    }
    TEST_ASSERT_EQUAL_MESSAGE(f->bytes, c.at, f->name);
}

static void filled_holes_match_the_descriptor(void)
{
    static struct joined plain, filled;
    for (const struct fragment *f = __start_stitch_fragments; f < __stop_stitch_fragments; f++) {
        plain.arguments = no_arguments(f);
        join(f, &plain);
        for (int round = 0; round < (f->holes ? ROUNDS : 1); round++) {
            filled.arguments = random_arguments(f);
            join(f, &filled);
            check_fragment(f, &plain, &filled);
        }
    }
}

/* A fragment of one plain instruction is filled in registers, others in memory. All numbers of its three
 * registers are tested. */
static void all_registers_of_an_instruction(void)
{
    static struct joined plain, filled;
    const struct fragment *some[] = {&fragment_add_f, &fragment_select_f, &fragment_mad_f, &fragment_sqrt_f};
    for (unsigned i = 0; i < sizeof some / sizeof *some; i++) {
        plain.arguments = no_arguments(some[i]);
        join(some[i], &plain);
        for (int registers = 0; registers < 16 * 16 * 16; registers++) {
            filled.arguments = (union arguments){{registers & 15, registers >> 4 & 15, registers >> 8}};
            join(some[i], &filled);
            check_fragment(some[i], &plain, &filled);
        }
    }
}

void setUp(void)
{
    struct error error = {{0}};
    ZydisDecoderInit(&decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    arena = code_create(1 << 20, NULL, &error);
    plan = plan_take(&error);
    TEST_ASSERT_TRUE_MESSAGE(arena && plan, error.text);
    seed = test_seed();
}

void tearDown(void)
{
    plan_give(plan);
    code_destroy(arena);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(filled_holes_match_the_descriptor);
    RUN_TEST(all_registers_of_an_instruction);
    return UNITY_END();
}
