/* The work of the measurement: each job is one input, prepared for every way to process it. */
#ifndef CLIENTS_RUN_WORK_H
#define CLIENTS_RUN_WORK_H

#include "bench/clients/kernel.h"

#include <stdbool.h>
#include <stddef.h>

/* A way that is not an engine: plain C, and a library. */
enum way { WAY_PLAIN, WAY_LIBRARY, WAY_KERNEL };

struct work {
    const char *name, *library, *about;
    size_t bytes; /* of the input, for one run */
    size_t out_bytes;
    unsigned stride;
    int bound; /* the largest difference between a byte of the library's result and of the kernel's */
    const struct kernel_text *text;
    const void *choice;
    uint8_t *out;
    /* Processes the input once. `kernel` is null for the other ways. */
    void (*run)(struct work *work, enum way way, const struct kernel *kernel);
    const void *state;
};

/* Each prepares its jobs, and returns their number. The memory is kept until the program ends. */
size_t work_cipher(struct work *work);
size_t work_filter(struct work *work);
size_t work_matcher(struct work *work);

/* Compare `cases` random cases of a kernel with the library. Return the number of differences. */
unsigned work_cipher_differences(unsigned cases);
unsigned work_filter_differences(unsigned cases);
unsigned work_matcher_differences(unsigned cases);

/* Allocates, or ends the program. */
void *work_memory(size_t bytes);

/* Ends the program with a reason. */
_Noreturn void work_fail(const char *reason);

/* Creates a kernel of the specializer, or ends the program. */
struct kernel *work_kernel(const struct kernel_text *text, const void *choice, unsigned stride);

#endif
