/* Fragment 12 of the thesis: calls the listing of cross.asm on random vectors. Prints as JSON how many
 * results of each version are those of the formula in binary32 and in binary64, and the bytes of each. */
#include <stdint.h>
#include <stdio.h>

void cross_sse(float *result, const float *second, const float *first);
void cross_fpu(float *result, const float *second, const float *first);
extern const uint32_t cross_bytes[2];

enum { VECTORS = 100000 };

static uint32_t state = 1;

static float next(void)
{
    state = state * 1664525u + 1013904223u;
    return (float)(int32_t)(state >> 8 & 0xffff) / 256.0f - 128.0f;
}

/* Component i of the product; with single precision after each operation, or with double. */
static float formula(const float *a, const float *b, int i, int is_double)
{
    int j = (i + 1) % 3, k = (i + 2) % 3;
    volatile float one = a[j] * b[k], two = a[k] * b[j];
    return is_double ? (float)((double)a[j] * b[k] - (double)a[k] * b[j]) : one - two;
}

int main(void)
{
    int sse = 0, fpu = 0;
    for (int n = 0; n < VECTORS; n++) {
        float a[4] = {next(), next(), next(), 0}, b[4] = {next(), next(), next(), 0}, r[4], s[4];
        cross_sse(r, b, a);
        cross_fpu(s, b, a);
        int sse_same = 0, fpu_same = 0;
        for (int i = 0; i < 3; i++) {
            sse_same += r[i] == formula(a, b, i, 0);
            fpu_same += s[i] == formula(a, b, i, 1);
        }
        sse += sse_same == 3;
        fpu += fpu_same == 3;
    }
    printf("{\"vectors\": %d, \"sse\": %d, \"fpu\": %d, \"sse_bytes\": %u, \"fpu_bytes\": %u}\n", VECTORS,
           sse, fpu, (unsigned)cross_bytes[0], (unsigned)cross_bytes[1]);
    return 0;
}
