#include "command/inspect/observe.h"

#include "machine/cpu.h"

#include <string.h>

/* Of the call of observe_pixels that the thread executes. */
static _Thread_local struct sight *current;

static inline void observe(enum observed name, int number, const void *value, size_t bytes)
{
    current->seen[name] |= (uint8_t)(1 << number);
    memcpy(current->value[name][number], value, bytes);
}

#define OBSERVE(e, name, number, value) observe(OBSERVED_##name, number, &(value), sizeof(value))

#include "emu/emulate/bind.h"
#include "spec/spec.h"

#define OBSERVED(name, type, meaning)                                                                        \
    _Static_assert(sizeof(OBSERVED_TYPE_##type) <= sizeof current->value[0][0], "a " #type " has room");
#define OBSERVED_TYPE_msk         msk
#define OBSERVED_TYPE_itg         itg
#define OBSERVED_TYPE_flt         flt
#define OBSERVED_TYPE_color       struct color
#define OBSERVED_TYPE_float_color struct float_color
#include "def/observed.def"
#undef OBSERVED

void observe_pixels(struct sight *sight, const struct pixel_key *key, const struct program *program,
                    const struct triangle_layout *layout, const uint8_t *const base[BASE_COUNT])
{
    static _Thread_local struct env e;
    current = sight;
    memset(sight->seen, 0, sizeof sight->seen);
    e.program = program;
    e.fuses = cpu_has_avx2_fma();
    memcpy(e.base, base, sizeof e.base);
    spec_pixel(&e, key, layout);
}
