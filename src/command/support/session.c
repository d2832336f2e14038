#include "command/support/session.h"

#include "command/container/reader.h"
#include "image/rows.h"

#include <stdlib.h>
#include <string.h>

struct stream *session_load_frames(const struct command *self, const char *path)
{
    struct stream *stream;
    struct error error = {""};
    tool_progress("reading %s", path);
    if (container_open(path, &stream, &error))
        return tool_fail(self, "%s", error.text), NULL;
    return stream;
}

struct stream *session_load(const struct command *self, const char *path)
{
    struct stream *stream;
    struct error error = {""};
    tool_progress("reading %s", path);
    if (stream_read(path, &stream, &error))
        return tool_fail(self, "%s", error.text), NULL;
    return stream;
}

int session_open(const struct command *self, const struct stream *stream, unsigned engine, unsigned threads,
                 const struct setting_values *settings, struct session *session)
{
    return session_open_measured(self, stream, engine, threads, settings, false, session);
}

/* A request in TRIPTYCH_DEBUG that cannot be met is a warning, printed once, not a failure. */
static void tell_debug_error(struct session *session)
{
    const char *reason = session->device ? triptych_debug_error(session->device) : "";
    if (*reason && !session->told)
        tool_fail(session->self, "debugging: %s", reason);
    session->told |= *reason != 0;
}

int session_open_measured(const struct command *self, const struct stream *stream, unsigned engine,
                          unsigned threads, const struct setting_values *settings, bool measure,
                          struct session *session)
{
    struct error error = {""};
    char text[SETTING_TEXT] = "";
    const struct triptych_options options = {.engine = triptych_engine_name(engine),
                                             .threads = threads,
                                             .measure = measure,
                                             .settings = settings ? setting_write(settings, text) : text};
    *session = (struct session){.stream = stream, .self = self};
    if (triptych_device_create(&options, &session->device, error.text, sizeof error.text))
        return tool_fail(self, "engine %s: %s", options.engine, error.text);
    tell_debug_error(session);
    if (stream_prepare(stream, session->device, &session->player, &error))
        return tool_fail(self, "%s", error.text);
    return STATUS_OK;
}

