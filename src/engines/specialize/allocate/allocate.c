#include "engines/specialize/allocate/allocate.h"

#include <string.h>

struct scan {
    const struct ir *ir;
    struct allocation *allocation;
    uint64_t registers;         /* a bit for each available register */
    uint64_t held;              /* a bit for each register that has a holder */
    unsigned loop;              /* the innermost loop around the position, 0: none */
    uint16_t holder[REGISTERS]; /* the web in each register, 0: none */
};

static uint64_t registers_of(bool wide)
{
    return wide ? WIDE_REGISTERS | MASK_REGISTERS : NARROW_REGISTERS;
}

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
}

static void let_go(struct scan *scan, unsigned reg)
{
    scan->holder[reg] = 0;
    scan->held &= ~(1ull << reg);
}

/* The operands that each form of def/engine/select.def can read from memory, a bit each. */
enum {
    MEMORY_BINARY = 2,
    MEMORY_REVERSED = 1,
    MEMORY_COMPARE = 3,
    MEMORY_UNARY = 1,
    MEMORY_ROUND = 1,
    MEMORY_SHIFT = 0,
    MEMORY_NEGATE = 0,
    MEMORY_HALF = 0,
    MEMORY_MAD = 7,
    MEMORY_SELECT = 2,
    MEMORY_MOVE = 7
};

static const uint8_t memory_operands[IR_OP_COUNT] = {
#define SELECT(op, form, ...) [IR_##op] = MEMORY_##form,
#include "def/engine/select.def"
    [IR_phi] = MEMORY_MOVE,
    [IR_next] = MEMORY_MOVE,
    [IR_join] = MEMORY_MOVE,
    [IR_reciprocal] = MEMORY_BINARY};

bool allocate_folds(const struct ir_instruction *instruction, int operand)
{
    unsigned operands = memory_operands[instruction->op];
    return (operands | (ir_properties(instruction) & IR_COMMUTES && operands)) >> operand & 1;
}

/* Returns true if a spilled value can be read again from the memory that it was loaded from. */
static bool rematerializes(const struct ir *ir, const struct ir_instruction *instruction)
{
    if (instruction->op == IR_copy)
        return allocate_is_constant(&ir->instruction[instruction->operand[0]]);
    return (instruction->op == IR_uniform || instruction->op == IR_load) && ir_is_invariant_read(instruction);
}

static void begin_loop(const struct ir *ir, struct allocation *a, uint32_t number, uint16_t loop)
{
    a->loop_at[number] = loop;
    while (ir->instruction[--number].op == IR_phi)
        a->loop_at[number] = loop;
}

/* Numbers the loops from 1 in program order, and finds both ends of every `when`. */
static void find_regions(const struct ir *ir, struct allocation *a)
{
    uint16_t count = 0, loop = 0, when = 0;
    for (uint32_t number = 1; number < ir->count; number++)
        switch (ir->instruction[number].op) {
        case IR_loop:
            a->loop[++count] = (struct loop_extent){.head = (uint16_t)number, .outer = loop};
            begin_loop(ir, a, number, loop = count);
            break;
        case IR_again:
            a->loop_at[number] = loop;
            a->loop[loop].again = (uint16_t)number;
            loop = a->loop[loop].outer;
            break;
        case IR_when:
            a->region_at[number] = when; /* the `when` around it, until its end is found */
            when = (uint16_t)number;
            break;
        case IR_end:
            a->region_at[number] = when;
            when = a->region_at[when];
            a->region_at[a->region_at[number]] = (uint16_t)number;
            break;
        }
}

uint32_t allocate_joined_end(const struct ir *ir, uint32_t join)
{
    while (ir->instruction[join].op != IR_end)
        join--;
    return join;
}

unsigned allocate_entered_loop(const struct allocation *a, unsigned birth, unsigned inner)
{
    unsigned entered = 0;
    for (unsigned loop = inner; loop && a->loop[loop].head > birth; loop = a->loop[loop].outer)
        entered = loop;
    return entered;
}

static bool defines_value(const struct ir_instruction *i)
{
    return i->op != IR_nop && !(ir_properties(i) & IR_EFFECT);
}

/* A value that the next iteration of a loop reads again is alive up to the loop's end. */
static uint16_t end_of_life(const struct allocation *a, unsigned value, uint32_t use, unsigned loop)
{
    unsigned entered = allocate_entered_loop(a, value, loop);
    return entered ? a->loop[entered].again : (uint16_t)use;
}

static unsigned follow_loop_back(const struct allocation *a, const struct ir_instruction *i, uint32_t number,
                                 unsigned loop)
{
    if (i->op == IR_again)
        return a->loop_at[number];
    return i->op == IR_loop ? a->loop[loop].outer : loop;
}

/* An estimate of how often an instruction runs each time that the routine's body does: a loop has eight
 * iterations. */
static uint32_t frequency(unsigned depth)
{
    enum { DEPTH = 6 };
    return 1u << 3 * (depth < DEPTH ? depth : DEPTH);
}

