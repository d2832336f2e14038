#include "machine/disassemble.h"
#include "contract/engine.h"

#include <stdbool.h>
#include <string.h>

const char *routine_instruction_set(const struct routine *routine)
{
    return routine->code ? disassemble_set(routine->code, routine->code_bytes - routine->constant_bytes)
                         : "SSE2";
}

/* The routines of an engine with a fixed width may have other lanes, except those of the batch interpreter.
 * Calls are padded to LANES_MAXIMUM where the engine has no fixed width; a vector of AVX2 has half of these
 * lanes. */
uint32_t routine_lanes(const struct routine *routine)
{
    enum { LANES_AVX2 = 8 };
    uint32_t width = (uint32_t)routine->engine->width;
    if (width)
        return routine->lanes && width <= LANES_MAXIMUM ? routine->lanes : width;
    bool is_narrow = strcmp(routine_instruction_set(routine), "AVX-512") != 0;
    return is_narrow && routine->lanes > LANES_AVX2 ? LANES_AVX2 : routine->lanes;
}
