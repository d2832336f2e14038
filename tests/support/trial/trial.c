#include "tests/support/trial/trial.h"

#include "base/bits.h"
#include "contract/lane.h"
#include "contract/engine.h"
#include "engines/list.h"
#include "shader/program/program.h"
#include "tests/support/system/seed.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

enum { TEXT = 1 << 16, MESSAGE = 4096, INTEGERS = 16, RESULTS = 1024, CONSTANTS = 256, FEW_SETS = 20 };

static const float edge[] = {
    0.0f,    -0.0f,         1.0f,           -1.0f,           0.5f,        -0.5f,        2.0f,
    -3.0f,   0.4999999702f, 0.50000006f,    1e-39f,          -1e-39f,     FLT_MIN,      -FLT_MIN,
    FLT_MAX, -FLT_MAX,      INFINITY,       -INFINITY,       NAN,         1e-20f,       1e20f,
    -7.75f,  0x1p23f,       0x1.000002p+0f, -0x1.fffffep-1f, 3.14159274f, -1.57079637f, 127.5f,
    -126.5f, 1e9f,          255.0f};
enum { EDGES = sizeof edge / sizeof *edge, EDGE_SETS = (EDGES * EDGES + 3) / 4, ORDINARY_SETS = 100 };

static struct trial_operands sets[EDGE_SETS + ORDINARY_SETS];
const struct trial_operands *trial_edges = sets;
const unsigned trial_edge_sets = EDGE_SETS + ORDINARY_SETS;
const struct trial_operands *trial_ordinary = sets + EDGE_SETS;
const unsigned trial_ordinary_sets = ORDINARY_SETS;

static double between(double low, double high)
{
    static uint64_t seed = 88172645463325252ull;
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return low + (high - low) * (double)(seed >> 40) / 16777216.0;
}

static void __attribute__((constructor)) make_sets(void)
{
    for (unsigned s = 0; s < EDGE_SETS; s++)
        for (unsigned c = 0; c < 4; c++) {
            unsigned pair = 4 * s + c;
            sets[s].v[0][c] = edge[pair / EDGES % EDGES];
            sets[s].v[1][c] = edge[pair % EDGES];
            sets[s].v[2][c] = edge[(pair * 7 + pair / EDGES) % EDGES];
        }
    for (unsigned s = EDGE_SETS; s < EDGE_SETS + ORDINARY_SETS; s++)
        for (unsigned o = 0; o < TRIAL_OPERANDS; o++)
            for (unsigned c = 0; c < 4; c++)
                sets[s].v[o][c] = (float)between(-4, 4);
}

/* --- Numbers ----------------------------------------------------------------------------------------------
 */

float trial_round(double value)
{
    /* A value is flushed if it is less than FLT_MIN after rounding to 24 bits with an unbounded exponent. */
    if (fabs(value) < 1 && fabsf((float)(value * 0x1p64)) < FLT_MIN * 0x1p64f)
        return copysignf(0, (float)value);
    return (float)value;
}

double trial_flush(float value)
{
    return (double)lane_flush(value);
}

double trial_fused(double a, double b, double c)
{
    double product = a * b, sum = product + c, virtual = sum - product;
    double error = (product - (sum - virtual)) + (c - virtual);
    uint64_t bits;
    if (!isfinite(sum) || error == 0)
        return sum;
    memcpy(&bits, &sum, sizeof bits);
    if (!(bits & 1))
        return nextafter(sum, error > 0 ? INFINITY : -INFINITY);
    return sum;
}

/* --- The shader -------------------------------------------------------------------------------------------
 */

static void append(char *text, const char *line)
{
    TEST_ASSERT_TRUE(strlen(text) + strlen(line) < TEXT);
    strcat(text, line);
}

static void append_number(char *text, const char *format, unsigned number)
{
    char line[80];
    snprintf(line, sizeof line, format, number, number);
    append(text, line);
}

/* The lines by which a shader of a model reads its operands and writes its results. */
struct frame {
    const char *coordinates;           /* a line, or null */
    const char *declare, *give, *take; /* lines for an operand, or a result, by its number; null: none */
    const char *names[TRIAL_OPERANDS]; /* of operands in the body, in ps_1_x, which does not move them */
};

