#include "matrix.h"

static value append(struct recording *recording, struct recorded operation)
{
    recording->at[recording->count] = operation;
    return recording->count++;
}

value load_a(struct recording *recording, int element)
{
    return append(recording, (struct recorded){.operation = OPERATION_LOAD_A, .element = element});
}

value load_b(struct recording *recording, int element)
{
    return append(recording, (struct recorded){.operation = OPERATION_LOAD_B, .element = element});
}

value multiply(struct recording *recording, value left, value right)
{
    return append(recording,
                  (struct recorded){.operation = OPERATION_MULTIPLY, .left = left, .right = right});
}

value add(struct recording *recording, value left, value right)
{
    return append(recording, (struct recorded){.operation = OPERATION_ADD, .left = left, .right = right});
}

void store_c(struct recording *recording, int element, value stored)
{
    append(recording, (struct recorded){.operation = OPERATION_STORE_C, .left = stored, .element = element});
}

void product_record(struct recording *recording, int size)
{
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            value sum = multiply(recording, load_a(recording, i * size), load_b(recording, j));
            for (int k = 1; k < size; k++) {
                value a = load_a(recording, i * size + k), b = load_b(recording, k * size + j);
                sum = add(recording, sum, multiply(recording, a, b));
            }
            store_c(recording, i * size + j, sum);
        }
}
