#define _GNU_SOURCE /* secure_getenv */
#include "capture/record_part.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Records -------------------------------------------------------------------------------------------- */

void record_call(struct triptych_device *device, const struct call *call)
{
    struct recorder *recorder = device_recorder(device);
    if (!recorder)
        return;
    record_write_call(&recorder->write, call);
    bool draws = call_row(call->type)->traits & CALL_DRAWS;
    recorder->drawn = call->type != CALL_FRAME && (recorder->drawn || draws);
    recorder->waited = recorder->waited && !draws;
}

void record_memory_is_short(struct triptych_device *device)
{
    record_write_fail(&device_recorder(device)->write, "not enough memory");
}

static uint32_t take_number(struct recorder *recorder)
{
    if (recorder->free_count)
        return recorder->free_numbers[--recorder->free_count];
    if (recorder->next < NO_RESOURCE)
        return recorder->next++;
    record_write_fail(&recorder->write, "more than 65536 resources at a time");
    return 0;
}

uint32_t record_define(struct triptych_device *device, const struct resource *resource)
{
    struct recorder *recorder = device_recorder(device);
    uint32_t number = take_number(recorder);
    record_write_definition(&recorder->write, number, resource);
    return number;
}

void record_release(struct triptych_device *device, uint32_t number)
{
    struct recorder *recorder = device_recorder(device);
    record_call(device, &(struct call){.type = CALL_RELEASE, .resource = number});
    if (recorder->free_count == recorder->free_capacity) {
        uint32_t capacity = 2 * recorder->free_capacity + 64;
        uint32_t *larger = realloc(recorder->free_numbers, capacity * sizeof *larger);
        if (!larger) {
            record_memory_is_short(device);
            return;
        }
        recorder->free_numbers = larger;
        recorder->free_capacity = capacity;
    }
    recorder->free_numbers[recorder->free_count++] = number;
}

uint32_t record_bytes(struct triptych_device *device, const void *data, size_t bytes)
{
    struct resource resource = {.type = RESOURCE_BUFFER, .value_type = VALUE_BYTES, .vertex_bytes = bytes};
    resource.vertices = (uint8_t *)(uintptr_t)data;
    return record_define(device, &resource);
}

/* --- Beginning and end ---------------------------------------------------------------------------------- */

enum triptych_result record_start(struct triptych_device *device, const char *path, struct error *error)
{
    if (device_recorder(device)) {
        error_set(error, "%s: calls are recorded already, expected record_stop before another recording",
                  path);
        return TRIPTYCH_BAD_CALL;
    }
    struct recorder *recorder = calloc(1, sizeof *recorder);
    if (!recorder) {
        error_set(error, "%s: out of memory for a recording", path);
        return TRIPTYCH_NO_MEMORY;
    }
    errno = 0;
    if (chunk_open(&recorder->write.chunks, path, true, error)) {
        free(recorder);
        return device_refusal(TRIPTYCH_BAD_ARGUMENT);
    }
    device_set_recorder(device, recorder);
    record_beginning(device);
    return TRIPTYCH_OK;
}

/* Names are "PATH", then "PATH-2.EXTENSION" and so on. */
enum triptych_result record_from_environment(struct triptych_device *device, struct error *error)
{
    static atomic_uint devices;
    const char *path = secure_getenv("TRIPTYCH_RECORD");
    if (!path || !*path)
        return TRIPTYCH_OK;
    unsigned number = atomic_fetch_add(&devices, 1) + 1;
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    size_t stem = dot ? (size_t)(dot - path) : strlen(path), size = strlen(path) + 16;
    char *numbered = malloc(size);
    if (!numbered) {
        error_set(error, "%s: out of memory for a recording", path);
        return TRIPTYCH_NO_MEMORY;
    }
    snprintf(numbered, size, "%.*s-%u%s", (int)stem, path, number, path + stem);
    enum triptych_result result = record_start(device, number > 1 ? numbered : path, error);
    if (result == TRIPTYCH_OK)
        device_recorder(device)->from_environment = true;
    free(numbered);
    return result;
}

/* Reports an event. A program that is recorded by the environment may have no log function; then the standard
 * error output receives the event. */
static void report(const struct triptych_device *device, bool from_environment, enum triptych_log_level level,
                   const char *text)
{
    device_report(device, level, text);
    if (from_environment && !device_has_log(device))
        fprintf(stderr, "triptych: %s\n", text);
}

static void warn_of_frames(const struct triptych_device *device)
{
    const struct recorder *recorder = device_recorder(device);
    char text[ERROR_CAPACITY];
    if (recorder->framed || recorder->waits < 2)
        return;
    snprintf(text, sizeof text,
             "the recording is one frame, although pixels were read or finished %u times: expected "
             "triptych_end_frame after each frame",
             recorder->waits);
    report(device, recorder->from_environment, TRIPTYCH_LOG_WARNING, text);
}

enum triptych_result record_stop(struct triptych_device *device, struct error *error)
{
    struct recorder *recorder = device_recorder(device);
    if (!recorder) {
        error_set(error, "no calls are recorded: expected record_start first");
        return TRIPTYCH_BAD_CALL;
    }
    warn_of_frames(device);
    if (recorder->drawn)
        record_frame(device);
    record_open_queries(device, CALL_END_QUERY);
    device_set_recorder(device, NULL);
    int result = chunk_close(&recorder->write.chunks, error);
    free(recorder->write.codec.data);
    free(recorder->free_numbers);
    free(recorder);
    return result ? TRIPTYCH_FILE_FAILED : TRIPTYCH_OK;
}

void record_close(struct triptych_device *device)
{
    bool from_environment = device_recorder(device)->from_environment;
    struct error error;
    error_clear(&error);
    if (record_stop(device, &error) != TRIPTYCH_OK)
        report(device, from_environment, TRIPTYCH_LOG_ERROR, error.text);
}
