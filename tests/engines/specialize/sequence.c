/* Random sequences of passes on random programs. Any pass may follow any other and may be repeated, and the
 * final renumbering may occur anywhere. Values are split into parts once at most. After each pass the program
 * must be valid and have the same results.
 *
 * The first pass of a sequence depends on the program's number, so each pass is first equally often.
 * TRIPTYCH_SEED selects other programs and sequences. */
#include "base/bits.h"
#include "machine/mxcsr.h"
#include "contract/lane.h"
#include "engines/specialize/specialize.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>
#include <string.h>

enum { PROGRAMS = 6800, SEQUENCE = 10, COMPACT = PASS_COUNT, CHOICES, TRAIL = 200, LANES = 8, PARTS = 2 };

static pass_function *const passes[PASS_COUNT] = {
#define PASS(name, ...) pass_##name,
#include "def/engine/pass.def"
#undef PASS
};

static struct ir ir;
static struct pass_memory memory;
static struct program_data given, expected, got;
static char trail[TRAIL]; /* the passes so far */
static unsigned changed[CHOICES];

void setUp(void)
{
    memset(changed, 0, sizeof changed);
}

void tearDown(void)
{
}

static void fail(uint64_t number, const char *what)
{
    static char message[2 * TRAIL + 200];
    snprintf(message, sizeof message, "program %llu after%s: %s", (unsigned long long)number, trail, what);
    TEST_FAIL_MESSAGE(message);
}

static void note(unsigned choice)
{
    const char *name = choice == COMPACT ? "compact" : pass_name(choice);
    size_t length = strlen(trail);
    snprintf(trail + length, sizeof trail - length, " %s", name);
}

static void run(unsigned choice)
{
    unsigned saved = mxcsr_enter();
    uint32_t count = ir.count;
    memory.lanes = choice == PASS_split ? LANES / PARTS : choice == PASS_shape ? 8 : 16;
    memory.parts = PARTS;
    memory.judges = true;
    memory.shapes = (struct pass_shapes){0};
    note(choice);
    if (choice == COMPACT)
        ir_compact(&ir, memory.map);
    changed[choice] += choice == COMPACT ? count != ir.count : passes[choice](&ir, &memory);
    mxcsr_leave(saved);
}

static void compare(uint64_t number)
{
    char what[120];
    got = given;
    program_interpret(&ir, &got, LANES / ir.parts);
    int at = program_difference(&expected, &got);
    if (at < 0)
        return;
    snprintf(what, sizeof what, "lane %d of slot %d: expected %08x, got %08x", at % VERTEX_CAPACITY,
             at / VERTEX_CAPACITY, bits_of_float(expected.output[at]), bits_of_float(got.output[at]));
    fail(number, what);
}

static void verify(uint64_t number)
{
    const char *wrong = ir_verify(&ir);
    if (wrong)
        fail(number, wrong);
}

typedef void generator(struct ir *, unsigned length, uint64_t *seed);

/* The program is verified after each pass. Results are compared after each pass in every other program, and
 * at the end. */
static void try_sequence(generator *make, uint64_t number, unsigned longest)
{
    uint64_t seed = test_seed() + number * 0x9e3779b97f4a7c15ull;
    seed |= !seed;
    trail[0] = 0;
    make(&ir, 3 + program_random(&seed) % longest, &seed);
    verify(number);
    program_fill(&given, &seed);
    expected = given;
    program_interpret(&ir, &expected, LANES);
    for (unsigned length = 1 + program_random(&seed) % SEQUENCE, i = 0; i < length; i++) {
        run(i ? program_random(&seed) % CHOICES : (unsigned)(number % CHOICES));
        verify(number);
        if (number % 2 || i == 0)
            compare(number);
    }
    compare(number);
}

/* Each pass must have changed something in each test, but for the estimates and for passes of pixel routines:
 * those of the span reading, and the parts of whole blocks. */
static void expect_changes(uint32_t without)
{
    without |=
        1u << PASS_separate | 1u << PASS_near | 1u << PASS_stretch | 1u << PASS_shape | 1u << PASS_early;
    if (test_stride() > 1) /* too few programs: few have a uniform condition */
        without |= 1u << PASS_condition;
    for (unsigned choice = 0; choice < CHOICES; choice++)
        if (!(without >> choice & 1))
            TEST_ASSERT_GREATER_THAN_MESSAGE(test_share_of(20, 5), changed[choice],
                                             choice == COMPACT ? "compact" : pass_name(choice));
}

static void test_straight_programs(void)
{
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 6); n++)
        try_sequence(program_make, n, 100);
    expect_changes(1u << PASS_unroll | 1u << PASS_phi | 1u << PASS_condition | 1u << PASS_invariant |
                   1u << PASS_preload);
}

static void test_programs_with_loops_and_variables(void)
{
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 4); n++)
        try_sequence(program_make_loops, n, 40);
    expect_changes(1u << PASS_unroll);
}

static void test_programs_with_constant_loops(void)
{
    for (uint64_t n = 1; n <= test_share_of(2 * PROGRAMS, 4); n++) /* few have a uniform condition */
        try_sequence(program_make_counted, n, 40);
    expect_changes(0);
}

static void test_programs_with_forms_that_recordings_lack(void)
{
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 2); n++)
        try_sequence(program_make_wild, n, 50);
    expect_changes(1u << PASS_unroll);
}

/* The generator respects the capacity. */
static void test_long_programs(void)
{
    for (uint64_t n = 1; n <= 4; n++) {
        try_sequence(program_make, n, 5000);
        try_sequence(program_make_loops, n, 400);
        TEST_ASSERT_FALSE(ir.overflow);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_straight_programs);
    RUN_TEST(test_programs_with_loops_and_variables);
    RUN_TEST(test_programs_with_constant_loops);
    RUN_TEST(test_programs_with_forms_that_recordings_lack);
    RUN_TEST(test_long_programs);
    return UNITY_END();
}
