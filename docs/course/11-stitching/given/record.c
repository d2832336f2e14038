#include "stitch.h"

static int append(struct recording *recording, struct recorded operation)
{
    recording->at[recording->count] = operation;
    return recording->count++;
}

static int load(struct recording *recording, enum operation operation, int element)
{
    return append(recording, (struct recorded){.operation = operation, .element = element});
}

static int binary(struct recording *recording, enum operation operation, int left, int right)
{
    return append(recording, (struct recorded){.operation = operation, .left = left, .right = right});
}

static int element_product(struct recording *recording, int size, int i, int j, int k)
{
    int a = load(recording, OPERATION_LOAD_A, i * size + k);
    int b = load(recording, OPERATION_LOAD_B, k * size + j);
    return binary(recording, OPERATION_MULTIPLY, a, b);
}

void product_record(struct recording *recording, int size)
{
    recording->count = 0;
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            int sum = element_product(recording, size, i, j, 0);
            for (int k = 1; k < size; k++)
                sum = binary(recording, OPERATION_ADD, sum, element_product(recording, size, i, j, k));
            append(recording,
                   (struct recorded){.operation = OPERATION_STORE_C, .left = sum, .element = i * size + j});
        }
}
