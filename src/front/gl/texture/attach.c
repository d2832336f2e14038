/* Framebuffer objects: names and attachments, chapter 4.4. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/texture/framebuffer.h"
#include "front/gl/state.h"
#include "front/gl/texture/texture.h"

static bool check_target(struct gl_context *context, GLenum target)
{
    if (target != GL_FRAMEBUFFER)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_FRAMEBUFFER", gl_constant_name(target));
    return target == GL_FRAMEBUFFER;
}

/* --- Names --- */

static void each_attachment(struct gl_framebuffer *framebuffer, void (*visit)(struct gl_attachment *, void *),
                            void *user)
{
    for (unsigned i = 0; i < GL_DRAWS; i++)
        visit(&framebuffer->color[i], user);
    visit(&framebuffer->depth, user);
    visit(&framebuffer->stencil, user);
}

static void detach(struct gl_attachment *attachment, void *object)
{
    if (object && attachment->object != object)
        return;
    struct gl_object *old = attachment->object;
    *attachment = (struct gl_attachment){0};
    gl_object_release(old);
}

static void destroy(struct gl_object *object)
{
    each_attachment((struct gl_framebuffer *)object, detach, NULL);
}

static struct gl_object *make(struct gl_context *context, GLuint name)
{
    struct gl_framebuffer *framebuffer = gl_object_make(context->share, sizeof *framebuffer, name, destroy);
    if (framebuffer)
        framebuffer->draw[0] = GL_COLOR_ATTACHMENT0;
    return (struct gl_object *)framebuffer;
}

void gl_framebuffer_detach(struct gl_context *context, struct gl_object *object)
{
    if (context->framebuffer)
        each_attachment(context->framebuffer, detach, object);
    context->late |= GL_LATE_TARGET;
}

void gl_BindFramebuffer(struct gl_context *context, GLenum target, GLuint name)
{
    struct gl_object *found = NULL;
    if (!check_target(context, target))
        return;
    if (name && !(found = gl_object_bind(context, GL_KIND_FRAMEBUFFER, name, make)))
        return;
    GL_HOLD(&context->framebuffer, found);
    context->late |= GL_LATE_TARGET;
}

void gl_GenFramebuffers(struct gl_context *context, GLsizei count, GLuint *names)
{
    gl_object_generate(context, GL_KIND_FRAMEBUFFER, count, names);
}

static void unbind(struct gl_context *context, struct gl_object *object)
{
    if ((struct gl_object *)context->framebuffer != object)
        return;
    GL_HOLD(&context->framebuffer, NULL);
    context->late |= GL_LATE_TARGET;
}

void gl_DeleteFramebuffers(struct gl_context *context, GLsizei count, const GLuint *names)
{
    gl_object_delete(context, GL_KIND_FRAMEBUFFER, count, names, unbind);
}

GLboolean gl_IsFramebuffer(struct gl_context *context, GLuint name)
{
    return gl_object_find(context, GL_KIND_FRAMEBUFFER, name) != NULL;
}

/* --- Attachments --- */

static struct gl_framebuffer *bound(struct gl_context *context, GLenum target)
{
    if (!check_target(context, target))
        return NULL;
    if (!context->framebuffer)
        gl_error(context, GL_INVALID_OPERATION, "found the default framebuffer, expected an object");
    return context->framebuffer;
}

static struct gl_attachment *find_attachment(struct gl_context *context, struct gl_framebuffer *framebuffer,
                                             GLenum name)
{
    if (name >= GL_COLOR_ATTACHMENT0 && name < GL_COLOR_ATTACHMENT0 + GL_DRAWS)
        return &framebuffer->color[name - GL_COLOR_ATTACHMENT0];
    if (name == GL_DEPTH_ATTACHMENT)
        return &framebuffer->depth;
    if (name == GL_STENCIL_ATTACHMENT)
        return &framebuffer->stencil;
    gl_error(context, GL_INVALID_ENUM, "found %s, expected an attachment", gl_constant_name(name));
    return NULL;
}

static void attach(struct gl_context *context, struct gl_attachment *place, struct gl_attachment with)
{
    struct gl_object *old = place->object;
    if (with.object)
        with.object->references++;
    *place = with.object ? with : (struct gl_attachment){0};
    gl_object_release(old);
    context->late |= GL_LATE_TARGET;
}

void gl_FramebufferRenderbuffer(struct gl_context *context, GLenum target, GLenum attachment,
                                GLenum renderbuffer_target, GLuint name)
{
    struct gl_framebuffer *framebuffer = bound(context, target);
    struct gl_attachment *place = framebuffer ? find_attachment(context, framebuffer, attachment) : NULL;
    if (!place)
        return;
    struct gl_object *object = gl_object_find(context, GL_KIND_RENDERBUFFER, name);
    if (renderbuffer_target != GL_RENDERBUFFER)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_RENDERBUFFER",
                 gl_constant_name(renderbuffer_target));
    else if (name && !object)
        gl_error(context, GL_INVALID_OPERATION, "found %u, expected a renderbuffer", name);
    else
        attach(context, place, (struct gl_attachment){.object = object});
}

