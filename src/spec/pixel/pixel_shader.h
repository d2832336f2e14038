/* Pixels by a shader: its inputs and results.
 *
 * Varyings arrive at ports (shader/program/program.h); only the components that are read are interpolated.
 * Colours are interpolated at the centroid, and clamped to 0..1 below model 3.0. All else is interpolated at
 * the pixel's centre unless the shader declares otherwise. vPos is the pixel's column and row, wherever its
 * centre is; in ps_gl these plus 1/2, with the triangle's depth and 1/w. vFace is 1 on clockwise triangles,
 * on lines and on points, else -1.
 *
 * The results are oC0 to oC3, each for its own target, and r0 in ps_1_x. If a factor of blending is of the
 * second colour, oC1 is that colour, and only the first target is written. The first result's alpha is the
 * alpha test's, and the first result is fogged, in models below 3.0. With targets of up to 8 bits, colours
 * are quantized as soon as the shader has ended, and the steps that follow are those of packed colours. */
#ifndef SPEC_PIXEL_PIXEL_SHADER_H
#define SPEC_PIXEL_PIXEL_SHADER_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/math/float_color.h"
#include "spec/pixel/depth.h"
#include "spec/pixel/float_pixel.h"
#include "spec/pixel/interpolate.h"
#include "spec/pixel/packed_pixel.h"
#include "spec/pixel/stencil.h"
#include "spec/shader/shader.h"
#include "spec/shader/shader_flow.h"

/* Inputs that are not interpolated are 0. */
static inline void shader_nothing(struct env *e, struct machine *m)
{
    flt zero = lit_f(E, 0.0f);
    for (int i = 0; i < OUTPUT_COUNT; i++)
        for (int c = 0; c < 4; c++)
            m->input[i][c] = zero;
    for (int i = 0; i < 8; i++)
        for (int c = 0; c < 4; c++)
            m->coordinate[i][c] = zero;
    for (int c = 0; c < 4; c++)
        m->place[c] = m->sprite[c] = m->face[c] = zero;
}

static inline flt port_value(struct env *e, const struct pixel_source *s, const struct program_port *port,
                             int number, int c)
{
    int varying = port_varying(number, c);
    const struct pixel_position *at = port->centroid ? &s->color_at : s->at;
    if (!s->k->varying[varying])
        return lit_f(E, 0.0f);
    flt value = interpolate(E, s->k, s->layout, at, port->centroid ? s->color_w : s->w, varying,
                            port_component(number, c));
    return port->color && shader_major(e->program->model) < 3 ? saturate(E, value) : value;
}

static inline void shader_varyings(struct env *e, const struct pixel_source *s, struct machine *m)
{
    for (int i = 0; i < PORTS; i++) {
        const struct program_port *port = &e->program->port[i];
        flt *to = port->file == FILE_TEXTURE ? m->coordinate[port->index] : m->input[port->index];
        for (int c = 0; c < 4; c++)
            if (port->mask >> c & 1)
                to[c] = port_value(E, s, port, i, c);
    }
}

/* The pixel's centre on the target. */
static inline void shader_centre(struct env *e, flt centre[2])
{
    flt x = uniform_f(E, BASE_ENTRY, (int)offsetof(struct entry, x));
    flt y = uniform_f(E, BASE_ENTRY, (int)offsetof(struct entry, y));
    flt lane_x = load_f(E, BASE_LANES, (int)offsetof(struct lane_table, x));
    flt lane_y = load_f(E, BASE_LANES, (int)offsetof(struct lane_table, y));
    centre[0] = add_f(E, x, lane_x);
    centre[1] = add_f(E, y, lane_y);
}

/* From 0 at the low side of a point to 1 at the high side, which are in 1/256 pixel. */
static inline flt shader_across(struct env *e, flt centre, size_t low, size_t high)
{
    itg begin = uniform_i(E, BASE_TRIANGLE, (int)low);
    itg end = uniform_i(E, BASE_TRIANGLE, (int)high);
    itg size = sub_i(E, end, begin);
    flt first = float_f(E, begin);
    flt extent = float_f(E, size);
    flt minus = neg_f(E, first);
    flt distance = mad_f(E, centre, lit_f(E, 1 << SUBPIXEL_BITS), minus);
    return div_f(E, distance, extent);
}

