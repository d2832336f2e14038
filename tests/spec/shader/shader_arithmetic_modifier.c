/* The arithmetic instructions of shaders under masks of their results and under every modifier, in models of
 * every generation, against the definitions of docs/shader-semantics.md in double precision. */
#include "tests/spec/shader/operand.h"
#include "tests/support/trial/trial_arithmetic.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

#define B(c) at(o, 1, c)
#define C(c) at(o, 2, c)

/* --- Masks --------------------------------------------------------------------------------------------- */

static const struct arithmetic_row *masked_row;
static unsigned mask;

/* Components outside of the mask are those of the third operand. If the row has four lines with one component
 * each, its x is the result of all components. */
static void masked_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    double whole[TRIAL_RESULTS][4];
    int scalar = strchr(masked_row->body, '@') != NULL;
    masked_row->reference(t, o, whole);
    for (int c = 0; c < 4; c++)
        r[0][c] = mask >> c & 1 ? whole[0][scalar ? 0 : c] : C(c);
}

static void mask_body(char *text, size_t bytes)
{
    const char *body = masked_row->body, *end = strrchr(body, '\n');
    const char *result = strstr(end ? end : body, " r0") + 3, *rest = strchr(result, ',');
    size_t used = (size_t)snprintf(text, bytes, "mov r0, r3\n%.*s.", (int)(result - body), body);
    for (int c = 0; c < 4; c++)
        if (mask >> c & 1)
            text[used++] = "xyzw"[c];
    for (; *rest && used + 1 < bytes; rest++)
        text[used++] = *rest == '@' ? 'x' : *rest;
    text[used] = 0;
}

static int is_allowed(uint8_t masks, const struct shader_model *model)
{
    switch (masks) {
    case MASKS_ANY: return 1;
    case MASKS_WITHIN_XYZ: return mask < 8;
    case MASKS_WITHIN_XY: return mask < 4;
    case MASKS_NORMAL: return mask == 7 || mask == 15;
    case MASKS_FRACTION: return shader_major(model) > 1 || mask == 2 || mask == 3;
    default: return 0; /* they have one, which the row has */
    }
}

static void try_masks(const struct arithmetic_row *row, const struct shader_model *model)
{
    char body[512];
    const struct shader_operation *operation = &shader_operations[row->opcode];
    if (shader_slots(operation, model) < 0 ||
        row->flags & (shader_major(model) == 1 ? ARITHMETIC_NOT_1 : ARITHMETIC_ONLY_1))
        return;
    masked_row = row;
    for (mask = 1; mask < 16; mask++) {
        if (!is_allowed(operation->masks, model))
            continue;
        mask_body(body, sizeof body);
        struct trial trial = {.model = model->name, .setup = row->setup, .body = body, .results = 1};
        trial.operands = trial_ordinary;
        trial.sets = 12;
        trial.alone = shader_major(model) < 3 || (mask != 6 && mask != 9 && mask != 2);
        trial_expect_within(&trial, masked_reference, row->relative, row->absolute);
    }
}

static void masks_do_not_change_the_other_components(void)
{
    for (unsigned m = 0; m < ARITHMETIC_MODELS; m++)
        for (unsigned i = 0; i < ARITHMETIC_ROWS; i++)
            try_masks(&arithmetic_rows[i], &shader_models[arithmetic_models[m]]);
}

/* --- Modifiers --------------------------------------------------------------------------------------------
 * Every instruction with modifiers of its result and of its first source, and with a predicate. */

enum dress { SATURATED, PARTIAL, NEGATED, MAGNITUDE, NEGATED_MAGNITUDE, PREDICATED, DRESSES };

static const struct {
    const char *before, *after, *source; /* the name of the instruction; replaces r1 */
} dresses[DRESSES] = {
    [SATURATED] = {"", "_sat", "r1"},
    [PARTIAL] = {"", "_pp", "r1"},
    [NEGATED] = {"", "", "-r1"},
    [MAGNITUDE] = {"", "", "r1_abs"},
    [NEGATED_MAGNITUDE] = {"", "", "-r1_abs"},
    [PREDICATED] = {"(p0) ", "", "r1"},
};

static const struct arithmetic_row *dressed_row;
static enum dress dress;
static unsigned written; /* components */

