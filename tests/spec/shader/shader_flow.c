/* Flow control of shaders: conditions, predicates and subroutines, with lanes that diverge and lanes that do
 * not. The results are compared with the same decisions in C for each set of operands. */
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

static void chosen_by_booleans(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    copy(o, trial->booleans >> 3 & 1 ? 0 : 1, r[0]);
    copy(o, trial->booleans >> 15 & 1 ? 2 : 0, r[1]);
    copy(o, 1, r[2]);
}

static void booleans_choose(void)
{
    struct trial trial = flow_trial(NULL,
                                    "if b3\nmov r0, r1\nelse\nmov r0, r2\nendif\n"
                                    "mov r4, r3\nif !b15\nmov r4, r1\nendif\n"
                                    "mov r5, r1\nif b4\nmov r5, r2\nendif\nif b5\nmov r5, r3\nendif",
                                    3);
    trial.setup = "defb b4, true\ndefb b5, false\n";
    trial.sets = 8;
    for (unsigned i = 0; i < 4; i++) {
        trial.booleans = (i & 1) << 3 | (i & 2) << 14;
        flow_on_all(flow_statically, FLOW_STATICALLY, trial, chosen_by_booleans);
    }
}

static int comparison; /* by its number in def/shader/shader_comparison.def */

static void chosen_by_comparison(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        int is = flow_holds(comparison, at(o, 0, c), at(o, 1, c));
        r[0][c] = at(o, is ? 0 : 1, c);
        r[1][c] = is ? at(o, 2, c) : 1;
    }
}

/* All six comparisons of all pairs of edge values. With a NaN, all comparisons except _ne are false. */
static void comparisons_choose_lane_by_lane(void)
{
    for (comparison = 1; comparison <= 6; comparison++) {
        const char *name = shader_word_name(shader_comparisons, (unsigned)comparison);
        char body[512] = "mov r4, c20";
        for (int c = 0; c < 4; c++) {
            size_t used = strlen(body);
            char x = "xyzw"[c];
            snprintf(body + used, sizeof body - used,
                     "\nif_%s r1.%c, r2.%c\nmov r0.%c, r1\nmov r4.%c, r3\nelse\nmov r0.%c, r2\nendif", name,
                     x, x, x, x, x);
        }
        struct trial trial = flow_trial(NULL, body, 2);
        trial.setup = "def c20, 1, 1, 1, 1\n";
        flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, chosen_by_comparison);
    }
}

static void chosen_by_predicate(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    copy(o, at(o, 0, 1) < at(o, 1, 1) ? 0 : 1, r[0]);
    copy(o, 2, r[1]);
    if (!(at(o, 0, 2) < at(o, 1, 2)))
        copy(o, 0, r[1]);
}

static void predicates_choose(void)
{
    struct trial trial = flow_trial(NULL,
                                    "setp_lt p0, r1, r2\nif p0.y\nmov r0, r1\nelse\nmov r0, r2\nendif\n"
                                    "mov r4, r3\nif !p0.z\nmov r4, r1\nendif",
                                    2);
    flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, chosen_by_predicate);
}

/* x is the number of thresholds, -4 and up in steps of 1/3, that the operand exceeds, at most 24. y is 100
 * plus the depth of the first threshold that it does not exceed. z is set in the innermost condition. */
static void nested_24(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    double threshold = -4;
    int depth = 0;
    for (; depth < 24 && at(o, 0, 0) > threshold; depth++)
        threshold = rounded(threshold + (double)0.333333343f);
    r[0][0] = depth;
    r[0][1] = depth < 24 ? 100 + depth : 0;
    r[0][2] = depth == 24 ? at(o, 1, 2) : 0;
    r[0][3] = threshold;
}

