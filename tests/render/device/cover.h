/* Triangles that cover all pixels of the screen, from buffers or from memory, and refusals. */
#ifndef TESTS_RENDER_DEVICE_COVER_H
#define TESTS_RENDER_DEVICE_COVER_H

#include "tests/render/device/screen.h"

#include <string.h>

static const struct triptych_declaration_element elements[] = {
    {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
    {0, 16, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0}};

/* Binds vertices as stream 0 of a declaration. */
static inline void declare(triptych_buffer *buffer)
{
    OK(triptych_set_declaration(device, elements, 2));
    OK(triptych_set_stream(device, 0, buffer, 0, sizeof(struct vertex)));
}

/* A triangle that covers all pixels. */
static inline void make_cover(struct vertex vertex[3], uint32_t color)
{
    vertex[0] = at(0, 0, 0, color);
    vertex[1] = at(2 * SIZE, 0, 0, color);
    vertex[2] = at(0, 2 * SIZE, 0, color);
}

static inline triptych_buffer *cover(uint32_t color)
{
    struct vertex vertex[3];
    make_cover(vertex, color);
    return buffer_of(vertex, sizeof vertex);
}

static inline void expect_all(uint32_t color)
{
    read_image();
    TEST_ASSERT_EQUAL_UINT32(SIZE * SIZE, count_color(color));
}

#define REFUSED(expected, call)                                                                              \
    do {                                                                                                     \
        TEST_ASSERT_TRUE(TRIPTYCH_OK != (call));                                                             \
        TEST_ASSERT_EQUAL_STRING(expected, triptych_error(device));                                          \
    } while (0)

#endif
