/* Images, and surfaces that are drawn to: attached ones, other targets between draws. */
#include "command/fuzz/case/case_part.h"

int case_find_target(struct maker *maker)
{
    unsigned first = maker->textures ? random_below(&maker->random, maker->textures) : 0;
    for (unsigned i = 0; i < maker->textures; i++)
        if (maker->texture[(first + i) % maker->textures].target)
            return (int)((first + i) % maker->textures);
    return -1;
}

/* Draws that sample what they draw to are one case of two. */
static void unbind_textures(struct maker *maker)
{
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (maker->samplers >> i & 1)
            text_add(maker->text, "bind texture %u none\n", i);
}

unsigned case_level(struct maker *maker, int texture)
{
    const struct case_texture *from = &maker->texture[texture];
    unsigned level = random_chance(&maker->random, 3) ? random_below(&maker->random, from->levels) : 0;
    unsigned slices = from->type == TRIPTYCH_TEXTURE_VOLUME ? from->slices >> level : from->slices;
    unsigned slice = slices ? random_below(&maker->random, slices) : 0;
    if (level)
        text_add(maker->text, " level %u", level);
    if (slice)
        text_add(maker->text, " slice %u", slice);
    return from->size >> level ? from->size >> level : 1;
}

bool case_attach(struct maker *maker)
{
    int texture = case_find_target(maker);
    if (texture < 0)
        return false;
    if (random_chance(&maker->random, 2))
        unbind_textures(maker);
    text_add(maker->text, "attach color t%d", texture);
    case_level(maker, texture);
    if (random_chance(&maker->random, 2))
        text_add(maker->text, " depthformat %s", random_chance(&maker->random, 2) ? "d24s8" : "d16");
    text_add(maker->text, "\n");
    return true;
}

/* --- Images --------------------------------------------------------------------------------------------- */

static unsigned near(struct maker *maker, unsigned size)
{
    unsigned change = random_below(&maker->random, 24);
    return random_chance(&maker->random, 2) ? size : 1 + (size + change) / 2;
}

/* Of the target's size or near it, and mostly with its samples. */
static void add_image(struct maker *maker)
{
    struct case_image *image = &maker->image[maker->images];
    bool several = maker->samples > 1 && !random_chance(&maker->random, 4);
    *image = (struct case_image){near(maker, maker->width),
                                 near(maker, maker->height),
                                 several ? maker->samples : 1,
                                 random_chance(&maker->random, 3),
                                 false,
                                 TRIPTYCH_DEPTH_NONE};
    text_add(maker->text, "image im%u %u %u", maker->images++, image->width, image->height);
    if (image->depth) {
        unsigned format = 0;
        do
            format = random_below(&maker->random, TRIPTYCH_DEPTH_COUNT);
        while (!triptych_depth_bits(format));
        image->stencil = triptych_stencil_bits(format) > 0;
        image->depth_format = format;
        text_add(maker->text, " depth %s", case_depth_format(format));
    } else {
        text_add(maker->text, " %s", case_target_format(maker));
    }
    if (several)
        text_add(maker->text, " samples %u", image->samples);
    text_add(maker->text, "\n");
}

void case_images(struct maker *maker)
{
    unsigned images =
        random_chance(&maker->random, 2) ? 0 : 2 + random_below(&maker->random, CASE_IMAGES - 1);
    while (maker->images < images)
        add_image(maker);
}

/* Surfaces that are drawn to together. */
struct together {
    unsigned width, height, samples, colors;
    uint32_t used; /* images, a bit each */
};

static bool may_join(const struct together *all, const struct case_image *image)
{
    return !all->colors || (all->samples == image->samples && all->samples == 1);
}

static void join(struct together *all, unsigned width, unsigned height, unsigned samples)
{
    all->width = all->colors && all->width < width ? all->width : width;
    all->height = all->colors && all->height < height ? all->height : height;
    all->samples = samples;
    all->colors++;
}

static void attach_colors(struct maker *maker, struct together *all)
{
    int texture = random_chance(&maker->random, 3) ? case_find_target(maker) : -1;
    unsigned most = 1 + random_below(&maker->random, 3);
    if (texture >= 0) {
        text_add(maker->text, " color t%d", texture);
        unsigned size = case_level(maker, texture);
        join(all, size, size, 1);
    }
    for (unsigned tries = 0; tries < 6 && all->colors < most; tries++) {
        unsigned i = random_below(&maker->random, maker->images);
        const struct case_image *image = &maker->image[i];
        if (image->depth || all->used >> i & 1 || !may_join(all, image))
            continue;
        text_add(maker->text, " color im%u", i);
        join(all, image->width, image->height, image->samples);
        all->used |= 1u << i;
    }
}

/* Returns the image; null: there is none that fits. */
static const struct case_image *attach_depth(struct maker *maker, const struct together *all)
{
    unsigned first = random_below(&maker->random, maker->images);
    for (unsigned n = 0; n < maker->images; n++) {
        const struct case_image *image = &maker->image[(first + n) % maker->images];
        if (!image->depth || (all->colors && (image->width < all->width || image->height < all->height ||
                                              image->samples != all->samples)))
            continue;
        text_add(maker->text, " depth im%u", (first + n) % maker->images);
        return image;
    }
    return NULL;
}

void case_detach(struct maker *maker)
{
    text_add(maker->text, "attach none\n");
    maker->attached = false;
    maker->has_depth = maker->target_depth;
    maker->has_stencil = maker->target_stencil;
}

/* Writes a line. Returns false if no surfaces fit together. */
static bool attach(struct maker *maker)
{
    struct together all = {0};
    const struct case_image *depth = NULL;
    size_t begin = maker->text->length;
    text_add(maker->text, "attach");
    if (!random_chance(&maker->random, 6))
        attach_colors(maker, &all);
    if (!all.colors || !random_chance(&maker->random, 3))
        depth = attach_depth(maker, &all);
    if (!all.colors && !depth) {
        text_cut(maker->text, begin);
        return false;
    }
    bool own = !depth && random_chance(&maker->random, 2);
    text_add(maker->text, depth ? "\n" : own ? " depthformat d24s8\n" : " depthformat none\n");
    maker->attached = true;
    maker->has_depth = depth || own;
    maker->has_stencil = own || (depth && depth->stencil);
    return true;
}

void case_switch_target(struct maker *maker)
{
    if (maker->attached && random_chance(&maker->random, 3))
        case_detach(maker);
    else if (attach(maker) && random_chance(&maker->random, 3))
        case_clear(maker, maker->has_depth, maker->has_stencil);
}
