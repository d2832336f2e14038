/* Calls of the text that set states, transforms, poses, materials and lights. */
#include "command/text/parse.h"
#include "command/assets/skeleton.h"
#include "command/stream/transform.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- States --------------------------------------------------------------------------------------------- */

static const char *state_choice(const struct words *words, unsigned index)
{
    const struct triptych_state_row *state =
        triptych_state_at((enum triptych_state_table)words->count, index);
    return state ? state->name : NULL;
}

static int parse_row(struct parser *parser, enum triptych_state_table table, uint32_t *row)
{
    const struct triptych_state_row *state;
    for (*row = 0; (state = triptych_state_at(table, *row)); ++*row)
        if (lex_is(&parser->lex, state->name))
            return lex_next(&parser->lex);
    struct words states = {.at = state_choice, .count = table};
    if (table == TRIPTYCH_RENDER_STATES)
        return lex_expected_word(&parser->lex, states, "the name of a state");
    return lex_expected_word(&parser->lex, states, "the name of a %s state", triptych_table_name(table));
}

static const char *value_choice(const struct words *words, unsigned index)
{
    const struct triptych_state_row *state = words->list;
    const struct triptych_value *value = triptych_value_at(state->kind, index);
    return !value ? NULL : value->support == TRIPTYCH_SUPPORT_YES ? value->word : "";
}

/* Reports the words of a state that fit into the reason. */
static int expect_value(struct parser *parser, const struct triptych_state_row *state)
{
    struct words values = {.at = value_choice, .list = state};
    char choices[384];
    words_join(values, choices, sizeof choices);
    return lex_expected_word(&parser->lex, values, "a value of %s: %s", state->name,
                             *choices ? choices : "a number");
}

static int parse_real(struct parser *parser, const char *what, uint32_t *value)
{
    float number;
    if (lex_number(&parser->lex, what, &number))
        return -1;
    *value = triptych_float_bits(number);
    return 0;
}

/* Reads a word of the state, eight hexadecimal digits, or a number. The range is checked later, with the
 * state. */
static int parse_value(struct parser *parser, const struct triptych_state_row *state, uint32_t *value)
{
    struct lexer *lex = &parser->lex;
    char word[LIMIT_NAME_BYTES + 1];
    if (state->kind->notation == TRIPTYCH_NOTATION_REAL)
        return parse_real(parser, state->name, value);
    if (lex->token.type == TOKEN_EXPRESSION)
        return parse_integer(parser, state->name, UINT32_MAX, value);
    if (lex->token.type != TOKEN_WORD || lex->token.length > LIMIT_NAME_BYTES)
        return expect_value(parser, state);
    memcpy(word, lex->token.text, lex->token.length);
    word[lex->token.length] = 0;
    if (!triptych_value_number(state->kind, word, value))
        return lex_next(lex);
    if (word[0] == '0' && (word[1] | 32) == 'x')
        return lex_color(lex, state->name, value);
    if (word[0] >= '0' && word[0] <= '9')
        return parse_integer(parser, state->name, UINT32_MAX, value);
    return expect_value(parser, state);
}

/* The words are the names of the tables, in their order. */
int parse_set(struct parser *parser, struct call *call, unsigned word)
{
    enum triptych_state_table table = (enum triptych_state_table)word;
    call->set.table = table;
    call->set.i = 0;
    if (table != TRIPTYCH_RENDER_STATES &&
        parse_integer(parser, triptych_table_name(table), triptych_table_size(table) - 1, &call->set.i))
        return -1;
    if (parse_row(parser, table, &call->set.row))
        return -1;
    return parse_value(parser, triptych_state_at(table, call->set.row), &call->set.value);
}

int parse_convention(struct parser *parser, struct call *call, unsigned word)
{
    unsigned which, value;
    (void)word;
    if (parse_word(parser, WORDS_CONVENTION, "a convention", &which) ||
        parse_word(parser, WORDS_PIXEL_CENTER + which, "its value", &value))
        return -1;
    call->convention.which = which;
    call->convention.value = value;
    return 0;
}

/* --- Transforms ----------------------------------------------------------------------------------------- */

static const char *operation_choice(const struct words *words, unsigned index)
{
    const struct transform_operation *operation = transform_operation(index);
    (void)words;
    return operation ? operation->word : NULL;
}

