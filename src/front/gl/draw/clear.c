/* glClear: chapter 4.2.3. */
#include "front/gl/commands.h"
#include "front/gl/draw/prepare.h"
#include "front/gl/state.h"

#include <string.h>

static struct triptych_clear_values values_of(const struct gl_values *from)
{
    struct triptych_clear_values values = {.depth = from->clear_depth[0],
                                           .stencil = (unsigned)from->clear_stencil[0],
                                           .stencil_mask = from->stencil_write[0] & 0xff,
                                           .everywhere = 1};
    memcpy(values.color, from->clear_color, sizeof values.color);
    for (unsigned i = 0; i < 4; i++)
        values.color_mask |= (unsigned)from->color_write[i] << i;
    return values;
}

/* Bits of the surface without a meaning are cleared too: whole words cost nothing. */
static void widen(const struct gl_target *target, struct triptych_clear_values *values)
{
    unsigned both = TRIPTYCH_CLEAR_DEPTH | TRIPTYCH_CLEAR_STENCIL;
    struct gl_depth *image = target->depth ? target->depth : target->stencil;
    if (!image || !(values->flags & both))
        return;
    image = target->depth ? image : gl_depth_host(image);
    if (!gl_depth_guest(image)->has_stencil) {
        values->flags |= both;
        values->stencil_mask = 0xff;
    } else if (!image->has_depth && values->stencil_mask == 0xff) {
        values->flags |= both;
    }
}

void gl_Clear(struct gl_context *context, GLbitfield mask)
{
    const struct gl_values *from = &context->values;
    struct triptych_clear_values values = values_of(from);
    struct gl_target target;
    if (mask & ~(GLbitfield)(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT)) {
        gl_error(context, GL_INVALID_VALUE, "found the bits 0x%x, expected colour, depth and stencil", mask);
        return;
    }
    if (!gl_framebuffer_check(context, false, &target))
        return;
    values.flags =
        (mask & GL_COLOR_BUFFER_BIT && target.colors && values.color_mask ? TRIPTYCH_CLEAR_COLOR : 0u) |
        (mask & GL_DEPTH_BUFFER_BIT && target.depth_bits && from->depth_write[0] ? TRIPTYCH_CLEAR_DEPTH
                                                                                 : 0u) |
        (mask & GL_STENCIL_BUFFER_BIT && target.stencil_bits && values.stencil_mask ? TRIPTYCH_CLEAR_STENCIL
                                                                                    : 0u);
    if (!values.flags || !gl_prepare_target(context, &target))
        return;
    widen(&target, &values);
    gl_renderer_did(context, triptych_clear_rectangles(context->renderer, &values, NULL, 0));
}
