#include "rules.h"

#include <math.h>

/* True if there is a number in the range besides -0 and NaN. */
static bool has_numbers(struct range r)
{
    return r.low <= r.high;
}

static bool has_zero(struct range r)
{
    return r.negative_zero || (r.low <= 0 && r.high >= 0);
}

static bool has_infinity(struct range r)
{
    return has_numbers(r) && (r.low == -INFINITY || r.high == INFINITY);
}

static bool has_negative(struct range r)
{
    return has_numbers(r) && r.low < 0;
}

static bool has_positive(struct range r)
{
    return has_numbers(r) && r.high > 0;
}

/* The bounds, with -0 as the number 0, which it is for sums and products. */
static struct range with_zero(struct range r)
{
    if (!r.negative_zero)
        return r;
    r.low = has_numbers(r) ? fminf(r.low, 0) : 0;
    r.high = has_numbers(r) ? fmaxf(r.high, 0) : 0;
    return r;
}

/* Extends the range to a number, or by NaN. */
static void include(struct range *r, float x)
{
    if (isnan(x)) {
        r->nan = true;
        return;
    }
    r->low = fminf(r->low, x);
    r->high = fmaxf(r->high, x);
}

static struct range nothing(bool nan)
{
    return (struct range){INFINITY, -INFINITY, nan, false};
}

/* The exact bounds if there are no numbers but -0. */
static struct range finish(struct range r)
{
    if (r.low > r.high)
        r.low = r.high = 0;
    r.low += 0.0f;
    r.high += 0.0f;
    return r;
}

/* A sum is -0 if both are, or if it is negative and so small that it becomes zero. */
struct range range_of_add(struct range a, struct range b)
{
    struct range x = with_zero(a), y = with_zero(b), sum = nothing(a.nan || b.nan);
    include(&sum, x.low + y.low);
    include(&sum, x.high + y.high);
    sum.nan |= (x.low == -INFINITY && y.high == INFINITY) || (x.high == INFINITY && y.low == -INFINITY);
    if (sum.nan && isnan(x.low + y.low))
        sum.low = -INFINITY;
    if (sum.nan && isnan(x.high + y.high))
        sum.high = INFINITY;
    sum = finish(sum);
    sum.negative_zero = (a.negative_zero && b.negative_zero) || (sum.low < 0 && sum.high >= 0) ||
                        (sum.low == 0 && (has_negative(a) || has_negative(b)));
    return sum;
}

/* a - b is a + -b. Of b's zeros, +0 becomes -0, and -0 becomes +0. */
struct range range_of_subtract(struct range a, struct range b)
{
    struct range from = with_zero(b);
    struct range minus = {-from.high + 0.0f, -from.low + 0.0f, b.nan,
                          has_numbers(b) && b.low <= 0 && b.high >= 0};
    return range_of_add(a, minus);
}

/* A product is -0 if the signs differ and it is zero, or so small that it becomes zero. */
struct range range_of_multiply(struct range a, struct range b)
{
    struct range x = with_zero(a), y = with_zero(b), product = nothing(a.nan || b.nan);
    float corners[] = {x.low * y.low, x.low * y.high, x.high * y.low, x.high * y.high};
    bool minus_a = a.negative_zero || has_negative(a), minus_b = b.negative_zero || has_negative(b);
    bool plus_a = has_positive(a) || (has_numbers(a) && a.low <= 0 && a.high >= 0);
    bool plus_b = has_positive(b) || (has_numbers(b) && b.low <= 0 && b.high >= 0);
    for (int i = 0; i < 4; i++)
        if (!isnan(corners[i]))
            include(&product, corners[i]);
    product.nan |= (has_zero(a) && has_infinity(b)) || (has_infinity(a) && has_zero(b));
    product = finish(product);
    product.negative_zero =
        ((minus_a && plus_b) || (plus_a && minus_b)) && product.low <= 0 && product.high >= 0;
    return product;
}
