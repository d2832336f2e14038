/* Contexts of OpenGL ES for window systems.
 *
 * A window system makes a device, then surfaces and contexts on it. It makes a context current for a thread:
 * gl_context_bind, then gl_dispatch_set (dispatch/dispatch.h). Contexts of one share group have textures,
 * buffers, programs and renderbuffers in common.
 *
 * Every function of a context locks its device, and so does every command. Contexts of one device can be
 * current in several threads. When a command of another context was the last one of the device, the context
 * sets all of the renderer's state again (gl_device_enter). */
#ifndef GL_CONTEXT_H
#define GL_CONTEXT_H

#include "device.h"
#include "triptych.h"
#include "types.h"

#include <stdbool.h>

struct gl_context;
struct gl_share;

/* The interfaces of a context and of a command. */
enum gl_interface { GL_ES1 = 1, GL_ES2 = 2 };

struct gl_context_options {
    struct gl_device *device;
    enum gl_interface interface;
    bool debug;           /* messages of KHR_debug begin enabled */
    bool robust;          /* accesses outside of buffers are defined */
    bool loses_on_reset;  /* GL_LOSE_CONTEXT_ON_RESET rather than GL_NO_RESET_NOTIFICATION */
    bool without_surface; /* can be bound without surfaces */
};

/* A default framebuffer: images of the device, which the window system owns. Row 0 of an image is the row of
 * GL's y = 0, the bottom of a window.
 *
 * `generation` changes when the window system replaces the images, which happens only in its functions that
 * end a frame or bind, while the device is locked. A bound context compares it before it draws. */
struct gl_surface {
    struct gl_device *device;
    struct triptych_surface color;
    struct triptych_surface depth; /* absent without depth and stencil */
    unsigned width, height;        /* pixels */
    unsigned samples;              /* 1, or 4 */
    enum triptych_surface_format format;
    enum triptych_depth_format depth_format;
    /* Bits that the program gets from queries: an image can have more, such as an alpha that is always 1. */
    unsigned red, green, blue, alpha, depth_bits, stencil_bits;
    bool single; /* no back buffer: drawing is to GL_FRONT */
    unsigned generation;
    void *owner; /* the window system's */
};

/* Creates a context with the objects of `share`, or of a new group if it is null. Null without memory. */
struct gl_context *gl_context_create(struct gl_share *share, const struct gl_context_options *options);
/* Frees a context that is not bound, and the group with its last context. Null is allowed. */
void gl_context_destroy(struct gl_context *context);
/* The group of a context, for gl_context_create. */
struct gl_share *gl_context_share(struct gl_context *context);

/* Binds surfaces: null for both, no default framebuffer. The first surfaces of a context set its viewport and
 * scissor rectangle. Returns false, and changes nothing, without memory. A context that is no longer current
 * is bound to null surfaces. */
bool gl_context_bind(struct gl_context *context, struct gl_surface *draw, struct gl_surface *read);

/* Lock the device for a command, and unlock it. Entering finds out whether the renderer has the state of
 * another context, and whether surfaces were replaced. */
void gl_context_enter(struct gl_context *context);
void gl_context_leave(struct gl_context *context);

/* Before the end of a frame: the default framebuffer becomes the renderer's target, if draws go there. So a
 * recorded frame has a target without a draw too. */
void gl_context_show(struct gl_context *context);

/* glFlush and glFinish. */
void gl_context_flush(struct gl_context *context);
void gl_context_finish(struct gl_context *context);

#endif
