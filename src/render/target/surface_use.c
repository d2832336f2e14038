/* The rules for copies, reads, writes and fills of surfaces. */
#include "render/target/surface.h"

/* A part of width 0 is all of the surface. */
static enum triptych_result find_part(const struct surface_form *form, const char *what,
                                      const struct triptych_rectangle *given, struct triptych_rectangle *part,
                                      struct error *error)
{
    *part = (struct triptych_rectangle){0, 0, form->width, form->height};
    if (!given || !given->width)
        return TRIPTYCH_OK;
    *part = *given;
    if (part->height && part->x < form->width && part->y < form->height &&
        part->width <= form->width - part->x && part->height <= form->height - part->y)
        return TRIPTYCH_OK;
    error_set(error, "%s: %u x %u pixels at %u, %u: expected a part of %u x %u", what, part->width,
              part->height, part->x, part->y, form->width, form->height);
    return TRIPTYCH_BAD_ARGUMENT;
}

static const char *form_name(const struct surface_form *form)
{
    return form->format ? form->format->name : depth_formats[form->depth_format].name;
}

/* --- Copies --- */

/* Colours of any formats; depth of one format and by points. */
static enum triptych_result check_copied_forms(const struct surface_form form[2],
                                               enum triptych_copy_filter filter, struct error *error)
{
    if (form[0].format && form[1].format)
        return TRIPTYCH_OK;
    if (form[0].format || form[1].format || form[0].depth_format != form[1].depth_format)
        error_set(error, "copy of format %s to format %s: expected two formats of colours, or one of depth",
                  form_name(&form[0]), form_name(&form[1]));
    else if (filter != TRIPTYCH_COPY_POINT)
        error_set(error, "copy of depth with a linear filter: expected point");
    else
        return TRIPTYCH_OK;
    return TRIPTYCH_BAD_ARGUMENT;
}

enum triptych_result surface_check_copy(const struct surface_copy *copy,
                                        const struct triptych_target_description *target,
                                        struct surface_copy_plan *plan, struct error *error)
{
    static const char *const what[2] = {"source of a copy", "target of a copy"};
    if ((unsigned)copy->filter >= TRIPTYCH_COPY_COUNT) {
        error_set(error, "filter %u of a copy: expected point (0) or linear (1)", (unsigned)copy->filter);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    for (int i = 0; i < 2; i++) {
        enum triptych_result result =
            surface_find_form(copy->surface[i], what[i], target, &plan->form[i], error);
        if (result == TRIPTYCH_OK)
            result = find_part(&plan->form[i], what[i], &copy->part[i], &plan->part[i], error);
        if (result != TRIPTYCH_OK)
            return result;
    }
    return check_copied_forms(plan->form, copy->filter, error);
}

/* --- Memory --- */

static bool is_whole_blocks(const struct surface_memory *memory)
{
    const struct triptych_rectangle *part = &memory->part;
    unsigned side = memory->format->side;
    return part->x % side == 0 && part->y % side == 0 &&
           (part->width % side == 0 || part->x + part->width == memory->form.width) &&
           (part->height % side == 0 || part->y + part->height == memory->form.height);
}

static enum triptych_result check_format(const struct surface_memory *memory,
                                         enum triptych_surface_format number, struct error *error)
{
    if (!memory->form.format && number)
        error_set(error, "format %u for pixels of depth: expected 0", (unsigned)number);
    else if (!memory->form.format)
        return TRIPTYCH_OK;
    else if (!memory->format ||
             (!pixels_is_memory_format(memory->format) && memory->format != memory->form.format) ||
             memory->format->number == TRIPTYCH_SURFACE_NULL)
        error_set(error, "format %s for pixels in memory: expected 0, or an uncompressed format of colours",
                  memory->format ? memory->format->name : "of an unknown number");
    else if (!is_whole_blocks(memory))
        error_set(error, "%u x %u pixels at %u, %u in format %s: expected whole 4x4 blocks",
                  memory->part.width, memory->part.height, memory->part.x, memory->part.y,
                  memory->format->name);
    else
        return TRIPTYCH_OK;
    return TRIPTYCH_BAD_ARGUMENT;
}

static void find_bytes(struct surface_memory *memory)
{
    const struct pixels depth = {.depth_format = memory->form.depth_format};
    memory->rows = memory->part.height;
    if (!memory->format) {
        memory->row_bytes = memory->part.width * pixels_memory_bytes(&depth, NULL);
        return;
    }
    memory->row_bytes = texture_row_bytes(memory->format, memory->part.width);
    memory->rows = format_blocks(memory->format, memory->part.height);
}

enum triptych_result surface_check_memory(const struct triptych_surface *surface,
                                          const struct triptych_rectangle *part,
                                          enum triptych_surface_format format,
                                          const struct triptych_target_description *target,
                                          struct surface_memory *memory, struct error *error)
{
    enum triptych_result result = surface_find_form(surface, "surface", target, &memory->form, error);
    if (result == TRIPTYCH_OK)
        result = find_part(&memory->form, "surface", part, &memory->part, error);
    if (result != TRIPTYCH_OK)
        return result;
    memory->format = format ? format_find(format) : memory->form.format;
    result = check_format(memory, format, error);
    if (result == TRIPTYCH_OK)
        find_bytes(memory);
    return result;
}

enum triptych_result surface_check_fill(const struct triptych_surface *surface,
                                        const struct triptych_rectangle *part,
                                        const struct triptych_target_description *target,
                                        struct surface_memory *memory, struct error *error)
{
    enum triptych_result result = surface_find_form(surface, "surface", target, &memory->form, error);
    if (result == TRIPTYCH_OK)
        result = find_part(&memory->form, "surface", part, &memory->part, error);
    if (result != TRIPTYCH_OK || memory->form.format)
        return result;
    error_set(error, "fill of format %s: expected a format of colours", form_name(&memory->form));
    return TRIPTYCH_BAD_ARGUMENT;
}
