/* Texture objects: names, parameters, mipmaps: chapters 3.7.4 to 3.7.13. */
#include "front/gl/texture/texture.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/fixed.h"
#include "front/gl/texture/framebuffer.h"
#include "front/gl/state.h"

/* --- Names --- */

static void destroy(struct gl_object *object)
{
    gl_texture_free((struct gl_texture *)object);
}

struct gl_object *gl_texture_make(struct gl_context *context, GLuint name)
{
    struct gl_texture *texture = gl_object_make(context->share, sizeof *texture, name, destroy);
    if (!texture)
        return NULL;
    texture->min_filter = GL_NEAREST_MIPMAP_LINEAR;
    texture->mag_filter = GL_LINEAR;
    texture->wrap_s = texture->wrap_t = GL_REPEAT;
    texture->anisotropy = 1;
    return &texture->object;
}

/* Returns GL_DIMENSIONS, with an error, for a target that does not exist. */
static enum gl_dimension dimension_of(struct gl_context *context, GLenum target)
{
    if (target == GL_TEXTURE_2D)
        return GL_DIMENSION_2D;
    if (target == GL_TEXTURE_CUBE_MAP)
        return GL_DIMENSION_CUBE;
    gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_TEXTURE_2D or GL_TEXTURE_CUBE_MAP",
             gl_constant_name(target));
    return GL_DIMENSIONS;
}

static struct gl_texture *bound(struct gl_context *context, GLenum target)
{
    enum gl_dimension dimension = dimension_of(context, target);
    return dimension < GL_DIMENSIONS ? context->texture[gl_state_unit(context)][dimension] : NULL;
}

struct gl_texture *gl_texture_of_image(struct gl_context *context, GLenum target, unsigned *face)
{
    unsigned unit = gl_state_unit(context);
    *face = target - GL_TEXTURE_CUBE_MAP_POSITIVE_X;
    if (*face < GL_FACES)
        return context->texture[unit][GL_DIMENSION_CUBE];
    *face = 0;
    if (target == GL_TEXTURE_2D)
        return context->texture[unit][GL_DIMENSION_2D];
    gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_TEXTURE_2D or a face",
             gl_constant_name(target));
    return NULL;
}

void gl_ActiveTexture(struct gl_context *context, GLenum texture)
{
    unsigned units = context->fixed ? GL_FIXED_UNITS : GL_UNITS;
    if (texture - GL_TEXTURE0 >= units)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_TEXTURE0 to %u more",
                 gl_constant_name(texture), units - 1);
    else
        context->values.active_texture[0] = texture;
}

void gl_BindTexture(struct gl_context *context, GLenum target, GLuint name)
{
    enum gl_dimension dimension = dimension_of(context, target);
    if (dimension == GL_DIMENSIONS)
        return;
    struct gl_texture *texture =
        name ? (struct gl_texture *)gl_object_bind(context, GL_KIND_TEXTURE, name, gl_texture_make)
             : context->texture_0[dimension];
    if (!texture)
        return;
    if (texture->target && texture->target != target) {
        gl_error(context, GL_INVALID_OPERATION, "found texture %u of %s, expected one of the target", name,
                 gl_constant_name(texture->target));
        return;
    }
    texture->target = target;
    GL_HOLD(&context->texture[gl_state_unit(context)][dimension], texture);
    context->late |= GL_LATE_TEXTURES;
}

void gl_GenTextures(struct gl_context *context, GLsizei count, GLuint *names)
{
    gl_object_generate(context, GL_KIND_TEXTURE, count, names);
}

static void unbind(struct gl_context *context, struct gl_object *object)
{
    for (unsigned unit = 0; unit < GL_UNITS; unit++)
        for (unsigned i = 0; i < GL_DIMENSIONS; i++)
            if ((struct gl_object *)context->texture[unit][i] == object)
                GL_HOLD(&context->texture[unit][i], context->texture_0[i]);
    gl_framebuffer_detach(context, object);
    context->late |= GL_LATE_TEXTURES;
}

void gl_DeleteTextures(struct gl_context *context, GLsizei count, const GLuint *names)
{
    gl_object_delete(context, GL_KIND_TEXTURE, count, names, unbind);
}

GLboolean gl_IsTexture(struct gl_context *context, GLuint name)
{
    return gl_object_find(context, GL_KIND_TEXTURE, name) != NULL;
}

/* --- Parameters --- */

static bool is_wrap(GLenum value)
{
    return value == GL_REPEAT || value == GL_CLAMP_TO_EDGE || value == GL_MIRRORED_REPEAT;
}

static bool is_filter(GLenum value, bool of_levels)
{
    return value == GL_NEAREST || value == GL_LINEAR ||
           (of_levels && value >= GL_NEAREST_MIPMAP_NEAREST && value <= GL_LINEAR_MIPMAP_LINEAR);
}

