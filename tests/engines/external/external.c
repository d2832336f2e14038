/* The external engine, in each of its languages: the operations of its text against the expressions of
 * def/op.def, random programs with regions, loops and variables, and whole routines against the emulator;
 * then a missing and a failing compiler. Compilation is slow, so there are few routines, and each covers
 * much. */
#include "base/bits.h"
#include "emu/emulate/emulate.h"
#include "engines/external/external.h"
#include "engines/list.h"
#include "tests/support/differential/differential.h"
#include "tests/support/shader/edges.h"
#include "tests/support/shader/program.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const languages[] = {"external", "external:c=plain:optimize=1",
                                        "external:c=portable:optimize=1", "external:c=pixels:optimize=1"};
enum { LANGUAGES = sizeof languages / sizeof *languages };

static const struct engine *engine; /* that is tested */
static const union key key;
static struct ir *ir;
static struct program_data expected, got;
static char folder[] = "/tmp/triptych-external-test-XXXXXX";
static char message[256];

/* Temporary files are in a folder of the test, which is empty after each test. */
static unsigned files_left(void)
{
    unsigned count = 0;
    DIR *open = opendir(folder);
    for (struct dirent *entry; open && (entry = readdir(open));)
        count += entry->d_name[0] != '.';
    closedir(open);
    return count;
}

void setUp(void)
{
    ir = malloc(sizeof *ir);
    TEST_ASSERT_NOT_NULL(ir);
    setenv("TMPDIR", folder, 1);
    unsetenv("TRIPTYCH_CC");
    engine = &engine_external;
    if (engine_unavailable(&engine_external))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_external));
}

void tearDown(void)
{
    free(ir);
    TEST_ASSERT_EQUAL_MESSAGE(0, files_left(), "temporary files are left");
}

static void fail_if_different(const char *what, unsigned number)
{
    int at = program_difference(&expected, &got);
    if (at < 0)
        return;
    snprintf(message, sizeof message, "%s: %s %u: lane %d of slot %d: expected %08x, got %08x", engine->name,
             what, number, at % VERTEX_CAPACITY, at / VERTEX_CAPACITY,
             ((unsigned *)(void *)expected.output)[at], ((unsigned *)(void *)got.output)[at]);
    TEST_FAIL_MESSAGE(message);
}

