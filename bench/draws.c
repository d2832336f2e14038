/* Draws per second: the time to draw one triangle of 8 pixels after one change of the state.
 *
 *   draws [--engine NAME] [--threads N] [--draws N] [--passes N] [MODE]...
 *
 * Each mode is a way of changing the state between two draws, or of providing the vertices of each draw (the
 * table below). A pass makes all its draws
 * through the public interface and finishes, so the time includes everything: the set call, the draw call,
 * geometry, tiles, and the flushes of the queue. The modes take turns pass by pass, and the result is the
 * median of a mode's passes. The first pass, which builds the routines, is not counted. On a busy machine
 * processor time is more accurate than wall time. Each picture has a hash, which is the same with every
 * engine. */
#include "base/clock.h"
#include "triptych.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 256, RING = 4096, TRIANGLES = 1024, PASSES_MAXIMUM = 101 };

struct vertex {
    float position[3], normal[3];
};

/* The objects that the modes share. */
struct bench {
    triptych_device *device;
    triptych_buffer *vertices;
    triptych_buffer *changing; /* room for RING triangles */
    struct vertex vertex[3 * (TRIANGLES + 1)];
    triptych_texture *texture[2];
    triptych_shader *vertex_shader, *pixel_shader;
};

static void check(triptych_device *device, enum triptych_result result)
{
    if (result == TRIPTYCH_OK)
        return;
    fprintf(stderr, "draws: %s\n", triptych_error(device));
    exit(1);
}

/* --- Changes, each made before draw number i ------------------------------------------------------------ */

static void change_nothing(struct bench *bench, uint32_t i)
{
    (void)bench;
    (void)i;
}

static void change_factor(struct bench *bench, uint32_t i)
{
    check(bench->device,
          triptych_set_state(bench->device, TRIPTYCH_STATE_TEXTUREFACTOR, 0xff000000 | i * 0x010307));
}

static void change_world(struct bench *bench, uint32_t i)
{
    const float matrix[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {(float)(i & 15) / 128, 0, 0, 1}};
    check(bench->device, triptych_set_transform(bench->device, TRIPTYCH_TRANSFORM_WORLD, matrix));
}

static void change_material(struct bench *bench, uint32_t i)
{
    struct triptych_material material = {.diffuse = {(float)(i & 255) / 255, 1, 0, 1}};
    check(bench->device, triptych_set_material(bench->device, &material));
}

static void change_vertex_constant(struct bench *bench, uint32_t i)
{
    const float offset[4] = {(float)(i & 15) / 128, 0, 0, 0};
    check(bench->device, triptych_set_shader_floats(bench->device, TRIPTYCH_SHADER_VERTEX, 4, offset, 1));
}

static void change_pixel_constant(struct bench *bench, uint32_t i)
{
    const float color[4] = {(float)(i & 255) / 255, 0.5f, 0, 1};
    check(bench->device, triptych_set_shader_floats(bench->device, TRIPTYCH_SHADER_PIXEL, 0, color, 1));
}

static void change_two_constants(struct bench *bench, uint32_t i)
{
    change_vertex_constant(bench, i);
    change_pixel_constant(bench, i);
}

static void change_texture(struct bench *bench, uint32_t i)
{
    check(bench->device, triptych_set_texture(bench->device, 0, bench->texture[i & 1]));
}

static void change_state(struct bench *bench, uint32_t i)
{
    check(bench->device, triptych_set_state(bench->device, TRIPTYCH_STATE_ALPHABLENDENABLE, i & 1));
}

static void change_stream(struct bench *bench, uint32_t i)
{
    check(bench->device, triptych_set_stream(bench->device, 0, bench->vertices, i & 1 ? 72 : 0, 24));
}

/* --- Draws of triangle i -------------------------------------------------------------------------------- */

static void draw_bound(struct bench *bench, uint32_t i)
{
    check(bench->device, triptych_draw(bench->device, TRIPTYCH_TRIANGLE_LIST, 3 * (i % TRIANGLES), 1));
}

static void draw_user(struct bench *bench, uint32_t i)
{
    check(bench->device, triptych_draw_user(bench->device, TRIPTYCH_TRIANGLE_LIST, 1,
                                            bench->vertex + 3 * (i % TRIANGLES), sizeof *bench->vertex));
}

static void draw_indexed_user(struct bench *bench, uint32_t i)
{
    static const uint16_t index[3] = {0, 1, 2};
    check(bench->device,
          triptych_draw_indexed_user(bench->device, TRIPTYCH_TRIANGLE_LIST, 1, index, 16, 3,
                                     bench->vertex + 3 * (i % TRIANGLES), sizeof *bench->vertex));
}

