#include "front/glsl/check/builtin.h"
#include "front/glsl/link/link.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const glsl_stage_names[GLSL_STAGES] = {"vertex", "fragment"};

void glsl_link_error(struct glsl_linker *linker, const char *format, ...)
{
    va_list arguments;
    char line[512];
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if (linker->errors++ >= GLSL_ERRORS)
        return;
    linker->used +=
        (unsigned)snprintf(linker->log + linker->used, GLSL_LOG_BYTES - linker->used, "ERROR: %s\n", line);
}

/* --- Steps ---------------------------------------------------------------------------------------------- */

static bool has_failed(struct glsl_linker *linker, enum glsl_stage id, const struct glsl_code *code)
{
    if (code->failure)
        glsl_link_error(linker, "found %s in the %s shader", code->failure, glsl_stage_names[id]);
    return code->failure;
}

static bool lower(struct glsl_linker *linker, enum glsl_stage id)
{
    struct glsl_stage_link *stage = &linker->stage[id];
    stage->code = &glsl_lower(&linker->arena, stage->unit)->code;
    if (has_failed(linker, id, stage->code))
        return false;
    if (id == GLSL_VERTEX)
        glsl_link_need_varyings(linker);
    glsl_code_remove_dead(stage->code);
    glsl_link_note_uses(linker, stage);
    return true;
}

static bool reads_facing(const struct glsl_code *code)
{
    for (uint32_t i = 0; i < code->count; i++)
        for (unsigned k = 0; k < glsl_ops[code->instruction[i].op].sources; k++) {
            const struct glsl_operand *x = &code->instruction[i].from[k];
            if (x->file == GLSL_FILE_SOURCE && x->number == GLSL_SOURCE_FACING)
                return true;
        }
    return false;
}

static bool writes_second(const struct glsl_code *code)
{
    for (uint32_t i = 0; i < code->count; i++)
        if (code->instruction[i].to.file == GLSL_FILE_RESULT &&
            code->instruction[i].to.number == GLSL_RESULT_SECOND)
            return true;
    return false;
}

/* The other texts of a fragment shader. Their literals have room if those of the first had. */
static void print_others(struct glsl_linker *linker, struct glsl_code *code, struct glsl_layout layout)
{
    bool facing = reads_facing(code);
    layout.turned = facing;
    if (facing)
        linker->turned = glsl_print(code, &layout);
    layout.second = writes_second(code);
    if (layout.second && facing)
        linker->second[1] = glsl_print(code, &layout);
    layout.turned = false;
    if (layout.second)
        linker->second[0] = glsl_print(code, &layout);
}

static bool print(struct glsl_linker *linker, enum glsl_stage id)
{
    struct glsl_stage_link *stage = &linker->stage[id];
    struct glsl_layout layout = {.uniform = stage->uniform,
                                 .attribute = stage->attribute,
                                 .varying = stage->varying,
                                 .sampler = stage->sampler,
                                 .constants = stage->constants,
                                 .varyings = linker->varyings};
    glsl_code_allocate(stage->code);
    if (!stage->code->failure)
        stage->text = glsl_print(stage->code, &layout);
    if (!stage->code->failure)
        print_others(linker, stage->code, layout);
    return !has_failed(linker, id, stage->code);
}

/* A shader object without main compiles (section 6.1 is about programs). */
static void check_mains(struct glsl_linker *linker)
{
    for (unsigned i = 0; i < GLSL_STAGES; i++)
        if (!linker->stage[i].unit->main)
            glsl_link_error(linker, "found no 'main' in the %s shader, expected void main()",
                            glsl_stage_names[i]);
}

/* The fragment shader is lowered first: it decides which varyings the vertex shader computes. */
static bool link_stages(struct glsl_linker *linker)
{
    check_mains(linker);
    glsl_link_check_varyings(linker);
    glsl_link_check_uniforms(linker);
    if (linker->errors || !lower(linker, GLSL_FRAGMENT) || !lower(linker, GLSL_VERTEX))
        return false;
    glsl_link_place_varyings(linker);
    glsl_link_place_attributes(linker);
    glsl_link_place_uniforms(linker);
    return !linker->errors && print(linker, GLSL_VERTEX) && print(linker, GLSL_FRAGMENT);
}

/* --- The program ---------------------------------------------------------------------------------------- */

static size_t name_bytes(const char *name, struct glsl_type type)
{
    return strlen(name) + (type.array ? sizeof "[0]" : 1);
}

static size_t bytes_of(const struct glsl_linker *linker)
{
    size_t bytes = sizeof(struct glsl_program) + linker->uniforms * sizeof *linker->uniform +
                   linker->attributes * sizeof *linker->attribute;
    for (unsigned i = 0; i < linker->uniforms; i++)
        bytes += strlen(linker->uniform[i].name) + 1;
    for (unsigned i = 0; i < linker->attributes; i++)
        bytes += strlen(linker->attribute[i].name) + 1;
    for (unsigned i = 0; i < GLSL_STAGES; i++)
        bytes += strlen(linker->stage[i].text) + 1;
    const char *const others[] = {linker->turned, linker->second[0], linker->second[1]};
    for (unsigned i = 0; i < sizeof others / sizeof *others; i++)
        bytes += others[i] ? strlen(others[i]) + 1 : 0;
    return bytes;
}

