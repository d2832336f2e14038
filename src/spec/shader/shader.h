/* Shaders: registers and operands. shader_arithmetic.h and shader_texture.h have a function for what each
 * instruction computes. This file has the part that all instructions share: reading sources and modifying
 * them, and writing results. shader_flow.h has flow control and the walk through a program's steps
 * (shader/program/program.h).
 *
 * Registers are C variables that hold values: a recorder renames them, and no register file remains. Inside a
 * region that only some lanes execute, a write replaces the register in all lanes, and its value from before
 * the region is kept. settle() selects between both, lane by lane, before the set of lanes changes. So a
 * region costs a selection for each component that it changes, not one for each write.
 *
 * Values follow the standard where it has a rule. Registers addressed outside of their range are 0. Results
 * of ps_1_x stay within -8 and 8, and its constants within -1 and 1. Saturated NaN is 0. */
#ifndef SPEC_SHADER_SHADER_H
#define SPEC_SHADER_SHADER_H

#include "contract/language.h"
#include "spec/math/float_color.h"
#include "spec/math/vector.h"

/* Variables (get_, set_) for loops and for calls, by their depth. They follow those of the first cells. The
 * last ones are those of the temporaries from CELL_MORE on. */
enum {
    VARIABLE_LIVE = CELL_MORE,
    VARIABLE_COUNT = VARIABLE_LIVE + PROGRAM_LOOPS,
    VARIABLE_COUNTER = VARIABLE_COUNT + PROGRAM_LOOPS,
    VARIABLE_RESUMED = VARIABLE_COUNTER + PROGRAM_LOOPS,
    VARIABLE_STAY = VARIABLE_RESUMED + PROGRAM_LOOPS,
    VARIABLE_END = VARIABLE_STAY + PROGRAM_CALLS + 1,
    VARIABLE_MORE = VARIABLES - (CELL_COUNT - CELL_MORE)
};

static inline int variable_of_cell(unsigned cell)
{
    return cell < CELL_MORE ? (int)cell : (int)(VARIABLE_MORE - CELL_MORE + cell);
}

struct machine {
    const struct program *program;
    unsigned booleans;    /* bits of the Boolean constants */
    bool legacy;          /* 0 times anything is 0 */
    flt cell[CELL_COUNT]; /* floats only */
    itg address[4];
    msk predicate[4];
    msk killed;
    flt product[8]; /* by stage: a row of a matrix times a vector, of ps_1_1 to ps_1_3 */

    /* The lanes that execute, unless all do, and the values of changed cells in the other lanes. */
    bool masked;
    msk mask;
    struct cell_set changed;
    flt before[CELL_COUNT];
    itg address_before[4];
    msk predicate_before[4];

    /* The innermost loop. */
    int loops;
    msk live;    /* lanes that have not left its pass */
    msk resumed; /* lanes that have left the pass and not the loop, if it has a continue */
    itg counter; /* aL */

    /* The subroutine, or the main program. */
    int calls;
    msk stay; /* lanes that have not returned, if it returns early */

    /* The shader's inputs. */
    flt input[OUTPUT_COUNT][4];      /* v# */
    flt coordinate[8][4];            /* t# */
    flt place[4];                    /* vPos: x, y, x, y; of ps_gl x, y, depth, 1/w */
    flt sprite[4];                   /* vPoint */
    flt face[4];                     /* vFace, in all components */
    const struct pixel_key *pixel;   /* of a pixel shader */
    const struct vertex_key *vertex; /* of a vertex shader */
};

/* An instruction in execution. */
struct step {
    const struct shader_instruction *instruction;
    struct machine *machine;
    int mask;    /* components of the result that are computed */
    bool legacy; /* multiplication is the legacy one */
    struct vector4 source[SHADER_SOURCES];
    struct vector4 row[4]; /* of a matrix: the second source and the registers that follow it */
};

/* --- Sources ------------------------------------------------------------------------------------------- */

static inline flt component_of_literal(struct env *e, const struct program_constant *constant, unsigned c)
{
    float value;
    memcpy(&value, &constant->value[c], sizeof value);
    return lit_f(E, value);
}

/* The relative part of an index: a0.x to a0.w, or aL. */
static inline itg relative_index(struct env *e, const struct machine *m, const struct shader_operand *o)
{
    itg base = o->relative == FILE_ADDRESS ? m->address[o->component] : m->counter;
    return add_i(E, base, lit_i(E, o->index));
}

/* The row of a constant; outside of their range, the row of zeros that follows them. */
static inline itg constant_row(struct env *e, const struct machine *m, const struct shader_operand *o,
                               int row)
{
    int rows = (int)m->program->constants;
    itg index = relative_index(E, m, o);
    if (row)
        index = add_i(E, index, lit_i(E, row));
    msk below = gt_i(E, lit_i(E, 0), index);
    msk above = gt_i(E, index, lit_i(E, rows - 1));
    msk outside = or_m(E, below, above);
    itg inside = select_i(E, outside, lit_i(E, rows), index);
    return add_i(E, inside, inside);
}

