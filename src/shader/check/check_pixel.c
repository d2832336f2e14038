/* Texture instructions, by pixel model.
 *
 * ps_1_1 to ps_1_3: they precede all arithmetic. Each belongs to one stage, its destination t#, and stages
 * are in order. Products with matrices use consecutive stages: pads, then the final instruction. ps_1_4: two
 * phases of texture instructions followed by arithmetic. The stage is the destination r#, each at most once
 * per phase. Colours v#, texkill, texdepth and r# as coordinates belong to the second phase; a shader without
 * `phase` has only a second phase. The first phase's alpha is lost. ps_2_0, ps_2_b: at most four texture
 * reads in a chain whose coordinates depend on one another. Pixel models 2 and 3: an instruction that needs
 * differences between pixels of computed values must not be in divergent code. */
#include "shader/check/check.h"

#include <string.h>

enum { XYZ = 7, W = 8, DEPENDENT_READS = 3 };

/* --- ps_1_1 to ps_1_3 ---------------------------------------------------------------------------------- */

/* The instructions that may follow a pad: the final one, or another pad of a matrix of three. */
static bool ends_pads(const struct check *check)
{
    switch (check->at->opcode) {
    case SHADER_TEXM3X2TEX:
    case SHADER_TEXM3X2DEPTH: return check->pad_opcode == SHADER_TEXM3X2PAD && check->pads == 1;
    case SHADER_TEXM3X3PAD: return check->pad_opcode == SHADER_TEXM3X3PAD && check->pads == 1;
    case SHADER_TEXM3X3TEX:
    case SHADER_TEXM3X3SPEC:
    case SHADER_TEXM3X3VSPEC:
    case SHADER_TEXM3X3: return check->pad_opcode == SHADER_TEXM3X3PAD && check->pads == 2;
    default: return false;
    }
}

static bool is_matrix(unsigned opcode)
{
    switch (opcode) {
    case SHADER_TEXM3X2PAD:
    case SHADER_TEXM3X2TEX:
    case SHADER_TEXM3X2DEPTH:
    case SHADER_TEXM3X3PAD:
    case SHADER_TEXM3X3TEX:
    case SHADER_TEXM3X3SPEC:
    case SHADER_TEXM3X3VSPEC:
    case SHADER_TEXM3X3: return true;
    default: return false;
    }
}

static int check_matrix(struct check *check)
{
    unsigned opcode = check->at->opcode, stage = check->at->destination.index;
    bool begins = opcode == SHADER_TEXM3X2PAD || opcode == SHADER_TEXM3X3PAD;
    if (check->pads ? !ends_pads(check) : is_matrix(opcode) && !begins)
        return check->pads ? REFUSE(check, NULL, "found %s after %s, expected the matrix's next row",
                                    check->row->name, shader_operations[check->pad_opcode].name)
                           : REFUSE(check, NULL, "found %s, expected the matrix's first rows before it",
                                    check->row->name);
    if (check->pads && stage != check->pad_stage + 1)
        return REFUSE(check, &check->at->destination, "found t%u, expected t%u: rows take consecutive stages",
                      stage, check->pad_stage + 1);
    check->pads = begins ? check->pads + 1 : 0;
    check->pad_opcode = opcode;
    check->pad_stage = stage;
    return 0;
}

static int check_stage(struct check *check)
{
    const struct shader_operand *stage = &check->at->destination, *source = &check->at->source[0];
    if (check->arithmetic_begun)
        return REFUSE(check, NULL, "found %s after arithmetic, expected texture instructions first",
                      check->row->name);
    if (check_matrix(check))
        return -1;
    if (check->at->opcode == SHADER_TEXKILL)
        return 0;
    if (stage->index < check->stages_done)
        return REFUSE(check, stage, "found t%u, expected the stages in order, each once", stage->index);
    check->stages_done = stage->index + 1u;
    if (source->file == FILE_TEXTURE && source->index >= stage->index)
        return REFUSE(check, source, "found t%u, expected an earlier stage than t%u", source->index,
                      stage->index);
    return 0;
}

/* --- ps_1_4 -------------------------------------------------------------------------------------------- */

static bool has_phases(const struct check *check)
{
    for (uint32_t i = 0; i < check->shader->count; i++)
        if (check->shader->instructions[i].opcode == SHADER_PHASE)
            return true;
    return false;
}

