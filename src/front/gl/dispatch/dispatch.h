/* The commands of OpenGL ES as functions of C: of the thread's current context. */
#ifndef GL_DISPATCH_H
#define GL_DISPATCH_H

#include "front/gl/context.h"

/* Makes a context current for the commands of this thread; null: none. Commands without a context, and those
 * that its interface does not have, do nothing and return 0. */
void gl_dispatch_set(struct gl_context *context, enum gl_interface interface);

typedef void gl_command(void);

/* Returns the function of a command, "glClear"; null if the command does not exist or has no implementation.
 * A context is not needed. */
gl_command *gl_dispatch_find(const char *name);

/* The interfaces, GL_ES1 and GL_ES2, whose core commands all have an implementation. */
unsigned gl_dispatch_interfaces(void);

#endif
