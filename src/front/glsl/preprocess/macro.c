/* Macros: their table and their expansion. An argument is expanded by itself before it replaces its
 * parameter. */
#include "front/glsl/context.h"
#include "front/glsl/preprocess/preprocess.h"

#include <stdio.h>
#include <string.h>

void glsl_list_add(struct glsl_context *context, struct glsl_list *list, const struct glsl_token *token)
{
    if (list->count == list->capacity) {
        size_t capacity = list->capacity ? 2 * list->capacity : 8;
        struct glsl_token *grown = glsl_take(&context->arena, capacity * sizeof *grown);
        if (list->count)
            memcpy(grown, list->token, list->count * sizeof *grown);
        list->token = grown;
        list->capacity = capacity;
    }
    list->token[list->count++] = *token;
}

/* --- The table ------------------------------------------------------------------------------------------ */

static unsigned slot_of(const char *text, unsigned length)
{
    unsigned hash = 2166136261u;
    for (unsigned i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)text[i]) * 16777619u;
    return hash % GLSL_MACRO_SLOTS;
}

static struct glsl_macro *find(struct glsl_preprocessor *p, const struct glsl_token *name)
{
    struct glsl_macro *macro = p->slot[slot_of(name->text, name->length)];
    while (macro && !glsl_token_is(name, macro->name))
        macro = macro->next;
    return macro;
}

struct glsl_macro *glsl_macro_find(struct glsl_preprocessor *p, const struct glsl_token *name)
{
    struct glsl_macro *macro = find(p, name);
    return macro && macro->defined ? macro : NULL;
}

static struct glsl_macro *find_or_add(struct glsl_context *context, const struct glsl_token *name)
{
    struct glsl_preprocessor *p = context->preprocessor;
    struct glsl_macro *macro = find(p, name), **slot = &p->slot[slot_of(name->text, name->length)];
    if (macro)
        return macro;
    macro = GLSL_NEW(&context->arena, struct glsl_macro);
    macro->name = glsl_copy(&context->arena, name->text, name->length);
    macro->next = *slot;
    return *slot = macro;
}

void glsl_macro_predefine(struct glsl_context *context, const char *name, const char *number)
{
    struct glsl_token token = {.kind = GLSL_NAME, .text = name, .length = (uint16_t)strlen(name)};
    struct glsl_token value = {.kind = GLSL_NUMBER, .text = number, .length = (uint16_t)strlen(number)};
    struct glsl_macro *macro = find_or_add(context, &token);
    macro->defined = macro->predefined = true;
    glsl_list_add(context, &macro->body, &value);
}

/* Returns true if #define and #undef may name it; reports why not. */
static bool is_free(struct glsl_context *context, const struct glsl_token *name)
{
    struct glsl_macro *macro = glsl_macro_find(context->preprocessor, name);
    if (glsl_token_is(name, "defined") || (macro && macro->predefined))
        glsl_error(context, name->place, "found '%.*s', which is predefined, expected another name",
                   name->length, name->text);
    else if (name->length >= 3 && !memcmp(name->text, "GL_", 3))
        glsl_error(context, name->place, "found '%.*s', expected a name that does not begin with GL_",
                   name->length, name->text);
    else
        return true;
    return false;
}

/* The parameters between parentheses; returns the number of tokens read, 0 after an error. */
static size_t read_parameters(struct glsl_context *context, struct glsl_macro *macro,
                              const struct glsl_token *line, size_t count)
{
    struct glsl_list names = {0};
    size_t at = 1;
    bool more = at < count && !glsl_token_is(&line[at], ")");
    while (more && at + 1 < count && line[at].kind == GLSL_NAME) {
        for (size_t i = 0; i < names.count; i++)
            if (line[at].length == names.token[i].length &&
                !memcmp(line[at].text, names.token[i].text, line[at].length))
                glsl_error(context, line[at].place, "found the parameter '%.*s' twice", line[at].length,
                           line[at].text);
        glsl_list_add(context, &names, &line[at++]);
        more = glsl_token_is(&line[at], ",");
        at += more;
    }
    if (more || at >= count || !glsl_token_is(&line[at], ")")) {
        glsl_error(context, line[at < count ? at : count - 1].place, "expected names of parameters and )");
        return 0;
    }
    macro->parameter = names.token;
    macro->parameters = (unsigned)names.count;
    return at + 1;
}

/* White space counts between the tokens of a body, and not between parameters. */
static bool same_tokens(const struct glsl_token *a, const struct glsl_token *b, size_t count, bool spaces)
{
    for (size_t i = 0; i < count; i++)
        if (a[i].length != b[i].length || memcmp(a[i].text, b[i].text, a[i].length) ||
            (spaces && i && a[i].spaced != b[i].spaced))
            return false;
    return true;
}

