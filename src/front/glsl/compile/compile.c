#include "front/glsl/glsl.h"

#include "front/glsl/check/builtin.h"
#include "front/glsl/preprocess/preprocess.h"
#include "front/glsl/token.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const struct glsl_limits default_limits = {
    .vertex_attributes = 16,
    .vertex_uniform_vectors = 256,
    .varying_vectors = 8,
    .vertex_samplers = 4,
    .samplers = 20,
    .pixel_samplers = 16,
    .pixel_uniform_vectors = 224,
    .draw_buffers = 4,
    .dual_source_draw_buffers = 1,
};

static void compile(struct glsl_context *context, const char *const *strings, const int *lengths,
                    unsigned count)
{
    struct glsl_unit *unit = GLSL_NEW(&context->arena, struct glsl_unit);
    context->unit = unit;
    unit->stage = context->stage;
    unit->last_global = &unit->global;
    unit->last_function = &unit->function;
    unit->last_initial = &unit->initial;
    glsl_builtin_begin(context);
    glsl_scopes_begin(context);
    glsl_preprocess_begin(context, glsl_tokens(context, strings, lengths, count));
    glsl_parse(context);
    if (!context->log.errors)
        glsl_check_unit(context, context->found.place);
}

/* The jump from the arena comes back here: 1 if memory was refused, 2 after an error that ends the
 * compilation. */
static int try_to_compile(struct glsl_context *context, const char *const *strings, const int *lengths,
                          unsigned count)
{
    int reason = setjmp(context->arena.refused);
    if (!reason)
        compile(context, strings, lengths, count);
    return reason;
}

struct glsl_unit *glsl_compile(enum glsl_stage stage, const char *const *strings, const int *lengths,
                               unsigned count, const struct glsl_limits *limits, char **log)
{
    struct glsl_context *context = calloc(1, sizeof *context);
    struct glsl_unit *unit = NULL;
    *log = context ? calloc(1, GLSL_LOG_BYTES) : NULL;
    if (!*log) {
        free(context);
        errno = ENOMEM;
        return NULL;
    }
    context->stage = stage;
    context->limits = limits ? *limits : default_limits;
    context->log.text = *log;
    bool refused = try_to_compile(context, strings, lengths, count) == 1;
    if (!refused && !context->log.errors) {
        unit = context->unit;
        unit->arena = context->arena;
    } else {
        glsl_arena_free(&context->arena);
    }
    free(context);
    if (refused) {
        free(*log);
        *log = NULL;
        errno = ENOMEM;
    }
    return unit;
}

void glsl_unit_free(struct glsl_unit *unit)
{
    if (!unit)
        return;
    struct glsl_arena arena = unit->arena; /* which contains the unit */
    glsl_arena_free(&arena);
}
