/* Targets and textures of random kinds: every format that can be one, every type, few texels. */
#include "command/fuzz/case/case_part.h"

#include "render/texture/format.h"
#include "render/texture/texture.h"

static unsigned format_count(void)
{
    unsigned count = 0;
    while (format_at(count))
        count++;
    return count;
}

static const struct format *random_format(struct maker *maker, unsigned role)
{
    const struct format *format;
    unsigned count = format_count();
    do
        format = format_at(random_below(&maker->random, count));
    while (!(format->roles & role));
    return format;
}

/* Small, so that hundreds of cases fit into a second; now and then of several tiles, for threads to share. */
static void choose_size(struct maker *maker)
{
    bool large = random_chance(&maker->random, 32);
    maker->width = 1 + random_below(&maker->random, large ? 140 : 20);
    maker->height = 1 + random_below(&maker->random, large ? 90 : 16);
}

static void add_color_formats(struct maker *maker)
{
    maker->targets =
        maker->samples == 1 && random_chance(&maker->random, 6) ? 2 + random_below(&maker->random, 3) : 1;
    if (maker->targets == 1 && random_chance(&maker->random, 2))
        return;
    text_add(maker->text, " color");
    for (unsigned t = 0; t < maker->targets; t++) {
        const struct format *format = random_format(maker, ROLE_TARGET);
        maker->target.color_format[t] = format->number;
        text_add(maker->text, " %s", format->name);
    }
}

const char *case_depth_format(unsigned format)
{
    static const char *const name[] = {
#define DEPTH_FORMAT(name, word, storage, depth_bits, stencil_bits, meaning) #word,
#include "def/state/depth_format.def"
#undef DEPTH_FORMAT
    };
    return name[format];
}

const char *case_target_format(struct maker *maker)
{
    return random_format(maker, ROLE_TARGET)->name;
}

void case_target(struct maker *maker)
{
    unsigned depth = random_below(&maker->random, TRIPTYCH_DEPTH_COUNT);
    choose_size(maker);
    maker->has_depth = maker->target_depth = triptych_depth_bits(depth) > 0;
    maker->has_stencil = maker->target_stencil = triptych_stencil_bits(depth) > 0;
    maker->samples = random_chance(&maker->random, 8) ? 2u << random_below(&maker->random, 3) : 1;
    text_add(maker->text, "target %u %u depth %s", maker->width, maker->height, case_depth_format(depth));
    if (maker->samples > 1)
        text_add(maker->text, " samples %u", maker->samples);
    maker->target = (struct triptych_target_description){.width = maker->width,
                                                         .height = maker->height,
                                                         .depth_format = (enum triptych_depth_format)depth,
                                                         .samples = maker->samples,
                                                         .color_format = {TRIPTYCH_SURFACE_A8R8G8B8}};
    add_color_formats(maker);
    text_add(maker->text, "\n");
}

/* --- Textures ------------------------------------------------------------------------------------------- */

void case_words(struct maker *maker, size_t count)
{
    text_add(maker->text, " {");
    for (size_t i = 0; i < count; i++)
        text_add(maker->text, "%s%u", i % 8 ? " " : "\n    ", (uint32_t)random_u64(&maker->random));
    text_add(maker->text, "\n}\n");
}

static void add_bytes(struct maker *maker, size_t count)
{
    text_add(maker->text, " bytes {");
    for (size_t i = 0; i < count; i++)
        text_add(maker->text, "%s%02x", i % 32 ? "" : "\n    ", random_below(&maker->random, 256));
    text_add(maker->text, "\n}");
}

/* Images whose texels lie one after the other: their number. */
static size_t texel_blocks(const struct case_texture *texture, const struct format *format, unsigned depth)
{
    size_t side = (texture->size + format->side - 1) / format->side;
    return side * side * depth * (texture->type == TRIPTYCH_TEXTURE_CUBE ? 6 : 1);
}

/* Levels come from the first one, where their texels are written. */
static void add_contents(struct maker *maker, const struct case_texture *texture, const struct format *format,
                         unsigned depth)
{
    size_t bytes = texel_blocks(texture, format, depth) * format->bytes;
    bool packed = format->coding == CODING_PACKED;
    if (bytes <= 4096 && (!packed || random_chance(&maker->random, 3))) {
        add_bytes(maker, bytes);
    } else if (!packed) {
        text_add(maker->text, " empty");
    } else if (random_chance(&maker->random, 2)) {
        text_add(maker->text, " gradient");
    } else {
        text_add(maker->text, " checker %u", 1 + random_below(&maker->random, 3));
        case_color(maker);
        case_color(maker);
    }
}