/* Operands are inputs, or texels for pixel shaders in draws (`textured`). */
static struct frame frame_of(const struct shader_model *model, int textured)
{
    int third = shader_major(model) == 3;
    if (model->stage == STAGE_VERTEX)
        return (struct frame){.declare = "dcl_texcoord%u v%u\n",
                              .give = "mov r%u, v%u\n",
                              .take = third ? "mov o%u, r%u\n" : "mov oT%u, r%u\n"};
    if (shader_major(model) > 1 && textured)
        return (struct frame){.coordinates = third ? "dcl_texcoord v0.xy\n" : "dcl t0.xy\n",
                              .declare = "dcl_2d s%u\n",
                              .give = third ? "texld r%u, v0, s%u\n" : "texld r%u, t0, s%u\n",
                              .take = "mov oC%u, r%u\n"};
    if (shader_major(model) > 1)
        return (struct frame){.declare = third ? "dcl_texcoord%u v%u\n" : "dcl t%u\n",
                              .give = third ? "mov r%u, v%u\n" : "mov r%u, t%u\n",
                              .take = "mov oC%u, r%u\n"};
    if (!textured)
        return (struct frame){.names = {"v0", "v1"}};
    if (model->column == COLUMN_PS_1_4)
        return (struct frame){.give = "texld r%u, t%u\n", .names = {"r1", "r2"}};
    return (struct frame){.give = "tex t%u\n", .names = {"t1", "t2"}};
}

/* Replaces $1 and $2 by the operands' names. */
static void append_body(char *text, const char *body, const char *const names[TRIAL_OPERANDS])
{
    char letter[2] = "";
    for (; *body; body++)
        if (*body == '$') {
            append(text, names[*++body - '1']);
        } else {
            letter[0] = *body;
            append(text, letter);
        }
    append(text, "\n");
}

static void append_results(char *text, const struct trial *trial, const struct shader_model *model,
                           const char *take)
{
    int vertices = model->stage == STAGE_VERTEX, third = shader_major(model) == 3;
    for (unsigned r = 0; r < trial->results && take && !trial->gives; r++) {
        char line[80];
        snprintf(line, sizeof line, take, r + (vertices && third), r ? r + 3 : 0);
        append(text, line);
    }
    if (vertices)
        append(text, third ? "mov o0, r1\n" : "mov oPos, r1\n");
}

/* Defines c11 to c13 by their bits. */
static void define_operands(const struct trial *trial, char *text)
{
    char line[80];
    TEST_ASSERT_EQUAL_UINT(1, trial->sets);
    for (unsigned o = 0; o < TRIAL_OPERANDS; o++) {
        const float *v = trial->operands->v[o];
        snprintf(line, sizeof line, "def c1%u, 0x%08x, 0x%08x, 0x%08x, 0x%08x\n", o + 1, bits_of_float(v[0]),
                 bits_of_float(v[1]), bits_of_float(v[2]), bits_of_float(v[3]));
        append(text, line);
    }
}

static void make_text(const struct trial *trial, const struct shader_model *model, int textured, char *text)
{
    struct frame frame = frame_of(model, textured);
    if (trial->literal)
        frame = (struct frame){.give = "mov r%u, c1%u\n", .take = frame.take};
    unsigned operands = frame.names[0] ? 2 : TRIAL_OPERANDS;
    snprintf(text, TEXT, "%s\n", model->name);
    append(text, frame.coordinates ? frame.coordinates : "");
    for (unsigned o = 1; o <= operands && frame.declare; o++)
        append_number(text, frame.declare, o);
    if (model->stage == STAGE_VERTEX && shader_major(model) == 3) {
        append(text, "dcl_position o0\n");
        for (unsigned r = 0; r < trial->results; r++) {
            append_number(text, "dcl_texcoord%u o", r);
            append_number(text, "%u\n", r + 1);
        }
    }
    append(text, trial->setup ? trial->setup : "");
    if (trial->literal)
        define_operands(trial, text);
    for (unsigned o = 1; o <= operands && frame.give; o++)
        append_number(text, frame.give, o);
    append_body(text, trial->body, frame.names);
    append_results(text, trial, model, frame.take);
    append(text, trial->after ? trial->after : "");
}

const struct shader_model *trial_model(const char *name)
{
    for (int m = 0; m < MODEL_COUNT; m++)
        if (!strcmp(shader_models[m].name, name))
            return &shader_models[m];
    TEST_FAIL_MESSAGE(name);
    return NULL;
}

static const struct program *make_program(const char *text)
{
    static char message[TEXT + MESSAGE];
    struct error error = {{0}};
    struct shader *shader;
    const struct program *program = NULL;
    if (!shader_assemble("trial", text, strlen(text), &shader, &error) &&
        !shader_validate(shader, NULL, &error))
        program = program_acquire(shader, &error);
    shader_free(shader);
    snprintf(message, sizeof message, "%s\n%s", error.text, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, message);
    return program;
}

/* --- Comparison -------------------------------------------------------------------------------------------
 */

