#include "render/target/attachment.h"

#include "machine/large.h"
#include "machine/mxcsr.h"

#include <stdlib.h>

/* --- Memory --- */

struct tile_memory *attachment_memory_create(uint32_t columns, uint32_t rows, uint32_t stride,
                                             struct error *error)
{
    size_t bytes = (size_t)columns * rows * stride * sizeof(uint32_t);
    struct tile_memory *memory = malloc(sizeof *memory);
    if (memory)
        *memory = (struct tile_memory){large_allocate(bytes), columns, rows, stride, 1};
    if (memory && memory->words)
        return memory;
    free(memory);
    error_set(error, "out of memory for a target of %u x %u pixels (%zu MiB)", columns * TILE_SIZE,
              rows * TILE_SIZE, bytes >> 20);
    return NULL;
}

struct tile_memory *attachment_memory_retain(struct tile_memory *memory)
{
    if (memory)
        memory->references++;
    return memory;
}

void attachment_memory_release(struct tile_memory *memory)
{
    if (!memory || --memory->references)
        return;
    free(memory->words);
    free(memory);
}

/* --- Attachments --- */

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
__attribute__((noinline)) static void clear_tiles(struct attachment *a)
{
    uint32_t tiles = a->columns * a->rows;
    struct color_clear color = {.pending = true};
    struct depth_clear depth = {.word = depth_encode(a->depth_format, 1), .pending = true};
    depth.range = (struct depth_range){depth.word, depth.word};
    if (a->format)
        color_encode(a->format, (const float[4]){0}, color.word);
    for (uint32_t i = 0; i < tiles && a->color_clear; i++)
        a->color_clear[i] = color;
    for (uint32_t i = 0; i < tiles && a->depth_clear; i++)
        a->depth_clear[i] = depth;
}

static struct attachment *create(struct attachment made, struct error *error)
{
    struct attachment *a = malloc(sizeof *a);
    made.references = 1;
    made.columns = (made.width + TILE_SIZE - 1) / TILE_SIZE;
    made.rows = (made.height + TILE_SIZE - 1) / TILE_SIZE;
    size_t tiles = (size_t)made.columns * made.rows;
    if (made.format)
        made.color_clear = calloc(tiles, sizeof *made.color_clear);
    else
        made.depth_clear = calloc(tiles, sizeof *made.depth_clear);
    if (!a || !(made.color_clear || made.depth_clear)) {
        free(made.color_clear);
        free(made.depth_clear);
        free(a);
        error_set(error, "out of memory for a target of %u x %u pixels", made.width, made.height);
        return NULL;
    }
    *a = made;
    unsigned saved = mxcsr_enter();
    clear_tiles(a);
    mxcsr_leave(saved);
    return a;
}

struct attachment *attachment_create_color(const struct format *format, uint32_t width, uint32_t height,
                                           uint32_t samples, struct error *error)
{
    return create((struct attachment){.format = format, .width = width, .height = height, .samples = samples},
                  error);
}

struct attachment *attachment_create_depth(enum triptych_depth_format format, uint32_t width, uint32_t height,
                                           uint32_t samples, struct error *error)
{
    return create(
        (struct attachment){.depth_format = format, .width = width, .height = height, .samples = samples},
        error);
}

struct attachment *attachment_retain(struct attachment *attachment)
{
    if (attachment)
        attachment->references++;
    return attachment;
}

void attachment_release(struct attachment *attachment)
{
    if (!attachment || --attachment->references)
        return;
    attachment_memory_release(attachment->memory);
    free(attachment->color_clear);
    free(attachment->depth_clear);
    free(attachment);
}
