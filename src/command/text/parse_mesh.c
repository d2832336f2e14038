/* The definition of a mesh: its source, the source's parameters, then options. */
#include "command/assets/mesh.h"
#include "command/text/parse.h"

#include <stdio.h>

static int parse_positive(struct parser *parser, const char *what, float *number)
{
    struct token place = parser->lex.token;
    if (lex_number(&parser->lex, what, number))
        return -1;
    if (!(*number > 0))
        return lex_fail(&parser->lex, &place, "found a %s of %g, expected more than 0", what,
                        (double)*number);
    return 0;
}

static int parse_fit(struct parser *parser, struct mesh_options *options)
{
    return parse_positive(parser, "size", &options->fit);
}

static int parse_subdivisions(struct parser *parser, struct mesh_options *options)
{
    int64_t subdivisions;
    if (lex_integer(&parser->lex, "subdivisions", 1, LIMIT_SUBDIVISIONS, &subdivisions))
        return -1;
    options->subdivisions = (unsigned)subdivisions;
    return 0;
}

static int parse_texcoords(struct parser *parser, struct mesh_options *options)
{
    unsigned value;
    if (parse_word(parser, WORDS_TEXCOORDS, "a projection", &value))
        return -1;
    options->texcoords = (enum texcoords)value;
    return 0;
}

static int parse_normals(struct parser *parser, struct mesh_options *options)
{
    unsigned value;
    if (parse_word(parser, WORDS_NORMALS, "a kind of normals", &value))
        return -1;
    options->normals = (enum normals)value;
    return 0;
}

static int parse_center(struct parser *parser, struct mesh_options *options)
{
    (void)parser;
    options->center = 1;
    return 0;
}

static int parse_bones(struct parser *parser, struct mesh_options *options)
{
    (void)parser;
    options->bones = 1;
    return 0;
}

static int parse_tiling(struct parser *parser, struct mesh_options *options)
{
    for (int i = 0; i < 2; i++)
        if (parse_positive(parser, "repetition", &options->repeat[i]))
            return -1;
    return 0;
}

enum {
    MODELS = 1 << MESH_FILE | 1 << MESH_MODEL,
    FILES = MODELS | 1 << MESH_BEZIER,
    SHAPES = 1 << MESH_BOX | 1 << MESH_GRID | 1 << MESH_SPHERE | 1 << MESH_CYLINDER | 1 << MESH_TORUS
};

static const struct option {
    const char *word;
    unsigned sources; /* that have it: a mask of 1 << source */
    int (*parse)(struct parser *parser, struct mesh_options *options);
} options[] = {
    {"normals", MODELS, parse_normals},
    {"subdivisions", 1 << MESH_BEZIER, parse_subdivisions},
    {"texcoords", FILES, parse_texcoords},
    {"repeat", FILES | SHAPES, parse_tiling},
    {"bones", MODELS, parse_bones},
    {"center", FILES, parse_center},
    {"fit", FILES, parse_fit},
};

enum { OPTIONS = sizeof options / sizeof *options };

static int parse_options(struct parser *parser, struct mesh_options *out)
{
    struct lexer *lex = &parser->lex;
    unsigned left = 0; /* options that may still come */
    for (int i = 0; i < OPTIONS; i++)
        left |= (options[i].sources >> out->source & 1) << i;
    while (lex->token.type != TOKEN_LINE_END && lex->token.type != TOKEN_END) {
        char choices[128] = "";
        size_t at = 0;
        int i = 0;
        while (i < OPTIONS && !((left >> i & 1) && lex_is(lex, options[i].word)))
            i++;
        for (int j = 0; i == OPTIONS && j < OPTIONS; j++)
            if (left >> j & 1)
                at += (size_t)snprintf(choices + at, sizeof choices - at, "%s%s", at ? ", " : "",
                                       options[j].word);
        if (i == OPTIONS)
            return lex_expected_word(lex, WORDS_OF_ROWS(options), "%s%sthe end of the line", choices,
                                     at ? ", or " : "");
        left &= ~(1u << i);
        if (lex_next(lex) || options[i].parse(parser, out))
            return -1;
    }
    if (out->source == MESH_BEZIER && !out->subdivisions)
        return lex_expected(lex, "subdivisions N");
    return 0;
}

