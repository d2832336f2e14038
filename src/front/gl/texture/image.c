/* Images that several objects have in common: EGL images (OES_EGL_image), and colours of pbuffers. */
#include "front/gl/texture/image.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"
#include "front/gl/texture/framebuffer.h"
#include "front/gl/texture/texture.h"

#include <stdlib.h>

/* --- Life --- */

static struct gl_image *make(struct gl_device *device, unsigned width, unsigned height)
{
    struct gl_image *image = calloc(1, sizeof *image);
    if (image)
        *image = (struct gl_image){.device = device,
                                   .renderer = device->renderer,
                                   .references = 1,
                                   .width = width,
                                   .height = height};
    return image;
}

static void set_depth(struct gl_image *image, bool has_depth, bool has_stencil)
{
    image->depth = (struct gl_depth){.surface = image->surface,
                                     .width = image->width,
                                     .height = image->height,
                                     .has_depth = has_depth,
                                     .has_stencil = has_stencil};
}

struct gl_image *gl_image_make(struct gl_device *device, const struct gl_texel *texel, unsigned width,
                               unsigned height)
{
    const struct triptych_texture_description description = {.type = TRIPTYCH_TEXTURE_2D,
                                                             .format = texel->storage,
                                                             .width = width,
                                                             .height = height,
                                                             .depth = 1,
                                                             .levels = 1};
    struct gl_image *image = make(device, width, height);
    if (!image)
        return NULL;
    image->texel = texel;
    image->renderable = gl_renderable_of_texel(texel);
    if (triptych_texture_define(image->renderer, &description, &image->surface.texture) != TRIPTYCH_OK) {
        free(image);
        return NULL;
    }
    set_depth(image, texel->depth, texel->stencil);
    return image;
}

struct gl_image *gl_image_hold(struct gl_image *image)
{
    image->references++;
    return image;
}

/* Stencil of other images in the surface goes back to theirs. They can be of any share group. */
static void part_depth(struct gl_image *image)
{
    struct gl_share any = {.device = image->device, .renderer = image->renderer};
    if (!image->depth.host && !image->depth.guest)
        return;
    gl_depth_part(&any, &image->depth);
    gl_device_forget(image->device);
}

void gl_image_release(struct gl_image *image)
{
    if (!image || --image->references)
        return;
    part_depth(image);
    triptych_texture_destroy(image->renderer, image->surface.texture);
    triptych_image_destroy(image->renderer, image->surface.image);
    free(image);
}

void gl_image_change(struct gl_image *image)
{
    image->changes++;
    if (image->has_copies)
        image->device->image_changes++;
}

void gl_image_part(struct gl_image *image, const struct gl_texture *texture)
{
    if (image->holder == texture)
        image->holder = NULL;
}

/* --- Images of objects --- */

/* An image of others can be made again when nothing else has it any more. */
static bool is_in_use(const struct gl_image *image)
{
    return image && (image->references > 1 || image->holder);
}

static struct gl_image *of_texture(struct gl_context *context, GLenum target, GLuint name, GLint level,
                                   enum gl_image_result *result)
{
    struct gl_texture *texture = (struct gl_texture *)gl_object_find(context, GL_KIND_TEXTURE, name);
    const unsigned face = target == GL_TEXTURE_2D ? 0 : target - GL_TEXTURE_CUBE_MAP_POSITIVE_X;
    const GLenum whole = target == GL_TEXTURE_2D ? target : GL_TEXTURE_CUBE_MAP;
    *result = GL_IMAGE_NO_OBJECT;
    if (!texture || texture->target != whole)
        return NULL;
    *result = GL_IMAGE_NO_LEVEL;
    if (level < 0 || level >= GL_LEVELS || (level && !texture->level[face][level].texel))
        return NULL;
    *result = GL_IMAGE_NO_OBJECT;
    if (!gl_texture_lends(texture, (unsigned)level))
        return NULL;
    *result = GL_IMAGE_IN_USE;
    if (is_in_use(texture->level[face][level].image))
        return NULL;
    *result = GL_IMAGE_NO_MEMORY;
    return gl_texture_lend(texture, face, (unsigned)level);
}

