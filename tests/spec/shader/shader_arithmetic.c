/* The results of the arithmetic instructions of shaders, in models of every generation. Each instruction is
 * tried with all pairs of edge values of binary32 and with ordinary numbers, and compared with its definition
 * in docs/shader-semantics.md in double precision. */
#include "tests/spec/shader/operand.h"
#include "tests/support/trial/trial_arithmetic.h"

#include <float.h>
#include <math.h>

void setUp(void)
{
}

void tearDown(void)
{
}

#define A(c) at(o, 0, c)
#define B(c) at(o, 1, c)
#define C(c) at(o, 2, c)

/* Returns 1 if engines are tried in the model. All models differ in their rules, so the way `emulated` is
 * tried in each. The code of an instruction is the same within a generation, so engines are tried in one
 * model of each. */
static int is_for_engines(const struct shader_model *model)
{
    return model->column != COLUMN_VS_2_X && model->column != COLUMN_PS_2_X;
}

static void try_row(const struct arithmetic_row *row, const struct shader_model *model, int legacy)
{
    char body[512];
    int first = shader_major(model) == 1;
    if (shader_slots(&shader_operations[row->opcode], model) < 0 ||
        row->flags & (first ? ARITHMETIC_NOT_1 : ARITHMETIC_ONLY_1))
        return;
    arithmetic_unfold(row->body, body, sizeof body);
    struct trial trial = {
        .model = model->name, .setup = row->setup, .body = body, .results = 1, .legacy = legacy};
    trial.operands = row->flags & ARITHMETIC_ORDINARY ? trial_ordinary : trial_edges;
    trial.sets = row->flags & ARITHMETIC_ORDINARY ? trial_ordinary_sets : trial_edge_sets;
    trial.alone = legacy ? shader_major(model) < 3 : !is_for_engines(model);
    trial_expect_within(&trial, row->reference, row->relative, row->absolute);
}

static void try_all(int legacy)
{
    for (unsigned m = 0; m < ARITHMETIC_MODELS; m++)
        for (unsigned i = 0; i < ARITHMETIC_ROWS; i++)
            try_row(&arithmetic_rows[i], &shader_models[arithmetic_models[m]], legacy);
}

static void instructions_compute_their_definitions(void)
{
    try_all(0);
}

static void with_legacy_multiplication_zeros_give_zero(void)
{
    try_all(1);
}

/* Makes a shader for each set of operands, in which compilers can fold the constants. Some shaders are
 * executed in all ways. */
static void try_literals(const struct arithmetic_row *row, const struct shader_model *model, unsigned step,
                         int alone)
{
    char body[512];
    if (shader_slots(&shader_operations[row->opcode], model) < 0 ||
        row->flags & (shader_major(model) == 1 ? ARITHMETIC_NOT_1 : ARITHMETIC_ONLY_1))
        return;
    arithmetic_unfold(row->body, body, sizeof body);
    struct trial trial = {
        .model = model->name, .setup = row->setup, .body = body, .results = 1, .literal = 1, .sets = 1};
    for (unsigned set = 0; set < trial_edge_sets; set += step) {
        if (row->flags & ARITHMETIC_ORDINARY && set < trial_edge_sets - trial_ordinary_sets)
            continue;
        trial.operands = &trial_edges[set];
        trial.alone = alone;
        trial_expect_within(&trial, row->reference, row->relative, row->absolute);
    }
}

static void constants_that_are_known_compute_the_same(void)
{
    for (unsigned i = 0; i < ARITHMETIC_ROWS; i++) {
        try_literals(&arithmetic_rows[i], &shader_models[MODEL_VS_3_0], 7, 1);
        try_literals(&arithmetic_rows[i], &shader_models[MODEL_VS_3_0], 61, 0);
        try_literals(&arithmetic_rows[i], &shader_models[MODEL_PS_3_0], 113, 0);
        try_literals(&arithmetic_rows[i], &shader_models[MODEL_VS_1_1], 113, 0);
    }
}

/* --- Edges by hand ------------------------------------------------------------------------------------- */

