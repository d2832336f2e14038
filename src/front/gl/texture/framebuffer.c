/* The images that draws and reads use: chapter 4.4.5, completeness. */
#include "front/gl/texture/framebuffer.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"
#include "front/gl/texture/texture.h"

/* An attached image, or one of the default framebuffer. */
struct image {
    struct triptych_surface surface;
    struct gl_depth *depth;
    enum triptych_surface_format format;
    unsigned width, height;
    unsigned red, green, blue, alpha, depth_bits, stencil_bits;
    bool color; /* can be a colour */
};

static bool find_renderbuffer(const struct gl_attachment *attachment, struct image *image)
{
    struct gl_renderbuffer *buffer = (struct gl_renderbuffer *)attachment->object;
    const struct gl_renderable *format = buffer->format;
    if (!buffer->image && !buffer->shared)
        return false;
    if (buffer->shared)
        gl_image_change(buffer->shared);
    *image = (struct image){.surface = gl_renderbuffer_surface(buffer),
                            .depth = buffer->shared ? &buffer->shared->depth : &buffer->depth,
                            .format = format->color,
                            .width = buffer->width,
                            .height = buffer->height,
                            .red = format->red,
                            .green = format->green,
                            .blue = format->blue,
                            .alpha = format->alpha,
                            .depth_bits = format->depth_bits,
                            .stencil_bits = format->stencil_bits,
                            .color = format->color};
    return true;
}

static bool find_texture(struct gl_context *context, const struct gl_attachment *attachment,
                         struct image *image)
{
    struct gl_texture *texture = (struct gl_texture *)attachment->object;
    const struct gl_level *level = &texture->level[attachment->face][attachment->level];
    const struct gl_texel *texel = level->texel;
    if (!texel || !level->width || !level->height || !texel->drawn)
        return false;
    *image = (struct image){.depth = level->image ? &level->image->depth : &texture->depth,
                            .format = texel->storage,
                            .width = level->width,
                            .height = level->height,
                            .red = texel->red,
                            .green = texel->green,
                            .blue = texel->blue,
                            .alpha = texel->alpha,
                            .depth_bits = texel->depth,
                            .stencil_bits = texel->stencil,
                            .color = !texel->depth};
    return gl_texture_draw(context, texture, attachment->face, attachment->level, &image->surface);
}

static bool find_image(struct gl_context *context, const struct gl_attachment *attachment,
                       struct image *image)
{
    return attachment->is_texture ? find_texture(context, attachment, image)
                                  : find_renderbuffer(attachment, image);
}

/* Completeness so far, while images are added. */
struct check {
    struct gl_context *context;
    struct gl_target *target;
    unsigned images;
    GLenum status;
};

static bool add_image(struct check *check, const struct gl_attachment *attachment, struct image *image)
{
    if (!attachment->object || check->status != GL_FRAMEBUFFER_COMPLETE)
        return false;
    if (!find_image(check->context, attachment, image))
        check->status = GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT;
    else if (check->images++ &&
             (image->width != check->target->width || image->height != check->target->height))
        check->status = GL_FRAMEBUFFER_INCOMPLETE_DIMENSIONS;
    check->target->width = image->width;
    check->target->height = image->height;
    return check->status == GL_FRAMEBUFFER_COMPLETE;
}

static void see_color(struct gl_target *target, const struct image *image)
{
    target->red = image->red;
    target->green = image->green;
    target->blue = image->blue;
    target->alpha = image->alpha;
    target->read = image->surface;
    target->read_format = image->format;
    target->has_read = true;
}

static void add_color(struct check *check, const struct gl_framebuffer *framebuffer, unsigned i)
{
    struct image image;
    if (!add_image(check, &framebuffer->color[i], &image))
        return;
    if (!image.color)
        check->status = GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT;
    if (!i)
        see_color(check->target, &image);
    if (framebuffer->draw[i] == GL_NONE)
        return;
    check->target->surfaces.color[i] = image.surface;
    check->target->colors |= 1u << i;
}

static void add_depth(struct check *check, const struct gl_framebuffer *framebuffer)
{
    struct image image;
    if (add_image(check, &framebuffer->depth, &image)) {
        if (!image.depth_bits)
            check->status = GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT;
        check->target->depth_bits = image.depth_bits;
        check->target->depth = image.depth;
    }
    if (add_image(check, &framebuffer->stencil, &image)) {
        if (!image.stencil_bits)
            check->status = GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT;
        check->target->stencil_bits = image.stencil_bits;
        check->target->stencil = image.depth;
    }
}

/* The renderer draws to each surface once. */
static bool shares_images(const struct gl_framebuffer *framebuffer)
{
    for (unsigned i = 1; i < GL_DRAWS; i++)
        for (unsigned k = 0; k < i; k++) {
            const struct gl_attachment *a = &framebuffer->color[i], *b = &framebuffer->color[k];
            if (a->object && a->object == b->object && a->face == b->face && a->level == b->level)
                return true;
        }
    return false;
}

static GLenum object_target(struct gl_context *context, struct gl_framebuffer *framebuffer,
                            struct gl_target *target)
{
    struct check check = {context, target, 0, GL_FRAMEBUFFER_COMPLETE};
    for (unsigned i = 0; i < GL_DRAWS; i++)
        add_color(&check, framebuffer, i);
    add_depth(&check, framebuffer);
    target->samples = 1;
    if (check.status == GL_FRAMEBUFFER_COMPLETE && !check.images)
        return GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT;
    if (check.status == GL_FRAMEBUFFER_COMPLETE && shares_images(framebuffer))
        return GL_FRAMEBUFFER_UNSUPPORTED;
    return check.status;
}

static GLenum default_target(struct gl_context *context, const struct gl_surface *surface,
                             struct gl_target *target)
{
    if (!surface)
        return GL_FRAMEBUFFER_UNDEFINED_OES;
    target->read = surface->color;
    target->read_format = surface->format;
    target->has_read = true;
    target->width = surface->width;
    target->height = surface->height;
    target->samples = surface->samples;
    target->red = surface->red;
    target->green = surface->green;
    target->blue = surface->blue;
    target->alpha = surface->alpha;
    target->depth_bits = surface->depth_bits;
    target->stencil_bits = surface->stencil_bits;
    target->surfaces.depth = surface->depth;
    if (context->back_buffer != GL_NONE) {
        target->surfaces.color[0] = surface->color;
        target->colors = 1;
    }
    return GL_FRAMEBUFFER_COMPLETE;
}

GLenum gl_framebuffer_target(struct gl_context *context, bool read, struct gl_target *target)
{
    *target = (struct gl_target){.surfaces.depth_format = TRIPTYCH_DEPTH_NONE};
    return context->framebuffer
               ? object_target(context, context->framebuffer, target)
               : default_target(context, read ? context->read_surface : context->draw_surface, target);
}

bool gl_framebuffer_check(struct gl_context *context, bool read, struct gl_target *target)
{
    GLenum status = gl_framebuffer_target(context, read, target);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        gl_error(context, GL_INVALID_FRAMEBUFFER_OPERATION, "found a framebuffer with the status %s",
                 gl_constant_name(status));
    return status == GL_FRAMEBUFFER_COMPLETE;
}

GLenum gl_CheckFramebufferStatus(struct gl_context *context, GLenum target)
{
    struct gl_target found;
    if (target == GL_FRAMEBUFFER)
        return gl_framebuffer_target(context, false, &found);
    gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_FRAMEBUFFER", gl_constant_name(target));
    return 0;
}
