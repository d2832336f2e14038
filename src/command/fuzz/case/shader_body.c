/* Bodies of random shaders: definitions, runs of instructions, conditions, loops, subroutines.
 *
 * The loop counts keep the number of executed instructions within MAKER_BUDGET. The writer therefore sets the
 * counts: in defi, or in the values for the caller. Two rules look ahead. A loop is opened as one that pixels
 * may leave at different times or not at all. Labels, with the depth of their calls, are planned before the
 * first call. */
#include "base/bits.h"
#include "command/fuzz/case/shader_part.h"
#include "command/fuzz/case/wild.h"

#include <string.h>

/* --- Definitions ---------------------------------------------------------------------------------------- */

static uint32_t random_literal(struct maker *maker)
{
    static const float plain[] = {0, 1, -1, 0.5f, 2, 0.25f, 255, 3.14159274f};
    float most = shader_is_narrow(maker->model) ? 1 : 2;
    float value = one_in(maker, 4) ? plain[below(maker, sizeof plain / sizeof *plain)]
                                   : random_float(maker->random, -most, most);
    if (one_in(maker, maker->wild ? 2 : 24))
        return wild_bits(maker->random);
    return bits_of_float(value);
}

static void define_float(struct maker *maker)
{
    unsigned limit = shader_register_count(FILE_CONSTANT, maker->model);
    unsigned index = below(maker, maker->constants ? maker->constants : 1);
    if (maker->made->matrix >= 0 && index < 4)
        index = 4;
    if (one_in(maker, 8) && !maker->options->registers)
        index = below(maker, limit);
    for (uint32_t i = 0; i < maker->shader->count; i++)
        if (maker->shader->instructions[i].opcode == SHADER_DEF &&
            maker->shader->instructions[i].destination.index == index)
            return;
    struct shader_instruction instruction = {
        .opcode = SHADER_DEF, .destination = fuzz_shader_result(FILE_CONSTANT, index, MASK_FULL)};
    for (unsigned i = 0; i < 4; i++)
        instruction.literal[i] = random_literal(maker);
    fuzz_shader_add(maker, &instruction);
}

static void choose_count(struct maker *maker, unsigned index, unsigned most)
{
    int32_t *value = maker->made->integer[index];
    bool wild = maker->wild || one_in(maker, 16);
    value[0] = one_in(maker, 12) ? 0 : random_between(maker->random, 1, wild ? 255 : 5);
    value[1] = one_in(maker, 2) ? 0 : random_between(maker->random, 0, wild ? 255 : 6);
    value[2] = random_between(maker->random, wild ? -128 : -2, wild ? 127 : 3);
    value[3] = 0;
    if (value[0] > (int32_t)most)
        value[0] = (int32_t)most;
    maker->known_integers |= (uint16_t)(1u << index);
}

static void define_integer(struct maker *maker)
{
    unsigned index = below(maker, one_in(maker, 4) ? FUZZ_SHADER_INTEGERS : 3);
    if (maker->known_integers >> index & 1)
        return;
    choose_count(maker, index, one_in(maker, 20) ? 255 : 6);
    struct shader_instruction instruction = {
        .opcode = SHADER_DEFI, .destination = fuzz_shader_result(FILE_INTEGER, index, MASK_FULL)};
    memcpy(instruction.literal, maker->made->integer[index], sizeof instruction.literal);
    if (fuzz_shader_add(maker, &instruction))
        maker->defined_integers |= (uint16_t)(1u << index);
}

static void define_boolean(struct maker *maker)
{
    unsigned index = below(maker, one_in(maker, 4) ? 16 : 3);
    struct shader_instruction instruction = {.opcode = SHADER_DEFB,
                                             .destination =
                                                 fuzz_shader_result(FILE_BOOLEAN, index, MASK_FULL),
                                             .literal = {below(maker, 2)}};
    if (!(maker->defined_booleans >> index & 1) && fuzz_shader_add(maker, &instruction))
        maker->defined_booleans |= (uint16_t)(1u << index);
}

