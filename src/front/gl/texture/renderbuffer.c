/* Renderbuffers: chapter 4.4.2. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/texture/framebuffer.h"
#include "front/gl/state.h"
#include "front/gl/texture/image.h"

#define COLOR(name)                  .color = TRIPTYCH_SURFACE_##name
#define DEPTH(name)                  .depth = TRIPTYCH_DEPTH_##name
#define BITS(r, g, b, a)             .red = r, .green = g, .blue = b, .alpha = a
#define DEPTH_BITS(depths, stencils) .depth_bits = depths, .stencil_bits = stencils

/* All of depth and stencil have words of both (texture/depth.h). */
static const struct gl_renderable formats[] = {
    {GL_RGBA4, COLOR(A4R4G4B4), BITS(4, 4, 4, 4)},
    {GL_RGB5_A1, COLOR(A1R5G5B5), BITS(5, 5, 5, 1)},
    {GL_RGB565, COLOR(R5G6B5), BITS(5, 6, 5, 0)},
    {GL_RGB8_OES, COLOR(X8B8G8R8), BITS(8, 8, 8, 0)},
    {GL_RGBA8_OES, COLOR(A8B8G8R8), BITS(8, 8, 8, 8)},
    {GL_BGRA_EXT, COLOR(A8R8G8B8), BITS(8, 8, 8, 8)},
    {GL_BGRA8_EXT, COLOR(A8R8G8B8), BITS(8, 8, 8, 8)},
    {GL_R8_EXT, COLOR(R8), BITS(8, 0, 0, 0)},
    {GL_RG8_EXT, COLOR(R8G8), BITS(8, 8, 0, 0)},
    {GL_DEPTH_COMPONENT16, DEPTH(D24S8), DEPTH_BITS(24, 0)},
    {GL_DEPTH_COMPONENT24_OES, DEPTH(D24S8), DEPTH_BITS(24, 0)},
    {GL_STENCIL_INDEX8, DEPTH(D24S8), DEPTH_BITS(0, 8)},
    {GL_DEPTH24_STENCIL8_OES, DEPTH(D24S8), DEPTH_BITS(24, 8)},
};

static const struct gl_renderable *find_format(GLenum internal_format)
{
    for (unsigned i = 0; i < sizeof formats / sizeof *formats; i++)
        if (formats[i].internal_format == internal_format)
            return formats + i;
    return NULL;
}

/* The formats of texels, as rows of texel.def have them. */
const struct gl_texel *gl_renderable_texel(const struct gl_renderable *format)
{
    switch (format->internal_format) {
    case GL_RGBA4: return gl_texel_find(GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4);
    case GL_RGB5_A1: return gl_texel_find(GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1);
    case GL_RGB565: return gl_texel_find(GL_RGB, GL_UNSIGNED_SHORT_5_6_5);
    case GL_RGB8_OES: return gl_texel_find(GL_RGB, GL_UNSIGNED_BYTE);
    case GL_RGBA8_OES: return gl_texel_find(GL_RGBA, GL_UNSIGNED_BYTE);
    case GL_R8_EXT: return gl_texel_find(GL_RED_EXT, GL_UNSIGNED_BYTE);
    case GL_RG8_EXT: return gl_texel_find(GL_RG_EXT, GL_UNSIGNED_BYTE);
    default: return gl_texel_find(GL_BGRA_EXT, GL_UNSIGNED_BYTE);
    }
}

const struct gl_renderable *gl_renderable_of_texel(const struct gl_texel *texel)
{
    if (texel->depth)
        return find_format(texel->stencil ? GL_DEPTH24_STENCIL8_OES : GL_DEPTH_COMPONENT24_OES);
    for (unsigned i = 0; texel->drawn && i < sizeof formats / sizeof *formats; i++)
        if (formats[i].color == texel->storage)
            return formats + i;
    return NULL;
}

struct triptych_surface gl_renderbuffer_surface(const struct gl_renderbuffer *buffer)
{
    return buffer->shared ? buffer->shared->surface : (struct triptych_surface){.image = buffer->image};
}

static bool check_target(struct gl_context *context, GLenum target)
{
    if (target != GL_RENDERBUFFER)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_RENDERBUFFER", gl_constant_name(target));
    return target == GL_RENDERBUFFER;
}

/* --- Names --- */

static void destroy(struct gl_object *object)
{
    struct gl_renderbuffer *buffer = (struct gl_renderbuffer *)object;
    gl_depth_part(object->share, &buffer->depth);
    triptych_image_destroy(object->share->renderer, buffer->image);
    gl_image_release(buffer->shared);
}

static struct gl_object *make(struct gl_context *context, GLuint name)
{
    struct gl_renderbuffer *buffer = gl_object_make(context->share, sizeof *buffer, name, destroy);
    if (buffer)
        buffer->internal_format = GL_RGBA4;
    return (struct gl_object *)buffer;
}

void gl_BindRenderbuffer(struct gl_context *context, GLenum target, GLuint name)
{
    struct gl_object *found = NULL;
    if (check_target(context, target) &&
        (!name || (found = gl_object_bind(context, GL_KIND_RENDERBUFFER, name, make))))
        GL_HOLD(&context->renderbuffer, found);
}

