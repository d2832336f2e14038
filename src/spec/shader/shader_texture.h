/* The texture instructions of shaders, and those that use neighbouring pixels: a function for each row of
 * def/shader/shader.def. docs/shader-semantics.md ("Textures") has the definitions.
 *
 * A sampler samples the texture that is bound to it, whatever kind the shader declared, by the rules of
 * sample.h. Without a texture the result is (0, 0, 0, 1). Texels of depth are compared with the third
 * coordinate; on cubes this is z.
 *
 *   divisions    texldp, _dz and _dw, and the projected coordinates of ps_1_1 to ps_1_3 multiply by the
 *                reciprocal, which is FLT_MAX of zeros
 *   neighbours   right minus left in each row of the quad of 2x2 pixels, lower minus upper in each column
 *   depth        quotients are 1 where the divisor is a zero; the reader of the depth clamps it
 *
 * In ps_1_1 to ps_1_3 the register that an instruction writes names a stage. The instruction uses the stage's
 * coordinates (a matrix row, here M), sampler and bump matrix; a source is the result of an earlier stage.
 * The machine keeps the rows of a matrix product, by stage. */
#ifndef SPEC_SHADER_SHADER_TEXTURE_H
#define SPEC_SHADER_SHADER_TEXTURE_H

#include "contract/language.h"
#include "spec/math/float_color.h"
#include "spec/math/vector.h"
#include "spec/shader/shader.h"
#include "spec/shader/shader_arithmetic.h"
#include "spec/shader/shader_function.h"
#include "spec/texture/bump.h"
#include "spec/texture/detail.h"
#include "spec/texture/sample_float.h"

/* --- Lookups ------------------------------------------------------------------------------------------- */

static inline struct vector4 vector_of(flt x, flt y, flt z, flt w)
{
    return (struct vector4){{x, y, z, w}};
}

/* The register that ps_1_x's texture instructions write is their stage. */
static inline int step_stage(const struct step *s)
{
    return s->instruction->destination.index;
}

static inline const flt *stage_coordinate(const struct step *s, int behind)
{
    return s->machine->coordinate[step_stage(s) - behind];
}

static inline struct vector4 sample_number(struct env *e, const struct step *s, int number,
                                           const struct vector4 *at, const struct lookup *how)
{
    const struct machine *m = s->machine;
    struct sampler_key k = m->vertex ? vertex_sampler(m->vertex, number) : pixel_sampler(m->pixel, number);
    if (k.kind == TEXTURE_NONE)
        return vector_of(lit_f(E, 0.0f), lit_f(E, 0.0f), lit_f(E, 0.0f), lit_f(E, 1.0f));
    struct float_color r = sample_as_float(E, &k, at->v, how);
    return vector_of(r.channel[0], r.channel[1], r.channel[2], r.channel[3]);
}

/* Samples by the sampler that is the second source; its swizzle applies to the texel. */
static inline struct vector4 sample_source(struct env *e, const struct step *s, const struct vector4 *at,
                                           const struct lookup *how)
{
    const struct shader_operand *sampler = &s->instruction->source[1];
    struct vector4 texel = sample_number(E, s, sampler->index, at, how), r;
    for (unsigned c = 0; c < 4; c++)
        r.v[c] = texel.v[swizzle_component(sampler->swizzle, c)];
    return r;
}

static inline struct vector4 sample_stage(struct env *e, const struct step *s, const struct vector4 *at)
{
    struct lookup how = {.from = DETAIL_QUAD};
    return sample_number(E, s, step_stage(s), at, &how);
}

/* Divides the first `count` components. */
static inline void divide_coordinates(struct env *e, const struct step *s, struct vector4 *at, int count,
                                      flt divisor)
{
    flt factor = reciprocal(E, s, divisor);
    for (int c = 0; c < count; c++)
        at->v[c] = multiply(E, s, at->v[c], factor);
}

static inline flt limit(struct env *e, flt value, float low, float high)
{
    flt below = min_f(E, value, lit_f(E, high)); /* NaN too */
    return max_f(E, below, lit_f(E, low));
}

/* --- Models 2 and 3, and vertices ---------------------------------------------------------------------- */

