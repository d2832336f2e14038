/* Definitions of vertices, indices and buffers in the text. */
#include "capture/layout.h"
#include "command/assets/asset.h"
#include "command/text/parse.h"

#include "base/half.h"

#include <stdlib.h>
#include <string.h>

/* --- Blocks --------------------------------------------------------------------------------------------- */

/* The data of a block while they are read. */
struct block {
    uint8_t *data;
    size_t bytes, capacity;
    size_t size;  /* bytes of an item */
    size_t limit; /* items */
    const char *items;
};

static int append(struct parser *parser, struct block *block, const void *item)
{
    if (block->bytes == block->limit * block->size)
        return lex_expected(&parser->lex, "at most %zu %s", block->limit, block->items);
    if (block->bytes + block->size > block->capacity) {
        size_t capacity = block->capacity ? 2 * block->capacity : 64 * block->size;
        uint8_t *larger = realloc(block->data, capacity);
        if (!larger)
            return lex_fail(&parser->lex, &parser->lex.token, "not enough memory");
        block->data = larger;
        block->capacity = capacity;
    }
    memcpy(block->data + block->bytes, item, block->size);
    block->bytes += block->size;
    return 0;
}

static int open_block(struct parser *parser)
{
    if (parser->lex.token.type != TOKEN_OPEN)
        return lex_expected(&parser->lex, "{");
    return lex_next(&parser->lex);
}

/* Reads the value at the current token in its form in memory. */
static int parse_value(struct parser *parser, enum value_type type, const char *what, void *value)
{
    int64_t integer = 0;
    uint16_t narrow;
    uint32_t wide;
    switch (type) {
    case VALUE_FLOAT: return lex_any_number(&parser->lex, what, value);
    case VALUE_COLOR: return lex_color(&parser->lex, what, value);
    case VALUE_U16:
        if (lex_integer(&parser->lex, what, 0, UINT16_MAX, &integer))
            return -1;
        narrow = (uint16_t)integer;
        memcpy(value, &narrow, sizeof narrow);
        return 0;
    case VALUE_U32:
        if (lex_integer(&parser->lex, what, 0, UINT32_MAX, &integer))
            return -1;
        wide = (uint32_t)integer;
        memcpy(value, &wide, sizeof wide);
        return 0;
    case VALUE_BYTES: break;
    }
    return -1;
}

/* { value... } with line breaks anywhere; at least one. */
static int parse_values(struct parser *parser, enum value_type type, const char *what, struct block *block)
{
    struct lexer *lex = &parser->lex;
    uint32_t value;
    if (open_block(parser) || lex_skip_lines(lex))
        return -1;
    while (lex_is_value(lex))
        if (parse_value(parser, type, what, &value) || append(parser, block, &value) || lex_skip_lines(lex))
            return -1;
    if (lex->token.type != TOKEN_CLOSE)
        return lex_expected(lex, "%s or }", what);
    if (!block->bytes)
        return lex_expected(lex, "%s before it", what);
    return lex_next(lex);
}

/* --- Assets --------------------------------------------------------------------------------------------- */

int parse_account(struct parser *parser, const struct token *place, size_t bytes)
{
    struct error reason = {{0}};
    if (stream_build_account(&parser->build, bytes, &reason))
        return lex_fail(&parser->lex, place, "%s", reason.text);
    return 0;
}

int parse_load(struct parser *parser, struct resource *resource, const char *path, const struct token *place,
               resource_loader *loader)
{
    struct error reason = {{0}};
    char *joined = asset_path(parser->lex.path, path);
    if (!joined)
        return lex_fail(&parser->lex, place, "not enough memory");
    int result = loader(resource, joined, &reason);
    free(joined);
    if (result)
        return lex_fail(&parser->lex, place, "%s", reason.text);
    return 0;
}

int parse_path(struct parser *parser, char **path)
{
    struct token place = parser->lex.token;
    if (lex_string(&parser->lex, "the path of a file", path))
        return -1;
    size_t length = strlen(*path);
    if (!length || length > LIMIT_PATH_BYTES)
        return lex_fail(&parser->lex, &place, "found a path of %zu bytes, expected 1 to %d", length,
                        LIMIT_PATH_BYTES);
    return 0;
}

/* --- Vertices ------------------------------------------------------------------------------------------- */

