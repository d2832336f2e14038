/* Recordings with places: the same instructions as the recorder's, each with the chain of lines that led to
 * it, which the text of the specification confirms. */
#include "command/explore/embed.h"
#include "command/explore/record.h"
#include "shader/shader.h"
#include "tests/support/shader/random_key.h"
#include "tests/support/system/seed.h"

#include <unity.h>

#include <stdio.h>
#include <string.h>

enum { KEYS = 60 };

static struct explore_recording recording;
static struct ir *expected;
static char message[400];

void setUp(void)
{
}

void tearDown(void)
{
    explore_record_free(&recording);
    if (expected)
        ir_give(expected);
    expected = NULL;
}

static void record(enum unit unit, const union key *key)
{
    struct error error = {""};
    TEST_ASSERT_EQUAL_MESSAGE(0, explore_record(&recording, unit, key, &error), error.text);
}

static void check_instruction(const struct ir_instruction *a, const struct ir_instruction *b)
{
    TEST_ASSERT_EQUAL(a->op, b->op);
    TEST_ASSERT_EQUAL(a->type, b->type);
    TEST_ASSERT_EQUAL(a->base, b->base);
    TEST_ASSERT_EQUAL(a->scale, b->scale);
    TEST_ASSERT_EQUAL(a->k, b->k);
    TEST_ASSERT_EQUAL(a->field, b->field);
    TEST_ASSERT_EQUAL(a->line, b->line);
    TEST_ASSERT_EQUAL(a->origin, b->origin);
    TEST_ASSERT_EQUAL_MEMORY(a->operand, b->operand, sizeof a->operand);
}

static void check_recording(enum unit unit, const union key *key)
{
    struct error error = {""};
    record(unit, key);
    expected = ir_take(unit, key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(expected, error.text);
    TEST_ASSERT_EQUAL(expected->count, recording.ir->count);
    for (uint32_t n = 1; n < expected->count; n++)
        check_instruction(&expected->instruction[n], &recording.ir->instruction[n]);
    tearDown();
}

static void for_random_keys(void (*check)(enum unit unit, const union key *key))
{
    uint64_t seed = 0x9e3779b97f4a7c15;
    for (unsigned n = 0; n < test_share_of(KEYS, 8); n++)
        for (enum unit unit = 0; unit < UNIT_COUNT; unit++) {
            union key key;
            key_random(unit, &seed, &key);
            check(unit, &key);
        }
}

static void a_recording_with_places_has_the_instructions_of_the_recorder(void)
{
    for_random_keys(check_recording);
}

static const char *line_of(const char *text, uint32_t line, size_t *length)
{
    for (uint32_t at = 1; text && at < line; at++)
        text = strchr(text, '\n') + 1;
    *length = text ? strcspn(text, "\n") : 0;
    return text;
}

/* The line of the call, or the one before if the arguments begin a new line, has the function's name. */
static void check_call(const struct explore_place *caller, const char *function)
{
    const char *text = embed_spec_text(caller->file);
    TEST_ASSERT_NOT_NULL_MESSAGE(text, caller->file);
    for (uint32_t line = caller->line; line + 2 > caller->line; line--) {
        size_t length;
        const char *at = line_of(text, line, &length);
        const char *found = strstr(at, function);
        if (found && found < at + length)
            return;
    }
    snprintf(message, sizeof message, "%s:%u has no call of %s", caller->file, caller->line, function);
    TEST_FAIL_MESSAGE(message);
}

static void check_places(enum unit unit, const union key *key)
{
    record(unit, key);
    for (uint32_t n = 1; n < recording.ir->count; n++) {
        const struct ir_instruction *i = &recording.ir->instruction[n];
        uint32_t at = recording.place[n];
        TEST_ASSERT_NOT_EQUAL(EXPLORE_NO_PLACE, at);
        const struct explore_place *place = &recording.places[at];
        TEST_ASSERT_EQUAL_STRING(recording.ir->file[i->file], place->file);
        TEST_ASSERT_EQUAL(i->line, place->line);
        for (; place->caller != EXPLORE_NO_PLACE; place = &recording.places[place->caller])
            check_call(&recording.places[place->caller], place->function);
        snprintf(message, sizeof message, "spec_%s", unit_name[unit]);
        TEST_ASSERT_EQUAL_STRING(message, place->function);
    }
    tearDown();
}

static void every_place_is_reached_by_calls_from_the_unit(void)
{
    for_random_keys(check_places);
}

static const char shader_text[] = "ps_3_0\n"
                                  "def c0, 0.5, 1, 2, 3\n"
                                  "dcl_texcoord v0\n"
                                  "mul r0, v0, c0\n"
                                  "if_gt r0.x, c0.y\n"
                                  "add r0, r0, c0.z\n"
                                  "endif\n"
                                  "mov oC0, r0\n";

static void every_line_of_a_shader_that_computes_records_operations(void)
{
    static const bool records[] = {false, false, false, true, true, true, false, false};
    struct error error = {""};
    struct shader *shader;
    struct program_text text;
    union key key = {.pixel = {.write_mask = {15}, .float_color = 1}};
    TEST_ASSERT_EQUAL_MESSAGE(0, shader_assemble("t", shader_text, sizeof shader_text - 1, &shader, &error),
                              error.text);
    const struct program *program = program_acquire(shader, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, error.text);
    shader_free(shader);
    key_set_program(key.pixel.shader, program->number);
    record(UNIT_PIXEL, &key);
    TEST_ASSERT_EQUAL_MESSAGE(0, program_text_open(program, &text, &error), error.text);
    bool found[8] = {false};
    for (uint32_t n = 1; n < recording.ir->count; n++) {
        uint32_t step = ir_step_of(recording.ir, n);
        if (step != NO_STEP)
            found[text.line_of_step[step] - 1] = true;
    }
    TEST_ASSERT_EQUAL(8, text.lines);
    TEST_ASSERT_EQUAL_STRING("add r0, r0, c0.z", text.line[5]);
    TEST_ASSERT_EQUAL_MEMORY(records, found, sizeof found);
    program_text_free(&text);
    program_release(program);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_recording_with_places_has_the_instructions_of_the_recorder);
    RUN_TEST(every_place_is_reached_by_calls_from_the_unit);
    RUN_TEST(every_line_of_a_shader_that_computes_records_operations);
    return UNITY_END();
}
