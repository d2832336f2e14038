/* Makes programs from shaders, and keeps the registry that gives each its number. */
#include "shader/program/program.h"

#include "base/bits.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

static pthread_mutex_t registry_lock = PTHREAD_MUTEX_INITIALIZER;
static struct program *registry;
static uint32_t last_number;

/* --- What is read -------------------------------------------------------------------------------------- */

static void note_read(struct program *program, const struct shader_operand *source, unsigned places)
{
    uint8_t *mask = source->file == FILE_INPUT     ? program->input_mask
                    : source->file == FILE_TEXTURE ? program->texture_mask
                                                   : NULL;
    if (!mask)
        return;
    if (source->relative) {
        memset(program->input_mask, MASK_FULL, sizeof program->input_mask);
        return;
    }
    for (unsigned place = 0; place < 4; place++)
        if (places >> place & 1)
            mask[source->index] |= (uint8_t)(1 << swizzle_component(source->swizzle, place));
    if (source->modifier == MODIFIER_DIVIDE_Z || source->modifier == MODIFIER_DIVIDE_W)
        mask[source->index] = MASK_FULL;
}

/* Notes a lookup. Its third coordinate is noted for the sampler only, because the bound texture may not use
 * it. */
static void note_lookup(struct program *program, const struct shader_instruction *i, unsigned places)
{
    const struct shader_operand *at = &i->source[0];
    uint16_t *third = at->file == FILE_INPUT     ? program->input_third
                      : at->file == FILE_TEXTURE ? program->texture_third
                                                 : NULL;
    if (third && !at->relative && swizzle_component(at->swizzle, 2) == 2) {
        third[at->index] |= (uint16_t)(1 << i->source[1].index);
        places &= ~4u;
    }
    note_read(program, at, places);
}

static void note_constant(struct program *program, const struct shader_operand *source, unsigned rows)
{
    uint32_t index = source->index;
    if (source->file == FILE_CONSTANT && source->relative)
        program->constants = shader_register_count(FILE_CONSTANT, program->model);
    else if (source->file == FILE_CONSTANT && index + rows > program->constants)
        program->constants = index + rows;
    else if (source->file == FILE_INTEGER && index >= program->integers)
        program->integers = index + 1;
    else if (source->file == FILE_BOOLEAN && !program_defined(program, FILE_BOOLEAN, index))
        program->booleans |= (uint16_t)(1 << index);
}

/* ps_1_x's texture instructions read the coordinates of the stage that they name; texkill reads its operand.
 */
static void note_stage(struct program *program, const struct shader_instruction *i)
{
    const struct shader_operand *to = &i->destination;
    if (i->opcode == SHADER_TEXKILL) {
        note_read(program,
                  &(struct shader_operand){.file = to->file, .index = to->index, .swizzle = SWIZZLE_NONE},
                  MASK_FULL);
        return;
    }
    if (shader_major(program->model) == 1 && to->file == FILE_TEXTURE)
        program->texture_mask[to->index] = MASK_FULL;
}

static int note_instruction(struct program *program, const struct shader_instruction *i, struct error *error)
{
    const struct shader_operation *row = &shader_operations[i->opcode];
    if (row->flags & IS_TEXTURE)
        note_stage(program, i);
    for (unsigned s = 0; s < SHADER_SOURCES && row->source[s]; s++) {
        const struct shader_operand *source = &i->source[s];
        if (source->file == FILE_BOOLEAN && source->index >= 16)
            return error_set(error, "%s shader: found b%u, expected Boolean constants below 16",
                             program->model->name, source->index);
        if (s == 0 && row->source[1] == OPERAND_SAMPLER)
            note_lookup(program, i, shader_source_components(i, s));
        else
            note_read(program, source, shader_source_components(i, s));
        note_constant(program, source, row->source[s] == OPERAND_MATRIX ? row->rows : 1);
    }
    return 0;
}

/* --- Making -------------------------------------------------------------------------------------------- */

static float clamped(float value)
{
    return value < -1 ? -1 : value > 1 ? 1 : value;
}

static void define(struct program *program, const struct shader_instruction *i)
{
    struct program_constant *constant = &program->defined[program->defined_count++];
    constant->file = i->destination.file;
    constant->index = i->destination.index;
    memcpy(constant->value, i->literal, sizeof constant->value);
    for (int c = 0; c < 4 && shader_is_narrow(program->model); c++) { /* ps_1_x has float constants only */
        float value = bits_to_float(constant->value[c]);
        value = clamped(value);
        memcpy(&constant->value[c], &value, sizeof value);
    }
}

static void note_array(struct program *program, const struct shader_instruction *i)
{
    for (unsigned r = i->destination.index; r <= i->source[0].index; r++) {
        program->array_begin[r] = i->destination.index;
        program->array_end[r] = (uint16_t)(i->source[0].index + 1);
    }
}

