/* The tables of def/shader as arrays. */
#include "shader/shader.h"

#define VERTEX      STAGE_VERTEX
#define PIXEL       STAGE_PIXEL
#define SOFTWARE    CAN_SOFTWARE
#define SWIZZLE     CAN_SWIZZLE
#define DIFFERENCE  CAN_DIFFERENCE
#define PREDICATION CAN_PREDICATION
#define DEPENDENT   CAN_DEPENDENT
#define OPENGL      CAN_OPENGL

const struct shader_model shader_models[MODEL_COUNT] = {
#define MODEL(id, name, stage, version, column, slots, arithmetic, texture, temporaries, flow, branches,     \
              dynamic, loops, calls, capabilities)                                                           \
    {name,        stage, COLUMN_##column, capabilities, version, slots, arithmetic, texture,                 \
     temporaries, flow,  branches,        dynamic,      loops,   calls},
#include "def/shader/shader_model.def"
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
                    source3, masks, reads, rows, flags, meaning)                                             \
    {name,                                                                                                   \
     meaning,                                                                                                \
     vs ps,                                                                                                  \
     opcode,                                                                                                 \
     flags,                                                                                                  \
     READS_##reads,                                                                                          \
     control,                                                                                                \
     cube,                                                                                                   \
     OPERAND_##destination,                                                                                  \
     {OPERAND_##source0, OPERAND_##source1, OPERAND_##source2, OPERAND_##source3},                           \
     MASKS_##masks,                                                                                          \
     rows},
#include "def/shader/shader.def"
#undef INSTRUCTION
};

#define READ  CAN_READ
#define WRITE CAN_WRITE
#define FLOAT IS_FLOAT

const struct shader_register shader_registers[FILE_COUNT] = {
    {.name = ""},
#define REGISTER(id, name, type, index, v1, v2, vx, v3, vgl, p1, p2, p3, p4, p20, p2x, p30, pgl, software,   \
                 ports, access, meaning)                                                                     \
    {                                                                                                        \
        name,                                                                                                \
        ports,                                                                                               \
        meaning,                                                                                             \
        type,                                                                                                \
        index,                                                                                               \
        access,                                                                                              \
        {v1, v2, vx, v3, vgl, p1, p2, p3, p4, p20, p2x, p30, pgl},                                           \
        software},
#include "def/shader/shader_register.def"
#undef REGISTER
};

const struct shader_modifier shader_modifiers[MODIFIER_COUNT] = {
#define MODIFIER(id, number, before, after, columns, meaning) [number] = {before, after, columns, meaning},
#include "def/shader/shader_modifier.def"
#undef MODIFIER
};

#define MODIFIER(id, number, ...) _Static_assert(MODIFIER_##id == number, "rows are in the order of numbers");
#include "def/shader/shader_modifier.def"
#undef MODIFIER

#undef COMPARISON
const struct shader_word shader_comparisons[] = {
#define COMPARISON(id, name, number) {name, number},
#include "def/shader/shader_comparison.def"
#undef COMPARISON
    {NULL, 0},
};

const struct shader_word shader_usages[] = {
#define USAGE(id, name, number) {name, number},
#include "def/shader/shader_usage.def"
#undef USAGE
    {NULL, 0},
};

const struct shader_word shader_kinds[] = {
#define KIND(id, name, number) {name, number},
#include "def/shader/shader_usage.def"
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

unsigned shader_source_components(const struct shader_instruction *instruction, unsigned source)
{
    enum { FROM_RESULT = 16, W = 8 };
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    unsigned reads = source ? row->reads >> 8 : row->reads & 0xff;
    if (row->source[source] == OPERAND_SCALAR || row->source[source] == OPERAND_PREDICATE)
        return 1;
    if (row->source[source] == OPERAND_SCRATCH)
        return 0;
    if (instruction->source[source].modifier == MODIFIER_DIVIDE_W)
        reads |= W;
    return (reads & MASK_FULL) | (reads & FROM_RESULT ? instruction->destination.swizzle : 0u);
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
           (file == FILE_INPUT && (model->stage == STAGE_VERTEX || model->column >= COLUMN_PS_3_0));
}
