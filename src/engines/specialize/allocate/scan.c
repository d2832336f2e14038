/* The allocators `scan` and `hints`: one walk over the program assigns registers. `hints` is only informed of
 * the last use of each value, as if the programmer had freed it. It cannot compare next uses, so it evicts
 * the value that was used least recently. */
#include "engines/specialize/allocate/allocate.h"

#include <string.h>

struct scan {
    const struct ir *ir;
    struct allocation *allocation;
    uint64_t registers;         /* a bit for each available register */
    uint64_t held;              /* a bit for each register that has a holder */
    uint64_t occupied;          /* the same for each that has had one in the body */
    unsigned loop;              /* the innermost loop around the position, 0: none */
    uint16_t holder[REGISTERS]; /* the web in each register, 0: none */
    bool hinted;                /* only last uses are known */
    uint16_t used[REGISTERS];   /* with hints: the position of the latest use of the register */
};

/* The registers of the value's kind. */
static uint64_t suitable(const struct scan *scan, uint32_t number)
{
    bool mask = allocate_is_mask(scan->allocation, &scan->ir->instruction[number]);
    return scan->registers & (mask ? MASK_REGISTERS : WIDE_REGISTERS);
}

static void hold(struct scan *scan, unsigned reg, unsigned value)
{
    scan->holder[reg] = (uint16_t)value;
    scan->held |= 1ull << reg;
    scan->occupied |= 1ull << reg;
}

static void let_go(struct scan *scan, unsigned reg)
{
    scan->holder[reg] = 0;
    scan->held &= ~(1ull << reg);
}

static bool is_operand(const struct allocation *a, const struct ir_instruction *i, unsigned web)
{
    return allocate_web(a, i->operand[0]) == web || allocate_web(a, i->operand[1]) == web ||
           allocate_web(a, i->operand[2]) == web;
}

/* Frees the registers of operands whose last use is this instruction. Returns the last of them that suits the
 * result, which for a fused multiply-add is the addend if possible, since that is overwritten in place. */
static unsigned release(struct scan *scan, uint32_t number)
{
    const struct ir_instruction *i = &scan->ir->instruction[number];
    struct allocation *a = scan->allocation;
    unsigned preferred = NO_REGISTER;
    for (unsigned o = 0, operands = ir_operands(i); o < operands; o++) {
        unsigned value = allocate_web(a, i->operand[o]);
        if (a->last[value] != number || a->reg[value] == NO_REGISTER)
            continue;
        unsigned reg = a->reg[value];
        if (a->split[value] != NEVER || scan->holder[reg] != value)
            continue;
        let_go(scan, reg);
        if (suitable(scan, number) >> reg & 1)
            preferred = reg;
    }
    return preferred;
}

/* With hints: notes the use of the operands' registers. */
static void touch(struct scan *scan, uint32_t number)
{
    const struct allocation *a = scan->allocation;
    for (int o = 0; o < 3; o++) {
        unsigned web = allocate_web(a, scan->ir->instruction[number].operand[o]), reg = a->reg[web];
        if (web && reg < REGISTERS && scan->holder[reg] == web)
            scan->used[reg] = (uint16_t)number;
    }
}

static void advance(struct scan *scan, uint32_t number)
{
    const struct ir_instruction *i = &scan->ir->instruction[number];
    struct allocation *a = scan->allocation;
    if (scan->hinted) {
        touch(scan, number);
        return;
    }
    const unsigned operands = ir_operands(i);
    for (unsigned o = 0; o < operands; o++) {
        a->next_use[allocate_web(a, i->operand[o])] = a->next[number][o];
        a->left[allocate_web(a, i->operand[o])]--;
    }
    if (scan->loop)
        for (unsigned o = 0; o < operands; o++)
            a->recent[allocate_web(a, i->operand[o])] = (uint16_t)number;
}

/* The position of a value's next use. A use earlier in the current iteration of a loop happens again in the
 * next iteration; it counts as a use at the loop's end. */
