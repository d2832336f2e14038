#include "render/texture/texture.h"

#include "memory/extent.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define STORAGE_MAXIMUM ((uint64_t)1 << 32)

_Static_assert(TRIPTYCH_TEXTURE_MAXIMUM + 16 <= INT16_MAX,
               "rows are multiplied by pitches in 16 bits: dot_i in spec/texture/sample.h");

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

static uint32_t tiles_of(uint32_t size)
{
    return (size + TEXTURE_TILE - 1) / TEXTURE_TILE * TEXTURE_TILE;
}

/* From one row to the next: the row, a copy of its first texel, and in wide textures as many that rows begin
 * at cache lines if a texel has four bytes: then four neighbouring texels are often in one line. */
static uint32_t row_texels(uint32_t width)
{
    enum { WIDE = 128, LINE = 16 };
    uint32_t row = width + 1;
    return width < WIDE ? row : (row + LINE - 1) / LINE * LINE;
}

/* Fills in the levels; returns the texels of a face. */
static uint64_t lay_out(struct triptych_texture *texture)
{
    uint64_t offset = 0;
    for (unsigned i = 0; i < texture->levels; i++) {
        uint32_t width = halved(texture->width, i), height = halved(texture->height, i);
        uint32_t depth = halved(texture->depth, i);
        uint32_t pitch = texture->tiled ? tiles_of(width) : row_texels(width);
        uint32_t slice = pitch * (texture->tiled ? tiles_of(height) : height);
        texture->level[i] = (struct texture_level){
            .offset = (int32_t)offset,
            .width = (int32_t)width,
            .height = (int32_t)height,
            .depth = (int32_t)depth,
            .pitch = (int32_t)pitch,
            .slice_texels = (int32_t)slice,
        };
        offset += (uint64_t)slice * depth;
    }
    return offset;
}

/* Every texel what a block of zeros decodes to. */
static void clear_texels(struct triptych_texture *texture, size_t bytes)
{
    static const uint8_t zeros[16];
    const struct texture_image first = {.texels = (uint8_t *)texture->texels,
                                        .bytes = format_texel_bytes(texture->format),
                                        .compact = texture->format->compact};
    const struct triptych_box one = {.width = 1, .height = 1, .depth = 1};
    size_t size = first.bytes;
    uint8_t *texels = first.texels;
    texture_decode_part(texture->format, zeros, 0, &one, &first);
    for (size_t filled = size; filled < bytes; filled *= 2)
        memcpy(texels + filled, texels, filled < bytes - filled ? filled : bytes - filled);
}

/* Memory for the texels and their margin; null if it is short. */
static void *allocate_texels(const struct triptych_texture *texture)
{
    size_t margin = TEXTURE_MARGIN_ROWS * (size_t)texture->level[0].pitch + TEXTURE_MARGIN_TEXELS;
    return extent_allocate(texture_storage_bytes(texture) + margin * format_texel_bytes(texture->format));
}

