/* Changes of surfaces between draws: drawing to textures, copies, new texels. */
#include "command/fuzz/case/case_part.h"

#include "render/texture/format.h"

/* A texture that can be drawn to; -1: none. */
static int find_target(struct maker *maker)
{
    unsigned first = maker->textures ? random_below(&maker->random, maker->textures) : 0;
    for (unsigned i = 0; i < maker->textures; i++)
        if (maker->texture[(first + i) % maker->textures].target)
            return (int)((first + i) % maker->textures);
    return -1;
}

/* A texture that is drawn to cannot be sampled: all samplers that may have it are emptied. */
static void unbind_textures(struct maker *maker)
{
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (maker->samplers >> i & 1)
            text_add(maker->text, "bind texture %u none\n", i);
}

bool case_attach(struct maker *maker)
{
    int texture = find_target(maker);
    if (texture < 0)
        return false;
    unbind_textures(maker);
    text_add(maker->text, "attach color t%d", texture);
    if (maker->texture[texture].type == TRIPTYCH_TEXTURE_CUBE)
        text_add(maker->text, " slice %u", random_below(&maker->random, 6));
    if (random_chance(&maker->random, 2))
        text_add(maker->text, " depthformat %s", random_chance(&maker->random, 2) ? "d24s8" : "d16");
    text_add(maker->text, "\n");
    return true;
}

static void add_surface(struct maker *maker, int texture)
{
    if (texture < 0) {
        text_add(maker->text, " target");
        return;
    }
    text_add(maker->text, " t%d", texture);
    if (maker->texture[texture].type == TRIPTYCH_TEXTURE_CUBE)
        text_add(maker->text, " slice %u", random_below(&maker->random, 6));
}

static void add_part(struct maker *maker, int texture)
{
    unsigned width = texture < 0 ? maker->width : maker->texture[texture].size;
    unsigned height = texture < 0 ? maker->height : maker->texture[texture].size;
    unsigned x = random_below(&maker->random, width), y = random_below(&maker->random, height);
    if (random_chance(&maker->random, 2))
        text_add(maker->text, " part %u %u %u %u", x, y, 1 + random_below(&maker->random, width - x),
                 1 + random_below(&maker->random, height - y));
}

/* Between the target and a texture that can be one, either way. */
void case_copy(struct maker *maker)
{
    int surface[2] = {-1, find_target(maker)};
    bool back = random_chance(&maker->random, 3);
    if (surface[1] < 0 || maker->samples > 1)
        return;
    text_add(maker->text, "copy");
    add_surface(maker, surface[back]);
    add_part(maker, surface[back]);
    text_add(maker->text, " to");
    add_surface(maker, surface[!back]);
    add_part(maker, surface[!back]);
    text_add(maker->text, random_chance(&maker->random, 2) ? " linear\n" : "\n");
}

/* New texels for the first level, and what is made of it. */
void case_change(struct maker *maker)
{
    if (!maker->textures)
        return;
    unsigned t = random_below(&maker->random, maker->textures);
    if (maker->texture[t].update_words)
        text_add(maker->text, "update t%u u%u\n", t, t);
    if (maker->texture[t].mips)
        text_add(maker->text, "mips t%u\n", t);
}