static void declare_array(struct maker *maker)
{
    unsigned first = below(maker, maker->pool), last = first + below(maker, maker->pool - first);
    struct shader_instruction array = {.opcode = SHADER_ARRAY,
                                       .destination = fuzz_shader_result(FILE_TEMPORARY, first, MASK_FULL)};
    array.source[0] = fuzz_shader_operand(FILE_TEMPORARY, last);
    if (!fuzz_shader_add(maker, &array))
        return;
    maker->array = first;
    maker->array_end = last + 1;
}

void fuzz_shader_definitions(struct maker *maker)
{
    if (is_opengl(maker) && !maker->options->registers && one_in(maker, 3))
        declare_array(maker);
    for (unsigned i = below(maker, 4); i > 0; i--)
        define_float(maker);
    for (unsigned i = below(maker, 3); i > 0 && fuzz_shader_has(maker, SHADER_REP); i--)
        define_integer(maker);
    for (unsigned i = below(maker, 3); i > 0 && fuzz_shader_has(maker, SHADER_IF); i--)
        define_boolean(maker);
}

/* --- Blocks --------------------------------------------------------------------------------------------- */

static void write_block(struct maker *maker, unsigned depth, unsigned length);

static bool add_plain(struct maker *maker, enum shader_opcode opcode)
{
    return fuzz_shader_add(maker, &(struct shader_instruction){.opcode = (uint8_t)opcode});
}

/* Returns true if one more instruction of static flow control is allowed. */
static bool has_flow(const struct maker *maker, unsigned count)
{
    return !maker->model->flow || maker->check.flow + count <= maker->model->flow;
}

static bool all_loops_part(const struct maker *maker)
{
    for (unsigned i = 0; i < maker->check.block_count; i++)
        if (!is_if(maker->check.blocks[i].opcode) && !maker->check.blocks[i].dynamic)
            return false;
    return true;
}

/* The contents of a block: sometimes empty, else up to a little more than the remaining instructions. */
static void write_inner(struct maker *maker, unsigned depth)
{
    if (one_in(maker, 16))
        return;
    maker->left += 2;
    write_block(maker, depth + 1, 1 + below(maker, 5));
}

static void write_condition(struct maker *maker, unsigned depth)
{
    enum { CLOSING = 2 };
    bool compare = fuzz_shader_has(maker, SHADER_IF_COMPARE) && one_in(maker, 2);
    if (!has_flow(maker, 2) || !fuzz_shader_propose(maker, compare ? SHADER_IF_COMPARE : SHADER_IF, NULL))
        return;
    maker->reserve += CLOSING;
    write_inner(maker, depth);
    if (one_in(maker, 2) && fuzz_shader_has_room(maker, 0) && add_plain(maker, SHADER_ELSE))
        write_inner(maker, depth);
    maker->reserve -= CLOSING;
    add_plain(maker, SHADER_ENDIF);
}

/* An integer constant whose count the budget has room for; -1 if there is none. */
static int choose_integer(struct maker *maker)
{
    unsigned index = below(maker, one_in(maker, 8) ? FUZZ_SHADER_INTEGERS : 4);
    unsigned most = MAKER_BUDGET / 8 / maker->trips;
    if (!most)
        return -1;
    if (!(maker->known_integers >> index & 1))
        choose_count(maker, index, most);
    return maker->made->integer[index][0] <= (int32_t)most ? (int)index : -1;
}

static void write_loop(struct maker *maker, unsigned depth)
{
    enum { CLOSING = 2 };
    bool counts = fuzz_shader_has(maker, SHADER_LOOP) && one_in(maker, 2);
    bool parts = maker->model->dynamic && all_loops_part(maker) && one_in(maker, 2);
    int index = choose_integer(maker);
    struct shader_instruction begin = {.opcode = counts ? SHADER_LOOP : SHADER_REP};
    if (index < 0 || !has_flow(maker, 1) || maker->check.loops >= maker->model->loops)
        return;
    begin.source[0] = fuzz_shader_operand(counts ? FILE_LOOP : FILE_INTEGER, counts ? 0 : (unsigned)index);
    if (counts)
        begin.source[1] = fuzz_shader_operand(FILE_INTEGER, (unsigned)index);
    if (!fuzz_shader_add(maker, &begin))
        return;
    unsigned trips = maker->trips, count = (unsigned)maker->made->integer[index][0];
    maker->check.blocks[maker->check.block_count - 1].dynamic = parts;
    maker->reserve += CLOSING;
    maker->trips *= count ? count : 1;
    write_inner(maker, depth);
    maker->trips = trips;
    maker->reserve -= CLOSING;
    add_plain(maker, counts ? SHADER_ENDLOOP : SHADER_ENDREP);
}

