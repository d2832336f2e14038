/* The commands of OpenGL ES by their tables: each has a structure of its arguments, `struct gles_NAME`, and a
 * row that describes their types. Shared by the files of the target `gles`. */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_GL_GLES_CALL_H
#define TESTS_COMMAND_FUZZ_TARGETS_GL_GLES_CALL_H

#include "front/gl/state.h"
#include "front/gl/types.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* GLES_EACH(macro, a, b, ...): macro(a) macro(b) ..., for up to 27 of them. */
#define GLES_AGAIN
#define GLES_RESCAN_1(...)           __VA_ARGS__
#define GLES_RESCAN_2(...)           GLES_RESCAN_1(GLES_RESCAN_1(GLES_RESCAN_1(__VA_ARGS__)))
#define GLES_RESCAN_3(...)           GLES_RESCAN_2(GLES_RESCAN_2(GLES_RESCAN_2(__VA_ARGS__)))
#define GLES_RESCAN(...)             GLES_RESCAN_3(GLES_RESCAN_3(GLES_RESCAN_3(__VA_ARGS__)))
#define GLES_EACH(macro, ...)        __VA_OPT__(GLES_RESCAN(GLES_STEP(macro, __VA_ARGS__)))
#define GLES_STEP(macro, first, ...) macro(first) __VA_OPT__(GLES_NEXT GLES_AGAIN()(macro, __VA_ARGS__))
#define GLES_NEXT()                  GLES_STEP
#define GLES_PLAIN(...)              __VA_ARGS__

/* The arguments of each command. */
#define GLES_MEMBER(declaration) declaration;
#define GLES_STRUCT_none(name, parameters)
#define GLES_STRUCT_own(name, parameters)                                                                    \
    struct gles_##name {                                                                                     \
        GLES_EACH(GLES_MEMBER, GLES_PLAIN parameters)                                                        \
    };
#define GL_COMMAND(state, interfaces, result, name, maker, parameters, arguments)                            \
    GLES_STRUCT_##state(name, parameters)
#include "front/gl/calls/core.def"
#include "front/gl/calls/extension.def"
#undef GL_COMMAND

enum { GLES_ARGUMENTS = 9, GLES_BYTES = 16 * GLES_ARGUMENTS };

/* A command and its arguments. */
struct gles_command {
    const char *name, *symbol; /* "Clear", "glClear" */
    unsigned interfaces;
    uint16_t hash; /* the number that selects it (gles.c) */
    unsigned count;
    const char *declaration[GLES_ARGUMENTS]; /* "GLenum target" */
    uint16_t offset[GLES_ARGUMENTS], bytes[GLES_ARGUMENTS];
    void (*call)(void (*function)(void), const void *arguments);
};

/* The rest of an input, the context that is called, and memory of the calls. */
struct gles_input {
    const uint8_t *at, *end;
    struct gl_context *context;
    void *taken[16]; /* memory of the current call */
    unsigned takings;
    uint8_t *client;   /* memory of arrays, GLES_CLIENT bytes */
    unsigned vertices; /* drawn so far */
};

enum {
    GLES_CLIENT = 4096,
    GLES_PATIENCE = 1 << 16, /* bytes of an argument */
    GLES_TEXELS = 1 << 12,   /* of an image */
    GLES_VERTICES = 256      /* of all draws */
};

/* --- gles_input.c --- */

/* The next byte; 0 at the end. */
unsigned gles_byte(struct gles_input *);
/* The next four bytes. */
uint32_t gles_word(struct gles_input *);
/* Fills in an argument that is not a pointer. */
void gles_scalar(struct gles_input *, const char *declaration, void *to);
/* Single values: an enumeration of parameters with that name, a name of an object, a number, a count or an
 * offset. */
GLenum gles_enumeration(struct gles_input *, const char *parameter);
GLuint gles_name(struct gles_input *);
GLfloat gles_number(struct gles_input *);
GLint gles_integer(struct gles_input *);
/* A name of an attribute, a uniform or a label. */
const char *gles_text(struct gles_input *);

/* --- gles_memory.c --- */

/* Returns true if each pointer of a command has a row of gles_memory.def. */
bool gles_memory_is_known(const struct gles_command *);
/* Fills in the pointers of a command. Returns false if the call is left out: it needs more time or memory
 * than a fuzzer has, or memory that the program does not have. */
bool gles_memory(struct gles_input *, const struct gles_command *, void *arguments);
/* Returns true if an argument is a pointer, such as a handle of an image. */
bool gles_is_pointer(const char *declaration);
/* Frees the memory of the call. */
void gles_forget(struct gles_input *);

/* --- gles_limit.c --- */

/* Returns false if the call is left out because of its scalars. */
bool gles_limit(struct gles_input *, const struct gles_command *, const void *arguments);
/* Returns true if a draw of the vertices up to number `last` reads arrays within memory that exists. */
bool gles_arrays_exist(const struct gles_input *, uint64_t last);

#endif
