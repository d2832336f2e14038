/* Flow control of shaders: conditions, loops, breaks and subroutines, where lanes part and where they stay together,
 * against the same decisions taken in C for each set of operands. */
#include "tests/support/trial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

typedef const struct trial_operands *operands;

static double at(operands o, int operand, int c)
{
    return trial_flush(o->v[operand][c]);
}

static double rounded(double value)
{
    return (double)trial_round(value);
}

/* Models with flow control by constants, and by values. */
static const char *const statically[] = {"vs_2_0", "vs_2_x", "vs_3_0", "ps_2_x", "ps_3_0"};
static const char *const dynamically[] = {"vs_2_x", "vs_3_0", "ps_2_x", "ps_3_0"};
enum {
    STATICALLY = sizeof statically / sizeof *statically,
    DYNAMICALLY = sizeof dynamically / sizeof *dynamically
};

static struct trial trial_of(const char *model, const char *body, unsigned results)
{
    struct trial trial = {.model = model, .body = body, .results = results};
    trial.operands = trial_edges;
    trial.sets = trial_edge_sets;
    return trial;
}

static void on_all(const char *const *models, unsigned count, struct trial trial, trial_reference *reference)
{
    int requested = trial.requested;
    for (unsigned m = 0; m < count; m++) {
        trial.model = models[m];
        trial.requested = requested && models[m][3] == '3';
        trial_expect(&trial, reference);
    }
}

static void copy(operands o, int operand, double r[4])
{
    for (int c = 0; c < 4; c++)
        r[c] = at(o, operand, c);
}

/* --- Conditions -------------------------------------------------------------------------------------------
 */

static void chosen_by_booleans(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    copy(o, trial->booleans >> 3 & 1 ? 0 : 1, r[0]);
    copy(o, trial->booleans >> 15 & 1 ? 2 : 0, r[1]);
    copy(o, 1, r[2]);
}

static void booleans_choose(void)
{
    struct trial trial = trial_of(NULL,
                                  "if b3\nmov r0, r1\nelse\nmov r0, r2\nendif\n"
                                  "mov r4, r3\nif !b15\nmov r4, r1\nendif\n"
                                  "mov r5, r1\nif b4\nmov r5, r2\nendif\nif b5\nmov r5, r3\nendif",
                                  3);
    trial.setup = "defb b4, true\ndefb b5, false\n";
    trial.sets = 8;
    for (unsigned i = 0; i < 4; i++) {
        trial.booleans = (i & 1) << 3 | (i & 2) << 14;
        on_all(statically, STATICALLY, trial, chosen_by_booleans);
    }
}

static int comparison; /* by its number in def/shader_comparison.def */

static int holds(double a, double b)
{
    switch (comparison) {
    case 1: return a > b;
    case 2: return a == b;
    case 3: return a >= b;
    case 4: return a < b;
    case 5: return a != b;
    default: return a <= b;
    }
}

static void chosen_by_comparison(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        int is = holds(at(o, 0, c), at(o, 1, c));
        r[0][c] = at(o, is ? 0 : 1, c);
        r[1][c] = is ? at(o, 2, c) : 1;
    }
}

/* All six over all pairs of edges: every one but _ne is false where a NaN is compared. */
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
        struct trial trial = trial_of(NULL, body, 2);
        trial.setup = "def c20, 1, 1, 1, 1\n";
        on_all(dynamically, DYNAMICALLY, trial, chosen_by_comparison);
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
    struct trial trial = trial_of(NULL,
                                  "setp_lt p0, r1, r2\nif p0.y\nmov r0, r1\nelse\nmov r0, r2\nendif\n"
                                  "mov r4, r3\nif !p0.z\nmov r4, r1\nendif",
                                  2);
    on_all(dynamically, DYNAMICALLY, trial, chosen_by_predicate);
}

