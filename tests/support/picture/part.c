#include "part.h"

void part_place(void)
{
    for (int i = 0; i < 4; i++) {
        drawn_position[i][0] = i % 2 ? -1 + 2.0f * PART / SIZE : -1;
        drawn_position[i][1] = i / 2 ? 1 - 2.0f * PART / SIZE : 1;
    }
}

void part_begin(void)
{
    use_float_target();
    part_place();
}

void part_draw(const float zeroth[4], const float next[4])
{
    const struct drawn_element element[] = {
        drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, zeroth[0], zeroth[1], zeroth[2], zeroth[3]),
        drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 1, next[0], next[1], next[2], next[3])};
    draw_declared(TRIPTYCH_USAGE_POSITION, element, 2);
    read_numbers(0);
}

void part_expect(const float expected[4], const char *what)
{
    expect_numbers(PART / 2, PART / 2 - 1, expected, what);
}
