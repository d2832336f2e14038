/* Loops, nested regions and variables: random programs mean after every pass, alone and with others, what they
 * meant before, and machine code with any number of registers computes what the interpreter does. And what the
 * passes are for, one by one. */
#include "base/code.h"
#include "base/cpu.h"
#include "base/mxcsr.h"
#include "def/lane.h"
#include "tests/support/program.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

enum { PROGRAMS = 700 };

static struct code_arena *arena;
static struct builder *builder;
static struct program_data expected, got;
static char message[200];

void setUp(void)
{
    struct error error = {{0}};
    arena = code_create(0, NULL, &error);
    builder = builder_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
}

void tearDown(void)
{
    builder_give(builder);
    code_destroy(arena);
}

static void verify_after(void *context, enum pass pass, const struct ir *ir)
{
    const char *wrong = ir_verify(ir);
    if (!wrong)
        return;
    snprintf(message, sizeof message, "program %u after pass %u: %s", *(const unsigned *)context,
             (unsigned)pass, wrong);
    TEST_FAIL_MESSAGE(message);
}

static void fail_if_different(const char *what, unsigned number)
{
    int at = program_difference(&expected, &got);
    if (at < 0)
        return;
    snprintf(message, sizeof message, "%s, program %u: lane %d of slot %d: expected %08x, got %08x", what,
             number, at % VERTEX_CAPACITY, at / VERTEX_CAPACITY, lane_bits(expected.output[at]),
             lane_bits(got.output[at]));
    TEST_FAIL_MESSAGE(message);
}

static void make(unsigned number, unsigned width)
{
    uint64_t seed = number * 0x9e3779b97f4a7c15ull | 1;
    program_make_loops(&builder->ir, 5 + program_random(&seed) % 50, &seed);
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    program_fill(&expected, &seed);
    got = expected;
    program_interpret(&builder->ir, &expected, width);
}

static void optimize_verified(unsigned number, enum profile profile, uint32_t disabled)
{
    unsigned saved = mxcsr_enter();
    optimize(&builder->ir, &builder->pass, profile, disabled, verify_after, &number);
    mxcsr_leave(saved);
    const char *wrong = ir_verify(&builder->ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
}

static void check_optimized(unsigned number, enum profile profile, uint32_t disabled, const char *what)
{
    make(number, 8);
    optimize_verified(number, profile, disabled);
    program_interpret(&builder->ir, &got, 8);
    fail_if_different(what, number);
}

static void test_all_passes_keep_meaning(void)
{
    for (unsigned n = 1; n <= PROGRAMS; n++) {
        check_optimized(n, PROFILE_FULL, 0, "full profile");
        check_optimized(n, PROFILE_THESIS, 0, "thesis profile");
    }
}

static void test_any_set_of_passes_keeps_meaning(void)
{
    for (unsigned pass = 0; pass < PASS_COUNT; pass++)
        for (unsigned n = 1; n <= PROGRAMS / 8; n++) {
            check_optimized(n, PROFILE_FULL, ~(1u << pass), "one pass");
            check_optimized(n, PROFILE_FULL, 1u << pass, "all but one pass");
        }
    for (unsigned n = 1; n <= PROGRAMS; n++)
        check_optimized(n, PROFILE_FULL, n, "a set of passes");
}

static void test_machine_code_equals_the_interpreter(void)
{
    static const uint32_t disabled[] = {0, ~0u, 0, 1, 0, 6, 0, 25};
    static const uint8_t registers[] = {4, 5, 7, 10, ALLOCATABLE};
    struct error error = {{0}};
    uint32_t spills = 0;
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    for (unsigned n = 1; n <= 2 * PROGRAMS; n++)
        for (unsigned r = n % 2; r < sizeof registers; r += 2) {
            unsigned width = n % 3 ? 8 : 4;
            make(n, width);
            optimize_verified(n, n % 7 ? PROFILE_FULL : PROFILE_THESIS, disabled[n % 8]);
            TEST_ASSERT_EQUAL_MESSAGE(
                0, program_compile_and_run(builder, arena, width, registers[r], &got, &error), error.text);
            char what[64];
            snprintf(what, sizeof what, "%u lanes, %u registers", width, registers[r]);
            fail_if_different(what, n);
            spills += builder->allocation.spills;
        }
    TEST_ASSERT_GREATER_THAN(1000, spills);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_all_passes_keep_meaning);
    RUN_TEST(test_any_set_of_passes_keeps_meaning);
    RUN_TEST(test_machine_code_equals_the_interpreter);
    return UNITY_END();
}
