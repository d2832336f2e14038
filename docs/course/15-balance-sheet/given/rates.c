/* Prints the rates of one core of this machine, as the check of lab 15 reads them: instructions, vector
 * arithmetic, loads and stores of vectors, each in a nanosecond, and bytes to memory in a nanosecond.
 * Arithmetic, stores and memory are measured by bench/peers/limits.c. Each loop here is timed several times,
 * because disturbances only make it slower. */
#include "base/clock.h"
#include "bench/peers/drive.h"

#include <stdio.h>

enum { TRIES = 20, ROUNDS = 50000, IN_A_ROUND = 24 };

static double now(void)
{
    return clock_seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

/* Additions to eight registers, independent of each other. */
static void add(void)
{
    for (int i = 0; i < ROUNDS; i++)
        __asm__ volatile(".rept 3\n"
                         "add $1, %%eax\n add $1, %%ecx\n add $1, %%edx\n add $1, %%esi\n"
                         "add $1, %%edi\n add $1, %%r8d\n add $1, %%r9d\n add $1, %%r10d\n"
                         ".endr" ::
                             : "eax", "ecx", "edx", "esi", "edi", "r8", "r9", "r10", "cc");
}

static void load(void)
{
    static char memory[256] __attribute__((aligned(64)));
    for (int i = 0; i < ROUNDS; i++)
        __asm__ volatile(".rept 6\n"
                         "vmovups (%0), %%ymm0\n vmovups 32(%0), %%ymm1\n"
                         "vmovups 64(%0), %%ymm2\n vmovups 96(%0), %%ymm3\n"
                         ".endr" ::"r"(memory)
                         : "xmm0", "xmm1", "xmm2", "xmm3", "memory");
}

/* Instructions in a nanosecond. */
static double rate(void (*loop)(void))
{
    double best = 0;
    for (int i = 0; i < TRIES; i++) {
        double start = now();
        loop();
        double found = 1e-9 * ROUNDS * IN_A_ROUND / (now() - start);
        best = found > best ? found : best;
    }
    return best;
}

int main(void)
{
    const struct limits *limits = limits_measured();
    if (limits->sums_avx2 <= 0) {
        fputs("this lab needs a processor with AVX2 and FMA\n", stderr);
        return 1;
    }
    printf("%.2f %.2f %.2f %.2f %.2f\n", rate(add), limits->sums_avx2 / 8, rate(load),
           limits->store_first / 32, limits->store_memory);
    return 0;
}
