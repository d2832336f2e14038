/* Directives: each is a line whose first token is #. */
#include "front/glsl/preprocess/preprocess.h"

#include "front/glsl/context.h"

#include <string.h>

void glsl_preprocess_begin(struct glsl_context *context, const struct glsl_token *tokens)
{
    struct glsl_preprocessor *p = GLSL_NEW(&context->arena, struct glsl_preprocessor);
    struct glsl_frame *source = GLSL_NEW(&context->arena, struct glsl_frame);
    const struct glsl_token *end = tokens;
    while (end->kind != GLSL_END)
        end++;
    *source = (struct glsl_frame){.at = tokens, .end = end + 1, .source = true};
    context->preprocessor = p;
    p->reader.top = source;
    p->line_begins = true;
    p->string = -1;
    glsl_macro_predefine(context, "__VERSION__", "100");
    glsl_macro_predefine(context, "__LINE__", "0");
    glsl_macro_predefine(context, "__FILE__", "0");
    glsl_macro_predefine(context, "GL_ES", "1");
    glsl_macro_predefine(context, "GL_FRAGMENT_PRECISION_HIGH", "1");
    for (unsigned i = 0; i < GLSL_EXTENSIONS; i++)
        glsl_macro_predefine(context, glsl_extensions[i], "1");
}

/* --- #if ------------------------------------------------------------------------------------------------ */

static bool is_reading(const struct glsl_preprocessor *p)
{
    return !p->conditions || p->condition[p->conditions - 1].reading;
}

static void begin_condition(struct glsl_context *context, const struct glsl_token *word, bool holds)
{
    struct glsl_preprocessor *p = context->preprocessor;
    bool outer = is_reading(p);
    if (p->conditions == GLSL_CONDITIONS) {
        glsl_error(context, word->place, "found more than %d levels of #if", GLSL_CONDITIONS);
        return;
    }
    p->condition[p->conditions++] =
        (struct glsl_condition){word->place, outer && holds, outer && holds, false, outer};
}

static struct glsl_condition *innermost(struct glsl_context *context, const struct glsl_token *word)
{
    struct glsl_preprocessor *p = context->preprocessor;
    if (p->conditions)
        return &p->condition[p->conditions - 1];
    glsl_error(context, word->place, "found #%.*s without #if", word->length, word->text);
    return NULL;
}

static void expect_line_end(struct glsl_context *context, const struct glsl_token *line, size_t count)
{
    if (count)
        glsl_error(context, line->place, "found '%.*s', expected the end of the line", line->length,
                   line->text);
}

static void read_if(struct glsl_context *context, const struct glsl_token *word,
                    const struct glsl_token *line, size_t count)
{
    bool holds = is_reading(context->preprocessor) && glsl_condition_value(context, word->place, line, count);
    begin_condition(context, word, holds);
}

static void read_ifdef(struct glsl_context *context, const struct glsl_token *word,
                       const struct glsl_token *line, size_t count)
{
    bool reading = is_reading(context->preprocessor), named = count && line->kind == GLSL_NAME;
    if (reading && !named)
        glsl_error(context, word->place, "expected a name after #%.*s", word->length, word->text);
    if (reading && named)
        expect_line_end(context, line + 1, count - 1);
    bool defined = named && glsl_macro_find(context->preprocessor, line);
    begin_condition(context, word, defined == glsl_token_is(word, "ifdef"));
}

static void read_elif(struct glsl_context *context, const struct glsl_token *word,
                      const struct glsl_token *line, size_t count)
{
    struct glsl_condition *condition = innermost(context, word);
    if (!condition)
        return;
    if (condition->last)
        glsl_error(context, word->place, "found #elif after #else");
    bool evaluated = condition->outer && !condition->taken;
    condition->reading = evaluated && glsl_condition_value(context, word->place, line, count);
    condition->taken |= condition->reading;
}

static void read_else(struct glsl_context *context, const struct glsl_token *word,
                      const struct glsl_token *line, size_t count)
{
    struct glsl_condition *condition = innermost(context, word);
    if (!condition)
        return;
    if (condition->last)
        glsl_error(context, word->place, "found #else twice");
    if (condition->outer)
        expect_line_end(context, line, count);
    condition->reading = condition->outer && !condition->taken;
    condition->taken = condition->last = true;
}

static void read_endif(struct glsl_context *context, const struct glsl_token *word,
                       const struct glsl_token *line, size_t count)
{
    const struct glsl_condition *condition = innermost(context, word);
    if (!condition)
        return;
    if (condition->outer)
        expect_line_end(context, line, count);
    context->preprocessor->conditions--;
}