static const char *copy_text(char **at, const char *text)
{
    char *copy = *at;
    size_t bytes = strlen(text) + 1;
    memcpy(copy, text, bytes);
    *at += bytes;
    return copy;
}

static void copy_uniforms(const struct glsl_linker *linker, struct glsl_program *program,
                          struct glsl_uniform *to, char **at)
{
    program->uniform = to;
    program->uniforms = linker->uniforms;
    for (unsigned i = 0; i < linker->uniforms; i++) {
        size_t bytes = name_bytes(linker->uniform[i].name, linker->uniform[i].type);
        to[i] = linker->uniform[i];
        to[i].name = copy_text(at, linker->uniform[i].name);
        if (program->uniform_name_bytes < bytes)
            program->uniform_name_bytes = (unsigned)bytes;
    }
}

static void copy_attributes(const struct glsl_linker *linker, struct glsl_program *program,
                            struct glsl_attribute *to, char **at)
{
    program->attribute = to;
    program->attributes = linker->attributes;
    for (unsigned i = 0; i < linker->attributes; i++) {
        size_t bytes = name_bytes(linker->attribute[i].name, linker->attribute[i].type);
        to[i] = linker->attribute[i];
        to[i].name = copy_text(at, linker->attribute[i].name);
        if (program->attribute_name_bytes < bytes)
            program->attribute_name_bytes = (unsigned)bytes;
    }
}

static void note_results(struct glsl_program *program, const struct glsl_code *code)
{
    for (uint32_t i = 0; i < code->count; i++) {
        const struct glsl_instruction *x = &code->instruction[i];
        program->discards |= x->op == GLSL_OP_KILL || x->op == GLSL_OP_KILL_IF;
        for (unsigned k = 0; k < glsl_ops[x->op].sources; k++)
            if (x->from[k].file == GLSL_FILE_SOURCE) {
                program->frag_coord |= x->from[k].number == GLSL_SOURCE_COORD;
                program->front_facing |= x->from[k].number == GLSL_SOURCE_FACING;
                program->point_coord |= x->from[k].number == GLSL_SOURCE_POINT;
            }
        if (x->to.file != GLSL_FILE_RESULT)
            continue;
        program->point_size |= x->to.number == GLSL_RESULT_POINT_SIZE;
        program->depth |= x->to.number == GLSL_RESULT_DEPTH;
        if (x->to.number >= GLSL_RESULT_COLOR && x->to.number < GLSL_RESULT_SECOND)
            program->colors |= (uint8_t)(1u << (x->to.number - GLSL_RESULT_COLOR));
    }
}

static struct glsl_program *make_program(const struct glsl_linker *linker)
{
    struct glsl_program *program = calloc(1, bytes_of(linker));
    if (!program)
        return NULL;
    struct glsl_uniform *uniform = (struct glsl_uniform *)(program + 1);
    struct glsl_attribute *attribute = (struct glsl_attribute *)(uniform + linker->uniforms);
    char *at = (char *)(attribute + linker->attributes);
    copy_uniforms(linker, program, uniform, &at);
    copy_attributes(linker, program, attribute, &at);
    program->varyings = linker->varyings;
    for (unsigned i = 0; i < GLSL_STAGES; i++) {
        program->text[i] = copy_text(&at, linker->stage[i].text);
        note_results(program, linker->stage[i].code);
    }
    program->turned = linker->turned ? copy_text(&at, linker->turned) : NULL;
    for (unsigned i = 0; i < 2; i++)
        program->second[i] = linker->second[i] ? copy_text(&at, linker->second[i]) : NULL;
    program->blends = linker->stage[GLSL_FRAGMENT].unit->blends;
    program->broadcasts = linker->stage[GLSL_FRAGMENT].unit->builtins >> GLSL_FRAG_COLOR & 1;
    return program;
}

/* The jump from the arena comes back here. Returns true if memory was refused. */
static bool try_to_link(struct glsl_linker *linker, bool *linked)
{
    if (setjmp(linker->arena.refused))
        return true;
    *linked = link_stages(linker);
    return false;
}

struct glsl_program *glsl_link(const struct glsl_unit *vertex, const struct glsl_unit *fragment,
                               const struct glsl_binding *bindings, unsigned count, char **log)
{
    struct glsl_linker *linker = calloc(1, sizeof *linker);
    struct glsl_program *program = NULL;
    bool linked = false;
    *log = linker ? calloc(1, GLSL_LOG_BYTES) : NULL;
    bool refused = !*log;
    if (!refused) {
        linker->log = *log;
        linker->stage[GLSL_VERTEX].unit = vertex;
        linker->stage[GLSL_FRAGMENT].unit = fragment;
        linker->binding = bindings;
        linker->bindings = count;
        refused = try_to_link(linker, &linked);
        if (!refused && linked)
            refused = !(program = make_program(linker));
        glsl_arena_free(&linker->arena);
    }
    free(linker);
    if (refused) {
        free(*log);
        *log = NULL;
        errno = ENOMEM;
    }
    return program;
}

void glsl_program_free(struct glsl_program *program)
{
    free(program);
}