static int begin_second_phase(struct check *check)
{
    if (check->phase != 1)
        return REFUSE(check, NULL, "found another phase, expected at most one");
    check->phase = 2;
    check->arithmetic_begun = false;
    check->stage_used = 0;
    check->texture = check->arithmetic = 0;
    for (unsigned i = 0; i < CHECK_TEMPORARIES; i++)
        check->written.temporary[i] &= XYZ;
    return 0;
}

/* Checks the way in which texld and texcrd read their source. */
static int check_set(struct check *check, const struct shader_operand *source)
{
    enum { XYWW = 0xf4 };
    bool temporary = source->file == FILE_TEMPORARY;
    unsigned third = source->swizzle == XYWW ? 4 : 3;
    if (temporary && (check->phase < 2 || check->at->opcode == SHADER_TEXCRD))
        return REFUSE(check, source, "found r%u, expected t%s", source->index,
                      check->at->opcode == SHADER_TEXCRD ? "" : ": r can be sampled at in the second phase");
    if (temporary && check->stage_used >> source->index & 1)
        return REFUSE(check, source,
                      "found r%u, which this phase has sampled to, expected a value of the first phase",
                      source->index);
    if (source->modifier == MODIFIER_DIVIDE_Z && !temporary)
        return REFUSE(check, source, "found the modifier '_dz' of t%u, expected it of r", source->index);
    if (source->modifier == MODIFIER_DIVIDE_W && (temporary || third != 4))
        return REFUSE(check, source, "found the modifier '_dw', expected it of t with .xyw");
    if (source->modifier == MODIFIER_DIVIDE_Z && ++check->divides > 2)
        return REFUSE(check, source, "found the modifier '_dz' a third time, expected at most two");
    if (temporary)
        return third == 3 ? 0 : REFUSE(check, source, "found .xyw of r%u, expected .xyz", source->index);
    if (check->selected[source->index] && check->selected[source->index] != third)
        return REFUSE(check, source, "found .xyz and .xyw of t%u, expected the same every time",
                      source->index);
    check->selected[source->index] = (uint8_t)third;
    return 0;
}

static int check_phased(struct check *check)
{
    const struct shader_operand *result = &check->at->destination;
    unsigned opcode = check->at->opcode;
    if (check->arithmetic_begun)
        return REFUSE(check, NULL, "found %s after arithmetic, expected a phase's texture instructions first",
                      check->row->name);
    if ((opcode == SHADER_TEXKILL || opcode == SHADER_TEXDEPTH) && check->phase < 2)
        return REFUSE(check, NULL, "found %s in the first phase, expected it in the second",
                      check->row->name);
    if (opcode == SHADER_TEXKILL)
        return 0;
    if (opcode == SHADER_TEXDEPTH) {
        if (result->index != 5)
            return REFUSE(check, result, "found r%u, expected r5 of texdepth", result->index);
        return check->written.temporary[5] & 3
                   ? 0
                   : REFUSE(check, result, "found r5.x, expected something to write it before it is read");
    }
    if (check->stage_used >> result->index & 1)
        return REFUSE(check, result, "found r%u again, expected each once a phase", result->index);
    bool divided = check->at->source[0].modifier == MODIFIER_DIVIDE_W;
    if (opcode == SHADER_TEXCRD && (result->swizzle == XYZ) == divided)
        return REFUSE(check, result, "found another mask, expected %s", divided ? ".xy with _dw" : ".xyz");
    if (check_set(check, &check->at->source[0]))
        return -1;
    check->stage_used |= (uint8_t)(1 << result->index);
    return 0;
}

static int check_phase_arithmetic(struct check *check)
{
    if (check->at->opcode == SHADER_BEM) {
        if (check->phase != 1 || check->bumped)
            return REFUSE(check, NULL, "found bem %s, expected it once, in the first of two phases",
                          check->phase == 1 ? "again" : "in the second phase");
        check->bumped = true;
    }
    for (unsigned i = 0; i < SHADER_SOURCES && check->row->source[i]; i++)
        if (check->at->source[i].file == FILE_INPUT && check->phase < 2)
            return REFUSE(check, &check->at->source[i],
                          "found v%u in the first phase, expected it in the second",
                          check->at->source[i].index);
    return 0;
}

