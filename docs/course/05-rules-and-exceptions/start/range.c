#include "rules.h"

#include <math.h>

/* Everything is possible: right, but of no use. */
static const struct range anything = {-INFINITY, INFINITY, true, true};

struct range range_of_add(struct range a, struct range b)
{
    (void)a;
    (void)b;
    return anything;
}

struct range range_of_subtract(struct range a, struct range b)
{
    (void)a;
    (void)b;
    return anything;
}

struct range range_of_multiply(struct range a, struct range b)
{
    (void)a;
    (void)b;
    return anything;
}
