#include "statistics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { SECOND_NS = 1000000000, COUNTED_FRAME = 64, MOST_ROUTINES = 4096 };

static uint64_t clock_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * SECOND_NS + (uint64_t)now.tv_nsec;
}

static double milliseconds(uint64_t ns)
{
    return (double)ns / 1e6;
}

void front_statistics_begin(struct front_statistics *statistics)
{
    memset(statistics, 0, sizeof *statistics);
    statistics->path = getenv("TRIPTYCH_STATISTICS");
    if (statistics->path && !*statistics->path)
        statistics->path = NULL;
    if (!statistics->path)
        return;
    statistics->hits = malloc(MOST_ROUTINES * sizeof *statistics->hits);
    statistics->created_ns = clock_ns();
}

static void remember_hits(struct front_statistics *statistics, triptych_device *renderer)
{
    struct triptych_routine_info routine;
    for (statistics->known = 0;
         statistics->known < MOST_ROUTINES && triptych_get_routine(renderer, statistics->known, &routine);)
        statistics->hits[statistics->known++] = routine.hits;
}

/* A routine that was not known before the frame was built for it. */
static void count_used(struct front_statistics *statistics, triptych_device *renderer)
{
    struct triptych_routine_info routine;
    for (unsigned i = 0; i < MOST_ROUTINES && triptych_get_routine(renderer, i, &routine); i++)
        statistics->used += i >= statistics->known || routine.hits != statistics->hits[i];
    statistics->counted++;
}

static void count_routines(struct front_statistics *statistics, triptych_device *renderer)
{
    if (!statistics->hits)
        return;
    if (statistics->frames % COUNTED_FRAME == 1)
        remember_hits(statistics, renderer);
    else if (statistics->frames % COUNTED_FRAME == 2)
        count_used(statistics, renderer);
}

static void write_routines(FILE *file, triptych_device *renderer)
{
    static const char *const units[] = {"vertex", "setup", "pixel"};
    unsigned count[3] = {0};
    uint64_t build_ns = 0;
    struct triptych_routine_info routine;
    for (unsigned i = 0; triptych_get_routine(renderer, i, &routine); i++) {
        build_ns += routine.build_ns;
        for (unsigned unit = 0; unit < 3; unit++)
            count[unit] += !strcmp(routine.unit, units[unit]);
    }
    fprintf(file, " \"routines\": {\"vertex\": %u, \"setup\": %u, \"pixel\": %u},\n \"build_ms\": %.3f\n}\n",
            count[0], count[1], count[2], milliseconds(build_ns));
}

static void write_numbers(FILE *file, const struct front_statistics *statistics, triptych_device *renderer)
{
    struct triptych_statistics drawn;
    triptych_get_statistics(renderer, &drawn);
    fprintf(file, "{\n \"engine\": \"%s\",\n \"frames\": %llu,\n", triptych_get_engine(renderer),
            (unsigned long long)statistics->frames);
    fprintf(file, " \"first_frame_ms\": %.3f,\n \"longest_frame_ms\": %.3f,\n \"total_ms\": %.3f,\n",
            milliseconds(statistics->first_ns - statistics->created_ns), milliseconds(statistics->longest_ns),
            milliseconds(statistics->last_ns - statistics->first_ns));
    fprintf(file, " \"draws\": %llu,\n \"triangles\": %llu,\n", (unsigned long long)drawn.draws,
            (unsigned long long)drawn.triangles);
    fprintf(file, " \"cache_hits\": %llu,\n \"cache_misses\": %llu,\n \"cache_evictions\": %llu,\n",
            (unsigned long long)drawn.cache_hits, (unsigned long long)drawn.cache_misses,
            (unsigned long long)drawn.cache_evictions);
    const uint64_t counted = statistics->counted ? statistics->counted : 1;
    fprintf(file, " \"routines_of_a_frame\": %.1f,\n", (double)statistics->used / (double)counted);
    write_routines(file, renderer);
}

/* A file that cannot be written must not disturb the program that is measured: it is reported once. */
static void write_file(struct front_statistics *statistics, triptych_device *renderer)
{
    FILE *file = fopen(statistics->path, "w");
    if (!file) {
        fprintf(stderr, "triptych: TRIPTYCH_STATISTICS: %s cannot be written\n", statistics->path);
        statistics->path = NULL;
        return;
    }
    write_numbers(file, statistics, renderer);
    fclose(file);
}

void front_statistics_frame(struct front_statistics *statistics, triptych_device *renderer)
{
    if (!statistics->path)
        return;
    const uint64_t now = clock_ns();
    if (!statistics->frames++)
        statistics->first_ns = statistics->written_ns = now;
    else if (now - statistics->last_ns > statistics->longest_ns)
        statistics->longest_ns = now - statistics->last_ns;
    count_routines(statistics, renderer);
    if (now - statistics->written_ns >= SECOND_NS) {
        write_file(statistics, renderer);
        statistics->written_ns = now;
    }
    /* The time of counting and writing belongs to no frame. */
    statistics->last_ns = clock_ns();
}

void front_statistics_end(struct front_statistics *statistics, triptych_device *renderer)
{
    if (statistics->path && statistics->frames)
        write_file(statistics, renderer);
    free(statistics->hits);
    statistics->hits = NULL;
    statistics->path = NULL;
}
