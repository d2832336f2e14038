/* Text and bytecode are equivalent. Every instruction of every model, with every modifier, is converted to
 * tokens and back and to text and back, and must be the same shader. */
#include "shader/shader.h"
#include "tests/support/shader/shaders.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { VARIANTS = 60 };

static struct error error;
static uint64_t seed;

void setUp(void)
{
    error_clear(&error);
    seed = 0x9e3779b97f4a7c15;
}

void tearDown(void)
{
}

static uint32_t *encode(const struct shader *shader, size_t *count)
{
    uint32_t *tokens;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_encode(shader, &tokens, count, &error), error.text);
    return tokens;
}

static char *print(const struct shader *shader)
{
    char *text;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_print(shader, &text, &bytes, &error), error.text);
    TEST_ASSERT_EQUAL_UINT64(strlen(text), bytes);
    return text;
}

/* Returns the text after its first line, the model's name. Bytecode does not distinguish the names vs_2_a,
 * ps_2_a and ps_2_b. */
static const char *behind_version(const char *text)
{
    return strchr(text, '\n') + 1;
}

static void expect_same(const struct shader *shader)
{
    struct shader *from_text, *from_tokens;
    size_t count, again;
    char *text = print(shader);
    uint32_t *tokens = encode(shader, &count);
    int bad = shader_assemble("text", text, strlen(text), &from_text, &error);
    if (bad)
        fputs(text, stderr);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad, error.text);
    TEST_ASSERT_EQUAL_PTR(shader->model, from_text->model);
    bad = shader_read("tokens", tokens, count * sizeof *tokens, &from_tokens, &error);
    if (bad)
        fputs(text, stderr);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad, error.text);

    uint32_t *tokens_again = encode(from_text, &again);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(count, again, text);
    TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(tokens, tokens_again, count, text);
    char *text_again = print(from_tokens);
    TEST_ASSERT_EQUAL_STRING(behind_version(text), behind_version(text_again));
    free(tokens_again);
    free(text_again);
    free(tokens);
    free(text);
    shader_free(from_text);
    shader_free(from_tokens);
}

static void every_instruction_of_every_model_is_unchanged(void)
{
    unsigned pairs = 0;
    for (unsigned m = 0; m < MODEL_COUNT; m++)
        for (unsigned opcode = 0; opcode < SHADER_COUNT; opcode++) {
            if (shader_slots(&shader_operations[opcode], &shader_models[m]) < 0)
                continue;
            struct shader *shader = shader_blank(&shader_models[m]);
            for (int i = 0; i < VARIANTS; i++)
                shader_add_random(shader, opcode, &seed);
            expect_same(shader);
            shader_free(shader);
            pairs++;
        }
    TEST_ASSERT_TRUE(pairs > 700);
}

static void every_source_modifier_is_unchanged(void)
{
    for (unsigned m = 0; m < MODEL_COUNT; m++) {
        struct shader *shader = shader_blank(&shader_models[m]);
        for (unsigned modifier = 0; modifier < MODIFIER_COUNT; modifier++) {
            if (shader_modifiers[modifier].columns[shader_models[m].column] == '.')
                continue;
            for (unsigned swizzle = 0; swizzle < 256; swizzle++) {
                shader_add_random(shader, SHADER_MOV, &seed);
                shader->instructions[shader->count - 1].source[0].modifier = (uint8_t)modifier;
                shader->instructions[shader->count - 1].source[0].swizzle = (uint8_t)swizzle;
            }
        }
        expect_same(shader);
        shader_free(shader);
    }
}

static void every_result_modifier_is_unchanged(void)
{
    for (unsigned m = 0; m < MODEL_COUNT; m++) {
        struct shader *shader = shader_blank(&shader_models[m]);
        for (int shift = -3; shift <= 3; shift++)
            for (unsigned modifier = 0; modifier < 8; modifier++)
                for (unsigned mask = 1; mask < 16; mask++) {
                    shader_add_random(shader, SHADER_ADD, &seed);
                    struct shader_operand *result = &shader->instructions[shader->count - 1].destination;
                    result->shift = (int8_t)shift;
                    result->modifier = (uint8_t)modifier;
                    result->swizzle = (uint8_t)mask;
                }
        expect_same(shader);
        shader_free(shader);
    }
}

