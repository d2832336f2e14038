/* Routines of the unit blit for tests without a device: the emulator's, each built when it is needed. */
#ifndef TESTS_SUPPORT_BLIT_BLITS_H
#define TESTS_SUPPORT_BLIT_BLITS_H

#include "emu/emulate/emulate.h"
#include "render/blit/blit.h"

static inline const struct routine *blits_build(void *owner, const union key *key, struct error *error)
{
    (void)owner;
    return engine_build(&engine_emulate, NULL, UNIT_BLIT, key, error);
}

static inline void blits_free(void *owner, const struct routine *routine)
{
    (void)owner;
    engine_emulate.free(NULL, (struct routine *)(uintptr_t)routine);
}

static const struct blits emulated_blits = {NULL, blits_build, blits_free};

#endif
