#include "render/draw/constant.h"

#include "machine/prefetch.h"
#include "shader/program/program.h"

#include <stdlib.h>

int constants_create(struct constants *constants, struct error *error)
{
    if (!constants->memory)
        constants->memory = malloc(2 * (size_t)CONSTANT_BYTES);
    return constants->memory ? 0 : error_set(error, "out of memory for the constants of shaders");
}

void constants_destroy(struct constants *constants)
{
    free(constants->memory);
    constants->memory = NULL;
}

static bool is_right(const struct constants *constants, const struct state *state, int stage)
{
    return constants->program[stage] == state->program[stage];
}

bool constants_fit(const struct constants *constants, const struct state *state)
{
    size_t bytes = 0;
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        if (state->program[stage] && !is_right(constants, state, stage))
            bytes += program_constant_bytes(state->program[stage]);
    return constants->used + bytes <= CONSTANT_BYTES;
}

/* Blocks are prefetched this many bytes ahead of writing: the cache of the core that rendered the old
 * contents may still hold the lines. */
enum { BYTES_AHEAD = 1024, BLOCK_ALIGNMENT = 16 };

static void write_block(struct constants *constants, const struct state *state, int stage)
{
    const struct program *program = state->program[stage];
    const struct shader_registers *registers = state->registers[stage];
    uint8_t *block = constants->memory + constants->half + constants->used;
    program_write_constants(program, (const float(*)[4])registers->floats,
                            (const int32_t(*)[4])registers->integers, block);
    constants->used += program_constant_bytes(program);
    prefetch_to_write(block + BYTES_AHEAD, program_constant_bytes(program));
    constants->program[stage] = program;
    constants->block[stage] = (const float *)(const void *)block;
    constants->number[stage]++;
}

const float *constants_block(struct constants *constants, const struct state *state, int stage)
{
    if (!state->program[stage])
        return NULL;
    if (!is_right(constants, state, stage))
        write_block(constants, state, stage);
    return constants->block[stage];
}

void *constants_take(struct constants *constants, size_t bytes)
{
    size_t padded = (bytes + BLOCK_ALIGNMENT - 1) & -(size_t)BLOCK_ALIGNMENT;
    if (padded > CONSTANT_BYTES - constants->used)
        return NULL;
    constants->used += padded;
    return constants->memory + constants->half + constants->used - padded;
}

void constants_changed(struct constants *constants, unsigned stage)
{
    constants->program[stage] = NULL;
}

void constants_reset(struct constants *constants)
{
    constants->used = 0;
    for (unsigned stage = 0; stage < SHADER_STAGES; stage++)
        constants_changed(constants, stage);
}

void constants_exchange(struct constants *constants)
{
    constants->half = CONSTANT_BYTES - constants->half;
    constants_reset(constants);
}
