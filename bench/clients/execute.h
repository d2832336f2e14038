/* The executing reading of a kernel's text: include this file, then the text, then KERNEL_EXECUTES. */
#ifndef CLIENTS_EXECUTE_H
#define CLIENTS_EXECUTE_H

#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"

/* Defines a function that executes `text` for all elements, four at a time. Every decision on the choice is
 * made again for each four elements. */
#define KERNEL_EXECUTES(name, text, type)                                                                    \
    void name(const void *choice, const struct kernel_arguments *call, unsigned stride)                      \
    {                                                                                                        \
        unsigned saved = mxcsr_enter();                                                                      \
        struct env e = {.fuses = cpu_has_avx2_fma()};                                                        \
        e.base[BASE_JOB] = (const uint8_t *)call->job;                                                       \
        for (uint32_t i = 0; i < call->count; i += EMULATE_WIDTH) {                                          \
            e.base[BASE_INPUT] = (const uint8_t *)(call->index + i);                                         \
            e.base[BASE_OUTPUT] = call->out + (size_t)i * stride;                                            \
            text(&e, (const type *)choice);                                                                  \
        }                                                                                                    \
        mxcsr_leave(saved);                                                                                  \
    }

#endif
