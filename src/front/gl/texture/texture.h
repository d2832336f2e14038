/* Textures: images of levels and faces, and the renderer's texture of those that fit together.
 *
 * OpenGL defines images one by one, in any sizes. The renderer's texture is made when a draw or a framebuffer
 * needs it. It has all levels if they are a complete set, otherwise the first one. Texels of an image are
 * either in its memory, in the renderer's texture, or in an image that others have too (image.h). The
 * renderer's texture then has a copy, unless it is the image itself. */
#ifndef FRONT_GL_TEXTURE_TEXTURE_H
#define FRONT_GL_TEXTURE_TEXTURE_H

#include "front/gl/texture/depth.h"
#include "front/gl/texture/image.h"
#include "front/gl/texture/texel.h"

enum { GL_FACES = 6 };

struct gl_level {
    const struct gl_texel *texel; /* null: not defined */
    GLenum internal_format;       /* as the program named it */
    unsigned width, height;       /* 0 is possible */
    uint8_t *memory;              /* rows of the storage without gaps; null: see below */
    bool kept;                    /* the texels are in the renderer's texture; otherwise, without memory, 0 */
    struct gl_image *image;       /* held: has the texels; null: it is not one of others */
    unsigned copied;              /* of a kept image: its changes when it was copied */
};

struct gl_texture {
    struct gl_object object;
    GLenum target; /* GL_TEXTURE_2D or GL_TEXTURE_CUBE_MAP; 0: never bound */
    GLenum min_filter, mag_filter, wrap_s, wrap_t;
    GLfloat anisotropy;
    bool generates; /* GL_GENERATE_MIPMAP: a change of the first level makes the others */
    struct gl_level level[GL_FACES][GL_LEVELS];
    triptych_texture *renderer;                      /* null: not needed yet */
    struct triptych_texture_description description; /* of the renderer's texture */
    struct gl_depth depth;                           /* of its first level as one of depth that is attached */
    bool loose;                                      /* images may be in memory that fit to it */
    unsigned images;                                 /* levels that are images of others too */
    bool checked, complete;                          /* `complete` is known, and what it is */
};

struct gl_object *gl_texture_make(struct gl_context *, GLuint name);
/* Finds the texture of a target of images: GL_TEXTURE_2D or a face. Null with an error. */
struct gl_texture *gl_texture_of_image(struct gl_context *, GLenum target, unsigned *face);

/* Returns true if each face has a first image, with texels, all of one size and format. */
bool gl_texture_has_first(const struct gl_texture *);
/* The renderer's texture with all texels; null if it is not complete for its filters (3.7.10), or
 * without memory. */
triptych_texture *gl_texture_use(struct gl_context *, struct gl_texture *);
/* The surface of an image. Returns false without memory. */
bool gl_texture_draw(struct gl_context *, struct gl_texture *, unsigned face, unsigned level,
                     struct triptych_surface *);
/* Defines an image, without texels. */
void gl_texture_define(struct gl_context *, struct gl_texture *, unsigned face, unsigned level,
                       const struct gl_texel *, GLenum internal_format, unsigned width, unsigned height);
/* Writes texels in the form of the storage of `texel`, whose format can differ from the image's. */
bool gl_texture_write(struct gl_context *, struct gl_texture *, unsigned face, unsigned level,
                      const struct gl_texel *texel, const struct triptych_rectangle *, const void *data,
                      size_t pitch);
/* Returns true if an image can be made of a level: the texture is complete, or has this level only. */
bool gl_texture_lends(const struct gl_texture *, unsigned level);
/* Moves the texels of a level to an image, which it returns with one reference more. Null without memory. */
struct gl_image *gl_texture_lend(struct gl_texture *, unsigned face, unsigned level);
/* Takes an image as its only one: level 0. Null: none. */
void gl_texture_take(struct gl_texture *, struct gl_image *);
/* Computes the levels from 1 on from the first one. */
bool gl_texture_generate(struct gl_context *, struct gl_texture *);
/* Follows each write of texels into a level: makes the other levels if the texture generates them. */
void gl_texture_wrote(struct gl_context *, struct gl_texture *, unsigned level);
/* Frees the texels of a texture. */
void gl_texture_free(struct gl_texture *);

static inline unsigned gl_texture_faces(const struct gl_texture *texture)
{
    return texture->target == GL_TEXTURE_CUBE_MAP ? GL_FACES : 1;
}

#endif