static int parse_element(struct parser *parser, struct resource *resource, unsigned *which)
{
    enum triptych_format format;
    if (parse_attribute(parser, parser->lex.token.length, which, &format))
        return -1;
    if (resource->layout.format[*which])
        return lex_expected(&parser->lex, "each attribute once");
    layout_add(&resource->layout, *which, format);
    return lex_next(&parser->lex);
}

/* Component c of a packed type into its bits. */
static int parse_field(struct parser *parser, const struct vertex_type *type, const char *what, unsigned c,
                       uint32_t *words)
{
    int64_t integer = 0, range = (int64_t)1 << type->bits, low = 0;
    float number;
    if (type->encoding == ENCODING_SIGNED)
        low = -range / 2;
    if (type->encoding != ENCODING_HALF) {
        if (lex_integer(&parser->lex, what, low, low + range - 1, &integer))
            return -1;
    } else if (lex_half_bits(&parser->lex, &integer)) {
        if (lex_next(&parser->lex))
            return -1;
    } else {
        struct token place = parser->lex.token;
        if (lex_number(&parser->lex, what, &number))
            return -1;
        integer = float_to_half(number);
        if ((integer & 0x7fff) == 0x7c00)
            return lex_fail(&parser->lex, &place, "found %g, expected a number in the range of binary16",
                            (double)number);
    }
    unsigned bit = c * type->bits;
    words[bit / 32] |= (uint32_t)(integer & (range - 1)) << bit % 32;
    return 0;
}

/* An attribute's values in their form in memory. */
static int parse_typed(struct parser *parser, enum triptych_format format, const char *what, uint32_t *words)
{
    const struct vertex_type *type = &key_vertex_types[format];
    if (type->encoding == ENCODING_COLOR)
        return parse_value(parser, VALUE_COLOR, what, words);
    for (unsigned c = 0; c < type->components; c++)
        if (type->encoding == ENCODING_FLOAT ? parse_value(parser, VALUE_FLOAT, what, words + c)
                                             : parse_field(parser, type, what, c, words))
            return -1;
    return 0;
}

/* One vertex; its attributes in the order of the text. */
static int parse_vertex(struct parser *parser, const struct layout *layout, const unsigned *order,
                        struct block *block)
{
    uint8_t vertex[4 * sizeof(float) * STREAM_ELEMENTS];
    uint32_t bytes = 0, values = 0;
    for (int i = 0; bytes < layout->stride; i++) {
        enum triptych_format format = layout->format[order[i]];
        uint32_t words[4] = {0};
        if (parse_typed(parser, format, word_text(WORDS_ATTRIBUTE, order[i]), words))
            return -1;
        memcpy(vertex + bytes, words, key_vertex_types[format].bytes);
        bytes += key_vertex_types[format].bytes;
        values += format_values(format);
    }
    if (append(parser, block, vertex))
        return -1;
    if (parser->lex.token.type != TOKEN_LINE_END)
        return lex_expected(&parser->lex, "the end of the line after a vertex of %u values", values);
    return lex_skip_lines(&parser->lex);
}

static int parse_vertex_block(struct parser *parser, const struct layout *layout, const unsigned *order,
                              struct block *block)
{
    struct lexer *lex = &parser->lex;
    if (open_block(parser))
        return -1;
    if (lex->token.type != TOKEN_LINE_END)
        return lex_expected(lex, "the end of the line before the first vertex");
    if (lex_skip_lines(lex))
        return -1;
    while (lex_is_value(lex))
        if (parse_vertex(parser, layout, order, block))
            return -1;
    if (lex->token.type != TOKEN_CLOSE)
        return lex_expected(lex, "a vertex or }");
    if (!block->bytes)
        return lex_expected(lex, "a vertex before it");
    return lex_next(lex);
}

int parse_vertex_data(struct parser *parser, struct resource *resource)
{
    unsigned order[STREAM_ELEMENTS];
    struct token place;
    int count = 0;
    do {
        if (parse_element(parser, resource, &order[count]))
            return -1;
        count++;
    } while (parser->lex.token.type == TOKEN_WORD && count < STREAM_ELEMENTS);
    const struct layout *layout = &resource->layout;
    struct block block = {.size = layout->stride, .limit = LIMIT_VERTICES, .items = "vertices"};
    place = parser->lex.token;
    int result = parse_vertex_block(parser, layout, order, &block);
    resource->vertices = block.data;
    resource->vertex_bytes = block.bytes;
    resource->vertex_count = (uint32_t)(block.bytes / layout->stride);
    return result ? -1 : parse_account(parser, &place, block.bytes);
}

