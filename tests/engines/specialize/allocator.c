/* The allocators of def/engine/allocator.def: for random keys, all shaders and all streams, the code reads
 * the right values at every number of lanes (tests/support/routine/placement.h). This needs no processor that
 * can run the code. placement.c runs code of all allocators with few registers. */
#include "engines/specialize/specialize.h"
#include "tests/support/routine/placement.h"
#include "tests/support/routine/routines.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <Zydis/Zydis.h>
#include <stdio.h>
#include <string.h>

static struct builder *builder;
static struct build_options options;
static unsigned visited;
static char message[KEY_TEXT_CAPACITY + 1000];

void setUp(void)
{
    struct error error = {{0}};
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    visited = 0;
}

void tearDown(void)
{
    specialize_give(builder);
}

/* With 16 lanes, the stack frame has no room for the homes of all values of the longest recordings. */
static bool is_too_large(void)
{
    return options.allocator == ALLOCATOR_none && builder->allocation.slots > emit_most_slots(options.width);
}

static void build(enum unit unit, const union key *key)
{
    struct error error = {{0}};
    char text[KEY_TEXT_CAPACITY];
    const char *wrong = error.text;
    if (specialize_code(builder, &options, unit, key, NULL, NULL, &error))
        wrong = placement_check(builder);
    else if (is_too_large())
        return;
    snprintf(message, sizeof message, "allocator %s, %u lanes, %s key: %s: %s",
             allocate_name(options.allocator), options.width, unit_name[unit], key_print(unit, key, text),
             wrong ? wrong : "");
    TEST_ASSERT_NULL_MESSAGE(wrong, message);
}

/* Each routine with one number of lanes and one profile, which change from routine to routine. */
static void check_routine(void *context, enum unit unit, const union key *key)
{
    static const uint8_t widths[] = {1, 4, 8, 16};
    static const enum profile profiles[] = {PROFILE_NONE, PROFILE_FULL, PROFILE_THESIS};
    static unsigned number;
    (void)context;
    if (number++ % test_step(2, 3))
        return;
    options.width = widths[visited % 4];
    options.parts = options.width < 16 && visited % 5 == 0 ? 2 : 1;
    options.profile = profiles[visited / 4 % 3];
    build(unit, key);
    visited++;
}

static void the_code_of_every_allocator_reads_the_right_values(void)
{
    for (unsigned i = 0; allocate_name(i); i++) {
        visited = 0;
        options = (struct build_options){.allocator = (enum allocator)i};
        visit_random_keys(test_share_of(300, 9), test_seed(), check_routine, NULL);
        visit_shaders(test_seed(), check_routine, NULL);
        visit_streams(check_routine, NULL);
        TEST_ASSERT_GREATER_THAN(test_share_of(300, 9) / 3, visited);
    }
}

/* --- What is evicted ------------------------------------------------------------------------------------ */

static uint16_t append(enum ir_op op, int32_t k, unsigned a, unsigned b, unsigned c)
{
    return ir_append(&builder->ir,
                     (struct ir_instruction){.op = (uint8_t)op,
                                             .type = TYPE_flt,
                                             .base = BASE_LANES,
                                             .k = k,
                                             .operand = {(uint16_t)a, (uint16_t)b, (uint16_t)c}});
}

/* Eight sums. In each round, each gets a value of its own that is alive as long as the program. */
static void append_sums(unsigned rounds)
{
    enum { SUMS = 8 };
    uint16_t sum[SUMS], step[SUMS];
    ir_start(&builder->ir);
    uint16_t factor = append(IR_load, 0, 0, 0, 0);
    for (unsigned i = 0; i < SUMS; i++)
        sum[i] = step[i] = append(IR_sqrt_f, 0, append(IR_load, 64 * (int32_t)i, 0, 0, 0), 0, 0);
    for (unsigned round = 0; round < rounds; round++)
        for (unsigned i = 0; i < SUMS; i++)
            sum[i] = append(IR_mad_f, 0, sum[i], factor, step[i]);
    for (unsigned i = 0; i < SUMS; i++)
        append(IR_store, 64 * (int32_t)i, sum[i], 0, 0);
}

/* 17 values are alive together. The four that have no register are evicted once, and not one or two sums in
 * each round: these would wait for a store and a load. */
static void the_rest_of_a_life_is_worth_more_than_the_next_use(void)
{
    const struct register_file file = allocate_register_file(ALLOCATABLE, 8);
    append_sums(20);
    allocate_registers(&builder->ir, &builder->allocation, &file);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(6, builder->allocation.spills);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(3, builder->allocation.spills);
}