static inline struct vector4 execute_texld(struct env *e, const struct step *s)
{
    struct lookup how = {.from = DETAIL_QUAD};
    return sample_source(E, s, &s->source[0], &how);
}

static inline struct vector4 execute_texldp(struct env *e, const struct step *s)
{
    struct lookup how = {.from = DETAIL_QUAD};
    struct vector4 at = s->source[0];
    divide_coordinates(E, s, &at, 3, at.v[3]);
    return sample_source(E, s, &at, &how);
}

static inline struct vector4 execute_texldb(struct env *e, const struct step *s)
{
    struct lookup how = {.from = DETAIL_BIASED};
    bool third = shader_major(s->machine->program->model) == 3;
    how.amount = limit(E, s->source[0].v[3], third ? -16.0f : -3.0f, third ? 15.0f : 3.0f);
    return sample_source(E, s, &s->source[0], &how);
}

static inline struct vector4 execute_texldl(struct env *e, const struct step *s)
{
    struct lookup how = {.from = DETAIL_GIVEN, .amount = s->source[0].v[3]};
    return sample_source(E, s, &s->source[0], &how);
}

static inline struct vector4 execute_texldd(struct env *e, const struct step *s)
{
    struct lookup how = {.from = DETAIL_CHANGES};
    for (int c = 0; c < 3; c++) {
        how.changes.across[c] = s->source[2].v[c];
        how.changes.down[c] = s->source[3].v[c];
    }
    return sample_source(E, s, &s->source[0], &how);
}

static inline struct vector4 neighbours(struct env *e, const struct step *s, int after, int before)
{
    struct vector4 r = s->source[0];
    for (int c = 0; c < 4; c++) {
        if (!wants(s, c))
            continue;
        flt high = permute_f(E, s->source[0].v[c], after);
        flt low = permute_f(E, s->source[0].v[c], before);
        r.v[c] = sub_f(E, high, low);
    }
    return r;
}

static inline struct vector4 execute_dsx(struct env *e, const struct step *s)
{
    return neighbours(E, s, QUAD_RIGHT, QUAD_LEFT);
}

static inline struct vector4 execute_dsy(struct env *e, const struct step *s)
{
    return neighbours(E, s, QUAD_LOWER, QUAD_UPPER);
}

/* texkill reads three components in models 1, four in others. NaN is not negative. In ps_1_1 to ps_1_3 they
 * are the stage's coordinates, not the texel sampled there. */
static inline void execute_texkill(struct env *e, const struct step *s)
{
    const struct shader_operand *of = &s->instruction->destination, *rule = &s->instruction->predicate;
    const struct shader_model *model = s->machine->program->model;
    msk negative = lit_m(E, 0);
    for (unsigned c = 0; c < (shader_major(model) == 1 ? 3 : 4); c++) {
        bool coordinate = of->file == FILE_TEXTURE;
        flt value =
            coordinate ? s->machine->coordinate[of->index][c] : read_component(E, s->machine, of, 0, c);
        msk here = lt_f(E, value, lit_f(E, 0.0f));
        if (rule->file) {
            msk ruled = predicate_of(E, s->machine, rule, c);
            here = and_m(E, here, ruled);
        }
        negative = or_m(E, negative, here);
    }
    kill(E, s->machine, negative);
}

/* kill, and kill with a comparison. */
static inline void execute_kill(struct env *e, const struct step *s)
{
    const struct shader_instruction *i = s->instruction;
    msk lanes = lit_m(E, -1);
    if (i->opcode == SHADER_KILL_COMPARE)
        lanes = compare_values(E, i->comparison, s->source[0].v[0], s->source[1].v[0]);
    kill(E, s->machine, lanes);
}

/* --- ps_1_4 -------------------------------------------------------------------------------------------- */

/* A source of texld and texcrd in ps_1_4: _dz and _dw divide x and y. */
static inline struct vector4 divided_source(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    int modifier = s->instruction->source[0].modifier;
    if (modifier == MODIFIER_DIVIDE_Z || modifier == MODIFIER_DIVIDE_W)
        divide_coordinates(E, s, &r, 2, r.v[modifier == MODIFIER_DIVIDE_Z ? 2 : 3]);
    return r;
}

