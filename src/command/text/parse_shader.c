/* Shaders in the text: definitions, bindings and constants. A shader is kept as a program and as canonical
 * text, from which the device creates it. The text between braces is kept too, for listings. */
#include "shader/program/program.h"
#include "command/assets/asset.h"
#include "command/text/parse.h"
#include "command/stream/transform.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- Definitions ---------------------------------------------------------------------------------------- */

/* Reads the lines between the braces. Line numbers in the reason start at the first of them. */
static int parse_text(struct parser *parser, struct resource *resource)
{
    struct lexer *lex = &parser->lex;
    struct token place = lex->token;
    struct error reason = {{0}};
    struct shader *shader;
    const char *text;
    size_t bytes;
    if (lex_next(lex))
        return -1;
    if (lex->token.type != TOKEN_LINE_END)
        return lex_expected(lex, "the end of the line before the text of the shader");
    if (lex_lines(lex, &text, &bytes))
        return -1;
    if (shader_assemble(resource->name, text, bytes, &shader, &reason) ||
        asset_keep_shader(resource, shader, &reason))
        return lex_fail(lex, &place, "%s", reason.text);
    resource->written = strndup(text, bytes);
    if (!resource->written)
        return lex_fail(lex, &place, "out of memory for the text of a shader");
    return lex_next(lex);
}

int parse_shader(struct parser *parser)
{
    struct resource *resource;
    if (parse_new_name(parser, RESOURCE_SHADER, &resource))
        return -1;
    struct token place = parser->lex.token;
    if (place.type != TOKEN_STRING && place.type != TOKEN_OPEN)
        return lex_expected(&parser->lex, "the path of a file in double quotes, or {");
    if (place.type == TOKEN_OPEN
            ? parse_text(parser, resource)
            : parse_path(parser, &resource->path) ||
                  parse_load(parser, resource, resource->path, &place, asset_load_shader))
        return -1;
    return parse_account(parser, &place, resource->code_bytes);
}

/* --- Setting -------------------------------------------------------------------------------------------- */

/* The words are in the order of the stages. */
int parse_set_shader(struct parser *parser, struct call *call, unsigned word)
{
    enum triptych_shader_stage stage = (enum triptych_shader_stage)word;
    const char *name = stage == TRIPTYCH_SHADER_PIXEL ? "pixel" : "vertex";
    char what[64];
    struct token place = parser->lex.token;
    snprintf(what, sizeof what, "a %s shader, or none,", name);
    call->shader.stage = stage;
    if (parse_name_or_none(parser, 1 << RESOURCE_SHADER, what, &call->resource))
        return -1;
    if (call->resource == NO_RESOURCE)
        return 0;
    const struct shader_model *model = parser->stream->resources[call->resource].program->model;
    if (model->stage != (int)stage)
        return lex_fail(&parser->lex, &place, "found a shader of model %s, expected a %s shader", model->name,
                        name);
    return 0;
}

/* --- Constants of matrices ------------------------------------------------------------------------------ */

/* Reads the modifiers of a matrix. */
static int parse_columns(struct parser *parser, uint32_t first, bool *inverse, bool *transposed,
                         uint32_t *count)
{
    static const char *const words[] = {"inverse", "transposed", "count"};
    struct lexer *lex = &parser->lex;
    struct token place = lex->token;
    int64_t columns = CONSTANTS_PER_CALL;
    if ((*inverse = lex_is(lex, "inverse")) && lex_next(lex))
        return -1;
    if ((*transposed = lex_is(lex, "transposed")) && lex_next(lex))
        return -1;
    if (lex_is(lex, "count") && (lex_next(lex) || lex_integer(lex, "count", 1, CONSTANTS_PER_CALL, &columns)))
        return -1;
    if (first + columns > TRIPTYCH_SHADER_FLOATS)
        return lex_fail(lex, &place, "found constants up to %d, expected at most %d",
                        (int)(first + columns - 1), TRIPTYCH_SHADER_FLOATS - 1);
    *count = (uint32_t)columns;
    return lex_ends_line(lex)
               ? 0
               : lex_expected_word(lex, WORDS_OF_ROWS(words), "inverse, transposed, count N, in that order");
}

static bool is_end_of_factors(const struct parser *parser)
{
    const struct lexer *lex = &parser->lex;
    return lex_ends_line(&parser->lex) || lex_is(lex, "inverse") || lex_is(lex, "transposed") ||
           lex_is(lex, "count");
}

/* Reads transforms whose values are computed when the call is executed. */
static int parse_current(struct parser *parser, struct call *call)
{
    enum triptych_shader_stage stage = call->constants.stage;
    enum triptych_transform which;
    uint32_t first = call->constants.first;
    bool inverse, transposed;
    memset(&call->constants, 0, sizeof call->constants);
    call->type = CALL_CONSTANT_MATRIX;
    call->constant_matrix.stage = stage;
    call->constant_matrix.first = first;
    for (; !is_end_of_factors(parser); call->constant_matrix.factors++) {
        if (call->constant_matrix.factors == MATRICES_PER_CALL)
            return lex_expected(&parser->lex, "at most %d transforms", MATRICES_PER_CALL);
        if (parse_transform_name(parser, &which))
            return -1;
        call->constant_matrix.factor[call->constant_matrix.factors] = (uint16_t)which;
    }
    if (parse_columns(parser, first, &inverse, &transposed, &call->constant_matrix.count))
        return -1;
    call->constant_matrix.inverse = inverse;
    call->constant_matrix.transposed = transposed;
    return 0;
}

