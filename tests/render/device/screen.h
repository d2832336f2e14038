/* A device with a target of SIZE x SIZE pixels and the emulator, for tests of the whole renderer. The
 * transforms are identities, and lighting and culling are off. */
#ifndef TESTS_RENDER_DEVICE_SCREEN_H
#define TESTS_RENDER_DEVICE_SCREEN_H

#include "emu/emulate/emulate.h"
#include "render/device/device.h"

#include <unity.h>

enum { SIZE = 200 };

static triptych_device *device;
static uint32_t image[SIZE * SIZE];
static float depth[SIZE * SIZE];

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

/* Creates the device with an engine, with the emulator, or with the emulator and default options. */
static inline void open_engine(const struct engine *engine, const struct device_options *options)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(engine, options, &device, NULL));
    OK(triptych_set_target(device, SIZE, SIZE));
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
}

static inline void open_device_with(const struct device_options *options)
{
    open_engine(&engine_emulate, options);
}

static inline void open_device(unsigned threads)
{
    open_device_with(&(struct device_options){.threads = threads});
}

static inline void close_device(void)
{
    triptych_device_destroy(device);
    device = NULL;
}

struct vertex {
    float position[4]; /* clip space: the transforms are identities */
    uint32_t color;    /* 0xAARRGGBB */
};

/* Returns a vertex at a window position in pixels; w is 1. */
static inline struct vertex at(float x, float y, float z, uint32_t color)
{
    return (struct vertex){{2 * x / SIZE - 1, 1 - 2 * y / SIZE, z, 1}, color};
}

static inline triptych_buffer *buffer_of(const void *data, size_t bytes)
{
    triptych_buffer *buffer;
    OK(triptych_buffer_create(device, data, bytes, &buffer));
    return buffer;
}

/* Binds vertices as positions and colours. */
static inline void bind(triptych_buffer *buffer)
{
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof(struct vertex)};
    struct triptych_element color = {TRIPTYCH_FORMAT_COLOR, buffer, 16, sizeof(struct vertex)};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &color));
}

/* Draws a list of triangles. */
static inline void draw_list(const struct vertex *vertex, uint32_t triangles)
{
    bind(buffer_of(vertex, 3 * triangles * sizeof *vertex));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, triangles));
}

/* Draws the pixels x0 <= x < x1, y0 <= y < y1 as two triangles. */
static inline void draw_rectangle(float x0, float y0, float x1, float y1, float z, uint32_t color)
{
    struct vertex vertex[6] = {at(x0, y0, z, color), at(x1, y0, z, color), at(x0, y1, z, color),
                               at(x1, y0, z, color), at(x1, y1, z, color), at(x0, y1, z, color)};
    draw_list(vertex, 2);
}

/* Returns a pixel of the image that was read last. */
static inline uint32_t pixel(int x, int y)
{
    return image[y * SIZE + x];
}

static inline void read_image(void)
{
    OK(triptych_read_color(device, image, sizeof image));
    OK(triptych_read_depth(device, depth, sizeof depth));
}

/* Returns the number of pixels of the image with this colour. */
static inline uint32_t count_color(uint32_t color)
{
    uint32_t count = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        count += image[i] == color;
    return count;
}

/* Colours as images and as vertices have them. */
enum {
    RED = 0xff0000ff,
    GREEN = 0xff00ff00,
    BLUE = 0xffff0000,
    RED_ARGB = 0xffff0000,
    GREEN_ARGB = 0xff00ff00
};

#endif
