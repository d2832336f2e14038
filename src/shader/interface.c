#include "shader/interface.h"

#include <string.h>

/* Registers with an implicit usage; -1 for the rest. */
static int implied_usage(enum shader_file file, const struct shader_model *model)
{
    switch (file) {
    case FILE_POSITION: return USAGE_POSITION;
    case FILE_POINT: return USAGE_PSIZE;
    case FILE_FOG: return USAGE_FOG;
    case FILE_COLOR: return USAGE_COLOR;
    case FILE_COORDINATE: return USAGE_TEXCOORD;
    case FILE_TEXTURE: return USAGE_TEXCOORD;
    case FILE_INPUT: return shader_has_usage(file, model) ? -1 : USAGE_COLOR;
    default: return -1;
    }
}

static bool is_output(enum shader_file file)
{
    return file == FILE_OUTPUT || (file >= FILE_POSITION && file <= FILE_COORDINATE);
}

static void add_port(struct shader_interface *interface, struct shader_port port)
{
    bool output = is_output(port.file);
    struct shader_port *ports = output ? interface->outputs : interface->inputs;
    unsigned *count = output ? &interface->output_count : &interface->input_count;
    for (unsigned i = 0; i < *count; i++)
        if (ports[i].file == port.file && ports[i].index == port.index && ports[i].usage == port.usage &&
            ports[i].usage_index == port.usage_index)
            return;
    if (*count < SHADER_PORTS)
        ports[(*count)++] = port;
}

/* A register that is mentioned, or declared without a usage. */
static void add_implied(struct shader_interface *interface, const struct shader_model *model,
                        const struct shader_operand *operand, unsigned mask, bool centroid)
{
    int usage = implied_usage(operand->file, model);
    if (usage >= 0)
        add_port(interface, (struct shader_port){operand->file, (uint8_t)operand->index, (uint8_t)mask,
                                                 (uint8_t)usage, (uint8_t)operand->index, centroid});
}

static void add_declaration(struct shader_interface *interface, const struct shader_model *model,
                            const struct shader_instruction *instruction)
{
    const struct shader_operand *declared = &instruction->destination;
    bool centroid = declared->modifier & RESULT_CENTROID;
    if (declared->file == FILE_SAMPLER)
        interface->kinds[declared->index] = instruction->kind;
    else if (shader_has_usage(declared->file, model))
        add_port(interface, (struct shader_port){declared->file, (uint8_t)declared->index, declared->swizzle,
                                                 instruction->usage, instruction->usage_index, centroid});
    else
        add_implied(interface, model, declared, declared->swizzle, centroid);
}

/* In ps_1_x the destination is the stage. t# of the stage are its coordinates unless an earlier instruction
 * wrote them. */
static void add_stage(struct shader_interface *interface, const struct shader_model *model,
                      const struct shader_instruction *instruction)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    const struct shader_operand *stage = &instruction->destination;
    bool by_register = instruction->opcode == SHADER_TEXREG2AR || instruction->opcode == SHADER_TEXREG2GB ||
                       instruction->opcode == SHADER_TEXREG2RGB;
    if (row->flags & IS_GRADIENT)
        interface->sampled |= (uint16_t)(1 << stage->index);
    if (stage->file == FILE_TEXTURE && !by_register)
        add_implied(interface, model, stage, MASK_FULL, false);
    if (row->source[0] == OPERAND_SET && instruction->source[0].file == FILE_TEXTURE)
        add_implied(interface, model, &instruction->source[0], MASK_FULL, false);
}

/* The components of vPos that the instruction reads. */
static void add_place(struct shader_interface *interface, const struct shader_instruction *instruction,
                      unsigned number)
{
    unsigned places = shader_source_components(instruction, number);
    for (unsigned p = 0; p < 4; p++)
        if (places >> p & 1)
            interface->place |= (uint8_t)(1 << swizzle_component(instruction->source[number].swizzle, p));
}

static void add_source(struct shader_interface *interface, const struct shader_model *model,
                       const struct shader_operand *source, unsigned rows)
{
    unsigned end = source->index + (rows ? rows : 1u);
    interface->face |= source->file == FILE_FACE;
    interface->sprite |= source->file == FILE_SPRITE;
    if (source->file == FILE_TEMPORARY && end > interface->temporaries)
        interface->temporaries = (uint16_t)end;
    else if (source->file == FILE_CONSTANT && source->relative)
        interface->indexed = true;
    else if (source->file == FILE_CONSTANT && end > interface->constants)
        interface->constants = (uint16_t)end;
    else if (source->file == FILE_SAMPLER)
        interface->sampled |= (uint16_t)(1 << source->index);
    /* Adds the inputs that ps_1_x does not declare; its t# belong to their stages. */
    else if (source->file == FILE_INPUT && shader_major(model) == 1 && model->stage == STAGE_PIXEL)
        add_implied(interface, model, source, MASK_FULL, false);
}

static void add_result(struct shader_interface *interface, const struct shader_model *model,
                       const struct shader_operand *result)
{
    if (result->file == FILE_TEMPORARY && result->index >= interface->temporaries)
        interface->temporaries = (uint16_t)(result->index + 1);
    else if (result->file == FILE_TARGET)
        interface->targets |= (uint8_t)(1 << result->index);
    else if (result->file == FILE_DEPTH)
        interface->depth = true;
    else if (is_output(result->file))
        add_implied(interface, model, result, MASK_FULL, false);
}

static void add_instruction(struct shader_interface *interface, const struct shader_model *model,
                            const struct shader_instruction *instruction)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    if (instruction->opcode == SHADER_DCL)
        add_declaration(interface, model, instruction);
    if (instruction->opcode == SHADER_ARRAY)
        add_source(interface, model, &instruction->source[0], 0);
    if (row->flags & IS_SETUP)
        return;
    interface->kills |= is_kill(instruction->opcode);
    interface->depth |= instruction->opcode == SHADER_TEXM3X2DEPTH || instruction->opcode == SHADER_TEXDEPTH;
    if (row->flags & IS_TEXTURE && shader_major(model) == 1)
        add_stage(interface, model, instruction);
    if (row->destination)
        add_result(interface, model, &instruction->destination);
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++) {
        add_source(interface, model, &instruction->source[i],
                   row->source[i] == OPERAND_MATRIX ? row->rows : 0);
        if (instruction->source[i].file == FILE_PLACE)
            add_place(interface, instruction, i);
    }
}

void shader_describe(const struct shader *shader, struct shader_interface *interface)
{
    memset(interface, 0, sizeof *interface);
    for (uint32_t i = 0; i < shader->count; i++)
        add_instruction(interface, shader->model, &shader->instructions[i]);
    if (shader->model->stage == STAGE_PIXEL && shader_major(shader->model) == 1)
        interface->targets = 1;
}