/* TRIPTYCH_RECORD may have started a recording. */
static void end_recording(struct session *session)
{
    if (session->device && triptych_record_stop(session->device) == TRIPTYCH_FILE_FAILED)
        tool_fail_at_end(session->self, "%s", triptych_error(session->device));
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
    return player_frame(session->player, frame, &error) ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

int session_seek(const struct command *self, struct session *session, unsigned frame)
{
    struct error error = {""};
    return player_seek(session->player, frame, &error) ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

unsigned session_spread(unsigned i, unsigned count, unsigned all)
{
    return count < 2 ? 0 : (unsigned)((uint64_t)i * (all - 1) / (count - 1));
}

static int reserve(const struct command *self, struct readback *readback, size_t pixels)
{
    if (pixels <= readback->capacity)
        return STATUS_OK;
    readback_free(readback);
    readback->color = malloc(pixels * sizeof *readback->color);
    readback->depth = malloc(pixels * sizeof *readback->depth);
    readback->stencil = malloc(pixels);
    if (!readback->color || !readback->depth || !readback->stencil)
        return tool_fail(self, "no memory for a picture of %zu pixels", pixels);
    readback->capacity = pixels;
    return STATUS_OK;
}

/* Returns true if the bytes of the first target are the whole picture. */
static bool is_bytes(const struct triptych_target_description *target)
{
    return !target->color_format[1] && triptych_format_is_bytes(target->color_format[0]);
}

/* Reads the numbers of each pixel, target after target. For samples, all samples of a pixel have its average.
 */
static int read_numbers(const struct command *self, const struct session *session, struct readback *readback,
                        const struct triptych_target_description *target)
{
    size_t all = (size_t)readback->width * readback->height;
    size_t pixels = (size_t)target->width * target->height;
    unsigned targets = 1;
    while (targets < TRIPTYCH_TARGETS && target->color_format[targets])
        targets++;
    float *one = malloc(pixels * 4 * sizeof *one);
    readback->numbers = malloc(all * targets * 4 * sizeof *readback->numbers);
    readback->targets = targets;
    int status = one && readback->numbers ? STATUS_OK : tool_fail(self, "no memory for %zu pixels", pixels);
    for (unsigned t = 0; t < targets && !status; t++) {
        if (triptych_read_target_numbers(session->device, t, one, pixels * 4 * sizeof *one))
            status = tool_fail(self, "%s: %s", session->stream->path, triptych_error(session->device));
        for (size_t i = 0; i < all && !status; i++)
            memcpy(readback->numbers + (i * targets + t) * 4, one + i % pixels * 4, 4 * sizeof *one);
    }
    free(one);
    return status;
}

static int read_pixels(triptych_device *device, struct readback *readback)
{
    size_t pixels = (size_t)readback->width * readback->height;
    return triptych_read_color(device, readback->color, pixels * sizeof *readback->color) ||
           (readback->has_depth &&
            triptych_read_depth(device, readback->depth, pixels * sizeof *readback->depth)) ||
           (readback->has_stencil && triptych_read_stencil(device, readback->stencil, pixels));
}

static int read_samples(triptych_device *device, unsigned samples, struct readback *readback)
{
    size_t pixels = (size_t)readback->width * readback->height / samples;
    int bad = 0;
    for (unsigned i = 0; i < samples && !bad; i++)
        bad = triptych_read_sample(device, i, readback->color + i * pixels, pixels * sizeof *readback->color,
                                   readback->has_depth ? readback->depth + i * pixels : NULL,
                                   pixels * sizeof *readback->depth,
                                   readback->has_stencil ? readback->stencil + i * pixels : NULL, pixels);
    return bad;
}

static int read_queries(const struct command *self, const struct session *session, struct readback *readback)
{
    struct query_count count;
    readback->query_count = 0;
    while (player_query(session->player, readback->query_count, &count)) {
        struct query_count *larger =
            realloc(readback->queries, (readback->query_count + 1) * sizeof *readback->queries);
        if (!larger)
            return tool_fail(self, "no memory for %u queries", readback->query_count + 1);
        readback->queries = larger;
        readback->queries[readback->query_count++] = count;
    }
    return STATUS_OK;
}

bool session_is_lower(triptych_device *device)
{
    unsigned origin = TRIPTYCH_WINDOW_ORIGIN_UPPER;
    triptych_get_convention(device, TRIPTYCH_WINDOW_ORIGIN, &origin);
    return origin == TRIPTYCH_WINDOW_ORIGIN_LOWER;
}

/* Reverses the rows. */
static void turn(struct readback *readback)
{
    const size_t width = readback->width;
    const unsigned rows = readback->height;
    rows_reverse(readback->color, width * sizeof *readback->color, rows);
    if (readback->has_depth)
        rows_reverse(readback->depth, width * sizeof *readback->depth, rows);
    if (readback->has_stencil)
        rows_reverse(readback->stencil, width * sizeof *readback->stencil, rows);
    if (readback->numbers)
        rows_reverse(readback->numbers, width * 4 * readback->targets * sizeof *readback->numbers, rows);
}

int readback_take(const struct command *self, const struct session *session, enum readback_what what,
                  struct readback *readback)
{
    struct triptych_target_description target;
    triptych_get_target(session->device, &target);
    if (!target.width)
        return tool_fail(self, "%s: the frame has no target, expected a call of target",
                         session->stream->path);
    unsigned samples = what == READBACK_SAMPLES ? target.samples : 1;
    if (reserve(self, readback, (size_t)target.width * target.height * samples))
        return STATUS_BAD;
    if (read_queries(self, session, readback))
        return STATUS_BAD;
    readback->width = target.width;
    readback->height = target.height * samples;
    readback->has_depth = what != READBACK_COLORS && triptych_depth_bits(target.depth_format);
    readback->has_stencil = what != READBACK_COLORS && triptych_stencil_bits(target.depth_format);
    if (samples > 1 ? read_samples(session->device, samples, readback)
                    : read_pixels(session->device, readback))
        return tool_fail(self, "%s: %s", session->stream->path, triptych_error(session->device));
    free(readback->numbers);
    readback->numbers = NULL;
    if (!is_bytes(&target) && read_numbers(self, session, readback, &target))
        return STATUS_BAD;
    if (what != READBACK_SAMPLES && session_is_lower(session->device))
        turn(readback);
    return STATUS_OK;
}

void readback_free(struct readback *readback)
{
    free(readback->color);
    free(readback->depth);
    free(readback->stencil);
    free(readback->queries);
    free(readback->numbers);
    *readback = (struct readback){0};
}

struct picture readback_picture(const struct readback *readback)
{
    return (struct picture){.width = readback->width,
                            .height = readback->height,
                            .color = readback->color,
                            .depth = readback->has_depth ? readback->depth : NULL,
                            .stencil = readback->has_stencil ? readback->stencil : NULL,
                            .numbers = readback->numbers,
                            .numbers_each = 4 * readback->targets};
}
