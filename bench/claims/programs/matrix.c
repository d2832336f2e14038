/* Fragments 1 and 2 of the thesis: a product of 2x2 matrices by a generic function of any size, and written
 * out. Prints the times of a product in ns as JSON, and whether both have the same result. */
#include "measure.h"

#include <stdio.h>
#include <string.h>

enum { PRODUCTS = 2000000 };

struct matrices {
    int size;
    float a[4], b[4], generic[4], written[4];
};

/* The size is known when it runs, as in a library for all sizes. */
static void __attribute__((noinline)) multiply(int size, const float *a, const float *b, float *c)
{
    for (int i = 0; i < size; i++) {
        for (int j = 0; j < size; j++) {
            c[size * i + j] = 0;
            for (int k = 0; k < size; k++)
                c[size * i + j] += a[size * i + k] * b[size * k + j];
        }
    }
}

static void __attribute__((noinline)) multiply_two(const float *a, const float *b, float *c)
{
    c[0] = a[0] * b[0] + a[1] * b[2];
    c[1] = a[0] * b[1] + a[1] * b[3];
    c[2] = a[2] * b[0] + a[3] * b[2];
    c[3] = a[2] * b[1] + a[3] * b[3];
}

static void run_generic(void *data)
{
    struct matrices *m = data;
    for (int i = 0; i < PRODUCTS; i++)
        multiply(m->size, m->a, m->b, m->generic);
}

static void run_written(void *data)
{
    struct matrices *m = data;
    for (int i = 0; i < PRODUCTS; i++)
        multiply_two(m->a, m->b, m->written);
}

int main(int count, char **arguments)
{
    struct matrices m = {
        .size = count > 1 ? (int)strlen(arguments[1]) : 2, .a = {1, 2, 3, 4}, .b = {5, 6, 7, 8}};
    double generic = measure_least(run_generic, &m) / PRODUCTS;
    double written = measure_least(run_written, &m) / PRODUCTS;
    printf("{\"generic_ns\": %.4f, \"written_ns\": %.4f, \"same\": %d}\n", generic, written,
           !memcmp(m.generic, m.written, sizeof m.generic));
    return 0;
}
