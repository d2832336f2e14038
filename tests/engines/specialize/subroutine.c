/* Which samplings become subroutines, and what their programs are (passes/subroutine.h). That results stay
 * the same is tested by equal.c, that calls keep the values of their callers by placement.c. */
#include "engines/specialize/specialize.h"
#include "engines/specialize/build.h"
#include "tests/support/routine/routines.h"
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
    bool memory = ir_op_information[op].properties & (IR_READS | IR_WRITES);
    return ir_append(ir, (struct ir_instruction){.op = (uint8_t)op,
                                                 .type = (uint8_t)type,
                                                 .base = memory ? (uint8_t)base : 0,
                                                 .operand = {a, b},
                                                 .k = k});
}

static uint16_t input(int offset)
{
    return append(IR_load, TYPE_flt, 0, 0, offset);
}

static void store(uint16_t value)
{
    append(IR_store, TYPE_non, value, 0, 0);
}

/* Reads two words of the job, `job` bytes from its start. */
static uint16_t sample(uint16_t x, uint16_t y, int job)
{
    ir_note_sampling(ir, true);
    uint16_t width = append(IR_uniform, TYPE_flt, 0, 0, job),
             height = append(IR_uniform, TYPE_flt, 0, 0, job + 4);
    uint16_t u = append(IR_mul_f, TYPE_flt, x, width, 0), v = append(IR_mul_f, TYPE_flt, y, height, 0);
    uint16_t sum = append(IR_add_f, TYPE_flt, u, v, 0);
    ir_note_sampling(ir, false);
    return sum;
}

static unsigned count(const struct ir *in, enum ir_op op)
{
    unsigned found = 0;
    for (uint32_t n = 1; n < in->count; n++)
        found += in->instruction[n].op == op;
    return found;
}

