/* Objects with names: how long they live, and what a share group has in common.
 *
 * The name holds one reference, and so does each binding and each attachment. A deleted name can be given to
 * a new object while the old one is still in use by other contexts. */
#ifndef FRONT_GL_OBJECT_H
#define FRONT_GL_OBJECT_H

#include "front/gl/gl.h"
#include "front/gl/name.h"

enum gl_kind {
    GL_KIND_BUFFER,
    GL_KIND_TEXTURE,
    GL_KIND_PROGRAM, /* and shaders: one space of names */
    GL_KIND_RENDERBUFFER,
    GL_SHARED_KINDS,
    GL_KIND_FRAMEBUFFER = GL_SHARED_KINDS, /* those of one context */
    GL_KIND_VERTEX_ARRAY,
    GL_KIND_QUERY,
    GL_KINDS
};

struct gl_share {
    unsigned references; /* of contexts */
    struct gl_device *device;
    triptych_device *renderer; /* of the device */
    unsigned moves; /* of stencil between surfaces (texture/depth.h): surfaces may have to be set again */
    struct gl_names names[GL_SHARED_KINDS];
};

struct gl_object {
    GLuint name;
    uint32_t references;
    /* Of a program or a shader: its name has no reference any more, and goes when nothing uses it. */
    bool deleted;
    struct gl_share *share;
    char *label; /* of KHR_debug; null: none */
    void (*destroy)(struct gl_object *);
};

/* Makes an object of `bytes` bytes, all 0 beyond its head, with one reference. Null if memory is refused. */
void *gl_object_make(struct gl_share *, size_t bytes, GLuint name, void (*destroy)(struct gl_object *));
/* Releases a reference; null is allowed. */
void gl_object_release(struct gl_object *);
/* Puts an object into a place that holds it: `*place` becomes `object`. Both can be null. */
void gl_object_hold(struct gl_object **place, struct gl_object *object);
#define GL_HOLD(place, other) gl_object_hold((struct gl_object **)(place), (struct gl_object *)(other))

/* The table of a kind; of the context or of its share group. */
struct gl_names *gl_object_names(struct gl_context *, enum gl_kind);
struct gl_object *gl_object_find(struct gl_context *, enum gl_kind, GLuint name);
/* Reserves names (glGen...). */
void gl_object_generate(struct gl_context *, enum gl_kind, GLsizei count, GLuint *names);
/* Returns the object of a name, made by `make` at its first use; null with an error if memory is refused. */
struct gl_object *gl_object_bind(struct gl_context *, enum gl_kind, GLuint name,
                                 struct gl_object *(*make)(struct gl_context *, GLuint name));
/* Checks glDelete...'s count, and frees names. `unbind` removes bindings of this context first; null: none.
 */
void gl_object_delete(struct gl_context *, enum gl_kind, GLsizei count, const GLuint *names,
                      void (*unbind)(struct gl_context *, struct gl_object *));

#endif
