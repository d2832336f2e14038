/* Shaders: their fields of the keys, and how the two halves of a draw are linked.
 *
 * The pixel side decides which values are interpolated. Each port (shader/program/program.h, contract/key.h)
 * requests components by usage and number; stages request their colours and channels:
 *
 *   pixel side             requests
 *   stages                 color 0 and 1, the texcoord of each stage's number, or of its texcoordindex for
 *                          the fixed function
 *   ps_1_x, ps_2_x         color 0 and 1 as v0 and v1, texcoord 0 to 7 as t0 to t7
 *   ps_3_0                 the usages that its inputs are declared with
 *   fog, but in ps_3_0     fog 0
 *
 *   vertex side            supplies
 *   fixed function         color 0 and 1, and as texcoord n the result of stage n's texgen and matrix
 *   vs_1_1 to vs_2_x       oD0 and oD1, oT0 to oT7, oFog, oPts
 *   vs_3_0                 the usages that its outputs are declared with
 *
 * A component that is requested but not supplied has its default; the draw is not refused. Defaults are those
 * of vertices without the element: color 0 is 1 1 1 1, color 1 is 0 0 0 0, all others are 0 0 0 1. Without a
 * fog factor there is no fog. A component that is supplied but not requested is dead code. A shader
 * that is needed for nothing but tests and counts is removed from the key. */
#include "render/derive/derive_part.h"
#include "contract/key_query.h"
#include "shader/program/program.h"

_Static_assert((int)PORTS == (int)PROGRAM_PORTS && (int)PORT_CHANNEL == (int)PORT_COORDINATE &&
                   (int)OUTPUTS == (int)OUTPUT_COUNT,
               "ports and outputs agree with programs");
_Static_assert((int)TRIPTYCH_USAGE_SAMPLE == (int)USAGE_SAMPLE &&
                   (int)TRIPTYCH_USAGE_COLOR == (int)USAGE_COLOR,
               "usages agree with the public ones");

/* Vertices in the window are not processed any further. */
const struct program *derive_vertex_program(const struct state *state)
{
    bool window = state->element[ATTRIBUTE_POSITIONT].format != TRIPTYCH_FORMAT_NONE;
    return window ? NULL : state->program[STAGE_VERTEX];
}

const struct program *derive_pixel_program(const struct state *state)
{
    return state->program[STAGE_PIXEL];
}

static uint8_t legacy(const struct state *state)
{
    return state->convention[TRIPTYCH_MULTIPLY] == TRIPTYCH_MULTIPLY_LEGACY;
}

static void store_booleans(const struct state *state, const struct program *program, uint8_t booleans[2])
{
    unsigned bits = state->booleans[program->model->stage] & program->booleans;
    booleans[0] = (uint8_t)bits;
    booleans[1] = (uint8_t)(bits >> 8);
}

/* --- Vertices --- */

/* The number of a blending by primitive and its colour: elements of vertices, the first two inputs of the
 * fixed function, and outputs of vertex shaders. */
static const struct {
    uint8_t usage, usage_index, components;
} blending[] = {{TRIPTYCH_USAGE_BLENDINDICES, 1, 1}, {TRIPTYCH_USAGE_COLOR, 2, 4}};

enum { BLENDING_INPUTS = sizeof blending / sizeof *blending };

static const struct state_element *blending_element(const struct state *state, unsigned input)
{
    return state_find_element(state, blending[input].usage, blending[input].usage_index);
}

bool derive_blends_by_primitive(const struct state *state)
{
    const struct program *program = derive_vertex_program(state);
    if (!GET(state, primitiveblendenable) || GET(state, logicop) != TRIPTYCH_LOGICOP_NONE)
        return false;
    return program ? program_gives(program, blending[0].usage, blending[0].usage_index, 0) >= 0
                   : blending_element(state, 0) != NULL;
}

void derive_blending_inputs(const struct state *state, struct vertex_key *key)
{
    for (unsigned i = 0; i < BLENDING_INPUTS; i++) {
        const struct state_element *element = blending_element(state, i);
        if (element)
            key->input[i] = derive_format(element, blending[i].components);
    }
}

const struct state_element *derive_input(const struct state *state, const struct vertex_key *key,
                                         unsigned number)
{
    const struct program *program = derive_vertex_program(state);
    if (key->input[number] == ATTRIBUTE_FORMAT_NONE)
        return NULL;
    if (!program)
        return blending_element(state, number);
    const struct shader_port *port = program_declaration(program, FILE_INPUT, number);
    return state_find_element(state, port->usage, port->usage_index);
}

static int highest(unsigned mask)
{
    return mask ? 32 - __builtin_clz(mask) : 0;
}

