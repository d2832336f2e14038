/* Triptych as a renderer that is measured: ENGINE THREADS FOLDER. It plays the streams of the folder, and the
 * pages of FOLDER/../pages. */
#include "peer.h"
#include "command/bench/execution.h"
#include "command/stream/stream.h"
#include "setting/setting.h"
#include "triptych.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PREPARE, FULL, LESS }; /* the streams' frames */

static struct triptych_options options;
static const char *folder;
static const struct workload *current;
static struct stream *stream;
static triptych_device *device;
static struct player *player;
static triptych_shader *shader; /* of renderer_build */
static struct error error;

static const char *reason_of(enum triptych_result result)
{
    return result ? triptych_error(device) : NULL;
}

static const char *load(const struct workload *workload)
{
    char path[1024];
    stream_free(stream);
    stream = NULL;
    bool page = workload->group == PAGE;
    snprintf(path, sizeof path, page ? "%s/../pages/%s.trib" : "%s/%s.tri", folder, workload->name);
    if (stream_read(path, &stream, &error))
        return error.text;
    current = workload;
    return page || stream->frame_count == 3 ? NULL : "the stream has another number of frames";
}

/* Each workload gets a new device. */
const char *renderer_open(const struct workload *workload)
{
    const char *reason = current == workload ? NULL : load(workload);
    if (reason)
        return reason;
    if (triptych_device_create(&options, &device, error.text, sizeof error.text) ||
        stream_prepare(stream, device, &player, &error))
        return error.text;
    bool failed =
        current->group == PAGE ? player_seek(player, 0, &error) : player_frame(player, PREPARE, &error);
    return failed ? error.text : NULL;
}

/* Pages are not limited: their frames set the rectangle. */
const char *renderer_limit(bool limited)
{
    if (current->group == PAGE)
        return NULL;
    const char *reason = reason_of(triptych_set_scissor(device, 508, 508, 8, 8));
    return reason ? reason : reason_of(triptych_set_state(device, TRIPTYCH_STATE_SCISSORTESTENABLE, limited));
}

/* The first frame prepares the device; the others follow it without playing it again. A page is its first
 * frame, which sets every state that it needs and so can follow itself. As in a program, the device is not
 * reset between frames. */
const char *renderer_frame(bool less)
{
    const uint32_t frame = current->group == PAGE ? 0 : less ? LESS : FULL;
    return player_go_on(player, frame, &error) ? error.text : NULL;
}

const char *renderer_read(uint32_t *rgba, bool *upward)
{
    *upward = false;
    return reason_of(triptych_read_color(device, rgba, PIXELS * sizeof *rgba));
}

const char *renderer_build(unsigned number)
{
    char text[512];
    triptych_shader *made;
    int length = snprintf(text, sizeof text,
                          "ps_2_0\ndef c0, %.7f, 0.5, 0.75, 1\ndcl t0.xy\ndcl_2d s0\ntexld r0, t0, s0\n"
                          "mul r1.xyz, r0, c0\ndp3 r0.w, r1, r1\nmad r1.xyz, r0, r0.w, c0.w\nmov r1.w, c0.w\n"
                          "mul r1.xyz, r1, c0.y\nmov oC0, r1\n",
                          0.25 + number * 1e-6);
    const char *reason = reason_of(triptych_shader_assemble(device, "new", text, (size_t)length, &made));
    if (!reason)
        reason = reason_of(triptych_set_pixel_shader(device, made));
    if (!reason)
        reason = reason_of(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
    if (!reason)
        reason = reason_of(triptych_finish(device));
    triptych_shader_destroy(device, shader);
    shader = made;
    return reason;
}

double renderer_build_us(void)
{
    struct triptych_routine_info info;
    double us = 0;
    for (unsigned i = 0; triptych_get_routine(device, i, &info); i++)
        us += (double)info.build_ns / 1e3;
    return us;
}

void renderer_close(void)
{
    if (shader)
        triptych_shader_destroy(device, shader);
    shader = NULL;
    player_free(player);
    player = NULL;
    if (device)
        triptych_device_destroy(device);
    device = NULL;
}

/* How rectangles are drawn: the default, or that of the environment. */
static const char *spans(void)
{
    struct setting_values values = {{0}};
    if (setting_read(getenv("TRIPTYCH_SETTINGS"), &values, &error))
        return "unknown";
    return setting_value_name(SETTING_spans, values.of[SETTING_spans]);
}

/* Draws one frame, to describe the lanes and instruction set of the routines that run. */
static const char *describe(char *description)
{
    char lanes[EXECUTION_TEXT];
    struct execution execution = {0};
    const char *reason = renderer_open(workload_find("flat-one"));
    if (!reason)
        reason = renderer_frame(false);
    if (!reason)
        reason = reason_of(triptych_finish(device));
    if (!reason)
        execution_add_device(&execution, device);
    renderer_close();
    snprintf(description, 256, "Triptych %s, spans=%s, engine %s, %s lanes, %s", TRIPTYCH_VERSION, spans(),
             options.engine, execution_lanes(&execution, lanes), execution_set(&execution));
    return reason;
}

const char *renderer_start(int count, char **arguments, char *description)
{
    if (count != 4)
        return "expected ENGINE THREADS FOLDER";
    options.engine = arguments[1];
    options.threads = (unsigned)strtoul(arguments[2], NULL, 10);
    folder = arguments[3];
    return describe(description);
}