static struct routine *build(void)
{
    struct error error = {{0}};
    TEST_ASSERT_NULL(ir_verify(ir));
    struct routine *routine = external_routine(engine, ir, UNIT_VERTEX, &key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    return routine;
}

static void run(const struct routine *routine)
{
    struct vertex_arguments call = {&got.job, got.input, got.output, PROGRAM_LANES};
    routine->run(&call, routine);
}

/* --- Operations -------------------------------------------------------------------------------------- */

/* Loads of the three operands with each type, then the operations. Each stores to a slot of its own. */
struct operations {
    unsigned slot;
    uint16_t operand[TYPE_msk + 1][3];
};

static void start_operations(struct operations *operations)
{
    ir_start(ir);
    operations->slot = 0;
    for (int type = TYPE_flt; type <= TYPE_fix; type++)
        for (int o = 0; o < 3; o++) {
            struct ir_instruction load = {.op = IR_load, .type = TYPE_itg, .base = BASE_INPUT};
            load.k = o * PROGRAM_LANES * 4;
            if (type == TYPE_flt)
                load.type = TYPE_flt;
            uint16_t value = ir_append(ir, load);
            struct ir_instruction copy = {.op = IR_copy, .type = TYPE_fix, .operand = {value}};
            operations->operand[type][o] = type == TYPE_fix ? ir_append(ir, copy) : value;
        }
    struct ir_instruction load = {.op = IR_load, .type = TYPE_itg, .base = BASE_INPUT};
    load.k = 3 * PROGRAM_LANES * 4;
    struct ir_instruction zero = {.op = IR_literal, .type = TYPE_itg};
    struct ir_instruction compare = {.op = IR_gt_i, .type = TYPE_msk};
    compare.operand[0] = ir_append(ir, zero);
    compare.operand[1] = ir_append(ir, load);
    operations->operand[TYPE_msk][0] = ir_append(ir, compare);
    compare.operand[1] = operations->operand[TYPE_itg][0];
    operations->operand[TYPE_msk][1] = ir_append(ir, compare);
}

static void append_operation(struct operations *operations, enum ir_op op, int k)
{
    const struct ir_op_information *information = &ir_op_information[op];
    struct ir_instruction i = {.op = (uint8_t)op, .type = information->result, .k = k};
    struct ir_instruction store = {.op = IR_store, .base = BASE_OUTPUT};
    for (int o = 0; o < information->operands; o++)
        i.operand[o] = operations->operand[information->operand[o]][o];
    store.operand[0] = ir_append(ir, i);
    store.k = (int32_t)(operations->slot++ * VERTEX_SLOT_BYTES);
    ir_append(ir, store);
    TEST_ASSERT_LESS_OR_EQUAL(SLOT_COUNT, operations->slot);
}

static int language; /* its number */

/* Runs a test with each language, or with sanitizers with the first. */
static void with_each_language(void test(void))
{
    for (language = 0; language < LANGUAGES; language += (int)test_stride()) {
        engine = engine_find(languages[language]);
        TEST_ASSERT_NOT_NULL(engine);
        test();
    }
}

/* Every combination of two edges, with the third in turn. */
static void check_edges(const char *what)
{
    struct routine *routine = build();
    unsigned cells = edge_count * edge_count;
    for (unsigned step = 0; step * PROGRAM_LANES < cells; step++) {
        memset(&expected, 0, sizeof expected);
        for (unsigned lane = 0; lane < PROGRAM_LANES; lane++) {
            unsigned n = step * PROGRAM_LANES + lane;
            unsigned digit[PROGRAM_ARRAYS] = {n, n / edge_count, n * 7 + n / edge_count, lane + step};
            for (unsigned o = 0; o < PROGRAM_ARRAYS; o++)
                expected.input[o * PROGRAM_LANES + lane] = edges[digit[o] % edge_count];
        }
        got = expected;
        program_interpret(ir, &expected, EXTERNAL_WIDTH);
        run(routine);
        fail_if_different(what, step);
    }
    engine_external.free(NULL, routine);
}

static void check_every_operation(void)
{
    struct operations operations;
    start_operations(&operations);
    for (unsigned op = 1; op <= IR_COMPUTED; op++)
        if (!(ir_op_information[op].properties & IR_SHIFTS))
            append_operation(&operations, op, 0);
    for (int k = 0; k < 256; k += 51)
        append_operation(&operations, IR_permute, k);
    check_edges("edges");
}

/* The numbers of bits in four parts. A part takes the compiler a second, so each language has one of them. */
static void check_shifts(void)
{
    struct operations operations;
    for (int part = 0; part < 4; part++) {
        if (part != language && !getenv("THOROUGH"))
            continue;
        start_operations(&operations);
        for (unsigned op = 1; op <= IR_COMPUTED; op++) {
            const struct ir_op_information *information = &ir_op_information[op];
            if (information->properties & IR_SHIFTS)
                for (int k = part; k < (information->result == TYPE_fix ? 16 : 32); k += 4)
                    append_operation(&operations, op, k);
        }
        check_edges("edges");
    }
}

static void test_every_operation_equals_its_expression(void)
{
    with_each_language(check_every_operation);
}

static void test_shifts_by_any_number(void)
{
    with_each_language(check_shifts);
}

/* Compilers fold constants without flushing denormals, so constants must be hidden from them. */
static void check_constants(void)
{
    static const uint32_t literals[] = {0x00000001, 0x3f800000, 0x807fffff, 0x00000000, 0x40000000};
    static const uint8_t ops[] = {IR_add_f, IR_sub_f, IR_mul_f, IR_min_f, IR_max_f};
    enum { LITERALS = sizeof literals / sizeof *literals, OPS = sizeof ops };
    uint16_t literal[LITERALS], integer[LITERALS];
    struct operations operations;
    start_operations(&operations);
    for (int i = 0; i < LITERALS; i++) {
        struct ir_instruction value = {.op = IR_literal, .type = TYPE_flt, .k = (int32_t)literals[i]};
        literal[i] = ir_append(ir, value);
        value.type = TYPE_itg;
        integer[i] = ir_append(ir, value);
    }
    for (int i = 0; i < LITERALS; i++) {
        struct ir_instruction cast = {.op = IR_copy, .type = TYPE_flt, .operand = {integer[i]}};
        operations.operand[TYPE_flt][1] = i % 2 ? literal[i] : ir_append(ir, cast);
        operations.operand[TYPE_flt][2] = literal[(i + 1) % LITERALS];
        for (int o = 0; o < OPS; o++) {
            operations.operand[TYPE_flt][0] = literal[(i + o) % LITERALS];
            append_operation(&operations, ops[o], 0);
        }
        append_operation(&operations, IR_lt_f, 0);
        operations.operand[TYPE_flt][0] = 1;
        append_operation(&operations, IR_mul_f, 0);
        append_operation(&operations, IR_add_f, 0);
    }
    check_edges("literals");
}

static void test_constants_are_flushed(void)
{
    with_each_language(check_constants);
}

/* A number of the size of 2^exponent, with 23 random bits below its first. */
static uint32_t near(int exponent, uint64_t *seed)
{
    return bits_of_float(ldexpf(1 + (float)(program_random(seed) & 0x7fffff) * 0x1p-23f, exponent));
}

/* Operands whose product, quotient, sum and fused sum are near the least normal number. Results that are
 * halfway to the next smaller number are rounded up to it and kept. */
static void fill_near_least(uint64_t *seed)
{
    uint32_t *a = expected.input, *b = a + PROGRAM_LANES, *c = b + PROGRAM_LANES;
    for (int lane = 0; lane < PROGRAM_LANES; lane++) {
        float least = 0x1p-126f * (lane % 4 == 3 ? 1.5f : 1);
        a[lane] = near(-63 + lane % 3, seed);
        b[lane] = bits_of_float(least * 0x1p60f / bits_to_float(a[lane]) * 0x1p-60f) + lane % 7 - 3;
        c[lane] = lane % 4 == 1 ? 0 : near(-126, seed) ^ (lane % 2 ? 0x80000000u : 0);
    }
    a[0] = bits_of_float((1 + 0x1p-12f) * 0x1p-75f);
    b[0] = bits_of_float((1 - 0x1p-12f + 0x1p-24f) * -0x1p-76f);
    c[0] = bits_of_float(0x1p-126f); /* the sum is 2^-187 below the half: zero */
    a[1] = bits_of_float(0x1p-100f - 0x1p-124f);
    b[1] = bits_of_float(0x1p-26f), c[1] = 0; /* at the half: kept */
}

static void check_least(void)
{
    uint64_t seed = 1;
    struct operations operations;
    start_operations(&operations);
    for (unsigned op = IR_add_f; op <= IR_max_f; op++)
        append_operation(&operations, (enum ir_op)op, 0);
    struct routine *routine = build();
    for (unsigned step = 0; step < 200; step++) {
        memset(&expected, 0, sizeof expected);
        fill_near_least(&seed);
        got = expected;
        program_interpret(ir, &expected, EXTERNAL_WIDTH);
        run(routine);
        fail_if_different("least", step);
    }
    engine->free(NULL, routine);
}

static void test_results_near_the_least_normal_number(void)
{
    with_each_language(check_least);
}

/* --- Programs and routines --------------------------------------------------------------------------- */

static void check_programs(void)
{
    for (unsigned n = 1; n <= test_share_of(6, 1); n++) {
        uint64_t seed = n * 0x9e3779b97f4a7c15ull | 1;
        if (n % 2)
            program_make_loops(ir, 60, &seed);
        else
            program_make(ir, 150, &seed);
        struct routine *routine = build();
        for (unsigned data = 0; data < 20; data++) {
            program_fill(&expected, &seed);
            got = expected;
            program_interpret(ir, &expected, EXTERNAL_WIDTH);
            run(routine);
            fail_if_different("program", n);
        }
        engine_external.free(NULL, routine);
    }
}

static void test_random_programs_and_loops(void)
{
    with_each_language(check_programs);
}

/* A routine takes the compiler a second or two. Those of portable C are in portable.c. */
static void check_routines(void)
{
    if (strstr(engine->name, "portable") && !getenv("THOROUGH"))
        return;
    const int rounds = (int)test_share_of(8, 1);
    struct differential *differential = differential_create(NULL);
    TEST_ASSERT_NOT_NULL(differential);
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        const char *difference =
            differential_rounds(differential, &engine_emulate, engine, unit, NULL, 4, rounds);
        if (difference)
            TEST_FAIL_MESSAGE(difference);
    }
    differential_destroy(differential);
}

