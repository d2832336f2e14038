#include "tests/support/picture/shape.h"

#include "base/bits.h"
#include <stddef.h>

float shape_depth[SIZE * SIZE];

static void bind(enum triptych_attribute attribute, enum triptych_format format, triptych_buffer *buffer,
                 size_t offset)
{
    struct triptych_element element = {format, buffer, offset, sizeof(struct shape_vertex)};
    OK(triptych_set_element(device, attribute, &element));
}

static unsigned primitives(enum triptych_primitive primitive, unsigned vertices)
{
    switch (primitive) {
    case TRIPTYCH_POINT_LIST: return vertices;
    case TRIPTYCH_LINE_LIST: return vertices / 2;
    case TRIPTYCH_LINE_STRIP: return vertices - 1;
    case TRIPTYCH_TRIANGLE_LIST: return vertices / 3;
    case TRIPTYCH_QUAD_LIST: return vertices / 4;
    case TRIPTYCH_QUAD_STRIP: return vertices / 2 - 1;
    default: return vertices - 2;
    }
}

void draw_shape(enum triptych_primitive primitive, const struct shape_vertex *vertex, unsigned count)
{
    struct shape_vertex clip[64];
    triptych_buffer *buffer;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(64, count);
    for (unsigned i = 0; i < count; i++) {
        clip[i] = vertex[i];
        clip[i].x = vertex[i].x / (SIZE / 2) - 1;
        clip[i].y = 1 - vertex[i].y / (SIZE / 2);
    }
    OK(triptych_buffer_create(device, clip, count * sizeof *clip, &buffer));
    bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, buffer, offsetof(struct shape_vertex, x));
    bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR, buffer, offsetof(struct shape_vertex, color));
    bind(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT2, buffer, offsetof(struct shape_vertex, u));
    OK(triptych_draw(device, primitive, 0, primitives(primitive, count)));
}

void set_number(enum triptych_state state, uint32_t value)
{
    OK(triptych_set_state(device, state, value));
}

void set_real(enum triptych_state state, float value)
{
    uint32_t bits = bits_of_float(value);
    set_number(state, bits);
}

void clear_shapes(void)
{
    static const float black[4];
    OK(triptych_clear(device, black, 1));
}

void read_shapes(void)
{
    OK(triptych_read_color(device, image, sizeof image));
    OK(triptych_read_depth(device, shape_depth, sizeof shape_depth));
}
