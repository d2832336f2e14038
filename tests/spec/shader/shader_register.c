/* Relative addresses of registers, and the instructions that compute them. */
#include "tests/spec/shader/operand.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ROWS = 256 };

static float rows[ROWS][4];

void setUp(void)
{
    for (int i = 0; i < ROWS; i++)
        for (int c = 0; c < 4; c++)
            rows[i][c] = (float)(i * 4 + c + 1);
}

void tearDown(void)
{
}

/* The values of addresses: halves to round, the ends of the file and of integers, and values that are not
 * integers. */
static const struct trial_operands addresses[] = {
    {{{0.0f, -0.0f, 0.5f, 1.5f}}},
    {{{2.5f, -0.5f, -1.5f, -2.5f}}},
    {{{0.49999997f, 0.99999994f, -0.49999997f, 1e-39f}}},
    {{{-3.0f, -3.5f, -2.51f, -1e-39f}}},
    {{{252.0f, 252.5f, 252.50002f, 253.0f}}},
    {{{251.5f, 255.0f, 256.0f, 1000.0f}}},
    {{{INFINITY, -INFINITY, NAN, 17.25f}}},
    {{{FLT_MAX, -FLT_MAX, 2147483520.0f, -2147483648.0f}}},
    {{{2147483648.0f, 4294967296.0f, 4294967300.0f, 16777217.0f}}},
    {{{100.9f, 100.1f, 7.0f, 254.0f}}},
};
enum { ADDRESSES = sizeof addresses / sizeof *addresses };

/* Returns the constant at an index, and 0 outside of the constants. Numbers beyond 32 bits and NaN are
 * outside. */
static double row_at(double index, int c)
{
    return index >= 0 && index < ROWS ? (double)rows[(int)index][c] : 0;
}

static double (*whole)(double);

static void addressed(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        r[0][c] = row_at(whole(at(o, 0, c)) + 3, c);
        r[1][c] = row_at(whole(at(o, 0, c)), 3 - c);
    }
}

static struct trial trial_of(const char *model, const char *body, unsigned results)
{
    struct trial trial = {.model = model, .body = body, .results = results};
    trial.operands = addresses;
    trial.sets = ADDRESSES;
    trial.constant = (const float(*)[4])rows;
    trial.constants = ROWS;
    return trial;
}

static void mova_rounds_to_nearest_even(void)
{
    static const char *const models[] = {"vs_2_0", "vs_2_x", "vs_3_0"};
    const char *body =
        "mova a0, r1\nmov r0.x, c[a0.x + 3].x\nmov r0.y, c3[a0.y].y\nmov r0.z, c[a0.z + 3].z\n"
        "mov r0.w, c[a0.w + 3].w\nmov r4.x, c[a0.x].w\nmov r4.y, c[a0.y].z\nmov r4.z, c[a0.z].y\n"
        "mov r4.w, c[a0.w].x";
    whole = nearbyint;
    for (int m = 0; m < 3; m++) {
        struct trial trial = trial_of(models[m], body, 2);
        trial_expect(&trial, addressed);
    }
}

static void mov_to_the_address_of_vs_1_1_takes_the_floor(void)
{
    char body[512] = "";
    whole = floor;
    for (int c = 0; c < 4; c++) {
        size_t used = strlen(body);
        snprintf(body + used, sizeof body - used,
                 "%smov a0.x, r1.%c\nmov r0.%c, c[a0.x + 3].%c\nmov r4.%c, c[a0.x].%c", c ? "\n" : "",
                 "xyzw"[c], "xyzw"[c], "xyzw"[c], "xyzw"[c], "wzyx"[c]);
    }
    struct trial trial = trial_of("vs_1_1", body, 2);
    trial_expect(&trial, addressed);
}

/* Relative addresses also read constants that the shader defines. They hide the draw's values of these
 * registers. */
static void defined_rows(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    addressed(trial, o, r);
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 4; c++) {
            double index = nearbyint(at(o, 0, c)) + (i ? 0 : 3);
            if (index == 3 || index == 20)
                r[i][c] = index == 3 ? -5 - (i ? 3 - c : c) : -50 - (i ? 3 - c : c);
        }
}

static void defined_constants_are_addressed_too(void)
{
    const char *body =
        "mova a0, r1\nmov r0.x, c[a0.x + 3].x\nmov r0.y, c3[a0.y].y\nmov r0.z, c[a0.z + 3].z\n"
        "mov r0.w, c[a0.w + 3].w\nmov r4.x, c[a0.x].w\nmov r4.y, c[a0.y].z\nmov r4.z, c[a0.z].y\n"
        "mov r4.w, c[a0.w].x";
    struct trial trial = trial_of("vs_3_0", body, 2);
    trial.setup = "def c3, -5, -6, -7, -8\ndef c20, -50, -51, -52, -53\n";
    whole = nearbyint;
    trial_expect(&trial, defined_rows);
}

