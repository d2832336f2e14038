/* Lists of attributes, of either width. */
#ifndef EGL_ATTRIBUTES_H
#define EGL_ATTRIBUTES_H

#include "types.h"

enum { EGL_PAIRS = 32 };

/* A list of names and values with EGL_NONE at its end. */
struct egl_list {
    EGLAttrib word[2 * EGL_PAIRS + 1];
};

/* Copies a list, which may be null: then it is empty. A longer list ends early with a name that no function
 * accepts. Returns `list`. */
const EGLAttrib *egl_list_widen(struct egl_list *list, const EGLint *words);

#endif
