/* Coalescing: gives phis, joins and their operands one register or slot where possible, so that control flow
 * joins without moves.
 *
 * A web is a set of values that phis and joins connect and whose lifetimes do not overlap; allocation treats
 * it as one value with several definitions. At first every value is a web. Then webs are united, unless two
 * of their values would be alive at the same time: first, in loops, each join with its operands and each phi
 * with its next value; then the joins outside of loops; then each phi with its first value. Values of
 * different webs are moved where control passes from one to the other (emit/move.c).
 *
 * A value is alive from its definition to its last use; if it is defined outside of a loop and used inside,
 * to the loop's end. A join reads its first operand at the region's `when` and its second at the region's
 * end, so a value that the region replaces dies at the `when`. A loop reads a phi's next value at its
 * `again`, where the phi is defined again: the phi dies at its last use in the loop, not at the loop's end.
 *
 * The values of a web form a list in the order of their definitions. Since they are never alive at the same
 * time, it is also the order of their deaths. */
#include "engines/specialize/allocate/allocate.h"

/* --- Lifetimes of values ------------------------------------------------------------------------------- */

/* The position of a value's definition. A phi is defined in its loop. */
static unsigned birth(const struct ir *ir, const struct allocation *a, unsigned value)
{
    return ir->instruction[value].op == IR_phi ? a->loop[a->loop_at[value]].head : value;
}

static void note_use(const struct ir *ir, struct allocation *a, unsigned value, uint32_t use, unsigned loop)
{
    unsigned entered = allocate_entered_loop(a, birth(ir, a, value), loop);
    uint16_t end = entered ? a->loop[entered].again : (uint16_t)use;
    if (allocate_enters_body(a, value, use))
        end = a->repeat;
    if (a->death[value] < end)
        a->death[value] = end;
}

static void note_uses(const struct ir *ir, struct allocation *a, uint32_t number, unsigned loop)
{
    const struct ir_instruction *i = &ir->instruction[number];
    switch (i->op) {
    case IR_next: note_use(ir, a, i->operand[1], a->loop[loop].again, loop); break;
    case IR_join: {
        uint32_t end = allocate_joined_end(ir, number);
        note_use(ir, a, i->operand[0], a->region_at[end], loop);
        note_use(ir, a, i->operand[1], end, loop);
        break;
    }
    default:
        for (int o = 0; o < 3; o++)
            if (i->operand[o])
                note_use(ir, a, i->operand[o], number, loop);
    }
}

static void find_lives(const struct ir *ir, struct allocation *a)
{
    unsigned loop = 0;
    for (uint32_t number = 0; number < ir->count; number++) {
        a->web[number] = a->tail[number] = (uint16_t)number;
        a->member[number] = 0;
        a->death[number] = (uint16_t)number;
    }
    for (uint32_t number = 1; number < ir->count; number++) {
        unsigned op = ir->instruction[number].op;
        if (op == IR_loop)
            loop = a->loop_at[number];
        note_uses(ir, a, number, loop);
        if (op == IR_again)
            loop = a->loop[loop].outer;
    }
}

/* --- Uniting ------------------------------------------------------------------------------------------- */

static unsigned find(struct allocation *a, unsigned value)
{
    while (a->web[value] != value)
        value = a->web[value] = a->web[a->web[value]];
    return value;
}

/* Returns true if a value is dead when another, defined later, is computed. */
static bool dies_before(const struct ir *ir, const struct allocation *a, unsigned value, unsigned later)
{
    return a->death[value] < later ||
           (a->death[value] == later && !allocate_keeps_operands(&ir->instruction[later]));
}

/* Returns true if values of both webs are alive at the same time. `x` is the web whose first value is
 * earlier. */
static bool meet(const struct ir *ir, const struct allocation *a, unsigned x, unsigned y)
{
    if (dies_before(ir, a, a->tail[x], y))
        return false;
    while (x && y) {
        if (x > y) {
            unsigned swapped = x;
            x = y;
            y = swapped;
        }
        if (!dies_before(ir, a, x, y))
            return true;
        x = a->member[x];
    }
    return false;
}

/* Merges two lists into one, in the order of definitions. */
static void unite_lists(struct allocation *a, unsigned x, unsigned y)
{
    unsigned last = a->tail[x] < a->tail[y] ? a->tail[y] : a->tail[x];
    unsigned web = x, at = a->tail[x] < y ? a->tail[x] : x;
    a->web[y] = (uint16_t)x;
    for (x = a->member[at]; y; at = a->member[at]) {
        if (x && x < y) {
            a->member[at] = (uint16_t)x;
            x = a->member[x];
        } else {
            a->member[at] = (uint16_t)y;
            y = a->member[y];
            if (x) {
                unsigned swapped = x;
                x = y;
                y = swapped;
            }
        }
    }
    a->tail[web] = (uint16_t)last;
}

/* Values that stay in memory have no register or slot. */
static bool has_location(const struct ir *ir, unsigned value)
{
    unsigned op = ir->instruction[value].op;
    return op != IR_literal && op != IR_constant && op != IR_load;
}

static bool same_kind(const struct ir *ir, const struct allocation *a, unsigned x, unsigned y)
{
    return allocate_is_mask(a, &ir->instruction[x]) == allocate_is_mask(a, &ir->instruction[y]);
}

static void unite(const struct ir *ir, struct allocation *a, unsigned value, unsigned other)
{
    unsigned x = find(a, value), y = find(a, other);
    if (x > y) {
        unsigned swapped = x;
        x = y;
        y = swapped;
    }
    if (x != y && has_location(ir, other) && same_kind(ir, a, x, y) && !meet(ir, a, x, y) &&
        allocate_lot(a, 4) != 1)
        unite_lists(a, x, y);
}

static void unite_join(const struct ir *ir, struct allocation *a, uint32_t join)
{
    const struct ir_instruction *i = &ir->instruction[join];
    if (a->death[join] == join)
        return;
    unite(ir, a, join, i->operand[1]);
    unite(ir, a, join, i->operand[0]);
}

/* Unites joins and the next values of phis, either those in loops or those outside of loops. */
static void unite_joins(const struct ir *ir, struct allocation *a, bool in_loops)
{
    unsigned depth = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        depth += i->op == IR_loop;
        depth -= i->op == IR_again;
        if ((depth != 0) != in_loops)
            continue;
        if (i->op == IR_join)
            unite_join(ir, a, number);
        else if (i->op == IR_next)
            unite(ir, a, i->operand[0], i->operand[1]);
    }
}

static void unite_phis(const struct ir *ir, struct allocation *a)
{
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op == IR_phi && a->death[number] > number)
            unite(ir, a, number, ir->instruction[number].operand[0]);
}

void allocate_coalesce(const struct ir *ir, struct allocation *a)
{
    find_lives(ir, a);
    unite_joins(ir, a, true);
    unite_joins(ir, a, false);
    unite_phis(ir, a);
    for (uint32_t number = 1; number < ir->count; number++)
        a->web[number] = (uint16_t)find(a, number);
}
