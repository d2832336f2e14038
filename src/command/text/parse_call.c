/* Calls of the text. The functions check only the words and numbers of a line. The effect of a call is
 * checked later (command/stream/follow.h). */
#include "render/texture/format.h"
#include "command/text/parse.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- Parts of calls ------------------------------------------------------------------------------------- */

int parse_word(struct parser *parser, enum word_list list, const char *what, unsigned *value)
{
    const struct token *token = &parser->lex.token;
    if (token->type == TOKEN_WORD && !word_value(list, token->text, token->length, value))
        return lex_next(&parser->lex);
    char choices[384];
    words_join(word_list(list), choices, sizeof choices);
    return lex_expected_word(&parser->lex, word_list(list), "%s: %s", what, choices);
}

int parse_integer(struct parser *parser, const char *what, int64_t high, uint32_t *value)
{
    int64_t integer;
    if (lex_integer(&parser->lex, what, 0, high, &integer))
        return -1;
    *value = (uint32_t)integer;
    return 0;
}

static int parse_field(struct parser *parser, struct parse_field *fields, size_t count)
{
    struct lexer *lex = &parser->lex;
    const struct words words = {words_row, fields, (unsigned)count, sizeof *fields};
    char choices[128] = "";
    size_t at = 0, i = 0;
    while (i < count && (fields[i].given || !lex_is(lex, fields[i].word)))
        i++;
    for (size_t j = 0; i == count && j < count; j++)
        if (!fields[j].given)
            at += (size_t)snprintf(choices + at, sizeof choices - at, "%s, ", fields[j].word);
    if (i == count)
        return lex_expected_word(lex, words, "%sor the end of the line", choices);
    fields[i].given = true;
    return lex_next(lex) || lex_numbers(lex, fields[i].word, fields[i].numbers, fields[i].count) ? -1 : 0;
}