static double saturated(double value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

/* In models 2, sincos accepts only a predicate for all components. */
static int predicate_component(int c)
{
    return dressed_row->opcode == SHADER_SINCOS_2 ? 1 : c;
}

static void dressed_reference(const struct trial *t, operands o, double r[TRIAL_RESULTS][4])
{
    struct trial_operands changed = *o;
    for (int c = 0; c < 4; c++) {
        if (dress == MAGNITUDE || dress == NEGATED_MAGNITUDE)
            changed.v[0][c] = fabsf(changed.v[0][c]);
        if (dress == NEGATED || dress == NEGATED_MAGNITUDE)
            changed.v[0][c] = -changed.v[0][c];
    }
    dressed_row->reference(t, &changed, r);
    for (int c = 0; c < 4; c++) {
        int p = predicate_component(c);
        if (dress == SATURATED && written >> c & 1)
            r[0][c] = saturated(r[0][c]);
        if (dress == PREDICATED && !(C(p) > B(p)))
            r[0][c] = C(c);
    }
}

/* Writes one line with the instruction and its modifiers, and records the components that it writes. */
static void dress_line(const char *line, size_t length, const char *name, char *text)
{
    const char *result = line + strlen(name), *source = strstr(result, " r1"), *comma = strchr(result, ',');
    const char *before =
        dress == PREDICATED && dressed_row->opcode == SHADER_SINCOS_2 ? "(p0.y) " : dresses[dress].before;
    for (const char *c = result; c < comma; c++)
        for (unsigned i = 0; i < 4; i++)
            written |= (unsigned)(*c == "xyzw"[i]) << i;
    if (!memchr(result, '.', (size_t)(comma - result)))
        written = 15;
    sprintf(text + strlen(text), "%s%s%s%.*s %s%.*s", before, name, dresses[dress].after,
            (int)(source - result), result, dresses[dress].source, (int)(line + length - source - 3),
            source + 3);
}

/* Changes every line that has the row's instruction. A predicate is set in a line before. */
static void dress_body(const char *body, const char *name, char *text)
{
    written = 0;
    strcpy(text, dress == PREDICATED ? "mov r0, r3\nsetp_gt p0, r3, r2\n" : "");
    for (const char *line = body; *line;) {
        size_t length = strcspn(line, "\n"), letters = strlen(name);
        if (!strncmp(line, name, letters) && line[letters] == ' ')
            dress_line(line, length, name, text);
        else
            strncat(text, line, length);
        line += length;
        if (*line) {
            strcat(text, "\n");
            line++;
        }
    }
}

static int can_be_dressed(const struct shader_operation *operation, const struct shader_model *model)
{
    int third = shader_major(model) == 3, vertices = model->stage == STAGE_VERTEX;
    switch (dress) {
    case SATURATED: return !(operation->flags & IS_UNSATURATED) && (third || !vertices);
    case PARTIAL: return !vertices;
    case NEGATED: return 1;
    case PREDICATED: return (model->capabilities & CAN_PREDICATION) != 0;
    default: return third;
    }
}

static void try_dressed(const struct arithmetic_row *row, const struct shader_model *model)
{
    char body[512], text[700];
    const struct shader_operation *operation = &shader_operations[row->opcode];
    if (shader_slots(operation, model) < 0 ||
        row->flags & (shader_major(model) == 1 ? ARITHMETIC_NOT_1 : ARITHMETIC_ONLY_1))
        return;
    dressed_row = row;
    arithmetic_unfold(row->body, body, sizeof body);
    for (dress = 0; dress < DRESSES; dress++) {
        if (!can_be_dressed(operation, model))
            continue;
        dress_body(body, operation->name, text);
        struct trial trial = {.model = model->name, .setup = row->setup, .body = text, .results = 1};
        trial.operands = row->flags & ARITHMETIC_ORDINARY ? trial_ordinary : trial_edges;
        trial.sets = row->flags & ARITHMETIC_ORDINARY ? trial_ordinary_sets : trial_edge_sets;
        trial.alone = shader_major(model) < 3 || dress == PARTIAL || dress == NEGATED_MAGNITUDE;
        trial_expect_within(&trial, dressed_reference, row->relative, row->absolute);
    }
}

static void every_instruction_works_with_every_modifier(void)
{
    for (unsigned m = 0; m < ARITHMETIC_MODELS; m++)
        for (unsigned i = 0; i < ARITHMETIC_ROWS; i++)
            try_dressed(&arithmetic_rows[i], &shader_models[arithmetic_models[m]]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_instruction_works_with_every_modifier);
    RUN_TEST(masks_do_not_change_the_other_components);
    return UNITY_END();
}
