#include "engines/specialize/allocate/allocate.h"

#include <assert.h>
#include <string.h>

/* The operands that each form of def/engine/select.def can read from memory, a bit each. */
enum {
    MEMORY_BINARY = 2,
    MEMORY_REVERSED = 1,
    MEMORY_COMPARE = 3,
    MEMORY_UNARY = 1,
    MEMORY_ROUND = 1,
    MEMORY_SHIFT = 0,
    MEMORY_ROTATE = 0,
    MEMORY_PLACES = 0,
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

/* A gather's result must not share a register with its index. A reciprocal writes its result before it has
 * read all of its operands. */
bool allocate_keeps_operands(const struct ir_instruction *i)
{
    return i->op == IR_gather || i->op == IR_reciprocal;
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

static void find_sections(const struct ir *ir, struct allocation *a)
{
    a->section = (uint16_t)(ir_find_body(ir) - 1);
    a->repeat = 0;
    for (uint32_t number = a->section; a->section && !a->repeat; number++)
        if (ir->instruction[number].op == IR_repeat)
            a->repeat = (uint16_t)number;
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

/* A value that the next iteration of a loop reads again is alive up to the loop's end. */
static uint16_t end_of_life(const struct allocation *a, unsigned value, uint32_t use, unsigned loop)
{
    if (allocate_enters_body(a, value, use))
        return a->repeat;
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

/* The next use of the value of operand `o` after the instruction. If an earlier operand is the same value, it
 * is the use after that one. */
static uint16_t use_after(const struct allocation *a, const struct ir_instruction *i, uint32_t number,
                          unsigned o, unsigned value)
{
    if (a->next_use[value] != number)
        return a->next_use[value];
    unsigned same = 0;
    while (same < o && allocate_web(a, i->operand[same]) != value)
        same++;
    return a->next[number][same];
}

/* Chains the uses of an instruction's operands. The walk is from back to front, so a value's first one is its
 * last use. */
static void chain_operands(const struct ir *ir, struct allocation *a, uint32_t number, unsigned loop)
{
    const struct ir_instruction *i = &ir->instruction[number];
    for (unsigned o = 0, operands = ir_operands(i); o < operands; o++) {
        unsigned value = allocate_web(a, i->operand[o]);
        if (!value)
            continue;
        uint16_t after = use_after(a, i, number, o, value);
        if (!after)
            a->last[value] = loop || a->section ? end_of_life(a, value, number, loop) : (uint16_t)number;
        a->next[number][o] = after;
        a->next_use[value] = (uint16_t)number;
        a->uses[value]++;
    }
}

/* The same in a program with loops: also estimates the numbers of uses and definitions. */
static void chain_in_loops(const struct ir *ir, struct allocation *a)
{
    unsigned loop = 0, depth = 0;
    memset(a->weight, 0, ir->count * sizeof a->weight[0]);
    for (uint32_t number = ir->count - 1; number > 0; number--) {
        const struct ir_instruction *i = &ir->instruction[number];
        depth += i->op == IR_again;
        depth -= i->op == IR_loop;
        loop = follow_loop_back(a, i, number, loop);
        a->weight[allocate_web(a, number)] += frequency(depth);
        chain_operands(ir, a, number, loop);
        for (unsigned o = 0; o < ir_operands(i); o++)
            a->weight[allocate_web(a, i->operand[o])] += frequency(depth);
    }
}

/* Chains the uses of each value, counts them, and finds the last one. */
static void chain_uses(const struct ir *ir, struct allocation *a)
{
    memset(a->next_use, 0, ir->count * sizeof a->next_use[0]);
    memset(a->next, 0, ir->count * sizeof a->next[0]);
    memset(a->last, 0, ir->count * sizeof a->last[0]);
    memset(a->uses, 0, ir->count * sizeof a->uses[0]);
    if (ir->loops)
        chain_in_loops(ir, a);
    else
        for (uint32_t number = ir->count - 1; number > 0; number--)
            chain_operands(ir, a, number, 0);
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

/* No value has a register, a slot or a split. */
static void begin_values(const struct ir *ir, struct allocation *a)
{
    static_assert(NO_REGISTER == UINT8_MAX && NEVER == UINT16_MAX && NO_SLOT == UINT16_MAX, "bytes of 0xff");
    memset(a->residence, RESIDENCE_NONE, ir->count);
    memset(a->reg, 0xff, ir->count);
    memset(a->split, 0xff, ir->count * sizeof a->split[0]);
    memset(a->slot, 0xff, ir->count * sizeof a->slot[0]);
}

static void classify(const struct ir *ir, struct allocation *a)
{
    begin_values(ir, a);
    for (uint32_t number = 1; number < ir->count; number++) {
        if (!a->uses[allocate_web(a, number)] || !allocate_defines_value(&ir->instruction[number]))
            continue;
        a->residence[number] = stays_in_memory(ir, a, number) ? RESIDENCE_MEMORY : RESIDENCE_REGISTER;
        if (allocate_is_constant(&ir->instruction[number]))
            a->constant[a->constant_count++] = (uint16_t)number;
    }
}

static uint64_t registers_of(const struct register_file *file)
{
    return (file->wide ? WIDE_REGISTERS | MASK_REGISTERS : NARROW_REGISTERS) & ~file->without;
}

typedef void allocator(const struct ir *ir, struct allocation *allocation, uint64_t registers);

static const struct {
    const char *name, *meaning;
    allocator *run;
} allocators[ALLOCATORS] = {
#define ALLOCATOR(name, meaning) {#name, meaning, allocate_by_##name},
#include "def/engine/allocator.def"
#undef ALLOCATOR
};

const char *allocate_name(unsigned i)
{
    return i < ALLOCATORS ? allocators[i].name : NULL;
}

const char *allocate_meaning(unsigned i)
{
    return i < ALLOCATORS ? allocators[i].meaning : NULL;
}

static void begin(const struct ir *ir, struct allocation *allocation, const struct register_file *file)
{
    allocation->lots = file->seed;
    allocation->wide = file->wide;
    allocation->scalar = file->scalar;
    allocation->spills = allocation->constant_count = allocation->kept_count = 0;
    memset(allocation->unread, 0, sizeof allocation->unread);
    allocation->webs = false;
    find_sections(ir, allocation);
    if (ir->loops || ir->phis)
        find_regions(ir, allocation);
}

void allocate_registers(const struct ir *ir, struct allocation *allocation, const struct register_file *file)
{
    if (file->allocator != ALLOCATOR_hints)
        begin(ir, allocation, file);
    else if (!file->hinted)
        allocate_write_hints(ir, allocation, file);
    allocators[file->allocator].run(ir, allocation, registers_of(file));
}

void allocate_write_hints(const struct ir *ir, struct allocation *allocation,
                          const struct register_file *file)
{
    begin(ir, allocation, file);
    allocate_find_lives(ir, allocation);
}

/* Every value that is freed anywhere gets a register. */
void allocate_read_hints(const struct ir *ir, struct allocation *a)
{
    begin_values(ir, a);
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (allocate_is_constant(i))
            a->residence[number] = RESIDENCE_MEMORY;
        else if (allocate_defines_value(i) && a->last[allocate_web(a, number)])
            a->residence[number] = RESIDENCE_REGISTER;
    }
}

void allocate_find_lives(const struct ir *ir, struct allocation *allocation)
{
    allocation->webs = ir->phis != 0;
    if (ir->phis)
        allocate_coalesce(ir, allocation);
    chain_uses(ir, allocation);
    classify(ir, allocation);
}

void allocate_print(const struct ir *ir, const struct allocation *a, FILE *out)
{
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (a->residence[number] == RESIDENCE_KEPT)
            fprintf(out, "%5u in the body  v%-2u%23s%s\n", number, a->reg[number], "",
                    ir_op_information[i->op].name);
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
