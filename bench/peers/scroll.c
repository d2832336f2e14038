/* The cost of each frame of a stream: pixels that are shaded, pixels that are moved, and the time.
 *
 * scroll [STREAM [ENGINE]]    bench/streams/pages/page-scroll.trib
 *
 * The stream is played from its first frame to its last one PASSES times on one thread, each time on the
 * same device, so frames of all kinds take turns. The times are medians, in microseconds, and as a part of
 * the last frame's, which draws the whole page. With --check it prints only the counts, which are the same
 * in each run. */
#include "base/clock.h"
#include "command/stream/stream.h"
#include "triptych.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PASSES = 15, FRAMES = 64 };

struct frame {
    uint64_t shaded, moved;
    double time[PASSES];
};

static struct frame frames[FRAMES];
static triptych_device *device;

static void fail(const char *reason)
{
    fprintf(stderr, "scroll: %s\n", reason);
    exit(2);
}

static uint64_t pixels_shaded(void)
{
    struct triptych_statistics statistics;
    triptych_get_statistics(device, &statistics);
    return statistics.pixels_shaded;
}

/* Pixels that copies within the frame write. */
static uint64_t pixels_moved(const struct stream *stream, uint32_t frame)
{
    uint64_t moved = 0;
    for (uint32_t i = stream->frames[frame]; i < stream->frames[frame + 1]; i++) {
        const struct call *call = stream->calls + stream->executed[i];
        if (call->type == CALL_COPY)
            moved += (uint64_t)call->copy.part[1].width * call->copy.part[1].height;
    }
    return moved;
}

static void play(const struct stream *stream, struct player *player, int pass)
{
    struct error error;
    for (uint32_t i = 0; i < stream->frame_count; i++) {
        uint64_t before = pixels_shaded();
        double start = clock_seconds_of(CLOCK_MONOTONIC);
        if (player_frame(player, i, &error) || triptych_finish(device))
            fail(error.text);
        frames[i].time[pass] = (clock_seconds_of(CLOCK_MONOTONIC) - start) * 1e6;
        frames[i].shaded = pixels_shaded() - before;
        frames[i].moved = pixels_moved(stream, i);
    }
}

static int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static void print(uint32_t count, bool counts_only)
{
    for (uint32_t i = 0; i < count; i++)
        qsort(frames[i].time, PASSES, sizeof *frames[i].time, ascending);
    printf("frame     shaded      moved%s\n", counts_only ? "" : "         us  of the last frame's");
    for (uint32_t i = 0; i < count; i++) {
        const struct frame *f = frames + i;
        printf("%5u %10llu %10llu", i, (unsigned long long)f->shaded, (unsigned long long)f->moved);
        if (!counts_only)
            printf(" %10.0f %6.3f", f->time[PASSES / 2],
                   f->time[PASSES / 2] / frames[count - 1].time[PASSES / 2]);
        putchar('\n');
    }
}

int main(int count, char **arguments)
{
    bool counts_only = count > 1 && !strcmp(arguments[1], "--check");
    int first = counts_only ? 2 : 1;
    const char *path = count > first ? arguments[first] : "bench/streams/pages/page-scroll.trib";
    const struct triptych_options options = {.engine = count > first + 1 ? arguments[first + 1] : NULL,
                                             .threads = 1};
    struct stream *stream;
    struct player *player;
    struct error error;
    char reason[512];
    if (stream_read(path, &stream, &error))
        fail(error.text);
    if (stream->frame_count > FRAMES)
        fail("a stream of more frames than 64");
    if (triptych_device_create(&options, &device, reason, sizeof reason))
        fail(reason);
    if (stream_prepare(stream, device, &player, &error))
        fail(error.text);
    for (int pass = 0; pass < (counts_only ? 1 : PASSES); pass++)
        play(stream, player, pass);
    print(stream->frame_count, counts_only);
    player_free(player);
    triptych_device_destroy(device);
    stream_free(stream);
    return 0;
}