int parse_operation(struct parser *parser, double made[4][4])
{
    struct lexer *lex = &parser->lex;
    const struct transform_operation *operation;
    struct token place = lex->token;
    double arguments[TRANSFORM_ARGUMENTS_MAXIMUM];
    size_t i = 0;
    while ((operation = transform_operation(i)) && !lex_is(lex, operation->word))
        i++;
    if (!operation)
        return lex_expected_word(
            lex, (struct words){.at = operation_choice},
            "identity, matrix, translate, scale, rotate, lookat, perspective or orthographic");
    if (lex_next(lex))
        return -1;
    for (size_t a = 0; a < operation->count; a++)
        if (lex_double(lex, operation->word, &arguments[a]))
            return -1;
    const char *expected = operation->make(arguments, made);
    if (expected)
        return lex_fail(lex, &place, "found another '%s', expected %s", operation->word, expected);
    return 0;
}

/* Rounds a matrix to binary32. Its numbers must be finite. */
static int parse_round(struct parser *parser, const struct token *place, double matrix[4][4], float out[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            out[i][j] = (float)matrix[i][j];
            if (!isfinite(out[i][j]))
                return lex_fail(&parser->lex, place,
                                "found a matrix with infinite values, expected finite ones");
        }
    return 0;
}

/* Reads the number of a texture matrix, or of a world matrix: the distance from the first one in the
 * enumeration. */
static int parse_transform_number(struct parser *parser, unsigned which, uint32_t *number)
{
    bool given = lex_is_digits(&parser->lex);
    if (which == TRIPTYCH_TRANSFORM_TEXTURE0)
        return parse_integer(parser, "texture matrix", 7, number);
    if (which != TRIPTYCH_TRANSFORM_WORLD || !given)
        return 0;
    if (parse_integer(parser, "world matrix", 255, number))
        return -1;
    if (*number)
        *number += TRIPTYCH_TRANSFORM_WORLD1 - 1;
    return 0;
}

/* Reads operations up to the end of the line and multiplies them. The first matrix is not multiplied by the
 * identity, which would lose the sign of its zeros. */
static int parse_operations(struct parser *parser, double matrix[4][4])
{
    struct lexer *lex = &parser->lex;
    double next[4][4];
    if (parse_operation(parser, matrix))
        return -1;
    for (int count = 1; lex->token.type != TOKEN_LINE_END && lex->token.type != TOKEN_END; count++) {
        if (count == LIMIT_OPERATIONS)
            return lex_expected(lex, "at most %d operations", LIMIT_OPERATIONS);
        if (parse_operation(parser, next))
            return -1;
        transform_multiply(matrix, next, matrix);
    }
    return 0;
}

int parse_transform_name(struct parser *parser, enum triptych_transform *which)
{
    unsigned word;
    uint32_t number = 0;
    if (parse_word(parser, WORDS_TRANSFORM, "a transform", &word) ||
        parse_transform_number(parser, word, &number))
        return -1;
    *which = (enum triptych_transform)(word + number);
    return 0;
}

/* Adds one transform per bone of the mesh. The last remains in `call`. */
static int add_pose(struct parser *parser, const struct skeleton *skeleton, double (*matrices)[4][4],
                    double world[4][4], const struct token *place, struct call *call)
{
    for (uint32_t b = 0; b < skeleton->bone_count; b++) {
        transform_multiply(matrices[b], world, matrices[b]);
        call->transform.which =
            (enum triptych_transform)(b ? TRIPTYCH_TRANSFORM_WORLD1 + b - 1 : TRIPTYCH_TRANSFORM_WORLD);
        if (parse_round(parser, place, matrices[b], call->transform.matrix) ||
            (b + 1 < skeleton->bone_count && parse_add_call(parser, call, place)))
            return -1;
    }
    return 0;
}

static int parse_animation(struct parser *parser, const struct skeleton *skeleton, int *animation)
{
    struct token place = parser->lex.token;
    char *name;
    if (lex_string(&parser->lex, "the name of an animation", &name))
        return -1;
    *animation = skeleton_find(skeleton, name);
    free(name);
    if (*animation < 0)
        return lex_fail(&parser->lex, &place,
                        "found an animation that the mesh does not have, expected %s%s%s",
                        skeleton->animation_count ? "\"" : "one with animations",
                        skeleton->animation_count ? skeleton->animations[0].name : "",
                        skeleton->animation_count ? "\"" : "");
    return 0;
}

