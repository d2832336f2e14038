#include "tests/support/trial/trial.h"

#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"
/* The header defines the three routines too, which are not used here. */
#pragma GCC diagnostic ignored "-Wunused-function"
#include "spec/spec.h"

#include "tests/support/trial/trial_spec.h"

void trial_emulate(const struct trial_memory *memory, const float *input, float *output)
{
    static struct env e;
    unsigned saved = mxcsr_enter();
    e.program = memory->program;
    e.base[BASE_CONSTANT] = memory->constants;
    e.base[BASE_INPUT] = (const uint8_t *)input;
    e.base[BASE_OUTPUT] = (const uint8_t *)output;
    trial_run(&e, memory);
    mxcsr_leave(saved);
}