static void draw_new_buffer(struct bench *bench, uint32_t i)
{
    triptych_device *device = bench->device;
    triptych_buffer *buffer;
    check(device, triptych_buffer_create(device, bench->vertex + 3 * (i % TRIANGLES),
                                         3 * sizeof *bench->vertex, &buffer));
    check(device, triptych_set_stream(device, 0, buffer, 0, sizeof *bench->vertex));
    check(device, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    check(device, triptych_buffer_destroy(device, buffer));
}

/* Writes a triangle to the changing buffer and draws it. */
static void draw_changed(struct bench *bench, uint32_t i, uint32_t to, enum triptych_map mode)
{
    triptych_device *device = bench->device;
    const size_t bytes = 3 * sizeof *bench->vertex;
    void *data;
    check(device, triptych_buffer_map(device, bench->changing, to * bytes, bytes, mode, &data));
    memcpy(data, bench->vertex + 3 * (i % TRIANGLES), bytes);
    check(device, triptych_buffer_unmap(device, bench->changing));
    if (!i)
        check(device, triptych_set_stream(device, 0, bench->changing, 0, sizeof *bench->vertex));
    check(device, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 3 * to, 1));
}

static void draw_appended(struct bench *bench, uint32_t i)
{
    draw_changed(bench, i, i % RING, i % RING ? TRIPTYCH_MAP_NO_OVERWRITE : TRIPTYCH_MAP_DISCARD);
}

static void draw_discarded(struct bench *bench, uint32_t i)
{
    draw_changed(bench, i, 0, TRIPTYCH_MAP_DISCARD);
}

static void draw_updated(struct bench *bench, uint32_t i)
{
    triptych_device *device = bench->device;
    const size_t bytes = 3 * sizeof *bench->vertex;
    check(device, triptych_buffer_update(device, bench->changing, i % RING * bytes,
                                         bench->vertex + 3 * (i % TRIANGLES), bytes));
    if (!i)
        check(device, triptych_set_stream(device, 0, bench->changing, 0, sizeof *bench->vertex));
    check(device, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 3 * (i % RING), 1));
}

static const struct mode {
    const char *name;
    void (*change)(struct bench *, uint32_t i);
    int shaders, textured, lit;
    const char *meaning;
    void (*draw)(struct bench *, uint32_t i); /* null: draw_bound */
} modes[] = {
    {"nothing", change_nothing, 0, 0, 0, "nothing", NULL},
    {"factor", change_factor, 0, 0, 0, "the texture factor", NULL},
    {"world", change_world, 0, 0, 0, "the world matrix", NULL},
    {"material", change_material, 0, 0, 1, "the material, lit by one light", NULL},
    {"texture", change_texture, 0, 1, 0, "the texture, one of two", NULL},
    {"state", change_state, 0, 0, 0, "alphablendenable, off and on", NULL},
    {"stream", change_stream, 0, 0, 0, "the offset into the vertices' buffer", NULL},
    {"shaders", change_nothing, 1, 0, 0, "nothing, with shaders", NULL},
    {"vertex", change_vertex_constant, 1, 0, 0, "a constant of the vertex shader", NULL},
    {"pixel", change_pixel_constant, 1, 0, 0, "a constant of the pixel shader", NULL},
    {"two", change_two_constants, 1, 0, 0, "a constant of each shader", NULL},
    {"user", change_nothing, 0, 0, 0, "nothing; vertices in memory of the caller", draw_user},
    {"indexed", change_nothing, 0, 0, 0, "nothing; the same with indices", draw_indexed_user},
    {"buffer", change_nothing, 0, 0, 0, "a buffer is created, bound and destroyed", draw_new_buffer},
    {"append", change_nothing, 0, 0, 0, "vertices are appended to a buffer of 288 KiB", draw_appended},
    {"discard", change_nothing, 0, 0, 0, "the same buffer is discarded", draw_discarded},
    {"update", change_nothing, 0, 0, 0, "vertices of the same buffer are updated", draw_updated},
};

enum { MODES = sizeof modes / sizeof *modes };

/* --- The scene ------------------------------------------------------------------------------------------ */

static const char vertex_code[] = "vs_2_0\n"
                                  "dcl_position v0\n"
                                  "dp4 r0.x, v0, c0\n"
                                  "dp4 r0.y, v0, c1\n"
                                  "dp4 r0.z, v0, c2\n"
                                  "dp4 r0.w, v0, c3\n"
                                  "add oPos, r0, c4\n"
                                  "mov oD0, v0\n";
