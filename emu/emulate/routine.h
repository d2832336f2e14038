/* The emulator's routines, and its forms: the combinations of its options (def/engine/emulate.def). Each form
 * is a compilation of the specification of its own (emu/emulate/form.h). */
#ifndef EMU_EMULATE_ROUTINE_H
#define EMU_EMULATE_ROUTINE_H

#include "contract/engine.h"
#include "contract/layout.h"
#include "shader/program/program.h"

/* Rows of float constants that files=array has. A shader that names a row beyond them has typed files. */
enum { EMULATE_ROWS = 256 };

struct decoded_step; /* emu/emulate/once.h */

/* A routine, with values that depend only on the key. */
struct emulate_routine {
    struct routine routine;
    const struct program *program;
    struct triangle_layout layout;
    bool fuses;
    uint64_t rows[EMULATE_ROWS / 64]; /* files=array: bits of the constants that are read by number */
    uint16_t first[FILE_COUNT];       /* the same: by file, the number of its first component in the array */
    struct decoded_step *step;        /* decode=once: for each of the program's steps */
};

struct emulate_form {
    routine_function *run[UNIT_ALL];
    /* Completes a routine that has a program. Returns the bytes of `step`, or SIZE_MAX if memory is refused.
     */
    size_t (*prepare)(struct emulate_routine *routine);
};

enum emulate_files { FILES_TYPED, FILES_ARRAY, FILES_KINDS };
enum emulate_decode { DECODE_EACH, DECODE_ONCE, DECODE_KINDS };

struct emulate_options {
    enum emulate_files files;
    enum emulate_decode decode;
};

extern const struct emulate_form emulate_typed_each, emulate_typed_once, emulate_array_each,
    emulate_array_once;

#endif
