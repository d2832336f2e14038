/* Fragment 10 of the thesis: the fraction of four floats, by truncation to integers, subtraction, and one
 * more where the result is negative. Compares it with x - floor(x) for every 97th of all floats, and prints
 * how many differ as JSON, of all values and of those within 32-bit integers. */
#include <emmintrin.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static __m128 fraction(__m128 x)
{
    __m128 rest = _mm_sub_ps(x, _mm_cvtepi32_ps(_mm_cvttps_epi32(x)));
    __m128 negative = _mm_cmplt_ps(rest, _mm_setzero_ps());
    return _mm_add_ps(rest, _mm_and_ps(negative, _mm_set1_ps(1)));
}

static int is_wrong(uint32_t bits, float found)
{
    float x, expected;
    memcpy(&x, &bits, sizeof x);
    expected = x - floorf(x);
    return isnan(expected) ? !isnan(found) : found != expected;
}

int main(void)
{
    uint64_t wrong = 0, wrong_inside = 0;
    uint32_t step = 97;
    for (uint64_t bits = 0; bits < (uint64_t)1 << 32; bits += 4 * step) {
        uint32_t lane[4] = {(uint32_t)bits, (uint32_t)(bits + step), (uint32_t)(bits + 2 * step),
                            (uint32_t)(bits + 3 * step)};
        float x[4], result[4];
        memcpy(x, lane, sizeof x);
        _mm_storeu_ps(result, fraction(_mm_loadu_ps(x)));
        for (int i = 0; i < 4; i++) {
            int bad = is_wrong(lane[i], result[i]);
            wrong += (uint64_t)bad;
            wrong_inside += (uint64_t)(bad && fabsf(x[i]) < 2147483648.0f);
        }
    }
    printf("{\"wrong\": %llu, \"wrong_inside\": %llu}\n", (unsigned long long)wrong,
           (unsigned long long)wrong_inside);
    return 0;
}