static inline struct vector4 execute_texcrd(struct env *e, const struct step *s)
{
    return divided_source(E, s);
}

static inline struct vector4 execute_texld_1_4(struct env *e, const struct step *s)
{
    struct vector4 at = divided_source(E, s);
    return sample_stage(E, s, &at);
}

/* Displaces two coordinates by the stage's matrix times `by`, as bump.h does. */
static inline struct vector4 displaced(struct env *e, const struct step *s, struct vector4 at,
                                       const struct vector4 *by)
{
    for (size_t axis = 0; axis < 2; axis++) {
        flt by_u = bump_value(E, step_stage(s), offsetof(struct bump_job, matrix[0]) + sizeof(float) * axis);
        flt by_v = bump_value(E, step_stage(s), offsetof(struct bump_job, matrix[1]) + sizeof(float) * axis);
        flt partly = multiply_add(E, s, by->v[0], by_u, at.v[axis]);
        at.v[axis] = multiply_add(E, s, by->v[1], by_v, partly);
    }
    return at;
}

static inline struct vector4 execute_bem(struct env *e, const struct step *s)
{
    return displaced(E, s, s->source[0], &s->source[1]);
}

/* The quotient; 1 where the divisor is a zero. */
static inline flt depth_quotient(struct env *e, flt dividend, flt divisor)
{
    flt quotient = div_f(E, dividend, divisor);
    msk zero = eq_f(E, divisor, lit_f(E, 0.0f));
    return select_f(E, zero, lit_f(E, 1.0f), quotient);
}

static inline void write_depth(struct env *e, const struct step *s, flt depth)
{
    write_cell(E, s->machine, s->instruction, CELL_DEPTH, 0, depth);
}

/* Red / green of r5, which is the instruction's destination. */
static inline void execute_texdepth(struct env *e, const struct step *s)
{
    const struct shader_operand *of = &s->instruction->destination;
    flt red = read_component(E, s->machine, of, 0, 0);
    flt green = read_component(E, s->machine, of, 0, 1);
    flt depth = depth_quotient(E, red, green);
    write_depth(E, s, depth);
}

/* --- ps_1_1 to ps_1_3 ---------------------------------------------------------------------------------- */

/* The stage's coordinates, divided if the transform flags specify it. */
static inline struct vector4 projected_coordinate(struct env *e, const struct step *s)
{
    const flt *t = stage_coordinate(s, 0);
    struct vector4 r = vector_of(t[0], t[1], t[2], t[3]);
    int projected = s->machine->pixel->projected[step_stage(s)];
    if (projected)
        divide_coordinates(E, s, &r, 3, t[projected == PROJECTED_THIRD ? 2 : 3]);
    return r;
}

static inline struct vector4 execute_tex(struct env *e, const struct step *s)
{
    struct vector4 at = projected_coordinate(E, s);
    return sample_stage(E, s, &at);
}

static inline struct vector4 execute_texcoord(struct env *e, const struct step *s)
{
    const flt *t = stage_coordinate(s, 0);
    struct vector4 r;
    for (int c = 0; c < 3; c++)
        r.v[c] = saturate(E, t[c]);
    r.v[3] = lit_f(E, 1.0f);
    return r;
}

static inline struct vector4 execute_texbem(struct env *e, const struct step *s)
{
    struct vector4 at = projected_coordinate(E, s);
    at = displaced(E, s, at, &s->source[0]);
    return sample_stage(E, s, &at);
}

static inline struct vector4 execute_texbeml(struct env *e, const struct step *s)
{
    struct vector4 r = execute_texbem(E, s);
    flt scale = bump_value(E, step_stage(s), offsetof(struct bump_job, luminance_scale));
    flt offset = bump_value(E, step_stage(s), offsetof(struct bump_job, luminance_offset));
    flt sum = multiply_add(E, s, s->source[0].v[2], scale, offset);
    flt luminance = saturate(E, sum);
    for (int c = 0; c < 4; c++)
        r.v[c] = multiply(E, s, r.v[c], luminance);
    return r;
}

