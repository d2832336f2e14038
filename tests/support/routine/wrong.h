/* Copies of the emulator with one fault each, for tests of the tools that find faults. The fault happens in
 * each call of a pixel routine. */
#ifndef TESTS_SUPPORT_ROUTINE_WRONG_H
#define TESTS_SUPPORT_ROUTINE_WRONG_H

#include "contract/engine.h"

enum wrong {
    WRONG_COLOR, /* one bit of a pixel is wrong */
    WRONG_DEPTH, /* one bit of a depth is wrong */
    WRONG_CRASH, /* the call ends the process */
    WRONG_HANG,  /* the call never returns */
    WRONG_COUNT
};

/* The engine; its name is "wrong". */
const struct engine *wrong_engine(enum wrong wrong);

#endif
