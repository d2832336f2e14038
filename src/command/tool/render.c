/* `triptych render`: draws frames of a stream with one engine and saves them as pictures.
 *
 * The draws of a frame are played like frames: the view of the stream that --draws uses has a frame up to
 * each draw, so the player continues from one to the next. */
#include "command/support/choose.h"
#include "command/support/option.h"
#include "command/support/shard.h"
#include "command/support/shared.h"
#include "command/store/store.h"
#include "command/support/session.h"
#include "command/support/sink.h"
#include "triptych.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS_MAXIMUM = 256, WIDTH_MAXIMUM = 256 };

enum { UNSET = UINT32_MAX };

struct settings {
    const char *engine, *out, *frames, *draws, *shard;
    unsigned frame, threads, width, form, columns, rate, compression;
    bool no_cache;
    struct option_given set;
    unsigned precision;
};

/* The pictures to draw: frames `first` to `last` of the stream, which may be a view (view_draws). The files
 * are numbered from `number` on. */
struct task {
    const struct stream *stream;
    unsigned start; /* the frame to play first; pictures begin with `first` */
    unsigned first, last, number;
    const char *what; /* a picture of: "frame" or "draw" */
    bool several;     /* a range is given */
};

/* --- Ranges --------------------------------------------------------------------------------------------- */

/* Reads `N`, `A-B`, `A..B` or `all`, of `count` numbers from 0. */
static int read_range(const struct command *self, const char *option, const char *text, unsigned count,
                      struct task *task)
{
    char first[12];
    const char *dots = strstr(text, "..");
    size_t length = dots ? (size_t)(dots - text) : strcspn(text, "-");
    const char *last = text[length] ? text + length + (dots ? 2 : 1) : text;
    task->several = true;
    task->first = 0;
    task->last = count - 1;
    if (!strcmp(text, "all"))
        return STATUS_OK;
    snprintf(first, sizeof first, "%.*s", (int)(length < sizeof first ? length : 0), text);
    if (option_read_number(first, 0, count - 1, &task->first) &&
        option_read_number(last, task->first, count - 1, &task->last))
        return STATUS_OK;
    return tool_fail(self, "--%s is \"%s\", expected all, N or A-B of numbers from 0 to %u", option, text,
                     count - 1);
}

/* --- Draws ---------------------------------------------------------------------------------------------- */

/* A copy of the stream whose frames from `frame` on end after each draw of that frame. `ends` has room for
 * one more than all frames and draws. The rest is shared. */
static struct stream view_draws(const struct stream *stream, unsigned frame, uint32_t *ends, unsigned *draws)
{
    struct stream view = *stream;
    memcpy(ends, stream->frames, (frame + 1) * sizeof *ends);
    *draws = 0;
    for (uint32_t i = stream->frames[frame]; i < stream->frames[frame + 1]; i++)
        if (stream_draws_at(stream, i))
            ends[frame + ++*draws] = i + 1;
    view.frames = ends;
    view.frame_count = frame + *draws;
    return view;
}

/* --- Drawing -------------------------------------------------------------------------------------------- */

static void print_queries(const struct task *task, unsigned number, const struct readback *readback)
{
    for (unsigned i = 0; i < readback->query_count; i++) {
        if (task->several)
            printf("%s %u: ", task->what, number);
        printf("%s: %" PRIu64 " samples passed\n", readback->queries[i].name, readback->queries[i].passed);
    }
}

static int draw_all(const struct command *self, const struct task *task, struct session *session,
                    struct sink *sink)
{
    struct readback readback = {0};
    int status = STATUS_OK;
    for (unsigned frame = task->start; frame < task->first && !status; frame++)
        status = session_play(self, session, frame);
    for (unsigned frame = task->first; frame <= task->last && !status; frame++) {
        unsigned number = task->number + frame - task->first;
        if (task->several)
            tool_progress("%s %u, of %u to %u", task->what, number, task->number,
                          task->number + task->last - task->first);
        status = session_play(self, session, frame) ||
                 readback_take(self, session, sink_needs(sink), &readback) || sink_add(sink, &readback);
        if (!status)
            print_queries(task, number, &readback);
    }
    tool_progress(NULL);
    readback_free(&readback);
    return status ? STATUS_BAD : STATUS_OK;
}

static int draw_task(const struct command *self, const struct task *task, const struct settings *settings,
                     unsigned engine)
{
    const struct sink_options options = {.path = settings->out,
                                         .form = settings->form,
                                         .columns = settings->columns,
                                         .rate = settings->rate,
                                         .compression = settings->compression,
                                         .first = task->number,
                                         .count = task->last - task->first + 1,
                                         .numbered = task->several};
    const struct setting_values values = choose_settings(&settings->set);
    struct session session = {0};
    struct sink sink;
    if (sink_open(self, &options, &sink))
        return STATUS_BAD;
    int status = session_open(self, task->stream, engine, settings->threads, &values, &session);
    if (!status)
        status = draw_all(self, task, &session, &sink);
    session_close(&session);
    return sink_close(&sink, status);
}

static int check_frame(const struct command *self, const struct stream *stream, unsigned frame)
{
    return frame < stream->frame_count ? STATUS_OK
                                       : tool_fail(self, "%s has no frame %u, its last is %u", stream->path,
                                                   frame, stream->frame_count - 1);
}

/* Reduces the range to the shard's part. *empty is true if it has no frames. */
static int cut_range(const struct command *self, const char *text, struct task *task, bool *empty)
{
    struct shard shard;
    uint64_t first, count;
    if (shard_read(self, text, &shard))
        return STATUS_BAD;
    shard_part(&shard, (uint64_t)task->last - task->first + 1, &first, &count);
    *empty = !count;
    task->first += (unsigned)first;
    task->last = task->first + (unsigned)count - 1;
    return STATUS_OK;
}