static const char pixel_code[] = "ps_2_0\n"
                                 "mov r0, c0\n"
                                 "mov oC0, r0\n";

/* Triangles that cover the centres of 3 + 2 + 2 + 1 pixels, all over the target. */
static void make_vertices(struct vertex vertex[3 * (TRIANGLES + 1)])
{
    static const float corner[3][2] = {{0, 0}, {3.4f, 0}, {0, 4.5f}};
    for (uint32_t i = 0; i <= TRIANGLES; i++)
        for (int c = 0; c < 3; c++) {
            float x = (float)(i * 37 % 224) + corner[c][0], y = (float)(i * 101 % 240) + corner[c][1];
            vertex[3 * i + (uint32_t)c] =
                (struct vertex){{x / (SIZE / 2) - 1, 1 - y / (SIZE / 2), 0.5f}, {0, 0, -1}};
        }
}

static void make(struct bench *bench, const struct triptych_options *options)
{
    static const uint32_t image[2][4] = {{0xff0000ff, 0xff00ff00, 0xffff0000, 0xffffffff}, {0xff808080}};
    char reason[256];
    if (triptych_device_create(options, &bench->device, reason, sizeof reason) != TRIPTYCH_OK) {
        fprintf(stderr, "draws: %s\n", reason);
        exit(1);
    }
    triptych_device *device = bench->device;
    make_vertices(bench->vertex);
    check(device, triptych_set_target(device, SIZE, SIZE));
    check(device, triptych_buffer_create(device, bench->vertex, sizeof bench->vertex, &bench->vertices));
    check(device, triptych_buffer_create(device, NULL, RING * 3 * sizeof *bench->vertex, &bench->changing));
    for (int i = 0; i < 2; i++)
        check(device, triptych_texture_create(device, image[i], 2, 2, &bench->texture[i]));
    check(device, triptych_shader_assemble(device, "vertex", vertex_code, strlen(vertex_code),
                                           &bench->vertex_shader));
    check(device,
          triptych_shader_assemble(device, "pixel", pixel_code, strlen(pixel_code), &bench->pixel_shader));
    const struct triptych_declaration_element elements[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, 12, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_NORMAL, 0}};
    check(device, triptych_set_declaration(device, elements, 2));
    check(device, triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    check(device, triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    check(device, triptych_enable_light(device, 0, 1));
}

/* Sets the state before the mode's draws. */
static void prepare(struct bench *bench, const struct mode *mode)
{
    triptych_device *device = bench->device;
    const float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    const float zero[4] = {0}, black[4] = {0, 0, 0, 1}, orange[4] = {1, 0.5f, 0, 1};
    struct triptych_material white = {.diffuse = {1, 1, 1, 1}};
    check(device, triptych_clear(device, black, 1));
    check(device, triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD, identity));
    check(device, triptych_set_material(device, &white));
    check(device, triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 0, identity[0], 4));
    check(device, triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, 4, zero, 1));
    check(device, triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, orange, 1));
    check(device, triptych_set_vertex_shader(device, mode->shaders ? bench->vertex_shader : NULL));
    check(device, triptych_set_pixel_shader(device, mode->shaders ? bench->pixel_shader : NULL));
    check(device, triptych_set_stream(device, 0, bench->vertices, 0, 24));
    check(device, triptych_set_texture(device, 0, mode->textured ? bench->texture[0] : NULL));
    check(device, triptych_set_state(device, TRIPTYCH_STATE_TEXTUREFACTOR, 0xff4080c0));
    check(device, triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 0));
    check(device, triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, (uint32_t)mode->lit));
    check(device, triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_COLOROP, mode->textured ? 4 : 2));
    check(device, triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_COLORARG1,
                                           mode->textured ? 2
                                           : mode->lit    ? 0
                                                          : 3)); /* texture, diffuse or factor */
    check(device, triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_COLORARG2, 3));
}

struct duration {
    double seconds, used; /* wall time, processor time */
};

static struct duration run(struct bench *bench, const struct mode *mode, uint32_t draws)
{
    void (*draw)(struct bench *, uint32_t) = mode->draw ? mode->draw : draw_bound;
    prepare(bench, mode);
    check(bench->device, triptych_finish(bench->device));
    double start = clock_seconds_of(CLOCK_MONOTONIC), used = clock_seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    for (uint32_t i = 0; i < draws; i++) {
        mode->change(bench, i);
        draw(bench, i);
    }
    check(bench->device, triptych_finish(bench->device));
    return (struct duration){clock_seconds_of(CLOCK_MONOTONIC) - start,
                             clock_seconds_of(CLOCK_PROCESS_CPUTIME_ID) - used};
}