static int parse_operations(struct parser *parser, struct call *call)
{
    struct token place = parser->lex.token;
    double matrix[4][4], next[4][4];
    bool inverse, transposed;
    if (parse_operation(parser, matrix))
        return -1;
    for (int count = 1; !is_end_of_factors(parser); count++) {
        if (count == LIMIT_OPERATIONS)
            return lex_expected(&parser->lex, "at most %d operations", LIMIT_OPERATIONS);
        if (parse_operation(parser, next))
            return -1;
        transform_multiply(matrix, next, matrix);
    }
    if (parse_columns(parser, call->constants.first, &inverse, &transposed, &call->constants.count))
        return -1;
    if (stream_store_columns(matrix, inverse, transposed, call->constants.floats))
        return lex_fail(&parser->lex, &place, "found constants that are not finite, expected a matrix%s",
                        inverse ? " with an inverse" : " of finite values");
    for (uint32_t i = call->constants.count; i < CONSTANTS_PER_CALL; i++)
        memset(call->constants.floats[i], 0, sizeof call->constants.floats[i]);
    return 0;
}

static int parse_matrix(struct parser *parser, struct call *call)
{
    const struct token *token = &parser->lex.token;
    unsigned ignored;
    if (lex_next(&parser->lex))
        return -1;
    if (token->type == TOKEN_WORD && !word_value(WORDS_TRANSFORM, token->text, token->length, &ignored))
        return parse_current(parser, call);
    return parse_operations(parser, call);
}

/* --- Constants ------------------------------------------------------------------------------------------ */

static int parse_first(struct parser *parser, enum triptych_shader_stage stage, enum call_constant_type type,
                       struct call *call)
{
    static const int64_t last[] = {[CONSTANTS_FLOAT] = TRIPTYCH_SHADER_FLOATS - 1,
                                   [CONSTANTS_INTEGER] = TRIPTYCH_SHADER_INTEGERS - 1,
                                   [CONSTANTS_BOOLEAN] = TRIPTYCH_SHADER_BOOLEANS - 1};
    memset(&call->constants, 0, sizeof call->constants);
    call->constants.stage = stage;
    call->constants.type = type;
    return parse_integer(parser, "constant", last[type], &call->constants.first);
}

/* Reads four numbers per constant, up to the end of the line. Every four constants become a call. */
static int parse_floats(struct parser *parser, enum triptych_shader_stage stage, struct call *call)
{
    struct token place = parser->lex.token;
    if (parse_first(parser, stage, CONSTANTS_FLOAT, call))
        return -1;
    if (lex_is(&parser->lex, "transform"))
        return parse_matrix(parser, call);
    do {
        if (call->constants.count == CONSTANTS_PER_CALL) {
            if (parse_add_call(parser, call, &place))
                return -1;
            call->constants.first += CONSTANTS_PER_CALL;
            call->constants.count = 0;
            memset(call->constants.floats, 0, sizeof call->constants.floats);
        }
        if (call->constants.first + call->constants.count == TRIPTYCH_SHADER_FLOATS)
            return lex_expected(&parser->lex, "the end of the line after constant %d",
                                TRIPTYCH_SHADER_FLOATS - 1);
        for (int i = 0; i < 4; i++)
            if (lex_any_number(&parser->lex, "constant X Y Z W",
                               &call->constants.floats[call->constants.count][i]))
                return -1;
        call->constants.count++;
    } while (!lex_ends_line(&parser->lex));
    return 0;
}

/* Reads one constant. The fourth number is unused and may be left out. */
static int parse_integers(struct parser *parser, enum triptych_shader_stage stage, struct call *call)
{
    if (parse_first(parser, stage, CONSTANTS_INTEGER, call))
        return -1;
    for (int i = 0; i < 4; i++) {
        int64_t value = 0;
        if (i == 3 && lex_ends_line(&parser->lex))
            break;
        if (lex_integer(&parser->lex, "constant COUNT START STEP", INT32_MIN, INT32_MAX, &value))
            return -1;
        call->constants.integers[0][i] = (int32_t)value;
    }
    call->constants.count = 1;
    return 0;
}

static int parse_booleans(struct parser *parser, enum triptych_shader_stage stage, struct call *call)
{
    static const char *const words[] = {"true", "false"};
    if (parse_first(parser, stage, CONSTANTS_BOOLEAN, call))
        return -1;
    do {
        int value = lex_is(&parser->lex, "true");
        if (!value && !lex_is(&parser->lex, "false"))
            return lex_expected_word(&parser->lex, WORDS_OF_ROWS(words), "true or false");
        if (call->constants.first + call->constants.count == TRIPTYCH_SHADER_BOOLEANS)
            return lex_expected(&parser->lex, "the end of the line after constant %d",
                                TRIPTYCH_SHADER_BOOLEANS - 1);
        call->constants.booleans[call->constants.count++] = value;
        if (lex_next(&parser->lex))
            return -1;
    } while (!lex_ends_line(&parser->lex));
    return 0;
}

/* The words are in the order of enum call_constant_type, each for both stages. */
int parse_constants(struct parser *parser, struct call *call, unsigned word)
{
    static int (*const parse[])(struct parser *, enum triptych_shader_stage,
                                struct call *) = {[CONSTANTS_FLOAT] = parse_floats,
                                                  [CONSTANTS_INTEGER] = parse_integers,
                                                  [CONSTANTS_BOOLEAN] = parse_booleans};
    return parse[word / 2](parser, (enum triptych_shader_stage)(word % 2), call);
}
