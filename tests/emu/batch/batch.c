/* The batch interpreter: every row of def/op.def on edge values, random programs with regions, loops and
 * variables for every size of a batch, and whole routines against the emulator. */
#include "emu/batch/batch.h"
#include "emu/emulate/emulate.h"
#include "engines/list.h"
#include "tests/support/differential/differential.h"
#include "tests/support/shader/edges.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct ir *ir;
static struct program_data expected, got;
static char message[160];
static bool fuses; /* batches have steps for pairs */

void setUp(void)
{
    ir = malloc(sizeof *ir);
    TEST_ASSERT_NOT_NULL(ir);
    fuses = false;
}

void tearDown(void)
{
    free(ir);
}

/* Runs `ir` over all lanes in batches of at most `lanes`. Returns the number of lanes of the schedule. */
static unsigned run(unsigned lanes)
{
    static const union key key;
    struct error error = {{0}};
    struct routine *routine = batch_routine(ir, lanes, fuses, UNIT_VERTEX, &key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    struct vertex_arguments call = {&got.job, got.input, got.output, PROGRAM_LANES};
    routine->run(&call, routine);
    unsigned used = batch_schedule(routine)->lanes;
    engine_batch.free(NULL, routine);
    return used;
}

static void fail_if_different(const char *what, unsigned number, unsigned lanes)
{
    int at = program_difference(&expected, &got);
    if (at < 0)
        return;
    snprintf(message, sizeof message, "%s %u, %u lanes: lane %d of slot %d: expected %08x, got %08x", what,
             number, lanes, at % VERTEX_CAPACITY, at / VERTEX_CAPACITY,
             ((unsigned *)(void *)expected.output)[at], ((unsigned *)(void *)got.output)[at]);
    TEST_FAIL_MESSAGE(message);
}

enum operand_form { FROM_LANES, FROM_JOB, FROM_LITERAL, FORMS };

static uint32_t edge(enum ir_type type, unsigned i)
{
    uint32_t word = edges[i % edge_count];
    return type == TYPE_msk ? -(word & 1) : word;
}

static uint16_t make_operand(enum operand_form form, enum ir_type type, int position, unsigned literal)
{
    struct ir_instruction i = {.type = (uint8_t)type};
    switch (form) {
    case FROM_LANES:
        i.op = IR_load;
        i.base = BASE_INPUT;
        i.k = position * PROGRAM_LANES * 4;
        break;
    case FROM_JOB:
        i.op = IR_uniform;
        i.base = BASE_JOB;
        i.k = (int32_t)offsetof(struct job, world_view_projection) + position * 4;
        break;
    default:
        i.op = IR_literal;
        i.k = (int32_t)edge(type, literal);
        if (type == TYPE_fix)
            i.k = (int32_t)((uint32_t)(i.k & 0xffff) * 0x10001u);
    }
    return ir_append(ir, i);
}

static void make_operation(enum ir_op op, unsigned form, int k, unsigned literal)
{
    const struct ir_op_information *information = &ir_op_information[op];
    struct ir_instruction i = {.op = (uint8_t)op, .type = information->result, .k = k};
    ir_start(ir);
    for (int o = 0; o < information->operands; o++, form /= FORMS)
        i.operand[o] = make_operand(form % FORMS, information->operand[o], o, literal + (unsigned)o);
    uint16_t result = ir_append(ir, i);
    ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {result}});
}

/* Each lane has the next edge value. The step determines the pairs. */
static void fill(enum ir_op op, unsigned step)
{
    memset(&expected, 0, sizeof expected);
    for (int o = 0; o < 3; o++) {
        enum ir_type type = ir_op_information[op].operand[o];
        uint32_t word = edge(type, step + (unsigned)o);
        memcpy(&expected.job.world_view_projection[0][o], &word, 4);
        for (unsigned lane = 0; lane < PROGRAM_LANES; lane++) {
            unsigned n = step * PROGRAM_LANES + lane;
            unsigned digit = o == 0 ? n : o == 1 ? n / edge_count : n / edge_count / edge_count + lane * 7;
            expected.input[o * PROGRAM_LANES + (int)lane] = edge(type, digit);
        }
    }
    got = expected;
}

/* Masks are words of memory here, which recordings do not have. */
static bool has_masks(enum ir_op op)
{
    return memchr(ir_op_information[op].operand, TYPE_msk, sizeof ir_op_information[op].operand) != NULL;
}