static bool check_texture(struct gl_context *context, const struct gl_texture *texture, GLuint name,
                          GLenum target, GLint level)
{
    bool face = target >= GL_TEXTURE_CUBE_MAP_POSITIVE_X && target <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z;
    if (target != GL_TEXTURE_2D && !face)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a target of images", gl_constant_name(target));
    else if (!texture || texture->target != (face ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D))
        gl_error(context, GL_INVALID_OPERATION, "found %u, expected a texture of the target", name);
    else if (level)
        gl_error(context, GL_INVALID_VALUE, "found level %d, expected 0", level);
    else
        return true;
    return false;
}

void gl_FramebufferTexture2D(struct gl_context *context, GLenum target, GLenum attachment,
                             GLenum texture_target, GLuint name, GLint level)
{
    struct gl_framebuffer *framebuffer = bound(context, target);
    struct gl_attachment *place = framebuffer ? find_attachment(context, framebuffer, attachment) : NULL;
    struct gl_object *object = gl_object_find(context, GL_KIND_TEXTURE, name);
    if (!place || (name && !check_texture(context, (struct gl_texture *)object, name, texture_target, level)))
        return;
    unsigned face = texture_target == GL_TEXTURE_2D ? 0 : texture_target - GL_TEXTURE_CUBE_MAP_POSITIVE_X;
    attach(context, place,
           (struct gl_attachment){.object = object,
                                  .is_texture = true,
                                  .target = texture_target,
                                  .face = name ? face : 0,
                                  .level = (unsigned)level});
}

/* --- Queries --- */

static GLint parameter(struct gl_context *context, const struct gl_attachment *attachment, GLenum name)
{
    switch (name) {
    case GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE:
        return !attachment->object ? GL_NONE : attachment->is_texture ? GL_TEXTURE : GL_RENDERBUFFER;
    case GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME:
        if (attachment->object)
            return (GLint)attachment->object->name;
        break;
    case GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL:
        if (attachment->is_texture)
            return (GLint)attachment->level;
        break;
    case GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_CUBE_MAP_FACE:
        if (attachment->is_texture)
            return attachment->target == GL_TEXTURE_2D ? 0 : (GLint)attachment->target;
        break;
    default: break;
    }
    gl_error(context, GL_INVALID_ENUM, "found %s, expected a parameter of the attachment",
             gl_constant_name(name));
    return -1;
}

void gl_GetFramebufferAttachmentParameteriv(struct gl_context *context, GLenum target, GLenum attachment,
                                            GLenum name, GLint *out)
{
    struct gl_framebuffer *framebuffer = bound(context, target);
    const struct gl_attachment *found =
        framebuffer ? find_attachment(context, framebuffer, attachment) : NULL;
    GLint value = found ? parameter(context, found, name) : -1;
    if (value >= 0)
        *out = value;
}

/* --- EXT_draw_buffers, NV_draw_buffers, EXT_discard_framebuffer --- */

static bool check_draw_buffers(struct gl_context *context, GLsizei count, const GLenum *buffers)
{
    bool object = context->framebuffer;
    if (count < 0 || count > GL_DRAWS)
        gl_error(context, GL_INVALID_VALUE, "found %d buffers, expected 0 to %d", count, GL_DRAWS);
    else if (!object && (count != 1 || (buffers[0] != GL_BACK && buffers[0] != GL_NONE)))
        gl_error(context, GL_INVALID_OPERATION, "the default framebuffer has GL_BACK or GL_NONE");
    else {
        GLsizei i = 0;
        while (object && i < count &&
               (buffers[i] == GL_NONE || buffers[i] == GL_COLOR_ATTACHMENT0 + (GLenum)i))
            i++;
        if (!object || i == count)
            return true;
        gl_error(context, GL_INVALID_OPERATION, "found %s at place %d, expected GL_NONE or its attachment",
                 gl_constant_name(buffers[i]), i);
    }
    return false;
}

void gl_DrawBuffersEXT(struct gl_context *context, GLsizei count, const GLenum *buffers)
{
    if (!check_draw_buffers(context, count, buffers))
        return;
    context->late |= GL_LATE_TARGET;
    if (!context->framebuffer) {
        context->back_buffer = buffers[0];
        return;
    }
    for (GLsizei i = 0; i < GL_DRAWS; i++)
        context->framebuffer->draw[i] = i < count ? buffers[i] : GL_NONE;
}

void gl_DrawBuffersNV(struct gl_context *context, GLsizei count, const GLenum *buffers)
{
    gl_DrawBuffersEXT(context, count, buffers);
}

/* The contents become undefined, so they can stay. */
void gl_DiscardFramebufferEXT(struct gl_context *context, GLenum target, GLsizei count,
                              const GLenum *attachments)
{
    if (!check_target(context, target))
        return;
    if (count < 0)
        gl_error(context, GL_INVALID_VALUE, "found %d attachments, expected 0 or more", count);
    for (GLsizei i = 0; i < count; i++) {
        GLenum a = attachments[i];
        bool fits = context->framebuffer
                        ? (a >= GL_COLOR_ATTACHMENT0 && a < GL_COLOR_ATTACHMENT0 + GL_DRAWS) ||
                              a == GL_DEPTH_ATTACHMENT || a == GL_STENCIL_ATTACHMENT
                        : a == GL_COLOR_EXT || a == GL_DEPTH_EXT || a == GL_STENCIL_EXT;
        if (!fits) {
            gl_error(context, GL_INVALID_ENUM, "found %s, expected an attachment", gl_constant_name(a));
            return;
        }
    }
}
