#include "render/texture/texture.h"

#include "memory/extent.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define STORAGE_MAXIMUM ((uint64_t)1 << 32)

static const char *const type_name[TRIPTYCH_TEXTURE_TYPE_COUNT] = {"2d", "cube", "volume"};

static uint32_t halved(uint32_t size, unsigned level)
{
    return size >> level ? size >> level : 1;
}

/* Levels down to 1 x 1 x 1. */
static uint32_t full_chain(const struct triptych_texture_description *description)
{
    return 32 - (uint32_t)__builtin_clz(description->width | description->height | description->depth);
}

/* --- Checking --- */

static enum triptych_result check_format(const struct triptych_texture_description *description,
                                         struct error *error)
{
    const struct format *format = format_find(description->format);
    if (!format) {
        error_set(error, "format %u: expected one of Direct3D 9's", (unsigned)description->format);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!(format->roles & ROLE_TEXTURE)) {
        error_set(error, "format %s is not supported for textures", format->name);
        return TRIPTYCH_UNSUPPORTED;
    }
    if (format->roles & ROLE_DEPTH && description->type != TRIPTYCH_TEXTURE_2D) {
        error_set(error, "format %s for a %s texture: expected 2d", format->name,
                  type_name[description->type]);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return TRIPTYCH_OK;
}

static enum triptych_result check_size(const struct triptych_texture_description *d, struct error *error)
{
    uint32_t most = d->type == TRIPTYCH_TEXTURE_VOLUME ? TRIPTYCH_VOLUME_MAXIMUM : TRIPTYCH_TEXTURE_MAXIMUM;
    uint32_t deep = d->type == TRIPTYCH_TEXTURE_VOLUME ? most : 1;
    if (!d->width || !d->height || d->width > most || d->height > most)
        error_set(error, "texture of %u x %u texels: expected 1 to %u a side", d->width, d->height, most);
    else if (!d->depth || d->depth > deep)
        error_set(error, "%s texture of depth %u: expected 1%s", type_name[d->type], d->depth,
                  deep > 1 ? " to 2048" : "");
    else if (d->type == TRIPTYCH_TEXTURE_CUBE && d->width != d->height)
        error_set(error, "cube texture of %u x %u texels: expected a square", d->width, d->height);
    else if (d->levels > full_chain(d))
        error_set(error, "texture of %u levels: expected at most %u, or 0 for all", d->levels, full_chain(d));
    else
        return TRIPTYCH_OK;
    return TRIPTYCH_BAD_ARGUMENT;
}

static enum triptych_result check(const struct triptych_texture_description *description, struct error *error)
{
    if ((unsigned)description->type >= TRIPTYCH_TEXTURE_TYPE_COUNT) {
        error_set(error, "texture type %u: expected 2d (0), cube (1) or volume (2)",
                  (unsigned)description->type);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    enum triptych_result result = check_format(description, error);
    return result == TRIPTYCH_OK ? check_size(description, error) : result;
}

/* --- Making --- */

/* Fills in the levels; returns the texels of a face. */
static uint64_t lay_out(struct triptych_texture *texture)
{
    uint64_t offset = 0;
    for (unsigned i = 0; i < texture->levels; i++) {
        uint32_t width = halved(texture->width, i), height = halved(texture->height, i);
        uint32_t depth = halved(texture->depth, i);
        texture->level[i] = (struct texture_level){
            .offset = (int32_t)offset,
            .width = (int32_t)width,
            .height = (int32_t)height,
            .depth = (int32_t)depth,
            .pitch = (int32_t)(width + 1),
            .slice_texels = (int32_t)((width + 1) * height),
        };
        offset += (uint64_t)(width + 1) * height * depth;
    }
    return offset;
}

/* Every texel what a block of zeros decodes to. */
static void clear_texels(struct triptych_texture *texture, size_t bytes)
{
    static const uint8_t zeros[16];
    size_t size = format_texel_bytes(texture->format);
    uint8_t *texels = (uint8_t *)texture->texels;
    format_decode(texture->format, zeros, 0, 1, 1, texels, 1);
    for (size_t filled = size; filled < bytes; filled *= 2)
        memcpy(texels + filled, texels, filled < bytes - filled ? filled : bytes - filled);
}

static enum triptych_result allocate(struct triptych_texture *texture, struct error *error)
{
    size_t bytes = texture_storage_bytes(texture);
    size_t margin = TEXTURE_MARGIN_ROWS * (size_t)texture->level[0].pitch + TEXTURE_MARGIN_TEXELS;
    size_t room = bytes + margin * format_texel_bytes(texture->format);
    texture->texels = extent_allocate(room);
    if (!texture->texels || texture_blocks_create(texture)) {
        extent_free(texture->texels);
        error_set(error, "out of memory for a texture of %u x %u texels", texture->width, texture->height);
        return TRIPTYCH_NO_MEMORY;
    }
    clear_texels(texture, bytes);
    return TRIPTYCH_OK;
}

enum triptych_result texture_describe(const struct triptych_texture_description *description,
                                      struct triptych_texture *texture, struct error *error)
{
    enum triptych_result result = check(description, error);
    if (result != TRIPTYCH_OK)
        return result;
    *texture = (struct triptych_texture){
        .format = format_find(description->format),
        .type = description->type,
        .width = description->width,
        .height = description->height,
        .depth = description->depth,
        .levels = description->levels ? description->levels : full_chain(description),
        .faces = description->type == TRIPTYCH_TEXTURE_CUBE ? CUBE_FACES : 1,
    };
    uint64_t texels = lay_out(texture);
    uint64_t bytes = texels * texture->faces * format_texel_bytes(texture->format);
    if (bytes > STORAGE_MAXIMUM) {
        error_set(error, "texture of %" PRIu64 " bytes when decoded: expected at most %" PRIu64, bytes,
                  STORAGE_MAXIMUM);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    texture->face_texels = (uint32_t)texels;
    return TRIPTYCH_OK;
}

enum triptych_result texture_create(const struct triptych_texture_description *description,
                                    struct triptych_texture **texture, struct error *error)
{
    *texture = NULL;
    struct triptych_texture *made = extent_allocate(sizeof *made);
    if (!made) {
        error_set(error, "out of memory for a texture");
        return TRIPTYCH_NO_MEMORY;
    }
    enum triptych_result result = texture_describe(description, made, error);
    if (result == TRIPTYCH_OK)
        result = allocate(made, error);
    if (result == TRIPTYCH_OK)
        *texture = made;
    else
        extent_free(made);
    return result;
}

void texture_destroy(struct triptych_texture *texture)
{
    extent_free(texture->texels);
    free(texture->blocks);
    extent_free(texture);
}

/* --- Moving --- */

struct texture_span texture_level_span(const struct triptych_texture *texture, unsigned face, unsigned level)
{
    const struct texture_level *l = &texture->level[level];
    size_t size = format_texel_bytes(texture->format);
    size_t begin = ((size_t)face * texture->face_texels + (size_t)l->offset) * size;
    return (struct texture_span){begin, begin + (size_t)l->slice_texels * (size_t)l->depth * size};
}

struct texture_span texture_mip_span(const struct triptych_texture *texture)
{
    size_t end = texture_storage_bytes(texture);
    bool any = texture->faces == 1 && texture->levels > 1;
    return (struct texture_span){any ? texture_level_span(texture, 0, 1).begin : end, end};
}

void *texture_move(struct triptych_texture *texture, void *texels, struct texture_span lost)
{
    uint32_t *old = texture->texels;
    memcpy(texels, old, lost.begin);
    memcpy((uint8_t *)texels + lost.end, (const uint8_t *)old + lost.end,
           texture_storage_bytes(texture) - lost.end);
    texture->texels = texels;
    return old;
}

/* --- Changing --- */

size_t texture_row_bytes(const struct format *format, uint32_t width)
{
    return format_blocks(format, width) * format->bytes;
}

size_t texture_level_bytes(const struct triptych_texture *texture, unsigned level)
{
    const struct texture_level *l = &texture->level[level];
    return texture_row_bytes(texture->format, (uint32_t)l->width) *
           format_blocks(texture->format, (uint32_t)l->height) * (size_t)l->depth;
}

size_t texture_storage_bytes(const struct triptych_texture *texture)
{
    return (size_t)texture->face_texels * texture->faces * format_texel_bytes(texture->format);
}

struct triptych_box texture_whole_level(const struct triptych_texture *texture, unsigned level)
{
    const struct texture_level *l = &texture->level[level];
    return (struct triptych_box){
        .width = (unsigned)l->width, .height = (unsigned)l->height, .depth = (unsigned)l->depth};
}

/* Returns true if first to first + count - 1 is a part of 0 to size - 1 that begins with a block and ends
 * with a block or with the level. */
static bool is_part(unsigned first, unsigned count, int32_t size, unsigned side)
{
    unsigned whole = (unsigned)size;
    return count && first < whole && count <= whole - first && !(first % side) &&
           (!(count % side) || first + count == whole);
}

static enum triptych_result check_box(const struct triptych_texture *texture, unsigned level,
                                      const struct triptych_box *box, struct error *error)
{
    const struct texture_level *l = &texture->level[level];
    unsigned side = texture->format->side;
    if (is_part(box->x, box->width, l->width, side) && is_part(box->y, box->height, l->height, side) &&
        is_part(box->z, box->depth, l->depth, 1))
        return TRIPTYCH_OK;
    error_set(error, "box of %u x %u x %u texels at %u, %u, %u: expected a part of level %u's %d x %d x %d%s",
              box->width, box->height, box->depth, box->x, box->y, box->z, level, l->width, l->height,
              l->depth, side > 1 ? ", of whole 4x4 blocks" : "");
    return TRIPTYCH_BAD_ARGUMENT;
}

enum triptych_result texture_check_update(const struct triptych_texture *texture, unsigned face,
                                          unsigned level, const struct triptych_box *box, size_t row_pitch,
                                          size_t slice_pitch, struct error *error)
{
    if (face >= texture->faces || level >= texture->levels) {
        error_set(error, "face %u, level %u: expected 0 to %u, 0 to %u", face, level, texture->faces - 1,
                  texture->levels - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    struct triptych_box whole = texture_whole_level(texture, level);
    box = box ? box : &whole;
    enum triptych_result result = check_box(texture, level, box, error);
    if (result != TRIPTYCH_OK)
        return result;
    size_t row = texture_row_bytes(texture->format, box->width);
    size_t rows = format_blocks(texture->format, box->height);
    if (row_pitch < row || (box->depth > 1 && slice_pitch / row_pitch < rows)) {
        error_set(error,
                  "pitches of %zu and %zu bytes: expected at least %zu for a row and %zu rows for a slice",
                  row_pitch, slice_pitch, row, rows);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return TRIPTYCH_OK;
}

void texture_update(struct triptych_texture *texture, unsigned face, unsigned level,
                    const struct triptych_box *box, const void *data, size_t row_pitch, size_t slice_pitch)
{
    const struct texture_level *l = &texture->level[level];
    struct triptych_box whole = texture_whole_level(texture, level);
    box = box ? box : &whole;
    uint8_t *texels = texture_level_texels(texture, face, level);
    size_t stride = (size_t)l->pitch, size = format_texel_bytes(texture->format);
    for (unsigned z = 0; z < box->depth; z++) {
        size_t first = ((size_t)(box->z + z) * (size_t)l->height + box->y) * stride;
        format_decode(texture->format, (const uint8_t *)data + z * slice_pitch, row_pitch, box->width,
                      box->height, texels + (first + box->x) * size, stride);
        texture_close_rows(texture, l, texels + first * size, box->height);
    }
    texture_blocks_update(texture, face, level, box, data, row_pitch, slice_pitch);
}

void texture_close_rows(const struct triptych_texture *texture, const struct texture_level *level,
                        void *texels, size_t rows)
{
    size_t size = format_texel_bytes(texture->format);
    uint8_t *first = texels;
    for (size_t y = 0; y < rows; y++, first += (size_t)level->pitch * size)
        memcpy(first + (size_t)level->width * size, first, size);
}

/* --- As a whole --- */

size_t texture_level_count(const struct texture_level *level)
{
    return (size_t)level->width * (size_t)level->height * (size_t)level->depth;
}

size_t texture_texel_bytes(const struct triptych_texture *texture)
{
    size_t texels = 0;
    for (unsigned level = 0; level < texture->levels; level++)
        texels += texture_level_count(texture->level + level);
    return texels * texture->faces * format_texel_bytes(texture->format);
}

/* Goes over all rows, in order: what a copy without gaps consists of. */
struct row {
    const struct texture_level *level;
    uint8_t *texels;
    size_t bytes;
};

typedef void row_visitor(const struct triptych_texture *texture, const struct row *row, void *user);

static void visit_rows(const struct triptych_texture *texture, row_visitor *visit, void *user)
{
    size_t size = format_texel_bytes(texture->format);
    for (unsigned face = 0; face < texture->faces; face++)
        for (unsigned i = 0; i < texture->levels; i++) {
            const struct texture_level *level = texture->level + i;
            struct row row = {level, texture_level_texels(texture, face, i), (size_t)level->width * size};
            for (int y = 0; y < level->height * level->depth; y++, row.texels += (size_t)level->pitch * size)
                visit(texture, &row, user);
        }
}

static void read_row(const struct triptych_texture *texture, const struct row *row, void *user)
{
    uint8_t **data = user;
    (void)texture;
    memcpy(*data, row->texels, row->bytes);
    *data += row->bytes;
}

static void write_row(const struct triptych_texture *texture, const struct row *row, void *user)
{
    const uint8_t **data = user;
    memcpy(row->texels, *data, row->bytes);
    texture_close_rows(texture, row->level, row->texels, 1);
    *data += row->bytes;
}

void texture_read_texels(const struct triptych_texture *texture, void *data)
{
    uint8_t *at = data;
    visit_rows(texture, read_row, &at);
}

void texture_write_texels(struct triptych_texture *texture, const void *data)
{
    const uint8_t *at = data;
    visit_rows(texture, write_row, &at);
    texture_blocks_all_stale(texture, 0);
}
