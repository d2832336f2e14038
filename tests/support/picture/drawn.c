#include "drawn.h"

#include <stdio.h>
#include <string.h>

float drawn_position[4][4];
float drawn[SIZE * SIZE][4];

void drawn_begin(void)
{
    static const float whole[4][4] = {{-1, 1, 0.5f, 1}, {1, 1, 0.5f, 1}, {-1, -1, 0.5f, 1}, {1, -1, 0.5f, 1}};
    memcpy(drawn_position, whole, sizeof whole);
}

static triptych_shader *assemble(const char *text)
{
    triptych_shader *shader = NULL;
    if (text)
        OK(triptych_shader_assemble(device, "test", text, strlen(text), &shader));
    return shader;
}

void use_shaders(const char *vertex, const char *pixel)
{
    OK(triptych_set_vertex_shader(device, assemble(vertex)));
    OK(triptych_set_pixel_shader(device, assemble(pixel)));
}

struct drawn_element drawn_constant(enum triptych_usage usage, unsigned index, float x, float y, float z,
                                    float w)
{
    struct drawn_element r = {.usage = usage, .index = index};
    for (int i = 0; i < 4; i++)
        memcpy(r.value[i], (float[4]){x, y, z, w}, sizeof r.value[i]);
    return r;
}

static void declare(enum triptych_usage position, const struct drawn_element *elements, unsigned count)
{
    struct triptych_declaration_element declared[1 + DRAWN_ELEMENTS] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT4, position, 0}};
    float vertex[4][1 + DRAWN_ELEMENTS][4];
    triptych_buffer *buffer;
    for (unsigned i = 0; i < 4; i++) {
        memcpy(vertex[i][0], drawn_position[i], sizeof vertex[i][0]);
        for (unsigned j = 0; j < count; j++)
            memcpy(vertex[i][1 + j], elements[j].value[i], sizeof vertex[i][0]);
    }
    for (unsigned j = 0; j < count; j++)
        declared[1 + j] = (struct triptych_declaration_element){
            0, 16 * (1 + (size_t)j), TRIPTYCH_FORMAT_FLOAT4, elements[j].usage, elements[j].index};
    OK(triptych_set_declaration(device, declared, 1 + count));
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    OK(triptych_set_stream(device, 0, buffer, 0, sizeof vertex[0]));
}

void draw_declared(enum triptych_usage position, const struct drawn_element *elements, unsigned count)
{
    declare(position, elements, count);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
}

void draw_points(const struct drawn_element *elements, unsigned count)
{
    declare(TRIPTYCH_USAGE_POSITION, elements, count);
    OK(triptych_draw(device, TRIPTYCH_POINT_LIST, 0, 1));
}

void use_float_target(void)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F}};
    OK(triptych_set_target_description(device, &description));
}

void read_numbers(unsigned t)
{
    OK(triptych_read_target_numbers(device, t, drawn[0], sizeof drawn));
}

void expect_numbers(int x, int y, const float expected[4], const char *what)
{
    char message[200];
    const float *got = drawn[y * SIZE + x];
    if (!memcmp(got, expected, sizeof drawn[0]))
        return;
    snprintf(message, sizeof message, "%s: pixel (%d, %d): expected %g %g %g %g, got %g %g %g %g", what, x, y,
             (double)expected[0], (double)expected[1], (double)expected[2], (double)expected[3],
             (double)got[0], (double)got[1], (double)got[2], (double)got[3]);
    TEST_FAIL_MESSAGE(message);
}