/* --- The table ------------------------------------------------------------------------------------------ */

/* FNV-1a. */
static uint64_t hash_picture(struct bench *bench)
{
    static uint32_t image[SIZE * SIZE];
    check(bench->device, triptych_read_color(bench->device, image, sizeof image));
    uint64_t hash = 0xcbf29ce484222325;
    for (size_t i = 0; i < SIZE * SIZE; i++)
        hash = (hash ^ image[i]) * 0x100000001b3;
    return hash;
}

static uint64_t pixels_shaded(struct bench *bench)
{
    struct triptych_statistics statistics;
    triptych_get_statistics(bench->device, &statistics);
    return statistics.pixels_shaded;
}

static int compare(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static double median(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

struct row {
    double seconds[PASSES_MAXIMUM]; /* on the clock */
    double used[PASSES_MAXIMUM];    /* of processors */
    double pixels;
    uint64_t hash;
};

static void measure(struct bench *bench, const unsigned char *chosen, uint32_t draws, uint32_t passes,
                    struct row row[MODES])
{
    for (uint32_t pass = 0; pass <= passes; pass++)
        for (size_t m = 0; m < MODES; m++) {
            if (!chosen[m])
                continue;
            uint64_t before = pixels_shaded(bench);
            struct duration duration = run(bench, &modes[m], draws);
            row[m].pixels = (double)(pixels_shaded(bench) - before) / draws;
            row[m].hash = hash_picture(bench);
            if (!pass)
                continue;
            row[m].seconds[pass - 1] = duration.seconds;
            row[m].used[pass - 1] = duration.used;
        }
}

static uint32_t number(const char *option, const char *text, long least, long most)
{
    char *end;
    long value = text ? strtol(text, &end, 10) : 0;
    if (!text || *end || end == text || value < least || value > most) {
        fprintf(stderr, "draws: %s %s: expected %ld to %ld\n", option, text ? text : "", least, most);
        exit(2);
    }
    return (uint32_t)value;
}

static void choose(const char *name, unsigned char *chosen)
{
    for (size_t m = 0; m < MODES; m++)
        if (!strcmp(name, modes[m].name)) {
            chosen[m] = 1;
            return;
        }
    fprintf(stderr, "draws: mode %s: expected", name);
    for (size_t m = 0; m < MODES; m++)
        fprintf(stderr, " %s", modes[m].name);
    fprintf(stderr, "\n");
    exit(2);
}

int main(int count, char **argument)
{
    static struct row row[MODES];
    struct triptych_options options = {.engine = "specialize", .threads = 1};
    uint32_t draws = 100000, passes = 7;
    unsigned char chosen[MODES] = {0};
    int any = 0;
    for (int i = 1; i < count; i++) {
        const char *value = i + 1 < count ? argument[i + 1] : NULL;
        if (!strcmp(argument[i], "--engine") && value)
            options.engine = argument[++i];
        else if (!strcmp(argument[i], "--threads"))
            options.threads = number(argument[i++], value, 1, 256);
        else if (!strcmp(argument[i], "--draws"))
            draws = number(argument[i++], value, 1, 100000000);
        else if (!strcmp(argument[i], "--passes"))
            passes = number(argument[i++], value, 1, PASSES_MAXIMUM);
        else
            choose(argument[i], chosen), any = 1;
    }
    if (!any)
        memset(chosen, 1, sizeof chosen);
    static struct bench bench;
    make(&bench, &options);
    measure(&bench, chosen, draws, passes, row);
    printf("engine %s, %u thread%s, %u draws a pass, median of %u passes\n\n", options.engine,
           options.threads, options.threads == 1 ? "" : "s", draws, passes);
    printf("mode      kdraw/s  ns/draw   CPU ns  pixels/draw  picture           what changes between two "
           "draws\n");
    for (size_t m = 0; m < MODES; m++) {
        if (!chosen[m])
            continue;
        double seconds = median(row[m].seconds, passes), used = median(row[m].used, passes);
        printf("%-8s %8.0f %8.0f %8.0f %12.2f  %016" PRIx64 "  %s\n", modes[m].name, draws / seconds / 1e3,
               seconds / draws * 1e9, used / draws * 1e9, row[m].pixels, row[m].hash, modes[m].meaning);
    }
    triptych_device_destroy(bench.device);
    return 0;
}
