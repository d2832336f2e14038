/* `triptych render`: draws one frame of a stream with one engine and saves it as a picture. */
#include "image/exr.h"
#include "image/png.h"
#include "command/support/choose.h"
#include "command/support/option.h"
#include "command/support/session.h"
#include "triptych.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAME_MAXIMUM = 65535, THREADS_MAXIMUM = 256, WIDTH_MAXIMUM = 256, CHANNELS = 4 };

static int save_png(const char *path, const struct readback *capture, struct error *error)
{
    return png_save(path, capture->width, capture->height, capture->color, error);
}

enum { COLORS = CHANNELS * TRIPTYCH_TARGETS, NAME_CAPACITY = 24 };

/* Bytes become numbers from 0 to 1 in binary16, from which they can be recovered. Numbers and depth keep
 * their 32 bits. Names of channels of targets after the first begin with the target's number. */
static size_t color_channels(const struct readback *capture, const float *values,
                             struct exr_channel channels[COLORS], char names[COLORS][NAME_CAPACITY])
{
    static const char letters[] = "RGBA";
    unsigned targets = capture->numbers ? capture->targets : 1, count = targets * CHANNELS;
    for (unsigned i = 0; i < count; i++) {
        if (i < CHANNELS)
            snprintf(names[i], NAME_CAPACITY, "%c", letters[i]);
        else
            snprintf(names[i], NAME_CAPACITY, "target%u.%c", i / CHANNELS, letters[i % CHANNELS]);
        channels[i] =
            (struct exr_channel){names[i], values + i, count, capture->numbers ? EXR_FLOAT : EXR_HALF};
    }
    return count;
}

/* Stencil is a channel of numbers from 0 to 255. */
static int save_exr(const char *path, const struct readback *capture, struct error *error)
{
    size_t pixels = (size_t)capture->width * capture->height;
    float *values = malloc(pixels * (CHANNELS + 1) * sizeof *values);
    if (!values)
        return error_set(error, "%s: no memory for %zu pixels", path, pixels);
    for (size_t i = 0; i < pixels; i++)
        for (unsigned channel = 0; channel < CHANNELS; channel++)
            values[i * CHANNELS + channel] = (float)(capture->color[i] >> 8 * channel & 255) / 255;
    struct exr_channel channels[COLORS + 2];
    char names[COLORS][NAME_CAPACITY];
    size_t count = color_channels(capture, capture->numbers ? capture->numbers : values, channels, names);
    if (capture->has_depth)
        channels[count++] = (struct exr_channel){"Z", capture->depth, 1, EXR_FLOAT};
    float *stencil = values + pixels * CHANNELS;
    for (size_t i = 0; i < pixels && capture->has_stencil; i++)
        stencil[i] = capture->stencil[i];
    if (capture->has_stencil)
        channels[count++] = (struct exr_channel){"stencil", stencil, 1, EXR_HALF};
    int bad = exr_save(path, capture->width, capture->height, channels, count, error);
    free(values);
    return bad;
}

static const struct picture_kind {
    const char *extension;
    int (*save)(const char *path, const struct readback *capture, struct error *error);
} kinds[] = {
    {".png", save_png}, /* colour and alpha */
    {".exr", save_exr}, /* colour, alpha, depth, stencil */
};

static const struct picture_kind *find_kind(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof kinds / sizeof *kinds; i++)
        if (!strcmp(dot, kinds[i].extension))
            return kinds + i;
    return NULL;
}

struct settings {
    const char *engine, *out;
    unsigned frame, threads, width;
};

static int render_frame(const struct command *self, const struct stream *stream,
                        const struct settings *settings, unsigned engine, struct readback *capture)
{
    struct session session = {0};
    int status = session_open(self, stream, engine, settings->threads, &session);
    if (!status)
        status = session_play(self, &session, settings->frame);
    if (!status)
        status = readback_take(self, &session, READBACK_PIXELS, capture);
    session_close(&session);
    return status;
}

static int render(const struct command *self, const char *path, const struct settings *settings,
                  unsigned engine, const struct picture_kind *kind)
{
    struct stream *stream = session_load_frames(self, path);
    if (!stream)
        return STATUS_BAD;
    struct readback capture = {0};
    struct error error = {""};
    int status = STATUS_OK;
    if (settings->frame >= stream->frame_count)
        status = tool_fail(self, "%s has no frame %u, its last is %u", path, settings->frame,
                           stream->frame_count - 1);
    if (!status)
        status = render_frame(self, stream, settings, engine, &capture);
    if (!status && kind->save(settings->out, &capture, &error))
        status = tool_fail(self, "%s", error.text);
    for (unsigned i = 0; i < capture.query_count && !status; i++)
        printf("%s: %" PRIu64 " samples passed\n", capture.queries[i].name, capture.queries[i].passed);
    readback_free(&capture);
    stream_free(stream);
    return status;
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    if (!settings->out)
        return tool_fail(self, "--out is missing, expected --out FILE.png or --out FILE.exr");
    const struct picture_kind *kind = find_kind(settings->out);
    if (!kind)
        return tool_fail(self, "%s: unknown kind of picture, expected .png or .exr", settings->out);
    unsigned engine;
    if (choose_engine(self, settings->engine, settings->width, &engine))
        return STATUS_BAD;
    return render(self, operands->value[0], settings, engine, kind);
}

static const struct settings defaults = {.engine = "specialize"};

static const struct option options[] = {
    {"engine", "NAME", "engine (triptych list engines); specialize", OPTION_IS_WORD(struct settings, engine),
     .words = triptych_engine_name},
    {"width", "LANES", "lanes of the engine's variant", OPTION_IS_NUMBER(struct settings, width), .least = 1,
     .most = WIDTH_MAXIMUM},
    {"out", "FILE", "FILE.png: colour; FILE.exr: colour, depth and stencil",
     OPTION_IS_FILE(struct settings, out), .extension = "png exr"},
    {"frame", "N", "which frame, from 0; 0", OPTION_IS_NUMBER(struct settings, frame), .most = FRAME_MAXIMUM},
    {"threads", "N", "rendering threads; one per core", OPTION_IS_NUMBER(struct settings, threads),
     .least = 1, .most = THREADS_MAXIMUM},
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream", .kind = OPERAND_INPUT, .extension = "tri trib"},
    {0},
};

const struct command command_render = {
    .name = "render",
    .summary = "draw a frame with one engine and write it as a picture",
    .options = options,
    .operands = operands,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
