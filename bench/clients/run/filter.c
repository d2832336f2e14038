/* Video to RGB with FFmpeg's libswscale. */
#include "bench/clients/filter/convert.h"
#include "bench/clients/run/work.h"

#include <libswscale/swscale.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 1280, HEIGHT = 720 };

/* libswscale's fast conversions have fewer bits than its exact ones. */
enum { BOUND = 3 };

struct filter_state {
    struct convert_choice choice;
    struct convert_picture picture;
    struct SwsContext *context;
};

static void convert_library(const struct filter_state *state, uint8_t *out)
{
    const struct convert_picture *p = &state->picture;
    const uint8_t *const planes[4] = {p->y, p->u, p->v, NULL};
    const int pitches[4] = {p->y_pitch, p->u_pitch, p->v_pitch, 0}, out_pitch[4] = {p->width * 4, 0, 0, 0};
    uint8_t *const outs[4] = {out, NULL, NULL, NULL};
    sws_scale(state->context, planes, pitches, 0, p->height, outs, out_pitch);
}

static void run(struct work *work, enum way way, const struct kernel *kernel)
{
    const struct filter_state *state = work->state;
    const size_t pitch = (size_t)state->picture.width * 4;
    if (way == WAY_PLAIN)
        convert_plain_picture(&state->choice, &state->picture, work->out, pitch);
    else if (way == WAY_LIBRARY)
        convert_library(state, work->out);
    else if (convert_kernel_picture(kernel, &state->choice, &state->picture, work->out, pitch))
        work_fail("out of memory");
}

static const uint8_t *make_plane(size_t bytes, uint32_t seed, unsigned least, unsigned levels)
{
    uint8_t *plane = work_memory(bytes + 64);
    for (size_t i = 0; i < bytes; i++) {
        seed = seed * 1664525u + 1013904223u;
        plane[i] = (uint8_t)(least + (seed >> 24) % levels);
    }
    return plane;
}

/* The library converts exactly the same: no interpolation of chroma, the same matrix and range. */
static struct SwsContext *make_context(const struct convert_choice *choice, int width, int height)
{
    static const int spaces[CONVERT_MATRICES] = {SWS_CS_ITU601, SWS_CS_ITU709, SWS_CS_BT2020};
    enum AVPixelFormat from = choice->across == 1 ? AV_PIX_FMT_YUV444P
                              : choice->down == 1 ? AV_PIX_FMT_YUV422P
                                                  : AV_PIX_FMT_YUV420P;
    enum AVPixelFormat to = choice->place[0] == 0 ? AV_PIX_FMT_RGBA : AV_PIX_FMT_BGRA;
    struct SwsContext *context = sws_getContext(width, height, from, width, height, to,
                                                SWS_POINT | SWS_ACCURATE_RND, NULL, NULL, NULL);
    const int *matrix = sws_getCoefficients(spaces[choice->matrix]);
    if (!context ||
        sws_setColorspaceDetails(context, matrix, choice->full, matrix, 1, 0, 1 << 16, 1 << 16) < 0)
        work_fail("libswscale refuses the conversion");
    return context;
}

static struct filter_state *make_state(const struct convert_choice *choice, int width, int height,
                                       uint32_t seed)
{
    struct filter_state *state = work_memory(sizeof *state);
    int chroma_width = width / choice->across, chroma_height = height / choice->down;
    size_t chroma = (size_t)chroma_width * (size_t)chroma_height;
    state->choice = *choice;
    state->picture = (struct convert_picture){.width = width,
                                              .height = height,
                                              .y = make_plane((size_t)width * (size_t)height, seed, 16, 220),
                                              .u = make_plane(chroma, seed + 1, 16, 225),
                                              .v = make_plane(chroma, seed + 2, 16, 225),
                                              .y_pitch = width,
                                              .u_pitch = chroma_width,
                                              .v_pitch = chroma_width};
    state->context = make_context(choice, width, height);
    return state;
}

size_t work_filter(struct work *work)
{
    static const struct convert_choice choice = {CONVERT_BT709, false, 2, 2, {2, 1, 0, 3}};
    *work = (struct work){.name = "filter",
                          .library = "libswscale",
                          .about = "YUV 4:2:0, BT.709, to BGRA",
                          .bytes = WIDTH * HEIGHT * 3 / 2,
                          .out_bytes = WIDTH * HEIGHT * 4,
                          .stride = CONVERT_STRIDE,
                          .bound = BOUND,
                          .text = &convert_kernel,
                          .choice = &choice,
                          .out = work_memory(WIDTH * HEIGHT * 4),
                          .run = run,
                          .state = make_state(&choice, WIDTH, HEIGHT, 1)};
    return 1;
}

static bool is_near(const uint8_t *a, const uint8_t *b, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        if (abs(a[i] - b[i]) > BOUND)
            return false;
    return true;
}

/* All matrices, ranges, subsamplings and both orders in turn. */
unsigned work_filter_differences(unsigned cases)
{
    enum { COLUMNS = 64, ROWS = 8 };
    static const int places[2][4] = {{0, 1, 2, 3}, {2, 1, 0, 3}}, sampling[3][2] = {{1, 1}, {2, 1}, {2, 2}};
    static uint8_t expected[COLUMNS * ROWS * 4], got[COLUMNS * ROWS * 4];
    unsigned differences = 0;
    for (unsigned n = 0; n < cases; n++) {
        const int *samples = sampling[n / 6 % 3];
        struct convert_choice choice = {(enum convert_matrix)(n % 3), n / 3 % 2, samples[0], samples[1], {0}};
        memcpy(choice.place, places[n / 18 % 2], sizeof choice.place);
        struct filter_state *state = make_state(&choice, COLUMNS, ROWS, n);
        struct kernel *kernel = work_kernel(&convert_kernel, &choice, CONVERT_STRIDE);
        convert_library(state, expected);
        if (convert_kernel_picture(kernel, &choice, &state->picture, got, COLUMNS * 4))
            work_fail("out of memory");
        differences += !is_near(expected, got, sizeof got);
        sws_freeContext(state->context);
        kernel_free(kernel);
    }
    return differences;
}