static void conditions_nest_24_deep(void)
{
    char body[4096] = "mov r0, c20.x\nmov r0.w, c20.y";
    for (int i = 0; i < 24; i++)
        strcat(body, "\nif_gt r1.x, r0.w\nadd r0.x, r0.x, c20.z\nadd r0.w, r0.w, c20.w");
    strcat(body, "\nmov r0.z, r2.z");
    for (int i = 0; i < 24; i++)
        strcat(body, "\nelse\nadd r0.y, r0.x, c21.x\nendif");
    struct trial trial = flow_trial(NULL, body, 1);
    trial.setup = "def c20, 0, -4, 1, 0.333333343\ndef c21, 100, 0, 0, 0\n";
    flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, nested_24);
}

/* An address and a predicate are set on one side of the condition only. */
static void set_on_one_side(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    int above = at(o, 0, 0) > at(o, 1, 0);
    for (int c = 0; c < 4; c++) {
        r[0][c] = (double)trial->constant[above ? 3 : 1][c];
        r[1][c] = above                        ? at(o, 0, c) < at(o, 1, c) ? at(o, 0, c) : at(o, 2, c)
                                         : at(o, 0, c) >= at(o, 1, c) ? at(o, 0, c)
                                               : at(o, 2, c);
    }
}

static const float rows[8][4] = {{10, 11, 12, 13}, {20, 21, 22, 23}, {30, 31, 32, 33}, {40, 41, 42, 43},
                                 {50, 51, 52, 53}, {60, 61, 62, 63}, {70, 71, 72, 73}, {80, 81, 82, 83}};

static void addresses_and_predicates_diverge_too(void)
{
    static const char *const models[] = {"vs_2_x", "vs_3_0"};
    struct trial trial =
        flow_trial(NULL,
                   "mov r5, c20\nmova a0.x, r5.x\nsetp_ge p0, r1, r2\nif_gt r1.x, r2.x\nmova a0.x, r5.y\n"
                   "setp_lt p0, r1, r2\nendif\nmov r0, c[a0.x]\nmov r4, r3\n(p0) mov r4, r1",
                   2);
    trial.setup = "def c20, 1, 3, 0, 0\n";
    trial.constant = rows;
    trial.constants = 8;
    flow_on_all(models, 2, trial, set_on_one_side);
}

/* --- Subroutines --------------------------------------------------------------------------------------- */

static void called(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    for (int c = 0; c < 4; c++) {
        r[0][c] = rounded(at(o, 0, c) + at(o, 1, c));
        r[0][c] = rounded(r[0][c] + at(o, 1, c));
        if (trial->booleans & 4)
            r[0][c] = rounded(r[0][c] * at(o, 2, c));
        if (!(trial->booleans & 2))
            r[0][c] = rounded(r[0][c] + at(o, 1, c));
    }
}

static void subroutines_run_where_they_are_called(void)
{
    struct trial trial = flow_trial(NULL, "mov r0, r1\ncall l0\ncall l0\ncallnz l1, b2\ncallnz l0, !b1", 1);
    trial.after = "ret\nlabel l0\nadd r0, r0, r2\nret\nlabel l1\nmul r0, r0, r3\nret\n";
    for (unsigned i = 0; i < 4; i++) {
        trial.booleans = 2 * i;
        flow_on_all(flow_statically, FLOW_STATICALLY, trial, called);
    }
}

static void called_by_predicate(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        r[0][c] = at(o, 0, c);
        if (at(o, 0, 1) < at(o, 1, 1))
            r[0][c] = rounded(r[0][c] + at(o, 1, c));
        if (!(at(o, 0, 0) < at(o, 1, 0)))
            r[0][c] = rounded(r[0][c] * at(o, 2, c));
    }
}

static void predicates_call_lane_by_lane(void)
{
    struct trial trial =
        flow_trial(NULL, "mov r0, r1\nsetp_lt p0, r1, r2\ncallnz l0, p0.y\ncallnz l1, !p0.x", 1);
    trial.after = "ret\nlabel l0\nadd r0, r0, r2\nret\nlabel l1\nmul r0, r0, r3\nret\n";
    flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, called_by_predicate);
}