static uint32_t find(enum calls calls, bool fixed)
{
    uint32_t found = pass_find_subroutines(ir, &builder->subroutines, calls, fixed);
    const char *wrong = ir_verify(ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
    for (uint32_t n = 0; n < found; n++) {
        pass_take_subroutine(&builder->subroutines, n);
        wrong = ir_verify(&builder->subroutines.body);
        TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
    }
    return found;
}

static const struct ir_instruction *call(unsigned number)
{
    uint32_t n = 0;
    for (unsigned calls = 0; calls <= number; calls += ir->instruction[n].op == IR_call)
        TEST_ASSERT_LESS_THAN(ir->count, ++n);
    return &ir->instruction[n];
}

static void test_equal_samplings_are_one_subroutine(void)
{
    uint16_t a = input(0), b = input(32);
    store(sample(a, b, 64));
    store(sample(b, a, 64));
    store(sample(a, a, 64));
    TEST_ASSERT_EQUAL(2, find(CALLS_SAMPLING, false)); /* the last has one input */
    TEST_ASSERT_EQUAL(3, count(ir, IR_call));
    TEST_ASSERT_EQUAL(0, call(1)->k);
    TEST_ASSERT_EQUAL(1, call(2)->k);
    TEST_ASSERT_EQUAL(5, count(ir, IR_put));
    TEST_ASSERT_EQUAL(3, count(ir, IR_take));
    TEST_ASSERT_EQUAL(0, count(ir, IR_uniform));
    TEST_ASSERT_EQUAL(1, count(&builder->subroutines.body, IR_take));
}

static void test_samplings_of_other_textures_move_the_job(void)
{
    uint16_t a = input(0), b = input(32);
    store(sample(a, b, 64));
    store(sample(a, b, 160));
    TEST_ASSERT_EQUAL(1, find(CALLS_SAMPLING, false));
    TEST_ASSERT_EQUAL(0, call(0)->field);
    TEST_ASSERT_EQUAL(96, call(1)->field);
    TEST_ASSERT_TRUE(builder->subroutines.of[0].moved);
}

static void test_reads_of_the_job_move_together(void)
{
    uint16_t a = input(0), b = input(32);
    store(sample(a, b, 64));
    store(sample(a, b, 160));
    ir->instruction[ir->sampling[1].first].k += 4;
    TEST_ASSERT_EQUAL(2, find(CALLS_SAMPLING, false));
}

static void test_addresses_in_code_do_not_move(void)
{
    uint16_t a = input(0), b = input(32);
    store(sample(a, b, 64));
    store(sample(a, b, 160));
    TEST_ASSERT_EQUAL(2, find(CALLS_SAMPLING, true));
    TEST_ASSERT_EQUAL(0, call(1)->field);
}

static void test_shared_subroutines_have_two_callers(void)
{
    uint16_t a = input(0), b = input(32);
    store(sample(a, a, 64));
    store(sample(a, b, 64));
    store(sample(b, a, 64));
    TEST_ASSERT_EQUAL(1, find(CALLS_SHARED, false));
    TEST_ASSERT_EQUAL(2, count(ir, IR_call));
    TEST_ASSERT_EQUAL(2, count(ir, IR_uniform)); /* the first stays */
}

static void test_literals_are_not_inputs(void)
{
    uint16_t a = input(0), half = append(IR_literal, TYPE_flt, 0, 0, 0x3f000000);
    uint16_t same = append(IR_literal, TYPE_flt, 0, 0, 0x3f000000),
             one = append(IR_literal, TYPE_flt, 0, 0, 0x3f800000);
    store(sample(a, half, 64));
    store(sample(a, same, 64));
    store(sample(a, one, 64));
    TEST_ASSERT_EQUAL(2, find(CALLS_SAMPLING, false));
    TEST_ASSERT_EQUAL(3, count(ir, IR_put));
    TEST_ASSERT_EQUAL(0, call(1)->k);
}

static void test_variables_of_others_stay(void)
{
    for (int elsewhere = 0; elsewhere < 2; elsewhere++) {
        ir_start(ir);
        uint16_t a = input(0);
        if (elsewhere)
            append(IR_set, TYPE_flt, a, 0, 3);
        ir_note_sampling(ir, true);
        append(IR_set, TYPE_flt, append(IR_add_f, TYPE_flt, a, a, 0), 0, 3);
        uint16_t got = append(IR_get, TYPE_flt, 0, 0, 3);
        ir_note_sampling(ir, false);
        store(got);
        TEST_ASSERT_EQUAL(!elsewhere, find(CALLS_SAMPLING, false));
    }
}

/* A result that one caller uses is a result for all; pairs are passed on as words. */
static void test_results_are_those_of_all_callers(void)
{
    for (int n = 0; n < 2; n++) {
        uint16_t a = append(IR_load, TYPE_fix, 0, 0, 0);
        ir_note_sampling(ir, true);
        uint16_t sum = append(IR_add_x, TYPE_fix, a, a, 0), product = append(IR_mul_x, TYPE_fix, a, a, 0);
        ir_note_sampling(ir, false);
        store(sum);
        if (n)
            store(product);
    }
    TEST_ASSERT_EQUAL(1, find(CALLS_SAMPLING, false));
    TEST_ASSERT_EQUAL(2, count(&builder->subroutines.body, IR_put));
    TEST_ASSERT_EQUAL(TYPE_itg, builder->subroutines.body.instruction[1].type);
}

/* --- Routines ------------------------------------------------------------------------------------------- */

static unsigned calling, samplings;
static char message[KEY_TEXT_CAPACITY + 400];

static struct build_options options_of(enum calls calls)
{
    return (struct build_options){.width = 8, .parts = 1, .profile = PROFILE_FULL, .calls = calls};
}

static size_t build(enum calls calls, enum unit unit, const union key *key)
{
    const struct build_options options = options_of(calls);
    size_t bytes = specialize_code(builder, &options, unit, key, NULL, NULL, &error);
    TEST_ASSERT_NOT_EQUAL_MESSAGE(0, bytes, error.text);
    return bytes;
}

/* Without samplings the code is the same. With them, the program ends with the subroutines. The span reading
 * has none. */
static void check_routine(void *context, enum unit unit, const union key *any)
{
    static uint8_t without[CODE_CAPACITY];
    char text[KEY_TEXT_CAPACITY];
    union key blocks = *any, *key = &blocks;
    (void)context;
    if (unit == UNIT_PIXEL)
        key->pixel.span = 0;
    size_t bytes = build(CALLS_INLINE, unit, key);
    memcpy(without, builder->emitter.code, bytes);
    snprintf(message, sizeof message, "%s key: %s", unit_name[unit], key_print(unit, key, text));
    size_t with = build(CALLS_SAMPLING, unit, key);
    if (!builder->subroutines.count) {
        TEST_ASSERT_EQUAL_MESSAGE(bytes, with, message);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(without, builder->emitter.code, bytes, message);
        return;
    }
    calling++;
    samplings += builder->subroutines.recording.samplings;
    TEST_ASSERT_EQUAL_MESSAGE(builder->subroutines.count, count(ir, IR_leave), message);
    const char *wrong = ir_verify(ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
}

static void test_routines_without_samplings_are_the_same(void)
{
    calling = samplings = 0;
    visit_random_keys(test_share(200), test_seed(), check_routine, NULL);
    visit_shaders(test_seed(), check_routine, NULL);
    TEST_ASSERT_GREATER_THAN(test_share(80), calling);
    TEST_ASSERT_GREATER_THAN(calling, samplings);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_equal_samplings_are_one_subroutine);
    RUN_TEST(test_samplings_of_other_textures_move_the_job);
    RUN_TEST(test_reads_of_the_job_move_together);
    RUN_TEST(test_addresses_in_code_do_not_move);
    RUN_TEST(test_shared_subroutines_have_two_callers);
    RUN_TEST(test_literals_are_not_inputs);
    RUN_TEST(test_variables_of_others_stay);
    RUN_TEST(test_results_are_those_of_all_callers);
    RUN_TEST(test_routines_without_samplings_are_the_same);
    return UNITY_END();
}
