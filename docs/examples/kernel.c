/* The smallest kernel (docs/clients.md): multiplies 16 integers by a factor that its code contains. */
#include "bench/clients/kernel.h"
#include "bench/clients/record.h"
#include "contract/language.h"

#include <stdio.h>

struct choice {
    int factor;
};

/* An element is an integer, and so is its record, of 4 bytes. */
static void multiply_text(struct env *e, const struct choice *choice)
{
    itg x = load_i(E, BASE_INPUT, 0);
    scatter_i(E, BASE_OUTPUT, 0, 4, mul_i(E, x, lit_i(E, choice->factor)));
}

KERNEL_RECORDS(record_multiply, multiply_text, struct choice)

int main(void)
{
    const struct kernel_text multiply = {.name = "multiply", .record = record_multiply};
    const struct choice choice = {.factor = 3};
    const int32_t in[KERNEL_ELEMENTS] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    int32_t out[KERNEL_ELEMENTS];
    struct error error = {0};
    struct kernel *kernel = kernel_create(&multiply, &choice, 4, "specialize", &error);
    if (!kernel)
        return fprintf(stderr, "%s\n", error.text), 1;
    kernel_run(kernel, NULL, in, out, KERNEL_ELEMENTS);
    kernel_free(kernel);
    for (int i = 0; i < KERNEL_ELEMENTS; i++)
        printf("%d%c", out[i], i + 1 < KERNEL_ELEMENTS ? ' ' : '\n');
}
