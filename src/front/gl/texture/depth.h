/* Depth and stencil of renderbuffers and textures, which a framebuffer can have from two of them (4.4.5).
 *
 * The renderer has both in one surface: words with depth above stencil. So each image has a surface of such
 * words, also if it has only depth or only stencil. Its depth is always there. When it is drawn to with the
 * stencil of another image, both surfaces exchange their stencil. Stencil stays where it is until another
 * pair of images needs it elsewhere: then it costs a copy, otherwise nothing. The surfaces have one size.
 *
 * An image whose surface goes away, or gets new words, takes its stencil back first. */
#ifndef FRONT_GL_TEXTURE_DEPTH_H
#define FRONT_GL_TEXTURE_DEPTH_H

#include "front/gl/object.h"

struct gl_depth {
    struct triptych_surface surface;
    unsigned width, height;
    bool has_depth, has_stencil; /* otherwise the bits are in the words, and have no meaning */
    struct gl_depth *host;       /* whose surface has this image's stencil; null: its own */
    struct gl_depth *guest;      /* whose stencil this image's surface has; null: its own */
};

/* Brings the stencil of one image into the surface of the other. Both can be one. Returns false if memory is
 * refused: the bits are then undefined. */
bool gl_depth_join(struct gl_share *, struct gl_depth *depth, struct gl_depth *stencil);
/* The same for an image and its own stencil. */
bool gl_depth_part(struct gl_share *, struct gl_depth *);

/* The image whose surface has the stencil of this one. */
static inline struct gl_depth *gl_depth_host(struct gl_depth *image)
{
    return image->host ? image->host : image;
}

/* The image whose stencil is in the surface of this one. */
static inline struct gl_depth *gl_depth_guest(struct gl_depth *image)
{
    return image->guest ? image->guest : image;
}

#endif