/* --- Pairs --------------------------------------------------------------------------------------------- */

static bool can_pair(const struct shader_instruction *instruction)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    return row->destination == OPERAND_RESULT && !(row->flags & (IS_TEXTURE | IS_SETUP)) &&
           instruction->opcode != SHADER_DP4;
}

int check_pairing(struct check *check)
{
    const struct shader_instruction *at = check->at, *before = at - 1;
    if (!at->coissue)
        return 0;
    if (at == check->shader->instructions || !can_pair(before) || before->coissue)
        return REFUSE(check, NULL,
                      "found + without an instruction to pair with, expected arithmetic before it");
    if (!can_pair(at))
        return REFUSE(check, NULL, "found + before %s, expected arithmetic that pairs", check->row->name);
    unsigned first = before->destination.swizzle, second = at->destination.swizzle;
    if ((first != W && second != W) || first & second)
        return REFUSE(check, &at->destination,
                      "found a pair that writes the same pipe, expected .w of one and none "
                      "of it of the other");
    return 0;
}

/* --- Models 2 and 3 ------------------------------------------------------------------------------------ */

static int check_gradient(struct check *check)
{
    const struct shader_operand *source = &check->at->source[0];
    bool computed = source->file == FILE_TEMPORARY;
    if (check->row->flags & IS_GRADIENT && computed && !shader_is_opengl(check->model) &&
        (check_is_divergent(check) || check->at->predicate.file))
        return REFUSE(check, source,
                      "found %s of r%u where neighbouring pixels may not be, expected it "
                      "unconditional, or texldl or texldd",
                      check->row->name, source->index);
    return 0;
}

/* Finds the longest chain of texture reads that a result depends on. */
static int check_dependence(struct check *check)
{
    const struct shader_operand *result = &check->at->destination;
    unsigned order = 0;
    for (unsigned i = 0; i < SHADER_SOURCES && check->row->source[i]; i++) {
        const struct shader_operand *source = &check->at->source[i];
        if (source->file == FILE_TEMPORARY && check->order[source->index] > order)
            order = check->order[source->index];
    }
    if (check->row->flags & IS_TEXTURE && check->row->destination == OPERAND_RESULT &&
        check->at->source[0].file == FILE_TEMPORARY && ++order > DEPENDENT_READS &&
        !(check->model->capabilities & CAN_DEPENDENT))
        return REFUSE(check, &check->at->source[0],
                      "found a texture read that depends on others %u deep, expected "
                      "at most %d in %s",
                      order, DEPENDENT_READS, check->model->name);
    if (check->row->destination != OPERAND_RESULT || result->file != FILE_TEMPORARY)
        return 0;
    bool whole = result->swizzle == MASK_FULL;
    order = order > 255 ? 255 : order;
    if (whole || order > check->order[result->index])
        check->order[result->index] = (uint8_t)order;
    return 0;
}

/* --- All ----------------------------------------------------------------------------------------------- */

static int check_old(struct check *check)
{
    bool texture = check->row->flags & IS_TEXTURE;
    if (check->at->opcode == SHADER_PHASE)
        return begin_second_phase(check);
    if (check->row->flags & IS_SETUP || check->at->opcode == SHADER_NOP)
        return 0;
    if (check->model->column == COLUMN_PS_1_4) {
        if (!check->phase)
            check->phase = has_phases(check) ? 1 : 2;
        if (texture)
            return check_phased(check);
    } else if (texture) {
        return check_stage(check);
    } else if (check->pads) {
        return check_matrix(check);
    }
    check->arithmetic_begun = true;
    return check->model->column == COLUMN_PS_1_4 ? check_phase_arithmetic(check) : 0;
}

int check_pixel(struct check *check)
{
    if (check->model->stage != STAGE_PIXEL)
        return 0;
    if (shader_major(check->model) == 1)
        return check_old(check);
    if (check->row->flags & IS_DIFFERENCE && !(check->model->capabilities & CAN_DIFFERENCE))
        return REFUSE(check, NULL, "found %s, which %s does not have", check->row->name, check->model->name);
    return check_gradient(check) || check_dependence(check) ? -1 : 0;
}
