#include "tool/session.h"
#include "stream/stream.h"

#include <stdlib.h>

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
    if (!capture->color || !capture->depth)
        return fail(self, "no memory for a picture of %zu pixels", pixels);
    capture->capacity = pixels;
    return STATUS_OK;
}

int capture_read(const struct command *self, const struct session *session, struct capture *capture)
{
    unsigned width, height;
    triptych_target_size(session->device, &width, &height);
    if (!width || !height)
        return fail(self, "%s: the frame has no target, expected a call of target", session->stream->path);
    if (reserve(self, capture, (size_t)width * height))
        return STATUS_BAD;
    capture->width = width;
    capture->height = height;
    if (triptych_read_color(session->device, capture->color) ||
        triptych_read_depth(session->device, capture->depth))
        return fail(self, "%s: %s", session->stream->path, triptych_error(session->device));
    return STATUS_OK;
}

void capture_free(struct capture *capture)
{
    free(capture->color);
    free(capture->depth);
    *capture = (struct capture){0};
}

struct picture capture_picture(const struct capture *capture)
{
    return (struct picture){capture->width, capture->height, capture->color, capture->depth};
}