/* x: how many thresholds from -4 up in steps of 1/3 the operand is above of, up to 24; y: 100 and the depth at which
 * it was not; z: what the innermost left. */
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
    struct trial trial = trial_of(NULL, body, 1);
    trial.setup = "def c20, 0, -4, 1, 0.333333343\ndef c21, 100, 0, 0, 0\n";
    on_all(dynamically, DYNAMICALLY, trial, nested_24);
}

/* Registers that are not values: an address and a predicate, set on one side only. */
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

static void addresses_and_predicates_part_too(void)
{
    static const char *const models[] = {"vs_2_x", "vs_3_0"};
    struct trial trial =
        trial_of(NULL,
                 "mov r5, c20\nmova a0.x, r5.x\nsetp_ge p0, r1, r2\nif_gt r1.x, r2.x\nmova a0.x, r5.y\n"
                 "setp_lt p0, r1, r2\nendif\nmov r0, c[a0.x]\nmov r4, r3\n(p0) mov r4, r1",
                 2);
    trial.setup = "def c20, 1, 3, 0, 0\n";
    trial.constant = rows;
    trial.constants = 8;
    on_all(models, 2, trial, set_on_one_side);
}

/* --- Loops ------------------------------------------------------------------------------------------------
 */

static int32_t integers[4][4];

/* Horner's rule, so that order shows: r = r / 2 + 1, as often as the count says. */
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
    struct trial trial = trial_of(NULL, "mov r0, r1\nrep i0\nmad r0, r0, c20.x, c20.y\nendrep", 1);
    trial.setup = "def c20, 0.5, 1, 0, 0\n";
    trial.integer = (const int32_t(*)[4])integers;
    trial.integers = 1;
    for (unsigned i = 0; i < sizeof counts / sizeof *counts; i++) {
        integers[0][0] = counts[i];
        trial.sets = counts[i] > 20 ? 8 : trial_edge_sets;
        on_all(statically, STATICALLY, trial, repeated);
    }
    trial.setup = "def c20, 0.5, 1, 0, 0\ndefi i0, 5, 0, 0, 0\n";
    integers[0][0] = 5;
    trial.integers = 0;
    on_all(statically, STATICALLY, trial, repeated);
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
    struct trial trial = trial_of(NULL,
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
        on_all(dynamically, DYNAMICALLY, trial, repeated_in_4);
    }
}

/* The row of constants that an index stands for: 0 outside of them. */
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

/* Count, start and step: up, down into what is no constant, without a step, past the last constant, not at all. */
static void loop_counts_from_its_start_by_its_step(void)
{
    static const char *const models[] = {"vs_2_0", "vs_2_x", "vs_3_0"};
    static const int32_t numbers[][4] = {{4, 0, 1, 0},    {3, 1, 2, 0},    {6, 4, -1, 0},  {9, 6, -3, 0},
                                         {4, 3, 0, 0},    {0, 2, 1, 0},    {1, 255, 1, 0}, {5, 3, 127, 0},
                                         {3, 0, -128, 0}, {7, 255, -50, 0}};
    static float constants[256][4];
    struct trial trial =
        trial_of(NULL, "mov r0, r1\nmov r5, c20.x\nloop aL, i0\nmad r0, r0, r5, c[aL + 1]\nendloop", 1);
    memcpy(constants, rows, sizeof rows);
    for (int c = 0; c < 4; c++)
        constants[20][c] = 0.5f, constants[255][c] = (float)(c + 1);
    trial.constant = (const float(*)[4])constants;
    trial.constants = 256;
    trial.integer = (const int32_t(*)[4])integers;
    trial.integers = 1;
    for (unsigned i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        memcpy(integers[0], numbers[i], sizeof *numbers);
        on_all(models, 3, trial, counted);
    }
}

