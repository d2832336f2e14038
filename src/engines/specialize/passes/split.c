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
 * With more than 16 lanes, which only pixel routines have, the parts are those of two blocks. The addresses
 * of the second block are bases of their own (NEXT_COLOR, NEXT_DEPTH, NEXT_ENTRY). Both have the same record
 * and the same table of lanes. If a call has no second block for a pass, the first one is both. Its colours
 * are read for all parts before they are stored for one, so both compute and store the same.
 *
 * A value that is equal in all lanes has one instruction: literals, uniforms, slots of the constant table,
 * and what is computed from them. One that is equal in the lanes of a block has one instruction for each. A
 * region or a loop runs for all parts if a lane of any part is set: its mask is the union of the parts.
 * Consecutive gathers of neighbouring words stay together, part by part, as do scatters, because their code
 * moves several words together.
 *
 * Parts of four or more lanes have whole quads, so a permutation concerns each part by itself. With one lane,
 * a part of a permutation is a part of its operand, without an instruction; the number of parts is then at
 * least four.
 *
 * The parts of two blocks would need many registers, if each operation of a chain had four parts in a row. So
 * operations form groups of about a chain. A group is computed for the parts of the first block, and then for
 * those of the second. The processor looks far enough ahead to compute both together. Instructions that are
 * not operations are in no group: reads and writes of colours keep their order.
 *
 * If the program would exceed IR_CAPACITY, there are fewer parts. */
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum { QUAD = 4, ROW_BYTES = 16 };

/* Operations of a group. */
enum { GROUP_LEAST = 12, GROUP_MOST = 40 };

struct split_memory {
    uint16_t part[IR_CAPACITY][IR_PARTS]; /* of each old value its parts, in numbers of the new program */
    uint16_t last[IR_CAPACITY];           /* the last use of each old value, 0: none */
};