/* The storage of depth is drawn to and not sampled. */
static struct gl_image *lend_depth(struct gl_context *context, struct gl_renderbuffer *buffer)
{
    struct gl_image *image = make(context->device, buffer->width, buffer->height);
    if (!image)
        return NULL;
    if (!gl_depth_part(context->share, &buffer->depth)) {
        free(image);
        return NULL;
    }
    image->surface.image = buffer->image;
    set_depth(image, buffer->depth.has_depth, buffer->depth.has_stencil);
    return image;
}

/* Colours move to a texture. */
static struct gl_image *lend_color(struct gl_context *context, struct gl_renderbuffer *buffer)
{
    const struct triptych_surface from = {.image = buffer->image};
    struct gl_image *image =
        gl_image_make(context->device, gl_renderable_texel(buffer->format), buffer->width, buffer->height);
    if (!image)
        return NULL;
    if (triptych_copy(image->renderer, &from, NULL, &image->surface, NULL, TRIPTYCH_COPY_POINT)) {
        gl_image_release(image);
        return NULL;
    }
    triptych_image_destroy(image->renderer, buffer->image);
    return image;
}

static struct gl_image *lend(struct gl_context *context, struct gl_renderbuffer *buffer)
{
    struct gl_image *image = buffer->shared;
    if (!image) {
        image = buffer->format->color ? lend_color(context, buffer) : lend_depth(context, buffer);
        if (!image)
            return NULL;
        image->renderable = buffer->format;
        buffer->image = NULL;
        buffer->depth = (struct gl_depth){0};
        buffer->shared = image;
    }
    return gl_image_hold(image);
}

static struct gl_image *of_renderbuffer(struct gl_context *context, GLuint name, enum gl_image_result *result)
{
    struct gl_renderbuffer *buffer =
        (struct gl_renderbuffer *)gl_object_find(context, GL_KIND_RENDERBUFFER, name);
    *result = GL_IMAGE_NO_OBJECT;
    if (!buffer || (!buffer->image && !buffer->shared))
        return NULL;
    *result = GL_IMAGE_IN_USE;
    if (is_in_use(buffer->shared))
        return NULL;
    *result = GL_IMAGE_NO_MEMORY;
    return lend(context, buffer);
}

static void add_handle(struct gl_image *image, const void *handle)
{
    image->handle = handle;
    image->next = image->device->images;
    image->device->images = image;
}

static void remove_handle(struct gl_image *image)
{
    struct gl_image **link = &image->device->images;
    while (*link && *link != image)
        link = &(*link)->next;
    if (*link)
        *link = image->next;
    image->handle = NULL;
}

/* Other contexts can have the storage of before as a texture or a target. */
struct gl_image *gl_image_of_object(struct gl_context *context, GLenum target, GLuint name, GLint level,
                                    const void *handle, enum gl_image_result *result)
{
    gl_device_enter(context->device, NULL);
    struct gl_image *image = target == GL_RENDERBUFFER ? of_renderbuffer(context, name, result)
                                                       : of_texture(context, target, name, level, result);
    if (image) {
        add_handle(image, handle);
        gl_device_forget(context->device);
        *result = GL_IMAGE_MADE;
    }
    gl_device_leave(context->device);
    return image;
}

void gl_image_drop(struct gl_image *image)
{
    if (!image)
        return;
    struct gl_device *device = image->device;
    gl_device_enter(device, NULL);
    remove_handle(image);
    gl_image_release(image);
    gl_device_leave(device);
}

/* --- Colours of surfaces --- */

#define COLOR(base, words, bytes, r, g, b, a)                                                                \
    {                                                                                                        \
        .format = (base), .type = GL_UNSIGNED_BYTE, .storage_bytes = (bytes),                                \
        .storage = TRIPTYCH_SURFACE_##words, .red = (r), .green = (g), .blue = (b), .alpha = (a),            \
        .drawn = true                                                                                        \
    }