/* The inner loop's counter hides the outer one's, which is there again behind it. */
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
    struct trial trial = trial_of(
        NULL,
        "mov r0, r1\nmov r5, c20.x\nloop aL, i0\nadd r0, r0, c[aL]\nloop aL, i1\nmad r0, r0, r5, c[aL]\n"
        "endloop\nadd r0, r0, c[aL].wzyx\nendloop",
        1);
    trial.setup = "defi i0, 3, 0, 1, 0\ndefi i1, 2, 5, -1, 0\ndef c20, 0.5, 0, 0, 0\n";
    trial.constant = rows;
    trial.constants = 8;
    on_all(models, 2, trial, counted_twice);
}

/* --- Leaving loops ----------------------------------------------------------------------------------------
 */

/* x: passes begun; y: passes finished; each lane leaves when it has begun more than its first operand says. */
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
        struct trial trial = trial_of(NULL, bodies[i], 1);
        trial.setup = "def c20, 0, 1, 0, 0\ndefi i0, 6, 0, 0, 0\n";
        on_all(dynamically, DYNAMICALLY, trial, left);
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
        struct trial trial = trial_of(NULL, bodies[i], 1);
        trial.setup = "def c20, 0, 1, 0, 0\ndefi i0, 6, 0, 0, 0\n";
        on_all(dynamically, DYNAMICALLY, trial, left_at_once);
    }
}

/* All six over all pairs of edges, where every one but _ne stays with a NaN: left in the first pass if it
 * holds, in the third if not. */
static void left_by_comparison(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++)
        r[0][c] = holds(at(o, 0, c), at(o, 1, c)) ? 1 : 3;
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
        struct trial trial = trial_of(NULL, body, 1);
        trial.setup = "def c20, 0, 1, 0, 0\ndefi i0, 3, 0, 0, 0\n";
        on_all(dynamically, DYNAMICALLY, trial, left_by_comparison);
    }
}

/* A lane that left the inner loop goes on in the outer one, until it leaves that; x counts inner passes, y outer ones. */
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
        trial_of(NULL,
                 "mov r0, r3\nmov r0.xyz, c20.xxy\nrep i0\nrep i1\nbreak_lt r1.x, r0.z\n"
                 "add r0.x, r0.x, c20.y\nadd r0.z, r0.z, c20.z\nendrep\nadd r0.y, r0.y, c20.y\n"
                 "if_gt r2.x, r0.y\nmov r4, r0\nelse\nbreak\nendif\nendrep",
                 1);
    trial.setup = "def c20, 0, 1, 0.25, 0\ndefi i0, 4, 0, 0, 0\ndefi i1, 5, 0, 0, 0\n";
    trial.requested = 1;
    on_all(dynamically, DYNAMICALLY, trial, left_twice);
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
    struct trial trial = trial_of(NULL,
                                  "mov r0, r1\nmov r4, c20.x\nif_ge r1.x, r2.x\nrep i0\nbreak_lt r2.y, r4.x\n"
                                  "add r0, r0, c20.y\nadd r4, r4, c20.y\nendrep\nendif",
                                  1);
    trial.setup = "def c20, 0, 1, 0, 0\ndefi i0, 3, 0, 0, 0\n";
    on_all(dynamically, DYNAMICALLY, trial, looped_inside);
}

