/* glReadPixels: chapter 4.3, and EXT_robustness. */
#include "front/gl/texture/read.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"
#include "front/gl/texture/texel.h"

bool gl_read_area(struct gl_context *context, const struct gl_target *target, const struct gl_area *area,
                  enum triptych_surface_format format, unsigned bytes, void *out, size_t pitch)
{
    int64_t left = area->x > 0 ? area->x : 0, bottom = area->y > 0 ? area->y : 0;
    int64_t right = (int64_t)area->x + area->width, top = (int64_t)area->y + area->height;
    right = right < target->width ? right : target->width;
    top = top < target->height ? top : target->height;
    if (left >= right || bottom >= top)
        return true;
    struct triptych_rectangle part = {(unsigned)left, (unsigned)bottom, (unsigned)(right - left),
                                      (unsigned)(top - bottom)};
    uint8_t *first = (uint8_t *)out + (size_t)(bottom - area->y) * pitch + (size_t)(left - area->x) * bytes;
    return triptych_read_rectangle(context->renderer, &target->read, &part, format, first,
                                   (ptrdiff_t)pitch) == TRIPTYCH_OK;
}

void gl_read_preferred(const struct gl_target *target, GLenum *format, GLenum *type)
{
    *format = GL_BGRA_EXT;
    *type = GL_UNSIGNED_BYTE;
    if (target->red == 10) {
        *format = GL_RGBA;
        *type = GL_UNSIGNED_INT_2_10_10_10_REV_EXT;
    } else if (target->red == 5) {
        *format = target->alpha ? GL_RGBA : GL_RGB;
        *type = target->alpha ? GL_UNSIGNED_SHORT_5_5_5_1 : GL_UNSIGNED_SHORT_5_6_5;
    } else if (target->red == 4) {
        *format = GL_RGBA;
        *type = GL_UNSIGNED_SHORT_4_4_4_4;
    }
}

static bool check_format(struct gl_context *context, const struct gl_target *target, GLenum format,
                         GLenum type)
{
    GLenum other_format, other_type;
    gl_read_preferred(target, &other_format, &other_type);
    if ((format == GL_RGBA && type == GL_UNSIGNED_BYTE) || (format == other_format && type == other_type) ||
        (format == GL_BGRA_EXT && gl_texel_find(format, type)))
        return true;
    bool known = gl_texel_has_format(format) && gl_texel_has_type(type);
    gl_error(context, known ? GL_INVALID_OPERATION : GL_INVALID_ENUM,
             "found format 0x%04x of type 0x%04x, expected GL_RGBA of bytes or format 0x%04x of type 0x%04x",
             format, type, other_format, other_type);
    return false;
}

/* Returns true if all rows of the area are within `room` bytes. The last row ends with its last pixel. */
static bool fits(const struct gl_area *area, size_t pitch, unsigned bytes, size_t room)
{
    size_t before, all, row = (size_t)area->width * bytes;
    if (!area->width || !area->height)
        return true;
    return !__builtin_mul_overflow(pitch, (size_t)area->height - 1, &before) &&
           !__builtin_add_overflow(before, row, &all) && all <= room;
}

static bool check_read(struct gl_context *context, const struct gl_area *area, GLenum format, GLenum type,
                       struct gl_target *target)
{
    if (area->width < 0 || area->height < 0) {
        gl_error(context, GL_INVALID_VALUE, "found a size of %d x %d, expected 0 or more", area->width,
                 area->height);
        return false;
    }
    if (!gl_framebuffer_check(context, true, target))
        return false;
    if (!target->has_read) {
        gl_error(context, GL_INVALID_OPERATION, "found a framebuffer without colour 0");
        return false;
    }
    return check_format(context, target, format, type);
}

static void read_pixels(struct gl_context *context, const struct gl_area *area, GLenum format, GLenum type,
                        size_t room, void *pixels)
{
    struct gl_target target;
    if (!check_read(context, area, format, type, &target))
        return;
    const struct gl_texel *texel = gl_texel_find(format, type);
    unsigned width = (unsigned)area->width;
    size_t pitch = gl_texel_pitch(width, texel->bytes, (unsigned)context->values.pack_alignment[0]);
    if (!fits(area, pitch, texel->bytes, room)) {
        gl_error(context, GL_INVALID_OPERATION, "found a size of %zu bytes, expected more for %d x %d pixels",
                 room, area->width, area->height);
        return;
    }
    if (!gl_read_area(context, &target, area, texel->storage, texel->bytes, pixels, pitch))
        gl_error(context, GL_OUT_OF_MEMORY, "the renderer: %s", triptych_error(context->renderer));
    for (GLsizei row = 0; row < area->height && texel->bytes == 2; row++)
        gl_texel_rotate_back(type, (uint8_t *)pixels + (size_t)row * pitch, width);
}

void gl_ReadPixels(struct gl_context *context, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format,
                   GLenum type, void *pixels)
{
    read_pixels(context, &(struct gl_area){x, y, width, height}, format, type, SIZE_MAX, pixels);
}

void gl_ReadnPixelsEXT(struct gl_context *context, GLint x, GLint y, GLsizei width, GLsizei height,
                       GLenum format, GLenum type, GLsizei room, void *pixels)
{
    if (room < 0)
        gl_error(context, GL_INVALID_VALUE, "found room for %d bytes, expected 0 or more", room);
    else
        read_pixels(context, &(struct gl_area){x, y, width, height}, format, type, (size_t)room, pixels);
}