/* An instruction of x of a register and of one or two others. */
static bool add_scalars(struct maker *maker, enum shader_opcode opcode, unsigned to, unsigned a, unsigned b)
{
    struct shader_instruction i = {.opcode = (uint8_t)opcode};
    const unsigned from[] = {a, b};
    if (shader_operations[opcode].destination)
        i.destination = fuzz_shader_result(FILE_TEMPORARY, to, MASK_X);
    else
        i.comparison = COMPARISON_GREATER;
    for (unsigned s = 0; s < 2; s++) {
        i.source[s] = fuzz_shader_operand(FILE_TEMPORARY, from[s]);
        i.source[s].swizzle = 0;
    }
    return fuzz_shader_add(maker, &i);
}

/* A loop without a count. Two registers of its own, a number of passes and a limit of 1, 2, 4 or 8, make it
 * end. */
static void write_while(struct maker *maker, unsigned depth)
{
    unsigned counter = MAKER_COUNTER - 2 * maker->check.loops, limit = counter + 1,
             doublings = below(maker, 4);
    unsigned trips = maker->trips, passes = 1u << doublings;
    if (maker->check.loops >= 8 || trips * passes * 8 > MAKER_BUDGET)
        return;
    if (!add_scalars(maker, SHADER_SUB, counter, counter, counter) || !add_plain(maker, SHADER_WHILE))
        return;
    maker->trips *= passes + 1;
    add_scalars(maker, SHADER_SEQ, limit, counter, counter);
    add_scalars(maker, SHADER_ADD, counter, counter, limit);
    for (unsigned i = 0; i < doublings; i++)
        add_scalars(maker, SHADER_ADD, limit, limit, limit);
    add_scalars(maker, SHADER_BREAK_COMPARE, 0, counter, limit);
    write_inner(maker, depth);
    maker->trips = trips;
    add_plain(maker, SHADER_ENDWHILE);
}

/* Returns true if pixels may differ in running this within the innermost loop. */
static bool is_within_condition(const struct maker *maker, bool computed)
{
    for (unsigned i = maker->check.block_count; i-- > 0;) {
        const struct block *block = &maker->check.blocks[i];
        if (is_if(block->opcode) && (!computed || block->dynamic))
            return true;
    }
    return false;
}

/* Instructions that only models of OpenGL have: the rest of the pass, of the shader or of the pixel is left
 * out. */
static void write_leaving(struct maker *maker)
{
    unsigned kind = below(maker, 4);
    if (kind == 0 && maker->check.block_count && !maker->options->registers)
        add_plain(maker, SHADER_RET);
    else if (kind == 1 && is_pixel(maker) && !maker->options->registers)
        fuzz_shader_propose(maker, one_in(maker, 4) ? SHADER_KILL : SHADER_KILL_COMPARE, NULL);
    else if (maker->check.loops && is_within_condition(maker, false))
        add_plain(maker, SHADER_CONTINUE);
}

static void write_break(struct maker *maker)
{
    bool parts = all_loops_part(maker);
    unsigned kind = below(maker, 3);
    if (kind == 0 && parts)
        fuzz_shader_propose(maker, SHADER_BREAK_COMPARE, NULL);
    else if (kind == 1 && parts && maker->check.written.predicate)
        fuzz_shader_propose(maker, SHADER_BREAKP, NULL);
    else if (is_within_condition(maker, false) && (parts || !is_within_condition(maker, true)))
        add_plain(maker, SHADER_BREAK);
}

