/* The tables of def/shader*.def as arrays. */
#include "shader/shader.h"

#define VERTEX      STAGE_VERTEX
#define PIXEL       STAGE_PIXEL
#define SOFTWARE    CAN_SOFTWARE
#define SWIZZLE     CAN_SWIZZLE
#define DIFFERENCE  CAN_DIFFERENCE
#define PREDICATION CAN_PREDICATION
#define DEPENDENT   CAN_DEPENDENT

const struct shader_model shader_models[MODEL_COUNT] = {
#define MODEL(id, name, stage, version, column, slots, arithmetic, texture, temporaries, flow, branches,     \
              dynamic, loops, calls, capabilities)                                                           \
    {name,        stage, COLUMN_##column, capabilities, version, slots, arithmetic, texture,                 \
     temporaries, flow,  branches,        dynamic,      loops,   calls},
#include "def/shader_model.def"
#undef MODEL
};

#undef DIFFERENCE
#define SETUP       IS_SETUP
#define FLOW        IS_FLOW
#define TEXTURE     IS_TEXTURE
#define GRADIENT    IS_GRADIENT
#define DIFFERENCE  IS_DIFFERENCE
#define PREDICATES  IS_PREDICATES
#define STATIC      IS_STATIC
#define DYNAMIC     IS_DYNAMIC
#define UNSATURATED IS_UNSATURATED
#define APART       IS_APART

const struct shader_operation shader_operations[SHADER_COUNT] = {
#define INSTRUCTION(id, name, opcode, control, vs, ps, cube, destination, source0, source1, source2,         \
                    source3, masks, rows, flags, meaning)                                                    \
    {name,                                                                                                   \
     meaning,                                                                                                \
     vs ps,                                                                                                  \
     opcode,                                                                                                 \
     flags,                                                                                                  \
     control,                                                                                                \
     cube,                                                                                                   \
     OPERAND_##destination,                                                                                  \
     {OPERAND_##source0, OPERAND_##source1, OPERAND_##source2, OPERAND_##source3},                           \
     MASKS_##masks,                                                                                          \
     rows},
#include "def/shader.def"
#undef INSTRUCTION
};

#define READ  CAN_READ
#define WRITE CAN_WRITE
#define FLOAT IS_FLOAT

const struct shader_register shader_registers[FILE_COUNT] = {
    {.name = ""},
#define REGISTER(id, name, type, index, v1, v2, vx, v3, p1, p2, p3, p4, p20, p2x, p30, software, ports,      \
                 access, meaning)                                                                            \
    {name, ports, meaning, type, index, access, {v1, v2, vx, v3, p1, p2, p3, p4, p20, p2x, p30}, software},
#include "def/shader_register.def"
#undef REGISTER
};

const struct shader_modifier shader_modifiers[MODIFIER_COUNT] = {
#define MODIFIER(id, number, before, behind, columns, meaning) [number] = {before, behind, columns, meaning},
#include "def/shader_modifier.def"
#undef MODIFIER
};

#define MODIFIER(id, number, ...) _Static_assert(MODIFIER_##id == number, "rows are in the order of numbers");
#include "def/shader_modifier.def"
#undef MODIFIER

#undef COMPARISON
const struct shader_word shader_comparisons[] = {
#define COMPARISON(id, name, number) {name, number},
#include "def/shader_comparison.def"
#undef COMPARISON
    {NULL, 0},
};

const struct shader_word shader_usages[] = {
#define USAGE(id, name, number) {name, number},
#include "def/shader_usage.def"
#undef USAGE
    {NULL, 0},
};

const struct shader_word shader_kinds[] = {
#define KIND(id, name, number) {name, number},
#include "def/shader_usage.def"
#undef KIND
    {NULL, 0},
};

const char *shader_word_name(const struct shader_word *words, unsigned number)
{
    while (words->name && words->number != number)
        words++;
    return words->name;
}

int shader_slots(const struct shader_operation *operation, const struct shader_model *model)
{
    char slots = operation->slots[model->column];
    return slots == '.' ? -1 : slots <= '9' ? slots - '0' : slots - 'a' + 10;
}

unsigned shader_register_count(enum shader_file file, const struct shader_model *model)
{
    const struct shader_register *row = &shader_registers[file];
    unsigned count = row->count[model->column];
    if (file == FILE_TEMPORARY)
        return model->temporaries;
    return count && row->software && model->capabilities & CAN_SOFTWARE ? row->software : count;
}

bool shader_has_usage(enum shader_file file, const struct shader_model *model)
{
    return file == FILE_OUTPUT ||
           (file == FILE_INPUT && (model->stage == STAGE_VERTEX || model->column == COLUMN_PS_3_0));
}