/* The constant `row` registers after the operand's: component swizzle(place) for each of `places`. */
static inline struct vector4 read_constant(struct env *e, const struct machine *m,
                                           const struct shader_operand *o, int row, unsigned places)
{
    struct vector4 r = {{m->cell[0], m->cell[0], m->cell[0], m->cell[0]}};
    const struct program_constant *constant =
        o->relative ? NULL : program_defined(m->program, FILE_CONSTANT, o->index + (unsigned)row);
    itg index = lit_i(E, 0);
    if (o->relative)
        index = constant_row(E, m, o, row);
    for (unsigned p = 0; p < 4; p++) {
        unsigned c = swizzle_component(o->swizzle, p);
        if (!(places >> p & 1))
            continue;
        if (constant)
            r.v[p] = component_of_literal(E, constant, c);
        else if (o->relative)
            r.v[p] = gather_f(E, BASE_CONSTANT, GATHER_DIRECT, index, 8, (int)(4 * c));
        else
            r.v[p] = uniform_f(E, BASE_CONSTANT, (int)(16 * (o->index + (unsigned)row) + 4 * c));
    }
    return r;
}

/* v[aL + n], v[a0.x + n]: the input with that number; 0 if there is none. */
static inline flt indexed_input(struct env *e, const struct machine *m, const struct shader_operand *o,
                                unsigned c)
{
    itg index = relative_index(E, m, o);
    flt r = lit_f(E, 0.0f);
    for (unsigned i = 0; i < OUTPUT_COUNT; i++) {
        if (i >= shader_register_count(FILE_INPUT, m->program->model))
            continue;
        msk here = eq_i(E, index, lit_i(E, (int)i));
        r = select_f(E, here, m->input[i][c], r);
    }
    return r;
}

/* r[a0.x + n]: the register of the array with that number; 0 if there is none. */
static inline flt indexed_temporary(struct env *e, const struct machine *m, const struct shader_operand *o,
                                    unsigned c)
{
    itg index = relative_index(E, m, o);
    flt r = lit_f(E, 0.0f);
    for (unsigned i = m->program->array_begin[o->index]; i < m->program->array_end[o->index]; i++) {
        msk here = eq_i(E, index, lit_i(E, (int)i));
        r = select_f(E, here, m->cell[cell_of_temporary(i) + c], r);
    }
    return r;
}

/* Returns true if a texture register has what was sampled there, false if it has coordinates. */
static inline bool textures_are_written(const struct shader_model *model)
{
    return shader_is_narrow(model) && model->column != COLUMN_PS_1_4;
}

/* One component of a register that is not a constant. */
static inline flt read_component(struct env *e, const struct machine *m, const struct shader_operand *o,
                                 int row, unsigned c)
{
    unsigned index = o->index + (unsigned)row;
    bool written = textures_are_written(m->program->model);
    if (o->file == FILE_TEMPORARY)
        return o->relative ? indexed_temporary(E, m, o, c) : m->cell[cell_of_temporary(index) + c];
    if (o->file == FILE_TEXTURE)
        return written ? m->cell[CELL_TEXTURE + 4 * index + c] : m->coordinate[index][c];
    if (o->file == FILE_PLACE)
        return m->place[c];
    if (o->file == FILE_SPRITE)
        return m->sprite[c];
    if (o->file == FILE_FACE)
        return m->face[c];
    return o->relative ? indexed_input(E, m, o, c) : m->input[index][c];
}

/* The component that is read for a place: where nothing is read, that of the first place. */
static inline unsigned place_component(const struct shader_operand *o, unsigned places, unsigned p)
{
    return swizzle_component(o->swizzle, places >> p & 1 ? p : 0);
}

/* The registers of a source, or of the one `row` registers after it, swizzled. */
static inline struct vector4 read_registers(struct env *e, const struct machine *m,
                                            const struct shader_operand *o, int row, unsigned places)
{
    struct vector4 r;
    if (o->file == FILE_CONSTANT)
        return read_constant(E, m, o, row, places);
    for (unsigned p = 0; p < 4; p++)
        r.v[p] = read_component(E, m, o, row, place_component(o, places, p));
    return r;
}

