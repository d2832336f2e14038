#include "ir/ir.h"

#include "base/bits.h"
#include "ir/field.h"

#include <string.h>

#define OPERANDS_flt   1
#define OPERANDS_itg   1
#define OPERANDS_fix   1
#define OPERANDS_msk   1
#define OPERANDS_any   1
#define OPERANDS_non   0
#define COMMUTES       IR_COMMUTES
#define COUNT(a, b, c) (OPERANDS_##a + OPERANDS_##b + OPERANDS_##c)

#define IR_OP(name, result, a, b, c, properties, ...)                                                        \
    [IR_##name] = {#name, TYPE_##result, {TYPE_##a, TYPE_##b, TYPE_##c}, COUNT(a, b, c), properties},
#define OP(name, result, a, b, c, properties, expression)                                                    \
    IR_OP(name, result, a, b, c, IR_COMPUTES | (properties), )
#define OPK(name, result, a, b, c, properties, expression)                                                   \
    IR_OP(name, result, a, b, c, IR_COMPUTES | IR_SHIFTS | (properties), )
#define CAST(name, ...)

const struct ir_op_information ir_op_information[IR_OP_COUNT] = {
    [IR_nop] = {"nop", TYPE_non, {0}, 0, 0},
#include "def/op.def"
#include "def/ir.def"
#include "def/engine/lowered.def"
};

#undef OP
#undef OPK
#undef CAST
#undef IR_OP

static const char *const type_name[] = {"   ", "flt", "itg", "fix", "msk"};

static const char *const base_name[BASE_COUNT] = {
#define BASE(name, meaning) #name,
#include "def/base.def"
#undef BASE
};

void ir_start(struct ir *ir)
{
    ir->count = 1;
    ir->file_count = ir->constant_count = ir->loops = ir->variables = ir->phis = ir->steps = 0;
    ir->subroutines = ir->exchanged = ir->samplings = 0;
    ir->parts = ir->chunks = 1;
    ir->preamble = false;
    ir->early = false;
    ir->early_words = 0;
    ir->typed = true;
    ir->unit = UNIT_COUNT;
    ir->overflow = ir->span = ir->separated = false;
    ir->column_words = ir->row_words = ir->near_words = ir->near_columns = ir->near_rows = 0;
    ir->stretch_words = 0;
    memset(&ir->instruction[0], 0, sizeof ir->instruction[0]);
}

void ir_duplicate(struct ir *ir, const struct ir *from)
{
    memcpy(ir, from, offsetof(struct ir, instruction) + from->count * sizeof *from->instruction);
    memcpy(ir->step, from->step, from->steps * sizeof *from->step);
    ir->steps = from->steps;
    memcpy(ir->sampling, from->sampling, from->samplings * sizeof *from->sampling);
    ir->samplings = from->samplings;
}

static void count_control(struct ir *ir, const struct ir_instruction *i)
{
    if (i->op == IR_loop)
        ir->loops++;
    else if (i->op != IR_when && ir->variables <= (uint32_t)i->k)
        ir->variables = (uint32_t)i->k + 1;
}

uint16_t ir_append(struct ir *ir, struct ir_instruction instruction)
{
    if (ir->count == IR_CAPACITY) {
        ir->overflow = true;
        return 0;
    }
    if (ir_properties(&instruction) & (IR_OPENS | IR_VARIABLE))
        count_control(ir, &instruction);
    instruction.origin = (uint16_t)ir->count;
    ir->instruction[ir->count] = instruction;
    return (uint16_t)ir->count++;
}

/* A step without instructions is replaced by the next one, so there are fewer steps than instructions. */
void ir_note_step(struct ir *ir, uint32_t step)
{
    if (ir->steps && ir->step[ir->steps - 1].first == ir->count)
        ir->steps--;
    if (ir->count < IR_CAPACITY)
        ir->step[ir->steps++] = (struct ir_step){ir->count, step};
}

void ir_note_sampling(struct ir *ir, bool begins)
{
    if (ir->samplings == IR_SAMPLINGS)
        return;
    if (begins)
        ir->sampling[ir->samplings].first = ir->count;
    else
        ir->sampling[ir->samplings++].end = ir->count;
}

uint32_t ir_step_of(const struct ir *ir, uint32_t origin)
{
    uint32_t low = 0, high = ir->steps;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (ir->step[middle].first <= origin)
            low = middle + 1;
        else
            high = middle;
    }
    return origin && low ? ir->step[low - 1].step : NO_STEP;
}

bool ir_is_invariant_read(const struct ir_instruction *instruction)
{
    return ir_properties(instruction) & IR_READS && instruction->base != BASE_COLOR &&
           instruction->base != BASE_DEPTH && instruction->base != BASE_OUTPUT;
}

