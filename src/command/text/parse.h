/* Shared by the parts of the reader of text: lines (parse.c), calls and definitions (parse_*.c). Functions
 * return 0, or -1 with the reason in the lexer's error. */
#ifndef COMMAND_TEXT_PARSE_H
#define COMMAND_TEXT_PARSE_H

#include "command/assets/asset.h"
#include "command/stream/build.h"
#include "command/stream/expression.h"
#include "command/stream/lex.h"
#include "capture/word.h"

/* An open repeat. */
struct repeat {
    struct lexer body;  /* at its first token */
    struct token place; /* of its line */
    uint32_t count, left;
    unsigned variables; /* that were set before it */
    bool named;         /* the next one counts its repetitions */
};

struct parser {
    struct lexer lex;
    struct stream *stream;
    struct builder build;
    struct expression_scope scope;
    struct repeat repeats[LIMIT_REPEATS]; /* from the outermost one on */
    unsigned repeat_count;
    unsigned sequence_variables; /* that were set before the open sequence */
    uint64_t repeated;           /* bytes that repeats have read again */
};

/* Reads a word of a list. `what` names it in the reason. */
int parse_word(struct parser *parser, enum word_list list, const char *what, unsigned *value);

/* Reports that `what`, the name of a format with that role or with any (0), was expected. Returns -1. */
int parse_expect_format(struct parser *parser, unsigned role, const char *what);

/* A word followed by numbers, at most once in its call. */
struct parse_field {
    const char *word;
    float *numbers;
    size_t count;
    bool given;
};

/* Fields in any order up to the end of the line. */
int parse_fields(struct parser *parser, struct parse_field *fields, size_t count);

/* The fields of the call's row (capture/call.def) from number `first` on, in their order. */
int parse_regular(struct parser *parser, struct call *call, unsigned first);

/* Reads an unused name and adds a resource of the type. *resource is valid until the next one is added. */
int parse_new_name(struct parser *parser, enum resource_type type, struct resource **resource);

/* Reads the name of a resource of one of the types (a mask of 1 << type); `what` names them in the reason. */
int parse_name(struct parser *parser, unsigned types, const char *what, uint32_t *resource);

/* Reads a name, or none, which leaves *resource unchanged. */
int parse_name_or_none(struct parser *parser, unsigned types, const char *what, uint32_t *resource);

/* Read an operation of transforms as a matrix; the name of a transform, with its number. */
int parse_operation(struct parser *parser, double matrix[4][4]);
int parse_transform_name(struct parser *parser, enum triptych_transform *which);

/* Reads ATTRIBUTE:FORMAT from the first `length` bytes of the current token. `element` is of enum
 * stream_element. */
int parse_attribute(struct parser *parser, size_t length, unsigned *element, enum triptych_format *format);

/* Reads the name of a format that can be a target. */
int parse_color_format(struct parser *parser, enum triptych_surface_format *format);

/* Reads an integer from 0 to `high`. */
int parse_integer(struct parser *parser, const char *what, int64_t high, uint32_t *value);
/* Counts a resource's bytes against the stream's limit. */
int parse_account(struct parser *parser, const struct token *place, size_t bytes);

/* Read ATTRIBUTE:FORMAT... { vertices }, or 16|32 { indices }, into a resource. */
int parse_vertex_data(struct parser *parser, struct resource *resource);
int parse_index_data(struct parser *parser, struct resource *resource);

/* Reads the path of a file, which the caller frees. */
int parse_path(struct parser *parser, char **path);

/* Calls the loader with the resolved path. A failure is reported at `place`. */
int parse_load(struct parser *parser, struct resource *resource, const char *path, const struct token *place,
               resource_loader *loader);

/* Appends a call. */
int parse_add_call(struct parser *parser, const struct call *call, const struct token *place);

/* Calls whose text does not follow from their rows (stream_functions), from the token after the first word.
 * Fields that the text leaves out have their defaults. */
int parse_target(struct parser *parser, struct call *call, unsigned word);
int parse_set(struct parser *parser, struct call *call, unsigned word);
int parse_convention(struct parser *parser, struct call *call, unsigned word);
int parse_transform(struct parser *parser, struct call *call, unsigned word);
int parse_material(struct parser *parser, struct call *call, unsigned word);
int parse_light(struct parser *parser, struct call *call, unsigned word);
int parse_bind(struct parser *parser, struct call *call, unsigned word);
int parse_declare(struct parser *parser, struct call *call, unsigned word);
int parse_fvf(struct parser *parser, struct call *call, unsigned word);
int parse_set_shader(struct parser *parser, struct call *call, unsigned word);
int parse_constants(struct parser *parser, struct call *call, unsigned word);
int parse_update(struct parser *parser, struct call *call, unsigned word);
int parse_attach(struct parser *parser, struct call *call, unsigned word);
int parse_copy(struct parser *parser, struct call *call, unsigned word);
int parse_set_pixels(struct parser *parser, struct call *call, unsigned word);
int parse_fill_surface(struct parser *parser, struct call *call, unsigned word);
int parse_clear(struct parser *parser, struct call *call, unsigned word);
int parse_draw(struct parser *parser, struct call *call, unsigned word);
int parse_play(struct parser *parser, struct call *call, unsigned word);
int parse_sequence(struct parser *parser, struct call *call, unsigned word);

/* Reads the text of a stream. */
int parse_stream(const char *path, const char *text, size_t bytes, struct stream **stream,
                 struct error *error);

/* Lines of repeats and variables, from the token after the first word to the next line. parse_end_repeat
 * returns to the first line of the repeat until its repetitions are done. */
int parse_repeat(struct parser *parser);
int parse_end_repeat(struct parser *parser);
int parse_let(struct parser *parser);

/* Definitions, from the token after the first word to the end of the line. */
int parse_texture(struct parser *parser);
int parse_vertices(struct parser *parser);
int parse_indices(struct parser *parser);
int parse_buffer(struct parser *parser);
int parse_shader(struct parser *parser);
int parse_query(struct parser *parser);
int parse_new_image(struct parser *parser);
int parse_mesh(struct parser *parser);
int parse_model(struct parser *parser);

/* Reads a mesh from the token after the word of its source, which its options have. */
int parse_mesh_source(struct parser *parser, struct resource *resource);

/* Loads a texture from its file, resource->path. A failure is reported at `place`. */
int parse_texture_file(struct parser *parser, struct resource *resource, const struct token *place);

/* Adds the calls that draw a model, from the token after `model`; the last remains in `call`. */
int parse_draw_model(struct parser *parser, struct call *call);

#endif
