/* Names of objects: a table from names, any numbers but 0, to objects. A name can be reserved without an
 * object. Names are given from 1 up, each the least one that was not given yet. */
#ifndef FRONT_GL_NAME_H
#define FRONT_GL_NAME_H

#include "front/gl/gl.h"

struct gl_object;

struct gl_names {
    struct gl_name {
        GLuint name; /* 0: free */
        struct gl_object *object;
    } * slot;
    unsigned slots, used; /* slots: a power of two, or 0 */
    GLuint next;
};

/* Reserves `count` new names. Returns false, and reserves none, if memory is refused. */
bool gl_names_reserve(struct gl_names *, GLsizei count, GLuint *names);
/* Returns null for a name that has no object. */
struct gl_object *gl_names_find(const struct gl_names *, GLuint name);
bool gl_names_has(const struct gl_names *, GLuint name);
/* Gives a name an object, or reserves it with null. Returns false if memory is refused. */
bool gl_names_put(struct gl_names *, GLuint name, struct gl_object *object);
void gl_names_remove(struct gl_names *, GLuint name);
/* Returns any object that is left, and removes its name; null if there is none. */
struct gl_object *gl_names_take(struct gl_names *);
void gl_names_free(struct gl_names *);

#endif
