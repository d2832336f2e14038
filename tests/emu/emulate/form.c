/* The forms of the emulator: they execute different code, and give the same bytes. */
#define _GNU_SOURCE
#include "emu/emulate/emulate.h"
#include "emu/emulate/routine.h"
#include "engines/list.h"
#include "tests/support/differential/differential.h"
#include "tests/support/system/fault.h"
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
    fault_disarm();
}

static const char *const names[] = {"emulate", "emulate:files=array", "emulate:decode=once",
                                    "emulate:files=array:decode=once"};
enum { NAMES = sizeof names / sizeof *names };

static const struct program *assemble(const char *text)
{
    struct error error = {""};
    struct shader *shader;
    int bad = shader_assemble("shader", text, strlen(text), &shader, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad || shader_validate(shader, NULL, &error), error.text);
    const struct program *program = program_acquire(shader, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, error.text);
    shader_free(shader);
    return program;
}

static struct routine *build(const char *name, const struct program *program, struct error *error)
{
    union key key = {0};
    const struct engine *engine = engine_named(name, error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error->text);
    if (program)
        key_set_program(key.vertex.shader, program->number);
    return engine_build(engine, NULL, UNIT_VERTEX, &key, error);
}

/* Fills in the code and the bytes of data of each form's routine. */
static void build_all(const struct program *program, routine_function *run[NAMES], uint32_t bytes[NAMES])
{
    for (int i = 0; i < NAMES; i++) {
        struct error error = {""};
        struct routine *routine = build(names[i], program, &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
        run[i] = routine->run;
        bytes[i] = routine->data_bytes;
        routine->engine->free(NULL, routine);
    }
}

static void each_form_of_a_shader_is_code_of_its_own(void)
{
    const struct program *program = assemble("vs_2_0\ndcl_position v0\nadd oPos, v0, c255\n");
    routine_function *run[NAMES];
    uint32_t bytes[NAMES];
    build_all(program, run, bytes);
    for (int i = 0; i < NAMES; i++)
        for (int j = 0; j < i; j++)
            TEST_ASSERT_TRUE_MESSAGE(run[i] != run[j], names[i]);
    TEST_ASSERT_EQUAL(bytes[0], bytes[1]);
    TEST_ASSERT_GREATER_THAN(bytes[0], bytes[2]);
    TEST_ASSERT_EQUAL(bytes[2], bytes[3]);
    program_release(program);
}

static void routines_without_a_shader_have_one_form(void)
{
    routine_function *run[NAMES];
    uint32_t bytes[NAMES];
    build_all(NULL, run, bytes);
    for (int i = 1; i < NAMES; i++) {
        TEST_ASSERT_TRUE_MESSAGE(run[i] == run[0], names[i]);
        TEST_ASSERT_EQUAL(bytes[0], bytes[i]);
    }
}

static void a_shader_with_a_constant_beyond_the_array_has_typed_files(void)
{
    const struct program *program = assemble("vs_3_sw\ndcl_position v0\ndcl_position o0\nadd o0, v0, c256\n");
    routine_function *run[NAMES];
    uint32_t bytes[NAMES];
    build_all(program, run, bytes);
    TEST_ASSERT_TRUE(run[1] == run[0]);
    TEST_ASSERT_TRUE(run[3] == run[2] && run[2] != run[0]);
    program_release(program);
}

static void random_routines_are_equal_in_all_forms(void)
{
    enum { ROUNDS = 250 };
    struct differential *differential = differential_create(NULL);
    TEST_ASSERT_NOT_NULL(differential);
    for (unsigned i = 1; i < NAMES; i++)
        for (int unit = UNIT_VERTEX; unit <= UNIT_PIXEL; unit += UNIT_PIXEL - UNIT_VERTEX) {
            const char *difference = differential_rounds(differential, &engine_emulate, engine_find(names[i]),
                                                         unit, NULL, 100 * i + (uint64_t)unit + 1, ROUNDS);
            if (difference)
                TEST_FAIL_MESSAGE(difference);
        }
    differential_destroy(differential);
}

static void memory_for_steps_may_be_refused(void)
{
    const struct program *program = assemble("vs_2_0\ndcl_position v0\nmov oPos, v0\n");
    static const char *const reasons[] = {"out of memory for a routine", "out of memory for the steps"};
    engine_find(names[2]);
    for (unsigned at = 0; at < 2; at++) {
        struct error error = {""};
        fault_arm(at + 1, false);
        struct routine *routine = build(names[2], program, &error);
        fault_disarm();
        TEST_ASSERT_NULL(routine);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, reasons[at]), error.text);
    }
    program_release(program);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_form_of_a_shader_is_code_of_its_own);
    RUN_TEST(routines_without_a_shader_have_one_form);
    RUN_TEST(a_shader_with_a_constant_beyond_the_array_has_typed_files);
    RUN_TEST(random_routines_are_equal_in_all_forms);
    RUN_TEST(memory_for_steps_may_be_refused);
    return UNITY_END();
}
