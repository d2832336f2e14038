/* What the parts of the text reader share: the lines (parse.c), the calls (calls.c, call_state.c), the definitions of
 * resources (define.c), the check of the whole (check.c). Functions return 0, or -1 with the reason set at
 * the lexer's error. */
#ifndef STREAM_PARSE_H
#define STREAM_PARSE_H

#include "stream/asset.h"
#include "stream/build.h"
#include "stream/lex.h"
#include "stream/words.h"

struct parser {
    struct lexer lex;
    struct stream *stream;
    struct builder build;
};

/* The current token as one of a list's words. `what` names it in the reason. */
int parse_word(struct parser *parser, enum word_list list, const char *what, unsigned *value);

/* A word followed by numbers, at most once in its call. */
struct field {
    const char *word;
    float *numbers;
    size_t count;
    int given;
};

/* Fields in any order up to the end of the line. */
int parse_fields(struct parser *parser, struct field *fields, size_t count);

/* Reads a name that is not in use and adds a resource of that type; *resource is valid until the next one. */
int parse_new_name(struct parser *parser, enum resource_type type, struct resource **resource);

/* Reads the name of a resource of one of the types (a mask of 1 << type); `what` names them in the reason. */
int parse_name(struct parser *parser, unsigned types, const char *what, uint32_t *resource);

/* The same, or none: *resource stays as it is. */
int parse_name_or_none(struct parser *parser, unsigned types, const char *what, uint32_t *resource);

/* The matrix of an operation of transforms; the name of a transform, with its number if it has one. */
int parse_operation(struct parser *parser, double matrix[4][4]);
int parse_transform_name(struct parser *parser, enum triptych_transform *which);

/* Numbers that must be finite in binary32. */
int parse_round(struct parser *parser, const struct token *place, double matrix[4][4], float rounded[4][4]);

/* ATTRIBUTE:FORMAT, as much of the current token as `length` says: a number of enum stream_element. */
int parse_attribute(struct parser *parser, size_t length, unsigned *element, enum triptych_format *format);

/* An integer from 0 to `high`. */
int parse_integer(struct parser *parser, const char *what, int64_t high, uint32_t *value);
/* Counts a resource's bytes against the stream's limit. */
int parse_account(struct parser *parser, const struct token *place, size_t bytes);

/* ATTRIBUTE:FORMAT... { vertices }, and 16|32 { indices }, into a resource. */
int parse_vertex_data(struct parser *parser, struct resource *resource);
int parse_index_data(struct parser *parser, struct resource *resource);

/* Reads the path of a file, which the caller frees. */
int parse_path(struct parser *parser, char **path);

/* Calls the loader with where the path leads; a failure is reported at `place`. */
int parse_load(struct parser *parser, struct resource *resource, const char *path, const struct token *place,
               resource_loader *loader);

/* Appends a call. */
int parse_add_call(struct parser *parser, const struct call *call, const struct token *place);

/* Calls, from behind their first word; what is not mentioned in the text has its default. */
int parse_target(struct parser *parser, struct call *call);
int parse_viewport(struct parser *parser, struct call *call);
int parse_scissor(struct parser *parser, struct call *call);
int parse_clip_plane(struct parser *parser, struct call *call);
int parse_convention(struct parser *parser, struct call *call);
int parse_state(struct parser *parser, struct call *call);
int parse_sampler(struct parser *parser, struct call *call);
int parse_stage(struct parser *parser, struct call *call);
int parse_transform(struct parser *parser, struct call *call);
int parse_pose(struct parser *parser, struct call *call);
int parse_material(struct parser *parser, struct call *call);
int parse_light(struct parser *parser, struct call *call);
int parse_bind(struct parser *parser, struct call *call);
int parse_declare(struct parser *parser, struct call *call);
int parse_fvf(struct parser *parser, struct call *call);
int parse_frequency(struct parser *parser, struct call *call);
int parse_vertex_shader(struct parser *parser, struct call *call);
int parse_pixel_shader(struct parser *parser, struct call *call);
int parse_vertex_constants(struct parser *parser, struct call *call);
int parse_pixel_constants(struct parser *parser, struct call *call);
int parse_vertex_integers(struct parser *parser, struct call *call);
int parse_pixel_integers(struct parser *parser, struct call *call);
int parse_vertex_booleans(struct parser *parser, struct call *call);
int parse_pixel_booleans(struct parser *parser, struct call *call);
int parse_update(struct parser *parser, struct call *call);
int parse_mips(struct parser *parser, struct call *call);
int parse_attach(struct parser *parser, struct call *call);
int parse_copy(struct parser *parser, struct call *call);
int parse_clear(struct parser *parser, struct call *call);
int parse_texels(struct parser *parser, struct call *call);
int parse_contents(struct parser *parser, struct call *call);
int parse_release(struct parser *parser, struct call *call);
int parse_query_part(struct parser *parser, struct call *call);
int parse_draw(struct parser *parser, struct call *call);
int parse_primitives(struct parser *parser, struct call *call);

/* Definitions, from behind their first word to the end of the line. */
int parse_texture(struct parser *parser);
int parse_vertices(struct parser *parser);
int parse_indices(struct parser *parser);
int parse_buffer(struct parser *parser);
int parse_shader(struct parser *parser);
int parse_query(struct parser *parser);
int parse_mesh(struct parser *parser);

#endif
