#include "front/glsl/symbol.h"

#include "front/glsl/context.h"

#include <string.h>

static unsigned slot_of(const char *name)
{
    unsigned hash = 2166136261u;
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 16777619u;
    return hash % GLSL_SYMBOL_SLOTS;
}

void glsl_scopes_begin(struct glsl_context *context)
{
    struct glsl_scopes *scopes = &context->scopes;
    bool vertex = context->stage == GLSL_VERTEX;
    scopes->depth = 1;
    struct glsl_scope *global = &scopes->scope[1];
    global->precision[GLSL_FLOAT] = vertex ? GLSL_HIGH : GLSL_NO_PRECISION;
    global->precision[GLSL_INT] = vertex ? GLSL_HIGH : GLSL_MEDIUM;
    global->precision[GLSL_SAMPLER_2D] = global->precision[GLSL_SAMPLER_CUBE] = GLSL_LOW;
}

void glsl_scope_open(struct glsl_context *context, struct glsl_place place)
{
    struct glsl_scopes *scopes = &context->scopes;
    if (scopes->depth + 1 == GLSL_SCOPES) {
        glsl_error(context, place, "found more than %d scopes inside of each other", GLSL_SCOPES - 2);
        longjmp(context->arena.refused, 2);
    }
    scopes->scope[scopes->depth + 1] = scopes->scope[scopes->depth];
    scopes->scope[++scopes->depth].newest = NULL;
}

void glsl_scope_close(struct glsl_context *context)
{
    struct glsl_scopes *scopes = &context->scopes;
    struct glsl_symbol *symbol = scopes->scope[scopes->depth--].newest;
    for (; symbol; symbol = symbol->older)
        scopes->slot[slot_of(symbol->name)] = symbol->hidden;
}

struct glsl_symbol *glsl_symbol_find(struct glsl_context *context, const char *name)
{
    struct glsl_symbol *symbol = context->scopes.slot[slot_of(name)];
    while (symbol && strcmp(symbol->name, name))
        symbol = symbol->hidden;
    return symbol;
}

static struct glsl_symbol *add(struct glsl_context *context, enum glsl_symbol_kind kind, const char *name,
                               unsigned depth)
{
    struct glsl_scopes *scopes = &context->scopes;
    struct glsl_symbol *symbol = GLSL_NEW(&context->arena, struct glsl_symbol);
    struct glsl_symbol **slot = &scopes->slot[slot_of(name)];
    symbol->kind = (uint8_t)kind;
    symbol->depth = (uint16_t)depth;
    symbol->name = name;
    symbol->hidden = *slot;
    symbol->older = scopes->scope[depth].newest;
    *slot = scopes->scope[depth].newest = symbol;
    return symbol;
}

struct glsl_symbol *glsl_symbol_predefine(struct glsl_context *context, enum glsl_symbol_kind kind,
                                          const char *name)
{
    return add(context, kind, name, 0);
}

struct glsl_symbol *glsl_symbol_add(struct glsl_context *context, enum glsl_symbol_kind kind,
                                    const char *name, struct glsl_place place)
{
    struct glsl_symbol *old = glsl_symbol_find(context, name);
    if (!strncmp(name, "gl_", 3))
        glsl_error(context, place, "found '%s', expected a name that does not begin with gl_", name);
    else if (strstr(name, "__"))
        glsl_error(context, place, "found '%s', expected a name without two underscores", name);
    else if (old && old->depth == context->scopes.depth)
        glsl_error(context, place, "found '%s', which is already declared in this scope", name);
    else
        return add(context, kind, name, context->scopes.depth);
    return NULL;
}
