/* Pixels of the device's surfaces: rectangles in memory, copies, fills (render/device/attach.c draws to
 * surfaces).
 *
 * What is recorded is rendered first. The pixels are then found where they are newest, in tiles or as texels
 * (render/target/surface.h), and read or written there, by several threads. */
#include "machine/mxcsr.h"
#include "render/device/device_part.h"
#include "render/target/resolve.h"

#include <inttypes.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* --- Opening surfaces --- */

static void describe_main(struct triptych_device *device, struct triptych_target_description *target)
{
    target_describe(device->binding.main, target);
}

static struct attachment *main_attachment(const struct triptych_device *device,
                                          const struct triptych_surface *surface)
{
    return device->binding.main->colors[surface->slice].attachment;
}

/* The tiles of a texture's surface if they have its newest pixels. Only tiles have stencil, so depth is
 * always written there, and read there if there are any. */
static enum triptych_result find_tiles(struct triptych_device *device, const struct triptych_surface *surface,
                                       const struct surface_form *form, bool writes,
                                       struct attachment **tiles, struct error *error)
{
    bool makes = writes && !form->format;
    struct attachment *a = makes ? surface_make_attachment(surface, error) : surface_attachment(surface);
    *tiles = a && (a->tiles_newer || !form->format) ? a : NULL;
    if (makes && !a)
        return TRIPTYCH_NO_MEMORY;
    if (!*tiles)
        return TRIPTYCH_OK;
    struct pixels pixels = surface_pixels(surface, form, a);
    pixels.quad_rows = device->resources.quad_rows;
    if (pixels_prepare(&pixels, error))
        return TRIPTYCH_NO_MEMORY;
    if (a->texels_newer)
        device_load_surface(device, surface);
    return TRIPTYCH_OK;
}

/* Renders the queue, and finds the pixels of a surface. */
static enum triptych_result open_surface(struct triptych_device *device,
                                         const struct triptych_surface *surface,
                                         const struct surface_form *form, bool writes, struct pixels *pixels,
                                         struct error *error)
{
    struct attachment *tiles = NULL;
    enum triptych_result result = TRIPTYCH_OK;
    device_finish(device);
    if (surface->texture)
        result = find_tiles(device, surface, form, writes, &tiles, error);
    else
        tiles = surface->image ? surface->image->attachment : main_attachment(device, surface);
    if (result != TRIPTYCH_OK)
        return result;
    *pixels = surface_pixels(surface, form, tiles);
    pixels->quad_rows = device->resources.quad_rows;
    return writes && pixels_prepare(pixels, error) ? TRIPTYCH_NO_MEMORY : TRIPTYCH_OK;
}

/* After pixels of a surface have been written. */
static void close_surface(struct triptych_device *device, const struct triptych_surface *surface,
                          const struct pixels *pixels, const struct triptych_rectangle *part)
{
    if (!surface->texture)
        return;
    if (!pixels->tiles)
        surface_close_texels(surface, part);
    device_note_written(device, surface, pixels->tiles != NULL);
}

/* --- Work on parts --- */

enum { PIXELS_ALONE = 1 << 14 }; /* at most this number is not worth another thread */

typedef void part_function(const void *user, uint32_t part);

struct part_work {
    part_function *function;
    const void *user;
    uint32_t count;
    _Atomic uint32_t next;
};

static void part_task(void *user, unsigned worker)
{
    struct part_work *work = user;
    uint32_t part;
    (void)worker;
    while ((part = atomic_fetch_add(&work->next, 1)) < work->count)
        work->function(work->user, part);
}

static void run_parts(struct triptych_device *device, const struct triptych_rectangle *rectangle,
                      part_function *function, const void *user)
{
    struct part_work work = {function, user, pixels_parts(rectangle), 0};
    bool alone = (uint64_t)rectangle->width * rectangle->height <= PIXELS_ALONE;
    pool_run(device->pool, 0, alone ? 1 : work.count, alone ? POOL_ALONE : POOL_ALL, part_task, &work);
}

static void read_part(const void *memory, uint32_t part)
{
    pixels_read_part(memory, part);
}

static void write_part(const void *memory, uint32_t part)
{
    pixels_write_part(memory, part);
}

static void copy_part(const void *copy, uint32_t part)
{
    pixels_copy_part(copy, part);
}

/* --- Samples --- */

struct resolving {
    const struct routine *resolve;
    struct pixels from, to;
    struct triptych_rectangle part;
};

static void resolve_part(const void *user, uint32_t i)
{
    const struct resolving *resolving = user;
    struct triptych_rectangle part = pixels_part(&resolving->part, i);
    uint32_t tile = part.y / TILE_SIZE * resolving->from.tiles->columns + part.x / TILE_SIZE;
    pixels_resolve_tile(resolving->resolve, &resolving->from, &resolving->to, tile);
}

