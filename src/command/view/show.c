#include "command/view/show.h"

#include "command/inspect/overdraw.h"
#include "command/view/font.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TILE = 64, MARGIN = 4, LARGE = 900 /* pixels across, from which on text is larger */ };

static const uint32_t black = 0xff000000, white = 0xffffffff, amber = 0xff40c0ff;

void show_line(struct show_text *text, const char *format, ...)
{
    va_list arguments;
    if (text->lines == SHOW_LINES)
        return;
    va_start(arguments, format);
    vsnprintf(text->line[text->lines++], SHOW_COLUMNS, format, arguments);
    va_end(arguments);
}

/* A colour for each primitive, never dark: neighbours in number have very different ones. */
static uint32_t owner_color(const struct watch_owner *owner)
{
    uint32_t hash = owner->primitive * 2654435761u ^ owner->draw * 2246822519u;
    hash ^= hash >> 15;
    hash *= 2246822519u;
    hash ^= hash >> 13;
    return owner->draw ? (hash & 0x00ffffff) | 0xff404040 : black;
}

static uint32_t color_at(const struct show *show, const struct scene *scene, size_t pixel)
{
    switch (show->mode) {
    case SHOW_OVERDRAW: return overdraw_color(scene_analysis(scene)->count[pixel]);
    case SHOW_TRIANGLES: return owner_color(scene_analysis(scene)->owner + pixel);
    case SHOW_PICTURE: break;
    }
    return scene_picture(scene)->color[pixel];
}

static int reserve(struct show *show, unsigned width, unsigned height, struct error *error)
{
    size_t pixels = (size_t)width * height;
    if (pixels > show->capacity) {
        free(show->color);
        show->color = malloc(pixels * sizeof *show->color);
        show->capacity = show->color ? pixels : 0;
    }
    show->width = show->color ? width : 0;
    show->height = show->color ? height : 0;
    return show->color ? 0 : error_set(error, "no memory for a picture of %zu pixels", pixels);
}

static void enlarge(struct show *show, const struct scene *scene)
{
    unsigned width = scene_picture(scene)->width, zoom = show->zoom;
    for (unsigned y = 0; y < show->height; y++) {
        uint32_t *row = show->color + (size_t)y * show->width;
        if (y % zoom) {
            memcpy(row, row - show->width, show->width * sizeof *row);
            continue;
        }
        for (unsigned x = 0; x < show->width; x++)
            row[x] = x % zoom ? row[x - 1] : color_at(show, scene, (size_t)(y / zoom) * width + x / zoom);
    }
}

static void draw_tiles(struct show *show)
{
    unsigned side = TILE * show->zoom;
    for (unsigned y = 0; y < show->height; y++)
        for (unsigned x = 0; x < show->width; x++)
            if (!(x % side) || !(y % side))
                show->color[(size_t)y * show->width + x] = amber;
}

static void draw_text(const struct show *show)
{
    const struct font_picture picture = {show->width, show->height, show->color};
    int scale = show->width < LARGE ? 1 : 2, y = MARGIN;
    for (unsigned i = 0; show->text && i < show->text->lines; i++, y += FONT_HEIGHT * scale)
        font_draw(&picture, MARGIN, y, scale, white, show->text->line[i]);
    if (*show->message)
        font_draw(&picture, MARGIN, (int)show->height - MARGIN - FONT_HEIGHT * scale, scale, amber,
                  show->message);
}

int show_make(struct show *show, const struct scene *scene, struct error *error)
{
    const struct scene_picture *picture = scene_picture(scene);
    const struct scene_analysis *analysis = scene_analysis(scene);
    if (analysis->width != picture->width || analysis->height != picture->height)
        show->mode = SHOW_PICTURE;
    if (reserve(show, picture->width * show->zoom, picture->height * show->zoom, error))
        return -1;
    enlarge(show, scene);
    if (show->tiles)
        draw_tiles(show);
    draw_text(show);
    return 0;
}
