/* Inputs and outputs of programs by usage: the link between the vertex and the pixel shader of a draw,
 * whatever their models are. */
#include "shader/program/program.h"

enum { NO_PORT = -1 };

const struct shader_port *program_input(const struct program *program, unsigned file, unsigned index,
                                        unsigned component)
{
    for (unsigned i = 0; i < program->interface.input_count; i++) {
        const struct shader_port *port = &program->interface.inputs[i];
        if (port->file == file && port->index == index && port->mask >> component & 1)
            return port;
    }
    return NULL;
}

int program_gives(const struct program *program, unsigned usage, unsigned usage_index, unsigned c)
{
    for (unsigned i = 0; i < program->interface.output_count; i++) {
        const struct shader_port *port = &program->interface.outputs[i];
        if (port->usage != usage || port->usage_index != usage_index || !(port->mask >> c & 1))
            continue;
        struct shader_operand operand = {.file = port->file, .index = port->index};
        unsigned cell = program_cell(&operand);
        return cell_in(&program->written, cell + c) ? (int)(cell - CELL_OUTPUT) / 4 : -1;
    }
    return -1;
}

const struct shader_port *program_declaration(const struct program *program, unsigned file, unsigned index)
{
    const struct shader_port *port = NULL;
    for (unsigned c = 0; c < 4 && !port; c++)
        port = program_input(program, file, index, c);
    return port;
}

static void take_port(struct program *program, int number, const struct shader_port *from, unsigned mask,
                      unsigned third)
{
    struct program_port *port = &program->port[number];
    port->third = (uint16_t)(mask & 4 ? 0 : third);
    mask |= third ? 4 : 0;
    port->file = from->file;
    port->index = from->index;
    port->mask = (uint8_t)mask;
    port->color = from->usage == USAGE_COLOR && from->usage_index < PORT_COORDINATE;
    port->coordinate = from->usage == USAGE_TEXCOORD;
    port->centroid = from->centroid || from->usage == USAGE_COLOR;
}

/* The port that is reserved for the usage. */
static int own_port(const struct shader_port *from)
{
    if (from->usage == USAGE_COLOR && from->usage_index < PORT_COORDINATE)
        return from->usage_index;
    if (from->usage == USAGE_TEXCOORD && from->usage_index < PROGRAM_PORTS - PORT_COORDINATE)
        return PORT_COORDINATE + from->usage_index;
    return NO_PORT;
}

/* A free port: coordinates first, from the last one down; colours only if no other is free. */
static int free_port(const struct program *program)
{
    int number = PROGRAM_PORTS - 1;
    while (number > 0 && program->port[number].mask)
        number--;
    return number;
}

/* Registers with reserved ports take them first; then the others take the ports that are left. */
static void link_file(struct program *program, enum shader_file file, const uint8_t *masks,
                      const uint16_t *thirds, unsigned count)
{
    for (int others = 0; others < 2; others++)
        for (unsigned i = 0; i < count; i++) {
            const struct shader_port *from =
                masks[i] || thirds[i] ? program_declaration(program, file, i) : NULL;
            int own = from ? own_port(from) : NO_PORT;
            bool taken = own != NO_PORT && program->port[own].mask &&
                         (program->port[own].file != file || program->port[own].index != i);
            if (!from || (own == NO_PORT || taken) != (bool)others)
                continue;
            take_port(program, others ? free_port(program) : own, from, masks[i], thirds[i]);
        }
}

void program_link(struct program *program)
{
    if (program->model->stage != STAGE_PIXEL)
        return;
    link_file(program, FILE_INPUT, program->input_mask, program->input_third,
              shader_register_count(FILE_INPUT, program->model));
    link_file(program, FILE_TEXTURE, program->texture_mask, program->texture_third,
              shader_register_count(FILE_TEXTURE, program->model));
}
