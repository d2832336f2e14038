/* The writer of random shaders. Its shaders are valid, mostly at the first try. They contain every
 * instruction, modifier, register and kind of flow control of every model. Only the random numbers determine
 * a shader, and the writer is quick. */
#include "command/fuzz/case/shader.h"
#include "shader/program/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unity.h>

enum { SHADERS = 1200, MESSAGE = 512 };

static struct error error;
static char message[MESSAGE];

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static struct shader *make(unsigned model, unsigned number, struct fuzz_shader *made)
{
    struct random random = random_start(model, number);
    const struct fuzz_shader_options options = {0};
    struct shader *shader = fuzz_shader_make(&random, &shader_models[model], &options, made, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(shader, error.text);
    return shader;
}

static void shaders_are_valid_programs(void)
{
    for (unsigned model = 0; model < MODEL_COUNT; model++)
        for (unsigned number = 0; number < SHADERS / 4; number++) {
            struct fuzz_shader made;
            struct shader *shader = make(model, number, &made);
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_validate(shader, NULL, &error), error.text);
            const struct program *program = program_acquire(shader, &error);
            TEST_ASSERT_NOT_NULL_MESSAGE(program, error.text);
            int bad = program_check_integers(program, (const int32_t(*)[4])made.integer, &error);
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad, error.text);
            program_release(program);
            shader_free(shader);
        }
}

/* Their texts are equal. */
static void text_assembles_to_the_same_tokens(void)
{
    for (unsigned model = 0; model < MODEL_COUNT; model++)
        for (unsigned number = 0; number < 50; number++) {
            struct fuzz_shader made;
            struct shader *shader = make(model, number, &made), *again;
            struct random random = random_start(model, number);
            struct text text = {0};
            uint32_t *tokens, *tokens_again;
            size_t count, count_again;
            const struct fuzz_shader_options options = {0};
            TEST_ASSERT_EQUAL_INT(
                0, fuzz_shader_write(&random, &text, "name", shader->model, &options, &made, &error));
            const char *begin = strchr(text.data, '\n') + 1, *end = strrchr(text.data, '}');
            TEST_ASSERT_EQUAL_INT(0, strncmp(text.data, "shader name {\n", 14));
            int bad = shader_assemble("text", begin, (size_t)(end - begin), &again, &error);
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad, error.text);
            TEST_ASSERT_EQUAL_INT(0, shader_encode(shader, &tokens, &count, &error));
            TEST_ASSERT_EQUAL_INT(0, shader_encode(again, &tokens_again, &count_again, &error));
            TEST_ASSERT_EQUAL_UINT64(count, count_again);
            TEST_ASSERT_EQUAL_MEMORY(tokens, tokens_again, count * sizeof *tokens);
            free(tokens);
            free(tokens_again);
            shader_free(shader);
            shader_free(again);
            text_free(&text);
        }
}

/* --- Contents ------------------------------------------------------------------------------------------- */

struct seen {
    unsigned operation[SHADER_COUNT], modifier[MODIFIER_COUNT], comparison[8], kind[8], usage[16];
    unsigned predicate, coissue, relative[FILE_COUNT], saturate, partial, centroid, shift[8], mask[16];
    unsigned read[FILE_COUNT], written[FILE_COUNT];
};

static void look_at_source(struct seen *seen, const struct shader_operand *source)
{
    seen->read[source->file]++;
    seen->modifier[source->modifier]++;
    seen->relative[source->relative]++;
}

static void look_at(struct seen *seen, const struct shader_instruction *at)
{
    const struct shader_operation *row = &shader_operations[at->opcode];
    seen->operation[at->opcode]++;
    seen->comparison[at->comparison]++;
    seen->coissue += at->coissue;
    if (at->opcode == SHADER_DCL) {
        seen->kind[at->kind]++;
        seen->usage[at->usage]++;
        seen->centroid += (at->destination.modifier & RESULT_CENTROID) != 0;
    }
    if (at->predicate.file)
        look_at_source(seen, &at->predicate);
    seen->predicate += at->predicate.file != 0;
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++)
        look_at_source(seen, &at->source[i]);
    if (!row->destination)
        return;
    seen->written[at->destination.file]++;
    seen->saturate += (at->destination.modifier & RESULT_SATURATE) != 0;
    seen->partial += (at->destination.modifier & RESULT_PARTIAL) != 0;
    seen->shift[at->destination.shift + 3]++;
    seen->mask[at->destination.swizzle]++;
}

