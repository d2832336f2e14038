/* Splits each value into parts: a program of N lanes becomes one of the same lanes in N / P parts of P lanes,
 * one register each. So one pass of a routine's loop computes two or four registers of pixels, and a routine
 * of one lane has the four pixels of a quad in four registers.
 *
 * The parts of a value are consecutive instructions, part 0 first. Their memory is the part's:
 *
 *   load, store base + k     ->  base + k + 4 * P * part
 *   scatter base + k         ->  base + k + P * part * field
 *   set, get variable k      ->  variable k * parts + part; so are put and take
 *
 * A value that is equal in all lanes has one instruction: literals, uniforms, slots of the constant table,
 * and what is computed from them. A region or a loop runs for all parts if a lane of any part is set: its
 * mask is the union of the parts. Consecutive gathers of neighbouring words stay together, part by part, as
 * do scatters, because their code moves several words together.
 *
 * Parts of four or more lanes have whole quads, so a permutation concerns each part by itself. With one lane,
 * a part of a permutation is a part of its operand, without an instruction; the number of parts is then at
 * least four.
 *
 * If the program would exceed IR_CAPACITY, there are fewer parts. */
#include "engines/specialize/passes/pass.h"

enum { QUAD = 4, ROW_BYTES = 16 };

struct split_memory {
    uint16_t part[IR_CAPACITY][IR_PARTS]; /* of each old value its parts, in numbers of the new program */
};

