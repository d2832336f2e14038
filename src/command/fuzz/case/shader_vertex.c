/* Random vertex shaders: their inputs and outputs. The position comes first or last, from four dot
 * products with a matrix in constants, or as it is in the vertices, moved a little by something computed
 * now and then; wild shaders make it of anything. */
#include "command/fuzz/case/shader_part.h"

enum { OUTPUTS = 12, POSITION_SLOTS = 8, OUTPUT_SLOTS = 6 };

/* The outputs that are written at the end; below 3.0 registers have fixed usages. */
struct output {
    uint8_t file, index, mask;
};

/* --- Declarations --------------------------------------------------------------------------------------- */

static void random_usage(struct maker *maker, unsigned *usage, unsigned *usage_index)
{
    static const uint8_t common[] = {USAGE_NORMAL, USAGE_COLOR, USAGE_TEXCOORD, USAGE_TEXCOORD};
    *usage = common[below(maker, sizeof common)];
    *usage_index = *usage == USAGE_TEXCOORD ? below(maker, 8) : *usage == USAGE_COLOR ? below(maker, 2) : 0;
    if (!one_in(maker, 5))
        return;
    do
        *usage = below(maker, USAGE_SAMPLE + 1);
    while (*usage == USAGE_POSITIONT || *usage == USAGE_POSITION);
    *usage_index = one_in(maker, 3) ? below(maker, 16) : 0;
}

/* Returns true if an input or output of that file has the usage already. */
static bool is_declared(const struct maker *maker, enum shader_file file, unsigned usage,
                        unsigned usage_index)
{
    for (uint32_t i = 0; i < maker->shader->count; i++) {
        const struct shader_instruction *at = &maker->shader->instructions[i];
        if (at->opcode == SHADER_DCL && at->destination.file == file && at->usage == usage &&
            at->usage_index == usage_index)
            return true;
    }
    return false;
}

static void declare_inputs(struct maker *maker)
{
    unsigned index = one_in(maker, 4) ? below(maker, 4) : 0;
    unsigned count = below(maker, one_in(maker, 6) ? 12 : 4);
    fuzz_shader_declare(maker, fuzz_shader_result(FILE_INPUT, index, MASK_FULL), USAGE_POSITION, 0, 0);
    for (unsigned i = 0; i < count; i++) {
        unsigned usage, usage_index, mask = one_in(maker, 3) ? 1 + below(maker, MASK_FULL) : MASK_FULL;
        random_usage(maker, &usage, &usage_index);
        if (!is_declared(maker, FILE_INPUT, usage, usage_index))
            fuzz_shader_declare(maker, fuzz_shader_result(FILE_INPUT, ++index, mask), usage, usage_index, 0);
    }
}

/* Outputs of vs_3_0 can share a register, components apart. */
static unsigned declare_outputs(struct maker *maker, struct output *outputs)
{
    unsigned count = 0, more = below(maker, one_in(maker, 5) ? OUTPUTS : 5), index = below(maker, 2);
    outputs[count++] = (struct output){FILE_OUTPUT, (uint8_t)index, MASK_FULL};
    fuzz_shader_declare(maker, fuzz_shader_result(FILE_OUTPUT, index, MASK_FULL), USAGE_POSITION, 0, 0);
    for (unsigned free = 0; count <= more && ++index < OUTPUTS; free = 0) {
        for (unsigned part = 0; part < 2 && free != MASK_FULL; part++) {
            unsigned usage, usage_index;
            unsigned mask = part ? MASK_FULL & ~free : one_in(maker, 3) ? 1 + below(maker, 15) : MASK_FULL;
            random_usage(maker, &usage, &usage_index);
            if (usage == USAGE_NORMAL || is_declared(maker, FILE_OUTPUT, usage, usage_index) ||
                !fuzz_shader_declare(maker, fuzz_shader_result(FILE_OUTPUT, index, mask), usage, usage_index,
                                     0) ||
                count == OUTPUTS)
                break;
            outputs[count++] = (struct output){FILE_OUTPUT, (uint8_t)index, (uint8_t)mask};
            free |= mask;
        }
    }
    return count;
}

/* oPos, and some of the others. */
static unsigned choose_outputs(struct maker *maker, struct output *outputs)
{
    unsigned count = 0;
    outputs[count++] = (struct output){FILE_POSITION, 0, MASK_FULL};
    for (unsigned i = 0; i < 2; i++)
        if (!one_in(maker, 1 + 2 * (2 - i)))
            outputs[count++] = (struct output){FILE_COLOR, (uint8_t)i, MASK_FULL};
    for (unsigned i = below(maker, one_in(maker, 6) ? 8 : 4), index = 0; i > 0 && index < 8; i--, index++)
        outputs[count++] = (struct output){FILE_COORDINATE, (uint8_t)index, MASK_FULL};
    if (one_in(maker, 6))
        outputs[count++] = (struct output){FILE_FOG, 0, MASK_FULL};
    if (one_in(maker, 10) && count < OUTPUTS)
        outputs[count++] = (struct output){FILE_POINT, 0, MASK_FULL};
    return count;
}

/* --- Values --------------------------------------------------------------------------------------------- */

/* The position plus something small. */
static bool move_position(struct maker *maker, struct shader_operand to, unsigned from)
{
    struct shader_instruction moved = {.opcode = SHADER_MAD, .destination = to};
    int by = fuzz_shader_written(maker, MASK_FULL);
    if (by < 0 || maker->size[by] > 1)
        return false;
    moved.source[0] = fuzz_shader_operand(FILE_TEMPORARY, (unsigned)by);
    moved.source[1] = fuzz_shader_operand(FILE_CONSTANT, below(maker, maker->constants));
    moved.source[2] = fuzz_shader_operand(FILE_TEMPORARY, from);
    moved.source[1].swizzle = (uint8_t)(below(maker, 4) * 0x55);
    return fuzz_shader_add(maker, &moved);
}

