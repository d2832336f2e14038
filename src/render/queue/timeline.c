#include "render/queue/timeline.h"

#include "base/clock.h"

#include <stdlib.h>

/* Room for one more element. Returns false if memory is refused. */
static bool grow(void **array, uint32_t count, uint32_t *capacity, size_t element_bytes)
{
    if (count < *capacity)
        return true;
    uint32_t larger = *capacity ? 2 * *capacity : 1024;
    void *grown = realloc(*array, larger * element_bytes);
    if (!grown)
        return false;
    *array = grown;
    *capacity = larger;
    return true;
}

static bool has_room(struct timeline *timeline)
{
    void *part = timeline->part, *task = timeline->task_ns;
    bool room = grow(&part, timeline->parts, &timeline->part_capacity, sizeof *timeline->part) &&
                grow(&task, timeline->tasks, &timeline->task_capacity, sizeof *timeline->task_ns);
    timeline->part = part;
    timeline->task_ns = task;
    timeline->incomplete |= !room;
    return room;
}

void timeline_begin(struct timeline *timeline, enum timeline_kind kind, uint64_t estimate_ns)
{
    if (!timeline || !has_room(timeline))
        return;
    timeline->part[timeline->parts++] =
        (struct timeline_part){.kind = kind, .first = timeline->tasks, .estimate_ns = estimate_ns};
    timeline->mark = timeline->begun = clock_ns();
}

void timeline_task(struct timeline *timeline)
{
    if (!timeline || !timeline->parts || timeline->incomplete || !has_room(timeline))
        return;
    uint64_t now = clock_ns(), ns = now - timeline->mark;
    timeline->task_ns[timeline->tasks++] = ns < UINT32_MAX ? (uint32_t)ns : UINT32_MAX;
    timeline->part[timeline->parts - 1].tasks++;
    timeline->mark = now;
}

void timeline_end(struct timeline *timeline)
{
    if (timeline && timeline->parts && !timeline->incomplete)
        timeline->part[timeline->parts - 1].ns = clock_ns() - timeline->begun;
}

void timeline_restart(struct timeline *timeline)
{
    timeline->parts = timeline->tasks = 0;
    timeline->incomplete = false;
    timeline_begin(timeline, TIMELINE_SUBMIT, 0);
}

void timeline_free(struct timeline *timeline)
{
    free(timeline->part);
    free(timeline->task_ns);
    *timeline = (struct timeline){0};
}

/* --- Medians --- */

static bool is_alike(const struct timeline *a, const struct timeline *b)
{
    bool alike = a->parts == b->parts && a->tasks == b->tasks && !a->incomplete && !b->incomplete;
    for (uint32_t i = 0; i < a->parts && alike; i++)
        alike = a->part[i].kind == b->part[i].kind && a->part[i].tasks == b->part[i].tasks;
    return alike;
}

static int compare(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static uint64_t median(uint64_t *values, unsigned count)
{
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

static void take_medians(struct timeline *samples, unsigned count, uint64_t *values)
{
    for (uint32_t i = 0; i < samples->parts; i++) {
        for (unsigned n = 0; n < count; n++)
            values[n] = samples[n].part[i].ns;
        samples->part[i].ns = median(values, count);
    }
    for (uint32_t i = 0; i < samples->tasks; i++) {
        for (unsigned n = 0; n < count; n++)
            values[n] = samples[n].task_ns[i];
        samples->task_ns[i] = (uint32_t)median(values, count);
    }
}

bool timeline_take_medians(struct timeline *samples, unsigned count)
{
    uint64_t *values = malloc(count * sizeof *values);
    bool alike = values;
    for (unsigned n = 1; n < count && alike; n++)
        alike = is_alike(samples, samples + n);
    if (alike)
        take_medians(samples, count, values);
    free(values);
    return alike;
}
