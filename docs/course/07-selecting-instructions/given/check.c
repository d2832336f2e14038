/* The program of lab 7's check.
 *
 *   check ROUTINE       compares all 2^32 inputs with x - floor(x); ends with 1 if one differs
 *   check old           prints how many inputs of frc_mmx differ, and the least positive one; ends with 1 if
 *                       one differs between -2^31 and 2^31
 *   check time A B      prints A's time divided by B's
 *
 * ROUTINE, A and B: mmx, sse41, avx2, avx512. Ends with 3 if the processor cannot execute it. */
#define _GNU_SOURCE
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { BLOCK = 4096 };

typedef void routine(const float *from, float *to, size_t count);
extern routine frc_mmx, frc_sse41, frc_avx2, frc_avx512;

static float input[BLOCK], output[BLOCK];
static uint32_t expected[BLOCK];

static int available(const char *name)
{
    return !strcmp(name, "avx512") ? __builtin_cpu_supports("avx512f")
           : !strcmp(name, "avx2") ? __builtin_cpu_supports("avx2")
                                   : __builtin_cpu_supports("sse4.1");
}

static routine *find(const char *name)
{
    return !strcmp(name, "mmx")     ? frc_mmx
           : !strcmp(name, "sse41") ? frc_sse41
           : !strcmp(name, "avx2")  ? frc_avx2
                                    : frc_avx512;
}

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static float number_of(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* The definition, for a block of consecutive bit patterns. */
__attribute__((target("sse4.1"), optimize("O3"))) static void define(uint32_t first)
{
    for (int i = 0; i < BLOCK; i++) {
        input[i] = number_of(first + (uint32_t)i);
        expected[i] = bits_of(input[i] - floorf(input[i]));
    }
}

/* NaNs have many patterns. All count as the same result. */
static int differs(int i)
{
    uint32_t found = bits_of(output[i]);
    return found != expected[i] && !(isnan(output[i]) && isnan(number_of(expected[i])));
}

static int block_differs(void)
{
    return memcmp(output, expected, sizeof expected) != 0;
}

/* --- All inputs --- */

struct found {
    uint64_t count;
    uint32_t first; /* of the differences */
    uint32_t first_positive;
    uint32_t inside; /* the first between -2^31 and 2^31 apart from -0 */
};

static void note(struct found *found, uint32_t bits)
{
    float x = number_of(bits);
    if (!found->count++)
        found->first = bits;
    if (!found->first_positive && x > 0)
        found->first_positive = bits;
    if (!found->inside && fabsf(x) < 2147483648.0f && x != 0)
        found->inside = bits;
}

static struct found compare(routine *function)
{
    struct found found = {0};
    uint32_t first = 0;
    do {
        define(first);
        function(input, output, BLOCK);
        if (block_differs())
            for (int i = 0; i < BLOCK; i++)
                if (differs(i))
                    note(&found, first + (uint32_t)i);
        first += BLOCK;
    } while (first);
    return found;
}

static int print_difference(routine *function, uint32_t bits)
{
    define(bits & ~(uint32_t)(BLOCK - 1));
    function(input, output, BLOCK);
    uint32_t i = bits % BLOCK;
    printf("of %.9g it is %.9g, expected %.9g\n", (double)input[i], (double)output[i],
           (double)number_of(expected[i]));
    return 1;
}

static int check_all(routine *function)
{
    struct found found = compare(function);
    return found.count ? print_difference(function, found.first) : 0;
}

static int check_old(void)
{
    struct found found = compare(frc_mmx);
    if (found.inside)
        return print_difference(frc_mmx, found.inside);
    printf("%llu %.0f\n", (unsigned long long)found.count, (double)number_of(found.first_positive));
    return 0;
}

/* --- Time --- */

static double seconds(routine *function)
{
    struct timespec begin, end;
    define(0x3f800000);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin);
    for (int i = 0; i < 20000; i++)
        function(input, output, BLOCK);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    return (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
}

static int compare_times(const char *first, const char *second)
{
    double least_first = 1e9, least_second = 1e9;
    for (int i = 0; i < 5; i++) {
        least_first = fmin(least_first, seconds(find(first)));
        least_second = fmin(least_second, seconds(find(second)));
    }
    printf("%.1f\n", least_first / least_second);
    return 0;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    if (!strcmp(command, "old"))
        return check_old();
    for (int i = 1 + !strcmp(command, "time"); i < count; i++)
        if (!available(argument[i]))
            return 3;
    if (!strcmp(command, "time") && count == 4)
        return compare_times(argument[2], argument[3]);
    return check_all(find(command));
}
