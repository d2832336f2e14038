/* Random shaders of many instructions give the same bits in every way and on every engine. They have
 * conditions, loops, breaks, predication, relative addresses, modifiers and masks. */
#include "command/fuzz/case/shader.h"
#include "tests/support/system/seed.h"
#include "tests/support/trial/trial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REGISTERS = 8, CONSTANTS = 8, SETS = 40, SHADERS = 24, BOOLEANS = 16 };

static struct error error;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

/* Adds instructions that initialize the registers that the trial does not set. */
static void add_beginning(struct text *text, const struct shader_model *model)
{
    for (unsigned r = 0; r < REGISTERS; r++)
        if (r < 1 || r > TRIAL_OPERANDS)
            text_add(text, "mov r%u, r%u.%s\n", r, 1 + r % 3, r % 2 ? "wzyx" : "yzwx");
    text_add(text, "setp_ge p0, r1, r2\n%s",
             model->stage == STAGE_VERTEX || shader_is_opengl(model) ? "mova a0, r2\n" : "");
}

/* Splits the lines into definitions, which must be before all other instructions, and the body. */
static void split(const char *lines, struct text *setup, struct text *body)
{
    for (const char *end; *lines; lines = end) {
        end = strchr(lines, '\n') + 1;
        text_add_bytes(strncmp(lines, "def", 3) ? body : setup, lines, (size_t)(end - lines));
    }
}

static void add_random_shader(struct random *random, const struct shader_model *model, unsigned instructions,
                              struct text *setup, struct text *body, struct fuzz_shader *made)
{
    const struct fuzz_shader_options options = {.instructions = instructions,
                                                .constants = CONSTANTS,
                                                .wild = random_chance(random, 2),
                                                .registers = (1 << REGISTERS) - 1};
    char *lines;
    size_t bytes;
    struct shader *shader = fuzz_shader_make(random, model, &options, made, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(shader, error.text);
    TEST_ASSERT_EQUAL_INT(0, shader_print(shader, &lines, &bytes, &error));
    split(strchr(lines, '\n') + 1, setup, body);
    free(lines);
    shader_free(shader);
}

static void try_shader(const char *name, unsigned number)
{
    static float constants[CONSTANTS][4];
    static struct trial_operands operands[SETS];
    const struct shader_model *model = trial_model(name);
    struct random random = random_start(test_seed(), number);
    struct text setup = {0}, body = {0};
    struct fuzz_shader made;
    for (unsigned i = 0; i < CONSTANTS * 4; i++)
        constants[i / 4][i % 4] = random_float(&random, -4, 4);
    for (unsigned s = 0; s < SETS; s++)
        operands[s] = s < SETS / 2 ? trial_edges[random_below(&random, trial_edge_sets)]
                                   : trial_ordinary[random_below(&random, trial_ordinary_sets)];
    add_beginning(&body, model);
    unsigned most = shader_major(model) < 3 ? 10 : number % 8 ? 30 : 90;
    add_random_shader(&random, model, 10 + random_below(&random, most), &setup, &body, &made);
    TEST_ASSERT_FALSE(setup.failed || body.failed);
    text_cut(&body, body.length - 1);
    struct trial trial = {.model = name,
                          .setup = setup.data,
                          .body = body.data,
                          .results = 4,
                          .sets = SETS,
                          .operands = operands,
                          .constant = (const float(*)[4])constants,
                          .constants = CONSTANTS,
                          .integer = (const int32_t(*)[4])made.integer,
                          .integers = FUZZ_SHADER_INTEGERS,
                          .booleans = random_below(&random, 1 << BOOLEANS),
                          .legacy = number % 3 == 0};
    trial_expect_agreement(&trial);
    text_free(&setup);
    text_free(&body);
}

static void random_vertex_shaders_give_the_same_results_everywhere(void)
{
    for (unsigned number = 1; number <= SHADERS; number++)
        try_shader(number % 4 ? "vs_3_0" : "vs_2_x", number);
}

static void random_pixel_shaders_give_the_same_results_everywhere(void)
{
    for (unsigned number = 1; number <= SHADERS; number++)
        try_shader(number % 4 ? "ps_3_0" : "ps_2_x", SHADERS + number);
}

static void random_shaders_of_opengl_give_the_same_results_everywhere(void)
{
    for (unsigned number = 1; number <= SHADERS / 2; number++)
        try_shader(number % 2 ? "vs_gl" : "ps_gl", 2 * SHADERS + number);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(random_vertex_shaders_give_the_same_results_everywhere);
    RUN_TEST(random_pixel_shaders_give_the_same_results_everywhere);
    RUN_TEST(random_shaders_of_opengl_give_the_same_results_everywhere);
    return UNITY_END();
}
