/* The time to draw to a texture of 1024 x 1024 texels and return to the target, in microseconds.
 *
 *   targets [ENGINE]
 *
 * A pass changes the target PAIRS times to a texture and back, in one of the ways of the table below, and
 * finishes. The ways take turns pass by pass, and the result is the median of a way's passes. */
#include "base/clock.h"
#include "triptych.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 1024, PAIRS = 20, PASSES = 9 };

static triptych_device *device;
static triptych_texture *texture;

static void check(enum triptych_result result)
{
    if (result == TRIPTYCH_OK)
        return;
    fprintf(stderr, "targets: %s\n", triptych_error(device));
    exit(1);
}

static void draw_to(triptych_texture *to)
{
    const struct triptych_target_surfaces surfaces = {.color = {{.texture = to}},
                                                      .depth_format = TRIPTYCH_DEPTH_NONE};
    check(triptych_set_target_surfaces(device, to ? &surfaces : NULL));
}

/* A triangle of 32 pixels. */
static void draw(void)
{
    check(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
}

/* --- The ways ------------------------------------------------------------------------------------------- */

static void only_change(void)
{
    draw_to(texture);
    draw_to(NULL);
}

static void draw_in_both(void)
{
    draw_to(texture);
    draw();
    draw_to(NULL);
    draw();
}

/* The triangle in the target samples the texture. */
static void sample(void)
{
    draw_to(texture);
    draw();
    draw_to(NULL);
    check(triptych_set_texture(device, 0, texture));
    draw();
    check(triptych_set_texture(device, 0, NULL));
}

static void one_target(void)
{
    draw();
    draw();
}

static const struct {
    const char *name;
    void (*make)(void);
} ways[] = {
    {"two draws, no change", one_target},
    {"changes, no draw", only_change},
    {"a draw in both", draw_in_both},
    {"a draw in both, the second samples the first", sample},
};

enum { WAYS = sizeof ways / sizeof *ways };

/* --- The table ------------------------------------------------------------------------------------------ */

static void prepare(const char *engine)
{
    static const float vertices[9] = {0, 0, 0.5f, 0.0156f, 0, 0.5f, 0, -0.0156f, 0.5f};
    const struct triptych_options options = {.engine = engine, .threads = 1};
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, SIZE, SIZE, 1, 1};
    char reason[512];
    triptych_buffer *buffer;
    if (triptych_device_create(&options, &device, reason, sizeof reason)) {
        fprintf(stderr, "targets: %s\n", reason);
        exit(1);
    }
    check(triptych_set_target(device, SIZE, SIZE));
    check(triptych_texture_define(device, &description, &texture));
    check(triptych_buffer_create(device, vertices, sizeof vertices, &buffer));
    const struct triptych_declaration_element element = {0, 0, TRIPTYCH_FORMAT_FLOAT3,
                                                         TRIPTYCH_USAGE_POSITION, 0};
    check(triptych_set_declaration(device, &element, 1));
    check(triptych_set_stream(device, 0, buffer, 0, 12));
    check(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    check(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
}

static double pass(unsigned way)
{
    double start = clock_seconds_of(CLOCK_MONOTONIC);
    for (int i = 0; i < PAIRS; i++)
        ways[way].make();
    check(triptych_finish(device));
    return (clock_seconds_of(CLOCK_MONOTONIC) - start) / PAIRS * 1e6;
}

static int compare(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

int main(int count, char **arguments)
{
    double time[WAYS][PASSES];
    prepare(count > 1 ? arguments[1] : NULL);
    for (unsigned i = 0; i < WAYS; i++)
        pass(i); /* builds routines */
    for (int p = 0; p < PASSES; p++)
        for (unsigned i = 0; i < WAYS; i++)
            time[i][p] = pass(i);
    for (unsigned i = 0; i < WAYS; i++) {
        qsort(time[i], PASSES, sizeof **time, compare);
        printf("%-46s %10.2f us\n", ways[i].name, time[i][PASSES / 2]);
    }
    triptych_device_destroy(device);
    return 0;
}
