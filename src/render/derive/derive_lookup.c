/* Texture coordinates that only choose texels, so that a pixel reads nothing of them but their positions in
 * 24.8 fixed point (spec/texture/address.h). */
#include "render/derive/derive.h"

#include "contract/key_query.h"
#include "shader/program/program.h"

#include <string.h>

/* A sampler whose texel depends on nothing but the positions of u and v: no level of detail, no third
 * coordinate, and no whole periods that are subtracted before u and v are positions. */
static bool depends_on_positions(const struct pixel_key *key, unsigned number)
{
    struct sampler_key s = pixel_sampler(key, (int)number);
    bool periods = false;
    for (int axis = 0; axis < 2; axis++)
        periods |= s.address[axis] == ADDRESS_WRAP || s.address[axis] == ADDRESS_MIRROR;
    return s.kind == TEXTURE_2D && s.texel != TEXEL_COMPARE && !s.mip && !s.minify && !periods;
}

/* Adds a lookup; a sampler without texture reads no coordinates. */
static bool add_lookup(const struct pixel_key *key, unsigned channel, unsigned sampler,
                       uint16_t samplers[TEXTURE_STAGES])
{
    if (!key->texture[sampler])
        return true;
    samplers[channel] |= (uint16_t)(1 << sampler);
    return depends_on_positions(key, sampler);
}

static bool find_in_stages(const struct pixel_key *key, uint16_t samplers[TEXTURE_STAGES])
{
    for (unsigned stage = 0; stage < key->stages; stage++)
        if (key->bump[stage] || !add_lookup(key, key->coordinates[stage], stage, samplers))
            return false;
    return true;
}

/* The channel of an input's first two components, or -1 if they are not texture coordinates. */
static int channel_of(const struct program *program, const struct shader_operand *input)
{
    for (int port = PORT_CHANNEL; port < PORTS; port++)
        if (program->port[port].mask && program->port[port].file == input->file &&
            program->port[port].index == input->index)
            return port - PORT_CHANNEL;
    return -1;
}

/* Returns true if a source reads texture coordinates that are interpolated. */
static bool reads_coordinates(const struct pixel_key *key, const struct program *program,
                              const struct shader_operand *source)
{
    if (source->file != FILE_INPUT && source->file != FILE_TEXTURE)
        return false;
    int channel = channel_of(program, source);
    return source->relative || (channel >= 0 && key->varying[varying_texcoord(channel)]);
}

/* Returns true for texld with u and v as they are. */
static bool samples_directly(const struct shader_instruction *i)
{
    const struct shader_operand *at = &i->source[0];
    return i->opcode == SHADER_TEXLD && !at->relative && !at->modifier && !i->source[1].relative &&
           swizzle_component(at->swizzle, 0) == 0 && swizzle_component(at->swizzle, 1) == 1;
}

/* Returns true if the instruction uses differences between neighbouring pixels: some may lie outside of the
 * triangle. A lookup without level of detail does not. */
static bool reads_neighbours(const struct pixel_key *key, const struct shader_instruction *i)
{
    const unsigned flags = shader_operations[i->opcode].flags;
    if (!(flags & IS_GRADIENT))
        return false;
    struct sampler_key s = pixel_sampler(key, i->source[1].index);
    return !(flags & IS_TEXTURE) || s.mip || s.minify;
}

static bool find_in_instruction(const struct pixel_key *key, const struct program *program,
                                const struct shader_instruction *i, uint16_t samplers[TEXTURE_STAGES])
{
    const struct shader_operation *row = &shader_operations[i->opcode];
    unsigned first = 0;
    if (reads_neighbours(key, i) || reads_coordinates(key, program, &i->destination)) /* texkill */
        return false;
    if (samples_directly(i) && reads_coordinates(key, program, &i->source[0])) {
        first = 1;
        if (!add_lookup(key, (unsigned)channel_of(program, &i->source[0]), i->source[1].index, samplers))
            return false;
    }
    for (unsigned s = first; s < SHADER_SOURCES && row->source[s]; s++)
        if (reads_coordinates(key, program, &i->source[s]) ||
            (row->source[s] == OPERAND_MATRIX && i->source[s].file != FILE_CONSTANT))
            return false;
    return true;
}

/* Models 1 name coordinates by the stage. vPoint reads the corners of the record. */
static bool find_in_program(const struct pixel_key *key, const struct program *program,
                            uint16_t samplers[TEXTURE_STAGES])
{
    if (program->interface.sprite || shader_major(program->model) == 1)
        return false;
    for (uint32_t i = 0; i < program->steps; i++)
        if (!find_in_instruction(key, program, &program->step[i].instruction, samplers))
            return false;
    return true;
}

/* Returns true if no smooth varying but texture coordinates is read, and those are not divided. */
static bool has_plain_varyings(const struct pixel_key *key)
{
    for (int v = 0; v < VARYING_COUNT; v++) {
        bool smooth = key->varying[v] == INTERPOLATION_SMOOTH;
        if ((smooth && !varying_is_texcoord(v)) || (key->varying[v] && varying_is_divisor(v)))
            return false;
    }
    return true;
}

bool derive_lookups(const struct pixel_key *key, uint16_t samplers[TEXTURE_STAGES])
{
    uint32_t number = key_program(key->shader);
    const struct program *program = number ? program_find(number) : NULL;
    memset(samplers, 0, sizeof *samplers * TEXTURE_STAGES);
    if (!has_plain_varyings(key) || (number && !program))
        return false;
    return program ? find_in_program(key, program, samplers) : find_in_stages(key, samplers);
}
