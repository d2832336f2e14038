/* The naive emulator's engine.
 *
 * To build a routine is to store the key. Every run makes every decision on the state again for every four
 * elements. The thesis calls this emulation by switch (section 2.4.1). The compiler cannot specialise the
 * code, because keys are known only at run time.
 *
 * The section names two improvements, and the options of the engine are these: the registers of shaders are
 * in one array, and shader instructions are decoded once, in the build. Each combination is a form
 * (emu/emulate/form.h). Routines without a shader are the same in all forms. */
#include "emu/emulate/emulate.h"

#include "emu/emulate/routine.h"
#include "machine/cpu.h"

#include <stdlib.h>

static const struct emulate_form *const forms[FILES_KINDS][DECODE_KINDS] = {
    [FILES_TYPED] = {[DECODE_EACH] = &emulate_typed_each, [DECODE_ONCE] = &emulate_typed_once},
    [FILES_ARRAY] = {[DECODE_EACH] = &emulate_array_each, [DECODE_ONCE] = &emulate_array_once},
};

/* Notes the constants that an operand reads by number. Returns false if a row is not one of EMULATE_ROWS. */
static bool note_rows(struct emulate_routine *routine, const struct shader_operand *source, unsigned rows)
{
    if (source->file != FILE_CONSTANT || source->relative)
        return true;
    if (source->index + rows > EMULATE_ROWS)
        return false;
    for (unsigned row = source->index; row < source->index + rows; row++)
        routine->rows[row / 64] |= (uint64_t)1 << row % 64;
    return true;
}

static bool constants_fit(struct emulate_routine *routine)
{
    const struct program *program = routine->program;
    bool fit = true;
    for (uint32_t at = 0; at < program->steps; at++) {
        const struct shader_instruction *i = &program->step[at].instruction;
        const struct shader_operation *operation = &shader_operations[i->opcode];
        for (unsigned s = 0; s < SHADER_SOURCES && operation->source[s]; s++)
            fit &= note_rows(routine, &i->source[s],
                             operation->source[s] == OPERAND_MATRIX ? operation->rows : 1);
    }
    return fit;
}

static const struct emulate_form *choose_form(struct emulate_routine *routine, const struct engine *engine)
{
    const struct emulate_options *options = engine->options;
    bool array = routine->program && options->files == FILES_ARRAY && constants_fit(routine);
    return forms[array ? FILES_ARRAY : FILES_TYPED][routine->program ? options->decode : DECODE_EACH];
}

static struct routine *finish(struct emulate_routine *routine, const struct emulate_form *form,
                              struct error *error)
{
    size_t bytes = routine->program ? form->prepare(routine) : 0;
    routine->routine.run = form->run[routine->routine.unit];
    if (bytes <= ROUTINE_BYTES_MAXIMUM) {
        routine->routine.data_bytes = (uint32_t)(sizeof *routine - sizeof routine->routine + bytes);
        return &routine->routine;
    }
    if (bytes == SIZE_MAX)
        error_set(error, "out of memory for the steps of a shader");
    else
        error_set(error, "found %zu bytes of decoded steps, expected at most %d", bytes,
                  ROUTINE_BYTES_MAXIMUM);
    free(routine->step);
    free(routine);
    return NULL;
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    (void)arena;
    struct emulate_routine *routine = calloc(1, sizeof *routine);
    if (!routine) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    routine->program = key_shader(unit, key);
    routine->layout = layout_of_unit(unit, key);
    routine->fuses = cpu_has_avx2_fma();
    routine->routine = (struct routine){.engine = self, .unit = unit, .key = *key};
    return finish(routine, choose_form(routine, self), error);
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    (void)arena;
    free(((struct emulate_routine *)(void *)routine)->step);
    free(routine);
}

const struct engine engine_emulate = {
    .name = "emulate",
    .description = "naive emulator: the specification performed, every state decided for every four elements",
    .width = 4,
    .without_arena = true,
    .options = &(const struct emulate_options){FILES_TYPED, DECODE_EACH},
    .build = build,
    .free = free_routine,
};

bool emulate_is_engine(const struct engine *engine)
{
    return engine->build == build;
}