static void check_operation(enum ir_op op, int k)
{
    unsigned operands = ir_op_information[op].operands, forms = 1;
    for (unsigned o = 0; o < operands; o++)
        forms *= FORMS;
    unsigned steps = edge_count * (operands > 1 ? edge_count : 1) / PROGRAM_LANES + 1;
    for (unsigned form = 0; form < forms; form++)
        for (unsigned step = 0; step < steps; step++) {
            make_operation(op, form, k, step);
            if (!has_masks(op)) {
                TEST_ASSERT_NULL(ir_verify(ir));
            }
            fill(op, step);
            program_interpret(ir, &expected, PROGRAM_LANES);
            run(step % 2 ? 64 : 16);
            fail_if_different(ir_op_information[op].name, (unsigned)k, step % 2 ? 64 : 16);
        }
}

static void test_every_operation_equals_its_expression(void)
{
    for (unsigned op = 1; op <= IR_COMPUTED; op++) {
        int last = !(ir_op_information[op].properties & IR_SHIFTS) ? 0
                   : ir_op_information[op].result == TYPE_fix      ? 15
                                                                   : 31;
        for (int k = 0; k <= last; k += (int)test_stride_of(5))
            check_operation(op, k);
    }
}

static void test_a_permutation_exchanges_the_named_lanes(void)
{
    for (int lanes = 0; lanes < 256; lanes += (int)test_stride_of(7))
        check_operation(IR_permute, lanes);
}

/* The effect of a loop or a region in these programs may depend on the number of lanes in a batch, so the
 * expected result is computed with batches of the same size. */
static void check_programs(void make(struct ir *, unsigned, uint64_t *), const char *what)
{
    const unsigned programs = test_share_of(1200, 12);
    for (unsigned n = 1; n <= programs; n++) {
        uint64_t seed = n * 0x9e3779b97f4a7c15ull | 1;
        unsigned lanes = 4u << n % 5;
        fuses = n / 5 % 2;
        make(ir, 5 + program_random(&seed) % 60, &seed);
        TEST_ASSERT_NULL(ir_verify(ir));
        program_fill(&expected, &seed);
        got = expected;
        program_interpret(ir, &expected, lanes);
        TEST_ASSERT_EQUAL(lanes, run(lanes));
        fail_if_different(what, n, lanes);
    }
}

static void test_random_programs_of_any_batch_size(void)
{
    check_programs(program_make, "program");
}

static void test_random_loops_of_any_batch_size(void)
{
    check_programs(program_make_loops, "program with loops");
}

/* More simultaneous values than fit into the scratch memory with the requested lanes. */
static void make_wide(unsigned values)
{
    ir_start(ir);
    for (unsigned v = 0; v < values; v++)
        ir_append(ir, (struct ir_instruction){.op = IR_load,
                                              .type = TYPE_itg,
                                              .base = BASE_INPUT,
                                              .k = (int32_t)(v % PROGRAM_ARRAYS) * PROGRAM_LANES * 4});
    uint16_t sum = 1;
    for (unsigned v = 1; v < values; v++)
        sum = ir_append(ir, (struct ir_instruction){.op = IR_xor_i,
                                                    .type = TYPE_itg,
                                                    .operand = {sum, (uint16_t)(values - v + 1)}});
    ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {sum}});
}

static void test_a_routine_with_too_many_rows_has_fewer_lanes(void)
{
    static const struct {
        unsigned values, asked, lanes;
    } cases[] = {{100, 256, 256}, {5000, 256, 32}, {20000, 64, 8}, {32000, 256, 8}};
    uint64_t seed = 5;
    for (unsigned c = 0; c < sizeof cases / sizeof *cases; c++) {
        make_wide(cases[c].values);
        program_fill(&expected, &seed);
        got = expected;
        program_interpret(ir, &expected, PROGRAM_LANES);
        TEST_ASSERT_EQUAL(cases[c].lanes, run(cases[c].asked));
        fail_if_different("values", cases[c].values, cases[c].lanes);
    }
}

static void test_values_with_separate_lifetimes_share_a_row(void)
{
    struct error error = {{0}};
    ir_start(ir);
    uint16_t first =
        ir_append(ir, (struct ir_instruction){.op = IR_load, .type = TYPE_itg, .base = BASE_INPUT});
    uint16_t last = first;
    for (int i = 0; i < 1000; i++)
        last = ir_append(ir,
                         (struct ir_instruction){.op = IR_mul_i, .type = TYPE_itg, .operand = {last, first}});
    ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {last}});
    struct schedule *schedule = schedule_create(ir, 64, false, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(schedule, error.text);
    TEST_ASSERT_EQUAL(2 * 64 * 4, schedule->scratch_bytes);
    schedule_free(schedule);
}

