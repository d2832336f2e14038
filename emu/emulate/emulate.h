/* The naive emulator: executes the specification on four lanes, and makes every decision on the state for
 * each group of four. */
#ifndef EMU_EMULATE_EMULATE_H
#define EMU_EMULATE_EMULATE_H

#include "contract/engine.h"

extern const struct engine engine_emulate;

#endif
