/* Shaders in the text format: their definitions, which of them are set, and their constants. A shader is kept as the
 * program that it is and as its canonical text, from which the device makes it. */
#include "shader/program.h"
#include "stream/asset.h"
#include "stream/parse.h"
#include "stream/transform.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- Definitions ------------------------------------------------------------------------------------------
 */

/* The lines between the braces. Those of the reason are counted from the first of them. */
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

/* --- Setting ----------------------------------------------------------------------------------------------
 */

static int parse_set(struct parser *parser, enum triptych_shader_stage stage, struct call *call)
{
    const char *name = stage == TRIPTYCH_SHADER_PIXEL ? "pixel" : "vertex";
    char what[64];
    struct token place = parser->lex.token;
    snprintf(what, sizeof what, "a %s shader, or none,", name);
    call->shader = stage;
    if (parse_name_or_none(parser, 1 << RESOURCE_SHADER, what, &call->resource))
        return -1;
    if (call->resource == NO_RESOURCE)
        return 0;
    const struct shader_model *model = parser->stream->resources[call->resource].program->model;
    if (model->stage != stage)
        return lex_fail(&parser->lex, &place, "found a shader of model %s, expected a %s shader", model->name,
                        name);
    return 0;
}

int parse_vertex_shader(struct parser *parser, struct call *call)
{
    return parse_set(parser, TRIPTYCH_SHADER_VERTEX, call);
}

int parse_pixel_shader(struct parser *parser, struct call *call)
{
    return parse_set(parser, TRIPTYCH_SHADER_PIXEL, call);
}

/* --- Constants of matrices --------------------------------------------------------------------------------
 */

static int at_line_end(const struct parser *parser)
{
    return parser->lex.token.type == TOKEN_LINE_END || parser->lex.token.type == TOKEN_END;
}

/* Constants are columns, as the instructions m4x4 and so on want them. */
static int store_columns(double matrix[4][4], int inverse, int transposed,
                         float constants[CONSTANTS_PER_CALL][4])
{
    int finite = 1;
    if (inverse)
        transform_invert(matrix);
    if (!transposed)
        transform_transpose(matrix);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            constants[i][j] = (float)matrix[i][j];
            finite &= isfinite(constants[i][j]) != 0;
        }
    return finite ? 0 : -1;
}

static void widen(const float from[4][4], double to[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            to[i][j] = (double)from[i][j];
}

int stream_constants(const struct call *call, const float (*transforms)[4][4],
                     float constants[CONSTANTS_PER_CALL][4])
{
    double product[4][4], next[4][4];
    widen(transforms[call->constant_matrix.factor[0]], product);
    for (uint32_t i = 1; i < call->constant_matrix.factors; i++) {
        widen(transforms[call->constant_matrix.factor[i]], next);
        transform_multiply(product, next, product);
    }
    return store_columns(product, call->constant_matrix.inverse, call->constant_matrix.transposed, constants);
}

/* What is done to the matrix, from the first word of that on. */
static int parse_columns(struct parser *parser, uint32_t first, int *inverse, int *transposed,
                         uint32_t *count)
{
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
    return at_line_end(parser) ? 0 : lex_expected(lex, "inverse, transposed, count N, in that order");
}

static int is_end_of_factors(const struct parser *parser)
{
    const struct lexer *lex = &parser->lex;
    return at_line_end(parser) || lex_is(lex, "inverse") || lex_is(lex, "transposed") || lex_is(lex, "count");
}

/* Transforms as they will be. */
static int parse_current(struct parser *parser, struct call *call)
{
    enum triptych_shader_stage stage = call->constants.stage;
    enum triptych_transform which;
    uint32_t first = call->constants.first;
    int inverse, transposed;
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
    call->constant_matrix.inverse = (uint8_t)inverse;
    call->constant_matrix.transposed = (uint8_t)transposed;
    return 0;
}

static int parse_operations(struct parser *parser, struct call *call)
{
    struct token place = parser->lex.token;
    double matrix[4][4], next[4][4];
    int inverse, transposed;
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
    if (store_columns(matrix, inverse, transposed, call->constants.floats))
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

/* --- Constants --------------------------------------------------------------------------------------------
 */

static int parse_first(struct parser *parser, enum triptych_shader_stage stage, enum constant_type type,
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

/* Four numbers a constant, as many as there are; each four constants become a call. */
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
            return lex_expected(&parser->lex, "the end of the line behind constant %d",
                                TRIPTYCH_SHADER_FLOATS - 1);
        for (int i = 0; i < 4; i++)
            if (lex_any_number(&parser->lex, "constant X Y Z W",
                               &call->constants.floats[call->constants.count][i]))
                return -1;
        call->constants.count++;
    } while (!at_line_end(parser));
    return 0;
}

/* One constant; the fourth number, which means nothing, may be left out. */
static int parse_integers(struct parser *parser, enum triptych_shader_stage stage, struct call *call)
{
    if (parse_first(parser, stage, CONSTANTS_INTEGER, call))
        return -1;
    for (int i = 0; i < 4; i++) {
        int64_t value = 0;
        if (i == 3 && at_line_end(parser))
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
    if (parse_first(parser, stage, CONSTANTS_BOOLEAN, call))
        return -1;
    do {
        int value = lex_is(&parser->lex, "true");
        if (!value && !lex_is(&parser->lex, "false"))
            return lex_expected(&parser->lex, "true or false");
        if (call->constants.first + call->constants.count == TRIPTYCH_SHADER_BOOLEANS)
            return lex_expected(&parser->lex, "the end of the line behind constant %d",
                                TRIPTYCH_SHADER_BOOLEANS - 1);
        call->constants.booleans[call->constants.count++] = value;
        if (lex_next(&parser->lex))
            return -1;
    } while (!at_line_end(parser));
    return 0;
}

int parse_vertex_constants(struct parser *parser, struct call *call)
{
    return parse_floats(parser, TRIPTYCH_SHADER_VERTEX, call);
}

int parse_pixel_constants(struct parser *parser, struct call *call)
{
    return parse_floats(parser, TRIPTYCH_SHADER_PIXEL, call);
}

int parse_vertex_integers(struct parser *parser, struct call *call)
{
    return parse_integers(parser, TRIPTYCH_SHADER_VERTEX, call);
}

int parse_pixel_integers(struct parser *parser, struct call *call)
{
    return parse_integers(parser, TRIPTYCH_SHADER_PIXEL, call);
}

int parse_vertex_booleans(struct parser *parser, struct call *call)
{
    return parse_booleans(parser, TRIPTYCH_SHADER_VERTEX, call);
}

int parse_pixel_booleans(struct parser *parser, struct call *call)
{
    return parse_booleans(parser, TRIPTYCH_SHADER_PIXEL, call);
}