static void test_values_that_are_not_stored_have_no_steps(void)
{
    struct error error = {{0}};
    ir_start(ir);
    uint16_t value =
        ir_append(ir, (struct ir_instruction){.op = IR_load, .type = TYPE_flt, .base = BASE_INPUT});
    ir_append(ir, (struct ir_instruction){.op = IR_sqrt_f, .type = TYPE_flt, .operand = {value}});
    ir_append(ir, (struct ir_instruction){.op = IR_set, .type = TYPE_flt, .operand = {value}, .k = 7});
    struct schedule *schedule = schedule_create(ir, 64, false, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(schedule, error.text);
    TEST_ASSERT_EQUAL(1, schedule->count); /* the end */
    schedule_free(schedule);
}

static uint16_t add_binary(enum ir_op op, uint16_t a, uint16_t b)
{
    return ir_append(ir, (struct ir_instruction){
                             .op = (uint8_t)op, .type = ir_op_information[op].result, .operand = {a, b}});
}

static uint16_t add_input(enum ir_type type, int number)
{
    return ir_append(
        ir, (struct ir_instruction){
                .op = IR_load, .type = (uint8_t)type, .base = BASE_INPUT, .k = number * PROGRAM_LANES * 4});
}

/* A product of two inputs, and the second operation on it and the third input, at `position` of both. */
static void make_pair(enum ir_op first, enum ir_op second, int position, bool used_twice)
{
    enum ir_type type = ir_op_information[first].result;
    ir_start(ir);
    uint16_t a = add_input(type, 0), b = add_input(type, 1), c = add_input(type, 2);
    uint16_t product = add_binary(first, a, b);
    uint16_t sum = position ? add_binary(second, c, product) : add_binary(second, product, c);
    ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {sum}});
    if (used_twice)
        ir_append(ir,
                  (struct ir_instruction){
                      .op = IR_store, .base = BASE_OUTPUT, .k = VERTEX_CAPACITY * 4, .operand = {product}});
}

static unsigned steps_of(bool fused)
{
    struct error error = {{0}};
    struct schedule *schedule = schedule_create(ir, 64, fused, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(schedule, error.text);
    unsigned count = schedule->count;
    schedule_free(schedule);
    return count;
}

static void test_a_product_and_its_sum_are_one_step_with_both_roundings(void)
{
    static const struct {
        enum ir_op first, second;
        int position;
    } rows[] = {
#define PAIR(first, second, position) {IR_##first, IR_##second, position},
#include "def/engine/pair.def"
#undef PAIR
    };
    uint64_t seed = 7;
    fuses = true;
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        make_pair(rows[i].first, rows[i].second, rows[i].position, false);
        TEST_ASSERT_EQUAL(steps_of(false) - 1, steps_of(true));
        program_fill(&expected, &seed);
        for (unsigned lane = 0; lane < 3 * PROGRAM_LANES; lane++)
            ((uint32_t *)(void *)expected.input)[lane] = edges[program_random(&seed) % edge_count];
        got = expected;
        program_interpret(ir, &expected, PROGRAM_LANES);
        run(64);
        fail_if_different("pair", i, 64);
    }
}

static void test_a_product_that_is_used_twice_is_a_step(void)
{
    make_pair(IR_mul_f, IR_add_f, 0, true);
    TEST_ASSERT_EQUAL(steps_of(false), steps_of(true));
}

static void test_whole_routines_equal_the_emulator(void)
{
    const struct engine *const engines[] = {&engine_batch_4, &engine_batch_16, &engine_batch,
                                            &engine_batch_256, engine_find("batch:fuse=products")};
    enum { ROUNDS = 250 };
    struct differential *differential = differential_create(NULL);
    TEST_ASSERT_NOT_NULL(differential);
    for (unsigned i = 0; i < sizeof engines / sizeof *engines; i++)
        for (int unit = 0; unit < UNIT_COUNT; unit++) {
            const char *difference =
                differential_rounds(differential, &engine_emulate, engines[i], unit, NULL,
                                    100 * i + (uint64_t)unit + 1, (int)test_share_of(ROUNDS, 12));
            if (difference)
                TEST_FAIL_MESSAGE(difference);
        }
    differential_destroy(differential);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_operation_equals_its_expression);
    RUN_TEST(test_a_permutation_exchanges_the_named_lanes);
    RUN_TEST(test_random_programs_of_any_batch_size);
    RUN_TEST(test_random_loops_of_any_batch_size);
    RUN_TEST(test_a_routine_with_too_many_rows_has_fewer_lanes);
    RUN_TEST(test_values_with_separate_lifetimes_share_a_row);
    RUN_TEST(test_values_that_are_not_stored_have_no_steps);
    RUN_TEST(test_a_product_and_its_sum_are_one_step_with_both_roundings);
    RUN_TEST(test_a_product_that_is_used_twice_is_a_step);
    RUN_TEST(test_whole_routines_equal_the_emulator);
    return UNITY_END();
}