static bool has(const struct shader_model *model, const struct shader_operation *row)
{
    return shader_slots(row, model) >= 0 &&
           !(row->flags & IS_DIFFERENCE && !(model->capabilities & CAN_DIFFERENCE)) &&
           !(row->flags & IS_PREDICATES && !(model->capabilities & CAN_PREDICATION)) &&
           !(row->flags & IS_FLOW && !model->loops) && !(row->flags & IS_DYNAMIC && !model->dynamic) &&
           !((row->destination == OPERAND_CONSTANT_INTEGER || row->destination == OPERAND_CONSTANT_BOOLEAN) &&
             !model->loops);
}

/* Modifiers that operands of the model's arithmetic or flow control can have. */
static bool has_modifier(const struct shader_model *model, unsigned modifier)
{
    return shader_modifiers[modifier].columns[model->column] != '.' &&
           (modifier != MODIFIER_NOT || model->loops);
}

static void expect_seen(const struct shader_model *model, const char *what, unsigned count)
{
    snprintf(message, sizeof message, "%s: no %s in %d shaders", model->name, what, SHADERS);
    TEST_ASSERT_TRUE_MESSAGE(count > 0, message);
}

static void expect_all(const struct shader_model *model, const struct seen *seen)
{
    bool pixel = model->stage == STAGE_PIXEL, narrow = shader_is_narrow(model);
    for (unsigned i = 0; i < SHADER_COUNT; i++)
        if (has(model, &shader_operations[i]))
            expect_seen(model, shader_operations[i].name, seen->operation[i]);
    for (unsigned i = 0; i < MODIFIER_COUNT; i++)
        if (has_modifier(model, i))
            expect_seen(model, shader_modifiers[i].meaning, seen->modifier[i]);
    for (unsigned i = 1; i <= 6 && model->dynamic; i++)
        expect_seen(model, shader_word_name(shader_comparisons, i), seen->comparison[i]);
    for (unsigned i = 1; i < FILE_COUNT; i++) {
        const struct shader_register *row = &shader_registers[i];
        bool flow = i == FILE_INTEGER || i == FILE_BOOLEAN || i == FILE_LABEL || i == FILE_LOOP;
        if (!shader_register_count(i, model) || (flow && !model->loops))
            continue;
        if (i == FILE_PREDICATE ? !(model->capabilities & CAN_PREDICATION) : false)
            continue;
        expect_seen(model, row->name,
                    row->access & CAN_WRITE || i == FILE_TEXTURE ? seen->written[i] : seen->read[i]);
    }
    if (model->capabilities & CAN_PREDICATION)
        expect_seen(model, "predicate", seen->predicate);
    if (pixel && !narrow) {
        expect_seen(model, "_pp", seen->partial);
        expect_seen(model, "_centroid", seen->centroid);
        for (unsigned kind = 2; kind <= 4; kind++)
            expect_seen(model, shader_word_name(shader_kinds, kind), seen->kind[kind]);
    }
    if (pixel || shader_major(model) == 3)
        expect_seen(model, "_sat", seen->saturate);
    if (narrow) {
        expect_seen(model, "pair", seen->coissue);
        expect_seen(model, "_d2", seen->shift[2]);
        expect_seen(model, "_x4", seen->shift[5]);
    } else {
        for (unsigned mask = 1; mask < 16; mask++)
            expect_seen(model, "mask", seen->mask[mask]);
    }
    if (!pixel)
        expect_seen(model, "a0 as an index", seen->relative[FILE_ADDRESS]);
    if (shader_register_count(FILE_LOOP, model) && model->loops)
        expect_seen(model, "aL as an index", seen->relative[FILE_LOOP]);
    for (unsigned usage = 0; usage <= USAGE_SAMPLE && shader_has_usage(FILE_INPUT, model); usage++)
        if (usage != USAGE_POSITIONT)
            expect_seen(model, shader_word_name(shader_usages, usage), seen->usage[usage]);
}

static void shaders_of_every_model_contain_everything(void)
{
    for (unsigned model = 0; model < MODEL_COUNT; model++) {
        struct seen seen;
        memset(&seen, 0, sizeof seen);
        for (unsigned number = 0; number < SHADERS; number++) {
            struct fuzz_shader made;
            struct shader *shader = make(model, number, &made);
            for (uint32_t i = 0; i < shader->count; i++)
                look_at(&seen, &shader->instructions[i]);
            shader_free(shader);
        }
        expect_all(&shader_models[model], &seen);
    }
}

/* --- Lengths and numbers -------------------------------------------------------------------------------- */

