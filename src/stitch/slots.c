/* Slots of the frame, shared by the values of an operation plan that are not alive together.
 *
 * Nothing is carried from one pass of the loop to the next, and regions are only jumped over forward: a value
 * is alive from the part that gives it to the last one that reads it, whatever way control takes. Two walks
 * from front to back: the first finds those last parts, the second hands out places. A place is free when its
 * value's last reader has been met, before that reader's own result is placed: fragments write theirs last
 * (asm/operation.asm). The place freed last is taken first, while it is in the cache. Free places are a list
 * through the slots that had them. */
#include "stitch/plan.h"

enum { NO_SLOT = PART_CAPACITY };

struct sharing {
    struct slot *slot;
    uint32_t free; /* a slot whose place is free; NO_SLOT */
    int32_t bytes; /* places handed out */
};

static void find_last_readers(struct plan *plan)
{
    for (unsigned i = 0; i < plan->count; i++)
        for (unsigned slots = plan->part[i].slots & ~(unsigned)SLOTS_RESULT; slots; slots &= slots - 1)
            plan->slot[plan->part[i].arguments.value[__builtin_ctz(slots)] / SLOT_BYTES].last_reader = i;
}

/* No part reads it any more; 0, which gives no value, stands for that. */
static void release(struct sharing *sharing, uint32_t slot)
{
    sharing->slot[slot].last_reader = 0;
    sharing->slot[slot].next_free = sharing->free;
    sharing->free = slot;
}

static int32_t take(struct sharing *sharing)
{
    uint32_t free = sharing->free;
    if (free != NO_SLOT) {
        sharing->free = sharing->slot[free].next_free;
        return sharing->slot[free].place;
    }
    int32_t place = sharing->bytes;
    sharing->bytes += SLOT_BYTES;
    return place;
}

static void place_operands(struct sharing *sharing, struct part *part, uint32_t number, unsigned slots)
{
    for (; slots; slots &= slots - 1) {
        int32_t *argument = &part->arguments.value[__builtin_ctz(slots)];
        uint32_t slot = (uint32_t)(*argument / SLOT_BYTES);
        *argument = sharing->slot[slot].place;
        if (sharing->slot[slot].last_reader == number)
            release(sharing, slot);
    }
}

/* A result that nobody reads has its own part as last reader. */
static void place_result(struct sharing *sharing, struct part *part, uint32_t number)
{
    uint32_t slot = (uint32_t)(part->arguments.value[0] / SLOT_BYTES);
    sharing->slot[slot].place = part->arguments.value[0] = take(sharing);
    if (sharing->slot[slot].last_reader == number)
        release(sharing, slot);
}

int32_t plan_share_slots(struct plan *plan, int32_t bytes)
{
    struct sharing sharing = {.slot = plan->slot, .free = NO_SLOT};
    if (plan->dropped)
        return bytes;
    find_last_readers(plan);
    for (unsigned i = 0; i < plan->count; i++) {
        struct part *part = &plan->part[i];
        if (part->slots & SLOTS_RESULT) {
            place_operands(&sharing, part, i, part->slots & ~(SLOTS_RESULT | 1u));
            place_result(&sharing, part, i);
        } else
            place_operands(&sharing, part, i, part->slots);
    }
    return sharing.bytes;
}
