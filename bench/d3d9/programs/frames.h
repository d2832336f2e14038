/* The arguments of the programs for Windows, and the times of their frames:
 *
 *   PROGRAM picture N    draws frame N again and again, until the process is ended, and prints "@picture"
 *                        after it was presented three times
 *   PROGRAM speed N      draws the frames 0 to N - 1 and prints
 *                        "@frames N start MS first MS longest MS total MS"
 *
 * start: from the first call to the first frame; first: the first frame; longest and total: of the others.
 * A program's picture depends on the number of the frame only, never on the time. */
#ifndef FRAMES_H
#define FRAMES_H
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

struct frames {
    int picture; /* nonzero: only frame `last` */
    long last, drawn;
    double begun, previous, start, first, longest, total; /* milliseconds */
};

static inline double frames_clock(void)
{
    LARGE_INTEGER now, frequency;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&frequency);
    return 1000.0 * (double)now.QuadPart / (double)frequency.QuadPart;
}

static inline struct frames frames_begin(int count, char **arguments)
{
    struct frames frames;
    memset(&frames, 0, sizeof frames);
    frames.picture = count > 1 && !strcmp(arguments[1], "picture");
    frames.last = count > 2 ? atol(arguments[2]) : 60;
    frames.begun = frames_clock();
    return frames;
}

static inline void frames_measure(struct frames *frames, double now)
{
    const double duration = now - frames->previous;
    if (frames->drawn == 1) {
        frames->first = duration;
        return;
    }
    frames->total += duration;
    if (duration > frames->longest)
        frames->longest = duration;
}

/* Called before each frame and after the last one. Returns the number of the frame to draw, or -1. */
static inline long frames_next(struct frames *frames)
{
    const double now = frames_clock();
    if (frames->drawn)
        frames_measure(frames, now);
    else
        frames->start = now - frames->begun;
    frames->previous = now;
    if (frames->picture) {
        if (frames->drawn++ == 3) {
            printf("@picture\n");
            fflush(stdout);
        }
        return frames->last;
    }
    if (frames->drawn < frames->last)
        return frames->drawn++;
    printf("@frames %ld start %.3f first %.3f longest %.3f total %.3f\n", frames->last, frames->start,
           frames->first, frames->longest, frames->total);
    fflush(stdout);
    return -1;
}

#endif