/* The largest allowed difference from the expected result. */
struct tolerance {
    double relative, absolute;
};

static int agrees(float got, double expected, const struct tolerance *tolerance)
{
    float rounded = trial_round(expected);
    if (isnan(expected))
        return isnan(got);
    if (bits_of_float(lane_flush(got)) == bits_of_float(rounded))
        return 1;
    return isfinite(got) && isfinite(rounded) &&
           fabs((double)got - expected) <= tolerance->relative * fabs(expected) + tolerance->absolute;
}

static void print_operands(const struct trial_operands *operands, char *text, size_t bytes)
{
    size_t used = 0;
    for (unsigned o = 0; o < TRIAL_OPERANDS; o++)
        used += (size_t)snprintf(text + used, bytes - used, "  r%u = %.9g, %.9g, %.9g, %.9g\n", o + 1,
                                 (double)operands->v[o][0], (double)operands->v[o][1],
                                 (double)operands->v[o][2], (double)operands->v[o][3]);
}

static void compare(const struct trial *trial, const char *way, const char *text, unsigned set,
                    const struct trial_results *got, trial_reference *reference,
                    const struct tolerance *tolerance)
{
    static char message[TEXT + 2 * MESSAGE], operands[MESSAGE];
    double expected[TRIAL_RESULTS][4] = {{0}};
    reference(trial, &trial->operands[set], expected);
    for (unsigned r = 0; r < trial->results; r++)
        for (unsigned c = 0; c < 4; c++) {
            float value = got->v[r][c];
            if (agrees(value, expected[r][c], tolerance))
                continue;
            print_operands(&trial->operands[set], operands, sizeof operands);
            snprintf(message, sizeof message, "%s, result %u.%c: expected %.9g (%08x), got %.9g (%08x)\n%s%s",
                     way, r, "xyzw"[c], expected[r][c], bits_of_float(trial_round(expected[r][c])),
                     (double)value, bits_of_float(value), operands, text);
            TEST_FAIL_MESSAGE(message);
        }
}

unsigned trial_cell(const struct program *program, unsigned result)
{
    int first = shader_major(program->model) == 1, third = shader_major(program->model) == 3;
    if (program->model->stage == STAGE_PIXEL)
        return first ? CELL_TEMPORARY : CELL_OUTPUT + 4 * result;
    return CELL_OUTPUT + 4 * (result + (third ? 1 : OUTPUT_COORDINATE));
}

typedef void machine_way(const struct trial_memory *memory, const float *input, float *output);

/* Runs sets in groups of four. The last group repeats sets if their number is not a multiple of four. */
static void run_machine(const struct trial_memory *memory, machine_way *way, unsigned first,
                        struct trial_results got[TRIAL_LANES])
{
    float input[TRIAL_OPERANDS][4][TRIAL_LANES], output[TRIAL_RESULTS][4][TRIAL_LANES];
    const struct trial *trial = memory->trial;
    for (unsigned l = 0; l < TRIAL_LANES; l++) {
        unsigned set = first + l < trial->sets ? first + l : trial->sets - 1;
        for (unsigned o = 0; o < TRIAL_OPERANDS; o++)
            for (unsigned c = 0; c < 4; c++)
                input[o][c][l] = trial->operands[set].v[o][c];
    }
    way(memory, &input[0][0][0], &output[0][0][0]);
    for (unsigned l = 0; l < TRIAL_LANES; l++)
        for (unsigned r = 0; r < trial->results; r++)
            for (unsigned c = 0; c < 4; c++)
                got[l].v[r][c] = output[r][c][l];
}

static uint8_t *make_constants(const struct trial *trial, const struct program *program)
{
    static float floats[CONSTANTS][4];
    static int32_t integers[INTEGERS][4];
    memset(floats, 0, sizeof floats);
    memset(integers, 0, sizeof integers);
    if (trial->constants)
        memcpy(floats, trial->constant, trial->constants * sizeof *floats);
    if (trial->integers)
        memcpy(integers, trial->integer, trial->integers * sizeof *integers);
    uint8_t *constants = malloc(program_constant_bytes(program));
    TEST_ASSERT_NOT_NULL(constants);
    program_write_constants(program, (const float(*)[4])floats, (const int32_t(*)[4])integers, constants);
    return constants;
}