/* Walks from back to front: chains the uses of each value, counts them, and finds the last one. */
static void chain_uses(const struct ir *ir, struct allocation *a)
{
    memset(a->next_use, 0, ir->count * sizeof a->next_use[0]);
    memset(a->last, 0, ir->count * sizeof a->last[0]);
    memset(a->uses, 0, ir->count * sizeof a->uses[0]);
    unsigned loop = 0, loops = ir->loops, depth = 0;
    if (loops)
        memset(a->weight, 0, ir->count * sizeof a->weight[0]);
    for (uint32_t number = ir->count - 1; number > 0; number--) {
        const struct ir_instruction *i = &ir->instruction[number];
        uint16_t after[3];
        if (loops) {
            depth += i->op == IR_again;
            depth -= i->op == IR_loop;
            loop = follow_loop_back(a, i, number, loop);
            a->weight[allocate_web(a, number)] += frequency(depth);
        }
        for (int o = 0; o < 3; o++)
            after[o] = a->next_use[allocate_web(a, i->operand[o])];
        for (int o = 0; o < 3; o++) {
            unsigned value = allocate_web(a, i->operand[o]);
            a->next[number][o] = after[o];
            if (!value)
                continue;
            a->next_use[value] = (uint16_t)number;
            a->uses[value]++;
            if (loops)
                a->weight[value] += frequency(depth);
            if (!a->last[value])
                a->last[value] = loop ? end_of_life(a, value, number, loop) : (uint16_t)number;
        }
    }
}

/* Returns true if the value needs no register: a constant, or a load that is used once by an instruction that
 * can read this operand from memory. With 16 lanes or one that includes words for all lanes. */
static bool stays_in_memory(const struct ir *ir, struct allocation *a, uint32_t number)
{
    const struct ir_instruction *i = &ir->instruction[number];
    if (allocate_is_constant(i))
        return true;
    if (i->op != IR_load && !(i->op == IR_uniform && (a->wide || a->scalar)))
        return false;
    if (!ir_is_invariant_read(i) || a->uses[number] != 1)
        return false;
    const struct ir_instruction *user = &ir->instruction[a->next_use[number]];
    for (int o = 0; o < 3; o++)
        if (user->operand[o] == number)
            return allocate_folds(user, o) && allocate_lot(a, 4) != 1;
    return false;
}

