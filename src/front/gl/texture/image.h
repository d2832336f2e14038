/* Images that several objects have in common (front/gl/image.h), as the objects see them. */
#ifndef FRONT_GL_TEXTURE_IMAGE_H
#define FRONT_GL_TEXTURE_IMAGE_H

#include "front/gl/image.h"
#include "front/gl/texture/depth.h"
#include "front/gl/texture/texel.h"

struct gl_renderable;
struct gl_texture;

struct gl_image {
    struct gl_device *device;
    triptych_device *renderer; /* of the device */
    struct gl_image *next;     /* of those of the device with a handle */
    const void *handle;        /* of the window system; null: OES_EGL_image does not find it */
    unsigned references;
    struct triptych_surface surface;        /* a texture of one level; of depth without texels, an image */
    struct gl_depth depth;                  /* of the surface, if it is one of depth or stencil */
    const struct gl_texel *texel;           /* null: no texture can have it */
    const struct gl_renderable *renderable; /* null: no renderbuffer can have it */
    unsigned width, height;
    unsigned changes;          /* how often texels were written, or could be */
    bool has_copies;           /* textures of several images have copies */
    struct gl_texture *holder; /* that has the colour of a surface; null: none */
};

/* Makes an image with texels 0 and one reference. Null without memory. */
struct gl_image *gl_image_make(struct gl_device *, const struct gl_texel *, unsigned width, unsigned height);
/* Adds a reference, and returns the image; removes one. */
struct gl_image *gl_image_hold(struct gl_image *);
void gl_image_release(struct gl_image *);
/* Notes that texels are written: copies of them are old. */
void gl_image_change(struct gl_image *);
/* A texture no longer has the image. */
void gl_image_part(struct gl_image *, const struct gl_texture *);

#endif