static inline void shader_sprite(struct env *e, struct machine *m)
{
    flt centre[2];
    shader_centre(E, centre);
    m->sprite[0] = shader_across(E, centre[0], offsetof(struct triangle_head, x[0]),
                                 offsetof(struct triangle_head, x[1]));
    m->sprite[1] = shader_across(E, centre[1], offsetof(struct triangle_head, y[0]),
                                 offsetof(struct triangle_head, y[1]));
    m->sprite[3] = lit_f(E, 1.0f);
}

static inline void shader_place_opengl(struct env *e, const struct pixel_source *s, struct machine *m)
{
    shader_centre(E, m->place);
    if (s->k->place & PLACE_DEPTH)
        m->place[2] = pixel_depth(E, s->at, s->layout);
    if (s->k->place & PLACE_W)
        m->place[3] = pixel_reciprocal_w(E, s->k, s->at, s->layout);
}

static inline void shader_place_direct3d(struct env *e, struct machine *m)
{
    flt centre[2];
    shader_centre(E, centre);
    m->place[0] = m->place[2] = sub_f(E, centre[0], lit_f(E, 0.5f));
    m->place[1] = m->place[3] = sub_f(E, centre[1], lit_f(E, 0.5f));
}

static inline void shader_place(struct env *e, const struct pixel_source *s, struct machine *m)
{
    if (e->program->interface.place && shader_is_opengl(e->program->model))
        shader_place_opengl(E, s, m);
    else if (e->program->interface.place)
        shader_place_direct3d(E, m);
    if (e->program->interface.sprite)
        shader_sprite(E, m);
    if (e->program->interface.face) {
        msk clockwise = triangle_clockwise(E);
        flt sign = select_f(E, clockwise, lit_f(E, 1.0f), lit_f(E, -1.0f));
        for (int c = 0; c < 4; c++)
            m->face[c] = sign;
    }
}

static inline struct float_color shader_color(const struct machine *m, int target)
{
    struct float_color r;
    int first = shader_major(m->program->model) == 1 ? CELL_TEMPORARY : CELL_OUTPUT + 4 * target;
    for (int c = 0; c < 4; c++)
        r.channel[c] = m->cell[first + c];
    return r;
}

static inline void finish_shader_packed(struct env *e, const struct pixel_source *s, const struct machine *m,
                                        msk live)
{
    struct color color[TARGETS];
    for (int t = 0; t < TARGETS; t++) {
        struct float_color exact = shader_color(m, t);
        if (!pixel_has_color(s->k, t))
            continue;
        color[t] = color_quantize(E, exact.channel);
        if (t == 0)
            color[t] = apply_fog(E, s, color[t]);
    }
    finish_packed(E, s, color, 1, live);
}

static inline void finish_shader_float(struct env *e, const struct pixel_source *s, const struct machine *m,
                                       msk live)
{
    struct float_color color[TARGETS];
    for (int t = 0; t < TARGETS; t++)
        color[t] = shader_color(m, t);
    color[0] = apply_float_fog(E, s, color[0]);
    finish_float(E, s, color, 1, live);
}

static inline void shade_by_shader(struct env *e, const struct pixel_source *s, msk live)
{
    MACHINE(E, m);
    const struct pixel_key *k = s->k;
    flt depth;
    machine_begin(E, m, k->booleans, k->legacy);
    m->pixel = k;
    shader_nothing(E, m);
    shader_varyings(E, s, m);
    shader_place(E, s, m);
    machine_run(E, m);
    if (k->kills) {
        live = andn_m(E, live, m->killed);
        OBSERVE(E, kept, 0, live);
    }
    if (k->depth_output) {
        depth = clamp_depth(E, m->cell[CELL_DEPTH]);
        for (int i = 0; i < s->samples->count; i++)
            s->samples->at[i].depth = &depth;
    }
    if (k->float_color)
        finish_shader_float(E, s, m, live);
    else
        finish_shader_packed(E, s, m, live);
}

#endif
