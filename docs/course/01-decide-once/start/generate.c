#include "matrix.h"

/* Step 4: one instruction for each recorded operation.
 *
 * A result gets a register, and keeps it until the last operation that uses it. */
size_t product_generate(const struct recording *recording, uint8_t *code, size_t room)
{
    (void)recording;
    (void)code;
    (void)room;
    return 0;
}
