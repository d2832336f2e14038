#include "swizzle.h"

void letters_by_position(const char *mask, const char *swizzle, int source[COMPONENTS])
{
    (void)mask;
    (void)swizzle;
    for (int c = 0; c < COMPONENTS; c++)
        source[c] = -1;
}

void letters_in_order(const char *mask, const char *swizzle, int source[COMPONENTS])
{
    (void)mask;
    (void)swizzle;
    for (int c = 0; c < COMPONENTS; c++)
        source[c] = -1;
}
