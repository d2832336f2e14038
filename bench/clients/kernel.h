/* Kernels: programs in the staged language (docs/staging.md) that are not graphics, built by Triptych's
 * engines. docs/clients.md is their tutorial.
 *
 * The text of a kernel is a function of an environment and of a *choice*, a structure with all that is
 * decided when the kernel is built. It computes one element, in every lane another one. At INPUT it has the
 * element's word, at OUTPUT the element's record of `stride` bytes, and at JOB a structure that the caller
 * passes to each run. The text is compiled twice: record.h makes the function that records it, execute.h the
 * function that executes it. */
#ifndef CLIENTS_KERNEL_H
#define CLIENTS_KERNEL_H

#include "contract/arguments.h"
#include "ir/ir.h"

/* Runs have a multiple of this number of elements. */
enum { KERNEL_ELEMENTS = 16 };

struct kernel_text {
    const char *name;
    void (*record)(struct ir *ir, const void *choice);
    void (*execute)(const void *choice, const struct kernel_arguments *call, unsigned stride);
};

struct kernel;

/* The size of a kernel. */
struct kernel_size {
    uint32_t recorded;     /* instructions of the recording */
    uint32_t lanes;        /* elements that it computes together */
    uint32_t instructions; /* operations left after the passes, or steps of the interpreter; 0: emulate */
    uint32_t code_bytes;   /* 0: the engine generates no code */
    uint64_t build_ns;
};

/* Builds a kernel with an engine: emulate, batch and its variants, specialize and its variants, external. The
 * choice must be kept as long as the kernel: emulate reads it in every run. Free it with kernel_free. Returns
 * null with the reason. */
struct kernel *kernel_create(const struct kernel_text *text, const void *choice, unsigned stride,
                             const char *engine, struct error *error);
void kernel_free(struct kernel *kernel);

/* Runs the kernel for `count` elements, a multiple of KERNEL_ELEMENTS. */
void kernel_run(const struct kernel *kernel, const void *job, const int32_t *index, void *out,
                uint32_t count);

struct kernel_size kernel_size(const struct kernel *kernel);

/* Returns null if this machine can build kernels with the engine, else the reason. */
const char *kernel_unavailable(const char *engine);

#endif