static enum triptych_result allocate(struct triptych_texture *texture, struct error *error)
{
    texture->texels = allocate_texels(texture);
    if (!texture->texels || texture_blocks_create(texture)) {
        extent_free(texture->texels);
        error_set(error, "out of memory for a texture of %u x %u texels", texture->width, texture->height);
        return TRIPTYCH_NO_MEMORY;
    }
    clear_texels(texture, texture_storage_bytes(texture));
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
    uint64_t bytes = texels * texture->faces * format_row_bytes(texture->format);
    if (bytes > STORAGE_MAXIMUM) {
        error_set(error, "texture of %" PRIu64 " bytes when decoded: expected at most %" PRIu64, bytes,
                  STORAGE_MAXIMUM);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    texture->face_texels = (uint32_t)texels;
    return TRIPTYCH_OK;
}

void texture_order_tiles(struct triptych_texture *texture)
{
    texture->tiled = true;
    uint64_t texels = lay_out(texture);
    if (texels * texture->faces * format_row_bytes(texture->format) > STORAGE_MAXIMUM) {
        texture->tiled = false;
        texels = lay_out(texture);
    }
    texture->face_texels = (uint32_t)texels;
}

enum triptych_result texture_create(const struct triptych_texture_description *description, bool tiled,
                                    struct triptych_texture **texture, struct error *error)
{
    *texture = NULL;
    struct triptych_texture *made = extent_allocate(sizeof *made);
    if (!made) {
        error_set(error, "out of memory for a texture");
        return TRIPTYCH_NO_MEMORY;
    }
    enum triptych_result result = texture_describe(description, made, error);
    if (result == TRIPTYCH_OK && tiled)
        texture_order_tiles(made);
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
    struct triptych_box whole = texture_whole_level(texture, level);
    box = box ? box : &whole;
    for (unsigned z = 0; z < box->depth; z++) {
        struct texture_image image = texture_slice(texture, face, level, box->z + z);
        texture_decode_part(texture->format, (const uint8_t *)data + z * slice_pitch, row_pitch, box, &image);
        texture_close_rows(texture, face, level, box->z + z, box->y, box->height);
    }
    texture_blocks_update(texture, face, level, box, data, row_pitch, slice_pitch);
}

void texture_close_rows(const struct triptych_texture *texture, unsigned face, unsigned level, unsigned slice,
                        size_t y, size_t rows)
{
    struct texture_image image = texture_slice(texture, face, level, slice);
    size_t width = (size_t)texture->level[level].width * image.bytes;
    uint8_t *first = texture_texel(&image, 0, y);
    for (; rows && !image.tiled; rows--, first += image.pitch * image.bytes)
        memcpy(first + width, first, image.bytes);
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
    return texels * texture->faces * format_row_bytes(texture->format);
}

/* Goes over all rows, in order: what a copy without gaps consists of. */
struct row {
    struct texture_image image;
    unsigned face, level, slice;
    size_t y, texels;
};

typedef void row_visitor(const struct triptych_texture *texture, const struct row *row, void *user);

static void visit_slice(const struct triptych_texture *texture, struct row *row, row_visitor *visit,
                        void *user)
{
    const struct texture_level *level = &texture->level[row->level];
    row->image = texture_slice(texture, row->face, row->level, row->slice);
    row->texels = (size_t)level->width;
    for (row->y = 0; row->y < (size_t)level->height; row->y++)
        visit(texture, row, user);
}

static void visit_rows(const struct triptych_texture *texture, row_visitor *visit, void *user)
{
    struct row row = {.face = 0};
    for (row.face = 0; row.face < texture->faces; row.face++)
        for (row.level = 0; row.level < texture->levels; row.level++)
            for (row.slice = 0; row.slice < (unsigned)texture->level[row.level].depth; row.slice++)
                visit_slice(texture, &row, visit, user);
}

static void read_row(const struct triptych_texture *texture, const struct row *row, void *user)
{
    uint8_t **data = user;
    (void)texture;
    texture_read_row(&row->image, 0, row->y, row->texels, *data);
    *data += row->texels * texture_row_size(&row->image);
}

static void write_row(const struct triptych_texture *texture, const struct row *row, void *user)
{
    const uint8_t **data = user;
    texture_write_row(&row->image, 0, row->y, row->texels, *data);
    texture_close_rows(texture, row->face, row->level, row->slice, row->y, 1);
    *data += row->texels * texture_row_size(&row->image);
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

/* Copies a row to the same texture in another order, by parts. */
static void move_row(const struct triptych_texture *texture, const struct row *row, void *user)
{
    const struct triptych_texture *to = user;
    uint32_t part[4 * 64];
    struct texture_image image = texture_slice(to, row->face, row->level, row->slice);
    (void)texture;
    for (size_t x = 0, count; x < row->texels; x += count) {
        count = row->texels - x < 64 ? row->texels - x : 64;
        texture_read_row(&row->image, x, row->y, count, part);
        texture_write_row(&image, x, row->y, count, part);
    }
    texture_close_rows(to, row->face, row->level, row->slice, row->y, 1);
}

void texture_set_order(struct triptych_texture *texture, bool tiled)
{
    struct triptych_texture to = *texture;
    if (texture->tiled == tiled)
        return;
    to.tiled = false;
    if (tiled)
        texture_order_tiles(&to);
    else
        to.face_texels = (uint32_t)lay_out(&to);
    to.texels = to.tiled == tiled ? allocate_texels(&to) : NULL;
    if (!to.texels)
        return;
    visit_rows(texture, move_row, &to);
    extent_free(texture->texels);
    *texture = to;
}
