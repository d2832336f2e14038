#include "constant.h"

#include <stdio.h>
#include <stdlib.h>

struct constant {
    unsigned value;
    const char *name;
};

static const struct constant constants[] = {
#define GL_CONSTANT(value, name) {value, #name},
#include "calls/constant.def"
#undef GL_CONSTANT
};

static int compare(const void *key, const void *constant)
{
    unsigned value = *(const unsigned *)key, other = ((const struct constant *)constant)->value;
    return (value > other) - (value < other);
}

const char *gl_constant_name(unsigned value)
{
    static _Thread_local char text[16];
    const struct constant *found =
        bsearch(&value, constants, sizeof constants / sizeof *constants, sizeof *constants, compare);
    if (found)
        return found->name;
    snprintf(text, sizeof text, "0x%04x", value);
    return text;
}
