/* Vertices by a shader: its inputs and outputs.
 *
 * Inputs are the attributes that the declaration names with their usage, or 0 0 0 1. Outputs are linked to
 * the pixel routine's ports, component by component (the key's links). Below model 3.0, colours and the fog
 * factor are clamped to 0..1; nothing else is. A component that the pixel routine reads and the shader never
 * writes is 0 or 1, by its link. */
#ifndef SPEC_VERTEX_VERTEX_SHADER_H
#define SPEC_VERTEX_VERTEX_SHADER_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/shader/shader.h"
#include "spec/shader/shader_flow.h"
#include "spec/vertex/fetch.h"
#include "spec/vertex/point_size.h"
#include "spec/vertex/store.h"

static inline struct vector4 vertex_input(struct env *e, const struct vertex_key *k, int i)
{
    struct fetched from = {k->input[i], (int)offsetof(struct job, input[i])};
    struct vector4 value;
    for (int c = 0; c < 4; c++)
        value.v[c] = lit_f(E, c == 3 ? 1.0f : 0.0f);
    return from.format == ATTRIBUTE_FORMAT_NONE ? value : fetch_element(E, &from);
}

static inline void shader_inputs(struct env *e, const struct vertex_key *k, struct machine *m)
{
    for (int i = 0; i < INPUTS; i++) {
        struct vector4 value = vertex_input(E, k, i);
        for (int c = 0; c < 4; c++)
            m->input[i][c] = value.v[c];
    }
}

/* Returns true for outputs that models below 3.0 clamp. */
static inline bool is_clamped(const struct machine *m, int link)
{
    int number = (link - LINK_OUTPUT) / 4;
    return shader_major(m->program->model) < 3 && (number < OUTPUT_COORDINATE || number == OUTPUT_FOG);
}

/* The value at a link to an output. */
static inline flt linked(struct env *e, const struct machine *m, int link)
{
    flt value = m->cell[CELL_OUTPUT + link - LINK_OUTPUT];
    return is_clamped(m, link) ? clamp_unit(E, value) : value;
}

/* The value at a link that has no output. */
static inline flt unlinked(struct env *e, int link)
{
    return lit_f(E, link == LINK_ONE ? 1.0f : 0.0f);
}

static inline flt value_at_link(struct env *e, const struct machine *m, int link)
{
    return link >= LINK_OUTPUT ? linked(E, m, link) : unlinked(E, link);
}

/* A clip depth from -w to w is moved to the range that is tested, 0 to w. */
static inline void shader_position(struct env *e, const struct vertex_key *k, const struct machine *m)
{
    flt clip[4];
    for (int c = 0; c < 4; c++) {
        int output = program_gives(m->program, USAGE_POSITION, 0, (unsigned)c);
        clip[c] = output < 0 ? lit_f(E, c == 3 ? 1.0f : 0.0f) : m->cell[CELL_OUTPUT + 4 * output + c];
    }
    if (k->depth_range) {
        flt half = mul_f(E, clip[3], lit_f(E, 0.5f));
        clip[2] = mad_f(E, clip[2], lit_f(E, 0.5f), half);
    }
    for (int c = 0; c < 4; c++)
        store_slot(E, SLOT_X + c, clip[c]);
    store_position(E, k, clip);
}

static inline void vertex_by_shader(struct env *e, const struct vertex_key *k)
{
    MACHINE(E, m);
    machine_begin(E, m, k->booleans, k->legacy);
    m->vertex = k;
    shader_inputs(E, k, m);
    machine_run(E, m);
    shader_position(E, k, m);
    for (int i = 0; i < 4 * PORTS; i++) {
        int varying = port_varying(i / 4, i % 4);
        if (!k->varying[varying])
            continue;
        flt value = value_at_link(E, m, k->link[i]);
        store_slot(E, varying_slot[varying] + port_component(i / 4, i % 4), value);
    }
    if (k->varying[VARYING_fog] && k->fog_link >= LINK_OUTPUT) {
        flt fog = linked(E, m, k->fog_link);
        store_slot(E, SLOT_fog, fog);
    }
    for (int c = 0; c < BLENDING_COMPONENTS && k->varying[VARYING_blending]; c++) {
        flt value = value_at_link(E, m, k->blending_link[c]);
        store_slot(E, SLOT_blending + c, value);
    }
    if (k->size_link >= LINK_OUTPUT) {
        flt size = linked(E, m, k->size_link);
        flt limited = limit_point_size(E, size);
        store_slot(E, SLOT_POINT_SIZE, limited);
    }
}

#endif
