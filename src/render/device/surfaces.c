/* The device's surfaces: drawing to textures, copies, reading.
 *
 * While textures are drawn to, a target of their own replaces the one that was set, which is parked. Their
 * texels are valid again once the surfaces are stored: when the textures are left, or when texels are read
 * before. */
#include "machine/mxcsr.h"
#include "render/target/copy.h"
#include "render/device/device.h"
#include "render/target/surface.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
__attribute__((noinline)) static void load(struct triptych_device *device)
{
    unsigned saved = mxcsr_enter();
    surfaces_load(&device->binding.textures, &device->binding.target);
    mxcsr_leave(saved);
}

__attribute__((noinline)) static void
write_to_target(struct target *target, unsigned t, const struct triptych_rectangle *part, const float *image)
{
    struct rectangle area = {(int32_t)part->x, (int32_t)part->y, (int32_t)(part->x + part->width),
                             (int32_t)(part->y + part->height)};
    unsigned saved = mxcsr_enter();
    target_write_numbers(target, t, &area, image);
    mxcsr_leave(saved);
}

__attribute__((noinline)) static void write_to_surface(const struct triptych_surface *surface,
                                                       const struct triptych_rectangle *part,
                                                       const float *image)
{
    unsigned saved = mxcsr_enter();
    surface_write_numbers(surface, part, image);
    mxcsr_leave(saved);
}

/* --- Drawing to textures --- */

bool device_draws_to(const struct triptych_device *device, const struct triptych_texture *texture)
{
    return device->binding.draws_to_textures && surfaces_include(&device->binding.textures, texture);
}

void device_store_texture(struct triptych_device *device, const struct triptych_texture *texture)
{
    if (device_uses(device, texture) || device_draws_to(device, texture))
        device_finish(device);
    if (device_draws_to(device, texture))
        surfaces_store(&device->binding.textures, &device->binding.target);
}

void device_load_texture(struct triptych_device *device, const struct triptych_texture *texture)
{
    if (device_draws_to(device, texture))
        load(device);
}

void device_leave_textures(struct triptych_device *device)
{
    if (!device->binding.draws_to_textures)
        return;
    device_finish(device);
    surfaces_store(&device->binding.textures, &device->binding.target);
    target_destroy(&device->binding.target);
    device->binding.target = device->binding.parked;
    device->binding.parked = (struct target){0};
    device->binding.draws_to_textures = false;
}

static void target_changed(struct triptych_device *device)
{
    struct triptych_target_description description;
    target_describe(&device->binding.target, &description);
    state_set_target(&device->state, &description);
    device_state_changed(device, PARTS_ALL);
}

enum triptych_result device_set_target_textures(struct triptych_device *device,
                                                const struct triptych_target_textures *textures,
                                                struct error *error)
{
    struct triptych_target_description description;
    struct target target;
    if (!textures && !device->binding.draws_to_textures)
        return TRIPTYCH_OK;
    if (!textures) {
        device_leave_textures(device);
        target_changed(device);
        return TRIPTYCH_OK;
    }
    enum triptych_result result = surfaces_describe(textures, &description, error);
    if (result == TRIPTYCH_OK)
        result = device_check_target(&description, error);
    if (result != TRIPTYCH_OK)
        return result;
    if (target_create(&target, &description, error))
        return TRIPTYCH_NO_MEMORY;
    device_finish(device);
    device_leave_textures(device);
    device->binding.parked = device->binding.target;
    device->binding.target = target;
    device->binding.textures = *textures;
    device->binding.draws_to_textures = true;
    load(device);
    target_changed(device);
    return TRIPTYCH_OK;
}

/* --- Images of four numbers a pixel --- */

/* A surface of a texture, or a colour of the target. */
struct image {
    const struct triptych_surface *surface;
    uint32_t width, height;
};

static enum triptych_result find_image(struct triptych_device *device, const struct triptych_surface *surface,
                                       struct image *image, struct error *error)
{
    struct triptych_target_description target;
    uint32_t size[2];
    target_describe(device_main_target(device), &target);
    enum triptych_result result = surface_size(surface, "surface", &target, size, error);
    *image = (struct image){surface, size[0], size[1]};
    return result;
}

