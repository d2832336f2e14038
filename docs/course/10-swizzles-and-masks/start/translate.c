#include "swizzle.h"

int translate_pixel(const struct shader_add *add, struct machine_instruction *at)
{
    (void)add;
    (void)at;
    return 0;
}

int translate_component(const struct shader_add *add, struct machine_instruction *at)
{
    (void)add;
    (void)at;
    return 0;
}
