/* Estimates the time of a block of 16 pixels in the shapes of a program of 8 lanes: one register for each
 * value and two passes of the program; two registers and one pass (split.c); four registers and one pass for
 * two blocks. The program does not change. If `may_pair` is set, chooses four parts for the pass split where
 * they are faster than two.
 *
 * Two independent halves of a block hide each other's latency where one half does not keep the processor
 * busy: if the program is longer than the processor looks ahead, the next pass is out of reach. On the
 * other hand, two registers for each value leave fewer for each, so that more values are in memory.
 *
 * The estimate executes the program once on a model of a processor. It takes in WIDTH slots a cycle
 * (def/engine/cost.def), starts each instruction when its operands are there, and retires them in order,
 * at most AHEAD slots after the oldest that is not complete. With two registers each instruction that is
 * not the same in all lanes takes twice its slots. Then the pressure on registers is known. From it follow
 * values that are stored and read again, and constants without a register. A multiply-add reads only one
 * from memory.
 *
 * Times of a pass are measured in two ways, up to the last slot that is taken in and up to the last that
 * retires: the next pass begins between them. The estimate is their mean. The parts of a program in two parts
 * (early.c) are shorter, so that a pass begins long before the one before it ends: several passes are
 * executed on the model, and their mean distance counts.
 *
 * A separated program (separate.c) has one register for each value. Only its inner loop counts. The builder
 * gives its estimate to the program with two registers. */
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum {
    WIDTH = 3,       /* slots a cycle: vector instructions, with what is between them */
    AHEAD = 224,     /* slots of the reorder buffer: 224 in Skylake, 256 in Zen 3 */
    PASSES = 4,      /* that are executed one after the other, after a first one */
    REGISTERS = 13,  /* that values can have */
    PASS_SLOTS = 8,  /* of the loop over the parts of a block */
    SPILL_SLOTS = 1, /* a store; the loads are operands */
    HINTED_SLOTS = 5 /* of a gather after a window or a hint (window.c, near.c) */
};

struct cost {
    uint8_t latency, slots;
    bool known;
};

static const struct cost costs[IR_OP_COUNT] = {
#define COST(op, latency, slots) [IR_##op] = {latency, slots, true},
#include "def/engine/cost.def"
#undef COST
};

struct shape_memory {
    uint32_t ready[IR_CAPACITY];   /* by value: when it is computed, in slots */
    uint32_t retired[IR_CAPACITY]; /* by instruction: when it and those before it are complete, in slots */
    uint32_t taken[IR_CAPACITY];   /* the slots up to it */
    uint32_t last[IR_CAPACITY];    /* by value: its last use, 0: none */
    uint16_t uses[IR_CONSTANTS];   /* by slot of the constant table */
    uint8_t is_one[IR_CAPACITY];   /* the value is the same in all lanes: one register in both shapes */
    uint8_t is_kept[IR_CONSTANTS];
};

