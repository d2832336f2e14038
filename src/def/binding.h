/* What every binding of the staged language shares: the names of the bases and the headers that the spec
 * reads. */
#ifndef DEF_BINDING_H
#define DEF_BINDING_H

#include "draw/call.h"
#include "draw/key.h"

#include <float.h>
#include <stddef.h>
#include <stdint.h>

enum base {
#define BASE(name, meaning) BASE_##name,
#include "def/base.def"
#undef BASE
    BASE_COUNT
};

/* In place of a pointer field: the gather starts from the base itself. */
enum { GATHER_DIRECT = -1 };

#endif
