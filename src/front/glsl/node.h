/* The checked program: expressions with types, statements, functions, variables. All are in the arena. */
#ifndef FRONT_GLSL_NODE_H
#define FRONT_GLSL_NODE_H

#include "front/glsl/glsl.h"
#include "front/glsl/log.h"
#include "front/glsl/type.h"

#include <stdbool.h>
#include <stdint.h>

/* One scalar of a constant. A bool is 0 or 1 in `i`. */
union glsl_scalar {
    float f;
    int32_t i;
};

enum glsl_storage {
    GLSL_LOCAL, /* of a function, or global without a qualifier */
    GLSL_CONSTANT_STORAGE,
    GLSL_ATTRIBUTE,
    GLSL_UNIFORM,
    GLSL_VARYING,
    GLSL_IN, /* parameters */
    GLSL_CONST_IN,
    GLSL_OUT,
    GLSL_INOUT,
    GLSL_BUILTIN_IN, /* gl_FragCoord and others that are only read */
    GLSL_BUILTIN_OUT /* gl_Position and others */
};

struct glsl_variable {
    const char *name;
    struct glsl_type type;
    uint8_t storage; /* enum glsl_storage */
    uint8_t builtin; /* enum glsl_builtin_variable, for the two last kinds of storage */
    bool invariant, global;
    bool read, written;             /* by a statement */
    const union glsl_scalar *value; /* of a constant */
    struct glsl_place place;
    struct glsl_variable *next; /* global ones of the unit, or parameters of a function */
};

enum glsl_operator {
    GLSL_VALUE,        /* a constant: `value` */
    GLSL_READ,         /* `variable` */
    GLSL_FIELD,        /* operand 0, `index` */
    GLSL_INDEX,        /* operand 0, operand 1 */
    GLSL_SWIZZLE,      /* operand 0, `swizzle`, of as many components as the type has */
    GLSL_CALL,         /* `function`, arguments */
    GLSL_CALL_BUILTIN, /* `index` of builtin.def, arguments */
    GLSL_CONSTRUCT,    /* `type`, arguments */
    GLSL_NEGATE,
    GLSL_NOT,
    GLSL_INCREMENT, /* before: the new value */
    GLSL_DECREMENT,
    GLSL_INCREMENT_AFTER,
    GLSL_DECREMENT_AFTER,
    GLSL_ADD,
    GLSL_SUBTRACT,
    GLSL_MULTIPLY,
    GLSL_DIVIDE,
    GLSL_LESS,
    GLSL_GREATER,
    GLSL_LESS_EQUAL,
    GLSL_GREATER_EQUAL,
    GLSL_EQUAL,
    GLSL_NOT_EQUAL,
    GLSL_AND,
    GLSL_XOR,
    GLSL_OR,
    GLSL_SELECT,   /* operand 0 ? operand 1 : operand 2 */
    GLSL_ASSIGN,   /* operand 0 = operand 1; with `update`: operand 0 update= operand 1 */
    GLSL_SEQUENCE, /* operand 0, operand 1 */
};

struct glsl_function;

struct glsl_expression {
    uint8_t operation; /* enum glsl_operator */
    uint8_t update;    /* of an assignment: GLSL_ADD to GLSL_DIVIDE, or 0 */
    uint8_t swizzle[4];
    bool impure; /* it or a part of it assigns, or calls a function that can */
    uint16_t index;
    struct glsl_type type;
    struct glsl_place place;
    struct glsl_expression *operand[3];
    struct glsl_expression *argument, *next; /* the first argument; the next one in a list */
    struct glsl_variable *variable;
    struct glsl_function *function;
    const union glsl_scalar
        *value; /* of a constant expression (5.10), also if the operation is another one */
};

enum glsl_statement_kind {
    GLSL_BLOCK,       /* `body` */
    GLSL_EXPRESSION,  /* `expression`; null: empty */
    GLSL_DECLARATION, /* `variable` = `expression`, or without */
    GLSL_IF,          /* `expression`, `body`, `other` */
    GLSL_FOR,         /* `first`, `condition` or `expression`, `each`, `body` */
    GLSL_WHILE,       /* the same without `first` and `each` */
    GLSL_DO,          /* `body`, `expression` */
    GLSL_BREAK,
    GLSL_CONTINUE,
    GLSL_RETURN, /* `expression` or without */
    GLSL_DISCARD
};

struct glsl_statement {
    uint8_t kind; /* enum glsl_statement_kind */
    struct glsl_place place;
    struct glsl_statement *next; /* in a block */
    struct glsl_statement *first, *body, *other;
    struct glsl_statement *condition; /* a declaration, whose variable is the condition */
    struct glsl_expression *expression, *each;
    struct glsl_variable *variable;
};

/* A function that another one calls. */
struct glsl_callee {
    struct glsl_function *function;
    struct glsl_place place;
    struct glsl_callee *next;
};

struct glsl_function {
    const char *name;
    struct glsl_type type;
    struct glsl_variable *parameter; /* a list */
    unsigned parameters;
    struct glsl_statement *body; /* null: declared only */
    bool defined;
    uint8_t visit; /* by the search for recursion: 0 not yet, 1 in it, 2 done */
    struct glsl_callee *callee;
    struct glsl_place place;
    struct glsl_function *overload; /* the next one of that name in its scope */
    struct glsl_function *next;     /* of the unit */
};

/* A compiled source. */
struct glsl_unit {
    struct glsl_arena arena;
    enum glsl_stage stage;
    struct glsl_variable *global, **last_global;
    struct glsl_function *function, **last_function;
    struct glsl_statement *initial, **last_initial; /* declarations of global variables, in their order */
    struct glsl_function *main;
    uint32_t builtins;   /* bit i: the builtin variable i is used */
    uint32_t invariants; /* bit i: it is invariant */
    uint16_t blends;     /* bit i: the equation i of blend.def is allowed */
    bool invariant_all;  /* #pragma STDGL invariant(all) */
};

#endif