/* A buffer with other texels for a face's first level. */
static void add_update(struct maker *maker, unsigned number, const struct format *format, unsigned depth)
{
    struct case_texture *texture = &maker->texture[number];
    struct case_texture face = {.type = TRIPTYCH_TEXTURE_2D, .size = texture->size};
    texture->update_words = (unsigned)((texel_blocks(&face, format, depth) * format->bytes + 3) / 4);
    text_add(maker->text, "buffer u%u u32", number);
    case_words(maker, texture->update_words);
}

/* A buffer with other texels for the whole texture, as the renderer has them. */
static void add_whole(struct maker *maker, unsigned number, const struct format *format, unsigned depth)
{
    struct case_texture *texture = &maker->texture[number];
    struct triptych_texture_description description = {.type = texture->type,
                                                       .format = (enum triptych_surface_format)format->number,
                                                       .width = texture->size,
                                                       .height = texture->size,
                                                       .depth = depth,
                                                       .levels = texture->levels};
    struct triptych_texture shape;
    if (texture_describe(&description, &shape, NULL) != TRIPTYCH_OK)
        return;
    texture->whole = true;
    text_add(maker->text, "buffer w%u u32", number);
    case_words(maker, texture_texel_bytes(&shape) / sizeof(uint32_t));
}

static enum triptych_texture_type choose_type(struct maker *maker)
{
    unsigned first = random_below(&maker->random, TRIPTYCH_SAMPLERS), any = random_below(&maker->random, 3);
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++) {
        unsigned sampler = (first + i) % TRIPTYCH_SAMPLERS;
        if (maker->samplers >> sampler & 1 && maker->sampler_type[sampler] != ANY_TEXTURE)
            return (enum triptych_texture_type)maker->sampler_type[sampler];
    }
    return (enum triptych_texture_type)any;
}

static void add_texture(struct maker *maker)
{
    static const char *const type[] = {"2d", "cube", "volume"};
    unsigned number = maker->textures++;
    struct case_texture *texture = &maker->texture[number];
    *texture = (struct case_texture){.type = choose_type(maker)};
    const struct format *format = random_format(maker, ROLE_TEXTURE);
    if (format->roles & ROLE_DEPTH)
        texture->type = TRIPTYCH_TEXTURE_2D;
    unsigned depth = texture->type == TRIPTYCH_TEXTURE_VOLUME ? 1 + random_below(&maker->random, 4) : 1;
    /* whole blocks of compressed formats */
    texture->size = format->side * (1 + random_below(&maker->random, 8 / format->side + 1));
    texture->depth = format->roles & ROLE_DEPTH;
    texture->target = format->roles & ROLE_TARGET && texture->type != TRIPTYCH_TEXTURE_VOLUME;
    text_add(maker->text, "texture t%u %s %s %u", number, type[texture->type], format->name, texture->size);
    if (texture->type != TRIPTYCH_TEXTURE_CUBE)
        text_add(maker->text, " %u", texture->size);
    if (texture->type == TRIPTYCH_TEXTURE_VOLUME)
        text_add(maker->text, " %u", depth);
    texture->mips = random_chance(&maker->random, 2) && format->coding == CODING_PACKED;
    texture->slices = texture->type == TRIPTYCH_TEXTURE_CUBE ? 6 : depth;
    texture->levels = 1;
    while (texture->mips && (texture->size | depth) >> texture->levels)
        texture->levels++;
    if (texture->mips)
        text_add(maker->text, " mips");
    add_contents(maker, texture, format, depth);
    text_add(maker->text, "\n");
    if (random_chance(&maker->random, 8))
        add_update(maker, number, format, depth);
    if (random_chance(&maker->random, 24))
        add_whole(maker, number, format, depth);
}

/* A shader's samplers find textures of their kind as a rule. */
void case_textures(struct maker *maker)
{
    bool wanted = maker->shader[TRIPTYCH_SHADER_VERTEX] || maker->shader[TRIPTYCH_SHADER_PIXEL];
    unsigned count =
        wanted && maker->samplers ? 1 + random_below(&maker->random, 4) : random_below(&maker->random, 4);
    while (maker->textures < count)
        add_texture(maker);
}
