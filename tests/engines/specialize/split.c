/* Values in several registers (passes/split.c), and routines of one lane. That results stay the same is
 * tested by sequence.c, placement.c, operation.c and equal.c; here is what the code consists of. */
#include "contract/engine.h"
#include "machine/disassemble.h"
#include "engines/specialize/specialize.h"
#include "tests/support/routine/routines.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>
#include <string.h>

static struct builder *builder;
static struct ir *ir;
static struct error error;

void setUp(void)
{
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    ir = &builder->ir;
    ir_start(ir);
}

void tearDown(void)
{
    specialize_give(builder);
}

static uint16_t append(enum ir_op op, enum ir_type type, uint16_t a, uint16_t b, int k)
{
    enum base base = op == IR_store ? BASE_OUTPUT : op == IR_uniform ? BASE_JOB : BASE_INPUT;
    return ir_append(
        ir, (struct ir_instruction){
                .op = (uint8_t)op, .type = (uint8_t)type, .base = (uint8_t)base, .operand = {a, b}, .k = k});
}

static unsigned split(unsigned lanes, unsigned parts)
{
    builder->pass.lanes = lanes;
    builder->pass.parts = parts;
    unsigned changed = pass_split(ir, &builder->pass);
    TEST_ASSERT_NULL(ir_verify(ir));
    return changed;
}

static unsigned count(enum ir_op op)
{
    unsigned found = 0;
    for (uint32_t n = 1; n < ir->count; n++)
        found += ir->instruction[n].op == op;
    return found;
}

static void test_values_that_are_equal_in_all_lanes_have_one_part(void)
{
    uint16_t word = append(IR_uniform, TYPE_flt, 0, 0, 0);
    uint16_t square = append(IR_mul_f, TYPE_flt, word, word, 0);
    uint16_t lanes = append(IR_load, TYPE_flt, 0, 0, 0);
    uint16_t sum = append(IR_add_f, TYPE_flt, lanes, square, 0);
    append(IR_store, TYPE_non, sum, 0, 0);
    TEST_ASSERT_GREATER_THAN(0, split(8, 2));
    TEST_ASSERT_EQUAL(2, ir->parts);
    TEST_ASSERT_EQUAL(1, count(IR_uniform));
    TEST_ASSERT_EQUAL(1, count(IR_mul_f));
    TEST_ASSERT_EQUAL(2, count(IR_load));
    TEST_ASSERT_EQUAL(2, count(IR_add_f));
    TEST_ASSERT_EQUAL(2, count(IR_store));
    TEST_ASSERT_EQUAL_INT32(32, ir->instruction[ir->count - 1].k);
    TEST_ASSERT_EQUAL_MESSAGE(0, split(8, 2), "a second time");
}

static void test_a_region_runs_if_a_lane_of_any_part_is_set(void)
{
    uint16_t word = append(IR_load, TYPE_itg, 0, 0, 0);
    uint16_t mask = append(IR_gt_i, TYPE_msk, word, word, 0);
    append(IR_when, TYPE_non, mask, 0, 0);
    append(IR_store, TYPE_non, mask, 0, 0);
    append(IR_end, TYPE_non, 0, 0, 0);
    split(4, 4);
    TEST_ASSERT_EQUAL(3, count(IR_or_m));
    TEST_ASSERT_EQUAL(1, count(IR_when));
    TEST_ASSERT_EQUAL(4, count(IR_store));
}

/* Part l of the permutation is the part of its operand that lane l takes. */
static void test_neighbours_of_one_lane_are_the_other_parts(void)
{
    enum { SWAPPED = 1 | 0 << 2 | 3 << 4 | 2 << 6 };
    uint16_t lanes = append(IR_load, TYPE_flt, 0, 0, 0);
    uint16_t other = append(IR_permute, TYPE_flt, lanes, 0, SWAPPED);
    append(IR_store, TYPE_non, other, 0, 0);
    split(1, 1);
    TEST_ASSERT_EQUAL(4, ir->parts);
    TEST_ASSERT_EQUAL(0, count(IR_permute));
    for (uint32_t lane = 0; lane < 4; lane++) {
        const struct ir_instruction *store = &ir->instruction[ir->count - 4 + lane];
        TEST_ASSERT_EQUAL_INT32(4 * lane, store->k);
        TEST_ASSERT_EQUAL_INT32(4 * (lane ^ 1), ir->instruction[store->operand[0]].k);
    }
}

static void make_long(unsigned length)
{
    uint16_t value = append(IR_load, TYPE_flt, 0, 0, 0);
    for (unsigned n = 0; n < length; n++)
        value = append(IR_add_f, TYPE_flt, value, value, 0);
    append(IR_store, TYPE_non, value, 0, 0);
}

