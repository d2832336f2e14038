#include "ir/ir.h"

#include <string.h>

#define OPERANDS_flt   1
#define OPERANDS_itg   1
#define OPERANDS_fix   1
#define OPERANDS_msk   1
#define OPERANDS_non   0
#define COMMUTES       IR_COMMUTES
#define COUNT(a, b, c) (OPERANDS_##a + OPERANDS_##b + OPERANDS_##c)

const struct ir_op_information ir_op_information[IR_OP_COUNT] = {
    [IR_nop] = {"nop", TYPE_non, {0}, 0, 0},
#define OP(name, result, a, b, c, properties, expression)                                                    \
    [IR_##name] = {#name, TYPE_##result, {TYPE_##a, TYPE_##b, TYPE_##c}, COUNT(a, b, c), properties},
#define OPK(name, result, a, b, c, properties, expression)                                                   \
    [IR_##name] = {#name, TYPE_##result, {TYPE_##a}, 1, IR_SHIFTS | (properties)},
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
    [IR_copy] = {"copy", TYPE_non, {0}, 1, 0},
    [IR_literal] = {"literal", TYPE_non, {0}, 0, 0},
    [IR_load] = {"load", TYPE_non, {0}, 0, IR_READS},
    [IR_uniform] = {"uniform", TYPE_non, {0}, 0, IR_READS},
    [IR_gather] = {"gather", TYPE_non, {TYPE_itg}, 1, IR_READS},
    [IR_store] = {"store", TYPE_non, {0}, 1, IR_EFFECT},
    [IR_scatter] = {"scatter", TYPE_non, {0}, 1, IR_EFFECT},
    [IR_when] = {"when", TYPE_non, {TYPE_msk}, 1, IR_EFFECT | IR_OPENS},
    [IR_end] = {"end", TYPE_non, {0}, 0, IR_EFFECT | IR_CLOSES},
    [IR_loop] = {"loop", TYPE_non, {0}, 0, IR_EFFECT | IR_OPENS},
    [IR_again] = {"again", TYPE_non, {TYPE_msk}, 1, IR_EFFECT | IR_CLOSES},
    [IR_set] = {"set", TYPE_non, {0}, 1, IR_EFFECT},
    [IR_get] = {"get", TYPE_non, {0}, 0, 0},
    [IR_constant] = {"constant", TYPE_non, {0}, 0, 0},
    [IR_permute] = {"permute", TYPE_flt, {TYPE_flt}, 1, IR_SHIFTS},
};

static const char *const type_name[] = {"   ", "flt", "itg", "fix", "msk"};

static const char *const base_name[BASE_COUNT] = {
#define BASE(name, meaning) #name,
#include "def/base.def"
#undef BASE
};

void ir_start(struct ir *ir)
{
    ir->count = 1;
    ir->file_count = ir->constant_count = ir->loops = ir->variables = 0;
    ir->overflow = 0;
    memset(&ir->instruction[0], 0, sizeof ir->instruction[0]);
}

static void count_control(struct ir *ir, const struct ir_instruction *i)
{
    if (i->op == IR_loop)
        ir->loops++;
    else if (i->op != IR_again && ir->variables <= (uint32_t)i->k)
        ir->variables = (uint32_t)i->k + 1;
}

uint16_t ir_append(struct ir *ir, struct ir_instruction instruction)
{
    if (ir->count == IR_CAPACITY) {
        ir->overflow = 1;
        return 0;
    }
    if (instruction.op >= IR_loop && instruction.op <= IR_get)
        count_control(ir, &instruction);
    ir->instruction[ir->count] = instruction;
    return (uint16_t)ir->count++;
}

int ir_is_invariant_read(const struct ir_instruction *instruction)
{
    return ir_op_information[instruction->op].properties & IR_READS && instruction->base != BASE_COLOR &&
           instruction->base != BASE_DEPTH && instruction->base != BASE_OUTPUT;
}

void ir_compact(struct ir *ir, uint16_t *map)
{
    uint32_t to = 1;
    map[0] = 0;
    for (uint32_t from = 1; from < ir->count; from++) {
        struct ir_instruction *i = &ir->instruction[from];
        if (i->op == IR_nop)
            continue;
        for (int o = 0; o < 3; o++)
            i->operand[o] = map[i->operand[o]];
        map[from] = (uint16_t)to;
        if (to != from)
            ir->instruction[to] = *i;
        to++;
    }
    ir->count = to;
}

/* Innermost open region while walking, and which regions are open. Of each variable its type, and whether it
 * holds something here: what a `when` sets it does not hold behind the end, what a loop sets it does. */
struct walk {
    uint16_t region[IR_CAPACITY]; /* of each value: the `when` or `loop` it is inside of */
    uint16_t parent[IR_CAPACITY];
    uint16_t held[IR_CAPACITY]; /* of each `when`: how many variables were held before it */
    uint8_t open[IR_CAPACITY];
    uint8_t type[VARIABLES];
    uint8_t holds[VARIABLES];
    uint16_t holding[VARIABLES]; /* in the order in which they were set first */
    uint16_t holding_count;
    uint16_t current;
};

static const char *verify_variable(const struct ir *ir, uint32_t number, struct walk *walk, char *text)
{
    const struct ir_instruction *i = &ir->instruction[number];
    if (i->k < 0 || i->k >= VARIABLES || (uint32_t)i->k >= ir->variables)
        return snprintf(text, 128, "instruction %u: there is no variable %d", number, (int)i->k), text;
    if (i->type == TYPE_non || i->type == TYPE_fix || (walk->type[i->k] && walk->type[i->k] != i->type))
        return snprintf(text, 128, "instruction %u: variable %d is of another type", number, (int)i->k), text;
    walk->type[i->k] = i->type;
    if (i->op == IR_get && !walk->holds[i->k])
        return snprintf(text, 128, "instruction %u: variable %d may hold nothing", number, (int)i->k), text;
    if (i->op == IR_set && !walk->holds[i->k]) {
        walk->holds[i->k] = 1;
        walk->holding[walk->holding_count++] = (uint16_t)i->k;
    }
    return NULL;
}

static void leave_region(struct walk *walk, const struct ir *ir)
{
    if (ir->instruction[walk->current].op == IR_when)
        while (walk->holding_count > walk->held[walk->current])
            walk->holds[walk->holding[--walk->holding_count]] = 0;
    walk->open[walk->current] = 0;
    walk->current = walk->parent[walk->current];
}

static const char *verify_operands(const struct ir *ir, uint32_t number, const struct walk *walk, char *text)
{
    const struct ir_instruction *i = &ir->instruction[number];
    const struct ir_op_information *information = &ir_op_information[i->op];
    for (int o = 0; o < 3; o++) {
        unsigned operand = i->operand[o];
        if (o >= information->operands) {
            if (operand)
                return snprintf(text, 128, "instruction %u: operand %d is superfluous", number, o), text;
            continue;
        }
        if (!operand || operand >= number)
            return snprintf(text, 128, "instruction %u: operand %d is not defined before", number, o), text;
        if (!ir->instruction[operand].type || ir->instruction[operand].op == IR_set)
            return snprintf(text, 128, "instruction %u: operand %d is no value", number, o), text;
        if (!walk->open[walk->region[operand]])
            return snprintf(text, 128, "instruction %u: operand %d leaves its region", number, o), text;
    }
    return NULL;
}

const char *ir_verify(const struct ir *ir)
{
    static struct walk walk;
    static char text[128];
    memset(walk.type, 0, sizeof walk.type);
    memset(walk.holds, 0, sizeof walk.holds);
    walk.open[0] = 1;
    walk.current = walk.holding_count = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (i->op == IR_nop)
            continue;
        const char *wrong = verify_operands(ir, number, &walk, text);
        if (!wrong && (i->op == IR_set || i->op == IR_get))
            wrong = verify_variable(ir, number, &walk, text);
        if (wrong)
            return wrong;
        walk.region[number] = walk.current;
        if (ir_op_information[i->op].properties & IR_OPENS) {
            walk.parent[number] = walk.current;
            walk.held[number] = walk.holding_count;
            walk.current = (uint16_t)number;
            walk.open[number] = 1;
        } else if (ir_op_information[i->op].properties & IR_CLOSES) {
            if (ir->instruction[walk.current].op != (i->op == IR_end ? IR_when : IR_loop))
                return snprintf(text, sizeof text, "instruction %u: ends no region of its kind", number),
                       text;
            leave_region(&walk, ir);
        }
    }
    return walk.current ? "a region is not ended" : NULL;
}

static void print_literal(const struct ir_instruction *i, FILE *out)
{
    float value;
    memcpy(&value, &i->k, sizeof value);
    if (i->type == TYPE_flt)
        fprintf(out, " %.9g", (double)value);
    else
        fprintf(out, " 0x%x", (unsigned)i->k);
}

static void print_memory(const struct ir_instruction *i, FILE *out)
{
    fprintf(out, " %s", base_name[i->base]);
    if (i->op == IR_gather && i->field != GATHER_DIRECT)
        fprintf(out, "[%d]->", (int)i->field);
    fprintf(out, "+%d", (int)i->k);
    if (i->op == IR_gather)
        fprintf(out, " scale %d", i->scale);
    if (i->op == IR_scatter)
        fprintf(out, " stride %d", (int)i->field);
}

void ir_print_instruction(const struct ir *ir, uint32_t number, FILE *out)
{
    const struct ir_instruction *i = &ir->instruction[number];
    const struct ir_op_information *information = &ir_op_information[i->op];
    fprintf(out, "%5u  %s  %-9s", number, type_name[i->type], information->name);
    for (int o = 0; o < information->operands; o++)
        fprintf(out, " %%%u", i->operand[o]);
    if (i->op == IR_literal)
        print_literal(i, out);
    else if (information->properties & IR_READS || i->op == IR_store || i->op == IR_scatter)
        print_memory(i, out);
    else if (information->properties & IR_SHIFTS || i->op == IR_constant)
        fprintf(out, " %d", (int)i->k);
    else if (i->op == IR_set || i->op == IR_get)
        fprintf(out, " variable %d", (int)i->k);
    if (i->line)
        fprintf(out, "    ; %s:%u", ir->file[i->file], i->line);
    fputc('\n', out);
}

void ir_print(const struct ir *ir, FILE *out)
{
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op != IR_nop)
            ir_print_instruction(ir, number, out);
}