static void read_image(struct triptych_device *device, const struct image *image, float *numbers)
{
    const struct target *target = device_main_target(device);
    device_finish(device);
    if (image->surface->texture) {
        device_store_texture(device, image->surface->texture);
        surface_read_numbers(image->surface, numbers);
        return;
    }
    for (uint32_t row = 0; row < target->rows; row++)
        target_read_numbers(target, image->surface->slice, SAMPLE_RESOLVED, row, numbers, target->width);
}

static void write_image(struct triptych_device *device, const struct image *image,
                        const struct triptych_rectangle *part, const float *numbers)
{
    if (!image->surface->texture) {
        write_to_target(device_main_target(device), image->surface->slice, part, numbers);
        return;
    }
    device_store_texture(device, image->surface->texture);
    write_to_surface(image->surface, part, numbers);
    device_load_texture(device, image->surface->texture);
}

static float *allocate_numbers(uint64_t pixels, struct error *error)
{
    float *numbers = malloc((size_t)pixels * 4 * sizeof *numbers);
    if (!numbers)
        error_set(error, "out of memory for %" PRIu64 " pixels", pixels);
    return numbers;
}

/* --- Copies and reading --- */

static enum triptych_result copy(struct triptych_device *device, const struct image image[2],
                                 const struct triptych_rectangle part[2], enum triptych_copy_filter filter,
                                 struct error *error)
{
    float *whole = allocate_numbers((uint64_t)image[0].width * image[0].height, error);
    float *rows = whole ? allocate_numbers((uint64_t)part[1].width * part[1].height, error) : NULL;
    if (rows) {
        read_image(device, &image[0], whole);
        copy_scaled(whole, image[0].width, &part[0], &part[1], filter, rows);
        write_image(device, &image[1], &part[1], rows);
    }
    enum triptych_result result = rows ? TRIPTYCH_OK : TRIPTYCH_NO_MEMORY;
    free(whole);
    free(rows);
    return result;
}

enum triptych_result device_copy(struct triptych_device *device, const struct surface_copy *asked,
                                 struct error *error)
{
    struct triptych_target_description target;
    struct triptych_rectangle part[2];
    struct image image[2];
    target_describe(device_main_target(device), &target);
    enum triptych_result result = surface_check_copy(asked, &target, error);
    for (int i = 0; i < 2 && result == TRIPTYCH_OK; i++) {
        result = find_image(device, asked->surface[i], &image[i], error);
        part[i] = asked->part[i];
        if (!part[i].width)
            part[i] = (struct triptych_rectangle){0, 0, image[i].width, image[i].height};
    }
    return result == TRIPTYCH_OK ? copy(device, image, part, asked->filter, error) : result;
}

enum triptych_result device_read_surface_numbers(struct triptych_device *device,
                                                 const struct triptych_surface *surface, float *numbers,
                                                 size_t bytes, struct error *error)
{
    struct image image;
    enum triptych_result result = find_image(device, surface, &image, error);
    if (result == TRIPTYCH_OK)
        result = device_check_room("numbers", bytes, 16 * (size_t)image.width * image.height, error);
    if (result == TRIPTYCH_OK)
        read_image(device, &image, numbers);
    return result;
}

enum triptych_result device_read_surface(struct triptych_device *device,
                                         const struct triptych_surface *surface, uint32_t *rgba, size_t bytes,
                                         struct error *error)
{
    struct image image;
    enum triptych_result result = find_image(device, surface, &image, error);
    if (result == TRIPTYCH_OK)
        result = device_check_room("colours", bytes, 4 * (size_t)image.width * image.height, error);
    if (result != TRIPTYCH_OK)
        return result;
    size_t pixels = (size_t)image.width * image.height;
    float *numbers = allocate_numbers(pixels, error);
    if (!numbers)
        return TRIPTYCH_NO_MEMORY;
    read_image(device, &image, numbers);
    for (size_t i = 0; i < pixels; i++) {
        uint32_t words[4];
        memcpy(words, numbers + 4 * i, sizeof words);
        rgba[i] = color_bytes(TARGET_FLOAT, words);
    }
    free(numbers);
    return TRIPTYCH_OK;
}
