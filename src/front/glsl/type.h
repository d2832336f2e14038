/* Types: a value of a few words that is passed by copy (section 4.1). */
#ifndef FRONT_GLSL_TYPE_H
#define FRONT_GLSL_TYPE_H

#include "front/glsl/arena.h"

#include <stdbool.h>
#include <stdint.h>

enum glsl_base {
    GLSL_VOID,
    GLSL_FLOAT,
    GLSL_INT,
    GLSL_BOOL,
    GLSL_SAMPLER_2D,
    GLSL_SAMPLER_CUBE,
    GLSL_STRUCT,
    GLSL_ERROR /* of an expression with an error that has been reported */
};

enum glsl_precision { GLSL_NO_PRECISION, GLSL_LOW, GLSL_MEDIUM, GLSL_HIGH };

struct glsl_record;

struct glsl_type {
    uint8_t base;          /* enum glsl_base */
    uint8_t rows, columns; /* 1 and 1: a scalar; rows and 1: a vector; 2 to 4 each: a matrix */
    uint8_t precision;
    int array; /* the number of elements; 0: not an array */
    const struct glsl_record *record;
};

struct glsl_field {
    const char *name;
    struct glsl_type type;
};

/* A structure. Two types with the same record are the same type. */
struct glsl_record {
    const char *name; /* empty if it has none */
    struct glsl_field *field;
    unsigned count;
};

static inline struct glsl_type glsl_type_of(enum glsl_base base, unsigned rows, unsigned columns)
{
    return (struct glsl_type){.base = (uint8_t)base, .rows = (uint8_t)rows, .columns = (uint8_t)columns};
}

static inline struct glsl_type glsl_error_type(void)
{
    return glsl_type_of(GLSL_ERROR, 1, 1);
}

static inline bool glsl_is_sampler(struct glsl_type type)
{
    return type.base == GLSL_SAMPLER_2D || type.base == GLSL_SAMPLER_CUBE;
}

static inline bool glsl_is_numeric(struct glsl_type type)
{
    return type.base >= GLSL_FLOAT && type.base <= GLSL_BOOL;
}

static inline bool glsl_is_scalar(struct glsl_type type)
{
    return glsl_is_numeric(type) && type.rows == 1 && type.columns == 1 && !type.array;
}

static inline bool glsl_is_vector(struct glsl_type type)
{
    return glsl_is_numeric(type) && type.rows > 1 && type.columns == 1 && !type.array;
}

static inline bool glsl_is_matrix(struct glsl_type type)
{
    return type.columns > 1 && !type.array;
}

/* The same type, regardless of precision. */
bool glsl_same_type(struct glsl_type a, struct glsl_type b);

/* The type of an element of an array, of a column of a matrix, of a component of a vector. */
struct glsl_type glsl_element_type(struct glsl_type type);

/* The number of scalars of a value, of all elements and fields. */
unsigned glsl_scalars(struct glsl_type type);

/* Returns true if the type is or contains an array, or a sampler. */
bool glsl_has_array(struct glsl_type type);
bool glsl_has_sampler(struct glsl_type type);

/* The type as in a source, "vec3[4]". */
const char *glsl_type_name(struct glsl_arena *arena, struct glsl_type type);

#endif