/* --- The other directives ------------------------------------------------------------------------------- */

static void read_define(struct glsl_context *context, const struct glsl_token *word,
                        const struct glsl_token *line, size_t count)
{
    glsl_macro_define(context, count ? line : word, count);
}

static void read_undef(struct glsl_context *context, const struct glsl_token *word,
                       const struct glsl_token *line, size_t count)
{
    glsl_macro_undefine(context, count ? line : word, count);
}

/* The text of a line, with a space where there was white space. */
static const char *joined(struct glsl_context *context, const struct glsl_token *line, size_t count)
{
    const char *text = "";
    for (size_t i = 0; i < count; i++)
        text = glsl_format(&context->arena, "%s%s%.*s", text, i && line[i].spaced ? " " : "", line[i].length,
                           line[i].text);
    return text;
}

static void read_error(struct glsl_context *context, const struct glsl_token *word,
                       const struct glsl_token *line, size_t count)
{
    glsl_error(context, word->place, "#error %s", joined(context, line, count));
}

/* Pragmas that are not known are ignored. */
static void read_pragma(struct glsl_context *context, const struct glsl_token *word,
                        const struct glsl_token *line, size_t count)
{
    (void)word;
    const char *text = joined(context, line, count);
    if (!strcmp(text, "STDGL invariant(all)"))
        context->unit->invariant_all = true;
}

static bool set_behavior(struct glsl_context *context, unsigned i, const struct glsl_token *behavior)
{
    static const struct {
        const char *word;
        enum glsl_behavior value;
    } words[] = {{"disable", GLSL_DISABLED},
                 {"warn", GLSL_WARNED},
                 {"enable", GLSL_ENABLED},
                 {"require", GLSL_ENABLED}};
    for (unsigned w = 0; w < sizeof words / sizeof *words; w++)
        if (glsl_token_is(behavior, words[w].word)) {
            context->behavior[i] = (uint8_t)words[w].value;
            return true;
        }
    glsl_error(context, behavior->place, "found '%.*s', expected require, enable, warn or disable",
               behavior->length, behavior->text);
    return false;
}

static void extend_all(struct glsl_context *context, const struct glsl_token *behavior)
{
    if (glsl_token_is(behavior, "enable") || glsl_token_is(behavior, "require")) {
        glsl_error(context, behavior->place, "found '%.*s' for all extensions, expected warn or disable",
                   behavior->length, behavior->text);
        return;
    }
    for (unsigned i = 0; i < GLSL_EXTENSIONS && set_behavior(context, i, behavior); i++) {
    }
}

static void read_extension(struct glsl_context *context, const struct glsl_token *word,
                           const struct glsl_token *line, size_t count)
{
    if (count != 3 || line->kind != GLSL_NAME || !glsl_token_is(&line[1], ":") || line[2].kind != GLSL_NAME) {
        glsl_error(context, word->place, "expected #extension NAME : BEHAVIOR");
        return;
    }
    if (context->preprocessor->tokens_passed)
        glsl_error(context, word->place, "found #extension after other tokens, expected it before them");
    if (glsl_token_is(line, "all")) {
        extend_all(context, &line[2]);
        return;
    }
    for (unsigned i = 0; i < GLSL_EXTENSIONS; i++)
        if (glsl_token_is(line, glsl_extensions[i])) {
            set_behavior(context, i, &line[2]);
            return;
        }
    if (glsl_token_is(&line[2], "require"))
        glsl_error(context, line->place, "the extension %.*s is not supported", line->length, line->text);
    else
        glsl_warning(context, line->place, "the extension %.*s is not supported", line->length, line->text);
}

static void read_version(struct glsl_context *context, const struct glsl_token *word,
                         const struct glsl_token *line, size_t count)
{
    if (context->version_read)
        glsl_error(context, word->place, "found #version after other tokens, expected it at the beginning");
    else if (count != 1 || !glsl_token_is(line, "100"))
        glsl_error(context, count ? line->place : word->place,
                   "found another version of the language, expected 100");
}

