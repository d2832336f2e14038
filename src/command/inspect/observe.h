/* The pixel routine of the specification with its named values.
 *
 * The binding is the emulator's own (emu/emulate/bind.h), compiled again with its OBSERVE, which copies the
 * values that def/observed.def names. Everything else is as in the engine emulate, so the pictures are the
 * same. */
#ifndef COMMAND_INSPECT_OBSERVE_H
#define COMMAND_INSPECT_OBSERVE_H

#include "contract/binding.h"

#include <stdbool.h>

enum observed {
#define OBSERVED(name, type, meaning) OBSERVED_##name,
#include "def/observed.def"
#undef OBSERVED
    OBSERVED_COUNT
};

/* The numbers of a name: samples, targets or stages. The parts of a value: the pairs rb and ga of a packed
 * colour, the channels of one in binary32, one of any other type. */
enum { OBSERVED_NUMBERS = 8, OBSERVED_PARTS = 4, OBSERVED_LANES = 4 };

_Static_assert((int)OBSERVED_NUMBERS >= (int)SAMPLES_MAXIMUM &&
                   (int)OBSERVED_NUMBERS >= (int)TEXTURE_STAGES && (int)OBSERVED_NUMBERS >= (int)TARGETS,
               "every number has room");

/* The observed values of four pixels. */
struct sight {
    uint8_t seen[OBSERVED_COUNT]; /* bit i: the value of number i */
    uint32_t value[OBSERVED_COUNT][OBSERVED_NUMBERS][OBSERVED_PARTS][OBSERVED_LANES];
};

/* Performs the pixel routine on four lanes whose memory begins at the bases, and replaces *sight. Called
 * under the contract's MXCSR. */
void observe_pixels(struct sight *sight, const struct pixel_key *key, const struct program *program,
                    const struct triangle_layout *layout, const uint8_t *const base[BASE_COUNT]);

/* Returns true if the value is a mask that has the lane; true too if it was not observed: a test that is not
 * made is passed. */
static inline bool observe_passes(const struct sight *sight, enum observed name, unsigned number,
                                  unsigned lane)
{
    return !(sight->seen[name] >> number & 1) || sight->value[name][number][0][lane];
}

#endif
