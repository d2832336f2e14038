/* Shaders and programs: chapter 2.10. Both have names of one space. */
#ifndef FRONT_GL_PROGRAM_PROGRAM_H
#define FRONT_GL_PROGRAM_PROGRAM_H

#include "front/gl/object.h"
#include "front/glsl/program.h"

enum { GL_CONSTANTS = 256 }; /* registers of a stage */

/* The colours that a fragment shader gives: one for each target; one, and the second colour of blending; or
 * one for all targets, gl_FragColor. */
enum gl_form { GL_FORM_TARGETS, GL_FORM_SECOND, GL_FORM_BROADCAST, GL_FORMS };

/* The head of both. */
struct gl_code {
    struct gl_object object;
    bool is_program;
    char *log; /* never null after a compilation or a link that had memory */
};

struct gl_shader {
    struct gl_code code;
    enum glsl_stage stage;
    char *source;           /* null: none */
    struct glsl_unit *unit; /* of the last compilation; null if it failed. Programs keep their own of it */
};

/* A location of an attribute that the program requests. */
struct gl_wish {
    char *name;
    unsigned location;
};

/* The meaning of a location. */
struct gl_location {
    uint16_t uniform, element;
};

/* The registers of a stage that have changed. */
struct gl_constants {
    float value[GL_CONSTANTS][4];
    unsigned used, first, last; /* `last` 0: no change */
};

struct gl_program {
    struct gl_code code;
    struct gl_shader *shader[GLSL_STAGES]; /* attached: held */
    struct gl_wish *wish;
    unsigned wishes;
    bool linked, validated; /* the last link succeeded; of glValidateProgram */

    /* Of the last link that succeeded. A link that fails keeps them while the program is in use. */
    struct glsl_program *program;
    triptych_shader *stage[GLSL_STAGES];
    triptych_shader *turned; /* the fragment shader where clockwise triangles are front; null: the same */
    triptych_shader
        *other[GL_FORMS][2]; /* the fragment shader in other forms, and turned; null: not made yet */
    struct gl_location *location;
    unsigned locations;
    struct gl_constants constants[GLSL_STAGES];
    uint8_t unit[GLSL_STAGES][TRIPTYCH_VERTEX_SAMPLER]; /* of each sampler */
};

/* Finds a program; null with an error: GL_INVALID_OPERATION for a shader, else GL_INVALID_VALUE. */
struct gl_program *gl_program_find(struct gl_context *, GLuint name);
/* The same for a name that can also be that of the other kind. */
struct gl_code *gl_code_find(struct gl_context *, GLuint name, bool program);
/* Copies a text without its zero, as the getters of logs and names do. */
void gl_code_copy_text(const char *text, GLsizei room, GLsizei *length, GLchar *out);
/* Returns true if a draw can use a linked program: no unit has samplers of two types. */
bool gl_program_is_valid(const struct gl_program *);
/* The fragment shader in a form, and turned if the program has such a one. Without memory for it, the first
 * form, with an error. */
triptych_shader *gl_program_pixel(struct gl_context *, struct gl_program *, enum gl_form, bool turned);
/* Makes locations and the initial values of uniforms, after a link. Returns false without memory. */
bool gl_uniforms_begin(struct gl_program *);
/* Sets an element of a uniform by its name, column after column. A name that is not active is ignored. */
void gl_uniforms_set(struct gl_program *, const char *name, unsigned element, const GLfloat *values);
/* Sets gl_DepthRange. */
void gl_uniforms_set_range(struct gl_program *, const GLfloat range[2]);
/* The constant of GL_FLOAT_VEC3 and so on. */
GLenum gl_code_type(struct glsl_type);

#endif