static void derive_inputs(const struct state *state, const struct program *program, struct vertex_key *key)
{
    for (unsigned i = 0; i < INPUTS; i++) {
        unsigned mask = program->input_mask[i] | (program->input_third[i] ? 4 : 0);
        const struct shader_port *port = mask ? program_declaration(program, FILE_INPUT, i) : NULL;
        if (!port)
            continue;
        const struct state_element *element = state_find_element(state, port->usage, port->usage_index);
        if (element)
            key->input[i] = derive_format(element, highest(mask));
    }
}

/* Component c of a usage with its number. */
struct question {
    bool asked;
    unsigned usage, usage_index, c;
};

static uint8_t default_link(struct question q)
{
    bool color = q.usage == USAGE_COLOR, diffuse = color && q.usage_index == 0,
         specular = color && q.usage_index == 1;
    return diffuse || (q.c == 3 && !specular) ? LINK_ONE : LINK_ZERO;
}

static uint8_t link_to(const struct program *program, struct question q)
{
    int output = program_gives(program, q.usage, q.usage_index, q.c);
    return output < 0 ? default_link(q) : (uint8_t)(LINK_OUTPUT + 4 * output + (int)q.c);
}

/* A number of the vertex itself: the fog factor or the size of points. */
static uint8_t link_to_number(const struct program *program, unsigned usage)
{
    return link_to(program, (struct question){true, usage, 0, 0});
}

static void link_blending(const struct program *program, uint8_t link[BLENDING_COMPONENTS])
{
    for (unsigned i = 0; i < BLENDING_INPUTS; i++)
        for (unsigned c = 0; c < blending[i].components; c++)
            *link++ =
                link_to(program, (struct question){true, blending[i].usage, blending[i].usage_index, c});
}

/* The usage that a shader requests for component c of a port. */
static struct question shader_asks(const struct program *program, int port, unsigned c)
{
    const struct program_port *in = &program->port[port];
    const struct shader_port *from = in->mask ? program_input(program, in->file, in->index, c) : NULL;
    return from ? (struct question){true, from->usage, from->usage_index, c}
                : (struct question){.asked = false};
}

/* The usage that stages request. After vertex shaders the fourth coordinate is the divisor. */
static struct question stages_ask(const struct pixel_key *pixel, int port, unsigned c)
{
    if (port < PORT_CHANNEL)
        return (struct question){true, USAGE_COLOR, (unsigned)port, c};
    int stage = derive_channel_stage(pixel, port - PORT_CHANNEL);
    if (stage < 0)
        return (struct question){.asked = false};
    return (struct question){true, USAGE_TEXCOORD, (unsigned)stage, c};
}

/* The fixed function fills a register by its first declaration. */
static uint8_t fixed_link(const struct state *state, const struct pixel_key *pixel, int port,
                          struct question q)
{
    bool gives;
    if (port < PORT_CHANNEL)
        gives = q.usage == USAGE_COLOR && q.usage_index == (unsigned)port;
    else
        gives = q.usage == USAGE_TEXCOORD && q.usage_index < TEXTURE_STAGES &&
                (int)q.usage_index == derive_channel_set(state, pixel, port - PORT_CHANNEL);
    return gives ? LINK_FIXED : default_link(q);
}

void derive_links(const struct state *state, const struct pixel_key *pixel, struct vertex_key *key)
{
    const struct program *program = derive_vertex_program(state);
    for (int i = 0; i < 4 * PORTS; i++) {
        int port = i / 4;
        if (!key->varying[port_varying(port, i % 4)])
            continue;
        struct question q = key_program(pixel->shader)
                                ? shader_asks(derive_pixel_program(state), port, (unsigned)i % 4)
                                : stages_ask(pixel, port, (unsigned)i % 4);
        if (!q.asked)
            key->link[i] = LINK_ZERO;
        else if (program)
            key->link[i] = link_to(program, q);
        else
            key->link[i] = fixed_link(state, pixel, port, q);
    }
}

bool derive_shader_gives(const struct program *program, unsigned usage)
{
    return program_gives(program, usage, 0, 0) >= 0;
}

void derive_vertex_shader(const struct state *state, const struct program *program,
                          const struct setup_key *setup, struct vertex_key *key)
{
    key_set_program(key->shader, program->number);
    store_booleans(state, program, key->booleans);
    key->legacy = legacy(state);
    key->depth_range = state->convention[TRIPTYCH_DEPTH_RANGE] == TRIPTYCH_DEPTH_RANGE_MINUS;
    derive_inputs(state, program, key);
    for (int i = 0; i < VERTEX_SAMPLERS; i++)
        if (program->interface.sampled >> i & 1)
            derive_vertex_sampler(state, i, key);
    if (key->varying[VARYING_fog])
        key->fog_link = link_to_number(program, USAGE_FOG);
    if (key->varying[VARYING_blending])
        link_blending(program, key->blending_link);
    if (setup->point_size)
        key->size_link = link_to_number(program, USAGE_PSIZE);
}