/* How many cells a shape has: at least three around, so that it encloses something. */
static int parse_cells(struct parser *parser, struct mesh_options *out)
{
    static const char *const what[2] = {"cells across", "cells down"};
    for (int i = 0; i < 2; i++) {
        int64_t cells, least = out->source == MESH_GRID || (i && out->source == MESH_CYLINDER) ? 1 : 3;
        if (i && out->source == MESH_SPHERE)
            least = 2;
        if (lex_integer(&parser->lex, what[i], least, LIMIT_CELLS, &cells))
            return -1;
        out->cells[i] = (uint32_t)cells;
    }
    return 0;
}

static int parse_shadow(struct parser *parser, struct mesh_options *out)
{
    static const char *const words[] = {"directional", "point"};
    struct lexer *lex = &parser->lex;
    if (parse_name(parser, 1 << RESOURCE_MESH, "a mesh", &out->caster))
        return -1;
    out->light_is_point = lex_is(lex, "point");
    if (!out->light_is_point && !lex_is(lex, "directional"))
        return lex_expected_word(lex, WORDS_OF_ROWS(words), "directional or point");
    return lex_next(lex) || lex_numbers(lex, "the light", out->light, 3) ||
                   parse_positive(parser, "length", &out->length)
               ? -1
               : 0;
}

/* ATTRIBUTE:FORMAT... { vertices } 16|32 { indices of triangles } */
static int parse_given(struct parser *parser, struct resource *resource)
{
    if (parse_vertex_data(parser, resource) || parse_index_data(parser, resource))
        return -1;
    struct error reason = {{0}};
    if (resource->index_count % 3)
        return lex_expected(&parser->lex, "three indices a triangle before it");
    if (mesh_check_indices(resource, &reason))
        return lex_expected(&parser->lex, "%s", reason.text);
    return 0;
}

static int assemble_source(struct parser *parser, struct resource *resource)
{
    struct mesh_options *out = &resource->options;
    if (FILES >> out->source & 1)
        return parse_path(parser, &resource->path);
    if (out->source == MESH_SHADOW)
        return parse_shadow(parser, out);
    if (out->source == MESH_TORUS && parse_positive(parser, "radius", &out->tube))
        return -1;
    return out->source == MESH_BOX ? 0 : parse_cells(parser, out);
}

static int make(struct parser *parser, struct resource *resource, const struct token *place)
{
    struct error reason = {{0}};
    if (resource->path)
        return parse_load(parser, resource, resource->path, place, mesh_load);
    if (mesh_make(resource, &parser->stream->resources[resource->options.caster], &reason))
        return lex_fail(&parser->lex, place, "%s", reason.text);
    return 0;
}

int parse_mesh_source(struct parser *parser, struct resource *resource)
{
    struct token place = parser->lex.token;
    if (assemble_source(parser, resource) || parse_options(parser, &resource->options) ||
        make(parser, resource, &place))
        return -1;
    stream_build_extremes(resource);
    return parse_account(parser, &place,
                         resource->vertex_bytes + (size_t)resource->index_count * resource->index_bits / 8);
}

int parse_mesh(struct parser *parser)
{
    struct resource *resource;
    unsigned source;
    if (parse_new_name(parser, RESOURCE_MESH, &resource) || parse_word(parser, WORDS_MESH, "a mesh", &source))
        return -1;
    resource->options.source = (enum mesh_source)source;
    if (source == MESH_DATA)
        return parse_given(parser, resource);
    if (parse_mesh_source(parser, resource))
        return -1;
    asset_free_materials(resource);
    return 0;
}
