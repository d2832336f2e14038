/* The models of OpenGL: their instructions, their loops and returns, and temporaries that are addressed by
 * number. The results are compared with computations in C for each set of operands.
 * tests/spec/pixel/shader_opengl.c has what only pixels have. */
#include "tests/spec/shader/operand.h"
#include "tests/support/trial/trial_flow.h"

#include <math.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static const char *const models[] = {"vs_gl", "ps_gl"};

static void on_both(struct trial trial, trial_reference *reference)
{
    flow_on_all(models, 2, trial, reference);
}

/* --- Arithmetic ----------------------------------------------------------------------------------------- */

static void quotients(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        r[0][c] = rounded(at(o, 0, c) / at(o, 1, c));
        r[1][c] = rounded(sqrt(at(o, 0, c)));
    }
}

static void quotients_and_roots_are_those_of_ieee_754(void)
{
    on_both(flow_trial(NULL, "div r0, r1, r2\nsqrt r4, r1", 2), quotients);
}

static void integers_of(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        r[0][c] = floor(at(o, 0, c));
        r[1][c] = trunc(at(o, 0, c));
        r[2][c] = nearbyint(at(o, 0, c));
    }
}

static void numbers_are_rounded_to_integers(void)
{
    struct trial trial = flow_trial(NULL, "floor r0, r1\ntrunc r4, r1\nround r5, r1", 3);
    static const struct trial_operands halves[] = {
        {{{0.5f, -0.5f, 1.5f, -1.5f}}},
        {{{2.5f, 8388607.5f, -8388607.5f, 8388609}}},
        {{{0.49999997f, -0.49999997f, 16777216, 1e30f}}},
        {{{-0.25f, 0.75f, 3e9f, -3e9f}}},
    };
    on_both(trial, integers_of);
    trial.operands = halves;
    trial.sets = sizeof halves / sizeof *halves;
    on_both(trial, integers_of);
}

static void compared(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        double a = at(o, 0, c), b = at(o, 1, c);
        r[0][c] = a == b;
        r[1][c] = a != b;
        r[2][c] = a < b;
        r[3][c] = a != 0 ? b : at(o, 2, c);
    }
}

static void comparisons_give_0_or_1_and_select_by_them(void)
{
    on_both(flow_trial(NULL, "seq r0, r1, r2\nsne r4, r1, r2\nslt r5, r1, r2\nselect r6, r1, r2, r3", 4),
            compared);
}

/* --- Temporaries ---------------------------------------------------------------------------------------- */

static void written_on_one_side(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    int less = at(o, 0, 0) < at(o, 1, 0);
    copy(o, less ? 1 : 0, r[0]);
    for (int c = 0; c < 4; c++)
        r[1][c] = less && c == 0 ? at(o, 2, 0) : 0;
}

static void there_are_256_temporaries_which_begin_as_0(void)
{
    on_both(flow_trial(NULL,
                       "mov r255, r1\nif_lt r1.x, r2.x\nmov r255, r2\nmov r128.x, r3.x\nendif\n"
                       "mov r0, r255\nmov r4, r128",
                       2),
            written_on_one_side);
}

static void by_number(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    int less = at(o, 0, 0) < at(o, 1, 0);
    copy(o, less ? 1 : 0, r[0]);
    for (int c = 0; c < 4; c++)
        r[1][c] = 0;
    copy(o, less ? 1 : 2, r[2]);
    copy(o, 2, r[3]);
}

/* a0.x is 1 where x of the first operand is less, else 0; a0.y is outside of the array. */
static void arrays_are_addressed_by_number(void)
{
    struct trial trial = flow_trial(NULL,
                                    "mov r90, r1\nmov r91, r2\nmov r92, r3\nslt r20.x, r1.x, r2.x\n"
                                    "mova a0.x, r20.x\nmova a0.yz, c20\nmov r0, r90[a0.x]\n"
                                    "mov r4, r90[a0.y]\nmov r90[a0.z], r1\nmov r91[a0.x], r3\n"
                                    "mov r5, r91\nmov r6, r92",
                                    4);
    trial.setup = "def c20, 0, -100, 4, 0\narray r90, r92\n";
    on_both(trial, by_number);
}

static const float rows[4][4] = {{10, 11, 12, 13}, {20, 21, 22, 23}, {30, 31, 32, 33}, {40, 41, 42, 43}};

static void constant_by_number(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++)
        r[0][c] = (double)rows[at(o, 0, 0) < at(o, 1, 0) ? 2 : 1][c];
}

static void constants_are_addressed_by_number(void)
{
    struct trial trial = flow_trial(NULL, "slt r20.x, r1.x, r2.x\nmova a0.w, r20.x\nmov r0, c[a0.w + 1]", 1);
    trial.constant = rows;
    trial.constants = 4;
    on_both(trial, constant_by_number);
}

/* --- Loops and returns ---------------------------------------------------------------------------------- */

/* The passes that are counted: all six where x of the first operand is not less; none of three elsewhere. */
static void counted(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    int less = at(o, 0, 0) < at(o, 1, 0);
    const double expected[4] = {less ? 0 : 1 + 2 + 3 + 4 + 5 + 6, less ? 4 : 8, 0, 0};
    for (int c = 0; c < 4; c++) {
        r[0][c] = expected[c];
        r[1][c] = c == 0 ? (less ? 3 : 7) : 0;
    }
}