static void test_whole_routines_equal_the_emulator(void)
{
    with_each_language(check_routines);
}

static void test_a_routine_has_its_code(void)
{
    struct operations operations;
    start_operations(&operations);
    append_operation(&operations, IR_add_f, 0);
    struct routine *routine = build();
    TEST_ASSERT_NOT_NULL(routine->code);
    TEST_ASSERT_GREATER_THAN(32, routine->code_bytes);
    TEST_ASSERT_LESS_THAN(4096, routine->code_bytes);
    engine_external.free(NULL, routine);
}

/* --- Failures ---------------------------------------------------------------------------------------- */

static void expect_error(const char *what)
{
    struct error error = {{0}};
    struct operations operations;
    start_operations(&operations);
    append_operation(&operations, IR_add_f, 0);
    struct routine *routine = external_routine(engine, ir, UNIT_VERTEX, &key, &error);
    TEST_ASSERT_NULL(routine);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, what), error.text);
    TEST_ASSERT_NULL_MESSAGE(strchr(error.text, '\n'), error.text);
}

/* A script of the test as the compiler. */
static void write_compiler(const char *script)
{
    char path[sizeof folder + 16];
    snprintf(path, sizeof path, "%s/.compiler", folder);
    FILE *file = fopen(path, "w");
    TEST_ASSERT_NOT_NULL(file);
    fputs(script, file);
    fclose(file);
    chmod(path, 0700);
    setenv("TRIPTYCH_CC", path, 1);
}

