/* The part of the staged language that all bindings share: the names of the bases, and the headers that the
 * specification uses. */
#ifndef CONTRACT_BINDING_H
#define CONTRACT_BINDING_H

#include "contract/arguments.h"
#include "contract/key_query.h"
#include "shader/program/program.h"

#include <float.h>
#include <stddef.h>
#include <stdint.h>

enum base {
#define BASE(name, meaning) BASE_##name,
#include "def/base.def"
#undef BASE
    BASE_COUNT
};

/* Permutations for permute_f: for each lane, the lane of its quad that it takes; two bits a lane, lane 0's
 * lowest. Four consecutive lanes are a quad of 2x2 pixels, by rows. */
enum {
    QUAD_LEFT = 0 | 0 << 2 | 2 << 4 | 2 << 6, /* each row's left lane in both */
    QUAD_RIGHT = 1 | 1 << 2 | 3 << 4 | 3 << 6,
    QUAD_UPPER = 0 | 1 << 2 | 0 << 4 | 1 << 6, /* each column's upper lane in both */
    QUAD_LOWER = 2 | 3 << 2 | 2 << 4 | 3 << 6
};

/* The number of variables of the language (get_f, set_f ...). Values leave a WHEN, and pass from one round of
 * a LOOP to the next, in variables only. */
enum { VARIABLES = 512 + CELL_COUNT - CELL_MORE };

/* As the step of NOTE_STEP: the operations belong to no step of the shader. */
enum { NO_STEP = 0x7fffffff };

/* As the `field` of a gather: the gather starts from the base itself, not from a pointer in it. */
enum { GATHER_DIRECT = -1 };

#endif