static void lanes_leave_passes_and_loops_by_themselves(void)
{
    struct trial trial = flow_trial(NULL,
                                    "mov r0, c20.x\nwhile\nadd r4.x, r4.x, c20.y\nbreak_gt r4.x, c20.z\n"
                                    "if_lt r1.x, r2.x\nbreak_ge r4.x, c20.w\ncontinue\nendif\n"
                                    "add r0.x, r0.x, r4.x\nendwhile\nadd r0.y, r4.x, c20.y",
                                    2);
    trial.setup = "def c20, 0, 1, 6, 3\n";
    on_both(trial, counted);
}

/* Two nested loops of five passes: the inner one continues on odd numbers where y is less, the outer one on
 * its third pass. */
static void nested(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    int less = at(o, 0, 1) < at(o, 1, 1);
    double sum = 0;
    for (int outer = 0; outer < 5; outer++) {
        for (int inner = 0; inner < 5; inner++)
            if (!(less && inner % 2))
                sum += inner + 1;
        if (outer != 2)
            sum += 100;
    }
    for (int c = 0; c < 4; c++)
        r[0][c] = c == 0 ? sum : 0;
}

static void continue_belongs_to_the_innermost_loop(void)
{
    struct trial trial = flow_trial(NULL,
                                    "mov r0, c20.x\nrep i0\nmov r20.y, c20.x\nrep i0\n"
                                    "add r20.y, r20.y, c20.y\nmul r20.z, r20.y, c20.w\nfrc r20.z, r20.z\n"
                                    "if_lt r1.y, r2.y\nif_eq r20.z, c20.x\ncontinue\nendif\nendif\n"
                                    "add r0.x, r0.x, r20.y\nendrep\nadd r20.x, r20.x, c20.y\n"
                                    "if_eq r20.x, c20.z\ncontinue\nendif\nadd r0.x, r0.x, c21.x\nendrep",
                                    1);
    trial.setup = "def c20, 0, 1, 3, 0.5\ndef c21, 100, 0, 0, 0\ndefi i0, 5, 0, 0, 0\n";
    on_both(trial, nested);
}

static void always_65536(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    (void)o;
    for (int c = 0; c < 4; c++)
        r[0][c] = c == 0 ? 65536 : 0;
}

static void a_loop_without_a_break_ends_after_65536_passes(void)
{
    struct trial trial = flow_trial(NULL, "mov r0, c20.x\nwhile\nadd r0.x, r0.x, c20.y\nendwhile", 1);
    trial.model = "vs_gl";
    trial.setup = "def c20, 0, 1, 0, 0\n";
    trial.sets = 1;
    trial_expect(&trial, always_65536);
}

/* The subroutine returns from two loops where y of the first operand is less. */
static void returned(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    int less = at(o, 0, 1) < at(o, 1, 1);
    copy(o, less ? 1 : 0, r[0]);
    if (!less)
        r[0][0] = at(o, 2, 0);
    copy(o, 2, r[1]);
    for (int c = 0; c < 4; c++)
        r[2][c] = less ? 1 : 2;
}

static void subroutines_return_from_inside_of_loops(void)
{
    struct trial trial = flow_trial(NULL, "mov r5, c20.y\ncall l0\nmov r4, r3", 3);
    trial.setup = "def c20, 0, 1, 2, 0\ndefi i0, 3, 0, 0, 0\n";
    trial.after = "ret\nlabel l0\nmov r0, r1\nrep i0\nwhile\nif_lt r1.y, r2.y\nmov r0, r2\nret\nendif\n"
                  "mov r5, c20.z\nbreak\nendwhile\nendrep\nmov r0.x, r3.x\nret\n";
    on_both(trial, returned);
}

static void subroutines_return_from_conditional_calls(void)
{
    struct trial trial = flow_trial(
        NULL, "mov r5, c20.y\nsetp_eq p0, r1, r1\nsetp_ne p0.x, c20.x, c20.y\ncallnz l0, p0.x\nmov r4, r3",
        3);
    trial.setup = "def c20, 0, 1, 2, 0\n";
    trial.after = "ret\nlabel l0\nmov r0, r1\nif_lt r1.y, r2.y\nmov r0, r2\nret\nelse\nmov r5, c20.z\nendif\n"
                  "mov r0.x, r3.x\nret\n";
    on_both(trial, returned);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(quotients_and_roots_are_those_of_ieee_754);
    RUN_TEST(numbers_are_rounded_to_integers);
    RUN_TEST(comparisons_give_0_or_1_and_select_by_them);
    RUN_TEST(there_are_256_temporaries_which_begin_as_0);
    RUN_TEST(arrays_are_addressed_by_number);
    RUN_TEST(constants_are_addressed_by_number);
    RUN_TEST(lanes_leave_passes_and_loops_by_themselves);
    RUN_TEST(continue_belongs_to_the_innermost_loop);
    RUN_TEST(a_loop_without_a_break_ends_after_65536_passes);
    RUN_TEST(subroutines_return_from_inside_of_loops);
    RUN_TEST(subroutines_return_from_conditional_calls);
    return UNITY_END();
}
