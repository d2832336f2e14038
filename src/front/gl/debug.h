/* Messages of KHR_debug: errors of commands, messages of the program, and groups of them. */
#ifndef FRONT_GL_DEBUG_H
#define FRONT_GL_DEBUG_H

#include "front/gl/gl.h"

enum {
    GL_DEBUG_TEXT = 1024, /* bytes of a message or a label, with its zero */
    GL_DEBUG_LOGGED = 64, /* messages that wait for glGetDebugMessageLog */
    GL_DEBUG_GROUPS = 64
};

/* Returns true if messages are received: the caller makes the text of one only then. */
bool gl_debug_wants(const struct gl_context *, GLenum type);
/* Reports a message of the front end itself (GL_DEBUG_SOURCE_API). */
void gl_debug_message(struct gl_context *, GLenum type, GLuint id, GLenum severity, const char *text);
void gl_debug_free(struct gl_context *);

/* For glGet...: messages in the log, the length of the first one, and groups including the outer one. */
int32_t gl_debug_logged(const struct gl_context *);
int32_t gl_debug_next_length(const struct gl_context *);
int32_t gl_debug_depth(const struct gl_context *);

#endif