static int parse_pose(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    struct token place = lex->token;
    double time, world[4][4];
    uint32_t mesh;
    int animation;
    if (parse_name(parser, 1 << RESOURCE_MESH, "a mesh", &mesh))
        return -1;
    const struct skeleton *skeleton = parser->stream->resources[mesh].skeleton;
    if (!skeleton)
        return lex_fail(lex, &place, "found a mesh without bones, expected one with");
    if (parse_animation(parser, skeleton, &animation) || lex_double(lex, "time", &time))
        return -1;
    if (lex->token.type == TOKEN_LINE_END || lex->token.type == TOKEN_END)
        transform_operation(0)->make(NULL, world);
    else if (parse_operations(parser, world))
        return -1;
    double(*matrices)[4][4] = malloc(skeleton->bone_count * sizeof *matrices);
    if (!matrices || skeleton_pose(skeleton, (uint32_t)animation, time, matrices)) {
        free(matrices);
        return lex_fail(lex, &place, "not enough memory");
    }
    int result = add_pose(parser, skeleton, matrices, world, &place, call);
    free(matrices);
    return result;
}

/* transform NAME OPERATION..., or pose MESH ANIMATION TIME [OPERATION...] */
int parse_transform(struct parser *parser, struct call *call, unsigned word)
{
    double matrix[4][4];
    if (word)
        return parse_pose(parser, call);
    if (parse_transform_name(parser, &call->transform.which))
        return -1;
    struct token place = parser->lex.token;
    if (parse_operations(parser, matrix))
        return -1;
    return parse_round(parser, &place, matrix, call->transform.matrix);
}

/* --- Materials and lights ------------------------------------------------------------------------------- */

int parse_material(struct parser *parser, struct call *call, unsigned word)
{
    (void)word;
    call->material = call_default_material;
    struct parse_field fields[] = {{"diffuse", call->material.diffuse, 4, false},
                                   {"ambient", call->material.ambient, 4, false},
                                   {"emissive", call->material.emissive, 4, false},
                                   {"specular", call->material.specular, 4, false},
                                   {"power", &call->material.power, 1, false}};
    return parse_fields(parser, fields, 5);
}

/* Reads the fields whose bits are set in `chosen`. */
static int parse_chosen_fields(struct parser *parser, const struct parse_field *fields, unsigned chosen)
{
    struct parse_field left[16];
    size_t count = 0;
    for (unsigned i = 0; chosen >> i; i++)
        if (chosen >> i & 1)
            left[count++] = fields[i];
    return parse_fields(parser, left, count);
}

int parse_light(struct parser *parser, struct call *call, unsigned word)
{
    struct lexer *lex = &parser->lex;
    struct triptych_light *light = &call->light.value;
    struct parse_field fields[] = {{"diffuse", light->diffuse, 4, false},
                                   {"ambient", light->ambient, 4, false},
                                   {"specular", light->specular, 4, false},
                                   {"direction", light->direction, 3, false},
                                   {"position", light->position, 3, false},
                                   {"range", &light->range, 1, false},
                                   {"attenuation", light->attenuation, 3, false},
                                   {"theta", &light->theta, 1, false},
                                   {"phi", &light->phi, 1, false},
                                   {"falloff", &light->falloff, 1, false}};
    static const struct {
        const char *word;
        unsigned fields; /* that it has */
    } types[] = {{"directional", 0x00f}, {"point", 0x077}, {"spot", 0x3ff}};
    uint32_t index;
    (void)word;
    if (parse_integer(parser, "light", TRIPTYCH_LIGHTS - 1, &index))
        return -1;
    call->light.index = index;
    *light = call_default_light;
    for (unsigned type = 0; type < sizeof types / sizeof *types; type++)
        if (lex_is(lex, types[type].word)) {
            light->type = (enum triptych_light_type)type;
            return lex_next(lex) ? -1 : parse_chosen_fields(parser, fields, types[type].fields);
        }
    if (!lex_is(lex, "on") && !lex_is(lex, "off"))
        return lex_expected_word(lex, WORDS_OF_ROWS(types), "directional, point, spot, on or off");
    call->type = CALL_ENABLE_LIGHT;
    call->light = (struct call_light){0};
    call->enable_light.index = index;
    call->enable_light.on = lex_is(lex, "on");
    return lex_next(lex);
}
