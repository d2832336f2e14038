/* Figure 14 of the thesis on a processor of today: multiply-adds a ns of 1 to 12 independent chains, with
 * vectors of eight floats. Prints JSON. */
#include "measure.h"

#include <immintrin.h>
#include <stdio.h>

enum { ROUNDS = 100000 };

#define HIDE(value) __asm__ volatile("" : "+x"(value))

/* A function for each number of chains, so that all sums are in registers. */
#define CHAINS(count)                                                                                        \
    __attribute__((target("avx2,fma"))) static void run_##count(void *data)                                  \
    {                                                                                                        \
        __m256 sum[count], factor = _mm256_set1_ps(0.5f), term = _mm256_set1_ps(0.25f);                      \
        (void)data;                                                                                          \
        HIDE(factor);                                                                                        \
        HIDE(term);                                                                                          \
        _Pragma("GCC unroll 16") for (int i = 0; i < count; i++) sum[i] = term;                              \
        for (int round = 0; round < ROUNDS; round++) {                                                       \
            _Pragma("GCC unroll 16") for (int i = 0; i < count; i++) sum[i] =                                \
                _mm256_fmadd_ps(sum[i], factor, term);                                                       \
            _Pragma("GCC unroll 16") for (int i = 0; i < count; i++) HIDE(sum[i]);                           \
        }                                                                                                    \
    }

CHAINS(1)
CHAINS(2)
CHAINS(3)
CHAINS(4)
CHAINS(5)
CHAINS(6)
CHAINS(8)
CHAINS(10)
CHAINS(12)

int main(void)
{
    static const struct {
        int count;
        void (*run)(void *);
    } row[] = {{1, run_1}, {2, run_2}, {3, run_3},   {4, run_4},  {5, run_5},
               {6, run_6}, {8, run_8}, {10, run_10}, {12, run_12}};
    printf("{\"chains\": [");
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        double time = measure_least(row[i].run, NULL);
        printf("%s{\"chains\": %d, \"rate\": %.4f}", i ? ", " : "", row[i].count,
               8.0 * row[i].count * ROUNDS / time);
    }
    printf("]}\n");
    return 0;
}
