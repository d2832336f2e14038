/* Combines operations with the operations that compute their operands: the rows of def/engine/fusion.def,
 * tried when an operation is appended, until none applies. The operation that computed the operand
 * remains, and readers.c drops it if no other operation reads it. */
#include "engines/stitch/plan.h"

enum { COMMUTES = 1 };

/* The origin of a combined operation's operand: an operand of the operation (X), or of the one that
 * computed its operand (Y). */
enum origin { X0, X1, X2, Y0, Y1, NO };

static const struct {
    const struct fragment *fragment;
    uint8_t operands, commutes;
} forms[FORM_COUNT] = {
#define FORM(name, becomes, operands, properties) [FORM_##name] = {&fragment_##becomes, operands, properties},
#define FUSION(operation, operand, given, becomes, a, b, c)
#include "def/engine/fusion.def"
#undef FORM
#undef FUSION
#define COUNT_flt 1
#define COUNT_itg 1
#define COUNT_fix 1
#define COUNT_msk 1
#define COUNT_non 0
#define OP(name, result, a, b, c, properties, expression)                                                    \
    [FORM_##name] = {&fragment_##name, COUNT_##a + COUNT_##b + COUNT_##c, properties},
#define OPK(name, result, a, b, c, properties, expression) OP(name, result, a, b, c, properties, expression)
#define CAST(name, result, from)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
};

static const struct rule {
    uint8_t form, operand, given, becomes;
    uint8_t origin[3];
} rules[] = {
#define FORM(name, becomes, operands, properties)
#define FUSION(operation, operand, given, becomes, a, b, c)                                                  \
    {FORM_##operation, operand, FORM_##given, FORM_##becomes, {a, b, c}},
#include "def/engine/fusion.def"
#undef FORM
#undef FUSION
};

/* The set of forms of operands that appear in a row. */
#define FORM(name, becomes, operands, properties)
#define FUSION(operation, operand, given, becomes, a, b, c) | 1ull << FORM_##given
static const uint64_t forms_given = (1ull << FORM_zero | 1ull << FORM_ones)
#include "def/engine/fusion.def"
    ;
#undef FORM
#undef FUSION

static uint64_t forms_of_operands(const struct plan *plan, const struct operation *operation)
{
    uint64_t set = 0;
    for (int i = 0; i < 3; i++)
        set |= 1ull << plan->operation[operation->operand[i]].form;
    return set;
}

static bool applies(const struct plan *plan, const struct operation *operation, const struct rule *rule)
{
    if (rule->form != operation->form)
        return false;
    const struct operation *given = &plan->operation[operation->operand[rule->operand]];
    return given->form == rule->given || (rule->given == FORM_literal && given->kind == OPERATION_LITERAL);
}

static void apply(const struct plan *plan, struct operation *operation, const struct rule *rule)
{
    const struct operation *given = &plan->operation[operation->operand[rule->operand]];
    uint32_t from[] = {operation->operand[0], operation->operand[1], operation->operand[2],
                       given->operand[0],     given->operand[1],     0};
    for (int i = 0; i < 3; i++)
        operation->operand[i] = from[rule->origin[i]];
    bool same = rule->origin[0] == X0 && rule->origin[1] == X1 &&
                operation->operands == forms[rule->becomes].operands;
    operation->fused |= !same;
    operation->form = rule->becomes;
    operation->fragment = forms[rule->becomes].fragment;
    operation->operands = forms[rule->becomes].operands;
    operation->commutes = forms[rule->becomes].commutes;
}

static const struct rule *find_rule(const struct plan *plan, const struct operation *operation)
{
    for (unsigned i = 0; i < sizeof rules / sizeof *rules; i++)
        if (applies(plan, operation, rules + i))
            return rules + i;
    return NULL;
}

void plan_fuse(const struct plan *plan, struct operation *operation)
{
    if (!(forms_of_operands(plan, operation) & forms_given))
        return;
    for (const struct rule *rule; (rule = find_rule(plan, operation));)
        apply(plan, operation, rule);
}
