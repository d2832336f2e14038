/* Blits: pixels that change without a draw. Each operation has a header, which defines its result. An element
 * is a pixel or a word of one, and its `index` and `out` of struct blit_arguments are at INPUT and OUTPUT.
 *
 * Where pixels are in memory, which tiles an operation changes and which source pixels it reads is the
 * renderer's (render/blit/blit.h). */
#ifndef SPEC_BLIT_BLIT_H
#define SPEC_BLIT_BLIT_H

#include "contract/language.h"
#include "spec/blit/blend.h"
#include "spec/blit/clear.h"
#include "spec/blit/resolve.h"
#include "spec/blit/shrink.h"

static inline void spec_blit(struct env *e, const struct blit_key *k)
{
    switch ((enum blit_operation)k->operation) {
    case BLIT_CLEAR: blit_clear(E, k); break;
    case BLIT_RESOLVE: blit_resolve(E, k); break;
    case BLIT_SHRINK: blit_shrink(E, k); break;
    case BLIT_BLEND: blit_blend(E, k); break;
    case BLIT_COUNT: break;
    }
}

#endif