static enum triptych_result make_resolved(const struct pixels *from, struct pixels *to, struct error *error)
{
    *to = *from;
    to->quad_rows = false;
    to->tiles = attachment_create_color(from->format, from->width, from->height, 1, error);
    if (to->tiles && !pixels_prepare(to, error))
        return TRIPTYCH_OK;
    attachment_release(to->tiles);
    return TRIPTYCH_NO_MEMORY;
}

/* Opened pixels of a colour with several samples become others, which have their averages in a part. These
 * are kept in *resolved, to be released. */
static enum triptych_result resolve(struct triptych_device *device, const struct triptych_rectangle *part,
                                    struct pixels *pixels, struct attachment **resolved, struct error *error)
{
    struct resolving resolving = {.from = *pixels, .part = *part};
    const struct attachment *a = pixels->tiles;
    *resolved = NULL;
    if (!a || !a->format || a->samples == 1 || !a->memory)
        return TRIPTYCH_OK;
    errno = 0;
    resolving.resolve = target_acquire_resolve(&device->blits, (enum target_storage)a->format->target,
                                               a->samples, &a->memory->order, error);
    if (!resolving.resolve)
        return device_refusal(TRIPTYCH_ENGINE_FAILED);
    enum triptych_result result = make_resolved(pixels, &resolving.to, error);
    if (result == TRIPTYCH_OK) {
        run_parts(device, part, resolve_part, &resolving);
        *pixels = resolving.to;
        *resolved = resolving.to.tiles;
    }
    blit_release(&device->blits, resolving.resolve);
    return result;
}

/* --- Memory --- */

static enum triptych_result check_memory(struct triptych_device *device,
                                         const struct triptych_surface *surface,
                                         const struct triptych_rectangle *rectangle,
                                         enum triptych_surface_format format, size_t pitch,
                                         struct surface_memory *memory, struct error *error)
{
    struct triptych_target_description target;
    describe_main(device, &target);
    enum triptych_result result = surface_check_memory(surface, rectangle, format, &target, memory, error);
    if (result != TRIPTYCH_OK || pitch >= memory->row_bytes)
        return result;
    error_set(error, "pitch of %zu bytes: expected at least %zu", pitch, memory->row_bytes);
    return TRIPTYCH_BAD_ARGUMENT;
}

static enum triptych_result check_forwards(ptrdiff_t pitch, struct error *error)
{
    if (pitch >= 0)
        return TRIPTYCH_OK;
    error_set(error, "pitch of %td bytes for compressed texels: expected a positive one", pitch);
    return TRIPTYCH_BAD_ARGUMENT;
}

/* The part of a compressed texture, and its face. */
static struct triptych_box box_of(const struct triptych_surface *surface, const struct surface_memory *memory,
                                  unsigned *face)
{
    const struct triptych_rectangle *part = &memory->part;
    bool cube = surface->texture->type == TRIPTYCH_TEXTURE_CUBE;
    *face = cube ? surface->slice : 0;
    return (struct triptych_box){part->x, part->y, cube ? 0 : surface->slice, part->width, part->height, 1};
}

enum triptych_result device_read_rectangle(struct triptych_device *device,
                                           const struct triptych_surface *surface,
                                           const struct triptych_rectangle *rectangle,
                                           enum triptych_surface_format format, void *data, ptrdiff_t pitch,
                                           struct error *error)
{
    struct surface_memory found;
    struct pixels_memory memory;
    struct attachment *resolved;
    unsigned face;
    size_t distance = (size_t)(pitch < 0 ? -pitch : pitch);
    enum triptych_result result = check_memory(device, surface, rectangle, format, distance, &found, error);
    if (result == TRIPTYCH_OK && found.format && found.format->side > 1)
        result = check_forwards(pitch, error);
    if (result == TRIPTYCH_OK && found.format && found.format->side > 1) {
        struct triptych_box box = box_of(surface, &found, &face);
        return device_texture_read(device, surface->texture, face, surface->level, &box, data, distance, 0,
                                   error);
    }
    if (result == TRIPTYCH_OK)
        result = open_surface(device, surface, &found.form, false, &memory.pixels, error);
    if (result == TRIPTYCH_OK)
        result = resolve(device, &found.part, &memory.pixels, &resolved, error);
    if (result != TRIPTYCH_OK)
        return result;
    memory = (struct pixels_memory){memory.pixels, found.part, found.format, data, pitch};
    run_parts(device, &found.part, read_part, &memory);
    attachment_release(resolved);
    return TRIPTYCH_OK;
}