static unsigned next_use(const struct scan *scan, unsigned value)
{
    const struct allocation *a = scan->allocation;
    unsigned next = a->next_use[value];
    for (unsigned l = scan->loop; l && a->loop[l].head > value; l = a->loop[l].outer)
        if (a->recent[value] > a->loop[l].head)
            return next && next < a->loop[l].again ? next : a->loop[l].again;
    return next;
}

/* The length for which an evicted value gives up its register: until its next use. A value from outside of
 * the current loop gives it up in the whole loop, which counts as at least LOOP_RELIEF instructions. */
static uint64_t relief(const struct scan *scan, unsigned value, uint32_t position)
{
    enum { LOOP_RELIEF = 64 };
    unsigned length = next_use(scan, value) - position;
    if (length < LOOP_RELIEF && allocate_entered_loop(scan->allocation, value, scan->loop))
        length = LOOP_RELIEF;
    return length;
}

/* In straight-line code, what an evicted value costs: a store where it is defined, and a read at each use. */
static uint64_t accesses(const struct scan *scan, unsigned value)
{
    return 1u + scan->allocation->left[value];
}

/* Returns true if it is better to evict `value` at this position than `other`. Values of the preamble are
 * evicted first, those with the fewest uses before others. In straight-line code that is the one with more of
 * its life left for its accesses, in programs with loops the one with more relief for its weight. */
static bool is_better_victim(const struct scan *scan, unsigned value, unsigned other, uint32_t position)
{
    const struct allocation *a = scan->allocation;
    bool kept = allocate_is_kept(a, value), other_kept = allocate_is_kept(a, other);
    if (kept || other_kept)
        return kept && (!other_kept || a->uses[value] < a->uses[other]);
    if (!scan->ir->loops)
        return (a->last[value] - position) * accesses(scan, other) >
               (a->last[other] - position) * accesses(scan, value);
    return relief(scan, value, position) * a->weight[other] >
           relief(scan, other, position) * a->weight[value];
}

/* Returns true if it is better to evict the value in register `reg` than that in `other`. */
static bool is_better_register(const struct scan *scan, unsigned reg, unsigned other, uint32_t position)
{
    if (scan->hinted)
        return scan->used[reg] < scan->used[other];
    return is_better_victim(scan, scan->holder[reg], scan->holder[other], position);
}

static unsigned furthest(const struct scan *scan, const struct ir_instruction *i, uint32_t position)
{
    unsigned victim = NO_REGISTER, candidates = 1;
    for (uint64_t left = suitable(scan, position); left; left &= left - 1) {
        unsigned reg = (unsigned)__builtin_ctzll(left);
        if (is_operand(scan->allocation, i, scan->holder[reg]))
            continue;
        bool better = victim == NO_REGISTER ||
                      (!scan->allocation->lots && is_better_register(scan, reg, victim, position));
        if (better || allocate_lot(scan->allocation, ++candidates) == 1)
            victim = reg;
    }
    return victim;
}

/* A value from outside of a loop that is evicted in the loop is in memory in the whole loop, because the next
 * iteration executes the instructions before this position too. So is a value of the preamble that is evicted
 * in the body. */
static void spill(struct scan *scan, unsigned value, uint32_t position)
{
    struct allocation *a = scan->allocation;
    unsigned entered = allocate_entered_loop(a, value, scan->loop);
    a->split[value] = entered ? a->loop[entered].head : (uint16_t)position;
    if (allocate_enters_body(a, value, position))
        a->split[value] = a->section;
    a->spills++;
}

static unsigned free_register(struct scan *scan, uint32_t number)
{
    uint64_t free = suitable(scan, number) & ~scan->held;
    uint64_t above = free & ~0ull << allocate_lot(scan->allocation, REGISTERS);
    return free ? (unsigned)__builtin_ctzll(above ? above : free) : NO_REGISTER;
}