static void test_long_programs_have_fewer_parts(void)
{
    static const struct {
        unsigned length, parts;
    } expected[] = {{16000, 4}, {16400, 2}, {32700, 2}, {33000, 1}};
    for (unsigned n = 0; n < sizeof expected / sizeof *expected; n++) {
        ir_start(ir);
        make_long(expected[n].length);
        uint32_t before = ir->count;
        split(4, 4);
        TEST_ASSERT_EQUAL(expected[n].parts, ir->parts);
        TEST_ASSERT_EQUAL_UINT32((before - 1) * expected[n].parts + 1, ir->count);
        TEST_ASSERT_FALSE(ir->overflow);
    }
}

/* --- Two blocks ---------------------------------------------------------------------------------------- */

static uint16_t append_color(enum ir_op op, uint16_t value)
{
    return ir_append(
        ir, (struct ir_instruction){
                .op = (uint8_t)op, .type = TYPE_flt, .base = BASE_COLOR, .operand = {value}, .k = 0});
}

/* A colour, to which `length` values are added, one after the other. */
static void make_blending(unsigned length)
{
    uint16_t value = append_color(IR_load, 0);
    for (unsigned n = 0; n < length; n++)
        value = append(IR_add_f, TYPE_flt, value, value, 0);
    append_color(IR_store, value);
}

static void test_the_second_block_has_bases_of_its_own(void)
{
    uint16_t x = append(IR_uniform, TYPE_flt, 0, 0, 0);
    ir->instruction[x].base = BASE_ENTRY;
    append_color(IR_store, append(IR_add_f, TYPE_flt, append_color(IR_load, 0), x, 0));
    split(8, 4);
    TEST_ASSERT_EQUAL(2, count(IR_uniform));
    TEST_ASSERT_EQUAL(4, count(IR_add_f));
    unsigned found = 0;
    for (uint32_t n = 1; n < ir->count; n++) {
        const struct ir_instruction *store = &ir->instruction[n];
        if (store->op != IR_store)
            continue;
        const struct ir_instruction *sum = &ir->instruction[store->operand[0]];
        bool next = found >= 2;
        TEST_ASSERT_EQUAL_INT32(found++ % 2 * 32, store->k);
        TEST_ASSERT_EQUAL(next ? BASE_NEXT_COLOR : BASE_COLOR, store->base);
        TEST_ASSERT_EQUAL(next ? BASE_NEXT_COLOR : BASE_COLOR, ir->instruction[sum->operand[0]].base);
        TEST_ASSERT_EQUAL(next ? BASE_NEXT_ENTRY : BASE_ENTRY, ir->instruction[sum->operand[1]].base);
    }
    TEST_ASSERT_EQUAL(4, found);
}

/* A block that is computed twice reads its colours before the first of both results is stored. */
static void test_reads_of_both_blocks_precede_their_writes(void)
{
    make_blending(20);
    split(8, 4);
    uint32_t last_load = 0, first_store = 0;
    for (uint32_t n = 1; n < ir->count; n++) {
        last_load = ir->instruction[n].op == IR_load ? n : last_load;
        first_store = ir->instruction[n].op == IR_store && !first_store ? n : first_store;
    }
    TEST_ASSERT_EQUAL(4, count(IR_load));
    TEST_ASSERT_LESS_THAN_UINT32(first_store, last_load);
}

static bool is_of_next_block(uint32_t number)
{
    while (ir->instruction[number].op != IR_load)
        number = ir->instruction[number].operand[0];
    return ir->instruction[number].base == BASE_NEXT_COLOR;
}

/* Returns how often an addition is not of the same block as the one before it. */
static unsigned count_changes_of_block(void)
{
    unsigned changes = 0;
    bool next = false;
    for (uint32_t n = 1; n < ir->count; n++)
        if (ir->instruction[n].op == IR_add_f && is_of_next_block(n) != next) {
            next = !next;
            changes++;
        }
    return changes;
}

static void test_blocks_take_turns_by_groups_of_operations(void)
{
    make_blending(30);
    split(8, 4);
    TEST_ASSERT_EQUAL(1, count_changes_of_block());
    ir_start(ir);
    make_blending(400);
    split(8, 4);
    TEST_ASSERT_EQUAL(1600, count(IR_add_f));
    TEST_ASSERT_UINT_WITHIN(2, 19, count_changes_of_block()); /* ten groups, in both blocks */
}

/* Eight products and their sum, again and again: after each sum one value is alive. */
static void test_groups_end_where_few_values_are_alive(void)
{
    enum { SUMS = 6, FACTORS = 8 };
    uint16_t sum = append_color(IR_load, 0), product[FACTORS];
    for (unsigned n = 0; n < SUMS; n++) {
        uint16_t factor = sum;
        for (unsigned i = 0; i < FACTORS; i++)
            product[i] = append(IR_mul_f, TYPE_flt, factor, factor, 0);
        for (unsigned i = 0; i < FACTORS; i++)
            sum = append(IR_add_f, TYPE_flt, sum, product[i], 0);
    }
    append_color(IR_store, sum);
    split(8, 4);
    for (uint32_t n = 2; n < ir->count; n++)
        if (ir->instruction[n].op != IR_store && is_of_next_block(n - 1) && !is_of_next_block(n))
            TEST_ASSERT_EQUAL(IR_mul_f, ir->instruction[n].op);
}