static_assert(sizeof(struct shape_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct shape {
    const struct ir *ir;
    struct shape_memory *memory;
    uint32_t body, end; /* what is repeated for each block */
    unsigned parts;
    uint32_t hinted; /* gathers up to here follow a window or a hint */
};

static struct cost cost_of(const struct ir_instruction *i)
{
    return costs[i->op].known ? costs[i->op] : (struct cost){1, 1, true};
}

/* As split.c decides it. */
static bool is_uniform(const struct shape_memory *m, const struct ir_instruction *i)
{
    if (i->op == IR_literal || i->op == IR_constant || i->op == IR_uniform)
        return true;
    if (!(ir_properties(i) & IR_COMPUTES) && i->op != IR_copy && i->op != IR_gather && i->op != IR_permute)
        return false;
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (!m->is_one[i->operand[o]])
            return false;
    return true;
}

static void find_uses(const struct shape *s)
{
    struct shape_memory *m = s->memory;
    memset(m->last, 0, s->ir->count * sizeof *m->last);
    memset(m->uses, 0, sizeof m->uses);
    m->ready[0] = 0;
    for (uint32_t n = 1; n < s->ir->count; n++) {
        const struct ir_instruction *i = &s->ir->instruction[n];
        m->is_one[n] = n < s->body || is_uniform(m, i);
        m->ready[n] = 0;
        for (unsigned o = 0; o < ir_operands(i); o++) {
            const struct ir_instruction *operand = &s->ir->instruction[i->operand[o]];
            m->last[i->operand[o]] = n;
            m->uses[operand->op == IR_constant ? operand->k : 0] += operand->op == IR_constant;
        }
    }
}

/* True if the value is in memory from the start, and so needs no register. */
static bool is_in_memory(const struct shape *s, uint32_t value)
{
    return value < s->body || s->ir->instruction[value].op == IR_literal ||
           s->ir->instruction[value].op == IR_constant;
}

struct pressure {
    unsigned alive, most; /* registers that values would have */
    unsigned out;         /* of `alive`, those that are in memory */
    uint32_t spills;
};

static void end_lives(const struct shape *s, uint32_t n, struct pressure *p)
{
    const struct ir_instruction *i = &s->ir->instruction[n];
    for (unsigned o = 0; o < ir_operands(i); o++) {
        uint32_t value = i->operand[o];
        bool again = (o > 0 && value == i->operand[0]) || (o > 1 && value == i->operand[1]);
        if (s->memory->last[value] == n && !again && !is_in_memory(s, value))
            p->alive -= s->memory->is_one[value] ? 1 : s->parts;
    }
    if (p->out > p->alive)
        p->out = p->alive;
}

static struct pressure find_pressure(const struct shape *s)
{
    struct pressure p = {0};
    for (uint32_t n = s->body; n < s->end; n++) {
        end_lives(s, n, &p);
        if (!s->memory->last[n] || is_in_memory(s, n))
            continue;
        p.alive += s->memory->is_one[n] ? 1 : s->parts;
        p.most = p.alive > p.most ? p.alive : p.most;
        if (p.alive - p.out <= REGISTERS)
            continue;
        p.spills += p.alive - p.out - REGISTERS;
        p.out = p.alive - REGISTERS;
    }
    return p;
}

/* Marks the constants that registers without another value have: those with most uses (keep.c). */
static void keep_constants(const struct shape *s, unsigned registers)
{
    struct shape_memory *m = s->memory;
    memset(m->is_kept, 0, sizeof m->is_kept);
    for (; registers > 0; registers--) {
        uint32_t most = 0;
        for (uint32_t c = 1; c < s->ir->constant_count; c++)
            if (!m->is_kept[c] && (m->is_kept[most] || m->uses[c] > m->uses[most]))
                most = c;
        m->is_kept[most] = 1;
    }
}

/* The loads of a multiply-add's constants, but for one that is its operand. */
static unsigned count_loads(const struct shape *s, const struct ir_instruction *i)
{
    unsigned in_memory = 0;
    for (unsigned o = 0; i->op == IR_mad_f && o < 3; o++) {
        const struct ir_instruction *operand = &s->ir->instruction[i->operand[o]];
        in_memory +=
            operand->op == IR_literal || (operand->op == IR_constant && !s->memory->is_kept[operand->k]);
    }
    return in_memory > 1 ? in_memory - 1 : 0;
}

/* Only two registers have windows (window.c). */
static unsigned count_slots(struct shape *s, uint32_t n)
{
    const struct ir_instruction *i = &s->ir->instruction[n];
    unsigned slots = cost_of(i).slots + count_loads(s, i);
    if (i->op == IR_window && s->parts == 1)
        return 0;
    if (i->op == IR_window || i->op == IR_near)
        s->hinted = n + i->scale;
    if (i->op == IR_gather && n <= s->hinted)
        slots = HINTED_SLOTS;
    return s->memory->is_one[n] ? slots : s->parts * slots;
}

/* The time when the operands are there. */
static uint32_t operands_ready(const struct shape *s, uint32_t n, uint32_t now)
{
    const struct ir_instruction *i = &s->ir->instruction[n];
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (s->memory->ready[i->operand[o]] > now)
            now = s->memory->ready[i->operand[o]];
    return now;
}

/* The passes of a block. The inner loop of a separated program may have both chunks. */
static uint32_t passes_of(const struct shape *s)
{
    return s->parts > 1 || s->ir->chunks > 1 ? 1 : 2;
}

/* Returns the sum of both times of a block, in slots. */
static uint32_t execute(struct shape *s)
{
    struct shape_memory *m = s->memory;
    uint32_t now = PASS_SLOTS, taken = PASS_SLOTS, retired = 0, oldest = s->body;
    for (uint32_t n = s->body; n < s->end; n++) {
        unsigned slots = count_slots(s, n);
        taken += slots;
        now += slots;
        for (; oldest < n && taken - m->taken[oldest] > AHEAD; oldest++)
            now = m->retired[oldest] > now ? m->retired[oldest] : now;
        m->ready[n] = operands_ready(s, n, now) + WIDTH * cost_of(&s->ir->instruction[n]).latency;
        retired = m->ready[n] > retired ? m->ready[n] : retired;
        m->retired[n] = retired;
        m->taken[n] = taken;
    }
    return now + retired + 2 * (passes_of(s) - 1) * now;
}

/* Returns the slots from one pass to the next, if many follow each other. */
static uint32_t execute_many(struct shape *s)
{
    struct shape_memory *m = s->memory;
    uint32_t now = 0, taken = 0, retired = 0, oldest = 0, position = 0, begun = 0;
    for (uint32_t pass = 0; pass <= PASSES; pass++) {
        taken += PASS_SLOTS;
        now += PASS_SLOTS;
        for (uint32_t n = s->body; n < s->end; n++, position++) {
            unsigned slots = count_slots(s, n);
            taken += slots;
            now += slots;
            for (; oldest < position && taken - m->taken[oldest] > AHEAD; oldest++)
                now = m->retired[oldest] > now ? m->retired[oldest] : now;
            m->ready[n] = operands_ready(s, n, now) + WIDTH * cost_of(&s->ir->instruction[n]).latency;
            retired = m->ready[n] > retired ? m->ready[n] : retired;
            m->retired[position] = retired;
            m->taken[position] = taken;
        }
        begun = pass ? begun : retired;
    }
    return (retired - begun) / PASSES;
}

/* Returns the cycles of a block. */
static uint32_t estimate(struct shape *s, unsigned parts)
{
    s->parts = parts;
    s->hinted = 0;
    struct pressure p = find_pressure(s);
    keep_constants(s, p.most < REGISTERS && s->ir->constant_count ? REGISTERS - p.most : 0);
    uint32_t both = execute(s);
    return (both / 2 + passes_of(s) * SPILL_SLOTS * p.spills) / WIDTH;
}

/* In the span reading, the loop of a row's blocks. */
static void find_body(struct shape *s)
{
    s->body = ir_find_body(s->ir);
    s->end = s->ir->count;
    for (uint32_t n = s->body; s->ir->separated && n < s->ir->count; n++) {
        const struct ir_instruction *i = &s->ir->instruction[n];
        if (i->op == IR_loop && i->k == IR_LOOP_BLOCKS)
            s->body = n + 1;
        if (i->op == IR_again && i->k == IR_LOOP_BLOCKS)
            s->end = n;
    }
}

/* Returns the cycles of a part of a block, with two registers for each value. */
static uint32_t estimate_part(struct shape *s, uint32_t body, uint32_t end)
{
    s->body = body;
    s->end = end;
    s->hinted = 0;
    find_uses(s);
    struct pressure p = find_pressure(s);
    keep_constants(s, p.most < REGISTERS && s->ir->constant_count ? REGISTERS - p.most : 0);
    return (execute_many(s) + WIDTH * SPILL_SLOTS * p.spills) / WIDTH;
}

uint32_t pass_estimate_parts(const struct ir *ir, struct pass_memory *memory)
{
    struct shape s = {.ir = ir, .memory = pass_scratch(memory, sizeof *s.memory), .parts = 2};
    uint32_t rest = ir_find_body(ir), body = rest;
    while (ir->instruction[rest].op != IR_rest)
        rest++;
    return estimate_part(&s, body, rest) + estimate_part(&s, rest + 1, ir->count);
}

/* Two blocks together have to be faster by this part of the time: their code is twice as long. A loop runs
 * until the last lane of both blocks leaves it, which is later by an unknown time. In shorter programs the
 * next block is within reach anyway. */
enum { PAIR_MARGIN = 16, PAIR_MARGIN_OF_LOOPS = 8, PAIR_LEAST = 128 };

static bool prefers_pair(const struct pass_shapes *shapes, bool has_loops)
{
    const uint32_t margin = shapes->two / (has_loops ? PAIR_MARGIN_OF_LOOPS : PAIR_MARGIN);
    return shapes->four && shapes->two >= PAIR_LEAST && shapes->four < shapes->two - margin;
}

static bool has_loop(const struct ir *ir)
{
    for (uint32_t n = 1; ir->loops && n < ir->count; n++)
        if (ir->instruction[n].op == IR_loop)
            return true;
    return false;
}

unsigned pass_shape(struct ir *ir, struct pass_memory *memory)
{
    if (!memory->judges || memory->lanes != 8)
        return 0;
    struct shape s = {.ir = ir, .memory = pass_scratch(memory, sizeof *s.memory)};
    struct pass_shapes *shapes = &memory->shapes;
    find_body(&s);
    find_uses(&s);
    if (!shapes->one)
        shapes->one = estimate(&s, 1);
    if (!shapes->two && !ir->separated)
        shapes->two = estimate(&s, 2);
    if (!shapes->four && !ir->separated && pass_may_pair(ir))
        shapes->four = estimate(&s, 4) / 2;
    if (memory->may_pair && prefers_pair(shapes, has_loop(ir)))
        memory->parts = 4;
    return 0;
}
