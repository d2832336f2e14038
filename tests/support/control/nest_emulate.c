#include "emu/emulate/bind.h"

#include "nest_text.h"

void nest_emulate(const struct nest *nest, const struct vertex_arguments *arguments)
{
    static struct env e;
    e.base[BASE_JOB] = (const uint8_t *)arguments->job;
    for (uint32_t i = 0; i < arguments->count; i += EMULATE_WIDTH) {
        e.base[BASE_INPUT] = (const uint8_t *)(arguments->index + i);
        e.base[BASE_OUTPUT] = (const uint8_t *)(arguments->out + i);
        nest_text(&e, nest);
    }
}
