/* Texels: formats of programs, their storage in the renderer, and the conversion between them. */
#ifndef FRONT_GL_TEXTURE_TEXEL_H
#define FRONT_GL_TEXTURE_TEXEL_H

#include "front/gl/gl.h"

/* A row of texel.def. */
struct gl_texel {
    GLenum format, type;
    uint8_t bytes;         /* of a texel; of a block if the type is 0 */
    uint8_t storage_bytes; /* of a texel */
    enum triptych_surface_format storage;
    void (*convert)(void *out, const void *in, unsigned texels);
    uint8_t red, green, blue, alpha, depth, stencil;
    bool drawn;
};

/* Returns null if the pair does not exist. */
const struct gl_texel *gl_texel_find(GLenum format, GLenum type);
/* Returns the format without a size of an internal format that texels of the type can have; a format without
 * a size is its own. 0: there is none. A type of 0 is any. */
GLenum gl_texel_base(GLenum internal_format, GLenum type);
/* The texels of an image that is copied from a framebuffer; null if there are none of the internal format. */
const struct gl_texel *gl_texel_of_copy(GLenum internal_format);
/* Returns true if any row has the format, or the type. */
bool gl_texel_has_format(GLenum format);
bool gl_texel_has_type(GLenum type);

/* The bytes between two rows of `width` texels of `bytes` bytes, with an alignment of 1, 2, 4 or 8. */
size_t gl_texel_pitch(unsigned width, unsigned bytes, unsigned alignment);
/* Converts a rectangle, whose rows are `from` bytes apart, to rows of the storage, which are `pitch` bytes
 * apart. */
void gl_texel_convert(const struct gl_texel *, unsigned width, unsigned height, const void *in, size_t from,
                      void *out, size_t pitch);
/* The bytes of a compressed image, and its texels as rows of the storage. */
size_t gl_texel_compressed_bytes(const struct gl_texel *, unsigned width, unsigned height);
void gl_texel_decompress(const struct gl_texel *, unsigned width, unsigned height, const void *in, void *out,
                         size_t pitch);
/* Texels back from the storage to the program's format, of rows that are read (glReadPixels). In place. */
void gl_texel_rotate_back(GLenum type, void *texels, unsigned count);

#endif