static inline struct vector4 execute_texreg2ar(struct env *e, const struct step *s)
{
    const flt *v = s->source[0].v;
    struct vector4 at = vector_of(v[3], v[0], v[0], v[0]);
    return sample_stage(E, s, &at);
}

static inline struct vector4 execute_texreg2gb(struct env *e, const struct step *s)
{
    const flt *v = s->source[0].v;
    struct vector4 at = vector_of(v[1], v[2], v[2], v[2]);
    return sample_stage(E, s, &at);
}

static inline struct vector4 execute_texreg2rgb(struct env *e, const struct step *s)
{
    return sample_stage(E, s, &s->source[0]);
}

/* The stage's coordinates, a row of a matrix, times the source. */
static inline flt stage_row(struct env *e, const struct step *s)
{
    const flt *t = stage_coordinate(s, 0);
    struct vector4 row = vector_of(t[0], t[1], t[2], t[3]);
    return dot(E, s, 3, &row, &s->source[0]);
}

static inline struct vector4 execute_texdp3(struct env *e, const struct step *s)
{
    flt product = stage_row(E, s);
    return vector_replicate(product);
}

static inline struct vector4 execute_texdp3tex(struct env *e, const struct step *s)
{
    flt product = stage_row(E, s);
    flt zero = lit_f(E, 0.0f);
    struct vector4 at = vector_of(product, zero, zero, zero);
    return sample_stage(E, s, &at);
}

/* texm3x2pad and texm3x3pad keep one row for the stage that has the last row. */
static inline void execute_texm3x2pad(struct env *e, const struct step *s)
{
    s->machine->product[step_stage(s)] = stage_row(E, s);
}

static inline void execute_texm3x3pad(struct env *e, const struct step *s)
{
    execute_texm3x2pad(E, s);
}

static inline struct vector4 execute_texm3x2tex(struct env *e, const struct step *s)
{
    flt last = stage_row(E, s);
    struct vector4 at = vector_of(s->machine->product[step_stage(s) - 1], last, last, last);
    return sample_stage(E, s, &at);
}

static inline void execute_texm3x2depth(struct env *e, const struct step *s)
{
    flt last = stage_row(E, s);
    flt depth = depth_quotient(E, s->machine->product[step_stage(s) - 1], last);
    write_depth(E, s, depth);
}

static inline struct vector4 execute_texm3x3(struct env *e, const struct step *s)
{
    const flt *product = &s->machine->product[step_stage(s)];
    flt last = stage_row(E, s);
    return vector_of(product[-2], product[-1], last, lit_f(E, 1.0f));
}

static inline struct vector4 execute_texm3x3tex(struct env *e, const struct step *s)
{
    struct vector4 at = execute_texm3x3(E, s);
    return sample_stage(E, s, &at);
}

/* Samples at the reflection of the eye's vector on the product, a normal of any length: 2 (n eye / n n) n -
 * eye. */
static inline struct vector4 sample_reflected(struct env *e, const struct step *s, const struct vector4 *eye)
{
    struct vector4 normal = execute_texm3x3(E, s), at = normal;
    flt along = dot(E, s, 3, &normal, eye);
    flt square = dot(E, s, 3, &normal, &normal);
    flt inverse = reciprocal(E, s, square);
    flt share = multiply(E, s, along, inverse);
    flt twice = add_f(E, share, share);
    for (int c = 0; c < 3; c++) {
        flt opposite = neg_f(E, eye->v[c]);
        at.v[c] = multiply_add(E, s, twice, normal.v[c], opposite);
    }
    return sample_stage(E, s, &at);
}

static inline struct vector4 execute_texm3x3spec(struct env *e, const struct step *s)
{
    return sample_reflected(E, s, &s->source[1]);
}

static inline struct vector4 execute_texm3x3vspec(struct env *e, const struct step *s)
{
    flt z = stage_coordinate(s, 0)[3];
    struct vector4 eye = vector_of(stage_coordinate(s, 2)[3], stage_coordinate(s, 1)[3], z, z);
    return sample_reflected(E, s, &eye);
}

#endif
