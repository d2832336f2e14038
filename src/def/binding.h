/* What every binding of the staged language shares: the names of the bases and the headers that the spec
 * reads. */
#ifndef DEF_BINDING_H
#define DEF_BINDING_H

#include "draw/call.h"
#include "draw/key.h"
#include "shader/program.h"

#include <float.h>
#include <stddef.h>
#include <stdint.h>

enum base {
#define BASE(name, meaning) BASE_##name,
#include "def/base.def"
#undef BASE
    BASE_COUNT
};

/* Which lane of its quad each lane of permute_f takes: two bits a lane, lane 0's lowest. Four consecutive
 * lanes are a quad of 2x2 pixels, by rows. */
enum {
    QUAD_LEFT = 0 | 0 << 2 | 2 << 4 | 2 << 6, /* each row's left lane in both */
    QUAD_RIGHT = 1 | 1 << 2 | 3 << 4 | 3 << 6,
    QUAD_UPPER = 0 | 1 << 2 | 0 << 4 | 1 << 6, /* each column's upper lane in both */
    QUAD_LOWER = 2 | 3 << 2 | 2 << 4 | 3 << 6
};

/* Variables of the language, for what leaves a WHEN or goes around a LOOP: numbers below this. */
enum { VARIABLES = 512 };

/* In place of a pointer field: the gather starts from the base itself. */
enum { GATHER_DIRECT = -1 };

#endif
