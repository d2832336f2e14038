/* Contexts of OpenGL ES for fuzz targets: devices of some engines, which are kept for all inputs, and
 * contexts with a default framebuffer of 16 x 8 pixels. */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_GL_CANVAS_H
#define TESTS_COMMAND_FUZZ_TARGETS_GL_CANVAS_H

#include "front/gl/commands.h"

enum { CANVAS_WIDTH = 16, CANVAS_HEIGHT = 8 };

struct canvas {
    struct gl_context *context;
    struct gl_surface surface; /* RGBA8, depth of 24 bits and stencil of 8 */
};

/* Returns the device of an engine, which is made at the first call. */
struct gl_device *canvas_device(const char *engine);
/* Begins an input. After a thousand, all devices are dropped, because they keep routines. */
void canvas_next(void);

/* Makes a context on the device, with the objects of `share`, which can be null, and binds it to a
 * surface. */
void canvas_begin(struct canvas *, struct gl_device *, enum gl_interface, const struct canvas *share);
void canvas_end(struct canvas *);

#endif