static void classify(const struct ir *ir, struct allocation *a)
{
    for (uint32_t number = 0; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        a->residence[number] = RESIDENCE_NONE;
        a->reg[number] = NO_REGISTER;
        a->split[number] = NEVER;
        a->slot[number] = NO_SLOT;
        if (defines_value(i) && a->uses[allocate_web(a, number)])
            a->residence[number] = stays_in_memory(ir, a, number) ? RESIDENCE_MEMORY : RESIDENCE_REGISTER;
    }
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
    for (int o = 0; o < 3; o++) {
        unsigned value = allocate_web(a, i->operand[o]);
        if (!value || a->last[value] != number || a->reg[value] == NO_REGISTER)
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

static void advance(struct scan *scan, uint32_t number)
{
    const struct ir_instruction *i = &scan->ir->instruction[number];
    struct allocation *a = scan->allocation;
    for (int o = 0; o < 3; o++)
        a->next_use[allocate_web(a, i->operand[o])] = a->next[number][o];
    if (scan->loop)
        for (int o = 0; o < 3; o++)
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

/* Returns true if it is better to evict `value` at this position than `other`. In straight-line code that is
 * the one whose next use is further away, in programs with loops the one with more relief for its weight. */
static bool is_better_victim(const struct scan *scan, unsigned value, unsigned other, uint32_t position)
{
    const struct allocation *a = scan->allocation;
    if (!scan->ir->loops)
        return next_use(scan, value) > next_use(scan, other);
    return relief(scan, value, position) * a->weight[other] >
           relief(scan, other, position) * a->weight[value];
}

static unsigned furthest(const struct scan *scan, const struct ir_instruction *i, uint32_t position)
{
    unsigned victim = NO_REGISTER, candidates = 1;
    for (uint64_t left = suitable(scan, position); left; left &= left - 1) {
        unsigned reg = (unsigned)__builtin_ctzll(left);
        if (is_operand(scan->allocation, i, scan->holder[reg]))
            continue;
        bool better = victim == NO_REGISTER ||
                      (!scan->allocation->lots &&
                       is_better_victim(scan, scan->holder[reg], scan->holder[victim], position));
        if (better || allocate_lot(scan->allocation, ++candidates) == 1)
            victim = reg;
    }
    return victim;
}

/* A value from outside of a loop that is evicted in the loop is in memory in the whole loop, because the next
 * iteration executes the instructions before this position too. */
static void spill(struct scan *scan, unsigned value, uint32_t position)
{
    struct allocation *a = scan->allocation;
    unsigned entered = allocate_entered_loop(a, value, scan->loop);
    a->split[value] = entered ? a->loop[entered].head : (uint16_t)position;
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
    return is_better_victim(scan, number, scan->holder[reg], number);
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
    a->reg[number] = (uint8_t)reg;
}

/* At a loop's end, frees the registers of values that only another iteration could have used. */
static void cross_loop(struct scan *scan, const struct ir_instruction *i, uint32_t number)
{
    const struct allocation *a = scan->allocation;
    if (i->op == IR_loop) {
        scan->loop = a->loop_at[number];
        return;
    }
    scan->loop = a->loop[scan->loop].outer;
    for (unsigned reg = 0; reg < REGISTERS; reg++)
        if (scan->holder[reg] && a->last[scan->holder[reg]] == number)
            let_go(scan, reg);
}

/* A gather's result must not share a register with its index. A reciprocal writes its result before it has
 * read all of its operands. */
bool allocate_keeps_operands(const struct ir_instruction *i)
{
    return i->op == IR_gather || i->op == IR_reciprocal;
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
}

/* Frees the slots of values whose last use is at `position`. `lowest` is at most the first word of free_slot
 * with a bit. */
static void free_slots(struct allocation *a, uint32_t position, uint32_t *lowest)
{
    for (unsigned value = a->expiring[position]; value; value = a->expiring_next[value]) {
        uint32_t word = a->slot[value] / 64;
        a->free_slot[word] |= 1ull << a->slot[value] % 64;
        if (*lowest > word)
            *lowest = word;
    }
}

/* Takes the lowest free slot, or a new one. */
static uint32_t take_slot(struct allocation *a, uint32_t *lowest)
{
    uint32_t words = (a->slots + 63) / 64;
    while (*lowest < words && !a->free_slot[*lowest])
        ++*lowest;
    if (*lowest == words || allocate_lot(a, 4) == 1) {
        if (a->slots % 64 == 0)
            a->free_slot[a->slots / 64] = 0;
        return a->slots++;
    }
    uint32_t slot = *lowest * 64 + (uint32_t)__builtin_ctzll(a->free_slot[*lowest]);
    a->free_slot[*lowest] &= a->free_slot[*lowest] - 1;
    return slot;
}

static bool reads_again(const struct ir *ir, const struct allocation *a, unsigned web)
{
    return rematerializes(ir, &ir->instruction[web]) && !(a->webs && a->member[web]);
}

/* Assigns slots in the order of definitions. */
static void assign_slots(const struct ir *ir, struct allocation *a)
{
    uint32_t lowest = 0;
    a->slots = 0;
    if (!a->spills)
        return;
    memset(a->expiring, 0, ir->count * sizeof a->expiring[0]);
    for (uint32_t number = 1, freed = 0; number < ir->count; number++) {
        if (allocate_web(a, number) != number || a->split[number] == NEVER || reads_again(ir, a, number))
            continue;
        /* The moves to the joins of one region are simultaneous, so no join takes the slot of another one's
         * operand. */
        uint32_t before = ir->instruction[number].op == IR_join ? allocate_joined_end(ir, number) : number;
        for (; freed < before; freed++)
            free_slots(a, freed, &lowest);
        a->slot[number] = (uint16_t)take_slot(a, &lowest);
        a->expiring_next[number] = a->expiring[a->last[number]];
        a->expiring[a->last[number]] = (uint16_t)number;
    }
}

void allocate_registers(const struct ir *ir, struct allocation *allocation, const struct register_file *file)
{
    struct scan scan = {
        .ir = ir, .allocation = allocation, .registers = registers_of(file->wide) & ~file->without};
    allocation->lots = file->seed;
    allocation->wide = file->wide;
    allocation->scalar = file->scalar;
    allocation->spills = 0;
    allocation->webs = ir->phis != 0;
    if (ir->loops || ir->phis) {
        find_regions(ir, allocation);
        memset(allocation->recent, 0, ir->count * sizeof allocation->recent[0]);
    }
    if (ir->phis)
        allocate_coalesce(ir, allocation);
    chain_uses(ir, allocation);
    classify(ir, allocation);
    for (uint32_t number = 1; number < ir->count; number++)
        scan_instruction(&scan, number);
    assign_slots(ir, allocation);
}

void allocate_print(const struct ir *ir, const struct allocation *a, FILE *out)
{
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (a->residence[number] != RESIDENCE_REGISTER || allocate_web(a, number) != number)
            continue;
        unsigned reg = a->reg[number];
        fprintf(out, "%5u to %5u  %c%-2u ", number, a->last[number], reg < MASKS ? 'v' : 'k', reg % MASKS);
        if (a->split[number] == NEVER)
            fprintf(out, "%-22s", "");
        else if (a->slot[number] == NO_SLOT)
            fprintf(out, "read again after %-5u", a->split[number]);
        else
            fprintf(out, "slot %-3u after %-7u", a->slot[number], a->split[number]);
        uint32_t scale = ir->count / 96 + 1;
        fprintf(out, "%*s", (int)(number / scale), "");
        for (uint32_t at = number / scale; at <= a->last[number] / scale; at++)
            fputc(at * scale > a->split[number] ? '.' : '=', out);
        fprintf(out, "  %s\n", ir_op_information[i->op].name);
    }
}
