/* Destinations: registers that can be written, masks, and the modifiers of results. */
#include "shader/check/check.h"

enum { X = 1, Y = 2, XY = 3, XYZ = 7, W = 8 };

static const char *file_name(const struct shader_operand *operand)
{
    return shader_registers[operand->file].name;
}

static bool is_old_pixel(const struct check *check)
{
    return check->model->column >= COLUMN_PS_1_1 && check->model->column <= COLUMN_PS_1_4;
}

/* --- Which register ------------------------------------------------------------------------------------ */

static int refuse_file(struct check *check, const struct shader_operand *result, const char *expected)
{
    return REFUSE(check, result, "found %s as the destination of %s, expected %s", file_name(result),
                  check->row->name, expected);
}

static int check_result_file(struct check *check, const struct shader_operand *result)
{
    unsigned file = result->file, column = check->model->column;
    if (file == FILE_ADDRESS && column == COLUMN_VS_1_1 && check->at->opcode == SHADER_MOV)
        return result->swizzle == X ? 0
                                    : REFUSE(check, result, "found another component of a0, expected a0.x");
    if (file == FILE_TEXTURE && column <= COLUMN_PS_1_3)
        return 0;
    if ((shader_registers[file].access & (CAN_WRITE | IS_FLOAT)) != (CAN_WRITE | IS_FLOAT))
        return refuse_file(check, result, "a register that can be written");
    if (file == FILE_OUTPUT && !result->relative && result->index < CHECK_INPUTS &&
        result->swizzle & ~check->declared_output[result->index])
        return REFUSE(check, result, "found o%u with components that no dcl declares, expected a dcl of them",
                      result->index);
    return 0;
}

static int check_kill_file(struct check *check, const struct shader_operand *result)
{
    unsigned file = result->file, column = check->model->column;
    if (column <= COLUMN_PS_1_3)
        return file == FILE_TEXTURE ? 0 : refuse_file(check, result, "t");
    if (column >= COLUMN_PS_3_0)
        return file == FILE_TEMPORARY || file == FILE_INPUT ? 0 : refuse_file(check, result, "r or v");
    return file == FILE_TEMPORARY || file == FILE_TEXTURE ? 0 : refuse_file(check, result, "r or t");
}

static int check_relative(struct check *check, const struct shader_operand *result)
{
    bool opengl = shader_is_opengl(check->model), loop = result->relative == FILE_LOOP;
    bool array = opengl && result->file == FILE_TEMPORARY && check_is_in_array(check, result->index);
    if (!array && (result->file != FILE_OUTPUT || !(loop || opengl)))
        return REFUSE(check, result, "found %s with a relative index, expected none or %s", file_name(result),
                      opengl ? "a register of an array, or o" : "o by aL");
    if (loop && !check->loops && !check->inside)
        return REFUSE(check, result, "found aL outside a loop, expected it between loop and endloop");
    return 0;
}

static int check_file(struct check *check, const struct shader_operand *result)
{
    static const struct {
        uint8_t kind, file;
    } rows[] = {
        {OPERAND_ADDRESS, FILE_ADDRESS},
        {OPERAND_FLAGS, FILE_PREDICATE},
        {OPERAND_STAGE, FILE_TEXTURE},
        {OPERAND_TEMPORARY, FILE_TEMPORARY},
        {OPERAND_CONSTANT, FILE_CONSTANT},
        {OPERAND_CONSTANT_INTEGER, FILE_INTEGER},
        {OPERAND_CONSTANT_BOOLEAN, FILE_BOOLEAN},
    };
    unsigned kind = check->row->destination, count = shader_register_count(result->file, check->model);
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].kind == kind && rows[i].file != result->file)
            return refuse_file(check, result, shader_registers[rows[i].file].name);
    if (shader_registers[result->file].index == NUMBERED && result->index >= count)
        return REFUSE(check, result, "found %s%u, expected %s0 to %s%u", file_name(result), result->index,
                      file_name(result), file_name(result), count - 1);
    if (result->relative && check_relative(check, result))
        return -1;
    return kind == OPERAND_RESULT ? check_result_file(check, result)
           : kind == OPERAND_KILL ? check_kill_file(check, result)
                                  : 0;
}

