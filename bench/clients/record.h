/* The recording reading of a kernel's text: include this file, then the text, then KERNEL_RECORDS. */
#ifndef CLIENTS_RECORD_H
#define CLIENTS_RECORD_H

#include "ir/bind.h"

/* Defines a function that records `text`, a function of an environment and a choice of type `choice`. */
#define KERNEL_RECORDS(name, text, type)                                                                     \
    void name(struct ir *ir, const void *choice)                                                             \
    {                                                                                                        \
        struct env e = {.ir = ir};                                                                           \
        ir_start(ir);                                                                                        \
        text(&e, (const type *)choice);                                                                      \
    }

#endif
