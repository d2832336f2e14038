#include "tests/support/picture/varied.h"

#include <string.h>
#include <unity.h>

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

struct vertex {
    float position[4];
    uint32_t color;
};

static void bind(triptych_device *device, triptych_buffer *buffer)
{
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof(struct vertex)};
    struct triptych_element color = {TRIPTYCH_FORMAT_COLOR, buffer, offsetof(struct vertex, color),
                                     sizeof(struct vertex)};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &color));
}

void varied_begin(triptych_device *device)
{
    static const struct vertex vertex[3] = {{{-0.9f, 0.8f, 0.2f, 1}, 0x40ff8020},
                                            {{0.9f, 0.9f, 0.9f, 1}, 0xa020ff40},
                                            {{0.1f, -0.9f, 0.4f, 1}, 0xff6010ff}};
    static const float gray[4] = {0.4f, 0.6f, 0.3f, 0.7f};
    triptych_buffer *buffer;
    OK(triptych_set_target(device, VARIED_SIZE, VARIED_SIZE));
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHATESTENABLE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, 0x80));
    OK(triptych_clear(device, gray, 0.5f));
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    bind(device, buffer);
}

/* State 0 and the states next to it cover pixels. */
void varied_draw(triptych_device *device, unsigned n)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, 1 + (n + 4) % 9));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, 1 + (n / 9 + 5) % 9));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAFUNC, 1 + (n / 81 + 4) % 8));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZFUNC, 1 + (n / 648 + 3) % 8));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
}

void varied_read(triptych_device *device, struct varied_image *image)
{
    OK(triptych_read_color(device, image->color, sizeof image->color));
    OK(triptych_read_depth(device, image->depth, sizeof image->depth));
}

void varied_render(const struct engine *engine, const struct device_options *options, unsigned n,
                   unsigned count, struct varied_image *image)
{
    triptych_device *device;
    struct error error = {{0}};
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, device_create(engine, options, &device, &error), error.text);
    varied_begin(device);
    while (count--)
        varied_draw(device, n++);
    varied_read(device, image);
    triptych_device_destroy(device);
}
