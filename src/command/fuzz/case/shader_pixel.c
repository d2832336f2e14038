/* Random pixel shaders from 2.0 on: their inputs, colours, depth, and discarded pixels. */
#include "command/fuzz/case/shader_part.h"

enum { ENDING = 24 }; /* slots for what comes in the end */

/* --- Declarations --------------------------------------------------------------------------------------- */

void fuzz_shader_samplers(struct maker *maker, unsigned count)
{
    static const uint8_t kinds[] = {2, 2, 2, 2, 2, 3, 4}; /* of def/shader/shader_usage.def */
    unsigned all = shader_register_count(FILE_SAMPLER, maker->model);
    for (unsigned i = 0; i < count; i++) {
        unsigned index = one_in(maker, 6) ? below(maker, all) : i;
        if (index < all && !maker->check.declared_kind[index])
            fuzz_shader_declare(maker, fuzz_shader_result(FILE_SAMPLER, index, MASK_FULL), 0, 0,
                                kinds[below(maker, sizeof kinds)]);
    }
    maker->textured = 2 + below(maker, 6);
}

static unsigned random_mask(struct maker *maker)
{
    return one_in(maker, 4) ? 1 + below(maker, MASK_FULL) : MASK_FULL;
}

static void declare_input(struct maker *maker, enum shader_file file, unsigned index, unsigned mask,
                          unsigned usage, unsigned usage_index)
{
    struct shader_operand declared = fuzz_shader_result(file, index, mask);
    if (one_in(maker, 8))
        declared.modifier = RESULT_CENTROID;
    else if (one_in(maker, 12))
        declared.modifier = RESULT_PARTIAL;
    fuzz_shader_declare(maker, declared, usage, usage_index, 0);
}

/* v0 and v1, t0 to t7: those that the vertex shader gives, and some that it does not. */
static void declare_second(struct maker *maker)
{
    const struct shader_interface *given = maker->options->before ? &maker->options->before->interface : NULL;
    unsigned colors = 1 + below(maker, 3), coordinates = 0;
    for (unsigned i = 0; given && i < given->output_count; i++)
        if (given->outputs[i].usage == USAGE_TEXCOORD && below(maker, 4))
            coordinates |= 1u << (given->outputs[i].usage_index & 7);
    if (!given || one_in(maker, 4))
        coordinates |= below(maker, 16);
    if (one_in(maker, 10))
        coordinates |= below(maker, 256);
    for (unsigned i = 0; i < 2; i++)
        if (colors >> i & 1)
            declare_input(maker, FILE_INPUT, i, random_mask(maker), 0, 0);
    for (unsigned i = 0; i < 8; i++)
        if (coordinates >> i & 1)
            declare_input(maker, FILE_TEXTURE, i, random_mask(maker), 0, 0);
}

/* ps_3_0: v# can be anything, and two things in different components. */
static void declare_third(struct maker *maker)
{
    static const uint8_t usages[] = {USAGE_COLOR, USAGE_TEXCOORD, USAGE_TEXCOORD, USAGE_TEXCOORD};
    const struct shader_interface *given = maker->options->before ? &maker->options->before->interface : NULL;
    unsigned index = 0, all = shader_register_count(FILE_INPUT, maker->model);
    for (unsigned i = 0; given && i < given->output_count && index < all; i++) {
        const struct shader_port *port = &given->outputs[i];
        bool position = port->usage == USAGE_POSITION || port->usage == USAGE_PSIZE;
        if (one_in(maker, position ? 1 : 4))
            continue;
        declare_input(maker, FILE_INPUT, index++, one_in(maker, 4) ? random_mask(maker) : port->mask,
                      port->usage, port->usage_index);
    }
    unsigned more = given ? below(maker, 3) / 2 : 1 + below(maker, 4);
    for (unsigned i = 0; i < more && index < all; i++) {
        unsigned usage = one_in(maker, 8) ? 1 + below(maker, USAGE_SAMPLE) : usages[below(maker, 4)];
        unsigned mask = random_mask(maker);
        declare_input(maker, FILE_INPUT, index, mask, usage, below(maker, one_in(maker, 6) ? 16 : 2));
        if (mask != MASK_FULL && one_in(maker, 2))
            declare_input(maker, FILE_INPUT, index, MASK_FULL & ~mask, USAGE_TEXCOORD, below(maker, 8));
        index++;
    }
    if (one_in(maker, 8))
        fuzz_shader_declare(maker, fuzz_shader_result(FILE_PLACE, 0, one_in(maker, 2) ? MASK_XY : MASK_FULL),
                            0, 0, 0);
    if (one_in(maker, 8))
        fuzz_shader_declare(maker, fuzz_shader_result(FILE_FACE, 0, MASK_FULL), 0, 0, 0);
    if (is_opengl(maker) && one_in(maker, 8))
        fuzz_shader_declare(maker, fuzz_shader_result(FILE_SPRITE, 0, MASK_FULL), 0, 0, 0);
}

