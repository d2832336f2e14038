#include "image.h"

/* Formats whose pitch has no relation to their blocks. */
static bool has_texel_pitch(const struct d3d9_format *format)
{
    return format->number == TRIPTYCH_SURFACE_ATI1 || format->number == TRIPTYCH_SURFACE_ATI2;
}

void d3d9_image_begin(struct d3d9_image *image, struct d3d9_device *device, const struct d3d9_format *format,
                      uint32_t width, uint32_t height, uint32_t depth)
{
    enum { ALIGNMENT = 4 };
    uint32_t rows = d3d9_format_rows(format, height);
    image->device = device;
    image->format = format;
    image->width = width;
    image->height = height;
    image->depth = depth;
    image->samples = 1;
    image->row_bytes = (d3d9_format_row_bytes(format, width) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    image->slice_bytes = image->row_bytes * rows;
    image->pitch = image->row_bytes;
    if (has_texel_pitch(format)) {
        uint32_t row = (image->slice_bytes + height - 1) / height;
        if (row < width)
            row = width;
        image->pitch = (row + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
        image->slice_bytes = image->pitch * height;
    }
}

size_t d3d9_image_bytes(const struct d3d9_image *image)
{
    return (size_t)image->slice_bytes * image->depth;
}

void d3d9_image_borrow(struct d3d9_image *image, void *memory)
{
    image->row_bytes = d3d9_format_row_bytes(image->format, image->width);
    image->pitch = image->row_bytes;
    image->slice_bytes = image->row_bytes * d3d9_format_rows(image->format, image->height);
    image->memory = memory;
    image->borrowed = true;
}

void d3d9_image_end(struct d3d9_image *image)
{
    if (!image->borrowed)
        d3d9_memory_free(image->memory);
    image->memory = NULL;
}

bool d3d9_image_allocate(struct d3d9_image *image)
{
    if (!image->memory)
        image->memory = d3d9_memory_allocate(d3d9_image_bytes(image));
    return image->memory;
}

struct triptych_box d3d9_image_box(const struct d3d9_image *image)
{
    return (struct triptych_box){0, 0, 0, image->width, image->height, image->depth};
}

uint8_t *d3d9_image_at(const struct d3d9_image *image, uint32_t x, uint32_t y, uint32_t z)
{
    const struct d3d9_format *format = image->format;
    return image->memory + (size_t)z * image->slice_bytes + (size_t)(y / format->side) * image->row_bytes +
           (size_t)(x / format->across) * format->bytes;
}

static bool part_fits(uint32_t first, uint32_t end, uint32_t size, uint32_t side)
{
    return first < end && end <= size && first % side == 0 && (end % side == 0 || end == size);
}

bool d3d9_image_box_fits(const struct d3d9_image *image, const struct d3d9_box *box)
{
    uint32_t side = image->format->side;
    return part_fits(box->left, box->right, image->width, image->format->across) &&
           part_fits(box->top, box->bottom, image->height, side) &&
           part_fits(box->front, box->back, image->depth, 1);
}

/* The part of a lock's box that is inside the image; the whole image if there is none. Coordinates of
 * rectangles are signed. */
static struct triptych_box inside(const struct d3d9_image *image, const struct d3d9_box *box)
{
    struct triptych_box whole = d3d9_image_box(image);
    int64_t left = (int32_t)box->left, top = (int32_t)box->top, right = (int32_t)box->right;
    int64_t bottom = (int32_t)box->bottom, side = image->format->side, across = image->format->across;
    if (left < 0 || top < 0 || right > image->width || bottom > image->height || left >= right ||
        top >= bottom || left % across || top % side)
        return whole;
    return (struct triptych_box){left, top, box->front, right - left, bottom - top, box->back - box->front};
}

/* The first texel of a rectangle, which may be outside of the image. Direct3D computes it as if ATI1 and ATI2
 * had a byte for each texel. */
static uint8_t *first_texel(const struct d3d9_image *image, const struct d3d9_box *box)
{
    int64_t x = (int32_t)box->left / image->format->across, y = (int32_t)box->top / image->format->side;
    if (has_texel_pitch(image->format))
        return image->memory + (int64_t)box->front * image->slice_bytes +
               (int64_t)(int32_t)box->top * image->pitch + (int32_t)box->left;
    return image->memory + (int64_t)box->front * image->slice_bytes + y * image->row_bytes +
           x * image->format->bytes;
}

static int32_t fetch(struct d3d9_image *image, uint32_t flags)
{
    if (!d3d9_image_allocate(image))
        return D3D9_OUT_OF_MEMORY;
    if (image->home == D3D9_HOME_MEMORY || flags & D3D9_LOCK_DISCARD)
        return D3D9_OK;
    return d3d9_image_download(image, image);
}

int32_t d3d9_image_lock(struct d3d9_image *image, const struct d3d9_box *box, enum d3d9_box_check check,
                        uint32_t flags, void **bits)
{
    const struct d3d9_box whole = {0, 0, image->width, image->height, 0, image->depth};
    if (image->locked || image->use->context)
        return D3D9_INVALID_CALL;
    if (box && check == D3D9_BOX_STRICT && !d3d9_image_box_fits(image, box))
        return D3D9_INVALID_CALL;
    int32_t result = fetch(image, flags);
    if (result < 0)
        return result;
    image->locked = true;
    image->use->locks++;
    image->lock_flags = flags;
    image->locked_box = inside(image, box ? box : &whole);
    *bits = first_texel(image, box ? box : &whole);
    return D3D9_OK;
}

static int32_t store(struct d3d9_image *image)
{
    int32_t result = D3D9_OK;
    if (!(image->lock_flags & D3D9_LOCK_READ_ONLY)) {
        const struct triptych_box *box = &image->locked_box;
        result = d3d9_image_upload_box(image, box->x, box->y, box->z, image, box);
    }
    if (!image->borrowed)
        d3d9_memory_free(image->memory);
    if (!image->borrowed)
        image->memory = NULL;
    return result;
}

static int32_t finish(struct d3d9_image *image)
{
    image->locked = false;
    image->use->locks--;
    image->stale = true;
    if (image->home == D3D9_HOME_RENDERER)
        return store(image);
    if (!(image->lock_flags & (D3D9_LOCK_READ_ONLY | D3D9_LOCK_NO_DIRTY_UPDATE)))
        d3d9_image_add_dirty(image, &image->locked_box);
    return D3D9_OK;
}

int32_t d3d9_image_unlock(struct d3d9_image *image)
{
    if (image->use->context)
        return D3D9_OK;
    return image->locked ? finish(image) : D3D9_INVALID_CALL;
}

int32_t d3d9_image_begin_context(struct d3d9_image *image, void **bits)
{
    if (image->use->context || image->use->locks)
        return D3D9_INVALID_CALL;
    int32_t result = d3d9_image_lock(image, NULL, D3D9_BOX_ANY, 0, bits);
    if (result >= 0)
        image->use->context = image;
    return result;
}

int32_t d3d9_image_end_context(struct d3d9_image *image)
{
    if (image->use->context != image)
        return D3D9_INVALID_CALL;
    image->use->context = NULL;
    return finish(image);
}

/* The least interval that has both. An interval is a first element and a length. */
static void join(unsigned *first, unsigned *length, unsigned with, unsigned with_length)
{
    unsigned end = *first + *length, with_end = with + with_length;
    unsigned low = *first < with ? *first : with, high = end > with_end ? end : with_end;
    *first = low;
    *length = high - low;
}

static bool clip(unsigned *first, unsigned *length, unsigned size)
{
    if (*first >= size)
        return false;
    if (*length > size - *first)
        *length = size - *first;
    return *length;
}

/* Extends an interval to whole blocks. */
static void align(unsigned *first, unsigned *length, unsigned size, unsigned side)
{
    unsigned end = (*first + *length + side - 1) / side * side;
    *first = *first / side * side;
    *length = (end < size ? end : size) - *first;
}

void d3d9_image_add_dirty(struct d3d9_image *image, const struct triptych_box *with)
{
    struct triptych_box box = with ? *with : d3d9_image_box(image), *dirty = &image->dirty;
    unsigned side = image->format->side;
    if (!clip(&box.x, &box.width, image->width) || !clip(&box.y, &box.height, image->height) ||
        !clip(&box.z, &box.depth, image->depth))
        return;
    align(&box.x, &box.width, image->width, image->format->across);
    align(&box.y, &box.height, image->height, side);
    if (!dirty->width) {
        *dirty = box;
        return;
    }
    join(&dirty->x, &dirty->width, box.x, box.width);
    join(&dirty->y, &dirty->height, box.y, box.height);
    join(&dirty->z, &dirty->depth, box.z, box.depth);
}