/* Returns the place of a parameter, and whether it can have the value; null if it does not exist. */
static GLenum *find_parameter(struct gl_texture *texture, GLenum name, GLenum value, bool *fits)
{
    switch (name) {
    case GL_TEXTURE_MIN_FILTER: *fits = is_filter(value, true); return &texture->min_filter;
    case GL_TEXTURE_MAG_FILTER: *fits = is_filter(value, false); return &texture->mag_filter;
    case GL_TEXTURE_WRAP_S: *fits = is_wrap(value); return &texture->wrap_s;
    case GL_TEXTURE_WRAP_T: *fits = is_wrap(value); return &texture->wrap_t;
    default: return NULL;
    }
}

static void set_anisotropy(struct gl_context *context, struct gl_texture *texture, GLfloat value)
{
    if (!(value >= 1))
        gl_error(context, GL_INVALID_VALUE, "found an anisotropy of %g, expected 1 or more", (double)value);
    else
        texture->anisotropy = value < GL_ANISOTROPY ? value : GL_ANISOTROPY;
}

static void set_parameter(struct gl_context *context, GLenum target, GLenum name, GLenum value, GLfloat real)
{
    struct gl_texture *texture = bound(context, target);
    bool fits = false;
    if (!texture)
        return;
    context->late |= GL_LATE_TEXTURES;
    if (name == GL_GENERATE_MIPMAP && context->fixed) {
        texture->generates = real != 0;
        return;
    }
    if (name == GL_TEXTURE_MAX_ANISOTROPY_EXT) {
        set_anisotropy(context, texture, real);
        return;
    }
    GLenum *place = find_parameter(texture, name, value, &fits);
    if (!place || !fits) {
        gl_error(context, GL_INVALID_ENUM, "found the parameter %s with the value 0x%04x",
                 gl_constant_name(name), value);
        return;
    }
    *place = value;
    texture->checked = false;
}

void gl_TexParameteri(struct gl_context *context, GLenum target, GLenum name, GLint value)
{
    set_parameter(context, target, name, (GLenum)value, (GLfloat)value);
}

void gl_TexParameteriv(struct gl_context *context, GLenum target, GLenum name, const GLint *values)
{
    gl_TexParameteri(context, target, name, values[0]);
}

/* Enumerations are whole numbers below 2^16. */
void gl_TexParameterf(struct gl_context *context, GLenum target, GLenum name, GLfloat value)
{
    set_parameter(context, target, name, value >= 0 && value < 65536 ? (GLenum)value : 0, value);
}

void gl_TexParameterfv(struct gl_context *context, GLenum target, GLenum name, const GLfloat *values)
{
    gl_TexParameterf(context, target, name, values[0]);
}

static bool get_parameter(struct gl_context *context, GLenum target, GLenum name, GLfloat *out)
{
    struct gl_texture *texture = bound(context, target);
    bool fits;
    if (!texture)
        return false;
    if (name == GL_GENERATE_MIPMAP && context->fixed) {
        *out = texture->generates;
        return true;
    }
    const GLenum *place = find_parameter(texture, name, 0, &fits);
    if (!place && name != GL_TEXTURE_MAX_ANISOTROPY_EXT) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a parameter of textures",
                 gl_constant_name(name));
        return false;
    }
    *out = place ? (GLfloat)*place : texture->anisotropy;
    return true;
}

void gl_GetTexParameterfv(struct gl_context *context, GLenum target, GLenum name, GLfloat *out)
{
    get_parameter(context, target, name, out);
}

void gl_GetTexParameteriv(struct gl_context *context, GLenum target, GLenum name, GLint *out)
{
    GLfloat value;
    if (get_parameter(context, target, name, &value))
        *out = (GLint)value;
}

/* --- Mipmaps --- */

void gl_texture_wrote(struct gl_context *context, struct gl_texture *texture, unsigned level)
{
    const struct gl_level *first = &texture->level[0][0];
    if (level || !texture->generates || !gl_texture_has_first(texture) || !first->texel->type ||
        first->texel->depth)
        return;
    if (!gl_texture_generate(context, texture))
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for mipmaps");
}

void gl_GenerateMipmap(struct gl_context *context, GLenum target)
{
    struct gl_texture *texture = bound(context, target);
    if (!texture)
        return;
    const struct gl_level *first = &texture->level[0][0];
    if (!gl_texture_has_first(texture) || !first->texel->type || first->texel->depth)
        gl_error(context, GL_INVALID_OPERATION,
                 "found a texture without mipmaps, expected the first level of "
                 "each face, neither compressed nor of depth");
    else if (!gl_texture_generate(context, texture))
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for mipmaps");
}
