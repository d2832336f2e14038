#include "width.h"

static void find_last_uses(const struct recording *r, int *last)
{
    for (int n = 0; n < r->count; n++) {
        const struct recorded *o = r->at + n;
        last[n] = n;
        if (o->operation != OPERATION_LOAD)
            last[o->left] = n;
        if (o->operation == OPERATION_MULTIPLY || o->operation == OPERATION_ADD)
            last[o->right] = n;
    }
}

/* Of `count` cells the first whose value has ended, or -1. */
static int free_cell(const int *last, const int *value, int count, int position)
{
    for (int c = 0; c < count; c++)
        if (value[c] < 0 || last[value[c]] <= position)
            return c;
    return -1;
}

static int furthest(const int *last, const int *value)
{
    int found = 0;
    for (int c = 1; c < REGISTERS; c++)
        if (last[value[c]] > last[value[found]])
            found = c;
    return found;
}

void allocate(const struct recording *recording, struct place *place)
{
    int last[RECORDING_MAXIMUM], in_register[RECORDING_MAXIMUM], in_slot[RECORDING_MAXIMUM];
    find_last_uses(recording, last);
    for (int n = 0; n < RECORDING_MAXIMUM; n++)
        in_register[n] = in_slot[n] = -1;
    for (int n = 0; n < recording->count; n++) {
        place[n] = (struct place){-1, -1};
        if (recording->at[n].operation == OPERATION_STORE)
            continue;
        int reg = free_cell(last, in_register, REGISTERS, n);
        if (reg < 0) {
            reg = furthest(last, in_register);
            if (last[in_register[reg]] <= last[n])
                continue;
            place[in_register[reg]].reg = -1;
        }
        place[n].reg = reg;
        in_register[reg] = n;
    }
    for (int n = 0; n < recording->count; n++)
        if (recording->at[n].operation != OPERATION_STORE && place[n].reg < 0) {
            place[n].slot = free_cell(last, in_slot, RECORDING_MAXIMUM, n);
            in_slot[place[n].slot] = n;
        }
}