static const struct gl_texel colors[] = {
    COLOR(GL_RGBA, A8R8G8B8, 4, 8, 8, 8, 8), COLOR(GL_RGB, X8R8G8B8, 4, 8, 8, 8, 0),
    COLOR(GL_RGB, R5G6B5, 2, 5, 6, 5, 0),    COLOR(GL_RGBA, A1R5G5B5, 2, 5, 5, 5, 1),
    COLOR(GL_RGBA, A4R4G4B4, 2, 4, 4, 4, 4), COLOR(GL_RGBA, A2B10G10R10, 4, 10, 10, 10, 2),
};

static const struct gl_texel *find_color(enum triptych_surface_format format)
{
    for (unsigned i = 0; i < sizeof colors / sizeof *colors; i++)
        if (colors[i].storage == format)
            return colors + i;
    return NULL;
}

struct gl_image *gl_image_of_color(struct gl_device *device, enum triptych_surface_format format,
                                   unsigned width, unsigned height)
{
    gl_device_enter(device, NULL);
    struct gl_image *image = gl_image_make(device, find_color(format), width, height);
    gl_device_leave(device);
    return image;
}

struct triptych_surface gl_image_surface(const struct gl_image *image)
{
    return image->surface;
}

void gl_image_bind(struct gl_context *context, struct gl_image *image)
{
    gl_context_enter(context);
    struct gl_texture *texture = context->texture[gl_state_unit(context)][GL_DIMENSION_2D];
    gl_texture_take(texture, image);
    image->holder = texture;
    gl_device_forget(context->device);
    gl_context_leave(context);
}

void gl_image_unbind(struct gl_image *image)
{
    struct gl_device *device = image->device;
    gl_device_enter(device, NULL);
    if (image->holder)
        gl_texture_take(image->holder, NULL);
    gl_device_forget(device);
    gl_device_leave(device);
}

bool gl_image_is_bound(const struct gl_image *image)
{
    gl_device_enter(image->device, NULL);
    const bool bound = image->holder;
    gl_device_leave(image->device);
    return bound;
}

/* --- OES_EGL_image --- */

/* Returns null, with an error, if no image has the handle. */
static struct gl_image *find(struct gl_context *context, const void *handle)
{
    struct gl_image *image = context->device->images;
    while (image && (!handle || image->handle != handle))
        image = image->next;
    if (!image)
        gl_error(context, GL_INVALID_VALUE, "found no image, expected one of eglCreateImage");
    return image;
}

void gl_EGLImageTargetTexture2DOES(struct gl_context *context, GLenum target, GLeglImageOES handle)
{
    if (target != GL_TEXTURE_2D) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_TEXTURE_2D", gl_constant_name(target));
        return;
    }
    struct gl_image *image = find(context, handle);
    if (!image)
        return;
    if (!image->texel) {
        gl_error(context, GL_INVALID_OPERATION, "found an image of depth or stencil, expected colours");
        return;
    }
    gl_texture_take(context->texture[gl_state_unit(context)][GL_DIMENSION_2D], image);
    context->late |= GL_LATE_TARGET | GL_LATE_TEXTURES;
}

void gl_EGLImageTargetRenderbufferStorageOES(struct gl_context *context, GLenum target, GLeglImageOES handle)
{
    if (target != GL_RENDERBUFFER) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_RENDERBUFFER", gl_constant_name(target));
        return;
    }
    struct gl_image *image = find(context, handle);
    if (!image)
        return;
    if (!context->renderbuffer)
        gl_error(context, GL_INVALID_OPERATION, "found no renderbuffer, expected a bound one");
    else if (!image->renderable)
        gl_error(context, GL_INVALID_OPERATION, "found an image that is not drawn to");
    else
        gl_renderbuffer_take(context, context->renderbuffer, image);
}
