#include "tool/session.h"
#include "stream/reader.h"

#include <stdlib.h>
#include <string.h>

struct stream *session_load_frames(const struct command *self, const char *path)
{
    struct stream *stream;
    struct error error = {""};
    progress("reading %s", path);
    if (stream_open(path, &stream, &error))
        return fail(self, "%s", error.text), NULL;
    return stream;
}

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
    return session_open_measured(self, stream, engine, threads, false, session);
}

/* Once: what is asked for in TRIPTYCH_DEBUG and cannot be done is worth a line, not a failure. */
static void tell_debug_error(struct session *session)
{
    const char *reason = session->device ? triptych_debug_error(session->device) : "";
    if (*reason && !session->told)
        fail(session->self, "debugging: %s", reason);
    session->told |= *reason != 0;
}

int session_open_measured(const struct command *self, const struct stream *stream, unsigned engine,
                          unsigned threads, bool measure, struct session *session)
{
    struct error error = {""};
    const struct triptych_options options = {
        .engine = triptych_engine_name(engine), .threads = threads, .measure = measure};
    *session = (struct session){.stream = stream, .self = self};
    if (triptych_device_create(&options, &session->device, error.text, sizeof error.text))
        return fail(self, "engine %s: %s", options.engine, error.text);
    tell_debug_error(session);
    if (stream_prepare(stream, session->device, &session->player, &error))
        return fail(self, "%s", error.text);
    return STATUS_OK;
}

/* TRIPTYCH_RECORD may have asked for one. */
static void end_recording(struct session *session)
{
    if (session->device && triptych_record_stop(session->device) == TRIPTYCH_FILE_FAILED)
        fail_at_end(session->self, "%s", triptych_error(session->device));
}

void session_close(struct session *session)
{
    tell_debug_error(session);
    player_free(session->player);
    end_recording(session);
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

/* Each pixel's numbers, target after target; those of the average in the place of every sample. */
static int read_numbers(const struct command *self, const struct session *session, struct capture *capture,
                        const struct triptych_target_description *target)
{
    size_t all = (size_t)capture->width * capture->height;
    size_t pixels = (size_t)target->width * target->height;
    unsigned targets = 1;
    while (targets < TRIPTYCH_TARGETS && target->color_format[targets])
        targets++;
    float *one = malloc(pixels * 4 * sizeof *one);
    capture->numbers = malloc(all * targets * 4 * sizeof *capture->numbers);
    capture->targets = targets;
    int status = one && capture->numbers ? STATUS_OK : fail(self, "no memory for %zu pixels", pixels);
    for (unsigned t = 0; t < targets && !status; t++) {
        if (triptych_read_target_numbers(session->device, t, one))
            status = fail(self, "%s: %s", session->stream->path, triptych_error(session->device));
        for (size_t i = 0; i < all && !status; i++)
            memcpy(capture->numbers + (i * targets + t) * 4, one + i % pixels * 4, 4 * sizeof *one);
    }
    free(one);
    return status;
}

static int read_pixels(triptych_device *device, struct capture *capture)
{
    return triptych_read_color(device, capture->color) ||
           (capture->has_depth && triptych_read_depth(device, capture->depth)) ||
           (capture->has_stencil && triptych_read_stencil(device, capture->stencil));
}

static int read_samples(triptych_device *device, unsigned samples, struct capture *capture)
{
    size_t pixels = (size_t)capture->width * capture->height / samples;
    int bad = 0;
    for (unsigned i = 0; i < samples && !bad; i++)
        bad = triptych_read_sample(device, i, capture->color + i * pixels,
                                   capture->has_depth ? capture->depth + i * pixels : NULL,
                                   capture->has_stencil ? capture->stencil + i * pixels : NULL);
    return bad;
}

static int read_queries(const struct command *self, const struct session *session, struct capture *capture)
{
    struct query_count count;
    capture->query_count = 0;
    while (player_query(session->player, capture->query_count, &count)) {
        struct query_count *larger =
            realloc(capture->queries, (capture->query_count + 1) * sizeof *capture->queries);
        if (!larger)
            return fail(self, "no memory for %u queries", capture->query_count + 1);
        capture->queries = larger;
        capture->queries[capture->query_count++] = count;
    }
    return STATUS_OK;
}

int capture_read(const struct command *self, const struct session *session, enum capture_what what,
                 struct capture *capture)
{
    struct triptych_target_description target;
    triptych_get_target(session->device, &target);
    if (!target.width)
        return fail(self, "%s: the frame has no target, expected a call of target", session->stream->path);
    unsigned samples = what == CAPTURE_SAMPLES ? target.samples : 1;
    if (reserve(self, capture, (size_t)target.width * target.height * samples))
        return STATUS_BAD;
    if (read_queries(self, session, capture))
        return STATUS_BAD;
    capture->width = target.width;
    capture->height = target.height * samples;
    capture->has_depth = triptych_depth_bits(target.depth_format);
    capture->has_stencil = triptych_stencil_bits(target.depth_format);
    if (samples > 1 ? read_samples(session->device, samples, capture) : read_pixels(session->device, capture))
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
    free(capture->queries);
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
