/* A random case: a draw stream (docs/streams.md) of a few small draws with states from the tables of
 * states, shaders, vertices, textures and targets as unlikely as the interface allows.
 *
 * Most parts of a case are plausible and some are wild: what arithmetic stumbles over. Were all of it
 * wild, nearly every picture would be empty and every engine right. The text is meant to be valid; of what
 * the stream reader refuses nevertheless, runners keep count. */
#ifndef COMMAND_FUZZ_CASE_CASE_H
#define COMMAND_FUZZ_CASE_CASE_H

#include "base/random.h"
#include "command/fuzz/case/text.h"

/* Writes a whole stream. */
void case_write(struct random *random, struct text *text);

#endif
