/* Constants in the registers that the body leaves.
 *
 * Literals and slots of the constant table are operands in memory. Where an instruction has no such operand,
 * or a second one, it costs a load for each group of lanes; and operands in memory make instructions long.
 * After the scan, a register that holds nothing in the body is given to a constant, which the code loads
 * once a call, before the body (emit/location.c). The constants with most uses are first, in programs with
 * loops by the estimated number of uses.
 *
 * Subroutines write registers, so programs with calls have no such constants. With one lane or 16 lanes
 * constants have one word, which nearly every instruction can read. */
#include "engines/specialize/allocate/allocate.h"

#include <string.h>

enum { LEAST_USES = 2 };

struct keeper {
    const struct ir *ir;
    struct allocation *allocation;
    uint32_t room; /* the number of free registers */
};

static uint32_t uses_of(const struct keeper *k, unsigned value)
{
    return k->ir->loops ? k->allocation->weight[value] : k->allocation->uses[value];
}

/* Inserts a constant in the list, which is sorted by uses, or leaves it out. */
static void insert(const struct keeper *k, unsigned value)
{
    struct allocation *a = k->allocation;
    uint32_t at = a->kept_count;
    if (at == k->room && uses_of(k, a->kept[at - 1]) >= uses_of(k, value))
        return;
    at -= at == k->room;
    for (; at > 0 && uses_of(k, a->kept[at - 1]) < uses_of(k, value); at--)
        a->kept[at] = a->kept[at - 1];
    a->kept[at] = (uint16_t)value;
    a->kept_count += a->kept_count < k->room;
}

/* The slots of the constant table that nothing reads: all their uses are in the body, in registers. */
static void find_unread_slots(const struct keeper *k)
{
    struct allocation *a = k->allocation;
    bool any = false;
    for (uint32_t n = 0; n < a->kept_count; n++)
        any |= k->ir->instruction[a->kept[n]].op == IR_constant;
    if (!any)
        return;
    memset(a->unread, 1, k->ir->constant_count);
    for (uint32_t number = 1; number < k->ir->count; number++)
        if (k->ir->instruction[number].op == IR_constant &&
            (a->residence[number] == RESIDENCE_MEMORY || number < a->section))
            a->unread[k->ir->instruction[number].k] = 0;
}

void allocate_keep(const struct ir *ir, struct allocation *a, uint64_t free)
{
    const struct keeper k = {ir, a, (uint32_t)__builtin_popcountll(free)};
    if (!free || a->wide || a->scalar || ir->subroutines)
        return;
    for (uint32_t n = 0; n < a->constant_count; n++)
        if (a->uses[a->constant[n]] >= LEAST_USES && a->last[a->constant[n]] > a->section)
            insert(&k, a->constant[n]);
    for (uint32_t n = 0; n < a->kept_count; n++, free &= free - 1) {
        a->residence[a->kept[n]] = RESIDENCE_KEPT;
        a->reg[a->kept[n]] = (uint8_t)__builtin_ctzll(free);
    }
    find_unread_slots(&k);
}
