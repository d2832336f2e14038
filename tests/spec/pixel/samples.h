/* Triangles on targets with several samples a pixel, and the samples that they cover. Positions are whole
 * sixteenths of a pixel, so that a test does not round. */
#ifndef TESTS_SPEC_PIXEL_SAMPLES_H
#define TESTS_SPEC_PIXEL_SAMPLES_H

#include "tests/support/picture/canvas.h"
#include "tests/support/system/seed.h"

#include <stdio.h>

enum { SAMPLES = 8, UNIT = 16, EXTENT = SIZE * UNIT };

/* The standard patterns, in sixteenths from the centre. */
static const struct {
    unsigned count;
    int place[SAMPLES][2];
} patterns[] = {{2, {{4, 4}, {-4, -4}}},
                {4, {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}}},
                {8, {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}}};

enum { PATTERNS = sizeof patterns / sizeof *patterns };

struct corner {
    int x, y; /* sixteenths of a pixel */
    float z;
    uint32_t color;
};

static uint32_t color[SAMPLES][SIZE * SIZE];
static float depth[SAMPLES][SIZE * SIZE];
static uint8_t stencil[SAMPLES][SIZE * SIZE];
static unsigned pattern;

static inline void use_samples(unsigned which)
{
    struct triptych_target_description description = {.width = SIZE,
                                                      .height = SIZE,
                                                      .depth_format = TRIPTYCH_DEPTH_D24S8,
                                                      .samples = patterns[which].count};
    pattern = which;
    OK(triptych_set_target_description(device, &description));
}

static inline unsigned samples(void)
{
    return patterns[pattern].count;
}

static inline void read_all(void)
{
    for (unsigned i = 0; i < samples(); i++)
        OK(triptych_read_sample(device, i, color[i], sizeof color[i], depth[i], sizeof depth[i], stencil[i],
                                sizeof stencil[i]));
}

struct vertex {
    float x, y, z;
    uint32_t color;
};

static inline void draw_triangle(const struct corner corner[3])
{
    struct vertex vertex[3];
    triptych_buffer *buffer;
    for (int i = 0; i < 3; i++)
        vertex[i] = (struct vertex){(float)corner[i].x * 2 / EXTENT - 1, 1 - (float)corner[i].y * 2 / EXTENT,
                                    corner[i].z, corner[i].color};
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT3, buffer, 0, sizeof vertex[0]};
    struct triptych_element diffuse = {TRIPTYCH_FORMAT_COLOR, buffer, offsetof(struct vertex, color),
                                       sizeof vertex[0]};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_DIFFUSE, &diffuse));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
}

/* Returns twice the signed area of a, b and the point. It is positive if the point is to the left of a -> b
 * on the screen. */
static inline int64_t cross(const struct corner *a, const struct corner *b, int x, int y)
{
    return (int64_t)(b->x - a->x) * (y - a->y) - (int64_t)(b->y - a->y) * (x - a->x);
}

/* Returns 1 if the point is inside of the triangle, or on a left or top edge. The triangle is clockwise on
 * the screen. */
static inline int covers(const struct corner t[3], int x, int y)
{
    int turned = cross(&t[0], &t[1], t[2].x, t[2].y) < 0;
    for (int i = 0; i < 3; i++) {
        const struct corner *a = &t[turned ? (3 - i) % 3 : i], *b = &t[turned ? (2 - i) % 3 : (i + 1) % 3];
        int64_t side = cross(a, b, x, y);
        int owns = b->y < a->y || (b->y == a->y && b->x > a->x);
        if (side < 0 || (side == 0 && !owns))
            return 0;
    }
    return 1;
}

static inline void sample_place(unsigned sample, int p, int at[2])
{
    at[0] = p % SIZE * UNIT + UNIT / 2 + patterns[pattern].place[sample][0];
    at[1] = p / SIZE * UNIT + UNIT / 2 + patterns[pattern].place[sample][1];
}

static inline int covers_sample(const struct corner t[3], unsigned sample, int p)
{
    int at[2];
    sample_place(sample, p, at);
    return covers(t, at[0], at[1]);
}

static inline int covers_centre(const struct corner t[3], int p)
{
    return covers(t, p % SIZE * UNIT + UNIT / 2, p / SIZE * UNIT + UNIT / 2);
}

static inline struct corner random_corner(int reach)
{
    return (struct corner){(int)(random_word() % (unsigned)(EXTENT + 2 * reach)) - reach,
                           (int)(random_word() % (unsigned)(EXTENT + 2 * reach)) - reach, 0.5f, 0xffffffff};
}

/* Large and small ones, some beyond the target, of one colour. */
static inline void random_triangle(struct corner t[3])
{
    uint32_t packed = random_word();
    do {
        int small = random_word() % 2;
        t[0] = random_corner(small ? 0 : 300);
        for (int i = 1; i < 3; i++) {
            t[i] = random_corner(300);
            if (small) {
                t[i].x = t[0].x + (int)(random_word() % 80) - 40;
                t[i].y = t[0].y + (int)(random_word() % 80) - 40;
            }
        }
    } while (!cross(&t[0], &t[1], t[2].x, t[2].y));
    for (int i = 0; i < 3; i++)
        t[i].color = packed;
}

static inline void expect_color(unsigned sample, int p, uint32_t expected, const char *what)
{
    char text[160];
    if (color[sample][p] == expected)
        return;
    snprintf(text, sizeof text, "%s: %u samples, sample %u of pixel (%d, %d): expected %08x, got %08x", what,
             samples(), sample, p % SIZE, p / SIZE, expected, color[sample][p]);
    TEST_FAIL_MESSAGE(text);
}

/* Returns the depth at a point from the depths of the corners, in double precision. */
static inline double plane_at(const struct corner t[3], int x, int y)
{
    double area = (double)cross(&t[0], &t[1], t[2].x, t[2].y);
    double b = (double)cross(&t[2], &t[0], x, y) / area, c = (double)cross(&t[0], &t[1], x, y) / area;
    return (double)t[0].z * (1 - b - c) + (double)t[1].z * b + (double)t[2].z * c;
}

#endif
