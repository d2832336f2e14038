#include "command/assets/paint.h"

#include <stdlib.h>
#include <string.h>

void paint_describe_image(struct resource *resource, uint32_t width, uint32_t height)
{
    resource->texture = (struct triptych_texture_description){
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8B8G8R8, width, height, 1, 1};
    resource->texel_bytes = 4 * (size_t)width * height;
}

uint32_t paint_swap(uint32_t c)
{
    return (c & 0xff00ff00) | (c >> 16 & 0xff) | (c & 0xff) << 16;
}

/* One level of a face under construction: rows of RGBA8 words, slice after slice. */
struct canvas {
    const struct triptych_texture *shape;
    const struct texture_level *level;
    unsigned face;
    uint32_t *texels;
};

typedef void painter(struct resource *resource, const struct canvas *canvas);

static void paint_fill(struct resource *resource, const struct canvas *canvas)
{
    unsigned levels = resource->color_count / canvas->shape->faces;
    unsigned number = (unsigned)(canvas->level - canvas->shape->level) + canvas->face * levels;
    uint32_t color = paint_swap(resource->colors[number]);
    for (size_t i = 0; i < texture_level_count(canvas->level); i++)
        canvas->texels[i] = color;
}

static void paint_checker(struct resource *resource, const struct canvas *canvas)
{
    uint32_t *texel = canvas->texels, cell = resource->cell;
    for (uint32_t z = 0; z < (uint32_t)canvas->level->depth; z++)
        for (uint32_t y = 0; y < (uint32_t)canvas->level->height; y++)
            for (uint32_t x = 0; x < (uint32_t)canvas->level->width; x++)
                *texel++ = paint_swap(resource->colors[(x / cell + y / cell + z / cell) % 2]);
}

/* From 0 at the first texel of a side to 255 at the last. */
static uint32_t ramp(int at, int size)
{
    return size > 1 ? (uint32_t)((510 * at + size - 1) / (2 * (size - 1))) : 0;
}

static void paint_gradient(struct resource *resource, const struct canvas *canvas)
{
    const struct texture_level *level = canvas->level;
    uint32_t *texel = canvas->texels;
    (void)resource;
    for (int z = 0; z < level->depth; z++)
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                uint32_t blue = canvas->shape->faces > 1 ? canvas->face * 51 : ramp(z, level->depth);
                *texel++ = 0xff000000 | blue << 16 | ramp(y, level->height) << 8 | ramp(x, level->width);
            }
}

/* Converts to floats, from which formats with more than 8 bits are encoded. */
static void widen(const uint32_t *texels, size_t count, float *numbers)
{
    for (size_t i = 0; i < 4 * count; i++)
        numbers[i] = (float)(texels[i / 4] >> 8 * (i % 4) & 255) / 255.0f;
}

/* The canvas has room for the level's floats after its words. */
static void encode_level(const struct canvas *canvas, uint8_t *data)
{
    const struct format *format = canvas->shape->format;
    uint32_t width = (uint32_t)canvas->level->width;
    uint32_t rows = (uint32_t)(canvas->level->height * canvas->level->depth);
    const void *texels = canvas->texels;
    if (format->storage == STORAGE_FLOAT4) {
        float *numbers = (float *)(void *)(canvas->texels + (size_t)width * rows);
        widen(canvas->texels, (size_t)width * rows, numbers);
        texels = numbers;
    }
    format_encode(format, texels, width, width, rows, data, texture_row_bytes(format, width));
}

unsigned paint_given_levels(const struct resource *resource, const struct triptych_texture *shape)
{
    return resource->mips ? 1 : shape->levels;
}

/* The colours are in the order of the texels of a texture whose faces have only the given levels. */
static void paint_colors(struct resource *resource, const struct canvas *canvas)
{
    size_t first = canvas->face * (resource->color_count / canvas->shape->faces);
    for (const struct texture_level *level = canvas->shape->level; level < canvas->level; level++)
        first += texture_level_count(level);
    for (size_t i = 0; i < texture_level_count(canvas->level); i++)
        canvas->texels[i] = paint_swap(resource->colors[first + i]);
}

static void paint_image(struct resource *resource, const struct canvas *canvas)
{
    memcpy(canvas->texels, resource->colors, 4 * texture_level_count(canvas->level));
}

static painter *const painters[] = {[TEXTURE_COLORS] = paint_colors,
                                    [TEXTURE_FILL] = paint_fill,
                                    [TEXTURE_CHECKER] = paint_checker,
                                    [TEXTURE_GRADIENT] = paint_gradient,
                                    [TEXTURE_FILES] = paint_image};

int paint_texture(struct resource *resource, const struct triptych_texture *shape, struct error *error)
{
    size_t texels = texture_level_count(&shape->level[0]);
    uint8_t *data = resource->texels;
    struct canvas canvas = {.shape = shape, .texels = malloc(texels * (4 + 16))};
    if (!canvas.texels)
        return error_set(error, "not enough memory");
    for (canvas.face = 0; canvas.face < shape->faces; canvas.face++)
        for (unsigned level = 0; level < paint_given_levels(resource, shape); level++) {
            canvas.level = &shape->level[level];
            painters[resource->source](resource, &canvas);
            encode_level(&canvas, data);
            data += texture_level_bytes(shape, level);
        }
    free(canvas.texels);
    return 0;
}
