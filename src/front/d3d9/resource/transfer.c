/* Texels between memory and the renderer. */
#include "front/d3d9/device.h"
#include "image.h"
#include "renderer.h"
#include <string.h>

int32_t d3d9_image_upload_box(struct d3d9_image *to, uint32_t x, uint32_t y, uint32_t z,
                              const struct d3d9_image *from, const struct triptych_box *box)
{
    triptych_device *renderer = to->device->renderer;
    const uint8_t *data = d3d9_image_at(from, box->x, box->y, box->z);
    const struct triptych_box target = {x, y, z, box->width, box->height, box->depth};
    if (to->is_texture)
        return d3d9_renderer_result(triptych_texture_update(renderer, to->surface.texture, to->face,
                                                            to->surface.level, &target, data, from->row_bytes,
                                                            from->slice_bytes));
    const struct triptych_rectangle part = {x, y, box->width, box->height};
    return d3d9_renderer_write(renderer, &to->surface, to->format, &part, data, from->row_bytes);
}

int32_t d3d9_image_upload(struct d3d9_image *image)
{
    struct triptych_box box = image->dirty;
    if (!box.width || !image->has_surface || !image->memory)
        return D3D9_OK;
    image->dirty.width = 0;
    return d3d9_image_upload_box(image, box.x, box.y, box.z, image, &box);
}

int32_t d3d9_image_download(struct d3d9_image *to, const struct d3d9_image *from)
{
    const struct triptych_rectangle part = {0, 0, from->width, from->height};
    if (!d3d9_image_allocate(to))
        return D3D9_OUT_OF_MEMORY;
    return d3d9_renderer_read(from->device->renderer, &from->surface, from->format, &part, to->memory,
                              to->row_bytes);
}

void d3d9_image_copy(struct d3d9_image *to, uint32_t x, uint32_t y, uint32_t z, const struct d3d9_image *from,
                     const struct triptych_box *box)
{
    uint32_t bytes = d3d9_format_row_bytes(from->format, box->width);
    uint32_t rows = d3d9_format_rows(from->format, box->height);
    for (uint32_t slice = 0; slice < box->depth; slice++) {
        uint8_t *out = d3d9_image_at(to, x, y, z + slice);
        const uint8_t *in = d3d9_image_at(from, box->x, box->y, box->z + slice);
        for (uint32_t row = 0; row < rows; row++)
            memcpy(out + (size_t)row * to->row_bytes, in + (size_t)row * from->row_bytes, bytes);
    }
}
