/* Constants of shaders that seldom change as literals in code (option `track`).
 *
 * A word of a constant that was the same for `track` draws of a routine is burnt in: a variant of the routine
 * is built, in whose recording each read of the word is a literal. Its guard compares the burnt words with
 * those of a draw, whenever these may have changed. If it fails, the draw has another variant whose guard
 * holds, or the routine itself. A routine has at most TRACK_VARIANTS variants; if there would be more, its
 * constants are not tracked any longer.
 *
 * Reads by address have no literal: they read the draw's block of constants, as in the routine itself. */
#ifndef ENGINES_SPECIALIZE_TRACK_H
#define ENGINES_SPECIALIZE_TRACK_H

#include "engines/specialize/build.h"

enum { TRACK_VARIANTS = 4 };

/* Fills `constants`, TRACKED_WORDS bits, with the words that a recording reads, except by address. */
void specialize_note_constants(const struct ir *ir, uint64_t constants[TRACKED_WORDS / 64]);

/* Makes the recording's reads of these words literals. */
void specialize_burn(struct ir *ir, const struct burnt_words *burnt);

/* Begins to track these words for a routine. Returns 0, or -1 with the reason. */
int specialize_track(const uint64_t constants[TRACKED_WORDS / 64], struct code_arena *arena,
                     struct routine *routine, struct error *error);

/* Frees the variants of a routine, if it has any. No thread runs them. */
void specialize_track_free(struct routine *routine);

/* As engine.select. */
const struct routine *specialize_select(const struct routine *routine, const float *constants,
                                        uint64_t number);

#endif
