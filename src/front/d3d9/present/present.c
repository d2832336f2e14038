/* Presenting: the pixels of a back buffer for the Windows side. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/resource/renderer.h"
#include "swapchain.h"
#include <stdlib.h>
#include <string.h>

enum { PRESENT_DO_NOT_FLIP = 4 };

/* Replaces the channels of X8R8G8B8 words by those of the ramp. */
static void apply_gamma(const struct d3d9_gamma_ramp *ramp, const struct d3d9_host_picture *picture)
{
    for (uint32_t y = 0; y < picture->height; y++) {
        uint32_t *row = (uint32_t *)((uintptr_t)picture->bits + (size_t)y * picture->pitch);
        for (uint32_t x = 0; x < picture->width; x++)
            row[x] = (uint32_t)(ramp->red[row[x] >> 16 & 255] >> 8) << 16 |
                     (uint32_t)(ramp->green[row[x] >> 8 & 255] >> 8) << 8 | ramp->blue[row[x] & 255] >> 8;
    }
}

static bool gamma_is_identity(const struct d3d9_gamma_ramp *ramp)
{
    for (int i = 0; i < 256; i++)
        if (ramp->red[i] >> 8 != i || ramp->green[i] >> 8 != i || ramp->blue[i] >> 8 != i)
            return false;
    return true;
}

static int32_t fill(struct d3d9_swapchain *chain, struct d3d9_host_picture *picture)
{
    const struct d3d9_image *image = &chain->buffer[chain->presented]->image;
    const struct d3d9_gamma_ramp *ramp = &chain->device->presentation.gamma;
    const struct triptych_rectangle all = {0, 0, image->width, image->height};
    int32_t result = d3d9_renderer_read(chain->device->renderer, &image->surface,
                                        d3d9_format_find(TRIPTYCH_SURFACE_X8R8G8B8), &all,
                                        (void *)(uintptr_t)picture->bits, picture->pitch);
    if (result < 0)
        return result;
    if (!chain->parameters.windowed && !gamma_is_identity(ramp))
        apply_gamma(ramp, picture);
    picture->filled = 1;
    return D3D9_OK;
}

int32_t d3d9_swapchain_read_picture(struct d3d9_swapchain *chain, struct d3d9_host_picture *picture)
{
    if (!chain->buffer[chain->presented])
        return D3D9_DEVICE_LOST;
    const struct d3d9_image *image = &chain->buffer[chain->presented]->image;
    picture->filled = 0;
    picture->width = image->width;
    picture->height = image->height;
    if (!picture->bits || picture->room_width < image->width || picture->room_height < image->height)
        return D3D9_OK;
    return fill(chain, picture);
}

/* With several back buffers that are flipped, each gets the contents of the next one. */
static void flip(struct d3d9_swapchain *chain)
{
    uint32_t count = chain->parameters.back_buffer_count;
    chain->presented = 0;
    if (count < 2 || !chain->buffer[0] || chain->parameters.swap_effect == D3D9_SWAP_COPY)
        return;
    struct triptych_surface first = chain->buffer[0]->image.surface;
    for (uint32_t i = 0; i + 1 < count; i++)
        chain->buffer[i]->image.surface = chain->buffer[i + 1]->image.surface;
    chain->buffer[count - 1]->image.surface = first;
    chain->presented = count - 1;
    chain->device->late |= D3D9_LATE_TARGETS;
}

static void describe(const struct d3d9_swapchain *chain, uint64_t window, struct d3d9_host_picture *picture)
{
    const struct d3d9_present_parameters *p = &chain->parameters;
    picture->swapchain = (uintptr_t)chain;
    picture->window = window ? window : p->device_window;
    picture->swap_effect = p->swap_effect;
    picture->interval = p->presentation_interval;
    picture->windowed = p->windowed != 0;
    picture->filled = 0;
    picture->shown = 0;
}

int32_t d3d9_swapchain_present(struct d3d9_swapchain *chain, const struct d3d9_rect *source,
                               const struct d3d9_rect *destination, uint64_t window,
                               const struct d3d9_region *dirty, uint32_t flags,
                               struct d3d9_host_picture *picture)
{
    (void)source, (void)destination, (void)dirty;
    struct d3d9_device *device = chain->device;
    const struct d3d9_presentation *state = &device->presentation;
    describe(chain, window, picture);
    if (!device->extended && (state->lost || state->not_reset))
        return D3D9_DEVICE_LOST;
    if (device->extended && state->inactive && !chain->parameters.windowed)
        return D3D9_PRESENT_OCCLUDED;
    chain->present_count++;
    if (!(flags & PRESENT_DO_NOT_FLIP))
        flip(chain);
    int32_t result = d3d9_swapchain_read_picture(chain, picture);
    picture->shown = result >= 0 && !(flags & PRESENT_DO_NOT_FLIP);
    enum triptych_result ended = triptych_end_frame(device->renderer);
    front_statistics_frame(&device->statistics, device->renderer);
    return result < 0 ? result : d3d9_renderer_result(ended);
}

int32_t d3d9_device_present(struct d3d9_device *device, const struct d3d9_rect *source,
                            const struct d3d9_rect *destination, uint64_t window,
                            const struct d3d9_region *dirty, struct d3d9_host_picture *picture)
{
    return d3d9_swapchain_present(device->presentation.chain, source, destination, window, dirty, 0, picture);
}

int32_t d3d9_device_present_ex(struct d3d9_device *device, const struct d3d9_rect *source,
                               const struct d3d9_rect *destination, uint64_t window,
                               const struct d3d9_region *dirty, uint32_t flags,
                               struct d3d9_host_picture *picture)
{
    return d3d9_swapchain_present(device->presentation.chain, source, destination, window, dirty, flags,
                                  picture);
}

/* Copies what was presented last to the corner of a surface of the system pool. In a window Direct3D copies
 * the screen around it too, which the Linux side does not have. */
int32_t d3d9_swapchain_get_front_buffer_data(struct d3d9_swapchain *chain, struct d3d9_surface *destination)
{
    if (!destination || destination->resource.pool == D3D9_POOL_DEFAULT)
        return D3D9_INVALID_CALL;
    if (!chain->buffer[chain->presented])
        return D3D9_DEVICE_LOST;
    const struct d3d9_image *from = &chain->buffer[chain->presented]->image;
    struct d3d9_image *to = &destination->image;
    if (to->format->number != TRIPTYCH_SURFACE_A8R8G8B8 || to->locked)
        return D3D9_INVALID_CALL;
    const struct triptych_rectangle part = {0, 0, from->width < to->width ? from->width : to->width,
                                            from->height < to->height ? from->height : to->height};
    if (!d3d9_image_allocate(to))
        return D3D9_OUT_OF_MEMORY;
    int32_t result = d3d9_renderer_read(chain->device->renderer, &from->surface, to->format, &part,
                                        to->memory, to->row_bytes);
    to->stale = true;
    d3d9_image_add_dirty(to, NULL);
    return result;
}
