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

/* The C of the text. VECTORS: vectors of gcc and clang, builtins of x86-64 (vector.h). PLAIN: C11 without
 * extensions, for a processor that flushes denormals as the contract has it. PORTABLE: the same for one that
 * keeps denormals; the text flushes (plain.h). PIXELS: vectors of four values of one pixel (pack.h). The bits
 * of all are equal. */
enum external_language { EXTERNAL_VECTORS, EXTERNAL_PLAIN, EXTERNAL_PORTABLE, EXTERNAL_PIXELS };

struct external_options {
    enum external_language language;
    char optimize; /* the digit of -O */
};

/* Returns true for engine_external and its variants. */
bool external_is_engine(const struct engine *engine);

static inline const struct external_options *external_options(const struct engine *engine)
{
    return engine->options;
}

/* The options of variants (engines/variant.h). Returns a copy of an engine's options, which is freed with
 * free(), or null if memory is refused. */
void *external_copy_options(const struct engine *engine);

/* Each changes such a copy. Returns 0, or -1 with the reason. */
#define VARIANT(name, ...) int external_set_##name(void *options, const char *value, struct error *error);
#include "def/engine/external.def"
#undef VARIANT

/* A routine for a given recording. Free it with the engine's free(). Returns null with the reason. */
struct routine *external_routine(const struct engine *engine, const struct ir *ir, enum unit unit,
                                 const union key *key, struct error *error);

/* Writes the parts in `show`, a comma-separated list of: key; vector, the definitions of operations; text,
 * the routine; whole, both as one file for a compiler; asm, the compiled code; or all, without whole. Returns
 * 0, or -1 with the reason. */
int external_dump(const struct engine *engine, enum unit unit, const union key *key, const char *show,
                  FILE *out, struct error *error);

/* Writes what a text in that language begins with: the operations. */
void external_print_beginning(enum external_language language, FILE *out);

/* Writes the operations of plain C. `flushes`: for a machine that keeps denormals (plain.c). */
void external_print_operations(bool flushes, FILE *out);

/* Writes the text of the routine without its beginning (print.c). Returns 0, or -1 when memory is refused. */
int external_print(enum external_language language, const struct ir *ir, enum unit unit, const union key *key,
                   FILE *out);

extern const char external_vector[]; /* the contents of vector.h */
extern const char external_plain[];  /* of plain.h */

enum { EXTERNAL_WIDTH = 8 }; /* WIDTH of vector.h and plain.h */

/* The function in the text: void routine(const char *arguments). */
#define EXTERNAL_FUNCTION "routine"

/* Compiles a text to a shared object and loads it. Returns a handle for dlclose, or null with the reason
 * (compile.c). */
void *external_compile(const struct external_options *options, const char *text, size_t bytes,
                       struct error *error);

/* Returns null if code can be loaded, else the reason in one line, valid until the calling thread's next
 * call. */
const char *external_no_loading(void);

/* Returns null if there is a compiler, else the reason. */
const char *external_no_compiler(void);

#endif