/* Applies a source modifier to one component. */
static inline flt modify(struct env *e, int modifier, flt v)
{
    switch ((enum shader_modifier_id)modifier) {
    case MODIFIER_NEGATE: return neg_f(E, v);
    case MODIFIER_BIAS: return sub_f(E, v, lit_f(E, 0.5f));
    case MODIFIER_NEGATE_BIAS: return sub_f(E, lit_f(E, 0.5f), v);
    case MODIFIER_SIGN: return mad_f(E, v, lit_f(E, 2.0f), lit_f(E, -1.0f));
    case MODIFIER_NEGATE_SIGN: return mad_f(E, v, lit_f(E, -2.0f), lit_f(E, 1.0f));
    case MODIFIER_COMPLEMENT: return sub_f(E, lit_f(E, 1.0f), v);
    case MODIFIER_X2: return add_f(E, v, v);
    case MODIFIER_NEGATE_X2: return mul_f(E, v, lit_f(E, -2.0f));
    case MODIFIER_NONE:
    case MODIFIER_DIVIDE_Z:
    case MODIFIER_DIVIDE_W:
    case MODIFIER_NOT:
    case MODIFIER_COUNT: return v;
    case MODIFIER_ABSOLUTE:
    case MODIFIER_NEGATE_ABSOLUTE: break;
    }
    itg bits = bits_i(E, v);
    itg cleared = and_i(E, bits, lit_i(E, 0x7fffffff));
    flt magnitude = bits_f(E, cleared);
    if (modifier == MODIFIER_ABSOLUTE)
        return magnitude;
    return neg_f(E, magnitude);
}

/* A source, or the register `row` registers after it. Components outside of `places` are undefined. */
static inline struct vector4 read_source(struct env *e, const struct machine *m,
                                         const struct shader_operand *o, int row, unsigned places)
{
    struct vector4 r = READ_REGISTERS(E, m, o, row, places);
    for (unsigned p = 0; p < 4; p++)
        if (places >> p & 1)
            r.v[p] = modify(E, o->modifier, r.v[p]);
    return r;
}

static inline bool is_value(const struct shader_operand *o)
{
    return o->file && shader_registers[o->file].access & IS_FLOAT;
}

static inline void read_sources(struct env *e, struct step *s)
{
    const struct shader_operation *row = &shader_operations[s->instruction->opcode];
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++) {
        const struct shader_operand *o = &s->instruction->source[i];
        unsigned places = shader_source_components(s->instruction, i);
        if (!is_value(o))
            continue;
        s->source[i] = read_source(E, s->machine, o, 0, places);
        if (row->source[i] == OPERAND_MATRIX)
            for (int r = 0; r < row->rows; r++)
                s->row[r] = r ? read_source(E, s->machine, o, r, places) : s->source[i];
    }
}

/* --- Results ------------------------------------------------------------------------------------------- */

static inline void remember(struct machine *m, unsigned cell)
{
    if (!m->masked || cell_in(&m->changed, cell))
        return;
    cell_add(&m->changed, cell);
    if (cell_is_float(cell))
        m->before[cell] = m->cell[cell];
    else if (cell < CELL_PREDICATE)
        m->address_before[cell - CELL_ADDRESS] = m->address[cell - CELL_ADDRESS];
    else
        m->predicate_before[cell - CELL_PREDICATE] = m->predicate[cell - CELL_PREDICATE];
}

static inline msk select_m(struct env *e, msk mask, msk a, msk b)
{
    msk chosen = and_m(E, a, mask);
    msk kept = andn_m(E, b, mask);
    return or_m(E, chosen, kept);
}

/* Restores the values of changed cells in the lanes that do not execute. */
static inline void settle(struct env *e, struct machine *m)
{
    unsigned end = m->program->cells;
    for (unsigned c = cell_next(&m->changed, 0, end); c < end; c = cell_next(&m->changed, c + 1, end)) {
        unsigned a = c - CELL_ADDRESS, p = c - CELL_PREDICATE;
        if (cell_is_float(c))
            m->cell[c] = select_f(E, m->mask, m->cell[c], m->before[c]);
        else if (c < CELL_PREDICATE)
            m->address[a] = select_i(E, m->mask, m->address[a], m->address_before[a]);
        else
            m->predicate[p] = select_m(E, m->mask, m->predicate[p], m->predicate_before[p]);
    }
    m->changed = (struct cell_set){{0}};
}

static inline flt finish_result(struct env *e, const struct machine *m, const struct shader_operand *to,
                                flt v)
{
    if (to->shift)
        v = mul_f(E, v, lit_f(E, to->shift > 0 ? (float)(1 << to->shift) : 1.0f / (float)(1 << -to->shift)));
    if (to->modifier & RESULT_SATURATE)
        return saturate(E, v);
    if (!shader_is_narrow(m->program->model))
        return v;
    flt low = max_f(E, v, lit_f(E, -8.0f));
    return min_f(E, low, lit_f(E, 8.0f));
}