uint32_t ir_other_end(const struct ir *ir, uint32_t number)
{
    bool opens = ir_properties(&ir->instruction[number]) & IR_OPENS;
    for (int depth = 0;; number += opens ? 1 : UINT32_MAX) {
        unsigned properties = ir_properties(&ir->instruction[number]);
        depth += (properties & IR_OPENS) != 0;
        depth -= (properties & IR_CLOSES) != 0;
        if (!depth)
            return number;
    }
}

uint32_t ir_find_body(const struct ir *ir)
{
    uint32_t number = ir->preamble ? 1 : ir->count;
    while (number < ir->count && ir->instruction[number].op != IR_section)
        number++;
    return number < ir->count ? number + 1 : 1;
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

static void print_literal(const struct ir_instruction *i, FILE *out)
{
    float value = bits_to_float((uint32_t)i->k);
    if (i->type == TYPE_flt)
        fprintf(out, " %.9g", (double)value);
    else
        fprintf(out, " 0x%x", (unsigned)i->k);
}

/* Prints the fields by their names. Returns false if they have none. */
static bool print_fields(const struct ir *ir, const struct ir_instruction *i, FILE *out)
{
    struct ir_field pointer, field;
    if (ir->unit == UNIT_COUNT || ir_find_memory(ir, i, &pointer, &field) ||
        !*pointer.name + !*field.name == 2)
        return false;
    fprintf(out, " %s %s%s%s", base_name[i->base], pointer.name, *pointer.name ? "->" : "", field.name);
    if (!*field.name)
        fprintf(out, "+%d", (int)i->k);
    return true;
}

static void print_offsets(const struct ir_instruction *i, FILE *out)
{
    fprintf(out, " %s", base_name[i->base]);
    if (i->op == IR_gather && i->field != GATHER_DIRECT)
        fprintf(out, "[%d]->", (int)i->field);
    fprintf(out, "+%d", (int)i->k);
}

static void print_memory(const struct ir *ir, const struct ir_instruction *i, FILE *out)
{
    if (!print_fields(ir, i, out))
        print_offsets(i, out);
    if (i->op == IR_gather)
        fprintf(out, " scale %d", i->scale);
    if (i->op == IR_scatter)
        fprintf(out, " stride %d", (int)i->field);
    if (i->op == IR_uniform && i->scale == IR_UNIT)
        fprintf(out, " unit");
}

void ir_print_instruction(const struct ir *ir, uint32_t number, FILE *out)
{
    const struct ir_instruction *i = &ir->instruction[number];
    const struct ir_op_information *information = &ir_op_information[i->op];
    fprintf(out, "%s  %-9s", type_name[i->type], information->name);
    for (int o = 0; o < information->operands; o++)
        fprintf(out, " %%%u", i->operand[o]);
    if (i->op == IR_literal)
        print_literal(i, out);
    else if (information->properties & (IR_READS | IR_WRITES))
        print_memory(ir, i, out);
    else if (information->properties & IR_SHIFTS || i->op == IR_constant || i->op == IR_section ||
             i->op == IR_near_column || i->op == IR_near_row)
        fprintf(out, " %d", (int)i->k);
    else if (i->op == IR_stretch)
        fprintf(out, " +%d scale %d", (int)i->k, i->scale);
    else if (i->op == IR_stretched)
        fprintf(out, " %s+%d block %d", i->field ? "lower" : "upper", (int)i->k, i->scale);
    else if (i->op == IR_near)
        fprintf(out, " %s[%d]->", base_name[i->base], (int)i->field);
    else if (information->properties & IR_VARIABLE)
        fprintf(out, " variable %d", (int)i->k);
    else if (information->properties & IR_EXCHANGED)
        fprintf(out, " exchanged %d", (int)i->k);
    else if (i->op == IR_call)
        fprintf(out, " subroutine %d job+%d", (int)i->k, (int)i->field);
    else if (i->op == IR_subroutine)
        fprintf(out, " %d", (int)i->k);
    else if (i->op == IR_window) {
        fprintf(out, " %s[%d]->", base_name[i->base], (int)i->field);
        if (i->k)
            fprintf(out, " pitch +%d", (int)i->k);
    }
}

void ir_print_source(const struct ir *ir, const struct program_text *text, uint32_t origin, uint32_t *last,
                     FILE *out)
{
    uint32_t step = ir_step_of(ir, origin);
    if (!text || step >= text->steps || text->line_of_step[step] == *last)
        return;
    *last = text->line_of_step[step];
    fprintf(out, "; shader:%u: %s\n", *last, text->line[*last - 1]);
}

void ir_print(const struct ir *ir, const struct program_text *text, FILE *out)
{
    uint32_t last = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (i->op == IR_nop)
            continue;
        ir_print_source(ir, text, i->origin, &last, out);
        fprintf(out, "%5u  ", number);
        ir_print_instruction(ir, number, out);
        if (i->line)
            fprintf(out, "    ; %s:%u", ir->file[i->file], i->line);
        fputc('\n', out);
    }
}