static void called_inside(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        r[0][c] = at(o, 0, c);
        if (at(o, 0, 2) < at(o, 1, 2) && at(o, 0, 1) < at(o, 1, 1))
            r[0][c] = rounded(r[0][c] + at(o, 1, c));
        for (int pass = 0; pass < 2; pass++)
            if (!(at(o, 0, 0) < at(o, 1, 0)))
                r[0][c] = rounded(r[0][c] * at(o, 2, c));
    }
}

/* The condition and the loop around the calls decide in which lanes the subroutines write. */
static void conditional_calls_inside_of_conditions_and_loops_write_in_their_lanes(void)
{
    struct trial trial = flow_trial(NULL,
                                    "mov r0, r1\nsetp_lt p0, r1, r2\nif_lt r1.z, r2.z\ncallnz l0, p0.y\n"
                                    "endif\nrep i0\ncallnz l1, !p0.x\nendrep",
                                    1);
    trial.setup = "defi i0, 2, 0, 0, 0\n";
    trial.after = "ret\nlabel l0\nadd r0, r0, r2\nret\nlabel l1\nmul r0, r0, r3\nret\n";
    flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, called_inside);
}

/* Each calls the next twice: 1 + 2 + 4 + 8 additions. */
static void called_4_deep(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    copy(o, 0, r[0]);
    r[0][0] = 15;
}

static void subroutines_call_4_deep(void)
{
    struct trial trial = flow_trial(NULL, "mov r0, r1\nmov r0.x, c20.x\ncall l0", 1);
    trial.setup = "def c20, 0, 1, 0, 0\n";
    trial.after = "ret\nlabel l0\nadd r0.x, r0.x, c20.y\ncall l1\ncall l1\nret\n"
                  "label l1\nadd r0.x, r0.x, c20.y\ncall l2\ncall l2\nret\n"
                  "label l2\nadd r0.x, r0.x, c20.y\ncall l3\ncall l3\nret\n"
                  "label l3\nadd r0.x, r0.x, c20.y\nret\n";
    trial.sets = 8;
    flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, called_4_deep);
}

/* A subroutine contains a loop that some lanes leave, and is called where lanes have diverged. */
static void called_in_loop(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    copy(o, 1, r[0]);
    r[0][0] = 0;
    for (int i = 0; i < 4 && at(o, 0, 0) > r[0][0]; i++)
        r[0][0] += at(o, 0, 1) > r[0][0] ? 2 : 1;
}

static void subroutines_in_loops_run_in_lanes_that_remain(void)
{
    struct trial trial =
        flow_trial(NULL,
                   "mov r0, r2\nmov r0.x, c20.x\nrep i0\nif_gt r1.x, r0.x\ncall l0\nelse\nbreak\nendif\n"
                   "endrep",
                   1);
    trial.setup = "def c20, 0, 1, 2, 0\ndefi i0, 4, 0, 0, 0\n";
    trial.after =
        "ret\nlabel l0\nif_gt r1.y, r0.x\nadd r0.x, r0.x, c20.z\nelse\nadd r0.x, r0.x, c20.y\nendif\nret\n";
    trial.requested = 1;
    flow_on_all(flow_dynamically, FLOW_DYNAMICALLY, trial, called_in_loop);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(booleans_choose);
    RUN_TEST(comparisons_choose_lane_by_lane);
    RUN_TEST(predicates_choose);
    RUN_TEST(conditions_nest_24_deep);
    RUN_TEST(addresses_and_predicates_diverge_too);
    RUN_TEST(subroutines_run_where_they_are_called);
    RUN_TEST(predicates_call_lane_by_lane);
    RUN_TEST(conditional_calls_inside_of_conditions_and_loops_write_in_their_lanes);
    RUN_TEST(subroutines_call_4_deep);
    RUN_TEST(subroutines_in_loops_run_in_lanes_that_remain);
    return UNITY_END();
}
