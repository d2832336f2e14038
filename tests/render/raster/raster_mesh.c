/* The rasterizer and meshes: exactly one triangle covers each centre inside of a closed mesh. */
#include "render/raster/raster.h"
#include "tests/render/raster/random.h"
#include "tests/support/geometry/covered.h"

#include <stdio.h>
#include <stdlib.h>
#include <unity.h>

enum { WINDOW_MAXIMUM = 4194303, TARGET = TARGET_SIZE_MAXIMUM, TARGET_TILES = TARGET / TILE_SIZE };

void setUp(void)
{
    random_begin();
}

void tearDown(void)
{
}

/* --- Meshes --- */

struct position {
    int32_t x, y;
};

static void count_triangle(struct covered *a, struct position p, struct position q, struct position r)
{
    struct triangle_head h = {-1, {p.x, q.x, r.x}, {p.y, q.y, r.y}, 0, 0};
    int turn = between(0, 2); /* which vertex comes first must not matter */
    for (int i = 0; i < 3; i++) {
        const struct position v[3] = {p, q, r};
        h.x[i] = v[(i + turn) % 3].x;
        h.y[i] = v[(i + turn) % 3].y;
    }
    if (covered_orient(&h))
        covered_count(a, &h);
}

/* Twice the signed area, positive when p, q, r go clockwise on the screen. */
static int64_t turn_of(struct position p, struct position q, struct position r)
{
    return (int64_t)(q.x - p.x) * (r.y - p.y) - (int64_t)(q.y - p.y) * (r.x - p.x);
}

static void expect_ones(const struct covered *a, int32_t border, const char *what)
{
    for (int y = border; y < a->height - border; y++)
        for (int x = border; x < a->width - border; x++)
            if (a->count[y * a->width + x] != 1) {
                char text[128];
                snprintf(text, sizeof text, "%s: pixel (%d, %d) is covered %d times", what, x, y,
                         a->count[y * a->width + x]);
                TEST_FAIL_MESSAGE(text);
            }
}

/* Moves the vertices of a grid by less than the distance that would fold a cell. Each cell is cut along one
 * of its diagonals. */
static void test_pixels_inside_a_mesh_are_covered_once(void)
{
    static const int32_t cell[] = {192, 256, 1024, 5000};
    enum { SIDE = 24 };
    for (int round = 0; round < 24; round++) {
        static struct position p[SIDE + 1][SIDE + 1];
        int32_t size = cell[round % 4], shake = round / 4 % 3 == 0 ? 0 : size / 4;
        int32_t origin = round & 1 ? 128 : between(0, 255);
        for (int j = 0; j <= SIDE; j++)
            for (int i = 0; i <= SIDE; i++) {
                p[j][i].x = origin + i * size + between(-shake, shake);
                p[j][i].y = origin + j * size + between(-shake, shake);
                if (round / 12) /* on centres: many edges go through them */
                    p[j][i] = (struct position){p[j][i].x / 64 * 64, p[j][i].y / 64 * 64};
            }
        int32_t pixels = SIDE * size / 256;
        struct covered a = covered_make((struct rectangle){0, 0, pixels, pixels});
        for (int j = 0; j < SIDE; j++)
            for (int i = 0; i < SIDE; i++) {
                int k = draw() & 1;
                count_triangle(&a, p[j][i], p[j][i + 1], k ? p[j + 1][i] : p[j + 1][i + 1]);
                count_triangle(&a, p[j + 1][i], p[j + 1][i + 1], k ? p[j][i + 1] : p[j][i]);
            }
        expect_ones(&a, 3 + (size / 4 + 512) / 256, "mesh");
        free(a.count);
    }
}

/* A fan from a random point inside of a convex quadrilateral. The quadrilateral contains the area, and its
 * corners have the largest positions. */
static void test_pixels_inside_a_fan_are_covered_once(void)
{
    enum { SPOKES = 12, EXTENT = 96 };
    for (int round = 0; round < 600; round++) {
        int32_t reach = round % 3 == 0 ? WINDOW_MAXIMUM : round % 3 == 1 ? 60000 : 26000;
        const struct position corner[4] = {
            {-reach, -reach}, {reach, -reach}, {reach, reach}, {-reach, reach}};
        struct position rim[SPOKES], hub = {between(0, EXTENT * 256), between(0, EXTENT * 256)};
        if (round & 1)
            hub = (struct position){hub.x / 256 * 256 + 128, hub.y / 256 * 256 + 128};
        for (int i = 0; i < SPOKES; i++) { /* each side: its corner, then points of it in order */
            struct position from = corner[i / 3], to = corner[(i / 3 + 1) % 4];
            int64_t t = i % 3 == 0 ? 0 : between(i % 3 * 300, i % 3 * 300 + 200);
            rim[i].x = (int32_t)(from.x + (to.x - from.x) * t / 1000);
            rim[i].y = (int32_t)(from.y + (to.y - from.y) * t / 1000);
        }
        struct covered a = covered_make((struct rectangle){0, 0, EXTENT, EXTENT});
        for (int i = 0; i < SPOKES; i++)
            count_triangle(&a, hub, rim[i], rim[(i + 1) % SPOKES]);
        expect_ones(&a, 0, "fan");
        free(a.count);
    }
}

/* A strip between two chains of points that move to the right. No pixel is covered twice. */
static void test_pixels_of_a_strip_are_covered_at_most_once(void)
{
    enum { LENGTH = 60 };
    for (int round = 0; round < 60; round++) {
        struct position p[LENGTH];
        int32_t step = between(40, 700);
        for (int i = 0; i < LENGTH; i++)
            p[i] = (struct position){i * step / 2, 4000 + (i & 1 ? 1 : -1) * between(0, 3500)};
        struct covered a = covered_make((struct rectangle){0, 0, LENGTH * step / 512 + 1, 32});
        for (int i = 0; i + 2 < LENGTH; i++) {
            bool forward = turn_of(p[i], p[i + 1], p[i + 2]) > 0;
            TEST_ASSERT_TRUE(forward == (i % 2 == 1) || turn_of(p[i], p[i + 1], p[i + 2]) == 0);
            count_triangle(&a, p[i], p[i + 1], p[i + 2]);
        }
        uint32_t covered = 0;
        for (int i = 0; i < a.width * a.height; i++) {
            TEST_ASSERT_LESS_OR_EQUAL_UINT8(1, a.count[i]);
            covered += a.count[i];
        }
        TEST_ASSERT_GREATER_THAN_UINT32(0, covered);
        free(a.count);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_pixels_inside_a_mesh_are_covered_once);
    RUN_TEST(test_pixels_inside_a_fan_are_covered_once);
    RUN_TEST(test_pixels_of_a_strip_are_covered_at_most_once);
    return UNITY_END();
}
