#include "width.h"

/* Numbers of operands of operations without them are 0, which does no harm. */
void split(const struct recording *recording, struct recording *parts)
{
    parts->count = 2 * recording->count;
    for (int n = 0; n < parts->count; n++) {
        int part = n % 2;
        parts->at[n] = recording->at[n / 2];
        parts->at[n].left = 2 * parts->at[n].left + part;
        parts->at[n].right = 2 * parts->at[n].right + part;
        parts->at[n].part = part;
    }
}

/* The register of an operand. An operand in a slot is loaded to a scratch register first. */
static int operand(uint8_t **at, int lanes, const struct place *place, int scratch)
{
    if (place->reg >= 0)
        return place->reg;
    encode_load(at, lanes, scratch, BASE_FRAME, place->slot * 32);
    return scratch;
}

/* The bytes from the first element of input or output 0. */
static int displacement(const struct recorded *o)
{
    return 4 * (BLOCK * o->index + 8 * o->part);
}

static void generate_one(uint8_t **at, int lanes, const struct recorded *o, const struct place *place,
                         int number)
{
    const struct place *to = place + number;
    int result = to->reg >= 0 ? to->reg : SCRATCH_LEFT;
    if (o->operation == OPERATION_STORE) {
        int value = operand(at, lanes, place + o->left, SCRATCH_LEFT);
        encode_store(at, lanes, value, BASE_OUTPUT, displacement(o));
        return;
    }
    if (o->operation == OPERATION_LOAD)
        encode_load(at, lanes, result, BASE_INPUT, displacement(o));
    else {
        int left = operand(at, lanes, place + o->left, SCRATCH_LEFT);
        int right = operand(at, lanes, place + o->right, SCRATCH_RIGHT);
        if (o->operation == OPERATION_MULTIPLY)
            encode_multiply(at, lanes, result, left, right);
        else
            encode_add(at, lanes, result, left, right);
    }
    if (to->slot >= 0)
        encode_store(at, lanes, result, BASE_FRAME, to->slot * 32);
}

enum { OPERATION_BYTES = 4 * 9 }; /* at most, for one operation */

size_t generate(const struct recording *recording, int lanes, uint8_t *code, size_t room)
{
    struct place place[RECORDING_MAXIMUM];
    struct recording parts;
    uint8_t *at = code;
    if (lanes != 1 && lanes != 4 && lanes != 8 && lanes != 16)
        return 0;
    if (lanes == 16) {
        split(recording, &parts);
        recording = &parts;
        lanes = 8;
    }
    if (room < (size_t)recording->count * OPERATION_BYTES + 1)
        return 0;
    allocate(recording, place);
    for (int n = 0; n < recording->count; n++)
        generate_one(&at, lanes, recording->at + n, place, n);
    encode_return(&at);
    return (size_t)(at - code);
}
