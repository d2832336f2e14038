/* Targets: which are written, how they store what is written, and whether that takes colours in binary32. */
#include "render/derive/derive_part.h"
#include "shader/program/program.h"

/* The channels that are written: luminance if red is. */
static uint32_t written_channels(const struct target_channels *target, uint32_t enabled)
{
    if (target->storage == TARGET_L8)
        enabled = (enabled & MASK_ALPHA) | (enabled & MASK_RED ? MASK_COLOR : 0);
    return enabled & target->channels;
}

/* Stages give all targets their colour; a target that a shader gives none stays as it is. */
void derive_targets(const struct state *state, struct pixel_key *key)
{
    const uint32_t enabled[TARGETS] = {GET(state, colorwriteenable), GET(state, colorwriteenable1),
                                       GET(state, colorwriteenable2), GET(state, colorwriteenable3)};
    const struct program *program = derive_pixel_program(state);
    for (int t = 0; t < TARGETS; t++) {
        bool given = !program || program->interface.targets >> t & 1;
        key->target[t] = state->target[t].storage;
        key->write_mask[t] = (uint8_t)(given ? written_channels(&state->target[t], enabled[t]) : 0);
    }
}

static int last_written(const struct pixel_key *key)
{
    int last = -1;
    for (int t = 0; t < TARGETS; t++)
        if (key->write_mask[t])
            last = t;
    return last;
}

/* The first storage with the same number of planes: of a target that is not written, only its size
 * matters. */
static uint8_t place_holder(int storage)
{
    uint8_t r = 0;
    while (storage_planes[r] != storage_planes[storage])
        r++;
    return r;
}

/* Alpha is never encoded, so a target whose only written channel is alpha needs no sRGB, unless that excludes
 * it from a logic operation. */
static uint8_t written_storage(const struct state *state, const struct pixel_key *key, int t)
{
    bool differs = key->write_mask[t] & MASK_COLOR || key->logic;
    return key->target[t] == TARGET_8888 && differs && GET(state, srgbwriteenable) ? TARGET_SRGB
                                                                                   : key->target[t];
}

void derive_storage(const struct state *state, struct pixel_key *key)
{
    int last = last_written(key);
    for (int t = 0; t < TARGETS; t++) {
        if (t > last)
            key->target[t] = 0;
        else if (!key->write_mask[t])
            key->target[t] = place_holder(key->target[t]);
        else {
            key->target[t] = written_storage(state, key, t);
            key->float_color |= storage_planes[key->target[t]] > 1 || key->target[t] == TARGET_SRGB;
            key->dither |= storage_is_narrow(key->target[t]) && key->write_mask[t] & MASK_COLOR &&
                           GET(state, ditherenable);
        }
    }
}
