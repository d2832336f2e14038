#include "matrix.h"

/* Step 2: each of these functions appends one operation to the recording. The first is complete. */

value load_a(struct recording *recording, int element)
{
    recording->at[recording->count] = (struct recorded){.operation = OPERATION_LOAD_A, .element = element};
    return recording->count++;
}

value load_b(struct recording *recording, int element)
{
    (void)recording;
    (void)element;
    return 0;
}

value multiply(struct recording *recording, value left, value right)
{
    (void)recording;
    (void)left;
    (void)right;
    return 0;
}

value add(struct recording *recording, value left, value right)
{
    (void)recording;
    (void)left;
    (void)right;
    return 0;
}

void store_c(struct recording *recording, int element, value stored)
{
    (void)recording;
    (void)element;
    (void)stored;
}

/* Step 3: the text of product_generic, with `value` for float and the functions above for its operations. */
void product_record(struct recording *recording, int size)
{
    (void)recording;
    (void)size;
}
