/* Spill slots: values whose intervals do not overlap share one. Subroutines run in the middle of the program
 * before them, so they share slots with each other only. */
#include "engines/specialize/allocate/allocate.h"

#include <string.h>

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

/* Returns true if a spilled value can be read again from the memory that it was loaded from. */
static bool rematerializes(const struct ir *ir, const struct ir_instruction *instruction)
{
    if (instruction->op == IR_copy)
        return allocate_is_constant(&ir->instruction[instruction->operand[0]]);
    return (instruction->op == IR_uniform || instruction->op == IR_load) && ir_is_invariant_read(instruction);
}

static bool reads_again(const struct ir *ir, const struct allocation *a, unsigned web)
{
    return rematerializes(ir, &ir->instruction[web]) && !(a->webs && a->member[web]);
}

/* No slot of the program before the subroutines is free for them. */
static void begin_subroutines(struct allocation *a, uint32_t *lowest)
{
    memset(a->free_slot, 0, (a->slots + 63) / 64 * sizeof a->free_slot[0]);
    *lowest = a->slots / 64;
}

/* Assigns slots in the order of definitions. */
void allocate_slots(const struct ir *ir, struct allocation *a)
{
    uint32_t lowest = 0;
    a->slots = 0;
    if (!a->spills)
        return;
    memset(a->expiring, 0, ir->count * sizeof a->expiring[0]);
    for (uint32_t number = 1, freed = 0, subroutines = 0; number < ir->count; number++) {
        if (ir->instruction[number].op == IR_subroutine && !subroutines++) {
            begin_subroutines(a, &lowest);
            freed = number;
        }
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
