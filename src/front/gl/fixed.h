/* OpenGL ES 1.1: transformation, lighting, texture environments and fog, as programs of the machine.
 *
 * A draw of a context of version 1.1 makes a key of all that decides which steps a vertex and a fragment
 * take. Each key has a program, whose text is in the shading language of version 2.0. Programs are kept by
 * their keys. The rest is uniforms: matrices, colours and coefficients.
 *
 * Why not the renderer's fixed function: it is that of Direct3D 9. Lights of OpenGL have another spot, one
 * colour for both sums and a second side; environments read any unit and scale colour and alpha apart.
 *
 * Source: "OpenGL ES Common/Common-Lite Profile Specification", version 1.1.12. */
#ifndef FRONT_GL_FIXED_H
#define FRONT_GL_FIXED_H

#include "front/gl/gl.h"

struct gl_program;

enum {
    GL_FIXED_LIGHTS = 8,
    GL_FIXED_PLANES = 6,
    GL_FIXED_UNITS = 4,
    GL_FIXED_DEPTH = 32,
    GL_FIXED_KEPT = 64
};

/* Locations of attributes. */
enum gl_fixed_attribute {
    GL_FIXED_POSITION,
    GL_FIXED_NORMAL,
    GL_FIXED_COLOR,
    GL_FIXED_COORDINATES, /* of unit 0; the other units follow */
    GL_FIXED_SIZE = GL_FIXED_COORDINATES + GL_FIXED_UNITS
};

/* Enumerations are numbers too, so that one table has all parameters (parameter.c). */
struct gl_fixed_light {
    GLfloat ambient[4], diffuse[4], specular[4];
    GLfloat position[4], direction[4]; /* of eye space */
    GLfloat exponent, cutoff;
    GLfloat constant, linear, quadratic;
};

struct gl_fixed_material {
    GLfloat ambient[4], diffuse[4], specular[4], emission[4], shininess;
};

struct gl_fixed_environment {
    GLfloat mode, color[4], replace;
    GLfloat combine[2]; /* of colours, of alpha */
    GLfloat source[2][3], operand[2][3];
    GLfloat scale[2];
};

struct gl_fixed_stack {
    unsigned depth; /* the top */
    GLfloat matrix[GL_FIXED_DEPTH][16];
};

/* The state that decides on the program of a draw. Bytes and words without padding, compared as memory. */
struct gl_fixed_unit_key {
    uint16_t mode, combine[2], source[2][3], operand[2][3];
    uint8_t enabled, color, alpha; /* the texture has colours, has alpha */
    uint8_t replace;               /* coordinates of sprites */
    uint8_t scale[2];
};

struct gl_fixed_key {
    struct gl_fixed_unit_key unit[GL_FIXED_UNITS];
    uint16_t fog; /* the mode, 0: none */
    uint8_t lighting, lights, two_side, color_material, normalize, rescale;
    uint8_t planes, points, size_array, flat, alpha_to_one;
};

struct gl_fixed_program {
    struct gl_fixed_key key;
    struct gl_program *program; /* held; null: a free place */
    uint64_t used;              /* the draw that used it last */
};

struct gl_fixed {
#define GL_NUMBER(name, field, type, count, ...) GLfloat field[count];
#include "front/gl/fixed.def"
    struct gl_fixed_light light[GL_FIXED_LIGHTS];
    struct gl_fixed_material material;
    struct gl_fixed_environment environment[GL_FIXED_UNITS];
    GLboolean texture_2d[GL_FIXED_UNITS];
    GLfloat plane[GL_FIXED_PLANES][4]; /* of eye space */
    struct gl_fixed_stack modelview, projection, texture[GL_FIXED_UNITS];

    struct gl_fixed_program kept[GL_FIXED_KEPT];
    uint64_t draws;
};

/* Makes and frees the values of a context of version 1.1. Returns false without memory. */
bool gl_fixed_begin(struct gl_context *);
void gl_fixed_end(struct gl_context *);

/* Finds or makes the program of a draw, which becomes the context's, and sets its uniforms. Returns false if
 * nothing is to be drawn: without an array of vertices, or with an error without memory. */
bool gl_fixed_prepare(struct gl_context *, GLenum mode);
/* The texts of a key's program; null without memory. The caller frees them. */
char *gl_fixed_vertex_text(const struct gl_fixed_key *);
char *gl_fixed_fragment_text(const struct gl_fixed_key *);

/* The switch of a texture unit, GL_TEXTURE_2D; null for other names. */
GLboolean *gl_fixed_switch(struct gl_context *, GLenum name);
/* A hint of version 1.1; null for other names. */
GLfloat *gl_fixed_hint(struct gl_context *, GLenum name);
/* Values of glGet... that are computed: numbers in `out`, which has 16 places. Returns how many; 0:
 * unknown. `*unit` becomes true for numbers whose range is stretched to that of integers. */
unsigned gl_fixed_get(struct gl_context *, GLenum name, GLfloat *out, bool *number, bool *unit);
/* Returns false if the name is not that of an array's address. */
bool gl_fixed_pointer(struct gl_context *, GLenum name, void **out);

/* The top of the stack of modelview matrices. */
const GLfloat *gl_fixed_modelview(const struct gl_fixed *);
/* to = matrix * vector; in columns, as glLoadMatrixf. */
void gl_matrix_apply(const GLfloat matrix[16], const GLfloat vector[4], GLfloat to[4]);
/* The inverse; of a singular matrix, numbers without a meaning, which are not NaN. */
void gl_matrix_invert(const GLfloat matrix[16], GLfloat to[16]);

/* Groups of parameters, by their commands: bits. */
enum gl_group {
    GL_GROUP_NONE = 0,
    GL_GROUP_LIGHT = 1,
    GL_GROUP_MATERIAL = 2,
    GL_GROUP_FOG = 4,
    GL_GROUP_LIGHT_MODEL = 8,
    GL_GROUP_POINT = 16,
    GL_GROUP_SPRITE = 32,
    GL_GROUP_ENVIRONMENT = 64
};

/* A parameter of some groups (parameter.c): how many numbers it has, and if they are enumerations, which
 * commands of fixed-point numbers do not scale. Returns 0 for names that the groups do not have. */
unsigned gl_parameter_count(GLenum name, unsigned groups, bool *enumeration);

#endif
