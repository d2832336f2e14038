#include "front/glsl/compile/lex.h"

#include "front/glsl/check/check.h"
#include "front/glsl/preprocess/preprocess.h"
#include "glsl_grammar.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *word;
    int token;
} keywords[] = {
#define GLSL_KEYWORD(word, token) {word, token},
#include "front/glsl/compile/keyword.def"
#undef GLSL_KEYWORD
};

static const struct {
    char text[4];
    int token;
} operators[] = {
    {"<<=", OTHER_ASSIGN},
    {">>=", OTHER_ASSIGN},
    {"&=", OTHER_ASSIGN},
    {"|=", OTHER_ASSIGN},
    {"^=", OTHER_ASSIGN},
    {"++", INC},
    {"--", DEC},
    {"<<", LEFT},
    {">>", RIGHT},
    {"<=", LE},
    {">=", GE},
    {"==", EQ},
    {"!=", NE},
    {"&&", AND},
    {"||", OR},
    {"^^", XOR},
    {"*=", MUL_ASSIGN},
    {"/=", DIV_ASSIGN},
    {"+=", ADD_ASSIGN},
    {"-=", SUB_ASSIGN},
    {"%=", MOD_ASSIGN},
};

const char *glsl_lex_found(struct glsl_context *context)
{
    const struct glsl_token *found = &context->found;
    if (found->kind == GLSL_END)
        return "the end of the source";
    return glsl_format(&context->arena, "'%.*s'", found->length, found->text);
}

struct glsl_type glsl_lex_record(const char *name, struct glsl_context *context)
{
    const struct glsl_symbol *symbol = glsl_symbol_find(context, name);
    struct glsl_type type = glsl_type_of(GLSL_STRUCT, 1, 1);
    type.record = symbol->record;
    return type;
}

/* --- Numbers -------------------------------------------------------------------------------------------- */

static int whole_number(struct glsl_context *context, const char *text, union GLSL_GRAMMAR_STYPE *value)
{
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 0);
    if (*end)
        glsl_error(context, context->found.place, "found '%s', expected a whole number in base 8, 10 or 16",
                   text);
    else if (errno || number > UINT32_MAX)
        glsl_error(context, context->found.place, "found '%s', expected at most 32 bits", text);
    value->whole = (int32_t)(uint32_t)number;
    return INTEGER;
}

static int real_number(struct glsl_context *context, const char *text, union GLSL_GRAMMAR_STYPE *value)
{
    char *end;
    value->real = strtof(text, &end);
    if (*end)
        glsl_error(context, context->found.place, "found '%s', expected a number such as 1.5 or 2e3", text);
    return REAL;
}

static int number(struct glsl_context *context, const struct glsl_token *token,
                  union GLSL_GRAMMAR_STYPE *value)
{
    const char *text = glsl_copy(&context->arena, token->text, token->length);
    bool hexadecimal = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    return !hexadecimal && strpbrk(text, ".eE") ? real_number(context, text, value)
                                                : whole_number(context, text, value);
}

/* --- Words ---------------------------------------------------------------------------------------------- */

static int name(struct glsl_context *context, const struct glsl_token *token, union GLSL_GRAMMAR_STYPE *value)
{
    value->name = glsl_copy(&context->arena, token->text, token->length);
    const struct glsl_symbol *symbol = glsl_symbol_find(context, value->name);
    bool is_type =
        symbol && symbol->kind == GLSL_RECORD_SYMBOL && !context->after_type && !context->after_point;
    return is_type ? TYPE_NAME : IDENTIFIER;
}

static int word(struct glsl_context *context, const struct glsl_token *token, union GLSL_GRAMMAR_STYPE *value)
{
    for (unsigned i = 0; i < sizeof keywords / sizeof *keywords; i++)
        if (glsl_token_is(token, keywords[i].word))
            return keywords[i].token;
    if (glsl_token_is(token, "layout") && context->stage == GLSL_FRAGMENT &&
        context->behavior[GLSL_KHR_BLEND_EQUATION_ADVANCED])
        return LAYOUT; /* a name without the extension */
    return name(context, token, value);
}

static int punctuator(const struct glsl_token *token)
{
    for (unsigned i = 0; i < sizeof operators / sizeof *operators; i++)
        if (glsl_token_is(token, operators[i].text))
            return operators[i].token;
    return token->length == 1 && !strchr("#%&|^", token->text[0]) ? token->text[0] : STRAY;
}

static bool is_type_token(int token)
{
    static const int types[] = {BOOL,      BVEC2,       BVEC3, BVEC4, FLOAT,    INT,  IVEC2,
                                IVEC3,     IVEC4,       MAT2,  MAT3,  MAT4,     VEC2, VEC3,
                                SAMPLER2D, SAMPLERCUBE, VEC4,  VOID,  TYPE_NAME};
    for (unsigned i = 0; i < sizeof types / sizeof *types; i++)
        if (types[i] == token)
            return true;
    return false;
}

int glsl_grammar_lex(union GLSL_GRAMMAR_STYPE *value, struct glsl_place *place, struct glsl_context *context)
{
    struct glsl_token token = glsl_preprocess_next(context);
    int result = STRAY;
    context->found = token;
    *place = token.place;
    switch ((enum glsl_token_kind)token.kind) {
    case GLSL_END: result = END; break;
    case GLSL_NAME: result = word(context, &token, value); break;
    case GLSL_NUMBER: result = number(context, &token, value); break;
    case GLSL_PUNCTUATOR: result = punctuator(&token); break;
    case GLSL_LINE_END:
    case GLSL_STRAY: break;
    }
    context->after_type = is_type_token(result);
    context->after_point = result == '.';
    return result;
}
