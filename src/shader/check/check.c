/* The validator: one pass over the instructions, in which every part checks each instruction; then the rules
 * for the end of the shader. */
#include "shader/check/check.h"

#include <stdlib.h>
#include <string.h>

/* --- Declarations and definitions ---------------------------------------------------------------------- */

static int refuse_declared(struct check *check, const char *expected)
{
    const struct shader_operand *declared = &check->at->destination;
    const char *name = shader_registers[declared->file].name;
    if (shader_registers[declared->file].index == NUMBERED)
        return REFUSE(check, declared, "found %s%u, expected %s", name, declared->index, expected);
    return REFUSE(check, declared, "found %s, expected %s", name, expected);
}

/* No two elements, and no two outputs, have the same usage. */
static int check_usage(struct check *check)
{
    const struct shader_instruction *at = check->at;
    for (const struct shader_instruction *i = check->shader->instructions; i < at; i++)
        if (i->opcode == SHADER_DCL && i->destination.file == at->destination.file && i->usage == at->usage &&
            i->usage_index == at->usage_index)
            return refuse_declared(check, "another usage than one that is declared already");
    return 0;
}

static int declare_components(struct check *check, uint8_t *declared)
{
    unsigned mask = check->at->destination.swizzle;
    if (*declared & mask)
        return refuse_declared(check, "a register that is not declared already");
    *declared |= (uint8_t)mask;
    return 0;
}

static int declare_sampler(struct check *check, const struct shader_operand *declared)
{
    if (check->declared_kind[declared->index])
        return refuse_declared(check, "a sampler that is not declared already");
    if (declared->swizzle != MASK_FULL)
        return REFUSE(check, declared, "found a mask of a sampler, expected none");
    check->declared_kind[declared->index] = check->at->kind;
    return 0;
}

static int declare_output(struct check *check, const struct shader_operand *declared)
{
    if (check->at->usage == 0 && check->at->usage_index == 0) {
        if (declared->swizzle != MASK_FULL)
            return REFUSE(check, declared, "found a mask of the position, expected none");
        check->position_output = declared->index;
    }
    if (check_usage(check))
        return -1;
    return declare_components(check, &check->declared_output[declared->index]);
}

/* In model 3, a pixel shader reads its place as vPos. The position that the vertex shader writes is not
 * an input. */
static int declare_input(struct check *check, const struct shader_operand *declared)
{
    bool vertex = check->model->stage == STAGE_VERTEX;
    if (vertex && check_usage(check))
        return -1;
    if (!vertex && shader_major(check->model) == 3 && check->at->usage == 0 && check->at->usage_index == 0)
        return refuse_declared(check, "another usage than the position, or vPos");
    return declare_components(check, &check->declared_input[declared->index]);
}

static int declare_flag(struct check *check, bool *declared)
{
    if (*declared)
        return refuse_declared(check, "a register that is not declared already");
    *declared = true;
    return 0;
}

static int check_declaration(struct check *check)
{
    const struct shader_operand *declared = &check->at->destination;
    if (declared->relative)
        return REFUSE(check, declared, "found a relative index, expected none of dcl");
    if (shader_registers[declared->file].index == NUMBERED &&
        declared->index >= shader_register_count(declared->file, check->model))
        return refuse_declared(check, "a register that the model has");
    switch (declared->file) {
    case FILE_INPUT: return declare_input(check, declared);
    case FILE_TEXTURE: return declare_components(check, &check->declared_texture[declared->index]);
    case FILE_SAMPLER: return declare_sampler(check, declared);
    case FILE_OUTPUT: return declare_output(check, declared);
    case FILE_PLACE: return declare_flag(check, &check->declared_place);
    case FILE_FACE: return declare_flag(check, &check->declared_face);
    case FILE_SPRITE: return declare_flag(check, &check->declared_sprite);
    default: return refuse_declared(check, "an input, an output or a sampler");
    }
}

static int check_definition(struct check *check)
{
    const struct shader_operand *defined = &check->at->destination;
    if (defined->relative || defined->swizzle != MASK_FULL)
        return REFUSE(check, defined, "found a mask or a relative index, expected only the constant");
    for (const struct shader_instruction *i = check->shader->instructions; i < check->at; i++)
        if (i->opcode == check->at->opcode && i->destination.index == defined->index)
            return REFUSE(check, defined, "found %s%u defined again, expected it once",
                          shader_registers[defined->file].name, defined->index);
    return 0;
}

/* Two arrays have no register in common. */
static int check_array(struct check *check)
{
    const struct shader_operand *first = &check->at->destination, *last = &check->at->source[0];
    if (first->file != FILE_TEMPORARY || first->relative || last->relative || last->index < first->index)
        return REFUSE(check, last, "found an array without a register, expected the first r# and the last");
    for (const struct shader_instruction *i = check->shader->instructions; i < check->at; i++)
        if (i->opcode == SHADER_ARRAY && i->destination.index <= last->index &&
            i->source[0].index >= first->index)
            return REFUSE(check, first, "found registers of another array, expected others");
    return 0;
}

