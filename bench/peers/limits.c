/* The rates that one core of this machine can reach, measured by loops without other work. Each rate is the
 * best of a few tries, because disturbances only slow a loop down. */
#define _GNU_SOURCE
#include "base/clock.h"
#include "drive.h"

#include <immintrin.h>
#include <stdlib.h>
#include <string.h>

enum {
    TRIES = 5,
    CHAINS = 12, /* independent multiply-adds */
    ROUNDS = 40000,
    FIRST_BYTES = 16 << 10,
    SECOND_BYTES = 256 << 10,
    MEMORY_BYTES = 64 << 20
};

static double now(void)
{
    return clock_seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

/* Prevents the compiler from optimizing the value. */
#define HIDE(value)     __asm__ volatile("" : "+x"(value))
#define HIDE_512(value) __asm__ volatile("" : "+v"(value))

__attribute__((target("avx2,fma"))) static double sums_avx2(void)
{
    __m256 sum[CHAINS], factor = _mm256_set1_ps(0.5f), term = _mm256_set1_ps(0.25f);
    HIDE(factor);
    HIDE(term);
#pragma GCC unroll 16 /* all loops over sums: otherwise they are stored in memory, not in registers */
    for (int i = 0; i < CHAINS; i++)
        sum[i] = term;
    double start = now();
    for (int round = 0; round < ROUNDS; round++) {
#pragma GCC unroll 16
        for (int i = 0; i < CHAINS; i++)
            sum[i] = _mm256_fmadd_ps(sum[i], factor, term);
#pragma GCC unroll 16
        for (int i = 0; i < CHAINS; i++)
            HIDE(sum[i]);
    }
    return 8.0 * CHAINS * ROUNDS / (now() - start);
}

__attribute__((target("avx512f"))) static double sums_avx512(void)
{
    __m512 sum[CHAINS], factor = _mm512_set1_ps(0.5f), term = _mm512_set1_ps(0.25f);
    HIDE_512(factor);
    HIDE_512(term);
#pragma GCC unroll 16
    for (int i = 0; i < CHAINS; i++)
        sum[i] = term;
    double start = now();
    for (int round = 0; round < ROUNDS; round++) {
#pragma GCC unroll 16
        for (int i = 0; i < CHAINS; i++)
            sum[i] = _mm512_fmadd_ps(sum[i], factor, term);
#pragma GCC unroll 16
        for (int i = 0; i < CHAINS; i++)
            HIDE_512(sum[i]);
    }
    return 16.0 * CHAINS * ROUNDS / (now() - start);
}

__attribute__((target("avx2"))) static double stores(char *memory, size_t bytes, size_t total)
{
    __m256i value = _mm256_set1_epi8(7);
    double start = now();
    for (size_t done = 0; done < total; done += bytes) {
        for (size_t at = 0; at < bytes; at += 128) {
            __m256i *to = (__m256i *)(memory + at);
            HIDE(value);
            _mm256_store_si256(to, value);
            _mm256_store_si256(to + 1, value);
            _mm256_store_si256(to + 2, value);
            _mm256_store_si256(to + 3, value);
        }
        __asm__ volatile("" ::: "memory");
    }
    return (double)total / (now() - start);
}

/* Gathers from addresses that vary a little, as the addresses of texels do. */
__attribute__((target("avx2"))) static double gathers(const char *memory, size_t bytes)
{
    enum { STEPS = 100000 };
    __m128i at = _mm_setr_epi32(0, 8, 1032, 1040), step = _mm_set1_epi32(4099 & ~7);
    __m128i mask = _mm_set1_epi32((int)(bytes - 1) & ~7);
    __m256i sum = _mm256_setzero_si256();
    double start = now();
    for (int i = 0; i < STEPS; i++) {
        sum = _mm256_xor_si256(sum, _mm256_i32gather_epi64((const long long *)memory, at, 1));
        at = _mm_and_si128(_mm_add_epi32(at, step), mask);
    }
    HIDE(sum);
    return 4.0 * STEPS / (now() - start);
}

static double at_most(double most, double value)
{
    return value > most ? value : most;
}

static struct limits measure(void)
{
    struct limits limits = {0};
    char *memory = aligned_alloc(4096, MEMORY_BYTES);
    if (!memory || !__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
        free(memory);
        return limits;
    }
    memset(memory, 1, MEMORY_BYTES);
    for (int i = 0; i < TRIES; i++) {
        limits.sums_avx2 = at_most(limits.sums_avx2, sums_avx2() * 1e-9);
        if (__builtin_cpu_supports("avx512f"))
            limits.sums_avx512 = at_most(limits.sums_avx512, sums_avx512() * 1e-9);
        limits.store_first = at_most(limits.store_first, stores(memory, FIRST_BYTES, 256 << 20) * 1e-9);
        limits.store_second = at_most(limits.store_second, stores(memory, SECOND_BYTES, 128 << 20) * 1e-9);
        limits.store_memory = at_most(limits.store_memory, stores(memory, MEMORY_BYTES, MEMORY_BYTES) * 1e-9);
        limits.gather_first = at_most(limits.gather_first, gathers(memory, FIRST_BYTES) * 1e-9);
        limits.gather_second = at_most(limits.gather_second, gathers(memory, SECOND_BYTES) * 1e-9);
    }
    free(memory);
    return limits;
}

const struct limits *limits_measured(void)
{
    static struct limits limits;
    static bool known;
    if (!known)
        limits = measure();
    known = true;
    return &limits;
}