static int fill(struct program *program, const struct shader *shader, struct error *error)
{
    for (uint32_t n = 0; n < shader->count; n++) {
        const struct shader_instruction *i = &shader->instructions[n];
        if (i->opcode == SHADER_DEF || i->opcode == SHADER_DEFI || i->opcode == SHADER_DEFB)
            define(program, i);
        if (i->opcode == SHADER_ARRAY)
            note_array(program, i);
    }
    for (uint32_t n = 0; n < shader->count; n++) {
        const struct shader_instruction *i = &shader->instructions[n];
        if (!program_has_step(i))
            continue;
        program->step[program->steps++].instruction = *i;
        if (note_instruction(program, i, error))
            return -1;
    }
    unsigned end = cell_of_temporary(program->interface.temporaries);
    program->cells = end > CELL_MORE ? end : CELL_MORE;
    program_link(program);
    return program_connect(program, error);
}

static void destroy(struct program *program)
{
    free(program->step);
    free(program->defined);
    free(program->tokens);
    free(program);
}

/* Names the program after the path, without folders and ending. */
static void name_after(struct program *program, const char *path)
{
    const char *slash = strrchr(path, '/'), *stem = slash ? slash + 1 : path, *dot = strrchr(stem, '.');
    size_t length = dot && dot > stem ? (size_t)(dot - stem) : strlen(stem);
    if (length >= sizeof program->name)
        length = sizeof program->name - 1;
    memcpy(program->name, stem, length);
}

static struct program *create(const struct shader *shader, struct error *error)
{
    struct shader_counts counts;
    if (shader_validate(shader, &counts, error))
        return NULL;
    struct program *program = calloc(1, sizeof *program);
    if (!program) {
        error_set(error, "out of memory for a shader");
        return NULL;
    }
    program->model = shader->model;
    program->slots = counts.slots;
    name_after(program, shader->path);
    shader_describe(shader, &program->interface);
    program->step = calloc(shader->count + 1, sizeof *program->step);
    program->defined = calloc(shader->count + 1, sizeof *program->defined);
    if (!program->step || !program->defined)
        error_set(error, "out of memory for a shader of %u instructions", shader->count);
    else if (!shader_encode(shader, &program->tokens, &program->token_count, error) &&
             !fill(program, shader, error))
        return program;
    destroy(program);
    return NULL;
}

/* --- The registry -------------------------------------------------------------------------------------- */

static bool same(const struct program *a, const struct program *b)
{
    return a->hash == b->hash && a->model == b->model && a->token_count == b->token_count &&
           !memcmp(a->tokens, b->tokens, a->token_count * sizeof *a->tokens);
}

static struct program *intern(struct program *program)
{
    pthread_mutex_lock(&registry_lock);
    struct program *found = registry;
    while (found && !same(found, program))
        found = found->next;
    if (!found) {
        program->number = ++last_number;
        program->next = registry;
        registry = found = program;
    }
    found->users++;
    pthread_mutex_unlock(&registry_lock);
    return found;
}

const struct program *program_acquire(const struct shader *shader, struct error *error)
{
    struct program *program = create(shader, error);
    if (!program)
        return NULL;
    program->hash = XXH3_64bits(program->tokens, program->token_count * sizeof *program->tokens);
    struct program *interned = intern(program);
    if (interned != program)
        destroy(program);
    return interned;
}

void program_release(const struct program *released)
{
    struct program **at = &registry, *program = NULL;
    pthread_mutex_lock(&registry_lock);
    while (*at && *at != released)
        at = &(*at)->next;
    if (*at && --(*at)->users == 0) {
        program = *at;
        *at = program->next;
    }
    pthread_mutex_unlock(&registry_lock);
    if (program)
        destroy(program);
}

/* The caller holds the lock. */
static struct program *find_registered(uint32_t number)
{
    struct program *found = registry;
    while (found && found->number != number)
        found = found->next;
    return found;
}

const struct program *program_find(uint32_t number)
{
    pthread_mutex_lock(&registry_lock);
    const struct program *found = find_registered(number);
    pthread_mutex_unlock(&registry_lock);
    return found;
}

const struct program *program_hold(uint32_t number)
{
    pthread_mutex_lock(&registry_lock);
    struct program *found = find_registered(number);
    if (found)
        found->users++;
    pthread_mutex_unlock(&registry_lock);
    return found;
}

/* --- Queries ------------------------------------------------------------------------------------------- */

const struct program_constant *program_defined(const struct program *program, enum shader_file file,
                                               unsigned index)
{
    for (uint32_t i = program->defined_count; i-- > 0;) /* the last definition is valid */
        if (program->defined[i].file == file && program->defined[i].index == index)
            return &program->defined[i];
    return NULL;
}

size_t program_constant_bytes(const struct program *program)
{
    return 16 * (size_t)(program->constants + 1 + program->integers);
}

void program_write_constants(const struct program *program, const float (*floats)[4],
                             const int32_t (*integers)[4], void *to)
{
    float(*row)[4] = to;
    memcpy(row, floats, 16 * (size_t)program->constants);
    if (shader_is_narrow(program->model))
        for (uint32_t i = 0; i < 4 * program->constants; i++)
            row[i / 4][i % 4] = clamped(row[i / 4][i % 4]);
    for (uint32_t i = 0; i < program->defined_count; i++) {
        const struct program_constant *constant = &program->defined[i];
        if (constant->file == FILE_CONSTANT && constant->index < program->constants)
            memcpy(row[constant->index], constant->value, 16);
    }
    memset(row[program->constants], 0, 16);
    memcpy(row[program->constants + 1], integers, 16 * (size_t)program->integers);
}
