/* Operations on the sources and results of instructions: modifiers, swizzles, masks, shifts, saturation,
 * predication and instructions issued in pairs. */
#include "tests/spec/shader/operand.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static int is_first(const char *model)
{
    return !strncmp(model, "ps_1", 4);
}

/* Expects results of the first operand. Texels in ps_1_x are limited to -8 to 8, so other values are tried
 * only in the way `emulated`. */
static void expect_of_first(struct trial trial, trial_reference *reference)
{
    static struct trial_operands within[64];
    trial.alone = 1;
    trial_expect(&trial, reference);
    unsigned count = 0;
    for (unsigned s = 0; s < trial_edge_sets && count < 64; s += 7) {
        within[count] = trial_edges[s];
        for (int o = 0; o < TRIAL_OPERANDS; o++)
            for (int c = 0; c < 4; c++)
                if (!(fabsf(within[count].v[o][c]) <= 8))
                    within[count].v[o][c] = (float)(o * 4 + c) - 7.5f;
        count++;
    }
    trial.alone = 0;
    trial.operands = within;
    trial.sets = count;
    trial_expect(&trial, reference);
}

static struct trial trial_of(const char *model, const char *body, unsigned results)
{
    struct trial trial = {.model = model, .body = body, .results = results};
    trial.operands = trial_edges;
    trial.sets = trial_edge_sets;
    return trial;
}

/* --- Modifiers ----------------------------------------------------------------------------------------- */

static enum shader_modifier_id modifier;

static double modified(double a)
{
    switch (modifier) {
    case MODIFIER_NEGATE: return -a;
    case MODIFIER_BIAS: return a - 0.5;
    case MODIFIER_NEGATE_BIAS: return 0.5 - a;
    case MODIFIER_SIGN: return 2 * a - 1;
    case MODIFIER_NEGATE_SIGN: return 1 - 2 * a;
    case MODIFIER_COMPLEMENT: return 1 - a;
    case MODIFIER_X2: return 2 * a;
    case MODIFIER_NEGATE_X2: return -2 * a;
    case MODIFIER_ABSOLUTE: return fabs(a);
    case MODIFIER_NEGATE_ABSOLUTE: return -fabs(a);
    default: return a;
    }
}

/* Results of ps_1_x stay within 8; NaN is the lower end. */
static double within_8(const struct trial *trial, double value)
{
    if (!is_first(trial->model))
        return value;
    return value > -8 ? value < 8 ? value : 8 : -8;
}

static void modified_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    for (int c = 0; c < 4; c++)
        r[0][c] = within_8(trial, modified(at(o, 0, c)));
}

/* Every modifier of values in every model that has it; _dz and _dw divide coordinates
 * (tests/spec/shader/shader_texture_stage.c). */
static void modifiers_change_the_operand(void)
{
    unsigned tried = 0;
    for (int m = 0; m < MODEL_COUNT; m++)
        for (int i = MODIFIER_NONE; i <= MODIFIER_NEGATE_ABSOLUTE; i++) {
            const struct shader_modifier *row = &shader_modifiers[i];
            const struct shader_model *model = &shader_models[m];
            char body[64];
            if (row->columns[model->column] != 'x' || i == MODIFIER_DIVIDE_Z || i == MODIFIER_DIVIDE_W)
                continue;
            int first = is_first(model->name);
            snprintf(body, sizeof body, "mov r0, %s%s%s", row->before, first ? "$1" : "r1", row->after);
            struct trial trial = trial_of(model->name, body, 1);
            modifier = (enum shader_modifier_id)i;
            if (first)
                expect_of_first(trial, modified_reference);
            else
                trial_expect(&trial, modified_reference);
            tried++;
        }
    TEST_ASSERT_EQUAL_UINT(2 * MODEL_COUNT + 2 * 6 + 5 * 4 + 2, tried);
}

static void each_source_has_its_own_reference(const struct trial *trial, operands o,
                                              double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++)
        r[0][c] = trial_fused(-at(o, 0, c), fabs(at(o, 1, 3 - c)), -fabs(at(o, 2, 1)));
}