static int check_setup(struct check *check)
{
    if (!(check->row->flags & IS_SETUP) || check->at->opcode == SHADER_PHASE) {
        check->begun = true;
        return 0;
    }
    if (check->begun)
        return REFUSE(check, NULL, "found %s after instructions that execute, expected it before them",
                      check->row->name);
    return check->at->opcode == SHADER_DCL     ? check_declaration(check)
           : check->at->opcode == SHADER_ARRAY ? check_array(check)
                                               : check_definition(check);
}

/* --- Slots --------------------------------------------------------------------------------------------- */

static int refuse_slots(struct check *check, const char *sort, unsigned found, unsigned limit)
{
    return REFUSE(check, NULL, "found %u %sinstruction slots%s, expected at most %u in %s", found, sort,
                  check->phase ? " in one phase" : "", limit, check->model->name);
}

/* The second instruction of a pair takes no slot. */
static int check_slots(struct check *check)
{
    const struct shader_model *model = check->model;
    unsigned slots = (unsigned)shader_slots(check->row, model);
    unsigned sampler = check->at->source[1].index;
    if (check->at->coissue)
        slots = 0;
    if (shader_major(model) == 3 && check->row->cube && sampler < CHECK_SAMPLERS &&
        check->declared_kind[sampler] == 3)
        slots += check->row->cube;
    if (check->at->predicate.file)
        slots++;
    check->slots += slots;
    if (check->row->flags & IS_TEXTURE)
        check->texture += slots;
    else
        check->arithmetic += slots;
    if (model->slots && check->slots > model->slots)
        return refuse_slots(check, "", check->slots, model->slots);
    if (model->texture && check->texture > model->texture)
        return refuse_slots(check, "texture ", check->texture, model->texture);
    if (model->arithmetic && check->arithmetic > model->arithmetic)
        return refuse_slots(check, "arithmetic ", check->arithmetic, model->arithmetic);
    return 0;
}

/* --- The end ------------------------------------------------------------------------------------------- */

static int refuse_end(struct check *check, const char *name, const char *expected)
{
    static const struct shader_instruction first = {.place = 1, .column = 1};
    uint32_t count = check->shader->count;
    check->at = count ? &check->shader->instructions[count - 1] : &first;
    return REFUSE(check, NULL, "found the end of the shader and %s, expected it %s", name, expected);
}

static int check_vertex_end(struct check *check)
{
    if (shader_major(check->model) < 3)
        return check->position == MASK_FULL
                   ? 0
                   : refuse_end(check, check->position ? "oPos partly written" : "oPos never written",
                                "written in all components");
    if (check->position_output < 0)
        return refuse_end(check, "no output declared as the position", "declared: dcl_position o0");
    return check->output[check->position_output] == MASK_FULL
               ? 0
               : refuse_end(check, "the position not written", "written in all components");
}

static int check_pixel_end(struct check *check)
{
    if (check->pads)
        return refuse_end(check, "a matrix without its last row", "with it");
    if (shader_major(check->model) == 1)
        return check->written.temporary[0] == MASK_FULL
                   ? 0
                   : refuse_end(check, check->written.temporary[0] ? "r0 partly written" : "r0 never written",
                                "written in all components");
    if (shader_major(check->model) > 2)
        return 0;
    for (unsigned i = CHECK_TARGETS; i-- > 1;)
        if (check->target[i] && !check->target[i - 1])
            return refuse_end(check, "a target written but not the ones before it", "with all of them");
    return check->target[0] ? 0 : refuse_end(check, "oC0 never written", "written");
}

/* --- The pass ------------------------------------------------------------------------------------------ */

int check_instruction(struct check *check, uint32_t number)
{
    check->at = &check->shader->instructions[number];
    check->row = &shader_operations[check->at->opcode];
    if (check->row->flags & IS_PREDICATES && !(check->model->capabilities & CAN_PREDICATION))
        return REFUSE(check, NULL, "found %s, which %s does not have", check->row->name, check->model->name);
    if (check_setup(check) || check_pairing(check) || check_predicate(check) || check_sources(check) ||
        check_flow(check) || check_destination(check) || check_pixel(check) || check_slots(check))
        return -1;
    check_note_written(&check->written, check->at);
    return 0;
}

static int check_all(struct check *check)
{
    const struct shader *shader = check->shader;
    if (check_flow_begin(check))
        return -1;
    for (uint32_t i = 0; i < shader->count; i++)
        if (check_instruction(check, i))
            return -1;
    if (check_flow_end(check))
        return -1;
    return check->model->stage == STAGE_VERTEX ? check_vertex_end(check) : check_pixel_end(check);
}

struct check check_of(const struct shader *shader, struct error *error)
{
    return (struct check){.shader = shader, .model = shader->model, .error = error, .position_output = -1};
}

void check_free(struct check *check)
{
    free(check->subroutines);
}

int shader_validate(const struct shader *shader, struct shader_counts *counts, struct error *error)
{
    struct check check = check_of(shader, error);
    int bad = check_all(&check);
    check_free(&check);
    if (!bad && counts)
        *counts = (struct shader_counts){.slots = check.slots, .flow = check.flow};
    return bad;
}