static void every_register_is_unchanged(void)
{
    for (unsigned m = 0; m < MODEL_COUNT; m++) {
        struct shader *shader = shader_blank(&shader_models[m]);
        for (unsigned file = 1; file < FILE_COUNT; file++)
            for (unsigned index = 0; index < shader_register_count(file, &shader_models[m]); index++) {
                shader_add_random(shader, SHADER_MOV, &seed);
                struct shader_operand *source = &shader->instructions[shader->count - 1].source[0];
                *source =
                    (struct shader_operand){.file = (uint8_t)file, .index = (uint16_t)index, .swizzle = 0xe4};
            }
        expect_same(shader);
        shader_free(shader);
    }
}

static void special_numbers_are_unchanged(void)
{
    static const uint32_t numbers[] = {0,          0x80000000, 1,          0x80000001, 0x007fffff,
                                       0x00800000, 0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000,
                                       0x7fc00000, 0xffc12345, 0x3f800000, 0x3f7fffff, 0x34000000,
                                       0x3eaaaaab, 0x42c80000, 0x4b800001};
    struct shader *shader = shader_blank(&shader_models[MODEL_PS_2_0]);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        shader_add_random(shader, SHADER_DEF, &seed);
        for (int j = 0; j < 4; j++)
            shader->instructions[i].literal[j] = numbers[i] ^ (uint32_t)j;
    }
    expect_same(shader);
    shader_free(shader);
}

/* A compiler's output: a comment of another kind, then a table that names four constants and one integer. */
static struct {
    uint32_t version, other_comment, other, comment;
    char letters[4];
    uint32_t header[7];
    struct {
        uint32_t name;
        uint16_t set, index, count, reserved;
        uint32_t type, value;
    } constants[2];
    char strings[16];
    uint32_t end;
} compiled = {0xffff0200,
              0x0001fffe,
              0x12345678,
              0x0016fffe,
              "CTAB",
              {28, 0, 0xffff0200, 2, 28, 0, 0},
              {{69, 2, 5, 4, 0, 0, 0}, {76, 1, 3, 1, 0, 0, 0}},
              "\0Colors\0light",
              0xffff};

static void names_come_from_the_constant_table(void)
{
    struct shader *shader;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_read("ctab", &compiled, sizeof compiled, &shader, &error),
                                  error.text);
    char *text = print(shader);
    TEST_ASSERT_EQUAL_STRING("ps_2_0\n; c5 to c8: Colors\n; i3: light\n", text);
    free(text);
    shader_free(shader);
}

static void a_constant_table_that_points_outside_is_refused(void)
{
    struct shader *shader;
    compiled.constants[1].name = 84;
    TEST_ASSERT_EQUAL_INT(-1, shader_read("ctab", &compiled, sizeof compiled, &shader, &error));
    TEST_ASSERT_EQUAL_STRING("ctab: token 4: found a broken entry 1 of the constant table", error.text);
    error_clear(&error);
    compiled.header[3] = 4;
    TEST_ASSERT_EQUAL_INT(-1, shader_read("ctab", &compiled, sizeof compiled, &shader, &error));
    TEST_ASSERT_EQUAL_STRING_LEN("ctab: token 4: found a broken constant table", error.text, 44);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_instruction_of_every_model_is_unchanged);
    RUN_TEST(every_source_modifier_is_unchanged);
    RUN_TEST(every_result_modifier_is_unchanged);
    RUN_TEST(every_register_is_unchanged);
    RUN_TEST(special_numbers_are_unchanged);
    RUN_TEST(names_come_from_the_constant_table);
    RUN_TEST(a_constant_table_that_points_outside_is_refused);
    return UNITY_END();
}
