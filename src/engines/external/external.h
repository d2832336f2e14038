/* The external code generator: prints the recorded pipeline as C, has the system's compiler compile it,
 * and loads the result.
 *
 * Thesis, section 2.4: code can be generated at run time by writing text and running a compiler. The code
 * is as good as the compiler, and the build takes a thousand times as long. The compiler is the program in
 * the environment variable TRIPTYCH_CC, else `cc`: gcc 12 or clang 14, or later. */
#ifndef ENGINES_EXTERNAL_EXTERNAL_H
#define ENGINES_EXTERNAL_EXTERNAL_H

#include "contract/engine.h"
#include "ir/ir.h"

#include <stdio.h>

extern const struct engine engine_external;

/* A routine for a given recording. Free it with the engine's free(). Returns null with the reason. */
struct routine *external_routine(const struct ir *ir, enum unit unit, const union key *key,
                                 struct error *error);

/* Writes the parts in `show`, a comma-separated list of: key; vector, the definitions of operations; text,
 * the routine; asm, its compiled code; or all. Returns 0, or -1 with the reason. */
int external_dump(enum unit unit, const union key *key, const char *show, FILE *out, struct error *error);

/* Writes the text of the routine without vector.h (print.c). Returns 0, or -1 when memory is refused. */
int external_print(const struct ir *ir, enum unit unit, const union key *key, FILE *out);

extern const char external_vector[]; /* the contents of vector.h */

enum { EXTERNAL_WIDTH = 8 };

/* The function in the text: void routine(const char *arguments). */
#define EXTERNAL_FUNCTION "routine"

/* Compiles a text to a shared object and loads it. Returns a handle for dlclose, or null with the reason
 * (compile.c). */
void *external_compile(const char *text, size_t bytes, struct error *error);

/* Returns null if code can be loaded, else the reason in one line, valid until the calling thread's next
 * call. */
const char *external_no_loading(void);

/* Returns null if there is a compiler, else the reason. */
const char *external_no_compiler(void);

#endif