static void each_source_has_its_own_modifier_and_swizzle(void)
{
    struct trial trial = trial_of("vs_3_0", "mad r0, -r1, r2_abs.wzyx, -r3_abs.y", 1);
    trial_expect(&trial, each_source_has_its_own_reference);
    trial.model = "ps_3_0";
    trial_expect(&trial, each_source_has_its_own_reference);
}

/* --- Swizzles and masks -------------------------------------------------------------------------------- */

static unsigned swizzles[TRIAL_RESULTS];

static void swizzled_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    for (unsigned i = 0; i < trial->results; i++)
        for (unsigned c = 0; c < 4; c++)
            r[i][c] = at(o, 0, (int)swizzle_component(swizzles[i], c));
}

static void append_swizzled(char *body, size_t bytes, unsigned i)
{
    size_t used = strlen(body);
    snprintf(body + used, bytes - used, "%smov r%u, r1.", i ? "\n" : "", i ? i + 3 : 0);
    for (unsigned c = 0; c < 4; c++)
        strncat(body, &"x\0y\0z\0w"[2 * swizzle_component(swizzles[i], c)], 1);
}

static void try_swizzles(const char *model, unsigned count, int alone)
{
    char body[256] = "";
    for (unsigned i = 0; i < count; i++)
        append_swizzled(body, sizeof body, i);
    struct trial trial = trial_of(model, body, count);
    trial.operands = trial_ordinary;
    trial.sets = 4;
    trial.alone = alone;
    trial_expect(&trial, swizzled_reference);
}

static void every_swizzle_reads_the_components_that_it_names(void)
{
    static const char *const any[] = {"vs_1_1", "vs_2_0", "vs_3_0", "ps_2_x", "ps_3_0"};
    for (unsigned m = 0; m < sizeof any / sizeof *any; m++)
        for (unsigned swizzle = 0; swizzle < 256; swizzle += TRIAL_RESULTS) {
            for (unsigned i = 0; i < TRIAL_RESULTS; i++)
                swizzles[i] = swizzle + i;
            try_swizzles(any[m], TRIAL_RESULTS, any[m][3] != '3');
        }
}

static void ps_2_0_has_eight_swizzles(void)
{
    static const unsigned some[2][TRIAL_RESULTS] = {
        {0x00, 0x55, 0xaa, 0xff},                                        /* .x .y .z .w */
        {0xe4, 1 | 2 << 2 | 0 | 3 << 6, 2 | 0 | 1 << 4 | 3 << 6, 0x1b}}; /* .xyzw .yzxw .zxyw .wzyx */
    for (int i = 0; i < 2; i++) {
        memcpy(swizzles, some[i], sizeof swizzles);
        try_swizzles("ps_2_0", TRIAL_RESULTS, 0);
    }
}

static void masked_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    for (unsigned i = 0; i < trial->results; i++)
        for (unsigned c = 0; c < 4; c++)
            r[i][c] = swizzles[i] >> c & 1 ? at(o, 0, (int)c) + at(o, 1, (int)c) : at(o, 2, (int)c);
}

static void every_mask_keeps_the_components_that_it_does_not_name(void)
{
    static const char *const models[] = {"vs_1_1", "vs_3_0", "ps_2_0", "ps_3_0"};
    for (unsigned m = 0; m < sizeof models / sizeof *models; m++)
        for (unsigned mask = 1; mask < 16; mask++) {
            char body[128] = "mov r0, r3\nadd r0.";
            for (unsigned c = 0; c < 4; c++)
                if (mask >> c & 1)
                    strncat(body, &"xyzw"[c], 1);
            strcat(body, ", r1, r2");
            swizzles[0] = mask;
            struct trial trial = trial_of(models[m], body, 1);
            trial.operands = trial_ordinary;
            trial.sets = 4;
            trial_expect(&trial, masked_reference);
        }
}

