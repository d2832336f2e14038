/* The device's surfaces as images: copies and reading (render/device/attach.c draws to them). */
#include "machine/mxcsr.h"
#include "render/target/copy.h"
#include "render/device/device.h"
#include "render/target/surface.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
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

/* --- Images of four numbers a pixel --- */

/* A surface, or a colour of the target. */
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

/* Reads depth as surfaces of textures have it: the same number in all channels. */
static void read_depth_numbers(const struct target *view, float *numbers)
{
    size_t pixels = (size_t)view->width * view->height;
    float *depth = numbers + 3 * pixels; /* read by the numbers of earlier pixels only */
    for (uint32_t row = 0; row < view->rows; row++)
        target_read_depth(view, SAMPLE_RESOLVED, row, depth);
    for (size_t p = 0; p < pixels; p++) {
        float value = depth[p];
        for (int c = 0; c < 4; c++)
            numbers[4 * p + (size_t)c] = value;
    }
}

static enum triptych_result read_image(struct triptych_device *device, const struct image *image,
                                       float *numbers, struct error *error)
{
    struct target view;
    if (image->surface->texture) {
        device_store_texture(device, image->surface->texture);
        surface_read_numbers(image->surface, numbers);
        return TRIPTYCH_OK;
    }
    enum triptych_result result = device_view(device, image->surface, &view, error);
    if (result != TRIPTYCH_OK)
        return result;
    device_finish(device);
    if (view.depth)
        read_depth_numbers(&view, numbers);
    for (uint32_t row = 0; row < view.rows && !view.depth; row++)
        target_read_numbers(&view, 0, SAMPLE_RESOLVED, row, numbers, view.width);
    target_destroy(&view);
    return TRIPTYCH_OK;
}

static enum triptych_result write_image(struct triptych_device *device, const struct image *image,
                                        const struct triptych_rectangle *part, const float *numbers,
                                        struct error *error)
{
    struct target view;
    if (image->surface->texture) {
        device_store_texture(device, image->surface->texture);
        write_to_surface(image->surface, part, numbers);
        device_load_texture(device, image->surface->texture);
        return TRIPTYCH_OK;
    }
    enum triptych_result result = device_view(device, image->surface, &view, error);
    if (result != TRIPTYCH_OK)
        return result;
    device_finish(device);
    write_to_target(&view, 0, part, numbers);
    target_destroy(&view);
    return TRIPTYCH_OK;
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
    enum triptych_result result = rows ? read_image(device, &image[0], whole, error) : TRIPTYCH_NO_MEMORY;
    if (result == TRIPTYCH_OK) {
        copy_scaled(whole, image[0].width, &part[0], &part[1], filter, rows);
        result = write_image(device, &image[1], &part[1], rows, error);
    }
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
        result = read_image(device, &image, numbers, error);
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
    result = read_image(device, &image, numbers, error);
    for (size_t i = 0; i < pixels && result == TRIPTYCH_OK; i++) {
        uint32_t words[4];
        memcpy(words, numbers + 4 * i, sizeof words);
        rgba[i] = color_bytes(TARGET_FLOAT, words);
    }
    free(numbers);
    return result;
}