static int compare_numbers(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* Refused shaders cost time and make the rest less random. Most shaders must be short, so that a campaign can
 * draw many. */
static void few_are_refused_and_most_are_short(void)
{
    for (unsigned model = 0; model < MODEL_COUNT; model++) {
        unsigned proposed = 0, refused = 0, discarded = 0;
        static int lengths[SHADERS];
        clock_t start = clock();
        for (unsigned number = 0; number < SHADERS; number++) {
            struct fuzz_shader made;
            shader_free(make(model, number, &made));
            proposed += made.proposed;
            refused += made.refused;
            discarded += made.discarded;
            lengths[number] = (int)made.instructions;
        }
        double seconds = (double)(clock() - start) / CLOCKS_PER_SEC / SHADERS;
        qsort(lengths, SHADERS, sizeof *lengths, compare_numbers);
        snprintf(message, sizeof message,
                 "%s: %u of %u refused, %u discarded, lengths %d to %d, median %d, %.1f us",
                 shader_models[model].name, refused, proposed, discarded, lengths[0], lengths[SHADERS - 1],
                 lengths[SHADERS / 2], seconds * 1e6);
        if (getenv("TRIPTYCH_REPORT"))
            puts(message);
        TEST_ASSERT_TRUE_MESSAGE(refused <= proposed / 20, message);
        TEST_ASSERT_TRUE_MESSAGE(discarded <= SHADERS / 100, message);
        TEST_ASSERT_TRUE_MESSAGE(lengths[SHADERS / 2] >= 6 && lengths[SHADERS / 2] <= 24, message);
        TEST_ASSERT_TRUE_MESSAGE(shader_is_narrow(&shader_models[model]) || lengths[SHADERS - 1] > 50,
                                 message);
        TEST_ASSERT_TRUE_MESSAGE(seconds < 0.005, message);
    }
}

static void equal_numbers_give_equal_shaders_and_others_different_ones(void)
{
    const struct fuzz_shader_options options = {0};
    for (unsigned number = 0; number < 200; number++) {
        struct text first = {0}, second = {0};
        struct fuzz_shader vertex, pixel;
        struct random random = random_start(7, number), again = random_start(7, number);
        TEST_ASSERT_EQUAL_INT(0,
                              fuzz_shader_pair(&random, &first, "v", "p", &options, &vertex, &pixel, &error));
        TEST_ASSERT_EQUAL_INT(0,
                              fuzz_shader_pair(&again, &second, "v", "p", &options, &vertex, &pixel, &error));
        TEST_ASSERT_EQUAL_STRING(first.data, second.data);
        TEST_ASSERT_EQUAL_UINT64(random.state, again.state);
        text_free(&first);
        text_free(&second);
    }
}

/* --- Pairs ---------------------------------------------------------------------------------------------- */

static bool is_given(const struct shader_interface *vertex, const struct shader_port *asked)
{
    for (unsigned i = 0; i < vertex->output_count; i++)
        if (vertex->outputs[i].usage == asked->usage && vertex->outputs[i].usage_index == asked->usage_index)
            return true;
    return false;
}

static void a_pixel_shader_reads_some_outputs_of_its_vertex_shader(void)
{
    unsigned met = 0, missed = 0, third = 0, mixed = 0;
    const struct fuzz_shader_options options = {0};
    for (unsigned number = 0; number < SHADERS; number++) {
        struct text text = {0};
        struct fuzz_shader vertex, pixel;
        struct random random = random_start(11, number);
        TEST_ASSERT_EQUAL_INT(0,
                              fuzz_shader_pair(&random, &text, "v", "p", &options, &vertex, &pixel, &error));
        text_free(&text);
        TEST_ASSERT_EQUAL_INT(STAGE_VERTEX, vertex.model->stage);
        TEST_ASSERT_EQUAL_INT(STAGE_PIXEL, pixel.model->stage);
        for (unsigned i = 0; i < pixel.interface.input_count; i++)
            *(is_given(&vertex.interface, &pixel.interface.inputs[i]) ? &met : &missed) += 1;
        bool both = shader_major(vertex.model) == 3 && shader_major(pixel.model) == 3;
        third += both;
        mixed += !both && (shader_major(vertex.model) == 3 || shader_major(pixel.model) == 3);
    }
    TEST_ASSERT_TRUE(met > missed);
    TEST_ASSERT_TRUE(missed > met / 20);
    TEST_ASSERT_TRUE(third > SHADERS / 20);
    TEST_ASSERT_TRUE(mixed > 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(shaders_are_valid_programs);
    RUN_TEST(text_assembles_to_the_same_tokens);
    RUN_TEST(shaders_of_every_model_contain_everything);
    RUN_TEST(few_are_refused_and_most_are_short);
    RUN_TEST(equal_numbers_give_equal_shaders_and_others_different_ones);
    RUN_TEST(a_pixel_shader_reads_some_outputs_of_its_vertex_shader);
    return UNITY_END();
}