static void expect_of_machine(const struct trial_memory *memory, const char *text, trial_reference *reference,
                              const struct tolerance *tolerance)
{
    static const struct {
        const char *name;
        machine_way *way;
    } ways[] = {{"emulated", trial_emulate}, {"recorded", trial_interpret}, {"optimized", trial_optimize}};
    const struct trial *trial = memory->trial;
    for (unsigned w = 0; w < sizeof ways / sizeof *ways; w++)
        for (unsigned set = 0; set < trial->sets; set += TRIAL_LANES) {
            struct trial_results got[TRIAL_LANES];
            run_machine(memory, ways[w].way, set, got);
            for (unsigned l = 0; l < TRIAL_LANES && set + l < trial->sets; l++)
                compare(trial, ways[w].name, text, set + l, &got[l], reference, tolerance);
        }
}

/* All engines, then forms of the emulator that no list has. Null past the last. */
static const struct engine *tried_engine(unsigned i)
{
    static const char *const forms[] = {"emulate:files=array", "emulate:decode=once",
                                        "emulate:files=array:decode=once"};
    unsigned engines = 0;
    while (engine_at(engines))
        engines++;
    if (i < engines)
        return engine_at(i);
    return i - engines < sizeof forms / sizeof *forms ? engine_find(forms[i - engines]) : NULL;
}

static void expect_of_engines(const struct trial_memory *memory, trial_reference *reference,
                              const struct tolerance *tolerance)
{
    static struct trial_results results[RESULTS];
    static char text[TEXT];
    const struct trial *trial = memory->trial;
    TEST_ASSERT_TRUE(trial->sets <= RESULTS);
    make_text(trial, memory->program->model, 1, text);
    const struct engine *engine;
    unsigned number = memory->number, stride = test_stride_of(3);
    for (unsigned i = 0; (engine = tried_engine(i)); i++) {
        if ((engine->on_request && !trial->requested) || engine_unavailable(engine) || number++ % stride)
            continue;
        if (memory->program->model->stage == STAGE_VERTEX)
            trial_run_vertices(memory, engine, results);
        else
            trial_run_pixels(trial, text, engine, results);
        for (unsigned set = 0; set < trial->sets; set++)
            compare(trial, engine->name, text, set, &results[set], reference, tolerance);
    }
}

/* Returns the trial with the sets that the build tries. */
static struct trial trial_share(const struct trial *trial)
{
    static struct trial_operands few[RESULTS];
    struct trial share = *trial;
    const unsigned stride = trial->sets > FEW_SETS ? test_stride_of(7) : 1;
    TEST_ASSERT_TRUE(trial->sets <= RESULTS);
    if (stride == 1)
        return share;
    for (unsigned set = share.sets = 0; set < trial->sets; set += stride)
        few[share.sets++] = trial->operands[set];
    share.operands = few;
    return share;
}

static void expect_within(const struct trial *trial, trial_reference *reference, struct tolerance tolerance)
{
    static unsigned number;
    static char text[TEXT];
    make_text(trial, trial_model(trial->model), 0, text);
    const struct program *program = make_program(text);
    uint8_t *constants = make_constants(trial, program);
    const struct trial_memory memory = {program, trial, constants, ++number};
    expect_of_machine(&memory, text, reference, &tolerance);
    if (!trial->alone)
        expect_of_engines(&memory, reference, &tolerance);
    free(constants);
    program_release(program);
}

void trial_expect(const struct trial *trial, trial_reference *reference)
{
    trial_expect_within(trial, reference, 0, 0);
}

static struct trial_results emulated[RESULTS];

static void emulated_reference(const struct trial *trial, const struct trial_operands *operands,
                               double results[TRIAL_RESULTS][4])
{
    for (unsigned r = 0; r < trial->results; r++)
        for (int c = 0; c < 4; c++)
            results[r][c] = (double)emulated[operands - trial->operands].v[r][c];
}

void trial_expect_agreement(const struct trial *trial)
{
    static char text[TEXT];
    const struct trial share = trial_share(trial);
    make_text(&share, trial_model(share.model), 0, text);
    const struct program *program = make_program(text);
    uint8_t *constants = make_constants(&share, program);
    const struct trial_memory memory = {program, &share, constants, 0};
    for (unsigned set = 0; set < share.sets; set += TRIAL_LANES) {
        struct trial_results got[TRIAL_LANES];
        run_machine(&memory, trial_emulate, set, got);
        for (unsigned l = 0; l < TRIAL_LANES && set + l < share.sets; l++)
            emulated[set + l] = got[l];
    }
    free(constants);
    expect_within(&share, emulated_reference, (struct tolerance){0, 0});
    program_release(program);
}

void trial_expect_within(const struct trial *trial, trial_reference *reference, double relative,
                         double absolute)
{
    const struct trial share = trial_share(trial);
    expect_within(&share, reference, (struct tolerance){relative, absolute});
}