/* --- Masks --------------------------------------------------------------------------------------------- */

static bool is_good_mask(const struct check *check, unsigned mask)
{
    switch (check->row->masks) {
    case MASKS_FULL: return mask == MASK_FULL;
    case MASKS_FULL_2: return mask == MASK_FULL || shader_major(check->model) == 3;
    case MASKS_XY: return mask == XY;
    case MASKS_XYZ: return mask == XYZ;
    case MASKS_XY_XYZ: return mask == XY || mask == XYZ;
    case MASKS_NORMAL: return mask == XYZ || mask == MASK_FULL;
    case MASKS_WITHIN_XYZ: return !(mask & W);
    case MASKS_WITHIN_XY: return !(mask & ~(unsigned)XY);
    case MASKS_FRACTION: return check->model->column != COLUMN_VS_1_1 || mask == Y || mask == XY;
    default: return true;
    }
}

static const char *const mask_text[] = {
    [MASKS_FULL] = "no mask",
    [MASKS_FULL_2] = "no mask",
    [MASKS_XY] = ".xy",
    [MASKS_XYZ] = ".xyz",
    [MASKS_XY_XYZ] = ".xy or .xyz",
    [MASKS_NORMAL] = ".xyz or no mask",
    [MASKS_WITHIN_XYZ] = "a mask without w",
    [MASKS_WITHIN_XY] = ".x, .y or .xy",
    [MASKS_FRACTION] = ".y or .xy",
};

static int check_mask(struct check *check, const struct shader_operand *result)
{
    unsigned mask = result->swizzle;
    if (!is_good_mask(check, mask))
        return REFUSE(check, result, "found another mask, expected %s of %s", mask_text[check->row->masks],
                      check->row->name);
    if (check->row->destination == OPERAND_RESULT && check->model->column >= COLUMN_PS_1_1 &&
        check->model->column <= COLUMN_PS_1_3 && mask != MASK_FULL && mask != XYZ && mask != W)
        return REFUSE(check, result, "found another mask, expected .xyz, .w or none in %s",
                      check->model->name);
    return 0;
}

/* --- Modifiers ----------------------------------------------------------------------------------------- */

static int check_saturate(struct check *check, const struct shader_operand *result)
{
    bool vertex = check->model->stage == STAGE_VERTEX, texture = check->row->flags & IS_TEXTURE;
    if (!(result->modifier & RESULT_SATURATE))
        return 0;
    if ((vertex && shader_major(check->model) < 3) || check->row->flags & (IS_UNSATURATED | IS_SETUP) ||
        (texture && !(is_old_pixel(check) && check->at->opcode == SHADER_TEXCRD)))
        return REFUSE(check, result, "found _sat, which %s does not have in %s", check->row->name,
                      check->model->name);
    return 0;
}

static int check_shift(struct check *check, const struct shader_operand *result)
{
    bool four = check->model->column == COLUMN_PS_1_4;
    if (!result->shift)
        return 0;
    if (!is_old_pixel(check) || check->row->destination == OPERAND_STAGE ||
        check->row->flags & (IS_TEXTURE | IS_SETUP))
        return REFUSE(check, result, "found a shift, which %s does not have in %s", check->row->name,
                      check->model->name);
    if (!four && (result->shift > 2 || result->shift < -1))
        return REFUSE(check, result, "found another shift, expected _x2, _x4 or _d2 in %s",
                      check->model->name);
    return 0;
}

static int check_modifiers(struct check *check, const struct shader_operand *result)
{
    bool modern = check->model->stage == STAGE_PIXEL && !is_old_pixel(check);
    bool declares = check->row->destination == OPERAND_DECLARED;
    bool defines = check->row->flags & IS_SETUP && !declares;
    if (result->modifier & RESULT_PARTIAL && (!modern || defines || check->row->destination == OPERAND_KILL ||
                                              check->row->destination == OPERAND_FLAGS))
        return REFUSE(check, result, "found _pp, which %s does not have in %s", check->row->name,
                      check->model->name);
    if (result->modifier & RESULT_CENTROID && !(modern && declares))
        return REFUSE(check, result, "found _centroid, expected it after a pixel shader's dcl");
    return check_saturate(check, result) || check_shift(check, result) ? -1 : 0;
}