static bool same_macro(const struct glsl_macro *a, const struct glsl_macro *b)
{
    return a->function == b->function && a->parameters == b->parameters && a->body.count == b->body.count &&
           same_tokens(a->parameter, b->parameter, a->parameters, false) &&
           same_tokens(a->body.token, b->body.token, a->body.count, true);
}

void glsl_macro_define(struct glsl_context *context, const struct glsl_token *line, size_t count)
{
    const struct glsl_token *name = line;
    size_t at = 1;
    if (!count || name->kind != GLSL_NAME) {
        glsl_error(context, name->place, "expected a name after #define");
        return;
    }
    if (!is_free(context, name))
        return;
    struct glsl_macro made = {.name = NULL};
    made.function = count > 1 && glsl_token_is(&line[1], "(") && !line[1].spaced;
    if (made.function) {
        size_t read = read_parameters(context, &made, line + 1, count - 1);
        if (!read)
            return;
        at += read;
    }
    for (; at < count; at++)
        glsl_list_add(context, &made.body, &line[at]);
    struct glsl_macro *macro = find_or_add(context, name);
    if (macro->defined && !same_macro(macro, &made)) {
        glsl_error(context, name->place,
                   "found another definition of '%s', expected the same or #undef before", macro->name);
        return;
    }
    made.name = macro->name;
    made.next = macro->next;
    made.defined = true;
    *macro = made;
}

void glsl_macro_undefine(struct glsl_context *context, const struct glsl_token *line, size_t count)
{
    if (!count || line->kind != GLSL_NAME) {
        glsl_error(context, line->place, "expected a name after #undef");
        return;
    }
    if (count > 1)
        glsl_error(context, line[1].place, "found '%.*s', expected the end of the line", line[1].length,
                   line[1].text);
    struct glsl_macro *macro = glsl_macro_find(context->preprocessor, line);
    if (is_free(context, line) && macro)
        macro->defined = false;
}

/* --- Expansion ------------------------------------------------------------------------------------------ */

static void push(struct glsl_context *context, struct glsl_reader *reader, const struct glsl_token *token,
                 size_t count, struct glsl_macro *macro)
{
    struct glsl_frame *frame = GLSL_NEW(&context->arena, struct glsl_frame);
    const struct glsl_token *end = count ? token + count : token; /* an empty list has no memory */
    *frame = (struct glsl_frame){reader->top, token, end, macro, false};
    reader->top = frame;
    if (macro)
        macro->active = true;
}

static void pop(struct glsl_reader *reader)
{
    if (reader->top->macro)
        reader->top->macro->active = false;
    reader->top = reader->top->below;
}

static bool read_raw(struct glsl_context *context, struct glsl_reader *reader, struct glsl_token *token)
{
    while (reader->top && reader->top->at == reader->top->end)
        pop(reader);
    if (!reader->top)
        return false;
    *token = *reader->top->at++;
    if (reader->top->source)
        glsl_preprocess_place(context->preprocessor, token);
    return true;
}

/* Returns true if the next token, after line ends, is an opening parenthesis. */
static bool parenthesis_follows(const struct glsl_reader *reader)
{
    for (const struct glsl_frame *frame = reader->top; frame; frame = frame->below)
        for (const struct glsl_token *at = frame->at; at < frame->end; at++)
            if (at->kind != GLSL_LINE_END)
                return glsl_token_is(at, "(");
    return false;
}

/* Reads the arguments after the name, with their parentheses. Returns their number; -1 after an error. */
static int read_arguments(struct glsl_context *context, struct glsl_reader *reader,
                          const struct glsl_macro *macro, struct glsl_list *argument,
                          const struct glsl_token *name)
{
    unsigned depth = 0, count = 0;
    struct glsl_token token;
    while (read_raw(context, reader, &token) && token.kind != GLSL_END) {
        if (token.kind == GLSL_LINE_END)
            continue;
        bool opens = glsl_token_is(&token, "("), closes = glsl_token_is(&token, ")");
        if (closes && --depth == 0)
            return (int)count + 1;
        if (depth == 1 && glsl_token_is(&token, ","))
            count++;
        else if (depth && count < macro->parameters + !macro->parameters)
            glsl_list_add(context, &argument[count], &token);
        depth += opens;
    }
    glsl_error(context, name->place, "found no ) after the arguments of the macro '%s'", macro->name);
    return -1;
}

static int parameter_of(const struct glsl_macro *macro, const struct glsl_token *token)
{
    for (unsigned i = 0; i < macro->parameters; i++)
        if (token->length == macro->parameter[i].length &&
            !memcmp(token->text, macro->parameter[i].text, token->length))
            return (int)i;
    return -1;
}

