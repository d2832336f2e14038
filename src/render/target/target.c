#include "render/target/target.h"

#include "base/minmax.h"

#include <stdlib.h>
#include <string.h>

const struct format *target_format(const struct triptych_target_description *description, unsigned t)
{
    enum triptych_surface_format number = description->color_format[t];
    return format_find(number || t ? number : TRIPTYCH_SURFACE_A8R8G8B8);
}

/* --- Attachments --- */

/* Absent colours take the room that the pixel routine's key gives them (spec/pixel/target.h). */
static void place_colors(struct target *target, const struct triptych_target_description *description,
                         const struct target_parts *parts)
{
    uint32_t plane = 0;
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct format *format = target_format(description, t);
        struct attachment *a = parts->color[t];
        struct target_color *color = target->colors + t;
        *color = (struct target_color){.format = format, .attachment = a, .plane = plane};
        if (format)
            color->storage = (enum target_storage)format->target;
        plane += storage_planes[color->storage];
        if (!a)
            continue;
        color->clear = a->color_clear;
        color->columns = a->columns;
        target->planes = plane;
    }
}

/* Returns true if the colours that are stored have memory where a pixel routine finds them. */
static bool lie_together(const struct target *target)
{
    const struct tile_memory *memory = NULL;
    uint32_t before = 0; /* planes of the memory before those of the target */
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct target_color *color = target->colors + t;
        const struct attachment *a = color->attachment;
        if (!a)
            continue;
        if (!a->memory || a->plane < color->plane || (memory && memory != a->memory) ||
            (memory && a->plane - color->plane != before))
            return false;
        memory = a->memory;
        before = a->plane - color->plane;
    }
    return true;
}

static struct attachment *first_color(const struct target *target)
{
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].attachment)
            return target->colors[t].attachment;
    return NULL;
}

/* New memory for all colours. Those with words have to move. */
static int gather_colors(struct target *target, bool quad_rows, struct error *error)
{
    uint32_t columns = 0, rows = 0;
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].attachment) {
            columns = max_u32(columns, target->colors[t].attachment->columns);
            rows = max_u32(rows, target->colors[t].attachment->rows);
        }
    struct tile_memory *memory =
        attachment_memory_create(columns, rows, target->planes * target->samples, quad_rows, error);
    if (!memory)
        return -1;
    for (unsigned t = 0; t < TARGETS; t++) {
        struct attachment *a = target->colors[t].attachment;
        uint32_t plane = target->colors[t].plane;
        if (!a)
            continue;
        if (a->memory)
            target->move[target->moves++] = (struct tile_move){
                attachment_retain(a), a->memory, attachment_memory_retain(memory), a->plane, plane};
        a->memory = attachment_memory_retain(memory);
        a->plane = plane;
    }
    attachment_memory_release(memory);
    return 0;
}

static int give_depth_memory(struct attachment *a, bool quad_rows, struct error *error)
{
    if (a && !a->memory)
        a->memory = attachment_memory_create(a->columns, a->rows, a->samples, quad_rows, error);
    return !a || a->memory ? 0 : -1;
}

static void note_size(struct target *target, const struct attachment *a)
{
    if (a && a->width > target->width)
        target->whole_columns = min_u32(target->whole_columns, target->width / TILE_SIZE);
    if (a && a->height > target->height)
        target->whole_rows = min_u32(target->whole_rows, target->height / TILE_SIZE);
}

/* Holds the attachments and their memory. */
static void hold_parts(struct target *target, const struct target_parts *parts)
{
    const struct attachment *first = first_color(target);
    for (unsigned t = 0; t < TARGETS; t++)
        note_size(target, attachment_retain(parts->color[t]));
    if (first)
        target->memory[0] = attachment_memory_retain(first->memory);
    if (!parts->depth)
        return;
    note_size(target, attachment_retain(parts->depth));
    target->depth_attachment = parts->depth;
    target->memory[1] = attachment_memory_retain(parts->depth->memory);
    target->depth_columns = parts->depth->columns;
    target->depth_clear = parts->depth->depth_clear;
}

/* Takes the addresses and the orders of memory. */
static void find_words(struct target *target)
{
    const struct tile_memory *color = target->memory[0], *depth = target->memory[1];
    target->color = NULL;
    for (unsigned t = 0; t < TARGETS && !target->color; t++) {
        const struct attachment *a = target->colors[t].attachment;
        if (a)
            target->color = color->words + (a->plane - target->colors[t].plane) * color->order.plane;
    }
    if (color)
        target->color_order = color->order;
    if (depth) {
        target->depth = depth->words;
        target->depth_order = depth->order;
    }
}

void target_set_order(struct target *target, bool quad_rows)
{
    for (int i = 0; i < 2; i++)
        attachment_memory_set_order(target->memory[i], quad_rows);
    find_words(target);
}

int target_bind(struct target *target, const struct triptych_target_description *description,
                const struct target_parts *parts, struct error *error)
{
    struct target t = {.width = description->width,
                       .height = description->height,
                       .samples = 1u << samples_exponent(description->samples),
                       .depth_format = description->depth_format};
    t.columns = t.whole_columns = (t.width + TILE_SIZE - 1) / TILE_SIZE;
    t.rows = t.whole_rows = (t.height + TILE_SIZE - 1) / TILE_SIZE;
    place_colors(&t, description, parts);
    if (give_depth_memory(parts->depth, parts->quad_rows, error) ||
        (!lie_together(&t) && gather_colors(&t, parts->quad_rows, error)))
        return -1;
    hold_parts(&t, parts);
    find_words(&t);
    *target = t;
    return 0;
}

