/* Texture functions (8.7). */
#include "front/glsl/check/builtin.h"
#include "front/glsl/lower/lower.h"

struct sampling {
    enum glsl_op op;
    bool divides; /* the coordinates by the last one, before */
    bool extra;   /* w is the third argument: a bias or a level */
};

static struct sampling sampling_of(const struct glsl_lowering *l, unsigned meaning)
{
    bool vertex = l->code.unit->stage == GLSL_VERTEX;
    switch (meaning) {
    case GLSL_CALL_TEXTURE_BIAS: return (struct sampling){GLSL_OP_TEXLDB, false, true};
    case GLSL_CALL_TEXTURE_PROJ:
        return vertex ? (struct sampling){GLSL_OP_TEXLDL, true, false}
                      : (struct sampling){GLSL_OP_TEXLDP, false, false};
    case GLSL_CALL_TEXTURE_PROJ_BIAS: return (struct sampling){GLSL_OP_TEXLDB, true, true};
    case GLSL_CALL_TEXTURE_LOD: return (struct sampling){GLSL_OP_TEXLDL, false, true};
    case GLSL_CALL_TEXTURE_PROJ_LOD: return (struct sampling){GLSL_OP_TEXLDL, true, true};
    case GLSL_CALL_TEXTURE_GRADIENT: return (struct sampling){GLSL_OP_TEXLDD, false, false};
    case GLSL_CALL_TEXTURE_PROJ_GRADIENT: return (struct sampling){GLSL_OP_TEXLDD, true, false};
    default: return (struct sampling){vertex ? GLSL_OP_TEXLDL : GLSL_OP_TEXLD, false, false};
    }
}

/* The coordinates in the order of the instruction: x, y, z, and w for a divisor, a bias or a level. */
static struct glsl_operand coordinates(struct glsl_lowering *l, const struct sampling *sampling,
                                       struct glsl_operand at, unsigned rows,
                                       const struct glsl_operand *extra)
{
    struct glsl_code *code = &l->code;
    unsigned used = rows;
    if (sampling->op == GLSL_OP_TEXLDP && rows == 3)
        return glsl_operand_swizzled(at, 0xa4); /* xyzz */
    if (sampling->divides) {
        at = glsl_emit_2(code, GLSL_OP_DIV, 2, at, glsl_operand_scalar(at, rows - 1));
        used = 2;
    }
    if (sampling->op != GLSL_OP_TEXLDB && sampling->op != GLSL_OP_TEXLDL)
        return at;
    struct glsl_operand to = glsl_operand_temporary(glsl_code_temporary(code, 1), 4);
    glsl_emit_store(code, to, glsl_mask(used), at);
    glsl_emit_store(code, to, 8,
                    sampling->extra ? glsl_operand_scalar(*extra, 0) : glsl_operand_literal(code, 0));
    return to;
}

static struct glsl_operand sample(struct glsl_lowering *l, enum glsl_op op, const struct glsl_operand *from)
{
    struct glsl_operand to = glsl_operand_temporary(glsl_code_temporary(&l->code, 1), 4);
    glsl_emit(&l->code, op, to, 15, from);
    return to;
}

/* An index of samplers that is not constant: all of them are sampled, so that differences between pixels
 * are defined, and the one whose number is the index is selected. */
static struct glsl_operand sample_any(struct glsl_lowering *l, enum glsl_op op, struct glsl_operand *from)
{
    struct glsl_access access = l->code.access[from[1].access];
    struct glsl_operand index = glsl_operand_temporary(from[1].index, 1), result = {0};
    index.swizzle = glsl_replicate(from[1].index_component);
    uint32_t first = from[1].number, count = 1;
    from[1].access = 0;
    for (unsigned i = 0; i < access.levels; i++)
        count *= access.level[i].count;
    for (uint32_t n = 0; n < count && !l->code.failure; n++) {
        uint32_t offset = 0;
        for (uint32_t i = access.levels, rest = n; i-- > 0; rest /= access.level[i].count)
            offset += rest % access.level[i].count * access.level[i].stride;
        from[1].number = first + offset;
        struct glsl_operand texel = sample(l, op, from);
        if (n) {
            struct glsl_operand is =
                glsl_emit_2(&l->code, GLSL_OP_SEQ, 1, index, glsl_operand_literal(&l->code, (float)offset));
            texel = glsl_emit_3(&l->code, GLSL_OP_SELECT, 4, is, texel, result);
        }
        result = texel;
    }
    return result;
}

struct glsl_value glsl_lower_texture(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct sampling sampling = sampling_of(l, x->index);
    const struct glsl_expression *argument = x->argument->next;
    unsigned rows = argument->type.rows, count = 0;
    struct glsl_operand value[3] = {0}, sampler = glsl_lower_operand(l, x->argument);
    for (; argument && !l->code.failure; argument = argument->next) {
        struct glsl_value part = glsl_lower_argument(l, argument);
        value[count++] = glsl_value_part(l, &part, 0);
    }
    if (l->code.failure)
        return glsl_value_temporary(l, x->type);
    struct glsl_operand from[4] = {coordinates(l, &sampling, value[0], rows, &value[1]), sampler, value[1],
                                   value[2]};
    from[1].swizzle = GLSL_XYZW;
    return glsl_value_of(x->type,
                         from[1].access ? sample_any(l, sampling.op, from) : sample(l, sampling.op, from));
}
