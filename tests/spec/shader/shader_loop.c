/* Loops of shaders: the numbers of passes, counters, and lanes that leave a loop before others. The results
 * are compared with the same decisions in C for each set of operands. */
#include "tests/spec/shader/operand.h"
#include "tests/support/trial/trial_flow.h"

#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* --- Conditions ---------------------------------------------------------------------------------------- */

static int comparison; /* by its number in def/shader/shader_comparison.def */

static const float rows[8][4] = {{10, 11, 12, 13}, {20, 21, 22, 23}, {30, 31, 32, 33}, {40, 41, 42, 43},
                                 {50, 51, 52, 53}, {60, 61, 62, 63}, {70, 71, 72, 73}, {80, 81, 82, 83}};

/* --- Loops --------------------------------------------------------------------------------------------- */

static int32_t integers[4][4];

/* Computes r = r / 2 + 1, `count` times; the result depends on the order. */
static void repeated(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        r[0][c] = at(o, 0, c);
        for (int i = 0; i < integers[0][0]; i++)
            r[0][c] = rounded(trial_fused(r[0][c], 0.5, 1));
    }
}

static void rep_repeats_by_its_count(void)
{
    static const int counts[] = {0, 1, 2, 17, 255};
    struct trial trial = flow_trial(NULL, "mov r0, r1\nrep i0\nmad r0, r0, c20.x, c20.y\nendrep", 1);
    trial.setup = "def c20, 0.5, 1, 0, 0\n";
    trial.integer = (const int32_t(*)[4])integers;
    trial.integers = 1;
    for (unsigned i = 0; i < sizeof counts / sizeof *counts; i++) {
        integers[0][0] = counts[i];
        trial.sets = counts[i] > 20 ? 8 : trial_edge_sets;
        flow_on_all(flow_statically, FLOW_STATICALLY, trial, repeated);
    }
    trial.setup = "def c20, 0.5, 1, 0, 0\ndefi i0, 5, 0, 0, 0\n";
    integers[0][0] = 5;
    trial.integers = 0;
    flow_on_all(flow_statically, FLOW_STATICALLY, trial, repeated);
}

static void repeated_in_4(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    double passes = integers[0][0] * integers[1][0] * integers[2][0] * integers[3][0];
    for (int c = 0; c < 4; c++)
        r[0][c] = c ? at(o, 0, c) : passes;
}

static void rep_nests_4_deep(void)
{
    struct trial trial = flow_trial(NULL,
                                    "mov r0, r1\nmov r0.x, c20.x\nrep i0\nrep i1\nrep i2\nrep i3\n"
                                    "add r0.x, r0.x, c20.y\nendrep\nendrep\nendrep\nendrep",
                                    1);
    trial.setup = "def c20, 0, 1, 0, 0\n";
    trial.integer = (const int32_t(*)[4])integers;
    trial.integers = 4;
    trial.sets = 8;
    for (int zero = 0; zero < 5; zero++) { /* which of them does not run */
        for (int i = 0; i < 4; i++)
            integers[i][0] = i == zero ? 0 : i + 2;
        flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, repeated_in_4);
    }
}

/* The row of constants at an index: 0 outside of them. */
static double row_at(const struct trial *trial, int index, int c)
{
    return index >= 0 && (unsigned)index < trial->constants ? (double)trial->constant[index][c] : 0;
}

static void counted(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    int index = integers[0][1];
    copy(o, 0, r[0]);
    for (int i = 0; i < integers[0][0]; i++, index += integers[0][2])
        for (int c = 0; c < 4; c++)
            r[0][c] = rounded(trial_fused(r[0][c], 0.5, row_at(trial, index + 1, c)));
}

/* The loops have these counts, starts and steps: upwards, down below the first constant, without a step, past
 * the last constant, and without a pass. */