/* --- Subroutines ------------------------------------------------------------------------------------------
 */

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
    struct trial trial = trial_of(NULL, "mov r0, r1\ncall l0\ncall l0\ncallnz l1, b2\ncallnz l0, !b1", 1);
    trial.behind = "ret\nlabel l0\nadd r0, r0, r2\nret\nlabel l1\nmul r0, r0, r3\nret\n";
    for (unsigned i = 0; i < 4; i++) {
        trial.booleans = 2 * i;
        on_all(statically, STATICALLY, trial, called);
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
        trial_of(NULL, "mov r0, r1\nsetp_lt p0, r1, r2\ncallnz l0, p0.y\ncallnz l1, !p0.x", 1);
    trial.behind = "ret\nlabel l0\nadd r0, r0, r2\nret\nlabel l1\nmul r0, r0, r3\nret\n";
    on_all(dynamically, DYNAMICALLY, trial, called_by_predicate);
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

/* What they write is written by the condition and by the loop around the calls. */
static void conditional_calls_inside_of_conditions_and_loops_leave_what_they_wrote(void)
{
    struct trial trial = trial_of(NULL,
                                  "mov r0, r1\nsetp_lt p0, r1, r2\nif_lt r1.z, r2.z\ncallnz l0, p0.y\n"
                                  "endif\nrep i0\ncallnz l1, !p0.x\nendrep",
                                  1);
    trial.setup = "defi i0, 2, 0, 0, 0\n";
    trial.behind = "ret\nlabel l0\nadd r0, r0, r2\nret\nlabel l1\nmul r0, r0, r3\nret\n";
    on_all(dynamically, DYNAMICALLY, trial, called_inside);
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
    struct trial trial = trial_of(NULL, "mov r0, r1\nmov r0.x, c20.x\ncall l0", 1);
    trial.setup = "def c20, 0, 1, 0, 0\n";
    trial.behind = "ret\nlabel l0\nadd r0.x, r0.x, c20.y\ncall l1\ncall l1\nret\n"
                   "label l1\nadd r0.x, r0.x, c20.y\ncall l2\ncall l2\nret\n"
                   "label l2\nadd r0.x, r0.x, c20.y\ncall l3\ncall l3\nret\n"
                   "label l3\nadd r0.x, r0.x, c20.y\nret\n";
    trial.sets = 8;
    on_all(dynamically, DYNAMICALLY, trial, called_4_deep);
}

/* A subroutine in a loop that some lanes leave, called where lanes have parted. */
static void called_in_loop(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    copy(o, 1, r[0]);
    r[0][0] = 0;
    for (int i = 0; i < 4 && at(o, 0, 0) > r[0][0]; i++)
        r[0][0] += at(o, 0, 1) > r[0][0] ? 2 : 1;
}

static void subroutines_in_loops_know_who_left(void)
{
    struct trial trial =
        trial_of(NULL,
                 "mov r0, r2\nmov r0.x, c20.x\nrep i0\nif_gt r1.x, r0.x\ncall l0\nelse\nbreak\nendif\n"
                 "endrep",
                 1);
    trial.setup = "def c20, 0, 1, 2, 0\ndefi i0, 4, 0, 0, 0\n";
    trial.behind =
        "ret\nlabel l0\nif_gt r1.y, r0.x\nadd r0.x, r0.x, c20.z\nelse\nadd r0.x, r0.x, c20.y\nendif\nret\n";
    trial.requested = 1;
    on_all(dynamically, DYNAMICALLY, trial, called_in_loop);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(booleans_choose);
    RUN_TEST(comparisons_choose_lane_by_lane);
    RUN_TEST(predicates_choose);
    RUN_TEST(conditions_nest_24_deep);
    RUN_TEST(addresses_and_predicates_part_too);
    RUN_TEST(rep_repeats_by_its_count);
    RUN_TEST(rep_nests_4_deep);
    RUN_TEST(loop_counts_from_its_start_by_its_step);
    RUN_TEST(the_counter_is_the_innermost_loops);
    RUN_TEST(lanes_leave_loops_by_themselves);
    RUN_TEST(comparisons_leave_lane_by_lane);
    RUN_TEST(all_lanes_can_leave_in_the_first_pass);
    RUN_TEST(lanes_leave_the_innermost_loop_only);
    RUN_TEST(loops_run_in_the_lanes_that_enter);
    RUN_TEST(subroutines_run_where_they_are_called);
    RUN_TEST(predicates_call_lane_by_lane);
    RUN_TEST(conditional_calls_inside_of_conditions_and_loops_leave_what_they_wrote);
    RUN_TEST(subroutines_call_4_deep);
    RUN_TEST(subroutines_in_loops_know_who_left);
    return UNITY_END();
}
