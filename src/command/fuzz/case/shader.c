/* Random shaders as a whole: their style, and what a draw has to bring for them. */
#include "command/fuzz/case/shader_part.h"

#include <stdlib.h>
#include <string.h>

/* --- What the caller learns ----------------------------------------------------------------------------- */

static void note_constants(struct fuzz_shader *made, const struct maker *maker,
                           const struct shader_operand *operand)
{
    if (operand->file == FILE_INTEGER && !(maker->defined_integers >> operand->index & 1))
        made->integers |= (uint16_t)(1u << operand->index);
    else if (operand->file == FILE_BOOLEAN && !(maker->defined_booleans >> operand->index & 1))
        made->booleans |= (uint16_t)(1u << operand->index);
}

/* ps_1_x does not declare texture kinds: some of its instructions have three coordinates. */
static unsigned kind_of_stage(struct maker *maker, unsigned opcode)
{
    enum { PLANE = 2, CUBE, VOLUME };
    switch (opcode) {
    case SHADER_TEXREG2RGB:
    case SHADER_TEXM3X3TEX:
    case SHADER_TEXM3X3SPEC:
    case SHADER_TEXM3X3VSPEC: return one_in(maker, 4) ? VOLUME : CUBE;
    case SHADER_TEX:
    case SHADER_TEXLD_1_4: return one_in(maker, 5) ? CUBE + below(maker, 2) : PLANE;
    default: return PLANE;
    }
}

static void describe(struct maker *maker)
{
    const struct shader *shader = maker->shader;
    struct fuzz_shader *made = maker->made;
    shader_describe(shader, &made->interface);
    made->instructions = shader->count;
    for (uint32_t i = 0; i < shader->count; i++) {
        const struct shader_instruction *at = &shader->instructions[i];
        const struct shader_operation *row = &shader_operations[at->opcode];
        for (unsigned source = 0; source < SHADER_SOURCES && row->source[source]; source++)
            note_constants(made, maker, &at->source[source]);
        if (at->opcode == SHADER_TEXBEM || at->opcode == SHADER_TEXBEML || at->opcode == SHADER_BEM)
            made->bumps |= (uint8_t)(1 << at->destination.index);
        if (shader_is_narrow(maker->model) && row->flags & IS_GRADIENT)
            made->interface.kinds[at->destination.index] = (uint8_t)kind_of_stage(maker, at->opcode);
    }
    if (!made->interface.constants || made->interface.input_count == 0)
        made->matrix = made->interface.constants ? made->matrix : -1;
}

/* --- Style ---------------------------------------------------------------------------------------------- */

/* Half are below four, without what begins and ends a shader; few go into the hundreds. */
static unsigned choose_length(struct maker *maker)
{
    static const uint16_t limits[] = {2, 4, 5, 6, 8, 10, 16, 40};
    unsigned limit = limits[below(maker, sizeof limits / sizeof *limits)];
    if (maker->options->instructions)
        return maker->options->instructions;
    return below(maker, one_in(maker, 24) ? 400 : limit);
}

static unsigned choose_pool(struct maker *maker)
{
    unsigned most = maker->model->temporaries, all = most < MAKER_TEMPORARIES ? most : MAKER_TEMPORARIES,
             usual = all < 8 ? all : 8;
    if (one_in(maker, 8))
        return all;
    return usual > 2 ? 2 + below(maker, usual - 1) : usual;
}

static void choose_style(struct maker *maker)
{
    const struct shader_model *model = maker->model;
    unsigned all = shader_register_count(FILE_CONSTANT, model);
    unsigned most = maker->options->constants ? maker->options->constants : one_in(maker, 12) ? all : 16;
    maker->wild = maker->options->wild || (!maker->options->tame && one_in(maker, 12));
    maker->left = choose_length(maker);
    maker->pool = choose_pool(maker);
    maker->constants = most > all ? all : most;
    maker->flow = model->loops && one_in(maker, 2) ? 3 + below(maker, 8) : 0;
    maker->predicated = model->capabilities & CAN_PREDICATION && one_in(maker, 3) ? 2 + below(maker, 8) : 0;
    maker->depth = one_in(maker, 8) ? 1 + below(maker, 24) : 1 + below(maker, 3);
    maker->trips = 1;
}

/* --- A body for tests ----------------------------------------------------------------------------------- */

static void write_bare(struct maker *maker)
{
    enum { AROUND = 48 };
    uint32_t set = maker->options->registers;
    maker->reserve = AROUND;
    maker->pool = 32 - (unsigned)__builtin_clz(set);
    for (unsigned i = 0; i < maker->pool; i++)
        maker->check.written.temporary[i] = set >> i & 1 ? MASK_FULL : 0;
    fuzz_shader_definitions(maker);
    fuzz_shader_body(maker);
}

/* --- All ------------------------------------------------------------------------------------------------ */