static void test_programs_that_two_blocks_exclude(void)
{
    make_blending(10);
    TEST_ASSERT_TRUE(pass_may_pair(ir));
    append(IR_window, TYPE_non, 0, 0, 0);
    TEST_ASSERT_FALSE(pass_may_pair(ir));
    ir_start(ir);
    append_color(IR_store, append_color(IR_load, 0));
    ir->instruction[2].base = BASE_LANES; /* the number of pixels */
    TEST_ASSERT_FALSE(pass_may_pair(ir));
    split(8, 4);
    TEST_ASSERT_EQUAL(2, ir->parts);
}

/* --- Long programs ------------------------------------------------------------------------------------- */

/* With fewer than four parts there are no neighbours. */
static void test_a_long_program_of_one_lane_with_neighbours_is_refused(void)
{
    uint16_t lanes = append(IR_load, TYPE_flt, 0, 0, 0);
    append(IR_store, TYPE_non, append(IR_permute, TYPE_flt, lanes, 0, 0), 0, 64);
    make_long(16400);
    TEST_ASSERT_EQUAL(0, split(1, 1));
    TEST_ASSERT_TRUE(ir->overflow);
}

/* --- The code of one lane ------------------------------------------------------------------------------ */

static unsigned scalar_instructions, quads;

/* Copies, bits, selections and tests are of whole registers in every number of lanes, and there is no
 * conversion of one number to binary16. */
static bool is_packed_arithmetic(const char *text)
{
    static const char *const packed[] = {"vadd", "vsub", "vmul", "vdiv", "vmin",   "vmax", "vsqrt",
                                         "vcmp", "vfm",  "vfnm", "vrcp", "vround", "vcvt", "vperm"};
    const char *end = strchr(text, ' ');
    size_t length = end ? (size_t)(end - text) : strlen(text);
    if (length < 2 || strncmp(text + length - 2, "ps", 2))
        return length > 5 && !strncmp(text + length - 5, "ps2dq", 5);
    for (unsigned n = 0; n < sizeof packed / sizeof *packed; n++)
        if (!strncmp(text, packed[n], strlen(packed[n])))
            return strncmp(text, "vcvtph2ps", length) != 0;
    return false;
}

static void expect_one_lane(void *context, size_t offset, size_t length, const char *text)
{
    (void)context, (void)offset, (void)length;
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "ymm"), text);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "gather"), text);
    TEST_ASSERT_FALSE_MESSAGE(is_packed_arithmetic(text), text);
    scalar_instructions += strstr(text, "ss ") != NULL;
}

static void check_routine(void *context, enum unit unit, const union key *key)
{
    const struct build_options options = specialize_options(&engine_specialize_1, unit);
    (void)context;
    TEST_ASSERT_MESSAGE(specialize_code(builder, &options, unit, key, NULL, NULL, &error), error.text);
    TEST_ASSERT_TRUE(ir->parts == 1 || (ir->parts == 4 && unit == UNIT_PIXEL));
    quads += ir->parts == 4;
    disassemble(builder->emitter.code, builder->emitter.code_bytes, 0, expect_one_lane, NULL);
}

static void test_code_of_one_lane_has_no_packed_arithmetic(void)
{
    visit_random_keys(300, test_seed(), check_routine, NULL);
    visit_shaders(test_seed(), check_routine, NULL);
    TEST_ASSERT_GREATER_THAN(test_share(10000), scalar_instructions);
    TEST_ASSERT_GREATER_OR_EQUAL(test_share(6), quads);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_values_that_are_equal_in_all_lanes_have_one_part);
    RUN_TEST(test_a_region_runs_if_a_lane_of_any_part_is_set);
    RUN_TEST(test_neighbours_of_one_lane_are_the_other_parts);
    RUN_TEST(test_the_second_block_has_bases_of_its_own);
    RUN_TEST(test_reads_of_both_blocks_precede_their_writes);
    RUN_TEST(test_blocks_take_turns_by_groups_of_operations);
    RUN_TEST(test_groups_end_where_few_values_are_alive);
    RUN_TEST(test_programs_that_two_blocks_exclude);
    RUN_TEST(test_long_programs_have_fewer_parts);
    RUN_TEST(test_a_long_program_of_one_lane_with_neighbours_is_refused);
    RUN_TEST(test_code_of_one_lane_has_no_packed_arithmetic);
    return UNITY_END();
}