/* Returns true if the result is spilled rather than the value in the register. */
static bool gives_way(const struct scan *scan, uint32_t number, unsigned reg)
{
    if (scan->allocation->lots)
        return allocate_lot(scan->allocation, 4) == 1;
    return !scan->hinted && is_better_victim(scan, number, scan->holder[reg], number);
}

/* Assigns a register to the result of `number`: that of its web if it has one already, else the preferred
 * one, a free one, or that of the best victim, which may be the result itself. */
static void assign_register(struct scan *scan, uint32_t number, unsigned preferred)
{
    struct allocation *a = scan->allocation;
    unsigned web = allocate_web(a, number), reg = preferred;
    uint8_t scratch = allocate_is_mask(a, &scan->ir->instruction[number]) ? MASK_RESULT : SCRATCH_RESULT;
    if (web != number) {
        a->reg[number] = a->split[web] == NEVER ? a->reg[web] : scratch;
        return;
    }
    if (reg == NO_REGISTER || allocate_lot(a, 4) == 1)
        reg = free_register(scan, number);
    if (reg == NO_REGISTER) {
        reg = furthest(scan, &scan->ir->instruction[number], number);
        if (reg == NO_REGISTER || gives_way(scan, number, reg)) {
            a->reg[number] = scratch;
            spill(scan, number, number);
            return;
        }
        spill(scan, scan->holder[reg], number);
    }
    hold(scan, reg, number);
    scan->used[reg] = (uint16_t)number;
    a->reg[number] = (uint8_t)reg;
}

/* Frees the registers of values that only another iteration of a loop that ends here could have used. */
static void let_go_at(struct scan *scan, uint32_t number)
{
    for (unsigned reg = 0; reg < REGISTERS; reg++)
        if (scan->holder[reg] && scan->allocation->last[scan->holder[reg]] == number)
            let_go(scan, reg);
}

static void cross_loop(struct scan *scan, const struct ir_instruction *i, uint32_t number)
{
    const struct allocation *a = scan->allocation;
    scan->loop = i->op == IR_loop ? a->loop_at[number] : a->loop[scan->loop].outer;
    if (i->op == IR_again)
        let_go_at(scan, number);
}

static void scan_instruction(struct scan *scan, uint32_t number)
{
    const struct ir_instruction *i = &scan->ir->instruction[number];
    unsigned preferred = NO_REGISTER;
    advance(scan, number);
    if (!allocate_keeps_operands(i))
        preferred = release(scan, number);
    if (scan->allocation->residence[number] == RESIDENCE_REGISTER)
        assign_register(scan, number, preferred);
    if (allocate_keeps_operands(i))
        release(scan, number);
    if (i->op == IR_loop || i->op == IR_again)
        cross_loop(scan, i, number);
    if (i->op == IR_repeat)
        let_go_at(scan, number);
    if (i->op == IR_section)
        scan->occupied = scan->held;
}

static void walk(struct scan *scan)
{
    const struct ir *ir = scan->ir;
    if (ir->loops || ir->phis)
        memset(scan->allocation->recent, 0, ir->count * sizeof scan->allocation->recent[0]);
    for (uint32_t value = 0; !scan->hinted && value < ir->count; value++)
        scan->allocation->left[value] = (uint16_t)scan->allocation->uses[value];
    for (uint32_t number = 1; number < ir->count; number++)
        scan_instruction(scan, number);
    allocate_keep(ir, scan->allocation, scan->registers & NARROW_REGISTERS & ~scan->occupied);
    allocate_slots(ir, scan->allocation);
}

void allocate_by_scan(const struct ir *ir, struct allocation *allocation, uint64_t registers)
{
    struct scan scan = {.ir = ir, .allocation = allocation, .registers = registers};
    allocate_find_lives(ir, allocation);
    walk(&scan);
}

void allocate_by_hints(const struct ir *ir, struct allocation *allocation, uint64_t registers)
{
    struct scan scan = {.ir = ir, .allocation = allocation, .registers = registers, .hinted = true};
    allocate_read_hints(ir, allocation);
    walk(&scan);
}