static void test_without_a_compiler_the_engine_is_unavailable(void)
{
    setenv("TRIPTYCH_CC", "no-such-compiler", 1);
    TEST_ASSERT_NOT_NULL(strstr(engine_unavailable(&engine_external), "TRIPTYCH_CC"));
    expect_error("cannot start the compiler no-such-compiler");
    setenv("TRIPTYCH_CC", "/tmp/no/such/compiler", 1);
    TEST_ASSERT_NOT_NULL(engine_unavailable(&engine_external));
    setenv("TRIPTYCH_CC", "", 1);
    TEST_ASSERT_NULL(engine_unavailable(&engine_external));
}

static void test_the_first_error_of_the_compiler_is_reported(void)
{
    write_compiler("#!/bin/sh\necho 'a warning' >&2\necho 'x.c:7: error: out of vectors' >&2\n"
                   "echo 'error: another' >&2\nexit 3\n");
    expect_error("failed with status 3: x.c:7: error: out of vectors");
    write_compiler("#!/bin/sh\nexit 1\n");
    expect_error("failed with status 1: no message");
    write_compiler("#!/bin/sh\nkill -9 $$\n");
    expect_error("was ended by signal 9");
}

static void test_an_object_that_cannot_be_loaded_is_an_error(void)
{
    write_compiler("#!/bin/sh\nexit 0\n");
    expect_error("cannot load the compiled object");
    write_compiler("#!/bin/sh\nwhile [ \"$1\" != -o ]; do shift; done\n"
                   "echo 'int other;' >\"$2.c\" && cc -shared -fPIC -o \"$2\" \"$2.c\" && rm \"$2.c\"\n");
    expect_error("has no function routine");
}

static void test_a_folder_that_cannot_be_written_is_an_error(void)
{
    setenv("TMPDIR", "/proc/no-such-folder", 1);
    expect_error("cannot make a folder for the compiler");
}

int main(void)
{
    if (!mkdtemp(folder))
        return 1;
    UNITY_BEGIN();
    RUN_TEST(test_every_operation_equals_its_expression);
    RUN_TEST(test_shifts_by_any_number);
    RUN_TEST(test_constants_are_flushed);
    RUN_TEST(test_results_near_the_least_normal_number);
    RUN_TEST(test_random_programs_and_loops);
    RUN_TEST(test_whole_routines_equal_the_emulator);
    RUN_TEST(test_a_routine_has_its_code);
    RUN_TEST(test_without_a_compiler_the_engine_is_unavailable);
    RUN_TEST(test_the_first_error_of_the_compiler_is_reported);
    RUN_TEST(test_an_object_that_cannot_be_loaded_is_an_error);
    RUN_TEST(test_a_folder_that_cannot_be_written_is_an_error);
    char path[sizeof folder + 16];
    snprintf(path, sizeof path, "%s/.compiler", folder);
    unlink(path);
    rmdir(folder);
    return UNITY_END();
}
