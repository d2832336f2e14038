/* Copies of the emulator with one fault each, for tests of the tools that find faults. */
#ifndef TESTS_SUPPORT_ROUTINE_WRONG_H
#define TESTS_SUPPORT_ROUTINE_WRONG_H

#include "contract/engine.h"

enum wrong {
    WRONG_COLOR, /* draws with the alpha test have one bit more in a pixel */
    WRONG_DEPTH, /* draws with stencil have one bit less in depth */
    WRONG_CRASH, /* the same: ends the process */
    WRONG_HANG,  /* never returns */
    WRONG_COUNT
};

/* The engine; its name is "wrong". */
const struct engine *wrong_engine(enum wrong wrong);

#endif