static bool transform_by_rows(struct maker *maker, struct shader_operand to,
                              const struct shader_operand *from)
{
    for (unsigned i = 0; i < 4; i++) {
        struct shader_operand result = to;
        result.swizzle = (uint8_t)(1 << i);
        struct shader_instruction row = {.opcode = SHADER_DP4, .destination = result};
        row.source[0] = *from;
        row.source[1] = fuzz_shader_operand(FILE_CONSTANT, (unsigned)maker->made->matrix + i);
        if (!fuzz_shader_add(maker, &row))
            return false;
    }
    return true;
}

static bool transform(struct maker *maker, struct shader_operand to)
{
    if (maker->failed) /* perhaps the declaration of its input */
        return false;
    const struct shader_operand from =
        fuzz_shader_operand(FILE_INPUT, maker->shader->instructions[0].destination.index);
    struct shader_instruction whole = {.opcode = SHADER_M4X4, .destination = to};
    whole.source[0] = from;
    whole.source[1] = fuzz_shader_operand(FILE_CONSTANT, (unsigned)maker->made->matrix);
    if (maker->made->matrix < 0) {
        whole.opcode = SHADER_MOV;
        whole.source[1] = (struct shader_operand){0};
    } else if (one_in(maker, 4)) {
        return transform_by_rows(maker, to, &from);
    }
    return fuzz_shader_add(maker, &whole);
}

/* r# takes the position first now and then, for something to be added to it. */
static void write_position(struct maker *maker, const struct output *output)
{
    struct shader_operand to = fuzz_shader_result(output->file, output->index, MASK_FULL);
    unsigned temporary = below(maker, maker->pool);
    if (maker->wild && one_in(maker, 3)) {
        fuzz_shader_propose_any(maker, &to);
    } else if (one_in(maker, 5) &&
               transform(maker, fuzz_shader_result(FILE_TEMPORARY, temporary, MASK_FULL))) {
        struct shader_instruction move = {.opcode = SHADER_MOV, .destination = to};
        move.source[0] = fuzz_shader_operand(FILE_TEMPORARY, temporary);
        if (!move_position(maker, to, temporary))
            fuzz_shader_add(maker, &move);
    } else {
        transform(maker, to);
    }
}

/* An input, scaled: so that something varies over the picture whatever the rest is. */
static bool pass_input(struct maker *maker, const struct shader_operand *to)
{
    static const uint8_t opcodes[] = {SHADER_MOV, SHADER_MUL, SHADER_MAD};
    struct shader_instruction pass = {.opcode = opcodes[below(maker, sizeof opcodes)], .destination = *to};
    pass.source[0] = fuzz_shader_choose_input(maker);
    if (pass.opcode != SHADER_MOV)
        pass.source[1] = fuzz_shader_operand(FILE_CONSTANT, below(maker, maker->constants));
    if (pass.opcode == SHADER_MAD)
        pass.source[2] = pass.source[0];
    if (pass.opcode == SHADER_MAD && one_in(maker, 2))
        pass.source[2].swizzle = (uint8_t)(below(maker, 4) * 0x55);
    return fuzz_shader_add(maker, &pass);
}

static void write_output(struct maker *maker, const struct output *output)
{
    struct shader_instruction give = {.opcode = SHADER_MOV};
    give.destination = fuzz_shader_result(output->file, output->index, output->mask);
    int from = fuzz_shader_written(maker, MASK_FULL);
    if (one_in(maker, 8))
        give.destination.swizzle &= (uint8_t)(1 + below(maker, MASK_FULL));
    if (!give.destination.swizzle)
        give.destination.swizzle = output->mask;
    fuzz_shader_choose_modifiers(maker, &give);
    bool color = output->file == FILE_COLOR || output->file == FILE_OUTPUT;
    unsigned which = below(maker, color ? 5 : 3);
    if (which != 1 && which != 2 && pass_input(maker, &give.destination))
        return;
    if (from >= 0 && which == 1) {
        give.source[0] = fuzz_shader_operand(FILE_TEMPORARY, (unsigned)from);
        fuzz_shader_add(maker, &give);
    } else {
        fuzz_shader_propose_any(maker, &give.destination);
    }
}

void fuzz_shader_vertex(struct maker *maker)
{
    struct output outputs[OUTPUTS];
    bool third = shader_major(maker->model) == 3, first;
    maker->made->matrix = one_in(maker, 4) ? -1 : 0;
    maker->made->clip_position = maker->made->matrix < 0;
    declare_inputs(maker);
    if (third && one_in(maker, 4))
        fuzz_shader_samplers(maker, 1 + below(maker, 3));
    unsigned count = third ? declare_outputs(maker, outputs) : choose_outputs(maker, outputs);
    fuzz_shader_definitions(maker);
    first = one_in(maker, 3);
    maker->reserve = POSITION_SLOTS + OUTPUT_SLOTS * (count - 1);
    if (first)
        write_position(maker, &outputs[0]);
    fuzz_shader_body(maker);
    maker->reserve -= POSITION_SLOTS + OUTPUT_SLOTS * (count - 1);
    if (!first)
        write_position(maker, &outputs[0]);
    for (unsigned i = 1; i < count; i++)
        write_output(maker, &outputs[i]);
    fuzz_shader_end(maker);
}