/* Each row of a matrix that is outside of the constants is zero. */
static void matrix_rows(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    double index = nearbyint(at(o, 0, 0));
    for (int i = 0; i < 4; i++) {
        r[0][i] = 0;
        for (int c = 0; c < 4; c++)
            r[0][i] += (c + 1) * row_at(index + i + 2, c);
    }
}

static void rows_of_a_matrix_are_addressed(void)
{
    struct trial trial = trial_of("vs_2_0", "mova a0.x, r1.x\nmov r5, c0\nm4x4 r0, r5, c[a0.x + 2]", 1);
    trial.setup = "def c0, 1, 2, 3, 4\n";
    static struct trial_operands near[8];
    static const float first[8] = {-6, -5, -4, -2.5f, 250, 251, 252, 254};
    for (int i = 0; i < 8; i++)
        near[i].v[0][0] = first[i];
    trial.operands = near;
    trial.sets = 8;
    rows[0][0] = 1, rows[0][1] = 2, rows[0][2] = 3, rows[0][3] = 4; /* as c0 is defined */
    trial_expect(&trial, matrix_rows);
}

static void modifiers_and_swizzles(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++)
        r[0][c] = -row_at(nearbyint(at(o, 0, 0)), (c + 1) % 4);
}

static void addressed_constants_are_modified_and_swizzled(void)
{
    struct trial trial = trial_of("vs_3_0", "mova a0.w, r1.x\nmov r0, -c[a0.w]_abs.yzwx", 1);
    trial_expect(&trial, modifiers_and_swizzles);
}

/* The predicate keeps some components of the address, and only one side of an `if` sets others. */
static void partly_addressed(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        int changed = at(o, 0, c) > at(o, 1, c), inside = at(o, 0, 0) > at(o, 2, 0);
        r[0][c] = row_at(changed ? 5 : 9, c);
        r[1][c] = row_at(inside ? 7 : changed ? 5 : 9, c);
    }
}

static void addresses_are_written_under_predication_and_in_branches(void)
{
    static const char *const models[] = {"vs_2_x", "vs_3_0"};
    for (int m = 0; m < 2; m++) {
        struct trial trial = trial_of(
            models[m],
            "mov r5, c20\nmova a0, r5.x\nsetp_gt p0, r1, r2\n(p0) mova a0, r5.y\nmov r0.x, c[a0.x].x\n"
            "mov r0.y, c[a0.y].y\nmov r0.z, c[a0.z].z\nmov r0.w, c[a0.w].w\nif_gt r1.x, r3.x\n"
            "mova a0, r5.z\nendif\nmov r4.x, c[a0.x].x\nmov r4.y, c[a0.y].y\nmov r4.z, c[a0.z].z\n"
            "mov r4.w, c[a0.w].w",
            2);
        trial.setup = "def c20, 9, 5, 7, 0\n";
        trial.operands = trial_edges;
        trial.sets = trial_edge_sets;
        trial_expect(&trial, partly_addressed);
    }
}

/* --- Inputs and outputs by the loop's counter ---------------------------------------------------------- */

static void summed_inputs(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        double sum = 0;
        for (int i = 0; i < 3; i++)
            sum = (double)trial_round(trial_fused(sum, 0.5, at(o, i, 3 - c)));
        r[0][c] = (double)trial_round(sum * 0.5); /* there is no input at the last number */
    }
}

static void inputs_are_addressed_by_the_counter(void)
{
    struct trial trial =
        trial_of("vs_3_0",
                 "mov r0, c20.y\nmov r5, c20.x\nloop aL, i0\nmad r0, r0, r5, v[aL].wzyx\nendloop\n"
                 "loop aL, i1\nmad r0, r0, r5, v[aL + 4].wzyx\nendloop",
                 1);
    trial.setup = "def c20, 0.5, 0, 0, 0\ndefi i0, 3, 1, 1, 0\ndefi i1, 1, 60, 1, 0\n";
    trial.operands = trial_ordinary;
    trial.sets = trial_ordinary_sets;
    trial_expect(&trial, summed_inputs);
    trial.model = "ps_3_0";
    trial.alone = 1; /* operands of draws are not in inputs; tests/spec/shader/shader_pixel.c tests draws */
    trial_expect(&trial, summed_inputs);
}

/* aL is 20, -108 and -236, which are not numbers of inputs, then 2. */
static void summed_from_below(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++)
        r[0][c] = 3 + at(o, 1, c);
}

