/* The naive emulator: the spec performed on four lanes at a time, every state decided per group of four. */
#ifndef EMU_EMULATE_H
#define EMU_EMULATE_H

#include "draw/engine.h"

extern const struct engine engine_emulate;

#endif