/* --- Pixels --- */

static const struct program_port *channel_port(const struct state *state, const struct pixel_key *key,
                                               int channel)
{
    const struct program *program = key_program(key->shader) ? derive_pixel_program(state) : NULL;
    return program && program->port[PORT_CHANNEL + channel].mask ? &program->port[PORT_CHANNEL + channel]
                                                                 : NULL;
}

int derive_channel_set(const struct state *state, const struct pixel_key *key, int channel)
{
    if (!key_program(key->shader))
        return derive_channel_stage(key, channel);
    const struct program_port *port = channel_port(state, key, channel);
    const struct shader_port *from =
        port ? program_declaration(derive_pixel_program(state), port->file, port->index) : NULL;
    return from && from->usage == USAGE_TEXCOORD ? (int)from->usage_index : -1;
}

/* Colours go by the shading mode. Over a point nothing varies but the coordinates of a sprite. */
static uint8_t port_interpolation(const struct state *state, const struct program_port *port, int number,
                                  enum primitive primitive)
{
    bool flat = port->color && derive_flat(state);
    bool sprite = port->coordinate && number >= PORT_CHANNEL && GET(state, pointspriteenable);
    if (primitive_is_point(primitive) ? !sprite : flat)
        return INTERPOLATION_FLAT;
    return INTERPOLATION_SMOOTH;
}

/* Two-dimensional sampling without comparison does not read a third coordinate. */
static bool third_is_read(const struct program_port *port, const struct pixel_key *key)
{
    bool r = !port->third;
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        r |= port->third >> i & 1 && key->texture[i] &&
             (key->texture[i] != TEXTURE_2D || key->texel[i] == TEXEL_COMPARE);
    return r;
}

static void derive_ports(const struct state *state, const struct program *program, enum primitive primitive,
                         struct pixel_key *key)
{
    for (int i = 0; i < PORTS; i++)
        for (int c = 0; c < 4; c++)
            if (program->port[i].mask >> c & 1 && (c != 2 || third_is_read(&program->port[i], key)))
                key->varying[port_varying(i, c)] = port_interpolation(state, &program->port[i], i, primitive);
}

static bool samples_coordinates(const struct program *program, int stage)
{
    for (uint32_t i = 0; i < program->steps; i++) {
        const struct shader_instruction *instruction = &program->step[i].instruction;
        unsigned opcode = instruction->opcode;
        if ((opcode == SHADER_TEX || opcode == SHADER_TEXBEM || opcode == SHADER_TEXBEML) &&
            instruction->destination.index == stage)
            return true;
    }
    return false;
}

/* ps_1_1 to ps_1_3 divide by the stage's state where they sample at its coordinates; later models encode
 * the division. */
static void derive_projected(const struct state *state, const struct program *program, struct pixel_key *key)
{
    if (shader_major(program->model) > 1 || program->model->column == COLUMN_PS_1_4)
        return;
    for (int i = 0; i < PROJECTED_STAGES; i++)
        if (key->texture[i] && samples_coordinates(program, i))
            key->projected[i] = derive_projection(state, i);
}

/* Positions of samples affect only their depth and centroids. */
static bool reads_centroid(const struct program *program)
{
    bool r = false;
    for (int i = 0; i < PORTS; i++)
        r |= program->port[i].mask && program->port[i].centroid;
    return r;
}

void derive_pixel_shader(const struct state *state, const struct program *program, enum primitive primitive,
                         struct pixel_key *key)
{
    key_set_program(key->shader, program->number);
    store_booleans(state, program, key->booleans);
    key->legacy = legacy(state);
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        if (program->interface.sampled >> i & 1)
            derive_pixel_sampler(state, i, key);
    if (shader_is_opengl(program->model))
        key->place = (uint8_t)(program->interface.place >> 2);
    derive_projected(state, program, key);
    derive_ports(state, program, primitive, key);
    if (shader_major(program->model) < 3 && key->write_mask[0] & MASK_COLOR) {
        derive_fog(state, key);
        if (key->varying[VARYING_fog] && primitive_is_point(primitive))
            key->varying[VARYING_fog] = INTERPOLATION_FLAT;
    }
    if ((!pixel_tests_depth(key) || key->depth_output) && !reads_centroid(program))
        key->sample_centers = 0;
}
