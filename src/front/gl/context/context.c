/* Contexts: creation, binding, share groups. */
#include "front/gl/context.h"
#include "front/gl/draw/buffer.h"
#include "front/gl/draw/prepare.h"
#include "front/gl/commands.h"
#include "front/gl/debug.h"
#include "front/gl/fixed.h"
#include "front/gl/texture/framebuffer.h"
#include "front/gl/state.h"
#include "front/gl/texture/texture.h"
#include "front/gl/draw/vertex_array.h"

#include <stdlib.h>

/* --- Share groups --- */

static struct gl_share *join_share(struct gl_share *share, struct gl_device *device)
{
    if (share) {
        share->references++;
        return share;
    }
    share = calloc(1, sizeof *share);
    if (share) {
        share->references = 1;
        share->device = device;
        share->renderer = device->renderer;
    }
    return share;
}

static void free_names(struct gl_names *names)
{
    for (struct gl_object *object; (object = gl_names_take(names));)
        if (!object->deleted)
            gl_object_release(object);
    gl_names_free(names);
}

static void leave_share(struct gl_share *share)
{
    if (--share->references)
        return;
    for (unsigned kind = 0; kind < GL_SHARED_KINDS; kind++)
        free_names(&share->names[kind]);
    free(share);
}

struct gl_share *gl_context_share(struct gl_context *context)
{
    return context->share;
}

/* --- Life --- */

/* The objects with the name 0. */
static bool make_defaults(struct gl_context *context)
{
    static const GLenum targets[GL_DIMENSIONS] = {GL_TEXTURE_2D, GL_TEXTURE_CUBE_MAP};
    context->vertex_array_0 = (struct gl_vertex_array *)gl_vertex_array_make(context, 0);
    if (!context->vertex_array_0)
        return false;
    GL_HOLD(&context->vertex_array, context->vertex_array_0);
    for (unsigned i = 0; i < GL_DIMENSIONS; i++) {
        context->texture_0[i] = (struct gl_texture *)gl_texture_make(context, 0);
        if (!context->texture_0[i])
            return false;
        context->texture_0[i]->target = targets[i];
        for (unsigned unit = 0; unit < GL_UNITS; unit++)
            GL_HOLD(&context->texture[unit][i], context->texture_0[i]);
    }
    return true;
}

static void release_bindings(struct gl_context *context)
{
    GL_HOLD(&context->array_buffer, NULL);
    GL_HOLD(&context->vertex_array, NULL);
    GL_HOLD(&context->vertex_array_0, NULL);
    GL_HOLD(&context->framebuffer, NULL);
    GL_HOLD(&context->renderbuffer, NULL);
    GL_HOLD(&context->program, NULL);
    for (unsigned i = 0; i < GL_DIMENSIONS; i++) {
        for (unsigned unit = 0; unit < GL_UNITS; unit++)
            GL_HOLD(&context->texture[unit][i], NULL);
        GL_HOLD(&context->texture_0[i], NULL);
    }
}

struct gl_context *gl_context_create(struct gl_share *share, const struct gl_context_options *options)
{
    struct gl_context *context = calloc(1, sizeof *context);
    if (!context)
        return NULL;
    context->device = gl_device_hold(options->device);
    context->renderer = context->device->renderer;
    context->options = *options;
    gl_device_enter(context->device, NULL);
    context->share = join_share(share, context->device);
    if (context->share)
        gl_state_reset(context);
    context->values.debug_output[0] = options->debug;
    bool made =
        context->share && make_defaults(context) && (options->interface != GL_ES1 || gl_fixed_begin(context));
    gl_device_leave(context->device);
    if (made)
        return context;
    gl_context_destroy(context);
    return NULL;
}

void gl_context_destroy(struct gl_context *context)
{
    if (!context)
        return;
    struct gl_device *device = context->device;
    gl_device_enter(device, NULL);
    gl_debug_free(context);
    gl_fixed_end(context);
    release_bindings(context);
    for (unsigned i = 0; i < GL_KINDS - GL_SHARED_KINDS; i++)
        free_names(&context->names[i]);
    triptych_buffer_destroy(context->renderer, context->current_buffer);
    triptych_buffer_destroy(context->renderer, context->stream.buffer);
    if (context->share)
        leave_share(context->share);
    gl_device_forget(device);
    gl_device_leave(device);
    gl_device_drop(device);
    free(context);
}

/* --- Binding --- */

/* The first surfaces set the areas (2.1.2 of EGL). */
static void set_areas(struct gl_context *context, const struct gl_surface *draw)
{
    GLint *viewport = context->values.viewport, *scissor = context->values.scissor;
    viewport[2] = scissor[2] = (GLint)draw->width;
    viewport[3] = scissor[3] = (GLint)draw->height;
    context->bound = true;
}

bool gl_context_bind(struct gl_context *context, struct gl_surface *draw, struct gl_surface *read)
{
    gl_device_enter(context->device, NULL);
    context->draw_surface = draw;
    context->read_surface = read;
    context->late = GL_LATE_ALL;
    if (draw && !context->bound)
        set_areas(context, draw);
    gl_device_leave(context->device);
    return true;
}

void gl_context_enter(struct gl_context *context)
{
    struct gl_surface *draw = context->draw_surface;
    if (gl_device_enter(context->device, context))
        context->late = GL_LATE_ALL;
    if (context->device->image_changes != context->image_changes) {
        context->image_changes = context->device->image_changes;
        context->late |= GL_LATE_TEXTURES;
    }
    if (draw && draw->generation != context->generation) {
        context->generation = draw->generation;
        context->late |= GL_LATE_TARGET;
    }
}

void gl_context_leave(struct gl_context *context)
{
    gl_device_leave(context->device);
}

void gl_context_show(struct gl_context *context)
{
    struct gl_target target;
    gl_context_enter(context);
    if (!context->framebuffer && gl_framebuffer_target(context, false, &target) == GL_FRAMEBUFFER_COMPLETE)
        gl_prepare_target(context, &target);
    gl_context_leave(context);
}

void gl_context_flush(struct gl_context *context)
{
    gl_context_enter(context);
    gl_Flush(context);
    gl_context_leave(context);
}

void gl_context_finish(struct gl_context *context)
{
    gl_context_enter(context);
    gl_Finish(context);
    gl_context_leave(context);
}