enum triptych_result device_write_rectangle(struct triptych_device *device,
                                            const struct triptych_surface *surface,
                                            const struct triptych_rectangle *rectangle,
                                            enum triptych_surface_format format, const void *data,
                                            size_t pitch, struct surface_memory *found, struct error *error)
{
    struct pixels_memory memory;
    unsigned face;
    enum triptych_result result = check_memory(device, surface, rectangle, format, pitch, found, error);
    if (result == TRIPTYCH_OK && found->format && found->format->side > 1) {
        struct triptych_box box = box_of(surface, found, &face);
        return device_texture_update(device, surface->texture, face, surface->level, &box, data, pitch, 0,
                                     error);
    }
    if (result == TRIPTYCH_OK)
        result = open_surface(device, surface, &found->form, true, &memory.pixels, error);
    if (result != TRIPTYCH_OK)
        return result;
    memory =
        (struct pixels_memory){memory.pixels, found->part, found->format, (uint8_t *)data, (ptrdiff_t)pitch};
    run_parts(device, &found->part, write_part, &memory);
    close_surface(device, surface, &memory.pixels, &found->part);
    return TRIPTYCH_OK;
}

/* --- Fills --- */

struct fill {
    struct pixels pixels;
    struct triptych_rectangle part;
    uint32_t words[4];
};

static void fill_part(const void *user, uint32_t i)
{
    const struct fill *fill = user;
    struct triptych_rectangle part = pixels_part(&fill->part, i);
    pixels_fill(&fill->pixels, &part, fill->words);
}

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
__attribute__((noinline)) static void find_words(const struct format *format, const float color[4],
                                                 uint32_t words[4])
{
    unsigned saved = mxcsr_enter();
    pixels_convert_numbers(format, color, 1, words);
    mxcsr_leave(saved);
}

enum triptych_result device_fill(struct triptych_device *device, const struct triptych_surface *surface,
                                 const struct triptych_rectangle *rectangle, const float color[4],
                                 struct error *error)
{
    struct triptych_target_description target;
    struct surface_memory found;
    struct fill fill;
    describe_main(device, &target);
    enum triptych_result result = surface_check_fill(surface, rectangle, &target, &found, error);
    if (result == TRIPTYCH_OK)
        result = open_surface(device, surface, &found.form, true, &fill.pixels, error);
    if (result != TRIPTYCH_OK)
        return result;
    fill.part = found.part;
    find_words(found.form.format, color, fill.words);
    run_parts(device, &found.part, fill_part, &fill);
    close_surface(device, surface, &fill.pixels, &found.part);
    return TRIPTYCH_OK;
}

/* --- Copies --- */

static bool same_pixels(const struct pixels *a, const struct pixels *b)
{
    return a->tiles ? a->tiles == b->tiles : a->image.texels == b->image.texels;
}

/* A copy of the source's part, for a copy within one surface: tiles or texels, as the surface has them. */
static enum triptych_result separate(struct triptych_device *device, struct pixels_copy *copy,
                                     struct error *error)
{
    const struct triptych_rectangle part = {0, 0, copy->source.width, copy->source.height};
    struct pixels_copy first = {.from = copy->from, .to = copy->from, .source = copy->source, .target = part};
    struct pixels *to = &first.to;
    to->width = part.width;
    to->height = part.height;
    to->image = (struct texture_image){
        .pitch = part.width, .bytes = copy->from.image.bytes, .compact = copy->from.image.compact};
    if (copy->from.tiles && copy->from.format)
        to->tiles = attachment_create_color(copy->from.format, part.width, part.height, 1, error);
    else if (copy->from.tiles)
        to->tiles = attachment_create_depth(copy->from.depth_format, part.width, part.height, 1, error);
    else
        to->image.texels = malloc((size_t)part.width * part.height * to->image.bytes);
    if (!copy->from.tiles && !to->image.texels)
        error_set(error, "out of memory for %" PRIu64 " pixels", (uint64_t)part.width * part.height);
    if ((!to->tiles && !to->image.texels) || pixels_prepare(to, error)) {
        attachment_release(to->tiles);
        return TRIPTYCH_NO_MEMORY;
    }
    run_parts(device, &part, copy_part, &first);
    copy->from = *to;
    copy->source = part;
    return TRIPTYCH_OK;
}

static void drop_separate(const struct pixels *pixels)
{
    attachment_release(pixels->tiles);
    free(pixels->image.texels);
}

/* Finds the pixels of both surfaces; *resolved is to be released. */
static enum triptych_result open_copy(struct triptych_device *device, const struct surface_copy *asked,
                                      struct pixels_copy *copy, struct attachment **resolved,
                                      struct error *error)
{
    struct triptych_target_description target;
    struct surface_copy_plan plan;
    describe_main(device, &target);
    enum triptych_result result = surface_check_copy(asked, &target, &plan, error);
    if (result == TRIPTYCH_OK)
        result = open_surface(device, asked->surface[1], &plan.form[1], true, &copy->to, error);
    if (result == TRIPTYCH_OK)
        result = open_surface(device, asked->surface[0], &plan.form[0], false, &copy->from, error);
    copy->source = plan.part[0];
    copy->target = plan.part[1];
    if (result == TRIPTYCH_OK)
        result = resolve(device, &copy->source, &copy->from, resolved, error);
    return result;
}

