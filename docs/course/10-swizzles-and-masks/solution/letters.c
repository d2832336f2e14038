#include "swizzle.h"

#include <string.h>

static int component_of(char letter)
{
    return letter == 'w' ? 3 : letter - 'x';
}

/* The letter at that index; the last one is repeated. */
static int letter_at(const char *swizzle, int index)
{
    int length = (int)strlen(swizzle);
    return component_of(swizzle[index < length ? index : length - 1]);
}

static int is_in(const char *mask, int component)
{
    for (; *mask; mask++)
        if (component_of(*mask) == component)
            return 1;
    return 0;
}

void letters_by_position(const char *mask, const char *swizzle, int source[COMPONENTS])
{
    for (int c = 0; c < COMPONENTS; c++)
        source[c] = is_in(mask, c) ? letter_at(swizzle, c) : -1;
}

void letters_in_order(const char *mask, const char *swizzle, int source[COMPONENTS])
{
    int next = 0;
    for (int c = 0; c < COMPONENTS; c++)
        source[c] = is_in(mask, c) ? letter_at(swizzle, next++) : -1;
}