/* --- A pixel shader's outputs -------------------------------------------------------------------------- */

/* Models 2 write a target once, by a mov of all components, and the depth once, by a mov of one component. */
static int check_depth(struct check *check, const struct shader_operand *result)
{
    const struct shader_operand *source = &check->at->source[0];
    if (check->depth)
        return REFUSE(check, result, "found oDepth written again, expected it once");
    if (result->swizzle != MASK_FULL)
        return REFUSE(check, result, "found a mask of oDepth, expected none");
    if (!swizzle_replicates(source->swizzle))
        return REFUSE(check, source, "found several components for oDepth, expected one, like r0.x");
    return 0;
}

static int check_target(struct check *check, const struct shader_operand *result)
{
    const struct shader_operand *source = &check->at->source[0];
    if (result->swizzle != MASK_FULL || source->swizzle != SWIZZLE_NONE || source->modifier)
        return REFUSE(check, result,
                      "found a mask, a swizzle or a modifier on the way to oC%u, expected none",
                      result->index);
    if (check->target[result->index])
        return REFUSE(check, result, "found oC%u written again, expected it once", result->index);
    return 0;
}

static int check_output(struct check *check, const struct shader_operand *result)
{
    if (result->file != FILE_TARGET && result->file != FILE_DEPTH)
        return 0;
    if (!shader_is_opengl(check->model) && (check_is_divergent(check) || check->at->predicate.file))
        return REFUSE(check, result, "found %s written under a computed condition, expected it unconditional",
                      file_name(result));
    if (shader_major(check->model) != 2)
        return 0;
    if (check->at->opcode != SHADER_MOV || result->modifier & ~RESULT_PARTIAL)
        return refuse_file(check, result, "mov, without _sat");
    return result->file == FILE_DEPTH ? check_depth(check, result) : check_target(check, result);
}

static void note_output(struct check *check, const struct shader_operand *result)
{
    switch (result->file) {
    case FILE_POSITION: check->position |= result->swizzle; break;
    case FILE_DEPTH: check->depth |= result->swizzle; break;
    case FILE_TARGET: check->target[result->index] |= result->swizzle; break;
    case FILE_OUTPUT:
        for (unsigned i = 0; i < CHECK_INPUTS; i++)
            if (i == result->index || result->relative)
                check->output[i] |= result->swizzle;
        break;
    }
}

/* texkill's operand is encoded as a destination, but it is read. */
static int check_killed(struct check *check, const struct shader_operand *result)
{
    unsigned components = shader_major(check->model) == 1 ? XYZ : MASK_FULL;
    unsigned column = check->model->column;
    if (result->file == FILE_TEMPORARY && !shader_is_opengl(check->model) &&
        components & ~check->written.temporary[result->index])
        return REFUSE(check, result, "found r%u.%s, expected something to write it before it is read",
                      result->index, components == XYZ ? "xyz" : "xyzw");
    bool declared = result->file == FILE_INPUT ? check->declared_input[result->index]
                    : result->file == FILE_TEXTURE
                        ? column < COLUMN_PS_2_0 || check->declared_texture[result->index]
                        : true;
    return declared ? 0
                    : REFUSE(check, result, "found %s%u, expected a dcl of it before", file_name(result),
                             result->index);
}

int check_destination(struct check *check)
{
    const struct shader_operand *result = &check->at->destination;
    if (!check->row->destination)
        return 0;
    if (check_modifiers(check, result))
        return -1;
    if (check->row->destination == OPERAND_DECLARED)
        return 0;
    if (check_file(check, result) || check_mask(check, result) || check_output(check, result))
        return -1;
    if (check->row->destination == OPERAND_KILL)
        return check_killed(check, result);
    note_output(check, result);
    return 0;
}