static_assert(sizeof(struct split_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct split {
    const struct ir *ir;
    uint16_t (*part)[IR_PARTS];
    struct ir_instruction *to;
    unsigned lanes, parts;
    uint32_t count;
    uint16_t repeats; /* the union of the masks of the next `again`, 0: not yet computed */
    bool full;
};

static uint16_t append(struct split *s, struct ir_instruction instruction)
{
    if (s->count == IR_CAPACITY) {
        s->full = true;
        return 0;
    }
    s->to[s->count] = instruction;
    return (uint16_t)s->count++;
}

/* Returns true if all parts of a value are one instruction. */
static bool is_one(const struct split *s, unsigned value)
{
    for (unsigned p = 1; p < s->parts; p++)
        if (s->part[value][p] != s->part[value][0])
            return false;
    return true;
}

/* Returns true if the instruction's value is equal in all lanes because its operands are. */
static bool is_uniform(const struct split *s, const struct ir_instruction *i)
{
    unsigned properties = ir_properties(i);
    if (i->op == IR_literal || i->op == IR_constant || i->op == IR_uniform)
        return true;
    if (!(properties & IR_COMPUTES) && i->op != IR_copy && i->op != IR_gather && i->op != IR_permute)
        return false;
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (!is_one(s, i->operand[o]))
            return false;
    return true;
}

/* Part p of an instruction. */
static struct ir_instruction part_of(const struct split *s, const struct ir_instruction *i, unsigned p)
{
    struct ir_instruction part = *i;
    int32_t lane = (int32_t)(s->lanes * p);
    for (int o = 0; o < 3; o++)
        part.operand[o] = s->part[i->operand[o]][p];
    if (i->op == IR_load || i->op == IR_store || i->op == IR_store_where)
        part.k += 4 * lane;
    else if (i->op == IR_scatter)
        part.k += lane * i->field;
    else if (ir_properties(i) & (IR_VARIABLE | IR_EXCHANGED))
        part.k = i->k * (int32_t)s->parts + (int32_t)p;
    return part;
}

/* The union of a mask's parts, for the instruction `at`. */
static uint16_t union_of(struct split *s, const struct ir_instruction *at)
{
    const uint16_t *part = s->part[at->operand[0]];
    uint16_t all = part[0];
    if (is_one(s, at->operand[0]))
        return all;
    for (unsigned p = 1; p < s->parts; p++)
        all = append(s, (struct ir_instruction){.op = IR_or_m,
                                                .type = TYPE_msk,
                                                .operand = {all, part[p]},
                                                .line = at->line,
                                                .file = at->file,
                                                .origin = at->origin});
    return all;
}

/* Next values directly precede the end of the loop, so the union of its masks is before them. */
static void prepare_again(struct split *s, uint32_t number)
{
    while (s->ir->instruction[number].op != IR_again)
        number++;
    if (!s->repeats)
        s->repeats = union_of(s, &s->ir->instruction[number]);
}

static void split_control(struct split *s, uint32_t number)
{
    struct ir_instruction control = s->ir->instruction[number];
    if (control.op == IR_again) {
        prepare_again(s, number);
        control.operand[0] = s->repeats;
        s->repeats = 0;
    } else if (control.op == IR_when)
        control.operand[0] = union_of(s, &control);
    append(s, control);
}

/* The number of instructions, from this one on, that stay together: a window and its gathers; gathers or
 * scatters of neighbouring words. Scatters of a row change their order, which has no effect if the records
 * are at least a row apart. */
static uint32_t run_length(const struct split *s, uint32_t number)
{
    const struct ir_instruction *first = &s->ir->instruction[number];
    uint32_t n = 1;
    if (first->op == IR_window) {
        while (n <= first->scale && number + n < s->ir->count && first[n].op == IR_gather)
            n++;
        return n;
    }
    if (first->op != IR_gather && (first->op != IR_scatter || first->field < ROW_BYTES))
        return 1;
    for (; n < ROW_BYTES / 4 && number + n < s->ir->count; n++) {
        const struct ir_instruction *i = first + n;
        if (i->op != first->op || i->base != first->base || i->field != first->field ||
            i->k != first->k + 4 * (int32_t)n)
            break;
        if (i->op == IR_gather && (i->operand[0] != first->operand[0] || i->scale != first->scale))
            break;
    }
    return n;
}

static void split_run(struct split *s, uint32_t number, uint32_t length)
{
    bool once = is_uniform(s, &s->ir->instruction[number]);
    for (unsigned p = 0; p < s->parts; p++)
        for (uint32_t n = number; n < number + length; n++)
            s->part[n][p] = p && once ? s->part[n][0] : append(s, part_of(s, &s->ir->instruction[n], p));
}

static void split_permutation(struct split *s, uint32_t number)
{
    const struct ir_instruction *i = &s->ir->instruction[number];
    for (unsigned p = 0; p < s->parts; p++) {
        unsigned lane = (unsigned)i->k >> 2 * (p % QUAD) & (QUAD - 1);
        s->part[number][p] = s->part[i->operand[0]][p / QUAD * QUAD + lane];
    }
}

/* Splits one instruction, or several that stay together. Returns the number of the next one. */
static uint32_t split_instruction(struct split *s, uint32_t number)
{
    const struct ir_instruction *i = &s->ir->instruction[number];
    uint32_t length = 1;
    if (i->op == IR_nop)
        return number + 1;
    if (i->op == IR_next)
        prepare_again(s, number);
    if (ir_properties(i) & (IR_OPENS | IR_CLOSES | IR_CALLS) || i->op == IR_section || i->op == IR_repeat)
        split_control(s, number);
    else if (i->op == IR_permute && s->lanes == 1)
        split_permutation(s, number);
    else
        split_run(s, number, length = run_length(s, number));
    return number + length;
}

static bool is_permuted(const struct ir *ir)
{
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op == IR_permute)
            return true;
    return false;
}

/* Returns false if the program would be too long. */
static bool split(struct ir *ir, struct pass_memory *memory, unsigned parts)
{
    struct split_memory *m = pass_scratch(memory, sizeof *m);
    struct split s = {.ir = ir,
                      .part = m->part,
                      .to = memory->rebuilt,
                      .lanes = memory->lanes,
                      .parts = parts,
                      .count = pass_rebuild(ir, memory)};
    for (unsigned p = 0; p < parts; p++)
        m->part[0][p] = 0;
    for (uint32_t number = 1; number < ir->count && !s.full;)
        number = split_instruction(&s, number);
    if (s.full)
        return false;
    pass_replace(ir, memory, s.count);
    ir->parts = parts;
    ir->phis *= parts;
    ir->variables *= parts;
    ir->exchanged *= parts;
    return true;
}

unsigned pass_split(struct ir *ir, struct pass_memory *memory)
{
    unsigned least = memory->lanes == 1 && is_permuted(ir) ? QUAD : 1;
    unsigned parts = memory->parts > least ? memory->parts : least;
    if (ir->parts > 1)
        return 0;
    for (; parts > 1 && !split(ir, memory, parts); parts /= 2)
        if (parts == least) {
            ir->overflow = true;
            return 0;
        }
    return parts > 1 ? ir->count : 0;
}