/* The result of lit of x, y and w: the second operand's y and z. */
static const struct trial_operands lights[] = {
    {{{1, 0, 9, 0}, {0, 1, 0}}}, /* the result does not contain 0 to the power 0 */
    {{{1, -0.0f, 9, 0}, {0, 1, 0}}},
    {{{1, -1, 9, 2}, {0, 1, 0}}},
    {{{0, 1, 9, 1}, {0, 0, 0}}},
    {{{-0.0f, 1, 9, 1}, {0, 0, 0}}},
    {{{-1, 0.5f, 9, 2}, {0, 0, 0}}},
    {{{0.25f, 0.5f, 9, 2}, {0, 0.25f, 0.25f}}},
    {{{2, 0.5f, 9, 0}, {0, 2, 1}}},
    {{{2, 0.5f, 9, -2}, {0, 2, 4}}},
    {{{1, 1, 9, INFINITY}, {0, 1, 1}}}, /* the power stays finite */
    {{{1, INFINITY, 9, 0}, {0, 1, 1}}},
    {{{1, INFINITY, 9, -1}, {0, 1, 0}}},
    {{{INFINITY, 0.5f, 9, 1}, {0, INFINITY, 0.5f}}},
    {{{NAN, 0.5f, 9, 1}, {0, 0, 0}}},
    {{{1, NAN, 9, 1}, {0, 1, 0}}},
    {{{1e-39f, 0.5f, 9, 1}, {0, 0, 0}}},
    {{{1, 1e-39f, 9, 0}, {0, 1, 0}}},
};

static void light_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    (void)t;
    r[0][0] = r[0][3] = 1;
    r[0][1] = B(1), r[0][2] = B(2);
}

static void light_at_the_edges(void)
{
    static const char *const those[] = {"vs_1_1", "vs_2_0", "vs_3_0"};
    for (int m = 0; m < 3; m++) {
        struct trial trial = {.model = those[m],
                              .body = "lit r0, r1",
                              .results = 1,
                              .operands = lights,
                              .sets = sizeof lights / sizeof *lights};
        trial_expect_within(&trial, light_reference, ARITHMETIC_BITS_15, 0);
    }
}

/* Angles with results computed by hand: zeros, right and straight angles in binary32, angles beyond 2^25, and
 * values that are not numbers. */
static const struct trial_operands angles[] = {
    {{{0.0f, 1, 0}}},
    {{{-0.0f, 1, -0.0f}}},
    {{{0x1.921fb6p+0f, 0, 1}}},
    {{{-0x1.921fb6p+0f, 0, -1}}},
    {{{0x1.921fb6p+1f, -1, 0}}},
    {{{0x1p26f, 1, 0}}},
    {{{FLT_MAX, 1, 0}}},
    {{{-FLT_MAX, 1, 0}}},
    {{{INFINITY, NAN, NAN}}},
    {{{-INFINITY, NAN, NAN}}},
    {{{NAN, NAN, NAN}}},
};

static void angle_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    (void)t;
    r[0][0] = A(1), r[0][1] = A(2);
    r[0][2] = r[0][3] = C(2);
}

static void angles_at_the_edges(void)
{
    static const char *const those[] = {"vs_3_0", "ps_3_0", "vs_2_0", "vs_2_x", "ps_2_0", "ps_2_x"};
    for (int m = 0; m < 6; m++) {
        int series = m >= 2;
        struct trial trial = {.model = those[m],
                              .setup = series ? ARITHMETIC_SERIES : NULL,
                              .body = series ? "mov r0, r3\nsincos r0.xy, r1.x, c20, c21"
                                             : "mov r0, r3\nsincos r0.xy, r1.x",
                              .results = 1,
                              .operands = angles,
                              .sets = sizeof angles / sizeof *angles};
        trial_expect_within(&trial, angle_reference, 0, 1.6e-7);
    }
}

/* cnd is of ps_1_x only (tests/spec/shader/shader_1.c). Those from div to select are of OpenGL's models only
 * (tests/spec/shader/shader_opengl.c). */
static void no_instruction_is_without_a_row(void)
{
    for (int opcode = 0; opcode < SHADER_COUNT; opcode++) {
        const struct shader_operation *operation = &shader_operations[opcode];
        int tried = opcode == SHADER_CND || (opcode >= SHADER_DIV && opcode <= SHADER_SELECT);
        if (operation->destination != OPERAND_RESULT || operation->flags & (IS_TEXTURE | IS_GRADIENT))
            continue;
        for (unsigned i = 0; i < ARITHMETIC_ROWS; i++)
            tried |= (int)arithmetic_rows[i].opcode == opcode;
        TEST_ASSERT_TRUE_MESSAGE(tried, operation->name);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(no_instruction_is_without_a_row);
    RUN_TEST(instructions_compute_their_definitions);
    RUN_TEST(light_at_the_edges);
    RUN_TEST(angles_at_the_edges);
    RUN_TEST(constants_that_are_known_compute_the_same);
    RUN_TEST(with_legacy_multiplication_zeros_give_zero);
    return UNITY_END();
}