void gl_GenRenderbuffers(struct gl_context *context, GLsizei count, GLuint *names)
{
    gl_object_generate(context, GL_KIND_RENDERBUFFER, count, names);
}

static void unbind(struct gl_context *context, struct gl_object *object)
{
    if ((struct gl_object *)context->renderbuffer == object)
        GL_HOLD(&context->renderbuffer, NULL);
    gl_framebuffer_detach(context, object);
}

void gl_DeleteRenderbuffers(struct gl_context *context, GLsizei count, const GLuint *names)
{
    gl_object_delete(context, GL_KIND_RENDERBUFFER, count, names, unbind);
}

GLboolean gl_IsRenderbuffer(struct gl_context *context, GLuint name)
{
    return gl_object_find(context, GL_KIND_RENDERBUFFER, name) != NULL;
}

/* --- Storage --- */

static struct gl_renderbuffer *bound(struct gl_context *context, GLenum target)
{
    if (!check_target(context, target))
        return NULL;
    if (!context->renderbuffer)
        gl_error(context, GL_INVALID_OPERATION, "found no renderbuffer, expected a bound one");
    return context->renderbuffer;
}

static bool make_image(struct gl_context *context, const struct gl_renderable *format, unsigned width,
                       unsigned height, triptych_image **image)
{
    struct triptych_image_description description = {.format = format->color,
                                                     .depth_format = format->depth,
                                                     .width = width,
                                                     .height = height,
                                                     .samples = 1};
    *image = NULL;
    return !width || !height ||
           gl_renderer_did(context, triptych_image_create(context->renderer, &description, image));
}

static void replace(struct gl_context *context, struct gl_renderbuffer *buffer,
                    const struct gl_renderbuffer *with)
{
    if (!gl_depth_part(context->share, &buffer->depth))
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a copy of stencil");
    triptych_image_destroy(context->renderer, buffer->image);
    gl_image_release(buffer->shared);
    buffer->shared = with->shared;
    buffer->format = with->format;
    buffer->internal_format = with->internal_format;
    buffer->width = with->width;
    buffer->height = with->height;
    buffer->image = with->image;
    buffer->depth = (struct gl_depth){.surface.image = with->image,
                                      .width = with->width,
                                      .height = with->height,
                                      .has_depth = with->format->depth_bits,
                                      .has_stencil = with->format->stencil_bits};
    context->late |= GL_LATE_TARGET;
}

void gl_RenderbufferStorage(struct gl_context *context, GLenum target, GLenum internal_format, GLsizei width,
                            GLsizei height)
{
    const struct gl_renderable *format = find_format(internal_format);
    struct gl_renderbuffer *buffer;
    triptych_image *image;
    if (!check_target(context, target))
        return;
    if (!format)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a format of renderbuffers",
                 gl_constant_name(internal_format));
    else if (width < 0 || height < 0 || width > GL_SIDE || height > GL_SIDE)
        gl_error(context, GL_INVALID_VALUE, "found a size of %d x %d, expected sides of 0 to %d", width,
                 height, GL_SIDE);
    else if ((buffer = bound(context, target)) &&
             make_image(context, format, (unsigned)width, (unsigned)height, &image))
        replace(context, buffer,
                &(struct gl_renderbuffer){.format = format,
                                          .internal_format = internal_format,
                                          .width = (unsigned)width,
                                          .height = (unsigned)height,
                                          .image = image});
}

void gl_renderbuffer_take(struct gl_context *context, struct gl_renderbuffer *buffer, struct gl_image *image)
{
    replace(context, buffer,
            &(struct gl_renderbuffer){.format = image->renderable,
                                      .internal_format = image->renderable->internal_format,
                                      .width = image->width,
                                      .height = image->height,
                                      .shared = gl_image_hold(image)});
}

void gl_GetRenderbufferParameteriv(struct gl_context *context, GLenum target, GLenum name, GLint *out)
{
    static const struct gl_renderable none = {0};
    const struct gl_renderbuffer *buffer = bound(context, target);
    if (!buffer)
        return;
    const struct gl_renderable *format = buffer->format ? buffer->format : &none;
    switch (name) {
    case GL_RENDERBUFFER_WIDTH: *out = (GLint)buffer->width; break;
    case GL_RENDERBUFFER_HEIGHT: *out = (GLint)buffer->height; break;
    case GL_RENDERBUFFER_INTERNAL_FORMAT: *out = (GLint)buffer->internal_format; break;
    case GL_RENDERBUFFER_RED_SIZE: *out = format->red; break;
    case GL_RENDERBUFFER_GREEN_SIZE: *out = format->green; break;
    case GL_RENDERBUFFER_BLUE_SIZE: *out = format->blue; break;
    case GL_RENDERBUFFER_ALPHA_SIZE: *out = format->alpha; break;
    case GL_RENDERBUFFER_DEPTH_SIZE: *out = format->depth_bits; break;
    case GL_RENDERBUFFER_STENCIL_SIZE: *out = format->stencil_bits; break;
    default:
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a parameter of renderbuffers",
                 gl_constant_name(name));
    }
}