/* Moves r# of a model with many, so that all of them are used. */
static void move_temporaries(struct maker *maker)
{
    static const uint8_t distances[] = {0, 0, 1, 20, 32, 100, 190};
    unsigned distance = distances[below(maker, sizeof distances)];
    for (uint32_t n = 0; n < maker->shader->count; n++) {
        struct shader_instruction *i = &maker->shader->instructions[n];
        struct shader_operand *operands[] = {&i->destination, &i->source[0], &i->source[1], &i->source[2],
                                             &i->source[3]};
        for (unsigned o = 0; o < sizeof operands / sizeof *operands; o++)
            if (operands[o]->file == FILE_TEMPORARY && operands[o]->index < MAKER_TEMPORARIES)
                operands[o]->index = (uint16_t)(operands[o]->index + distance);
    }
}

static void write_all(struct maker *maker)
{
    if (maker->options->registers)
        write_bare(maker);
    else if (maker->model->stage == STAGE_VERTEX)
        fuzz_shader_vertex(maker);
    else if (shader_is_narrow(maker->model))
        fuzz_shader_stages(maker);
    else
        fuzz_shader_pixel(maker);
    if (is_opengl(maker) && !maker->options->registers && !maker->failed)
        move_temporaries(maker);
}

static struct shader *make_once(struct random *random, const struct shader_model *model,
                                const struct fuzz_shader_options *options, struct fuzz_shader *made,
                                struct error *error)
{
    struct maker maker = {.random = random, .options = options, .model = model, .made = made, .error = error};
    made->model = model;
    made->matrix = -1;
    maker.shader = shader_create("random", false, error);
    if (!maker.shader)
        return NULL;
    maker.shader->model = model;
    maker.check = check_of(maker.shader, &maker.refusal);
    maker.check.labels = shader_register_count(FILE_LABEL, model) ? MAKER_LABELS : 0;
    if (check_flow_begin(&maker.check)) {
        maker.failed = true;
        if (error)
            *error = maker.refusal;
    } else {
        choose_style(&maker);
        write_all(&maker);
        if (!maker.failed)
            describe(&maker);
    }
    check_free(&maker.check);
    if (!maker.failed)
        return maker.shader;
    shader_free(maker.shader);
    return NULL;
}

struct shader *fuzz_shader_make(struct random *random, const struct shader_model *model,
                                const struct fuzz_shader_options *options, struct fuzz_shader *made,
                                struct error *error)
{
    struct error reason = {{0}};
    unsigned proposed = 0, refused = 0;
    for (unsigned discarded = 0;; discarded++) {
        memset(made, 0, sizeof *made);
        struct shader *shader = make_once(random, model, options, made, error);
        made->proposed += proposed;
        made->refused += refused;
        made->discarded = discarded;
        if (!shader || options->registers || !shader_validate(shader, NULL, &reason))
            return shader;
        proposed = made->proposed;
        refused = made->refused;
        error_clear(&reason);
        shader_free(shader);
    }
}

int fuzz_shader_write(struct random *random, struct text *text, const char *name,
                      const struct shader_model *model, const struct fuzz_shader_options *options,
                      struct fuzz_shader *made, struct error *error)
{
    char *lines;
    size_t bytes;
    struct shader *shader = fuzz_shader_make(random, model, options, made, error);
    if (!shader)
        return -1;
    int bad = shader_print(shader, &lines, &bytes, error);
    shader_free(shader);
    if (bad)
        return -1;
    text_add(text, "shader %s {\n", name);
    text_add_bytes(text, lines, bytes);
    text_add(text, "}\n");
    free(lines);
    return text->failed ? error_set(error, "not enough memory for the text of a shader") : 0;
}

const struct shader_model *fuzz_shader_model(struct random *random, enum shader_stage stage)
{
    const struct shader_model *model;
    do
        model = &shader_models[random_below(random, MODEL_COUNT)];
    while (model->stage != stage || (model->capabilities & CAN_SOFTWARE && !random_chance(random, 8)));
    return model;
}

int fuzz_shader_pair(struct random *random, struct text *text, const char *vertex_name,
                     const char *pixel_name, const struct fuzz_shader_options *options,
                     struct fuzz_shader *vertex, struct fuzz_shader *pixel, struct error *error)
{
    struct fuzz_shader_options behind = *options;
    const struct shader_model *first = fuzz_shader_model(random, STAGE_VERTEX), *second;
    bool mixed = random_chance(random, 8);
    do
        second = fuzz_shader_model(random, STAGE_PIXEL);
    while (!mixed && (shader_major(first) == 3) != (shader_major(second) == 3));
    behind.before = vertex;
    if (fuzz_shader_write(random, text, vertex_name, first, options, vertex, error))
        return -1;
    return fuzz_shader_write(random, text, pixel_name, second, &behind, pixel, error);
}