static void write_call(struct maker *maker)
{
    unsigned label = maker->label < maker->labels ? maker->label + 1 : 0;
    if (maker->label == maker->labels)
        label = below(maker, maker->labels);
    else if (maker->nested && label < maker->labels)
        label += below(maker, maker->labels - label);
    else
        return;
    struct shader_instruction call = {.opcode = one_in(maker, 2) ? SHADER_CALL : SHADER_CALLNZ};
    call.source[0] = fuzz_shader_operand(FILE_LABEL, label);
    if (call.opcode == SHADER_CALLNZ && !fuzz_shader_choose_source(maker, &call, 1))
        return;
    if (has_flow(maker, 1))
        fuzz_shader_add(maker, &call);
}

/* --- Runs of instructions ------------------------------------------------------------------------------- */

static void write_flow(struct maker *maker, unsigned depth)
{
    unsigned which = below(maker, is_opengl(maker) ? 12 : 8);
    bool deeper = depth < maker->depth && maker->check.block_count + 1 < CHECK_BLOCKS &&
                  fuzz_shader_has_room(maker, 2 * MAKER_MARGIN);
    if (which < 3 && deeper)
        write_condition(maker, depth);
    else if (which < 6 && deeper)
        write_loop(maker, depth);
    else if (which >= 8 && which < 10 && deeper)
        write_while(maker, depth);
    else if (which >= 10)
        write_leaving(maker);
    else if (which == 6 && maker->labels)
        write_call(maker);
    else if (maker->check.loops && fuzz_shader_has(maker, SHADER_BREAK))
        write_break(maker);
}

static void write_texture(struct maker *maker)
{
    static const uint8_t opcodes[] = {SHADER_TEXLD, SHADER_TEXLDP, SHADER_TEXLDB, SHADER_TEXLDD,
                                      SHADER_TEXLDL};
    enum shader_opcode opcode;
    do
        opcode = one_in(maker, 3) ? SHADER_TEXLD : opcodes[below(maker, sizeof opcodes)];
    while (maker->model->stage == STAGE_PIXEL ? !fuzz_shader_has(maker, opcode) : opcode != SHADER_TEXLDL);
    fuzz_shader_propose(maker, opcode, NULL);
}

/* An address from a value of any size, or from small ones. */
static void write_address(struct maker *maker)
{
    struct shader_operand address = fuzz_shader_result(FILE_ADDRESS, 0, MASK_X);
    if (fuzz_shader_has(maker, SHADER_MOVA))
        fuzz_shader_propose(maker, SHADER_MOVA, NULL);
    else
        fuzz_shader_propose(maker, SHADER_MOV, &address);
}

/* Of models 3, in a loop: o[aL + n]; of vs_gl also o[a0.x + n]; within what is declared or not. */
static void write_indexed_output(struct maker *maker)
{
    struct shader_operand result = fuzz_shader_result(FILE_OUTPUT, below(maker, 12), MASK_FULL);
    bool address = is_opengl(maker) && maker->check.written.address & MASK_X && one_in(maker, 2);
    result.relative = address ? FILE_ADDRESS : FILE_LOOP;
    fuzz_shader_propose_any(maker, &result);
}

static void write_instruction(struct maker *maker, unsigned depth)
{
    bool vertex = maker->model->stage == STAGE_VERTEX, bare = maker->options->registers;
    if (maker->flow && one_in(maker, maker->flow))
        write_flow(maker, depth);
    else if (maker->textured && one_in(maker, maker->textured))
        write_texture(maker);
    else if (maker->predicated && one_in(maker, 3 * maker->predicated))
        fuzz_shader_propose(maker, SHADER_SETP, NULL);
    else if ((vertex || is_opengl(maker)) && one_in(maker, 10))
        write_address(maker);
    else if (one_in(maker, 200))
        fuzz_shader_propose(maker, SHADER_NOP, NULL);
    else if (vertex && !bare && shader_major(maker->model) == 3 && maker->check.loops && one_in(maker, 12))
        write_indexed_output(maker);
    else
        fuzz_shader_propose_any(maker, NULL);
}

static bool has_left(const struct maker *maker)
{
    return maker->left > 0 && maker->executed < MAKER_BUDGET && !maker->failed &&
           fuzz_shader_has_room(maker, MAKER_MARGIN);
}