static int draw_frames(const struct command *self, const struct stream *stream,
                       const struct settings *settings, unsigned engine)
{
    unsigned frame = settings->frame == UNSET ? 0 : settings->frame;
    struct task task = {.stream = stream, .first = frame, .last = frame, .what = "frame"};
    if (settings->frames ? read_range(self, "frames", settings->frames, stream->frame_count, &task)
                         : check_frame(self, stream, frame))
        return STATUS_BAD;
    bool empty;
    if (cut_range(self, settings->shard, &task, &empty))
        return STATUS_BAD;
    task.number = task.start = task.first;
    return empty ? STATUS_OK : draw_task(self, &task, settings, engine);
}

static int draw_draws(const struct command *self, const struct stream *stream,
                      const struct settings *settings, unsigned engine)
{
    unsigned frame = settings->frame == UNSET ? 0 : settings->frame, draws;
    struct task task = {.what = "draw"};
    if (check_frame(self, stream, frame))
        return STATUS_BAD;
    uint32_t *ends = malloc((stream->executed_count + frame + 2) * sizeof *ends);
    if (!ends)
        return tool_fail(self, "no memory for the draws of frame %u", frame);
    struct stream view = view_draws(stream, frame, ends, &draws);
    int status = draws ? read_range(self, "draws", settings->draws, draws, &task)
                       : tool_fail(self, "%s: frame %u has no draws", stream->path, frame);
    task.stream = &view;
    task.number = task.first;
    task.start = frame;
    task.first += frame;
    task.last += frame;
    if (!status)
        status = draw_task(self, &task, settings, engine);
    free(ends);
    return status;
}

/* --- The command ---------------------------------------------------------------------------------------- */

static int check_settings(const struct command *self, const struct settings *settings)
{
    if (!settings->out)
        return tool_fail(self, "--out is missing, expected FILE.png, FILE.exr, FILE.apng or FILE.y4m");
    if (settings->frames && (settings->draws || settings->frame != UNSET))
        return tool_fail(self, "--frames and --%s are both given, expected one of them",
                         settings->draws ? "draws" : "frame");
    if (settings->shard && (!settings->frames || settings->columns || !strchr(settings->out, '%')))
        return tool_fail(self, "--shard is given, expected --frames, and --out with a file for each picture, "
                               "such as f%%04d.png");
    return STATUS_OK;
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    unsigned engine;
    store_off |= settings->no_cache;
    if (check_settings(self, settings) || choose_engine(self, settings->engine, settings->width, &engine))
        return STATUS_BAD;
    const char *path = operands->value[0];
    struct stream *stream = settings->draws ? session_load(self, path) : session_load_frames(self, path);
    if (!stream)
        return STATUS_BAD;
    stream->precision = settings->precision;
    int status = settings->draws ? draw_draws(self, stream, settings, engine)
                                 : draw_frames(self, stream, settings, engine);
    stream_free(stream);
    return status;
}

static const struct settings defaults = {
    .engine = "specialize", .frame = UNSET, .form = SINK_BY_NAME, .compression = PNG_LEVEL_DEFAULT};

static const struct option options[] = {
    {"engine", "NAME", "the engine, one of triptych list engines; specialize",
     OPTION_IS_WORD(struct settings, engine), .words = triptych_engine_name, .suffixed = true},
    {"width", "LANES", "lanes of the engine's variant", OPTION_IS_NUMBER(struct settings, width), .least = 1,
     .most = WIDTH_MAXIMUM},
    {"out", "FILE", "FILE.png: colour, FILE.exr: also depth and stencil, FILE.apng or FILE.y4m: an animation",
     OPTION_IS_FILE(struct settings, out), .extension = "png exr apng y4m"},
    {"format", "FORM", "png, exr, apng or y4m; that of the extension of --out, png for -",
     OPTION_IS_INDEX(struct settings, form), .words = sink_form_name},
    OPTION_FRAME(struct settings, frame),
    {"frames", "A-B|all", "several frames, to files named like f%04d.png",
     OPTION_IS_TEXT(struct settings, frames)},
    {"draws", "A-B|all", "a picture after each of these draws of the frame, from 0",
     OPTION_IS_TEXT(struct settings, draws)},
    OPTION_SHARD(struct settings, shard),
    {"sheet", "COLUMNS", "all pictures in one PNG, in rows of COLUMNS",
     OPTION_IS_NUMBER(struct settings, columns), .least = 1, .most = 1024},
    {"rate", "N", "frames a second of an animation; 30", OPTION_IS_NUMBER(struct settings, rate), .least = 1,
     .most = ANIMATION_RATE_MAXIMUM},
    OPTION_COMPRESSION(struct settings, compression),
    OPTION_NO_CACHE(struct settings, no_cache),
    {"threads", "N", "rendering threads; one per core", OPTION_IS_NUMBER(struct settings, threads),
     .least = 1, .most = THREADS_MAXIMUM},
    OPTION_SET(struct settings, set),
    OPTION_PRECISION(struct settings, precision),
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream", .kind = OPERAND_INPUT, .extension = "tri trib"},
    {0},
};

static const char notes[] =
    "Several pictures have a file each, whose name contains the number of the picture as %d or %04d, or\n"
    "one file for all: an animation, or the sheet of --sheet. A sheet is reduced if it has more than 8192\n"
    "pixels a side. Of frames before the first, states are set and nothing is drawn. A file - is standard\n"
    "output, a stream - standard input.";

const struct command command_render = {
    .name = "render",
    .summary = "draw frames with one engine and write them as pictures",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
