#include "base/clock.h"
#include "peer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLD_MAXIMUM = 9, BUILDS_MAXIMUM = 200, READING_MOST = 5 };

static const double cold_seconds = 0.3; /* in all, if one time took less */

static const struct workload *workload;    /* the open one */
static enum { NOTHING, LESS, FULL } drawn; /* the last frame; NOTHING: the target has other contents */
static uint32_t pixels[PIXELS];

/* Seconds of wall time, and of processor time of this process. */
struct span {
    double time, work;
};

static struct span now(void)
{
    return (struct span){clock_seconds_of(CLOCK_MONOTONIC), clock_seconds_of(CLOCK_PROCESS_CPUTIME_ID)};
}

static struct span since(struct span start)
{
    struct span end = now();
    return (struct span){end.time - start.time, end.work - start.work};
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, unsigned count)
{
    qsort(values, count, sizeof *values, ascending);
    return (values[(count - 1) / 2] + values[count / 2]) / 2;
}

static const char *draw(bool less)
{
    drawn = less ? LESS : FULL;
    return renderer_frame(less);
}

/* --- The first frame ------------------------------------------------------------------------------------ */

/* Opens the workload and draws some of its pixels twice. */
static const char *cold_once(const struct workload *wanted, struct span *cold, double *build_us)
{
    const char *reason = renderer_open(wanted);
    if (!reason)
        reason = renderer_limit(true);
    struct span start = now();
    if (!reason)
        reason = renderer_frame(true);
    struct span first = since(start);
    if (reason)
        return reason;
    *build_us = renderer_build_us();
    start = now();
    reason = renderer_frame(true);
    struct span second = since(start);
    *cold = (struct span){first.time - second.time, first.work - second.work};
    return reason ? reason : renderer_limit(false);
}

static const char *open_workload(const struct workload *wanted, char *answer, size_t capacity)
{
    double ms[COLD_MAXIMUM], work[COLD_MAXIMUM], build_us[COLD_MAXIMUM];
    struct span begun = now(), cold;
    const char *reason = NULL;
    unsigned count = 0;
    do {
        renderer_close();
        reason = cold_once(wanted, &cold, build_us + count);
        if (reason && !strcmp(reason, "none"))
            return snprintf(answer, capacity, "none"), NULL;
        if (reason)
            return reason;
        ms[count] = cold.time * 1e3;
        work[count++] = cold.work * 1e3;
    } while (count < COLD_MAXIMUM && since(begun).time < cold_seconds);
    struct span start = now();
    if ((reason = draw(true)))
        return reason;
    workload = wanted;
    snprintf(answer, capacity, "%.6f %.6f %.6f %.3f", median(ms, count), median(work, count),
             since(start).time * 1e3, median(build_us, count));
    return NULL;
}

/* --- Measuring ------------------------------------------------------------------------------------------ */

/* Measures the time of a frame. The first frame is not counted unless it is long, because the caches contain
 * the data of another renderer. */
static const char *measure_frames(bool less, double seconds, struct span *each)
{
    unsigned count = 0;
    bool warm = false;
    struct span start = now(), passed;
    do {
        const char *reason = draw(less);
        if (reason)
            return reason;
        count++;
        passed = since(start);
        if (!warm && passed.time < seconds / 2) {
            start = now();
            passed = (struct span){0, 0};
            count = 0;
        }
        warm = true;
    } while (passed.time < seconds);
    *each = (struct span){passed.time / count, passed.work / count};
    return NULL;
}

/* Measures the time to read a frame. Each time a new frame is drawn, whose time is not counted. */
static const char *measure_reading(double seconds, struct span *each)
{
    unsigned count = 0;
    struct span sum = {0, 0}, begun = now();
    do {
        bool upward;
        const char *reason = renderer_frame(true);
        struct span start = now();
        if (!reason)
            reason = renderer_read(pixels, &upward);
        struct span passed = since(start);
        if (reason)
            return reason;
        sum = (struct span){sum.time + passed.time, sum.work + passed.work};
        count++;
    } while (sum.time < seconds && since(begun).time < READING_MOST * seconds);
    *each = (struct span){sum.time / count, sum.work / count};
    return NULL;
}

static const char *measure_builds(double seconds, struct span *each)
{
    static unsigned number;
    double times[BUILDS_MAXIMUM], work[BUILDS_MAXIMUM];
    struct span begun = now();
    unsigned count = 0;
    do {
        struct span start = now();
        drawn = NOTHING;
        const char *reason = renderer_build(++number);
        if (reason)
            return reason;
        struct span passed = since(start);
        times[count] = passed.time;
        work[count++] = passed.work;
    } while (count < BUILDS_MAXIMUM && (count < 3 || since(begun).time < seconds));
    *each = (struct span){median(times, count), median(work, count)};
    return NULL;
}

static const char *measure(bool less, double seconds, char *answer, size_t capacity)
{
    struct span each = {0, 0};
    const char *reason = NULL;
    if (workload->kind == READ)
        reason = measure_reading(seconds, &each);
    else if (workload->kind == BUILD)
        reason = measure_builds(seconds, &each);
    else
        reason = measure_frames(less, seconds, &each);
    snprintf(answer, capacity, "%.9g %.9g", each.time * 1e3, each.work * 1e3);
    return reason;
}

static const char *write_image(bool less, const char *path)
{
    bool upward = false;
    const char *reason = drawn == (less ? LESS : FULL) ? NULL : draw(less);
    if (!reason)
        reason = renderer_read(pixels, &upward);
    if (reason)
        return reason;
    FILE *file = fopen(path, "wb");
    if (!file)
        return "the picture's file cannot be made";
    size_t rows = 0;
    for (unsigned y = 0; y < SIDE; y++)
        rows += fwrite(pixels + (size_t)(upward ? SIDE - 1 - y : y) * SIDE, SIDE * sizeof *pixels, 1, file);
    return fclose(file) || rows != SIDE ? "the picture's file cannot be written" : NULL;
}

/* --- Commands ------------------------------------------------------------------------------------------- */

static const char *obey(char *line, const char *description, char *answer, size_t capacity)
{
    char word[16] = "", first[512] = "", second[512] = "";
    sscanf(line, "%15s %511s %511s", word, first, second);
    bool less = !strcmp(first, "less");
    if (!strcmp(word, "hello")) {
        snprintf(answer, capacity, "%s", description);
        return NULL;
    }
    if (!strcmp(word, "open")) {
        const struct workload *wanted = workload_find(first);
        return wanted ? open_workload(wanted, answer, capacity) : "no such workload";
    }
    if (!strcmp(word, "close")) {
        renderer_close();
        workload = NULL;
        return NULL;
    }
    if (!workload)
        return "nothing is open";
    if (!strcmp(word, "measure"))
        return measure(less, strtod(second, NULL), answer, capacity);
    return strcmp(word, "image") ? "no such command" : write_image(less, second);
}

int main(int count, char **arguments)
{
    char description[256] = "", line[1200], answer[512];
    const char *reason = renderer_start(count, arguments, description);
    if (reason) {
        printf("error %s\n", reason);
        return 2;
    }
    while (fgets(line, sizeof line, stdin)) {
        *answer = 0;
        reason = obey(line, description, answer, sizeof answer);
        printf("%s %s\n", reason ? "error" : "ok", reason ? reason : answer);
        fflush(stdout);
    }
    return 0;
}