/* An instruction reads all of its sources before it writes. */
static void turned_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    double a[4], sum = 0;
    for (int c = 0; c < 4; c++)
        a[c] = at(o, 0, (c + 1) % 4);
    for (int c = 0; c < 4; c++)
        sum = c ? (double)trial_round(trial_fused(a[c], a[c], sum)) : (double)trial_round(a[c] * a[c]);
    for (int c = 0; c < 4; c++)
        r[0][c] = c == 1 ? sum : a[c];
}

static void sources_are_read_before_the_result_is_written(void)
{
    struct trial trial = trial_of("vs_2_0", "mov r0, r1\nmov r0, r0.yzwx\ndp4 r0.y, r0, r0", 1);
    trial_expect(&trial, turned_reference);
    trial.model = "ps_3_0";
    trial_expect(&trial, turned_reference);
}

/* --- Saturation and shifts ----------------------------------------------------------------------------- */

static double saturated(double value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

static void saturated_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        r[0][c] = saturated(at(o, 0, c) * at(o, 1, c));
        r[1][c] = c & 1 ? saturated(at(o, 0, c)) : at(o, 2, c);
    }
}

static void saturation_limits_to_0_and_1_and_changes_nan_to_0(void)
{
    static const char *const models[] = {"vs_3_0", "ps_2_0", "ps_2_x", "ps_3_0"};
    for (unsigned m = 0; m < sizeof models / sizeof *models; m++) {
        struct trial trial = trial_of(models[m], "mul_sat r0, r1, r2\nmov r4, r3\nmov_sat r4.yw, r1", 2);
        trial_expect(&trial, saturated_reference);
    }
}

/* Partial precision has the results of full precision. */
static void partial_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        r[0][c] = trial_fused(at(o, 0, c), at(o, 1, c), at(o, 2, c));
        r[1][c] = saturated(at(o, 0, c) + at(o, 1, c));
    }
}

static void partial_precision_changes_nothing(void)
{
    static const char *const models[] = {"ps_2_0", "ps_2_x", "ps_3_0"};
    for (unsigned m = 0; m < sizeof models / sizeof *models; m++) {
        struct trial trial = trial_of(models[m], "mad_pp r0, r1, r2, r3\nadd_sat_pp r4, r1, r2", 2);
        trial_expect(&trial, partial_reference);
    }
}

static int shift, saturates;

static void shifted_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    for (int c = 0; c < 4; c++) {
        double sum = (double)trial_round(at(o, 0, c) + at(o, 1, c));
        double value = ldexp(sum, shift);
        r[0][c] = saturates ? saturated(value) : within_8(trial, value);
    }
}

static void results_are_shifted_and_then_saturated(void)
{
    static const char *const names[] = {"_d8", "_d4", "_d2", "", "_x2", "_x4", "_x8"};
    static const char *const models[] = {"ps_1_1", "ps_1_2", "ps_1_3", "ps_1_4"};
    for (unsigned m = 0; m < 4; m++)
        for (shift = -3; shift <= 3; shift++)
            for (saturates = 0; saturates < 2; saturates++) {
                char body[64];
                if (m < 3 && (shift < -1 || shift > 2)) /* _x8, _d4 and _d8 are ps_1_4's */
                    continue;
                snprintf(body, sizeof body, "add%s%s r0, $1, $2", names[shift + 3], saturates ? "_sat" : "");
                struct trial trial = trial_of(models[m], body, 1);
                expect_of_first(trial, shifted_reference);
            }
}

/* --- Predication --------------------------------------------------------------------------------------- */

static int comparison; /* by its number in def/shader/shader_comparison.def */

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

/* The results with a predicate for each component, with its negation and a swizzle, and with one component
 * for all. */
static void predicated_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        double a = at(o, 0, c), b = at(o, 1, c), other = at(o, 2, c);
        r[0][c] = holds(a, b) ? a : other;
        r[1][c] = !holds(a, b) && (c == 0 || c == 2) ? b : other;
        r[2][c] = holds(at(o, 0, 2), at(o, 1, 2)) ? a : other;
        r[3][c] = !holds(at(o, 0, 3), at(o, 1, 3)) ? b : other;
    }
}