static void loop_counts_from_its_start_by_its_step(void)
{
    static const char *const models[] = {"vs_2_0", "vs_2_x", "vs_3_0"};
    static const int32_t numbers[][4] = {{4, 0, 1, 0},    {3, 1, 2, 0},    {6, 4, -1, 0},  {9, 6, -3, 0},
                                         {4, 3, 0, 0},    {0, 2, 1, 0},    {1, 255, 1, 0}, {5, 3, 127, 0},
                                         {3, 0, -128, 0}, {7, 255, -50, 0}};
    static float constants[256][4];
    struct trial trial =
        flow_trial(NULL, "mov r0, r1\nmov r5, c20.x\nloop aL, i0\nmad r0, r0, r5, c[aL + 1]\nendloop", 1);
    memcpy(constants, rows, sizeof rows);
    for (int c = 0; c < 4; c++)
        constants[20][c] = 0.5f, constants[255][c] = (float)(c + 1);
    trial.constant = (const float(*)[4])constants;
    trial.constants = 256;
    trial.integer = (const int32_t(*)[4])integers;
    trial.integers = 1;
    for (unsigned i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        memcpy(integers[0], numbers[i], sizeof *numbers);
        flow_on_all(models, 3, trial, counted);
    }
}

/* The inner loop's counter hides the outer one's, which is visible again after it. */
static void counted_twice(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    copy(o, 0, r[0]);
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 4; c++)
            r[0][c] = rounded(r[0][c] + row_at(trial, i, c));
        for (int j = 0; j < 2; j++)
            for (int c = 0; c < 4; c++)
                r[0][c] = rounded(trial_fused(r[0][c], 0.5, row_at(trial, 5 - j, c)));
        for (int c = 0; c < 4; c++)
            r[0][c] = rounded(r[0][c] + row_at(trial, i, 3 - c));
    }
}

static void the_counter_is_the_innermost_loops(void)
{
    static const char *const models[] = {"vs_2_x", "vs_3_0"};
    struct trial trial = flow_trial(
        NULL,
        "mov r0, r1\nmov r5, c20.x\nloop aL, i0\nadd r0, r0, c[aL]\nloop aL, i1\nmad r0, r0, r5, c[aL]\n"
        "endloop\nadd r0, r0, c[aL].wzyx\nendloop",
        1);
    trial.setup = "defi i0, 3, 0, 1, 0\ndefi i1, 2, 5, -1, 0\ndef c20, 0.5, 0, 0, 0\n";
    trial.constant = rows;
    trial.constants = 8;
    flow_on_all(models, 2, trial, counted_twice);
}

/* --- Leaving loops ------------------------------------------------------------------------------------- */

/* x is the number of started passes, and y the number of finished ones. A lane leaves the loop when it has
 * started more passes than its first operand. */
static void left(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    copy(o, 1, r[0]);
    r[0][0] = r[0][1] = 0;
    for (int i = 0; i < 6; i++) {
        r[0][0]++;
        if (r[0][0] > at(o, 0, 0))
            break;
        r[0][1]++;
    }
}

#define LEAVING(leave)                                                                                       \
    "mov r0, r2\nmov r0.xy, c20.x\nrep i0\nadd r0.x, r0.x, c20.y\n" leave "\nadd r0.y, r0.y, c20.y\nendrep"

static void lanes_leave_loops_by_themselves(void)
{
    static const char *const bodies[] = {
        LEAVING("break_gt r0.x, r1.x"),
        LEAVING("if_gt r0.x, r1.x\nbreak\nendif"),
        LEAVING("if_gt r0.x, r1.x\nmov r4, r0\nif_gt r0.x, r1.x\nbreak\nendif\nmov r0, r3\nendif"),
        LEAVING("setp_gt p0, r0.x, r1.x\nbreakp p0.z"),
        LEAVING("setp_gt p0, r0.x, r1.x\nif p0.x\nbreak\nelse\nmov r5, r0\nendif"),
        LEAVING("setp_gt p0, r0.x, r1.x\nsetp_le p0.yw, r0.x, r1.x\nbreakp !p0.x\nbreak"),
        LEAVING("break_le r0.x, r1.x\nbreak"),
    };
    /* The last two leave where the others stay. */
    for (unsigned i = 0; i < 5; i++) {
        struct trial trial = flow_trial(NULL, bodies[i], 1);
        trial.setup = "def c20, 0, 1, 0, 0\ndefi i0, 6, 0, 0, 0\n";
        flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, left);
    }
}

static void left_at_once(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    copy(o, 1, r[0]);
    r[0][0] = 1, r[0][1] = 0;
}