/* The component of the predicate for component c, or its opposite. */
static inline msk predicate_of(struct env *e, const struct machine *m, const struct shader_operand *o,
                               unsigned c)
{
    msk p = m->predicate[swizzle_component(o->swizzle, c)];
    return o->modifier == MODIFIER_NOT ? andn_m(E, lit_m(E, -1), p) : p;
}

static inline void write_cell(struct env *e, struct machine *m, const struct shader_instruction *i,
                              unsigned cell, unsigned c, flt value)
{
    remember(m, cell + c);
    if (i->predicate.file) {
        msk p = predicate_of(E, m, &i->predicate, c);
        value = select_f(E, p, value, m->cell[cell + c]);
    }
    m->cell[cell + c] = value;
}

/* r[a0.x + n]: writes the register of the array with that number, if there is one. */
static inline void write_element(struct env *e, struct machine *m, const struct shader_instruction *i,
                                 unsigned c, flt value)
{
    const struct shader_operand *to = &i->destination;
    itg index = relative_index(E, m, to);
    for (unsigned r = m->program->array_begin[to->index]; r < m->program->array_end[to->index]; r++) {
        unsigned cell = cell_of_temporary(r);
        msk here = eq_i(E, index, lit_i(E, (int)r));
        flt chosen = select_f(E, here, value, m->cell[cell + c]);
        write_cell(E, m, i, cell, c, chosen);
    }
}

/* o[aL + n], o[a0.x + n]: writes the output with that number, if there is one. */
static inline void write_indexed(struct env *e, struct machine *m, const struct shader_instruction *i,
                                 unsigned c, flt value)
{
    itg index = relative_index(E, m, &i->destination);
    for (unsigned o = 0; o < OUTPUT_COUNT; o++) {
        if (o >= shader_register_count(FILE_OUTPUT, m->program->model))
            continue;
        unsigned cell = CELL_OUTPUT + 4 * o;
        msk here = eq_i(E, index, lit_i(E, (int)o));
        flt chosen = select_f(E, here, value, m->cell[cell + c]);
        write_cell(E, m, i, cell, c, chosen);
    }
}

static inline void write_result(struct env *e, struct machine *m, const struct shader_instruction *i,
                                const struct vector4 *result)
{
    const struct shader_operand *to = &i->destination;
    for (unsigned c = 0; c < 4; c++) {
        if (!(to->swizzle >> c & 1))
            continue;
        flt value = finish_result(E, m, to, result->v[c]);
        if (to->relative && to->file == FILE_TEMPORARY)
            write_element(E, m, i, c, value);
        else if (to->relative)
            write_indexed(E, m, i, c, value);
        else
            write_cell(E, m, i, program_cell(to), c, value);
    }
}

/* Writes the address register: the result of mova, and of vs_1_1's mov. */
static inline void write_address(struct env *e, struct machine *m, const struct shader_instruction *i,
                                 const itg value[4])
{
    for (unsigned c = 0; c < 4; c++) {
        if (!(i->destination.swizzle >> c & 1))
            continue;
        remember(m, CELL_ADDRESS + c);
        itg v = value[c];
        if (i->predicate.file) {
            msk p = predicate_of(E, m, &i->predicate, c);
            v = select_i(E, p, v, m->address[c]);
        }
        m->address[c] = v;
    }
}

static inline void write_predicate(struct env *e, struct machine *m, const struct shader_instruction *i,
                                   const msk value[4])
{
    for (unsigned c = 0; c < 4; c++) {
        if (!(i->destination.swizzle >> c & 1))
            continue;
        remember(m, CELL_PREDICATE + c);
        msk v = value[c];
        if (i->predicate.file) {
            msk p = predicate_of(E, m, &i->predicate, c);
            v = select_m(E, p, v, m->predicate[c]);
        }
        m->predicate[c] = v;
    }
}

/* Discards the pixels of these lanes, if they execute. */
static inline void kill(struct env *e, struct machine *m, msk lanes)
{
    if (m->masked)
        lanes = and_m(E, lanes, m->mask);
    m->killed = or_m(E, m->killed, lanes);
}

/* A comparison's mask (def/shader/shader_comparison.def): on NaN only NOT_EQUAL is true. */
static inline msk compare_values(struct env *e, int comparison, flt a, flt b)
{
    switch ((enum shader_comparison_id)comparison) {
    case COMPARISON_GREATER: return lt_f(E, b, a);
    case COMPARISON_EQUAL: return eq_f(E, a, b);
    case COMPARISON_GREATER_EQUAL: return le_f(E, b, a);
    case COMPARISON_LESS: return lt_f(E, a, b);
    case COMPARISON_NOT_EQUAL: return ne_f(E, a, b);
    case COMPARISON_LESS_EQUAL: break;
    }
    return le_f(E, a, b);
}

#endif
