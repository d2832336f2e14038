/* The functions that the actions of grammar.y call: they make nodes with checked types. A failed check
 * reports an error and returns a node of the error type, which no later check reports again. */
#ifndef FRONT_GLSL_CHECK_H
#define FRONT_GLSL_CHECK_H

#include "front/glsl/context.h"
#include "front/glsl/node.h"

/* A list of expressions, fields, or statements while it is read. */
struct glsl_expressions {
    struct glsl_expression *first, *last;
    unsigned count;
};

struct glsl_statements {
    struct glsl_statement *first, *last;
};

struct glsl_member { /* a field of a structure that is being read */
    const char *name;
    struct glsl_type type;
    struct glsl_place place;
    struct glsl_member *next;
};

struct glsl_members {
    struct glsl_member *first, *last;
    unsigned count;
};

/* --- check_expression.c --- */

struct glsl_expression *glsl_node_expression(struct glsl_context *context, enum glsl_operator operation,
                                             struct glsl_type type, struct glsl_place place);
struct glsl_expression *glsl_node_failed(struct glsl_context *context, struct glsl_place place);
static inline bool glsl_has_failed(const struct glsl_expression *x)
{
    return x->type.base == GLSL_ERROR;
}

struct glsl_expression *glsl_node_literal(struct glsl_context *context, struct glsl_place place,
                                          enum glsl_base base, union glsl_scalar value);
struct glsl_expression *glsl_node_name(struct glsl_context *context, struct glsl_place place,
                                       const char *name);
struct glsl_expression *glsl_node_index(struct glsl_context *context, struct glsl_place place,
                                        struct glsl_expression *array, struct glsl_expression *index);
struct glsl_expression *glsl_node_field(struct glsl_context *context, struct glsl_place place,
                                        struct glsl_expression *of, const char *name);
struct glsl_expression *glsl_node_unary(struct glsl_context *context, struct glsl_place place,
                                        enum glsl_operator operation, struct glsl_expression *x);
struct glsl_expression *glsl_node_binary(struct glsl_context *context, struct glsl_place place,
                                         enum glsl_operator operation, struct glsl_expression *a,
                                         struct glsl_expression *b);
struct glsl_expression *glsl_node_choose(struct glsl_context *context, struct glsl_place place,
                                         struct glsl_expression *condition, struct glsl_expression *a,
                                         struct glsl_expression *b);
struct glsl_expression *glsl_node_assign(struct glsl_context *context, struct glsl_place place,
                                         uint8_t update, struct glsl_expression *to,
                                         struct glsl_expression *value);
struct glsl_expression *glsl_node_sequence(struct glsl_context *context, struct glsl_place place,
                                           struct glsl_expression *a, struct glsl_expression *b);
/* Returns true if the expression can be written; reports why not. `use` completes "... is written". */
bool glsl_check_writable(struct glsl_context *context, struct glsl_expression *x);
/* The value of a constant expression of one int that is above 0; 1 after an error. */
int glsl_check_array_size(struct glsl_context *context, struct glsl_place place,
                          const struct glsl_expression *size);

/* --- check_call.c --- */

struct glsl_expression *glsl_node_call(struct glsl_context *context, struct glsl_place place,
                                       const char *name, const struct glsl_expressions *arguments);
struct glsl_expression *glsl_node_construct(struct glsl_context *context, struct glsl_place place,
                                            struct glsl_type type, const struct glsl_expressions *arguments);
void glsl_node_add_expression(struct glsl_expressions *list, struct glsl_expression *x);

/* --- check_declaration.c --- */

/* A qualifier of layout(...) out. */
void glsl_check_blend_support(struct glsl_context *context, struct glsl_place place, const char *name);

/* The beginning of a declaration. */
struct glsl_specifier glsl_node_specify(struct glsl_context *context, struct glsl_place place,
                                        struct glsl_type type, unsigned precision);
/* Reports the definition of a structure where only its name may be; `where` completes "... of ". */
void glsl_check_no_record(struct glsl_context *context, const struct glsl_specifier *specifier,
                          const char *where);
void glsl_node_default_precision(struct glsl_context *context, struct glsl_place place, unsigned precision,
                                 struct glsl_type type);
struct glsl_specifier glsl_node_qualify(struct glsl_context *context, struct glsl_place place,
                                        enum glsl_storage storage, bool invariant,
                                        struct glsl_specifier specifier);
/* Declares a variable; `size` is null or the size of an array, `initial` null or its value. Returns a
 * declaration, or null after an error. */
struct glsl_statement *glsl_node_declare(struct glsl_context *context, const struct glsl_specifier *specifier,
                                         struct glsl_place place, const char *name,
                                         struct glsl_expression *size, struct glsl_expression *initial,
                                         bool has_size);
/* `invariant NAME` */
void glsl_node_invariant(struct glsl_context *context, struct glsl_place place, const char *name);
/* A declaration that names no variable. */
void glsl_check_empty_declaration(struct glsl_context *context, const struct glsl_specifier *specifier);
struct glsl_type glsl_node_record(struct glsl_context *context, struct glsl_place place, const char *name,
                                  const struct glsl_members *members);
void glsl_node_add_member(struct glsl_context *context, struct glsl_members *members, struct glsl_place place,
                          struct glsl_type type, const char *name, struct glsl_expression *size,
                          bool has_size);

/* --- check_function.c --- */

struct glsl_variable *glsl_node_parameter(struct glsl_context *context, struct glsl_place place,
                                          bool is_const, enum glsl_storage storage,
                                          const struct glsl_specifier *specifier, const char *name,
                                          struct glsl_expression *size, bool has_size);
struct glsl_function *glsl_node_prototype(struct glsl_context *context, struct glsl_place place,
                                          const struct glsl_specifier *result, const char *name,
                                          struct glsl_variable *parameters);
void glsl_node_declare_function(struct glsl_context *context, struct glsl_function *function);
/* Begins the definition of a function: opens the scope of its parameters. */
struct glsl_function *glsl_node_begin_function(struct glsl_context *context, struct glsl_function *function);
void glsl_node_end_function(struct glsl_context *context, struct glsl_statement *body);
/* Checks of the whole unit: main, calls of undefined functions, recursion. */
void glsl_check_unit(struct glsl_context *context, struct glsl_place end);

/* --- check_statement.c --- */

struct glsl_statement *glsl_node_statement(struct glsl_context *context, enum glsl_statement_kind kind,
                                           struct glsl_place place);
void glsl_node_add_statement(struct glsl_statements *list, struct glsl_statement *statement);
/* Reports a condition that is not one bool. */
void glsl_check_condition(struct glsl_context *context, const struct glsl_expression *condition);
struct glsl_statement *glsl_node_jump(struct glsl_context *context, enum glsl_statement_kind kind,
                                      struct glsl_place place, struct glsl_expression *value);
struct glsl_statement *glsl_node_if(struct glsl_context *context, struct glsl_place place,
                                    struct glsl_expression *condition, struct glsl_statement *then,
                                    struct glsl_statement *other);

/* --- grammar.y --- */

/* Reads all tokens and makes the unit. */
void glsl_parse(struct glsl_context *context);

#endif