int parse_fields(struct parser *parser, struct parse_field *fields, size_t count)
{
    while (!lex_ends_line(&parser->lex))
        if (parse_field(parser, fields, count))
            return -1;
    return 0;
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

static const char *format_choice(const struct words *words, unsigned index)
{
    const struct format *format = format_at(index);
    return !format ? NULL : (format->roles & words->count) == words->count ? format->name : "";
}

int parse_expect_format(struct parser *parser, unsigned role, const char *what)
{
    struct words formats = {.at = format_choice, .count = role};
    return lex_expected_word(&parser->lex, formats, "%s", what);
}

static int parse_depth_format(struct parser *parser, struct triptych_target_description *target)
{
    unsigned format;
    if (lex_next(&parser->lex) || parse_word(parser, WORDS_DEPTH, "a depth format", &format))
        return -1;
    target->depth_format = (enum triptych_depth_format)format;
    return 0;
}

int parse_color_format(struct parser *parser, enum triptych_surface_format *result)
{
    struct lexer *lex = &parser->lex;
    const struct format *format =
        lex->token.type == TOKEN_WORD ? format_named(lex->token.text, lex->token.length) : NULL;
    if (!format || !(format->roles & ROLE_TARGET))
        return parse_expect_format(parser, ROLE_TARGET, "the name of a format that can be a target");
    *result = (enum triptych_surface_format)format->number;
    return lex_next(lex);
}

/* One to four formats. */
static int parse_color_formats(struct parser *parser, struct triptych_target_description *target)
{
    struct lexer *lex = &parser->lex;
    if (lex_next(lex))
        return -1;
    for (unsigned t = 0; t < TRIPTYCH_TARGETS; t++) {
        const struct format *format =
            lex->token.type == TOKEN_WORD ? format_named(lex->token.text, lex->token.length) : NULL;
        if (!format && t)
            return 0;
        if (parse_color_format(parser, &target->color_format[t]))
            return -1;
    }
    return 0;
}

static int parse_samples(struct parser *parser, struct triptych_target_description *target)
{
    int64_t samples;
    struct token place = parser->lex.token;
    if (lex_next(&parser->lex) || lex_integer(&parser->lex, "samples per pixel", 1, 8, &samples))
        return -1;
    if (samples & (samples - 1))
        return lex_fail(&parser->lex, &place, "found %d samples, expected 1, 2, 4 or 8", (int)samples);
    target->samples = (unsigned)samples;
    return 0;
}

static int parse_target_formats(struct parser *parser, struct triptych_target_description *target)
{
    struct token place = parser->lex.token;
    if (lex_is(&parser->lex, "depth") && parse_depth_format(parser, target))
        return -1;
    if (lex_is(&parser->lex, "samples") && parse_samples(parser, target))
        return -1;
    if (lex_is(&parser->lex, "color") && parse_color_formats(parser, target))
        return -1;
    if (target->samples > 1 && target->color_format[1])
        return lex_fail(&parser->lex, &place, "found several colours, expected one with %u samples",
                        target->samples);
    return 0;
}

int parse_target(struct parser *parser, struct call *call, unsigned word)
{
    static const char *const words[] = {"depth", "samples", "color"};
    int64_t width, height;
    (void)word;
    if (lex_integer(&parser->lex, "target width", 1, TRIPTYCH_TARGET_MAXIMUM, &width) ||
        lex_integer(&parser->lex, "target height", 1, TRIPTYCH_TARGET_MAXIMUM, &height))
        return -1;
    call->target.width = (unsigned)width;
    call->target.height = (unsigned)height;
    if (parse_target_formats(parser, &call->target))
        return -1;
    return lex_ends_line(&parser->lex)
               ? 0
               : lex_expected_word(&parser->lex, WORDS_OF_ROWS(words), "the end of the line");
}

int parse_name_or_none(struct parser *parser, unsigned types, const char *what, uint32_t *resource)
{
    if (lex_is(&parser->lex, "none"))
        return lex_next(&parser->lex);
    return parse_name(parser, types, what, resource);
}

/* --- Regular calls -------------------------------------------------------------------------------------- */

/* "a frequency", "an attribute" */
static int parse_word_field(struct parser *parser, struct call *call, const struct call_field *field)
{
    char what[64];
    unsigned value;
    snprintf(what, sizeof what, "a%s %s", strchr("aeiou", *field->what) ? "n" : "", field->what);
    if (parse_word(parser, field->words, what, &value))
        return -1;
    call_put(call, field, value);
    return 0;
}

static int parse_resource_field(struct parser *parser, struct call *call, const struct call_field *field)
{
    char what[128];
    snprintf(what, sizeof what, "%s%s", field->what, field->or_none ? ", or none," : "");
    if (field->or_none && lex_is(&parser->lex, "none"))
        return lex_next(&parser->lex);
    return parse_name(parser, field->types, what, call_resource(call, field));
}

static int parse_signed_field(struct parser *parser, struct call *call, const struct call_field *field)
{
    int64_t value;
    if (lex_integer(&parser->lex, field->what, INT32_MIN, INT32_MAX, &value))
        return -1;
    *call_signed(call, field) = (int32_t)value;
    return 0;
}

static int parse_integer_field(struct parser *parser, struct call *call, const struct call_field *field)
{
    uint32_t value;
    if (parse_integer(parser, field->what, field->most, &value))
        return -1;
    call_put(call, field, value);
    return 0;
}

static int parse_any_field(struct parser *parser, struct call *call, const struct call_field *field)
{
    switch (field->kind) {
    case FIELD_FLOATS: return lex_numbers(&parser->lex, field->what, call_floats(call, field), field->count);
    case FIELD_SIGNED: return parse_signed_field(parser, call, field);
    case FIELD_WORD: return parse_word_field(parser, call, field);
    case FIELD_RESOURCE: return parse_resource_field(parser, call, field);
    default: return parse_integer_field(parser, call, field);
    }
}

int parse_regular(struct parser *parser, struct call *call, unsigned first)
{
    for (const struct call_field *f = call_row(call->type)->fields + first; f->kind != FIELD_END; f++)
        if (parse_any_field(parser, call, f))
            return -1;
    return 0;
}

/* --- Bindings ------------------------------------------------------------------------------------------- */

/* The number of sampler 0 may be left out. */
static int bind_texture(struct parser *parser, struct call *call)
{
    bool given = lex_is_digits(&parser->lex);
    return parse_regular(parser, call, given ? 0 : 1);
}

static int bind_vertices(struct parser *parser, struct call *call)
{
    return parse_regular(parser, call, 0);
}

/* The width of indices in a buffer of bytes. */
static int parse_bits(struct parser *parser, uint32_t *bits)
{
    *bits = lex_is(&parser->lex, "8") ? 8 : lex_is(&parser->lex, "16") ? 16 : 32;
    if (*bits == 32 && !lex_is(&parser->lex, "32"))
        return lex_expected(&parser->lex, "8, 16 or 32 bits");
    return lex_next(&parser->lex);
}

static int bind_indices(struct parser *parser, struct call *call)
{
    struct token place = parser->lex.token;
    if (parse_name_or_none(parser, CALL_INDICES, "indices, a mesh, a buffer of u16 or u32, or none,",
                           &call->resource))
        return -1;
    if (call->resource == NO_RESOURCE)
        return 0;
    const struct resource *resource = &parser->stream->resources[call->resource];
    if (resource->type == RESOURCE_BUFFER && resource->value_type == VALUE_BYTES)
        return parse_bits(parser, &call->bind_indices.bits);
    if (!resource->indices)
        return lex_fail(&parser->lex, &place, "found a buffer of other values, expected one of u16 or u32");
    return 0;
}

/* OFFSET STRIDE */
static int parse_place(struct parser *parser, uint32_t *offset, uint32_t *stride)
{
    if (parse_integer(parser, "offset", INT32_MAX, offset))
        return -1;
    return parse_integer(parser, "stride", 65536, stride);
}

static int bind_stream(struct parser *parser, struct call *call)
{
    if (parse_integer(parser, "stream", TRIPTYCH_STREAMS - 1, &call->bind_stream.number) ||
        parse_name_or_none(parser, CALL_ELEMENTS, "a buffer, vertices or a mesh, or none,", &call->resource))
        return -1;
    if (call->resource == NO_RESOURCE)
        return 0;
    return parse_place(parser, &call->bind_stream.offset, &call->bind_stream.stride);
}

static int bind_element(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    unsigned attribute, format;
    struct token place = lex->token;
    if (parse_word(parser, WORDS_ATTRIBUTE, "an attribute", &attribute))
        return -1;
    if (attribute >= TRIPTYCH_ATTRIBUTE_COUNT)
        return lex_fail(lex, &place, "found '%s', expected an attribute, or declare for other elements",
                        word_text(WORDS_ATTRIBUTE, attribute));
    call->element.attribute = (enum triptych_attribute)attribute;
    call->element.format = TRIPTYCH_FORMAT_NONE;
    if (lex_is(lex, "none"))
        return lex_next(lex);
    if (parse_word(parser, WORDS_FORMAT, "a format, or none", &format) ||
        parse_name(parser, CALL_ELEMENTS, "a buffer, vertices or a mesh", &call->resource))
        return -1;
    call->element.format = (enum triptych_format)format;
    return parse_place(parser, &call->element.offset, &call->element.stride);
}

int parse_bind(struct parser *parser, struct call *call, unsigned word)
{
    static const struct {
        const char *word;
        enum call_type type;
        int (*parse)(struct parser *parser, struct call *call);
    } rows[] = {{"texture", CALL_BIND_TEXTURE, bind_texture},
                {"vertices", CALL_BIND_VERTICES, bind_vertices},
                {"indices", CALL_BIND_INDICES, bind_indices},
                {"element", CALL_BIND_ELEMENT, bind_element},
                {"stream", CALL_BIND_STREAM, bind_stream}};
    (void)word;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (lex_is(&parser->lex, rows[i].word)) {
            call->type = rows[i].type;
            return lex_next(&parser->lex) ? -1 : rows[i].parse(parser, call);
        }
    return lex_expected_word(&parser->lex, WORDS_OF_ROWS(rows),
                             "texture, vertices, indices, element or stream");
}

/* part X Y WIDTH HEIGHT */
static int parse_part(struct parser *parser, struct call_clear_parts *parts)
{
    uint32_t side[4];
    if (parts->count == PARTS_PER_CALL)
        return lex_expected(&parser->lex, "at most 24 parts");
    if (lex_next(&parser->lex))
        return -1;
    for (int i = 0; i < 4; i++)
        if (parse_integer(parser, "part X Y WIDTH HEIGHT", TRIPTYCH_TARGET_MAXIMUM, &side[i]))
            return -1;
    parts->part[parts->count++] =
        (struct call_part){(uint16_t)side[0], (uint16_t)side[1], (uint16_t)side[2], (uint16_t)side[3]};
    return 0;
}

/* A value of a clear that must be an integer. */
static int whole_number(struct parser *parser, const struct token *place, const struct parse_field *field,
                        uint32_t most, uint32_t *value)
{
    float number = *field->numbers;
    if (!(number >= 0 && number <= (float)most && number == floorf(number)))
        return lex_fail(&parser->lex, place, "found %s %g, expected an integer from 0 to %" PRIu32,
                        field->word, (double)number, most);
    *value = (uint32_t)number;
    return 0;
}

enum clear_field {
    CLEAR_FIELD_COLOR,
    CLEAR_FIELD_DEPTH,
    CLEAR_FIELD_STENCIL,
    CLEAR_FIELD_COLOR_MASK,
    CLEAR_FIELD_STENCIL_MASK,
    CLEAR_FIELD_EVERYWHERE,
    CLEAR_FIELD_PART,
    CLEAR_FIELDS
};

/* Turns a clear without masks and parts into a plain one. */
static void choose_clear(const struct parse_field fields[CLEAR_FIELDS], const struct call_clear_parts *parts,
                         struct call *call)
{
    bool plain = !parts->count;
    for (int i = CLEAR_FIELD_COLOR_MASK; i < CLEAR_FIELDS; i++)
        plain &= !fields[i].given;
    call->type = plain ? CALL_CLEAR : CALL_CLEAR_PARTS;
    if (plain)
        call->clear = parts->clear;
    else
        call->clear_parts = *parts;
}

/* All values but those of parts are read as numbers. */
int parse_clear(struct parser *parser, struct call *call, unsigned word)
{
    struct call_clear_parts parts = {.count = 0};
    struct call_clear *clear = &parts.clear;
    float stencil = 0, color_mask = 15, stencil_mask = 255;
    struct token place = parser->lex.token;
    struct parse_field fields[CLEAR_FIELDS] = {{"color", clear->color, 4, false},
                                               {"depth", &clear->depth, 1, false},
                                               {"stencil", &stencil, 1, false},
                                               {"colormask", &color_mask, 1, false},
                                               {"stencilmask", &stencil_mask, 1, false},
                                               {"everywhere", NULL, 0, false},
                                               {"part", NULL, 0, false}};
    (void)word;
    while (!lex_ends_line(&parser->lex))
        if (lex_is(&parser->lex, "part") ? parse_part(parser, &parts)
                                         : parse_field(parser, fields, CLEAR_FIELDS))
            return -1;
    clear->flags = (fields[CLEAR_FIELD_COLOR].given ? TRIPTYCH_CLEAR_COLOR : 0) |
                   (fields[CLEAR_FIELD_DEPTH].given ? TRIPTYCH_CLEAR_DEPTH : 0) |
                   (fields[CLEAR_FIELD_STENCIL].given ? TRIPTYCH_CLEAR_STENCIL : 0);
    if (!clear->flags)
        return lex_expected(&parser->lex, "color R G B A, depth D, stencil S, or several of them");
    parts.everywhere = fields[CLEAR_FIELD_EVERYWHERE].given;
    if (whole_number(parser, &place, &fields[CLEAR_FIELD_STENCIL], 255, &clear->stencil) ||
        whole_number(parser, &place, &fields[CLEAR_FIELD_COLOR_MASK], 15, &parts.color_mask) ||
        whole_number(parser, &place, &fields[CLEAR_FIELD_STENCIL_MASK], 255, &parts.stencil_mask))
        return -1;
    choose_clear(fields, &parts, call);
    return 0;
}

/* draw PRIMITIVE FIRST COUNT, draw mesh NAME, or draw model NAME */
int parse_draw(struct parser *parser, struct call *call, unsigned word)
{
    unsigned primitive;
    (void)word;
    if (lex_is(&parser->lex, "mesh")) {
        call->type = CALL_DRAW_MESH;
        return lex_next(&parser->lex) ? -1 : parse_regular(parser, call, 0);
    }
    if (lex_is(&parser->lex, "model"))
        return lex_next(&parser->lex) ? -1 : parse_draw_model(parser, call);
    if (parse_word(parser, WORDS_PRIMITIVE, "a primitive, mesh NAME, or model NAME", &primitive))
        return -1;
    call->draw.primitive = primitive;
    return parse_regular(parser, call, 1);
}
