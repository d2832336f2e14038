/* The argument is reduced by multiples k of pi / 2 to at most pi / 4 (Cody and Waite 1980): pi / 2 is the sum
 * of three numbers whose first two have 33 bits, so that their products with k, of 20 bits, are exact. Then
 * follow Taylor's series up to terms below 2^-60. */
#include "command/stream/sine.h"

#include <math.h>

static const double two_over_pi = 0x1.45f306dc9c883p-1;
static const double half_pi[3] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};

/* The sine for |r| <= pi / 4. */
static double sine_near(double r)
{
    static const double divisors[] = {16 * 17, 14 * 15, 12 * 13, 10 * 11, 8 * 9, 6 * 7, 4 * 5, 2 * 3};
    double z = r * r, sum = 1;
    for (int i = 0; i < 7; i++)
        sum = 1 - z / divisors[i] * sum;
    return r - r * (z / divisors[7] * sum);
}

/* The cosine for |r| <= pi / 4. */
static double cosine_near(double r)
{
    static const double divisors[] = {15 * 16, 13 * 14, 11 * 12, 9 * 10, 7 * 8, 5 * 6, 3 * 4, 1 * 2};
    double z = r * r, sum = 1;
    for (int i = 0; i < 7; i++)
        sum = 1 - z / divisors[i] * sum;
    return 1 - z / divisors[7] * sum;
}

/* The sine of x plus `quarters` quarter turns. */
static double turned(double x, unsigned quarters)
{
    if (!(fabs(x) <= SINE_MOST))
        return NAN;
    double k = nearbyint(x * two_over_pi);
    double r = x - k * half_pi[0] - k * half_pi[1] - k * half_pi[2];
    unsigned quadrant = ((unsigned)(int)k + quarters) % 4;
    double value = quadrant % 2 ? cosine_near(r) : sine_near(r);
    return quadrant < 2 ? value : -value;
}

double sine_of(double x)
{
    return turned(x, 0);
}

double sine_of_complement(double x)
{
    return turned(x, 1);
}