/* --- Outputs -------------------------------------------------------------------------------------------- */

static void write_kill(struct maker *maker)
{
    struct shader_instruction kill = {.opcode = SHADER_TEXKILL};
    bool third = shader_major(maker->model) == 3;
    const uint8_t *declared = third ? maker->check.declared_input : maker->check.declared_texture;
    unsigned index = below(maker, third ? 10 : 8);
    int value = fuzz_shader_written(maker, MASK_FULL);
    if (value >= 0 && below(maker, 4))
        kill.destination = fuzz_shader_result(FILE_TEMPORARY, (unsigned)value, MASK_FULL);
    else if (declared[index])
        kill.destination = fuzz_shader_result(third ? FILE_INPUT : FILE_TEXTURE, index, MASK_FULL);
    else
        return;
    fuzz_shader_add(maker, &kill);
}

/* A register with four components, by moving something into one if there is none. */
static int complete_register(struct maker *maker)
{
    int index = fuzz_shader_written(maker, MASK_FULL);
    if (index >= 0)
        return index;
    index = (int)below(maker, maker->pool);
    struct shader_operand to = fuzz_shader_result(FILE_TEMPORARY, (unsigned)index, MASK_FULL);
    return fuzz_shader_propose(maker, SHADER_MOV, &to) ? index : -1;
}

/* Something that varies over the picture, added; and colours between 0 and 1 show more than others: the
 * fraction of them, or saturation. */
static void tame_color(struct maker *maker, unsigned index)
{
    struct shader_instruction tamed = {.opcode = SHADER_MAD,
                                       .destination = fuzz_shader_result(FILE_TEMPORARY, index, MASK_FULL)};
    tamed.source[0] = fuzz_shader_choose_input(maker);
    tamed.source[1] = fuzz_shader_operand(FILE_CONSTANT, below(maker, maker->constants));
    tamed.source[2] = fuzz_shader_operand(FILE_TEMPORARY, index);
    if (tamed.source[0].file)
        fuzz_shader_add(maker, &tamed);
    tamed.source[0] = tamed.source[2];
    if (one_in(maker, 4)) {
        tamed.destination.modifier = RESULT_SATURATE;
    } else {
        tamed.opcode = SHADER_FRC;
        tamed.source[1] = tamed.source[2] = fuzz_shader_operand(FILE_NONE, 0);
    }
    fuzz_shader_add(maker, &tamed);
}

static void write_color(struct maker *maker, unsigned target)
{
    struct shader_instruction give = {.opcode = SHADER_MOV};
    struct shader_operand to = fuzz_shader_result(FILE_TARGET, target, MASK_FULL);
    int index = complete_register(maker);
    if (shader_major(maker->model) == 3 && one_in(maker, 4)) {
        to.swizzle = (uint8_t)(one_in(maker, 4) ? random_mask(maker) : MASK_FULL);
        to.modifier = one_in(maker, 2) ? RESULT_SATURATE : 0;
        fuzz_shader_propose_any(maker, &to);
        return;
    }
    if (index < 0)
        return;
    if (target == 0)
        fuzz_shader_gather(maker, (unsigned)index);
    if (!maker->wild && below(maker, 4))
        tame_color(maker, (unsigned)index);
    give.destination = to;
    give.source[0] = fuzz_shader_operand(FILE_TEMPORARY, (unsigned)index);
    fuzz_shader_add(maker, &give);
}

static void write_depth(struct maker *maker)
{
    struct shader_instruction give = {.opcode = SHADER_MOV,
                                      .destination = fuzz_shader_result(FILE_DEPTH, 0, MASK_FULL)};
    int index = complete_register(maker);
    if (index < 0)
        return;
    give.source[0] = fuzz_shader_operand(FILE_TEMPORARY, (unsigned)index);
    give.source[0].swizzle = (uint8_t)(below(maker, 4) * 0x55);
    fuzz_shader_add(maker, &give);
}

void fuzz_shader_pixel(struct maker *maker)
{
    bool third = shader_major(maker->model) == 3;
    unsigned targets = one_in(maker, 5) ? 1 + below(maker, CHECK_TARGETS) : 1;
    if (third)
        declare_third(maker);
    else
        declare_second(maker);
    if (!one_in(maker, 4))
        fuzz_shader_samplers(maker,
                             one_in(maker, 8) ? 1 + below(maker, MAKER_SAMPLERS) : 1 + below(maker, 3));
    fuzz_shader_definitions(maker);
    maker->reserve = ENDING;
    fuzz_shader_body(maker);
    maker->reserve -= ENDING;
    if (one_in(maker, 7))
        write_kill(maker);
    for (unsigned i = 0; i < targets; i++)
        if (!third || i == 0 || !one_in(maker, 4))
            write_color(maker, i);
    if (one_in(maker, 8))
        write_depth(maker);
    fuzz_shader_end(maker);
}
