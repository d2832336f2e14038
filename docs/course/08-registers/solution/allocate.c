#include "registers.h"

#include <string.h>

void find_intervals(const struct program *program, struct interval *interval)
{
    for (int n = 1; n < program->count; n++) {
        interval[n] = (struct interval){n, n};
        for (int o = 0; o < OPERANDS; o++)
            if (program->instruction[n].operand[o])
                interval[program->instruction[n].operand[o]].last = n;
    }
}

/* Of the registers' values, the one that ends last. */
static int furthest(const struct interval *interval, const int *value, int registers)
{
    int found = 0;
    for (int r = 1; r < registers; r++)
        if (interval[value[r]].last > interval[value[found]].last)
            found = r;
    return found;
}

/* Finds a register whose value has ended at `position`, or none. */
static int free_register(const struct interval *interval, const int *value, int registers, int position)
{
    for (int r = 0; r < registers; r++)
        if (!value[r] || interval[value[r]].last <= position)
            return r;
    return NOWHERE;
}

static void assign_registers(const struct program *program, const struct interval *interval, int registers,
                             struct place *place)
{
    int value[PROGRAM_MAXIMUM] = {0}; /* of each register; 0: none yet */
    for (int n = 1; n < program->count; n++) {
        if (!program->instruction[n].has_value)
            continue;
        int r = free_register(interval, value, registers, n);
        place[n] = (struct place){NOWHERE, NOWHERE};
        if (r == NOWHERE) {
            r = furthest(interval, value, registers);
            if (interval[value[r]].last <= interval[n].last)
                continue;
            place[value[r]].reg = NOWHERE;
        }
        place[n].reg = r;
        value[r] = n;
    }
}

/* A second scan, because a value that was evicted has its slot from its definition on. */
static int assign_slots(const struct program *program, const struct interval *interval, struct place *place)
{
    int value[PROGRAM_MAXIMUM] = {0}, slots = 0;
    for (int n = 1; n < program->count; n++) {
        if (!program->instruction[n].has_value || place[n].reg != NOWHERE)
            continue;
        int slot = free_register(interval, value, slots, n);
        if (slot == NOWHERE)
            slot = slots++;
        place[n].slot = slot;
        value[slot] = n;
    }
    return slots;
}

int allocate(const struct program *program, const struct interval *interval, int registers,
             struct place *place)
{
    assign_registers(program, interval, registers, place);
    return assign_slots(program, interval, place);
}
