/* Lowering: the checked tree of one stage to code (code.h). Functions are inlined; conditions without
 * effects and products of bools are computed instead of branched on.
 *
 * A value is where its registers are, or constants. It is not copied before an operation needs it, so a
 * variable that is read stays a reference to the variable. Before an operand that can change variables,
 * earlier operands are copied (glsl_lower_before). */
#ifndef FRONT_GLSL_LOWER_H
#define FRONT_GLSL_LOWER_H

#include "front/glsl/check/builtin.h"
#include "front/glsl/lower/code.h"

struct glsl_value {
    struct glsl_type type;
    const union glsl_scalar *constant; /* null: the value is in registers */
    struct glsl_operand at;            /* the first one */
    uint32_t root, registers;          /* the block that it is a part of: a variable */
};

/* The place that an assignment writes. */
struct glsl_place_to {
    struct glsl_value value;
    struct glsl_operand component; /* of a vector, chosen by a value; file NONE: all of `value` */
};

/* Where a variable is. */
struct glsl_binding_of {
    const struct glsl_variable *variable;
    struct glsl_value value;
};

/* The function that is being inlined. */
struct glsl_inlined {
    const struct glsl_function *function;
    struct glsl_value result;
    struct glsl_operand returned; /* not 0 after a return; file NONE: all returns are at the end */
    unsigned loops;               /* of the function, around the statement */
};

/* The innermost loop. */
struct glsl_loop {
    const struct glsl_expression *each;      /* evaluated before the next pass */
    const struct glsl_expression *condition; /* of do: tested before the next pass */
};

struct glsl_lowering {
    struct glsl_code code;
    struct glsl_binding_of *binding; /* a hash table by variable */
    unsigned bindings, binding_room;
    struct glsl_inlined inlined;
    struct glsl_loop loop;
    unsigned depth, calls, call_depth;
    struct glsl_operand facing; /* gl_FrontFacing */
    struct glsl_operand point;  /* gl_PointCoord */
    struct glsl_value
        result[GLSL_BUILTIN_VARIABLES]; /* of the outputs that are used, by enum glsl_builtin_variable */
    uint32_t has_result;
};

enum { GLSL_MOST_DEPTH = 1000, GLSL_MOST_CALLS = 20000, GLSL_MOST_CALL_DEPTH = 128 };

/* --- value.c --- */

struct glsl_value glsl_value_constant(struct glsl_type type, const union glsl_scalar *constant);
struct glsl_value glsl_value_temporary(struct glsl_lowering *l, struct glsl_type type);
/* The value of one register. */
struct glsl_value glsl_value_of(struct glsl_type type, struct glsl_operand at);
/* Register i of a value. Literals of a constant are added to the code. */
struct glsl_operand glsl_value_part(struct glsl_lowering *l, const struct glsl_value *value, unsigned i);
/* The rows of register i of a type. */
unsigned glsl_value_rows(struct glsl_type type, unsigned i);
void glsl_value_copy(struct glsl_lowering *l, const struct glsl_value *to, const struct glsl_value *from);
/* The value in temporaries of its own. */
struct glsl_value glsl_value_copied(struct glsl_lowering *l, const struct glsl_value *from);
/* The scalar in component x of a temporary that does not change; for addresses. */
struct glsl_operand glsl_value_index(struct glsl_lowering *l, struct glsl_operand scalar);
/* Binds a variable to where it is. */
void glsl_value_bind(struct glsl_lowering *l, const struct glsl_variable *variable, struct glsl_value value);
struct glsl_value glsl_value_variable(struct glsl_lowering *l, const struct glsl_variable *variable);

/* --- access.c --- */

/* The place of a variable or a part of one. */
struct glsl_place_to glsl_lower_place(struct glsl_lowering *l, const struct glsl_expression *x);
struct glsl_value glsl_lower_part(struct glsl_lowering *l, const struct glsl_expression *x);
void glsl_lower_write(struct glsl_lowering *l, const struct glsl_place_to *to,
                      const struct glsl_value *value);
struct glsl_value glsl_lower_read(struct glsl_lowering *l, const struct glsl_place_to *place);

/* --- expression.c --- */

struct glsl_value glsl_lower_expression(struct glsl_lowering *l, const struct glsl_expression *x);
/* The same for an expression whose value is not used. */
void glsl_lower_effects(struct glsl_lowering *l, const struct glsl_expression *x);
/* The only register of a scalar or vector. */
struct glsl_operand glsl_lower_operand(struct glsl_lowering *l, const struct glsl_expression *x);
/* The value of an operand before another one is evaluated; `later` null: there is none. */
struct glsl_value glsl_lower_before(struct glsl_lowering *l, const struct glsl_expression *x,
                                    const struct glsl_expression *later);

/* Returns true if an expression of a list is impure. */
bool glsl_lower_any_impure(const struct glsl_expression *x);
/* The value of an argument, copied if one after it can change it. */
struct glsl_value glsl_lower_argument(struct glsl_lowering *l, const struct glsl_expression *x);

/* --- condition.c --- */

struct glsl_condition {
    uint8_t comparison;
    struct glsl_operand a, b;
};

/* A bool as a comparison that holds if the bool equals `holds`. */
struct glsl_condition glsl_lower_condition(struct glsl_lowering *l, const struct glsl_expression *x,
                                           bool holds);
struct glsl_value glsl_lower_logical(struct glsl_lowering *l, const struct glsl_expression *x);
struct glsl_value glsl_lower_equal(struct glsl_lowering *l, const struct glsl_expression *x);
struct glsl_value glsl_lower_select(struct glsl_lowering *l, const struct glsl_expression *x);
/* All components combined by MIN, which is "and", or MAX, which is "or". */
struct glsl_operand glsl_lower_reduce(struct glsl_lowering *l, enum glsl_op op, struct glsl_operand vector,
                                      unsigned rows);

/* --- construct.c --- */

struct glsl_value glsl_lower_construct(struct glsl_lowering *l, const struct glsl_expression *x);

/* --- matrix.c --- */

struct glsl_value glsl_lower_product(struct glsl_lowering *l, const struct glsl_value *a,
                                     const struct glsl_value *b, struct glsl_type type);

/* --- call.c, builtin.c, texture.c --- */

struct glsl_value glsl_lower_call(struct glsl_lowering *l, const struct glsl_expression *x);
struct glsl_value glsl_lower_builtin(struct glsl_lowering *l, const struct glsl_expression *x);
struct glsl_value glsl_lower_texture(struct glsl_lowering *l, const struct glsl_expression *x);

/* --- statement.c --- */

/* Lowers a list of statements, at whose end the function ends if `tail` is set. */
void glsl_lower_statements(struct glsl_lowering *l, const struct glsl_statement *list, bool tail);
/* The declaration of a global variable with a value. */
void glsl_lower_global(struct glsl_lowering *l, const struct glsl_statement *declaration);
/* Returns true if a return inside of the statement is not at the end of the function. */
bool glsl_lower_needs_flag(const struct glsl_statement *body);

/* --- lower.c --- */

/* The value of a variable of the language that is only read. */
struct glsl_value glsl_lower_source(struct glsl_lowering *l, const struct glsl_variable *variable);

/* The code of a unit, in its arena. code->failure is the reason if there is none. */
struct glsl_lowering *glsl_lower(struct glsl_arena *arena, const struct glsl_unit *unit);

#endif
