/* The external code generator: the recorded pipeline as C, compiled by the system's compiler and loaded.
 *
 * Thesis, section 2.4: code can be generated at run time by writing text and calling a compiler. It is as good
 * as that compiler makes it, and takes a thousand times as long to make. The compiler is the program named by
 * the environment variable TRIPTYCH_CC, else `cc`; gcc 12 or clang 14, or later. */
#ifndef EXTERNAL_EXTERNAL_H
#define EXTERNAL_EXTERNAL_H

#include "draw/engine.h"
#include "ir/ir.h"

#include <stdio.h>

extern const struct engine engine_external;

/* A routine for a recording instead of a key's; free it like the engine's. Null with the reason. */
struct routine *external_routine(const struct ir *ir, enum unit unit, const union key *key,
                                 struct error *error);

/* Writes what `show` names, a comma-separated list: key; vector, the operations that the text is written in;
 * text, the routine; asm, what the compiler makes of it; or all. Returns 0, or -1 with the reason. */
int external_dump(enum unit unit, const union key *key, const char *show, FILE *out, struct error *error);

/* Writes the routine's text without its head (print.c). Returns 0, or -1 when memory runs out. */
int external_print(const struct ir *ir, enum unit unit, const union key *key, FILE *out);

extern const char external_vector[]; /* the head: vector.h */

enum { EXTERNAL_WIDTH = 8 };

/* The name of the function in the text: void routine(const char *call). */
#define EXTERNAL_FUNCTION "routine"

/* Compiles a text to a shared object and loads it: a handle for dlclose, or null with the reason
 * (compile.c). */
void *external_compile(const char *text, size_t bytes, struct error *error);

/* Null if code can be loaded, else why not: one line, the calling thread's until it asks again. */
const char *external_no_loading(void);

/* Null if there is a compiler, else why there is none. */
const char *external_no_compiler(void);

#endif
