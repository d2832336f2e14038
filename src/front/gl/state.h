/* A context: the values that a program sets, and its bindings. */
#ifndef FRONT_GL_STATE_H
#define FRONT_GL_STATE_H

#include "front/gl/context.h"
#include "front/gl/object.h"

struct gl_buffer;
struct gl_debug;
struct gl_fixed;
struct gl_framebuffer;
struct gl_program;
struct gl_query;
struct gl_renderbuffer;
struct gl_texture;
struct gl_vertex_array;

/* Groups of values that are passed on to the renderer before the next draw (prepare.c). */
enum {
    GL_LATE_NOTHING = 0,
    GL_LATE_TARGET = 1,
    GL_LATE_AREA = 2,     /* viewport, scissor rectangle */
    GL_LATE_RASTER = 4,   /* everything that is a state of the renderer */
    GL_LATE_TEXTURES = 8, /* and their samplers */
    GL_LATE_PROGRAM = 16, /* uniforms that have changed */
    GL_LATE_SHADERS = 32, /* shaders, and all uniforms */
    GL_LATE_FIXED = 64,   /* uniforms of version 1.1 */
    GL_LATE_ALL = 127
};

/* The types of state.def. */
typedef GLboolean gl_type_BOOLEAN;
typedef GLenum gl_type_ENUM;
typedef GLint gl_type_INTEGER;
typedef GLuint gl_type_MASK;
typedef GLfloat gl_type_FLOAT;
typedef GLfloat gl_type_UNIT;

/* The rows of state.def with a field. Those with one number are arrays of one, so that all are read alike. */
struct gl_values {
#define GL_VALUE(name, field, type, count, late, ...) gl_type_##type field[count];
#define GL_CAPABILITY(name, field, late, initial)     GLboolean field[1];
#define GL_LIMIT(name, type, count, ...)
#define GL_COMPUTED(name, type, function)
#include "front/gl/state.def"
#undef GL_VALUE
#undef GL_CAPABILITY
#undef GL_LIMIT
#undef GL_COMPUTED
    /* Of version 1.1. */
#define GL_CAPABILITY(name, field, late, initial) GLboolean field[1];
#include "front/gl/fixed.def"
};

enum gl_dimension { GL_DIMENSION_2D, GL_DIMENSION_CUBE, GL_DIMENSIONS };

struct gl_context {
    struct gl_share *share;
    struct gl_device *device;
    triptych_device *renderer; /* of the device */
    struct gl_context_options options;
    struct gl_names names[GL_KINDS - GL_SHARED_KINDS];

    GLenum error;           /* the first that was not fetched */
    struct gl_debug *debug; /* null: no command of messages was called yet */
    struct gl_values values;
    struct gl_fixed *fixed; /* of version 1.1; null: a context of version 2.0 */
    unsigned late;          /* GL_LATE_... */

    /* Default framebuffers; null: none. */
    struct gl_surface *draw_surface, *read_surface;
    unsigned generation;    /* of the surface that the renderer has */
    unsigned moves;         /* of the share group when the renderer got the surfaces */
    unsigned image_changes; /* of the device, as the textures that the renderer has */
    bool bound;             /* was bound to a surface before */
    GLenum back_buffer;     /* glDrawBuffers of the default framebuffer: GL_BACK or GL_NONE */

    /* Bindings. Each holds its object; null: name 0. */
    struct gl_buffer *array_buffer;
    struct gl_vertex_array *vertex_array, *vertex_array_0; /* never null */
    struct gl_framebuffer *framebuffer;
    struct gl_renderbuffer *renderbuffer;
    struct gl_program *program;
    bool turned;  /* the last draw had its fragment shader for clockwise fronts */
    uint8_t form; /* and in this enum gl_form */
    struct gl_texture *texture_0[GL_DIMENSIONS];         /* the textures with the name 0 */
    struct gl_texture *texture[GL_UNITS][GL_DIMENSIONS]; /* never null */

    GLfloat current[GL_ATTRIBUTES][4]; /* values of attributes without an array */
    bool current_changed;
    triptych_buffer *current_buffer; /* the same for the renderer; null until it is needed */
    struct gl_stream {               /* memory of the program that draws read (stream.c) */
        triptych_buffer *buffer;
        size_t bytes, used;
        bool fresh; /* nothing of it is used yet */
    } stream;
    uint32_t declared; /* attributes of the declaration and their formats, as the renderer has them */
    struct triptych_declaration_element declaration[GL_ATTRIBUTES];
};

/* Give all values their initial ones. */
void gl_state_reset(struct gl_context *);

/* Returns true if fronts are counter-clockwise in the rows of a window. EXT_clip_control turns pictures over,
 * and not faces. */
static inline bool gl_state_front_ccw(const struct gl_values *values)
{
    return (values->front_face[0] == GL_CCW) == (values->clip_origin[0] == GL_LOWER_LEFT_EXT);
}

/* The unit of glActiveTexture. */
static inline unsigned gl_state_unit(const struct gl_context *context)
{
    return context->values.active_texture[0] - GL_TEXTURE0;
}

#endif
