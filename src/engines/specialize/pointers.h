/* Routines with the addresses of textures and vertex streams as literals in their code (option `addresses`).
 *
 * Such a routine has one or more copies of its code. Each has the addresses of one draw. A run needs a copy
 * with the addresses of its job; if there is none, it writes them into one that no thread runs. With
 * `addresses=patched` there is one copy: threads with other addresses wait until those that run it are done.
 * With `addresses=shared` there are up to POINTER_COPIES, made when a thread would wait. */
#ifndef ENGINES_SPECIALIZE_POINTERS_H
#define ENGINES_SPECIALIZE_POINTERS_H

#include "contract/engine.h"
#include "machine/code.h"
#include "engines/specialize/build.h"

enum { POINTER_COPIES = 64 };

/* Makes a routine of the code that was built last, which has pointers, with its first copy in the arena.
 * Returns null with the reason. The members of struct routine that do not concern the code are the
 * caller's. */
struct routine *specialize_pointers_routine(const struct builder *builder, struct code_arena *arena,
                                            size_t bytes, enum addresses addresses, struct error *error);

/* Frees the routine and its copies. No thread runs it. */
void specialize_pointers_free(struct routine *routine);

/* Returns true if the code that was built last is the routine's, whatever pointers have been written. */
bool specialize_pointers_match(const struct builder *builder, const struct routine *routine);

#endif
