#include "width.h"

static int append(struct recording *r, enum operation operation, int left, int right, int index)
{
    r->at[r->count] = (struct recorded){operation, left, right, index, 0};
    return r->count++;
}

static int multiply(struct recording *r, int left, int right)
{
    return append(r, OPERATION_MULTIPLY, left, right, 0);
}

static int add(struct recording *r, int left, int right)
{
    return append(r, OPERATION_ADD, left, right, 0);
}

/* Each output is a sum of products of all inputs and of their squares, so the inputs and squares are needed
 * until the end. */
void shader_record(struct recording *r)
{
    int value[INPUTS + 4];
    r->count = 0;
    for (int i = 0; i < INPUTS; i++)
        value[i] = append(r, OPERATION_LOAD, 0, 0, i);
    for (int i = 0; i < 4; i++)
        value[INPUTS + i] = multiply(r, value[i], value[i]);
    for (int o = 0; o < OUTPUTS; o++) {
        int sum = multiply(r, value[o], value[INPUTS + 3]);
        for (int i = 1; i < INPUTS + 4; i++) {
            int product = multiply(r, value[i], value[(i + o) % INPUTS]);
            sum = add(r, sum, product);
        }
        append(r, OPERATION_STORE, sum, 0, o);
    }
}