static void inputs_below_the_first_are_zeros(void)
{
    struct trial trial = trial_of("vs_3_0",
                                  "mov r0, c20.x\nloop aL, i0\nadd r0, r0, v[aL]\nadd r0, r0, c20.x\n"
                                  "endloop\nsub r0, r0, c20.x\nloop aL, i1\nadd r0, r0, v[aL]\nendloop",
                                  1);
    trial.setup = "def c20, 1, 0, 0, 0\ndefi i0, 3, 20, -128, 0\ndefi i1, 1, 2, 0, 0\n";
    trial.operands = trial_ordinary;
    trial.sets = trial_ordinary_sets;
    trial_expect(&trial, summed_from_below);
    trial.model = "ps_3_0";
    trial.alone = 1;
    trial_expect(&trial, summed_from_below);
}

static void kept_outputs(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 4; c++)
            r[i][c] = at(o, i == 1 && c != 2 ? 0 : 1, c);
}

static void outputs_below_the_first_are_not_written(void)
{
    struct trial trial = trial_of("vs_3_0",
                                  "mov o1, r2\nmov o2, r2\nmov o3, r2\nloop aL, i0\n"
                                  "mov o[aL + 2].xyw, r1\nendloop",
                                  3);
    trial.setup = "defi i0, 3, 0, -100, 0\n"; /* o2, and twice nothing */
    trial.gives = 1;
    trial.operands = trial_ordinary;
    trial.sets = trial_ordinary_sets;
    trial_expect(&trial, kept_outputs);
}

/* o1, o2 and o3 get the operands in reverse order. A write to o61 has no effect. */
static void given_outputs(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 4; c++)
            r[i][c] = c == 3 ? at(o, 1, 3) : at(o, 2 - i, c);
}

static void outputs_are_addressed_by_the_counter(void)
{
    struct trial trial = trial_of("vs_3_0",
                                  "mov o1, r2\nmov o2, r2\nmov o3, r2\nmov r4, r3\nmov r5, r2\nloop aL, i0\n"
                                  "mov o[aL + 1].xyz, r4\nmov r4, r5\nmov r5, r1\nendloop\n"
                                  "loop aL, i1\nmov o[aL + 1], r1\nendloop",
                                  3);
    trial.setup = "defi i0, 3, 0, 1, 0\ndefi i1, 1, 60, 1, 0\n";
    trial.gives = 1;
    trial.operands = trial_ordinary;
    trial.sets = trial_ordinary_sets;
    trial_expect(&trial, given_outputs);
}

/* The predicate selects the written components. Only lanes that execute write. */
static void partly_given_outputs(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 4; c++) {
            int given = at(o, 0, c) > at(o, 1, c), inside = at(o, 0, 1) >= at(o, 2, 1);
            r[i][c] = at(o, 2, c);
            if (given)
                r[i][c] = at(o, 0, c);
            if (inside && c == 2)
                r[i][c] = at(o, 1, c) < 1 ? at(o, 1, c) > 0 ? at(o, 1, c) : 0 : isnan(at(o, 1, c)) ? 0 : 1;
        }
}

static void addressed_outputs_are_written_under_predication_and_in_branches(void)
{
    struct trial trial = trial_of("vs_3_0",
                                  "mov o1, r3\nmov o2, r3\nmov o3, r3\nsetp_gt p0, r1, r2\nloop aL, i0\n"
                                  "(p0) mov o[aL], r1\nif_ge r1.y, r3.y\nmov_sat o[aL].z, r2\nendif\nendloop",
                                  3);
    trial.setup = "defi i0, 3, 1, 1, 0\n";
    trial.gives = 1;
    trial.operands = trial_edges;
    trial.sets = trial_edge_sets;
    trial_expect(&trial, partly_given_outputs);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(mova_rounds_to_nearest_even);
    RUN_TEST(mov_to_the_address_of_vs_1_1_takes_the_floor);
    RUN_TEST(defined_constants_are_addressed_too);
    RUN_TEST(rows_of_a_matrix_are_addressed);
    RUN_TEST(addressed_constants_are_modified_and_swizzled);
    RUN_TEST(addresses_are_written_under_predication_and_in_branches);
    RUN_TEST(inputs_are_addressed_by_the_counter);
    RUN_TEST(inputs_below_the_first_are_zeros);
    RUN_TEST(outputs_are_addressed_by_the_counter);
    RUN_TEST(outputs_below_the_first_are_not_written);
    RUN_TEST(addressed_outputs_are_written_under_predication_and_in_branches);
    return UNITY_END();
}