static enum triptych_result run_copy(struct triptych_device *device, struct pixels_copy *copy,
                                     struct error *error)
{
    bool within = (copy->from.tiles || copy->from.image.texels) && same_pixels(&copy->from, &copy->to);
    if (within && pixels_move(&copy->to, &copy->source, &copy->target))
        return TRIPTYCH_OK;
    errno = 0;
    if (pixels_acquire_copy(copy, &device->blits, error))
        return device_refusal(TRIPTYCH_ENGINE_FAILED);
    enum triptych_result result = within ? separate(device, copy, error) : TRIPTYCH_OK;
    if (result == TRIPTYCH_OK)
        run_parts(device, &copy->target, copy_part, copy);
    if (result == TRIPTYCH_OK && within)
        drop_separate(&copy->from);
    blit_release(&device->blits, copy->blend);
    return result;
}

enum triptych_result device_copy(struct triptych_device *device, const struct surface_copy *asked,
                                 struct error *error)
{
    struct pixels_copy copy = {.linear = asked->filter == TRIPTYCH_COPY_LINEAR};
    struct attachment *resolved = NULL;
    enum triptych_result result = open_copy(device, asked, &copy, &resolved, error);
    if (result == TRIPTYCH_OK)
        result = run_copy(device, &copy, error);
    attachment_release(resolved);
    if (result == TRIPTYCH_OK)
        close_surface(device, asked->surface[1], &copy.to, &copy.target);
    return result;
}

/* --- Numbers and bytes --- */

/* All pixels of a surface as numbers or as RGBA8; depth is the same number in all channels. */
struct image {
    struct pixels pixels;
    struct triptych_rectangle whole;
    float *numbers;
    uint32_t *rgba;
};

static void read_row(const struct image *image, uint32_t x, uint32_t y, uint32_t count)
{
    const struct pixels *pixels = &image->pixels;
    uint32_t row[4 * PIXELS_ROW], numbers[4 * PIXELS_ROW];
    size_t place = (size_t)y * pixels->width + x;
    pixels_read_row(pixels, x, y, count, row);
    pixels_row_numbers(pixels, row, count, (float *)(void *)numbers);
    if (image->numbers)
        memcpy(image->numbers + 4 * place, numbers, count * sizeof(float[4]));
    for (uint32_t i = 0; i < count && image->rgba; i++)
        image->rgba[place + i] = color_bytes(TARGET_FLOAT, numbers + 4 * i);
}

static void image_part(const void *user, uint32_t i)
{
    const struct image *image = user;
    struct triptych_rectangle part = pixels_part(&image->whole, i);
    for (uint32_t y = part.y; y < part.y + part.height; y++)
        read_row(image, part.x, y, part.width);
}

static enum triptych_result read_image(struct triptych_device *device, const struct triptych_surface *surface,
                                       struct image *image, size_t bytes, struct error *error)
{
    struct triptych_target_description target;
    struct surface_form form;
    struct attachment *resolved;
    describe_main(device, &target);
    enum triptych_result result = surface_find_form(surface, "surface", &target, &form, error);
    if (result != TRIPTYCH_OK)
        return result;
    size_t pixels = (size_t)form.width * form.height;
    image->whole = (struct triptych_rectangle){0, 0, form.width, form.height};
    result = image->numbers ? device_check_room("numbers", bytes, 16 * pixels, error)
                            : device_check_room("colours", bytes, 4 * pixels, error);
    if (result == TRIPTYCH_OK)
        result = open_surface(device, surface, &form, false, &image->pixels, error);
    if (result == TRIPTYCH_OK)
        result = resolve(device, &image->whole, &image->pixels, &resolved, error);
    if (result != TRIPTYCH_OK)
        return result;
    run_parts(device, &image->whole, image_part, image);
    attachment_release(resolved);
    return TRIPTYCH_OK;
}

enum triptych_result device_read_surface_numbers(struct triptych_device *device,
                                                 const struct triptych_surface *surface, float *numbers,
                                                 size_t bytes, struct error *error)
{
    struct image image = {.numbers = numbers};
    return read_image(device, surface, &image, bytes, error);
}

enum triptych_result device_read_surface(struct triptych_device *device,
                                         const struct triptych_surface *surface, uint32_t *rgba, size_t bytes,
                                         struct error *error)
{
    struct image image = {.rgba = rgba};
    return read_image(device, surface, &image, bytes, error);
}
