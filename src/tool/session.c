#include "tool/session.h"
#include "stream/stream.h"

#include <stdlib.h>
#include <string.h>

struct stream *session_load(const struct command *self, const char *path)
{
    struct stream *stream;
    struct error error = {""};
    progress("reading %s", path);
    if (stream_read(path, &stream, &error))
        return fail(self, "%s", error.text), NULL;
    return stream;
}

int session_open(const struct command *self, const struct stream *stream, unsigned engine, unsigned threads,
                 struct session *session)
{
    struct error error = {""};
    const struct triptych_options options = {.engine = triptych_engine_name(engine), .threads = threads};
    *session = (struct session){.stream = stream};
    if (triptych_device_create(&options, &session->device, error.text, sizeof error.text))
        return fail(self, "engine %s: %s", options.engine, error.text);
    if (stream_prepare(stream, session->device, &session->player, &error))
        return fail(self, "%s", error.text);
    return STATUS_OK;
}

void session_close(struct session *session)
{
    player_free(session->player);
    triptych_device_destroy(session->device);
    *session = (struct session){0};
}

int session_play(const struct command *self, struct session *session, unsigned frame)
{
    struct error error = {""};
    return player_frame(session->player, frame, &error) ? fail(self, "%s", error.text) : STATUS_OK;
}

unsigned session_spread(unsigned i, unsigned count, unsigned all)
{
    return count < 2 ? 0 : (unsigned)((uint64_t)i * (all - 1) / (count - 1));
}

static int reserve(const struct command *self, struct capture *capture, size_t pixels)
{
    if (pixels <= capture->capacity)
        return STATUS_OK;
    capture_free(capture);
    capture->color = malloc(pixels * sizeof *capture->color);
    capture->depth = malloc(pixels * sizeof *capture->depth);
    capture->stencil = malloc(pixels);
    if (!capture->color || !capture->depth || !capture->stencil)
        return fail(self, "no memory for a picture of %zu pixels", pixels);
    capture->capacity = pixels;
    return STATUS_OK;
}

/* Whether the first target's bytes are all there is. */
static bool is_bytes(const struct triptych_target_description *target)
{
    return !target->color_format[1] && triptych_format_is_bytes(target->color_format[0]);
}

/* Each pixel's numbers, target after target. */
static int read_numbers(const struct command *self, const struct session *session, struct capture *capture,
                        const struct triptych_target_description *target)
{
    size_t pixels = (size_t)target->width * target->height;
    unsigned targets = 1;
    while (targets < TRIPTYCH_TARGETS && target->color_format[targets])
        targets++;
    float *one = malloc(pixels * 4 * sizeof *one);
    capture->numbers = malloc(pixels * targets * 4 * sizeof *capture->numbers);
    capture->targets = targets;
    int status = one && capture->numbers ? STATUS_OK : fail(self, "no memory for %zu pixels", pixels);
    for (unsigned t = 0; t < targets && !status; t++) {
        if (triptych_read_target_numbers(session->device, t, one))
            status = fail(self, "%s: %s", session->stream->path, triptych_error(session->device));
        for (size_t i = 0; i < pixels && !status; i++)
            memcpy(capture->numbers + (i * targets + t) * 4, one + i * 4, 4 * sizeof *one);
    }
    free(one);
    return status;
}

int capture_read(const struct command *self, const struct session *session, struct capture *capture)
{
    struct triptych_target_description target;
    triptych_get_target(session->device, &target);
    if (!target.width)
        return fail(self, "%s: the frame has no target, expected a call of target", session->stream->path);
    if (reserve(self, capture, (size_t)target.width * target.height))
        return STATUS_BAD;
    capture->width = target.width;
    capture->height = target.height;
    capture->has_depth = triptych_depth_bits(target.depth_format);
    capture->has_stencil = triptych_stencil_bits(target.depth_format);
    if (triptych_read_color(session->device, capture->color) ||
        (capture->has_depth && triptych_read_depth(session->device, capture->depth)) ||
        (capture->has_stencil && triptych_read_stencil(session->device, capture->stencil)))
        return fail(self, "%s: %s", session->stream->path, triptych_error(session->device));
    free(capture->numbers);
    capture->numbers = NULL;
    return is_bytes(&target) ? STATUS_OK : read_numbers(self, session, capture, &target);
}

void capture_free(struct capture *capture)
{
    free(capture->color);
    free(capture->depth);
    free(capture->stencil);
    free(capture->numbers);
    *capture = (struct capture){0};
}

struct picture capture_picture(const struct capture *capture)
{
    return (struct picture){.width = capture->width,
                            .height = capture->height,
                            .color = capture->color,
                            .depth = capture->has_depth ? capture->depth : NULL,
                            .stencil = capture->has_stencil ? capture->stencil : NULL,
                            .numbers = capture->numbers,
                            .numbers_each = 4 * capture->targets};
}