static void all_lanes_can_leave_in_the_first_pass(void)
{
    static const char *const bodies[] = {
        LEAVING("setp_gt p0, r0.x, r1.x\nbreakp !p0.x\nbreak"),
        LEAVING("break_le r0.x, r1.x\nbreak"),
        LEAVING("break"),
    };
    for (unsigned i = 0; i < 3; i++) {
        struct trial trial = flow_trial(NULL, bodies[i], 1);
        trial.setup = "def c20, 0, 1, 0, 0\ndefi i0, 6, 0, 0, 0\n";
        flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, left_at_once);
    }
}

/* All six comparisons of all pairs of edge values. A lane leaves in the first pass if the comparison is true,
 * and in the third pass if not. With a NaN, all comparisons except _ne are false. */
static void left_by_comparison(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++)
        r[0][c] = flow_holds(comparison, at(o, 0, c), at(o, 1, c)) ? 1 : 3;
}

static void comparisons_leave_lane_by_lane(void)
{
    for (comparison = 1; comparison <= 6; comparison++) {
        const char *name = shader_word_name(shader_comparisons, (unsigned)comparison);
        char body[512] = "mov r0, c20.x";
        for (int c = 0; c < 4; c++) {
            size_t used = strlen(body);
            char x = "xyzw"[c];
            snprintf(body + used, sizeof body - used,
                     "\nrep i0\nadd r0.%c, r0.%c, c20.y\nbreak_%s r1.%c, r2.%c\nendrep", x, x, name, x, x);
        }
        struct trial trial = flow_trial(NULL, body, 1);
        trial.setup = "def c20, 0, 1, 0, 0\ndefi i0, 3, 0, 0, 0\n";
        flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, left_by_comparison);
    }
}

/* A lane that left the inner loop continues in the outer one until it leaves that too. x counts inner passes,
 * y outer ones. */
static void left_twice(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    copy(o, 2, r[0]);
    double limit = 1;
    r[0][0] = r[0][1] = 0;
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 5; j++) {
            if (at(o, 0, 0) < limit)
                break;
            r[0][0]++;
            limit = rounded(limit + 0.25);
        }
        r[0][1]++;
        if (!(at(o, 1, 0) > r[0][1]))
            break;
    }
    r[0][2] = limit;
}

static void lanes_leave_the_innermost_loop_only(void)
{
    struct trial trial =
        flow_trial(NULL,
                   "mov r0, r3\nmov r0.xyz, c20.xxy\nrep i0\nrep i1\nbreak_lt r1.x, r0.z\n"
                   "add r0.x, r0.x, c20.y\nadd r0.z, r0.z, c20.z\nendrep\nadd r0.y, r0.y, c20.y\n"
                   "if_gt r2.x, r0.y\nmov r4, r0\nelse\nbreak\nendif\nendrep",
                   1);
    trial.setup = "def c20, 0, 1, 0.25, 0\ndefi i0, 4, 0, 0, 0\ndefi i1, 5, 0, 0, 0\n";
    trial.requested = 1;
    flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, left_twice);
}

/* A loop that only some lanes enter. */
static void looped_inside(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    copy(o, 0, r[0]);
    if (!(at(o, 0, 0) >= at(o, 1, 0)))
        return;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 4; c++)
            if (at(o, 1, 1) < i)
                break;
            else
                r[0][c] = rounded(r[0][c] + 1);
}

static void loops_run_in_the_lanes_that_enter(void)
{
    struct trial trial =
        flow_trial(NULL,
                   "mov r0, r1\nmov r4, c20.x\nif_ge r1.x, r2.x\nrep i0\nbreak_lt r2.y, r4.x\n"
                   "add r0, r0, c20.y\nadd r4, r4, c20.y\nendrep\nendif",
                   1);
    trial.setup = "def c20, 0, 1, 0, 0\ndefi i0, 3, 0, 0, 0\n";
    flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, looped_inside);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(rep_repeats_by_its_count);
    RUN_TEST(rep_nests_4_deep);
    RUN_TEST(loop_counts_from_its_start_by_its_step);
    RUN_TEST(the_counter_is_the_innermost_loops);
    RUN_TEST(lanes_leave_loops_by_themselves);
    RUN_TEST(comparisons_leave_lane_by_lane);
    RUN_TEST(all_lanes_can_leave_in_the_first_pass);
    RUN_TEST(lanes_leave_the_innermost_loop_only);
    RUN_TEST(loops_run_in_the_lanes_that_enter);
    return UNITY_END();
}
