#include "matrix.h"

enum { REGISTERS = 16 };

/* The generator: where the recording's values are. */
struct generator {
    const struct recording *recording;
    int last_use[RECORDING_MAXIMUM]; /* the last operation that uses a value */
    int register_of[RECORDING_MAXIMUM];
    int holds[REGISTERS]; /* the value in a register; -1: none that is still used */
    uint8_t *at;
};

static void find_last_uses(struct generator *generator)
{
    for (int i = 0; i < generator->recording->count; i++) {
        const struct recorded *r = generator->recording->at + i;
        generator->last_use[i] = i;
        if (r->operation >= OPERATION_MULTIPLY)
            generator->last_use[r->left] = i;
        if (r->operation == OPERATION_MULTIPLY || r->operation == OPERATION_ADD)
            generator->last_use[r->right] = i;
    }
}

/* Registers whose values have had their last use are free, for the result of that use too. */
static int take_register(struct generator *generator, int number)
{
    for (int i = 0; i < REGISTERS; i++)
        if (generator->holds[i] < 0 || generator->last_use[generator->holds[i]] <= number) {
            generator->holds[i] = number;
            return generator->register_of[number] = i;
        }
    return -1;
}

/* Returns 0 if no register is free. */
static int generate_one(struct generator *generator, int number)
{
    const struct recorded *r = generator->recording->at + number;
    int left = generator->register_of[r->left], right = generator->register_of[r->right];
    if (r->operation == OPERATION_STORE_C) {
        encode_store(&generator->at, MEMORY_C, r->element, left);
        return 1;
    }
    int result = take_register(generator, number);
    if (result < 0)
        return 0;
    switch (r->operation) {
    case OPERATION_LOAD_A: encode_load(&generator->at, result, MEMORY_A, r->element); break;
    case OPERATION_LOAD_B: encode_load(&generator->at, result, MEMORY_B, r->element); break;
    case OPERATION_MULTIPLY: encode_multiply(&generator->at, result, left, right); break;
    default: encode_add(&generator->at, result, left, right); break;
    }
    return 1;
}

size_t product_generate(const struct recording *recording, uint8_t *code, size_t room)
{
    struct generator generator = {.recording = recording, .at = code};
    if (room < ((size_t)recording->count + 1) * INSTRUCTION_BYTES)
        return 0;
    find_last_uses(&generator);
    for (int i = 0; i < REGISTERS; i++)
        generator.holds[i] = -1;
    for (int i = 0; i < recording->count; i++)
        if (!generate_one(&generator, i))
            return 0;
    encode_return(&generator.at);
    return (size_t)(generator.at - code);
}
