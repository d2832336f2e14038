/* Framebuffers: what is attached, whether it is complete, and the surfaces that the renderer draws to. */
#ifndef FRONT_GL_TEXTURE_FRAMEBUFFER_H
#define FRONT_GL_TEXTURE_FRAMEBUFFER_H

#include "front/gl/texture/depth.h"

struct gl_image;
struct gl_texel;
struct gl_texture;

/* An image that is attached. Without an object there is none. */
struct gl_attachment {
    struct gl_object *object; /* held: a texture or a renderbuffer */
    bool is_texture;
    GLenum target; /* of a texture: GL_TEXTURE_2D or a face */
    unsigned face, level;
};

struct gl_framebuffer {
    struct gl_object object;
    struct gl_attachment color[GL_DRAWS], depth, stencil;
    GLenum draw[GL_DRAWS]; /* glDrawBuffersEXT: GL_COLOR_ATTACHMENTi or GL_NONE */
};

struct gl_renderbuffer {
    struct gl_object object;
    const struct gl_renderable *format; /* null: no storage yet */
    GLenum internal_format;
    unsigned width, height;
    triptych_image *image;   /* null if a side is 0 */
    struct gl_depth depth;   /* of the image, if it is one of depth or stencil */
    struct gl_image *shared; /* held, instead of the image: what others have too */
};

/* A format of renderbuffers, and its bits. */
struct gl_renderable {
    GLenum internal_format;
    enum triptych_surface_format color; /* 0: of depth */
    enum triptych_depth_format depth;
    uint8_t red, green, blue, alpha, depth_bits, stencil_bits;
};

/* The surfaces of a draw, a clear or a read. The images `depth` and `stencil` of a framebuffer object are
 * joined before they are drawn to. */
struct gl_target {
    struct triptych_target_surfaces surfaces; /* the colours of draws, in their order */
    struct gl_depth *depth, *stencil;         /* null: none, or those of the default framebuffer */
    struct triptych_surface read;             /* the colour that is read */
    enum triptych_surface_format read_format;
    bool has_read;
    unsigned width, height, samples;
    unsigned red, green, blue, alpha, depth_bits, stencil_bits;
    unsigned colors; /* bit i: colour i is drawn to */
};

/* Fills in the target of draws, or of reads. Returns GL_FRAMEBUFFER_COMPLETE, or what is missing:
 * GL_FRAMEBUFFER_UNDEFINED_OES if there is no default framebuffer. */
GLenum gl_framebuffer_target(struct gl_context *, bool read, struct gl_target *);
/* The same; records the error of a command that needs a complete framebuffer. */
bool gl_framebuffer_check(struct gl_context *, bool read, struct gl_target *);
/* Detaches an object that is deleted from the bound framebuffer. */
void gl_framebuffer_detach(struct gl_context *, struct gl_object *);

/* The storage of a renderbuffer that has one. */
struct triptych_surface gl_renderbuffer_surface(const struct gl_renderbuffer *);
/* The texels of a texture with the format of a renderbuffer, which is one of colours; and the format of a
 * renderbuffer with such texels, null if there is none. */
const struct gl_texel *gl_renderable_texel(const struct gl_renderable *);
const struct gl_renderable *gl_renderable_of_texel(const struct gl_texel *);
/* The storage of a renderbuffer becomes an image that others have too. */
void gl_renderbuffer_take(struct gl_context *, struct gl_renderbuffer *, struct gl_image *);
#endif