int parse_vertices(struct parser *parser)
{
    struct resource *resource;
    if (parse_new_name(parser, RESOURCE_VERTICES, &resource))
        return -1;
    return parse_vertex_data(parser, resource);
}

/* --- Indices and values --------------------------------------------------------------------------------- */

/* The block of a resource whose data are all of one type. */
static int parse_data(struct parser *parser, struct resource *resource, enum value_type type,
                      const char *what)
{
    struct token place = parser->lex.token;
    struct block block = {.size = value_bytes(type), .limit = LIMIT_VALUES, .items = "values"};
    int result = parse_values(parser, type, what, &block);
    if (type == VALUE_U16 || type == VALUE_U32) {
        resource->indices = block.data;
        resource->index_bits = 8 * value_bytes(type);
        resource->index_count = (uint32_t)(block.bytes / value_bytes(type));
        stream_build_extremes(resource);
    } else {
        resource->vertices = block.data;
        resource->vertex_bytes = block.bytes;
    }
    return result ? -1 : parse_account(parser, &place, block.bytes);
}

/* Reads { HEX... }: words of any number of pairs of digits. */
static int parse_bytes(struct parser *parser, struct block *block)
{
    struct lexer *lex = &parser->lex;
    if (open_block(parser) || lex_skip_lines(lex))
        return -1;
    for (; lex->token.type == TOKEN_WORD;) {
        const struct token *token = &lex->token;
        if (token->length % 2)
            return lex_expected(lex, "bytes: pairs of hexadecimal digits");
        for (size_t i = 0; i < token->length; i += 2) {
            int high = lex_hexadecimal_digit(token->text[i]), low = lex_hexadecimal_digit(token->text[i + 1]);
            uint8_t byte = (uint8_t)(high << 4 | low);
            if (high < 0 || low < 0)
                return lex_expected(lex, "bytes: pairs of hexadecimal digits");
            if (append(parser, block, &byte))
                return -1;
        }
        if (lex_next(lex) || lex_skip_lines(lex))
            return -1;
    }
    if (lex->token.type != TOKEN_CLOSE)
        return lex_expected(lex, "bytes or }");
    if (!block->bytes)
        return lex_expected(lex, "bytes before it");
    return lex_next(lex);
}

static int parse_byte_buffer(struct parser *parser, struct resource *resource)
{
    struct token place = parser->lex.token;
    struct block block = {.size = 1, .limit = LIMIT_FILE_BYTES, .items = "bytes"};
    int result = parse_bytes(parser, &block);
    resource->vertices = block.data;
    resource->vertex_bytes = block.bytes;
    return result ? -1 : parse_account(parser, &place, block.bytes);
}

int parse_index_data(struct parser *parser, struct resource *resource)
{
    int narrow = lex_is(&parser->lex, "16");
    if (!narrow && !lex_is(&parser->lex, "32"))
        return lex_expected(&parser->lex, "16 or 32 bits");
    if (lex_next(&parser->lex))
        return -1;
    return parse_data(parser, resource, narrow ? VALUE_U16 : VALUE_U32, "index");
}

int parse_indices(struct parser *parser)
{
    struct resource *resource;
    if (parse_new_name(parser, RESOURCE_INDICES, &resource))
        return -1;
    return parse_index_data(parser, resource);
}

int parse_buffer(struct parser *parser)
{
    struct resource *resource;
    unsigned type;
    if (parse_new_name(parser, RESOURCE_BUFFER, &resource) ||
        parse_word(parser, WORDS_VALUE, "a type of values", &type))
        return -1;
    resource->value_type = (enum value_type)type;
    if (resource->value_type == VALUE_BYTES)
        return parse_byte_buffer(parser, resource);
    return parse_data(parser, resource, resource->value_type, "value");
}

/* --- Queries -------------------------------------------------------------------------------------------- */

int parse_query(struct parser *parser)
{
    struct resource *resource;
    return parse_new_name(parser, RESOURCE_QUERY, &resource);
}