static void predicates_choose_component_by_component(void)
{
    static const char *const models[] = {"vs_2_x", "vs_3_0", "ps_2_x", "ps_3_0"};
    for (unsigned m = 0; m < sizeof models / sizeof *models; m++)
        for (comparison = 1; comparison <= 6; comparison++) {
            char body[256];
            snprintf(body, sizeof body,
                     "mov r0, r3\nmov r4, r3\nmov r5, r3\nmov r6, r3\nsetp_%s p0, r1, r2\n(p0) mov r0, r1\n"
                     "(!p0) mov r4.xz, r2\n(p0.z) mov r5, r1\n(!p0.w) mov r6, r2",
                     shader_word_name(shader_comparisons, (unsigned)comparison));
            struct trial trial = trial_of(models[m], body, 4);
            trial_expect(&trial, predicated_reference);
        }
}

/* One comparison sets two components of the predicate, and another sets the other two. The last one is set
 * only where the first is true. */
static void kept_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    (void)trial;
    for (int c = 0; c < 4; c++) {
        double a = at(o, 0, c), b = at(o, 1, c);
        int p = c < 2 ? a < b : a >= b;
        if (c == 3 && at(o, 0, 0) < at(o, 1, 0))
            p = a == b;
        r[0][c] = p ? a + b : at(o, 2, c);
    }
}

static void predicates_are_written_by_masks_and_under_predication(void)
{
    static const char *const models[] = {"vs_2_x", "vs_3_0", "ps_2_x", "ps_3_0"};
    const char *body =
        "mov r0, r3\nsetp_lt p0.xy, r1, r2\nsetp_ge p0.zw, r1, r2\n(p0.x) setp_eq p0.w, r1, r2\n"
        "(p0) add r0, r1, r2";
    for (unsigned m = 0; m < sizeof models / sizeof *models; m++) {
        struct trial trial = trial_of(models[m], body, 1);
        trial_expect(&trial, kept_reference);
    }
}

/* --- Pairs --------------------------------------------------------------------------------------------- */

static void paired_reference(const struct trial *trial, operands o, double r[TRIAL_RESULTS][4])
{
    double a[4], b[4];
    for (int c = 0; c < 4; c++) {
        a[c] = (double)trial_round(within_8(trial, at(o, 0, c)));
        b[c] = at(o, 1, c);
    }
    for (int c = 0; c < 3; c++)
        r[0][c] = within_8(trial, a[3] - b[c]);
    r[0][3] = within_8(trial, a[2] + b[3]);
}

/* The second instruction of a pair reads the registers as they were before the first one wrote. */
static void pairs_read_before_either_writes(void)
{
    static const char *const models[] = {"ps_1_1", "ps_1_2", "ps_1_3", "ps_1_4"};
    for (unsigned m = 0; m < 4; m++) {
        struct trial trial = trial_of(models[m],
                                      m < 3 ? "mov r0, $1\nsub r0.xyz, r0.w, $2\n+add r0.w, r0.z, $2"
                                            : "mov r0, $1\nsub r0.xyz, r0.w, $2\n+add r0.w, r0.z, $2.w",
                                      1);
        expect_of_first(trial, paired_reference);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(modifiers_change_the_operand);
    RUN_TEST(each_source_has_its_own_modifier_and_swizzle);
    RUN_TEST(every_swizzle_reads_the_components_that_it_names);
    RUN_TEST(ps_2_0_has_eight_swizzles);
    RUN_TEST(every_mask_keeps_the_components_that_it_does_not_name);
    RUN_TEST(sources_are_read_before_the_result_is_written);
    RUN_TEST(saturation_limits_to_0_and_1_and_changes_nan_to_0);
    RUN_TEST(partial_precision_changes_nothing);
    RUN_TEST(results_are_shifted_and_then_saturated);
    RUN_TEST(predicates_choose_component_by_component);
    RUN_TEST(predicates_are_written_by_masks_and_under_predication);
    RUN_TEST(pairs_read_before_either_writes);
    return UNITY_END();
}