static void write_block(struct maker *maker, unsigned depth, unsigned length)
{
    for (; length > 0 && has_left(maker); length--) {
        maker->left--;
        write_instruction(maker, depth);
    }
}

/* --- Whole bodies --------------------------------------------------------------------------------------- */

enum { SUBROUTINE_SLOTS = 24 };

/* Labels do not exist yet, so the validator receives their future positions and call depths. */
static void plan_subroutines(struct maker *maker)
{
    unsigned most = maker->model->calls;
    if (!maker->flow || !most || maker->options->registers || !one_in(maker, 3))
        return;
    maker->labels = 1 + below(maker, MAKER_LABELS);
    maker->nested = maker->labels <= most && one_in(maker, 2);
    maker->label = maker->labels;
    maker->reserve += 1 + maker->labels * SUBROUTINE_SLOTS;
    for (unsigned i = 0; i < maker->labels; i++) {
        maker->check.subroutines[i].position = UINT32_MAX - 1;
        maker->check.subroutines[i].depth = (uint16_t)(maker->nested ? maker->labels - i : 1);
    }
}

void fuzz_shader_body(struct maker *maker)
{
    unsigned length = maker->left;
    plan_subroutines(maker);
    if (maker->predicated)
        fuzz_shader_propose(maker, SHADER_SETP,
                            &(struct shader_operand){FILE_PREDICATE, .swizzle = MASK_FULL});
    if (maker->labels)
        maker->left = length = length * 2 / 3 + 1;
    write_block(maker, 0, length);
    if (maker->labels && fuzz_shader_has_room(maker, MAKER_MARGIN))
        write_call(maker);
}

static void write_subroutine(struct maker *maker, unsigned label)
{
    struct shader_instruction begin = {.opcode = SHADER_LABEL,
                                       .source = {fuzz_shader_operand(FILE_LABEL, label)}};
    maker->label = label;
    maker->reserve -= SUBROUTINE_SLOTS;
    maker->check.subroutines[label].position = maker->shader->count;
    if (!fuzz_shader_add(maker, &begin))
        return;
    maker->left = 1 + below(maker, 6);
    write_block(maker, 1, maker->left);
    add_plain(maker, SHADER_RET);
}

void fuzz_shader_end(struct maker *maker)
{
    if (!maker->labels)
        return;
    maker->flow *= 2;
    add_plain(maker, SHADER_RET);
    for (unsigned i = 0; i < maker->labels; i++)
        write_subroutine(maker, i);
}

void fuzz_shader_gather(struct maker *maker, unsigned into)
{
    enum { SUMMANDS = 6 };
    static const uint8_t opcodes[] = {SHADER_ADD, SHADER_MAD, SHADER_MUL, SHADER_SUB};
    uint32_t set = maker->fresh & ~(1u << into);
    for (unsigned i = 0; set && i < SUMMANDS && fuzz_shader_has_room(maker, 1); i++) {
        unsigned index = fuzz_shader_any_bit(maker, set), opcode = opcodes[below(maker, sizeof opcodes)];
        struct shader_instruction sum = {.opcode = (uint8_t)opcode,
                                         .destination = fuzz_shader_result(FILE_TEMPORARY, into, MASK_FULL)};
        bool whole = maker->check.written.temporary[index] == MASK_FULL;
        set &= ~(1u << index);
        if (!whole && shader_is_narrow(maker->model))
            continue;
        if (!maker->wild && maker->size[index] + maker->size[into] >= MAKER_LARGE)
            continue;
        sum.source[0] = fuzz_shader_operand(FILE_TEMPORARY, into);
        sum.source[1] = fuzz_shader_operand(FILE_TEMPORARY, index);
        sum.source[2] = fuzz_shader_operand(FILE_TEMPORARY, into);
        if (!whole)
            sum.source[1].swizzle =
                (uint8_t)(fuzz_shader_any_bit(maker, maker->check.written.temporary[index]) * 0x55);
        if (opcode != SHADER_MAD)
            sum.source[2] = (struct shader_operand){0};
        fuzz_shader_add(maker, &sum);
    }
}