/* Colours of the format NULL store nothing. */
static int create_parts(const struct triptych_target_description *description, struct target_parts *parts,
                        struct error *error)
{
    uint32_t width = description->width, height = description->height;
    uint32_t samples = 1u << samples_exponent(description->samples);
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct format *format = target_format(description, t);
        if (!format || format->number == TRIPTYCH_SURFACE_NULL)
            continue;
        parts->color[t] = attachment_create_color(format, width, height, samples, error);
        if (!parts->color[t])
            return -1;
    }
    if (!depth_formats[description->depth_format].depth_bits)
        return 0;
    parts->depth = attachment_create_depth(description->depth_format, width, height, samples, error);
    return parts->depth ? 0 : -1;
}

int target_create(struct target *target, const struct triptych_target_description *description,
                  bool quad_rows, struct error *error)
{
    struct target_parts parts = {.quad_rows = quad_rows};
    int result = create_parts(description, &parts, error);
    if (!result)
        result = target_bind(target, description, &parts, error);
    for (unsigned t = 0; t < TARGETS; t++)
        attachment_release(parts.color[t]);
    attachment_release(parts.depth);
    return result;
}

void target_destroy(struct target *target)
{
    for (uint32_t i = 0; i < target->moves; i++) {
        attachment_release(target->move[i].attachment);
        attachment_memory_release(target->move[i].from);
        attachment_memory_release(target->move[i].to);
    }
    for (unsigned t = 0; t < TARGETS; t++)
        attachment_release(target->colors[t].attachment);
    attachment_release(target->depth_attachment);
    attachment_memory_release(target->memory[0]);
    attachment_memory_release(target->memory[1]);
    memset(target, 0, sizeof *target);
}

void target_move_tile(const struct tile_move *move, uint32_t tile)
{
    const struct attachment *a = move->attachment;
    const struct tile_memory *from = move->from, *to = move->to;
    uint32_t column = tile % a->columns, row = tile / a->columns;
    if (a->color_clear[tile].pending)
        return;
    for (uint32_t p = 0; p < attachment_planes(a) * a->samples; p++)
        tile_order_copy(&from->order, tile_memory_words(from, column, row, move->from_plane + p), &to->order,
                        tile_memory_words(to, column, row, move->to_plane + p));
}

/* --- Views --- */

bool target_needs_view(const struct target *target)
{
    return (target->memory[0] && target->memory[0]->quad_rows) ||
           (target->memory[1] && target->memory[1]->quad_rows);
}

/* Copies the planes of all colours whose words are valid, from a target to the same with another order. */
static void copy_colors(const struct target *from, uint32_t tile, const struct target *to)
{
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct target_color *color = from->colors + t;
        if (!color->clear || target_color_clear(from, t, tile)->pending)
            continue;
        const uint32_t *source = target_color_words(from, color, tile);
        uint32_t *words = target_color_words(to, color, tile), planes = storage_planes[color->storage];
        for (uint32_t p = 0; p < planes * from->samples; p++) {
            size_t plane = p / planes * from->planes + p % planes;
            tile_order_copy(&from->color_order, source + plane * from->color_order.plane, &to->color_order,
                            words + plane * to->color_order.plane);
        }
    }
}

static void copy_depth(const struct target *from, uint32_t tile, const struct target *to)
{
    if (target_depth_clear(from, tile)->pending)
        return;
    for (uint32_t s = 0; s < from->samples; s++)
        tile_order_copy(&from->depth_order, target_tile_depth(from, tile) + s * from->depth_order.plane,
                        &to->depth_order, target_tile_depth(to, tile) + s * to->depth_order.plane);
}

void target_open_view(const struct target *target, uint32_t tile, uint32_t *words, struct target *view)
{
    *view = *target;
    if (target->color && target->memory[0]->quad_rows) {
        view->color = words;
        view->color_order = tile_order_alone;
        copy_colors(target, tile, view);
    }
    if (target->depth && target->memory[1]->quad_rows) {
        view->depth = words + 4 * SAMPLES_MAXIMUM * TILE_PIXELS;
        view->depth_order = tile_order_alone;
        copy_depth(target, tile, view);
    }
}

void target_close_view(const struct target *view, uint32_t tile, const struct target *target)
{
    if (view->color != target->color)
        copy_colors(view, tile, target);
    if (view->depth != target->depth)
        copy_depth(view, tile, target);
}

/* --- The whole --- */

void target_describe(const struct target *target, struct triptych_target_description *description)
{
    *description = (struct triptych_target_description){.width = target->width,
                                                        .height = target->height,
                                                        .samples = target->samples,
                                                        .depth_format = target->depth_format};
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].format)
            description->color_format[t] = (enum triptych_surface_format)target->colors[t].format->number;
}

void target_clear_words(const struct target *target, const float color[4], uint32_t words[TARGET_PLANES])
{
    memset(words, 0, TARGET_PLANES * sizeof *words);
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].format) {
            uint32_t encoded[4];
            color_encode(target->colors[t].format, color, encoded);
            memcpy(words + target->colors[t].plane, encoded,
                   storage_planes[target->colors[t].storage] * sizeof *words);
        }
}

/* The pixels of a tile of an image, the last tiles cut. */
static struct rectangle area_in(uint32_t width, uint32_t height, uint32_t column, uint32_t row)
{
    int32_t x = (int32_t)column * TILE_SIZE, y = (int32_t)row * TILE_SIZE;
    return (struct rectangle){x, y, min_i32(x + TILE_SIZE, (int32_t)width),
                              min_i32(y + TILE_SIZE, (int32_t)height)};
}

struct rectangle target_tile_area(const struct target *target, uint32_t tile)
{
    return area_in(target->width, target->height, tile % target->columns, tile / target->columns);
}

struct rectangle target_attachment_area(const struct attachment *a, uint32_t tile)
{
    return area_in(a->width, a->height, tile % a->columns, tile / a->columns);
}