/* The body with the arguments instead of the parameters. All tokens get the place of the macro's name. */
static struct glsl_list substitute(struct glsl_context *context, const struct glsl_macro *macro,
                                   struct glsl_list *argument, struct glsl_place place)
{
    struct glsl_list result = {0};
    for (unsigned i = 0; i < macro->parameters; i++)
        argument[i] = glsl_expand_all(context, argument[i].token, argument[i].count, false);
    for (size_t i = 0; i < macro->body.count; i++) {
        const struct glsl_token *token = &macro->body.token[i];
        int parameter = parameter_of(macro, token);
        if (parameter < 0)
            glsl_list_add(context, &result, token);
        else
            for (size_t j = 0; j < argument[parameter].count; j++)
                glsl_list_add(context, &result, &argument[parameter].token[j]);
    }
    for (size_t i = 0; i < result.count; i++)
        result.token[i].place = place;
    return result;
}

/* Returns true if a bound is exceeded. */
static bool is_too_large(struct glsl_context *context, const struct glsl_token *name, size_t count)
{
    struct glsl_preprocessor *p = context->preprocessor;
    p->expansions += (unsigned)(count < GLSL_EXPANSIONS ? count + 1 : GLSL_EXPANSIONS);
    if (p->expansions <= GLSL_EXPANSIONS)
        return false;
    p->expansions = GLSL_EXPANSIONS;
    glsl_error(context, name->place, "found macros that expand to more than %d tokens", GLSL_EXPANSIONS);
    return true;
}

/* Puts the expansion of a macro on the reader. Returns false if its name is not a call. */
static bool expand(struct glsl_context *context, struct glsl_reader *reader, struct glsl_macro *macro,
                   const struct glsl_token *name)
{
    struct glsl_list *argument = NULL;
    if (macro->function) {
        if (!parenthesis_follows(reader))
            return false;
        argument = glsl_take(&context->arena, (macro->parameters + 1) * sizeof *argument);
        int count = read_arguments(context, reader, macro, argument, name);
        bool empty = count == 1 && !macro->parameters && !argument[0].count;
        if (count >= 0 && !empty && (unsigned)count != macro->parameters)
            glsl_error(context, name->place, "found %d arguments of the macro '%s', expected %u", count,
                       macro->name, macro->parameters);
    }
    struct glsl_list body = substitute(context, macro, argument, name->place);
    if (!is_too_large(context, name, body.count))
        push(context, reader, body.token, body.count, macro);
    return true;
}

/* __LINE__ and __FILE__. */
static bool expand_place(struct glsl_context *context, struct glsl_token *token)
{
    bool line = glsl_token_is(token, "__LINE__");
    if (!line && !glsl_token_is(token, "__FILE__"))
        return false;
    token->text = glsl_format(&context->arena, "%u", line ? token->place.line : token->place.string);
    token->length = (uint16_t)strlen(token->text);
    token->kind = GLSL_NUMBER;
    return true;
}

/* Returns true if a token of a condition is `defined`, the parenthesis after it, or the name. */
static bool belongs_to_defined(struct glsl_reader *reader, const struct glsl_token *token)
{
    bool word = glsl_token_is(token, "defined"), belongs = reader->defined;
    if (!reader->condition)
        return false;
    reader->defined = word || (belongs && glsl_token_is(token, "("));
    return word || belongs;
}

bool glsl_expand_next(struct glsl_context *context, struct glsl_reader *reader, struct glsl_token *token)
{
    while (read_raw(context, reader, token)) {
        if (belongs_to_defined(reader, token))
            return true;
        if (token->kind != GLSL_NAME || token->painted || expand_place(context, token))
            return true;
        struct glsl_macro *macro = glsl_macro_find(context->preprocessor, token);
        if (macro && macro->active)
            token->painted = true;
        if (!macro || macro->active || !expand(context, reader, macro, token))
            return true;
    }
    return false;
}

struct glsl_list glsl_expand_all(struct glsl_context *context, const struct glsl_token *token, size_t count,
                                 bool condition)
{
    struct glsl_preprocessor *p = context->preprocessor;
    struct glsl_list result = {0};
    struct glsl_reader reader = {.condition = condition};
    struct glsl_token next;
    if (p->depth == GLSL_EXPANSION_DEPTH) {
        if (count)
            glsl_error(context, token->place, "found macros in %d levels of arguments", GLSL_EXPANSION_DEPTH);
        return result;
    }
    p->depth++;
    push(context, &reader, token, count, NULL);
    while (glsl_expand_next(context, &reader, &next))
        glsl_list_add(context, &result, &next);
    p->depth--;
    return result;
}