/* A value with many uses is evicted after all of them but one. */
static void uses_that_are_over_do_not_count(void)
{
    enum { USES = 40, OTHERS = 14, ROUNDS = 3 };
    const struct register_file file = allocate_register_file(ALLOCATABLE, 8);
    uint16_t other[OTHERS];
    ir_start(&builder->ir);
    uint16_t value = append(IR_sqrt_f, 0, append(IR_load, 0, 0, 0, 0), 0, 0), sum = value;
    for (unsigned i = 0; i < USES; i++)
        sum = append(IR_mul_f, 0, sum, value, 0);
    append(IR_store, 0, sum, 0, 0);
    for (unsigned i = 0; i < OTHERS; i++)
        other[i] = append(IR_sqrt_f, 0, append(IR_load, 64 * (int32_t)i, 0, 0, 0), 0, 0);
    sum = other[0];
    for (unsigned i = 0; i < ROUNDS * OTHERS; i++)
        sum = append(IR_mul_f, 0, sum, other[i % OTHERS], 0);
    append(IR_store, 0, append(IR_mul_f, 0, sum, value, 0), 0, 0);
    allocate_registers(&builder->ir, &builder->allocation, &file);
    TEST_ASSERT_NOT_EQUAL(NEVER, builder->allocation.split[value]);
}

/* --- Without allocation --------------------------------------------------------------------------------- */

/* The vector and mask registers that the code names, a bit each. */
static uint64_t registers_in_code(void)
{
    ZydisDecoder decoder;
    ZydisDecodedInstruction decoded;
    ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
    uint64_t named = 0;
    ZydisDecoderInit(&decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    for (size_t at = 0; at < builder->emitter.code_bytes; at += decoded.length) {
        TEST_ASSERT_TRUE(ZYAN_SUCCESS(ZydisDecoderDecodeFull(
            &decoder, builder->emitter.code + at, builder->emitter.code_bytes - at, &decoded, operands)));
        for (unsigned o = 0; o < decoded.operand_count_visible; o++) {
            if (operands[o].type != ZYDIS_OPERAND_TYPE_REGISTER)
                continue;
            ZydisRegister reg = operands[o].reg.value;
            ZydisRegisterClass class = ZydisRegisterGetClass(reg);
            unsigned number = (unsigned)ZydisRegisterGetId(reg);
            if (class == ZYDIS_REGCLASS_XMM || class == ZYDIS_REGCLASS_YMM || class == ZYDIS_REGCLASS_ZMM)
                named |= 1ull << number;
            else if (class == ZYDIS_REGCLASS_MASK)
                named |= 1ull << (MASKS + number);
        }
    }
    return named;
}

static unsigned values_without_memory(void)
{
    unsigned count = 0;
    for (uint32_t n = 1; n < builder->ir.count; n++) {
        const struct ir_instruction *i = &builder->ir.instruction[n];
        count += allocate_defines_value(i) && !allocate_is_constant(i);
    }
    return count;
}

static void check_homes(void *context, enum unit unit, const union key *key)
{
    static const uint8_t widths[] = {1, 4, 8, 16};
    const uint64_t scratch = 1ull << SCRATCH_RESULT | 1ull << SCRATCH_FIRST | 1ull << SCRATCH_SECOND |
                             1ull << MASK_RESULT | 1ull << MASK_SCRATCH;
    (void)context;
    options.width = widths[visited++ % 4];
    build(unit, key);
    if (is_too_large())
        return;
    TEST_ASSERT_EQUAL_HEX64(0, registers_in_code() & ~scratch);
    TEST_ASSERT_EQUAL(values_without_memory(), builder->allocation.slots);
    TEST_ASSERT_EQUAL(values_without_memory(), builder->allocation.spills);
}

static void without_allocation_code_uses_only_scratch_registers(void)
{
    options = (struct build_options){.allocator = ALLOCATOR_none, .profile = PROFILE_NONE};
    visit_random_keys(test_share_of(200, 9), test_seed(), check_homes, NULL);
    visit_shaders(test_seed(), check_homes, NULL);
}

static void the_engine_without_allocation_runs_no_pass(void)
{
    const struct build_options *simple = engine_specialize_simple.options;
    TEST_ASSERT_EQUAL(ALLOCATOR_none, simple->allocator);
    TEST_ASSERT_EQUAL_HEX32(1u << PASS_split,
                            pass_select(simple->profile, simple->enabled, simple->disabled));
}

int main(void)
{
    visit_fewer();
    UNITY_BEGIN();
    RUN_TEST(the_code_of_every_allocator_reads_the_right_values);
    RUN_TEST(the_rest_of_a_life_is_worth_more_than_the_next_use);
    RUN_TEST(uses_that_are_over_do_not_count);
    RUN_TEST(without_allocation_code_uses_only_scratch_registers);
    RUN_TEST(the_engine_without_allocation_runs_no_pass);
    return UNITY_END();
}
