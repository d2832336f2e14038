#include "front/gl/object.h"
#include "front/gl/state.h"

#include <stdlib.h>

void *gl_object_make(struct gl_share *share, size_t bytes, GLuint name, void (*destroy)(struct gl_object *))
{
    struct gl_object *object = calloc(1, bytes);
    if (object)
        *object = (struct gl_object){.name = name, .references = 1, .share = share, .destroy = destroy};
    return object;
}

void gl_object_release(struct gl_object *object)
{
    if (!object || --object->references)
        return;
    if (object->destroy)
        object->destroy(object);
    free(object->label);
    free(object);
}

void gl_object_hold(struct gl_object **place, struct gl_object *object)
{
    struct gl_object *old = *place;
    if (object)
        object->references++;
    *place = object;
    gl_object_release(old);
}

struct gl_names *gl_object_names(struct gl_context *context, enum gl_kind kind)
{
    return kind < GL_SHARED_KINDS ? &context->share->names[kind] : &context->names[kind - GL_SHARED_KINDS];
}

struct gl_object *gl_object_find(struct gl_context *context, enum gl_kind kind, GLuint name)
{
    return gl_names_find(gl_object_names(context, kind), name);
}

void gl_object_generate(struct gl_context *context, enum gl_kind kind, GLsizei count, GLuint *names)
{
    if (count < 0)
        gl_error(context, GL_INVALID_VALUE, "found %d names, expected 0 or more", count);
    else if (!gl_names_reserve(gl_object_names(context, kind), count, names))
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for %d names", count);
}

struct gl_object *gl_object_bind(struct gl_context *context, enum gl_kind kind, GLuint name,
                                 struct gl_object *(*make)(struct gl_context *, GLuint name))
{
    struct gl_object *object = gl_object_find(context, kind, name);
    if (object)
        return object;
    object = make(context, name);
    if (object && gl_names_put(gl_object_names(context, kind), name, object))
        return object;
    gl_object_release(object);
    gl_error(context, GL_OUT_OF_MEMORY, "no memory for an object");
    return NULL;
}

void gl_object_delete(struct gl_context *context, enum gl_kind kind, GLsizei count, const GLuint *names,
                      void (*unbind)(struct gl_context *, struct gl_object *))
{
    if (count < 0)
        gl_error(context, GL_INVALID_VALUE, "found %d names, expected 0 or more", count);
    for (GLsizei i = 0; i < count; i++) {
        struct gl_object *object = gl_object_find(context, kind, names[i]);
        gl_names_remove(gl_object_names(context, kind), names[i]);
        if (object && unbind)
            unbind(context, object);
        gl_object_release(object);
    }
}
