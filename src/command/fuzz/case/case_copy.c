/* Changes of surfaces and textures between draws: copies, fills, pixels of memory, new texels. */
#include "command/fuzz/case/case_part.h"

#include "render/texture/format.h"

#include <string.h>

/* A surface: a texture's, an image, or with neither a colour of the target. */
struct place {
    int texture, image; /* -1: none */
    unsigned width, height;
};

static const struct place target_place = {-1, -1, 0, 0};

/* Writes the surface, and determines its size. */
static void add_surface(struct maker *maker, struct place *place)
{
    if (place->texture >= 0) {
        text_add(maker->text, " t%d", place->texture);
        place->width = place->height = case_level(maker, place->texture);
    } else if (place->image >= 0) {
        text_add(maker->text, " im%d", place->image);
        place->width = maker->image[place->image].width;
        place->height = maker->image[place->image].height;
    } else {
        unsigned slice = random_below(&maker->random, maker->targets);
        text_add(maker->text, slice ? " target slice %u" : " target", slice);
        place->width = maker->width;
        place->height = maker->height;
    }
}

static void add_part(struct maker *maker, const struct place *place)
{
    unsigned x = random_below(&maker->random, place->width), y = random_below(&maker->random, place->height);
    if (random_chance(&maker->random, 2))
        text_add(maker->text, " part %u %u %u %u", x, y, 1 + random_below(&maker->random, place->width - x),
                 1 + random_below(&maker->random, place->height - y));
}

/* An image of colours or of depth; -1: none. */
static int find_image(struct maker *maker, bool depth)
{
    unsigned first = maker->images ? random_below(&maker->random, maker->images) : 0;
    for (unsigned i = 0; i < maker->images; i++)
        if (maker->image[(first + i) % maker->images].depth == depth)
            return (int)((first + i) % maker->images);
    return -1;
}

/* --- Copies --------------------------------------------------------------------------------------------- */

/* Colours: of the target, of a texture that can be drawn to, of an image. */
static struct place color_place(struct maker *maker)
{
    struct place place = target_place;
    unsigned kind = random_below(&maker->random, 5);
    if (kind < 2)
        place.texture = case_find_target(maker);
    else if (kind < 4)
        place.image = find_image(maker, false);
    return place;
}

/* Depth and stencil have one format. Returns false if there is none. */
static bool depth_places(struct maker *maker, struct place place[2])
{
    place[0] = place[1] = target_place;
    place[0].image = place[1].image = find_image(maker, true);
    if (place[0].image < 0)
        return false;
    for (unsigned i = 0; i < maker->images; i++)
        if (maker->image[i].depth &&
            maker->image[i].depth_format == maker->image[place[0].image].depth_format &&
            random_chance(&maker->random, 2))
            place[1].image = (int)i;
    return true;
}

void case_copy(struct maker *maker)
{
    struct place place[2];
    bool depth = random_chance(&maker->random, 4) && depth_places(maker, place);
    if (!depth) {
        place[0] = color_place(maker);
        place[1] = color_place(maker);
    }
    text_add(maker->text, "copy");
    add_surface(maker, &place[0]);
    add_part(maker, &place[0]);
    text_add(maker->text, " to");
    add_surface(maker, &place[1]);
    add_part(maker, &place[1]);
    text_add(maker->text, !depth && random_chance(&maker->random, 2) ? " linear\n" : "\n");
}

/* --- Fills and pixels ----------------------------------------------------------------------------------- */

/* A colour for a part of the target, of any texture of colours, or of an image. */
void case_fill(struct maker *maker)
{
    struct place place = target_place;
    place.texture = (int)random_below(&maker->random, maker->textures + 1) - 1;
    if (place.texture >= 0 && maker->texture[place.texture].depth)
        return;
    if (place.texture < 0 && random_chance(&maker->random, 2))
        place.image = find_image(maker, false);
    text_add(maker->text, "fill");
    add_surface(maker, &place);
    add_part(maker, &place);
    text_add(maker->text, " color");
    case_numbers(maker, 4, -0.5f, 1.5f);
    text_add(maker->text, "\n");
}

/* A format of at most four bytes that pixels in memory can have. */
static const char *memory_format(struct maker *maker)
{
    static const char *const formats[] = {"A8R8G8B8", "R5G6B5",      "L8",       "A8B8G8R8",
                                          "R8G8B8",   "A2R10G10B10", "G16R16",   "R16F",
                                          "G16R16F",  "A4L4",        "Q8W8V8U8", "A1R5G5B5"};
    return formats[random_below(&maker->random, sizeof formats / sizeof *formats)];
}

/* Pixels of depth in memory have two bytes or four. */
static unsigned depth_bytes(const struct case_image *image)
{
    return triptych_depth_bits(image->depth_format) + triptych_stencil_bits(image->depth_format) > 16 ? 4 : 2;
}

/* The bytes of a texture's update as one row of pixels. */
static void add_pixels(struct maker *maker, struct place *place, unsigned bytes, const char *format,
                       unsigned texture)
{
    size_t begin = maker->text->length;
    unsigned pixels = maker->texture[texture].update_words * 4 / bytes;
    text_add(maker->text, "pixels");
    add_surface(maker, place);
    if (!pixels || pixels > place->width) {
        text_cut(maker->text, begin);
        return;
    }
    text_add(maker->text, " part %u %u %u 1", random_below(&maker->random, place->width - pixels + 1),
             random_below(&maker->random, place->height), pixels);
    text_add(maker->text, format ? " format %s u%u\n" : "%s u%u\n", format ? format : "", texture);
}

void case_write_pixels(struct maker *maker)
{
    int texture = maker->textures ? (int)random_below(&maker->random, maker->textures) : -1;
    struct place place = target_place;
    if (texture < 0 || !maker->texture[texture].update_words || maker->texture[texture].depth)
        return;
    unsigned to = random_below(&maker->random, 4);
    if (to == 0 && (place.image = find_image(maker, true)) >= 0) {
        add_pixels(maker, &place, depth_bytes(&maker->image[place.image]), NULL, (unsigned)texture);
        return;
    }
    if (to == 1)
        place.texture = texture;
    if (to == 2)
        place.image = find_image(maker, false);
    const char *name = memory_format(maker);
    add_pixels(maker, &place, format_named(name, strlen(name))->bytes, name, (unsigned)texture);
}

/* --- Texels --------------------------------------------------------------------------------------------- */

/* New texels for the first level or for all, and what is made of them. */
void case_change(struct maker *maker)
{
    if (!maker->textures)
        return;
    unsigned t = random_below(&maker->random, maker->textures);
    if (maker->texture[t].whole && random_chance(&maker->random, 2))
        text_add(maker->text, "texels t%u w%u\n", t, t);
    if (maker->texture[t].update_words)
        text_add(maker->text, "update t%u u%u\n", t, t);
    if (maker->texture[t].mips)
        text_add(maker->text, "mips t%u\n", t);
}
