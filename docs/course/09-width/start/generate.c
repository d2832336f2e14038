#include "width.h"

void split(const struct recording *recording, struct recording *parts)
{
    *parts = *recording;
}

/* The register of an operand. An operand in a slot is loaded to a scratch register first. */
static int operand(uint8_t **at, int lanes, const struct place *place, int scratch)
{
    if (place->reg >= 0)
        return place->reg;
    encode_load(at, lanes, scratch, BASE_FRAME, place->slot * 32);
    return scratch;
}

/* The operations for one lane. */
static void generate_one(uint8_t **at, const struct recorded *o, const struct place *place, int number)
{
    const struct place *to = place + number;
    int result = to->reg >= 0 ? to->reg : SCRATCH_LEFT;
    if (o->operation == OPERATION_STORE) {
        int value = operand(at, 1, place + o->left, SCRATCH_LEFT);
        encode_store(at, 1, value, BASE_OUTPUT, 4 * BLOCK * o->index);
        return;
    }
    if (o->operation == OPERATION_LOAD)
        encode_load(at, 1, result, BASE_INPUT, 4 * BLOCK * o->index);
    else {
        int left = operand(at, 1, place + o->left, SCRATCH_LEFT);
        int right = operand(at, 1, place + o->right, SCRATCH_RIGHT);
        if (o->operation == OPERATION_MULTIPLY)
            encode_multiply(at, 1, result, left, right);
        else
            encode_add(at, 1, result, left, right);
    }
    if (to->slot >= 0)
        encode_store(at, 1, result, BASE_FRAME, to->slot * 32);
}

enum { OPERATION_BYTES = 4 * 9 }; /* at most, for one operation */

size_t generate(const struct recording *recording, int lanes, uint8_t *code, size_t room)
{
    struct place place[RECORDING_MAXIMUM];
    uint8_t *at = code;
    if (lanes != 1 || room < (size_t)recording->count * OPERATION_BYTES + 1)
        return 0;
    allocate(recording, place);
    for (int n = 0; n < recording->count; n++)
        generate_one(&at, recording->at + n, place, n);
    encode_return(&at);
    return (size_t)(at - code);
}