static void read_line(struct glsl_context *context, const struct glsl_token *word,
                      const struct glsl_token *line, size_t count)
{
    struct glsl_preprocessor *p = context->preprocessor;
    struct glsl_list list = glsl_expand_all(context, line, count, false);
    if (!list.count) {
        glsl_error(context, word->place, "expected a number after #line");
        return;
    }
    /* The last of several tokens is the string, unless they are one expression. */
    bool two = list.count > 1 && list.token[list.count - 1].kind == GLSL_NUMBER &&
               list.token[list.count - 2].kind != GLSL_PUNCTUATOR;
    long number = glsl_condition_value(context, word->place, list.token, list.count - two);
    if (two)
        p->string = (int)glsl_condition_value(context, word->place, &list.token[list.count - 1], 1);
    p->line_shift += number - (long)word->place.line;
}

typedef void directive(struct glsl_context *context, const struct glsl_token *word,
                       const struct glsl_token *line, size_t count);

static const struct {
    const char *word;
    directive *read;
    bool always; /* in parts that are not read too */
} directives[] = {
    {"if", read_if, true},
    {"ifdef", read_ifdef, true},
    {"ifndef", read_ifdef, true},
    {"elif", read_elif, true},
    {"else", read_else, true},
    {"endif", read_endif, true},
    {"define", read_define, false},
    {"undef", read_undef, false},
    {"error", read_error, false},
    {"pragma", read_pragma, false},
    {"extension", read_extension, false},
    {"version", read_version, false},
    {"line", read_line, false},
};

enum { DIRECTIVES = sizeof directives / sizeof *directives };

/* --- Reading -------------------------------------------------------------------------------------------- */

void glsl_preprocess_place(const struct glsl_preprocessor *p, struct glsl_token *token)
{
    token->place.line = (uint32_t)((long)token->place.line + p->line_shift);
    if (p->string >= 0)
        token->place.string = (uint16_t)p->string;
}

/* The tokens of the source to the end of the line, which is read. */
static struct glsl_list rest_of_line(struct glsl_context *context)
{
    struct glsl_preprocessor *p = context->preprocessor;
    struct glsl_frame *source = p->reader.top;
    struct glsl_list line = {0};
    while (source->at->kind != GLSL_LINE_END && source->at->kind != GLSL_END) {
        struct glsl_token token = *source->at++;
        glsl_preprocess_place(p, &token);
        glsl_list_add(context, &line, &token);
    }
    if (source->at->kind == GLSL_LINE_END)
        source->at++;
    return line;
}

static void read_directive(struct glsl_context *context, struct glsl_place hash)
{
    struct glsl_preprocessor *p = context->preprocessor;
    struct glsl_list line = rest_of_line(context);
    bool reading = is_reading(p);
    if (!line.count)
        return;
    const struct glsl_token *word = line.token;
    for (int i = 0; i < DIRECTIVES; i++)
        if (glsl_token_is(word, directives[i].word)) {
            if (reading || directives[i].always)
                directives[i].read(context, word, word + 1, line.count - 1);
            context->version_read |= reading;
            return;
        }
    if (reading)
        glsl_error(context, hash, "found #%.*s, expected a directive", word->length, word->text);
}

/* Reads directives and skips what conditions leave out, at the beginning of a line of the source. */
static void read_directives(struct glsl_context *context)
{
    struct glsl_preprocessor *p = context->preprocessor;
    struct glsl_frame *source = p->reader.top;
    while (source->at->kind != GLSL_END) {
        if (glsl_token_is(source->at, "#")) {
            struct glsl_token hash = *source->at++;
            glsl_preprocess_place(p, &hash);
            read_directive(context, hash.place);
        } else if (!is_reading(p)) {
            rest_of_line(context);
        } else if (source->at->kind == GLSL_LINE_END) {
            source->at++;
        } else {
            return;
        }
    }
}

static bool at_source(const struct glsl_preprocessor *p)
{
    return p->reader.top && !p->reader.top->below;
}

static void end_conditions(struct glsl_context *context)
{
    struct glsl_preprocessor *p = context->preprocessor;
    if (p->conditions)
        glsl_error(context, p->condition[p->conditions - 1].place, "found no #endif for this #if");
    p->conditions = 0;
}

struct glsl_token glsl_preprocess_next(struct glsl_context *context)
{
    struct glsl_preprocessor *p = context->preprocessor;
    struct glsl_token token = {.kind = GLSL_END};
    for (;;) {
        if (p->line_begins && at_source(p))
            read_directives(context);
        p->line_begins = false;
        if (!glsl_expand_next(context, &p->reader, &token) || token.kind == GLSL_END) {
            end_conditions(context);
            return token;
        }
        if (token.kind == GLSL_LINE_END) {
            p->line_begins = true;
            continue;
        }
        context->version_read = p->tokens_passed = true;
        return token;
    }
}
