/* Images that textures, renderbuffers and surfaces have in common, for window systems: EGL images, and the
 * colours of pbuffers that textures get.
 *
 * An image exists while anything holds it: the window system, levels of textures, renderbuffers. An object
 * that gets other texels by a command (glTexImage2D) leaves the image, which stays as it is for all others.
 * Every function locks the device. */
#ifndef GL_IMAGE_H
#define GL_IMAGE_H

#include "context.h"

enum gl_image_result {
    GL_IMAGE_MADE,
    GL_IMAGE_NO_OBJECT, /* no object has the name, or a texture is not complete */
    GL_IMAGE_NO_LEVEL,
    GL_IMAGE_IN_USE, /* the object has an image of others already */
    GL_IMAGE_NO_MEMORY
};

/* Makes an image of an object of a context: `target` is GL_TEXTURE_2D, a face of a cube or GL_RENDERBUFFER.
 * The texels stay. OES_EGL_image finds the image by `handle`. Null with another result. */
struct gl_image *gl_image_of_object(struct gl_context *, GLenum target, GLuint name, GLint level,
                                    const void *handle, enum gl_image_result *);
/* Makes the colour of a surface. The format is that of a config. Null without memory. */
struct gl_image *gl_image_of_color(struct gl_device *, enum triptych_surface_format, unsigned width,
                                   unsigned height);
struct triptych_surface gl_image_surface(const struct gl_image *);

/* The texture of the current unit, with the target GL_TEXTURE_2D, gets the colour of a surface as its only
 * image. It loses it with glTexImage2D, at its end, or with gl_image_unbind: then it has no image. */
void gl_image_bind(struct gl_context *, struct gl_image *);
void gl_image_unbind(struct gl_image *);
bool gl_image_is_bound(const struct gl_image *);

/* Ends the window system's hold. OES_EGL_image does not find the image any more. Null is allowed. */
void gl_image_drop(struct gl_image *);

#endif