static_assert(sizeof(struct split_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct split {
    const struct ir *ir;
    uint16_t (*part)[IR_PARTS];
    uint16_t *last;
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

/* Returns true if part p of the instruction's value, not the first, is part p - 1 of it because their
 * operands are. */
static bool is_previous(const struct split *s, const struct ir_instruction *i, unsigned p)
{
    unsigned properties = ir_properties(i);
    if (i->op == IR_literal || i->op == IR_constant || i->op == IR_uniform)
        return i->base != BASE_ENTRY || i->op != IR_uniform || s->lanes * p % BLOCK_PIXELS;
    if (!(properties & IR_COMPUTES) && i->op != IR_copy && i->op != IR_gather && i->op != IR_permute)
        return false;
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (s->part[i->operand[o]][p] != s->part[i->operand[o]][p - 1])
            return false;
    return true;
}

/* The base of the second of two blocks. */
static uint8_t next_base(unsigned base)
{
    switch (base) {
    case BASE_ENTRY: return BASE_NEXT_ENTRY;
    case BASE_COLOR: return BASE_NEXT_COLOR;
    case BASE_DEPTH: return BASE_NEXT_DEPTH;
    default: return (uint8_t)base;
    }
}

/* Part p of an instruction. */
static struct ir_instruction part_of(const struct split *s, const struct ir_instruction *i, unsigned p)
{
    struct ir_instruction part = *i;
    int32_t lane = (int32_t)(s->lanes * p % BLOCK_PIXELS);
    bool next = s->lanes * p >= BLOCK_PIXELS;
    for (int o = 0; o < 3; o++)
        part.operand[o] = s->part[i->operand[o]][p];
    if (i->op == IR_load || i->op == IR_store || i->op == IR_store_where)
        part.k += 4 * lane;
    else if (i->op == IR_scatter)
        part.k += lane * i->field;
    else if (ir_properties(i) & (IR_VARIABLE | IR_EXCHANGED))
        part.k = i->k * (int32_t)s->parts + (int32_t)p;
    if (next && i->op != IR_constant)
        part.base = next_base(i->base);
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

/* Appends part p of `length` instructions. All of them are part p - 1 if the first one is. */
static void split_part(struct split *s, uint32_t number, uint32_t length, unsigned p)
{
    bool same = p && is_previous(s, &s->ir->instruction[number], p);
    for (uint32_t n = number; n < number + length; n++)
        s->part[n][p] = same ? s->part[n][p - 1] : append(s, part_of(s, &s->ir->instruction[n], p));
}

static void split_run(struct split *s, uint32_t number, uint32_t length)
{
    for (unsigned p = 0; p < s->parts; p++)
        split_part(s, number, length, p);
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
    if (ir_properties(i) & (IR_OPENS | IR_CLOSES | IR_CALLS) || i->op == IR_section || i->op == IR_repeat ||
        i->op == IR_rest)
        split_control(s, number);
    else if (i->op == IR_permute && s->lanes == 1)
        split_permutation(s, number);
    else
        split_run(s, number, length = run_length(s, number));
    return number + length;
}

/* --- Groups of two blocks ------------------------------------------------------------------------------- */

static bool has_two_blocks(const struct split *s)
{
    return s->lanes * s->parts > BLOCK_PIXELS;
}

/* True if the value is in memory from the start, and so needs no register. */
static bool is_in_memory(const struct ir_instruction *i)
{
    return i->op == IR_literal || i->op == IR_constant || i->op == IR_uniform;
}

static bool is_operation(const struct ir_instruction *i)
{
    return ir_properties(i) & IR_COMPUTES || i->op == IR_copy || i->op == IR_nop || is_in_memory(i);
}

static void find_last_uses(const struct ir *ir, uint16_t *last)
{
    memset(last, 0, ir->count * sizeof *last);
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        for (unsigned o = 0; o < ir_operands(i); o++)
            last[i->operand[o]] = (uint16_t)number;
    }
}

/* How many more registers the values from `begin` on have after an instruction than before it. */
static int change_of_registers(const struct split *s, uint32_t begin, uint32_t number)
{
    const struct ir_instruction *i = &s->ir->instruction[number];
    int change = s->last[number] > number && !is_in_memory(i);
    for (unsigned o = 0; o < ir_operands(i); o++) {
        const unsigned value = i->operand[o];
        bool again = (o > 0 && value == i->operand[0]) || (o > 1 && value == i->operand[1]);
        change -=
            value >= begin && s->last[value] == number && !again && !is_in_memory(&s->ir->instruction[value]);
    }
    return change;
}

/* The end of the group that begins here: where the fewest of its values are used later. Returns `begin` if
 * there is no operation. */
static uint32_t end_of_group(const struct split *s, uint32_t begin)
{
    uint32_t end = begin, best = begin;
    int registers = 0, least = GROUP_MOST;
    while (end < s->ir->count && end < begin + GROUP_MOST && is_operation(&s->ir->instruction[end])) {
        registers += change_of_registers(s, begin, end++);
        if (end >= begin + GROUP_LEAST && registers <= least) {
            least = registers;
            best = end;
        }
    }
    return best > begin ? best : end;
}

/* Splits operations block by block. */
static void split_group(struct split *s, uint32_t begin, uint32_t end)
{
    const unsigned parts = BLOCK_PIXELS / s->lanes;
    for (unsigned first = 0; first < s->parts; first += parts)
        for (uint32_t n = begin; n < end; n++)
            for (unsigned p = first; p < first + parts && s->ir->instruction[n].op != IR_nop; p++)
                split_part(s, n, 1, p);
}

/* --- Programs ------------------------------------------------------------------------------------------- */

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
                      .last = m->last,
                      .to = memory->rebuilt,
                      .lanes = memory->lanes,
                      .parts = parts,
                      .count = pass_rebuild(ir, memory)};
    for (unsigned p = 0; p < parts; p++)
        m->part[0][p] = 0;
    find_last_uses(ir, m->last);
    for (uint32_t number = 1, end; number < ir->count && !s.full; number = end) {
        end = has_two_blocks(&s) ? end_of_group(&s, number) : number;
        if (end > number)
            split_group(&s, number, end);
        else
            end = split_instruction(&s, number);
    }
    if (s.full)
        return false;
    pass_replace(ir, memory, s.count);
    ir->parts = parts;
    ir->phis *= parts;
    ir->variables *= parts;
    ir->exchanged *= parts;
    return true;
}

bool pass_may_pair(const struct ir *ir)
{
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (i->op == IR_window || i->op == IR_near || (ir_properties(i) & IR_WRITES && i->base == BASE_LANES))
            return false;
    }
    return true;
}

unsigned pass_split(struct ir *ir, struct pass_memory *memory)
{
    unsigned least = memory->lanes == 1 && is_permuted(ir) ? QUAD : 1;
    unsigned parts = memory->parts > least ? memory->parts : least;
    if (ir->parts > 1)
        return 0;
    if (parts * memory->lanes > BLOCK_PIXELS && !pass_may_pair(ir))
        parts = BLOCK_PIXELS / memory->lanes;
    for (; parts > 1 && !split(ir, memory, parts); parts /= 2)
        if (parts == least) {
            ir->overflow = true;
            return 0;
        }
    return parts > 1 ? ir->count : 0;
}
