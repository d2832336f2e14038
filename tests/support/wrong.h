/* Engines that are the emulator but for one fault, for the tests of what finds faults. */
#ifndef TESTS_SUPPORT_WRONG_H
#define TESTS_SUPPORT_WRONG_H

#include "draw/engine.h"

enum wrong {
    WRONG_COLOR, /* draws wherever alpha tests are on with one bit more in a pixel */
    WRONG_DEPTH, /* where it has stencil, a bit less in depth */
    WRONG_CRASH, /* the same: ends the process */
    WRONG_HANG,  /* never returns */
    WRONG_COUNT
};

/* The engine; its name is "wrong". */
const struct engine *wrong_engine(enum wrong wrong);

#endif
