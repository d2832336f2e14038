/* Devices, engines, recordings, formats and statistics. */
#define _GNU_SOURCE /* secure_getenv */
#include "api/api.h"
#include "render/target/depth.h"
#include "engines/list.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char default_engine[] = "specialize";

/* --- Devices and engines -------------------------------------------------------------------------------- */

static enum triptych_result create(const struct triptych_options *options, triptych_device **device,
                                   struct error *error)
{
    const char *name = options && options->engine ? options->engine : default_engine;
    errno = 0;
    const struct engine *engine = engine_named(name, error);
    if (!engine)
        return errno == ENOMEM ? TRIPTYCH_NO_MEMORY : TRIPTYCH_BAD_ARGUMENT;
    struct device_options device_options = {.debug = secure_getenv("TRIPTYCH_DEBUG"),
                                            .settings = secure_getenv("TRIPTYCH_SETTINGS")};
    if (options) {
        device_options.threads = options->threads;
        device_options.cache_bytes = options->cache_bytes;
        device_options.measure = options->measure != 0;
        if (options->debug)
            device_options.debug = options->debug;
        if (options->settings)
            device_options.settings = options->settings;
    }
    enum triptych_result result = device_create(engine, &device_options, device, error);
    if (result == TRIPTYCH_OK && options)
        triptych_set_log(*device, options->log, options->log_user);
    return result;
}

enum triptych_result triptych_device_create(const struct triptych_options *options, triptych_device **device,
                                            char *reason, size_t size)
{
    struct error error;
    error_clear(&error);
    enum triptych_result result = TRIPTYCH_BAD_ARGUMENT;
    if (device) {
        *device = NULL;
        result = create(options, device, &error);
        if (result == TRIPTYCH_OK)
            result = record_from_environment(*device, &error);
        if (result != TRIPTYCH_OK) {
            device_destroy(*device);
            *device = NULL;
        }
    } else {
        error_set(&error, "device is null: expected where to put it");
    }
    if (reason && size)
        snprintf(reason, size, "%s", error.text);
    return result;
}

void triptych_device_destroy(triptych_device *device)
{
    if (device && device_recorder(device))
        record_close(device);
    device_destroy(device);
}

const char *triptych_version(void)
{
    return TRIPTYCH_VERSION;
}

const char *triptych_error(const triptych_device *device)
{
    return device ? device->errors.last.text : "device is null";
}

void triptych_set_log(triptych_device *device, triptych_log_function *log, void *user)
{
    if (device)
        device->log = (struct device_log){log, user};
}

const char *triptych_debug_error(triptych_device *device)
{
    if (!device)
        return "device is null";
    device_debug_error(device, &device->errors.told);
    return device->errors.told.text;
}

const char *triptych_engine_name(unsigned i)
{
    return engine_at(i) ? engine_at(i)->name : NULL;
}

const char *triptych_engine_description(unsigned i)
{
    return engine_at(i) ? engine_at(i)->description : NULL;
}

unsigned triptych_engine_width(unsigned i)
{
    return engine_at(i) ? (unsigned)engine_at(i)->width : 0;
}

const char *triptych_engine_unavailable(unsigned i)
{
    return engine_at(i) ? engine_unavailable(engine_at(i)) : NULL;
}

const char *triptych_get_engine(const triptych_device *device)
{
    return device ? device_engine(device)->name : NULL;
}

/* --- Arguments and results ------------------------------------------------------------------------------ */

static _Thread_local struct error call_error;

struct error *api_begin(triptych_device *device)
{
    error_clear(&call_error);
    return device ? &call_error : NULL;
}

struct error *api_begin_with(triptych_device *device, bool given, const char *name)
{
    if (!api_begin(device) || given)
        return device ? &call_error : NULL;
    error_set(&call_error, "%s is null", name);
    api_finish(device, TRIPTYCH_BAD_ARGUMENT);
    return NULL;
}

struct error *api_begin_with_both(triptych_device *device, bool first, const char *first_name, bool second,
                                  const char *second_name)
{
    return first ? api_begin_with(device, second, second_name) : api_begin_with(device, first, first_name);
}

enum triptych_result api_finish(triptych_device *device, enum triptych_result result)
{
    if (result != TRIPTYCH_OK) {
        device->errors.last = call_error;
        device_report(device, TRIPTYCH_LOG_ERROR, device->errors.last.text);
    }
    return result;
}

enum triptych_result api_changed(triptych_device *device, enum triptych_result result, unsigned parts)
{
    if (result == TRIPTYCH_OK)
        device_state_changed(device, parts);
    return api_finish(device, result);
}

/* --- Recording ------------------------------------------------------------------------------------------ */

enum triptych_result triptych_record_start(triptych_device *device, const char *path)
{
    struct error *error = api_begin_with(device, path, "path");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, record_start(device, path, error));
}

enum triptych_result triptych_record_stop(triptych_device *device)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, record_stop(device, error));
}

/* --- Formats -------------------------------------------------------------------------------------------- */

int triptych_format_is_bytes(enum triptych_surface_format number)
{
    const struct format *format = format_find(number);
    return format && format->storage == STORAGE_RGBA8;
}

static bool known_format(enum triptych_depth_format format)
{
    return (unsigned)format < TRIPTYCH_DEPTH_COUNT;
}

unsigned triptych_depth_bits(enum triptych_depth_format format)
{
    return known_format(format) ? depth_formats[format].depth_bits : 0;
}

unsigned triptych_stencil_bits(enum triptych_depth_format format)
{
    return known_format(format) ? depth_formats[format].stencil_bits : 0;
}

const char *triptych_depth_format_name(enum triptych_depth_format format)
{
    return known_format(format) ? depth_formats[format].name : NULL;
}

/* --- Statistics ----------------------------------------------------------------------------------------- */

void triptych_get_statistics(const triptych_device *device, struct triptych_statistics *statistics)
{
    if (!statistics)
        return;
    memset(statistics, 0, sizeof *statistics);
    if (device)
        device_get_statistics(device, statistics);
}

/* A number that other threads may change; null: 0. */
static uint64_t counter(const uint64_t *number)
{
    return number ? __atomic_load_n(number, __ATOMIC_RELAXED) : 0;
}

int triptych_get_routine(triptych_device *device, unsigned i, struct triptych_routine_info *info)
{
    struct routine routine;
    if (!device || !info)
        return 0;
    device_count_hits(device);
    if (!cache_get(device->cache, i, &routine))
        return 0;
    *info = (struct triptych_routine_info){
        .number = routine.number,
        .unit = unit_name[routine.unit],
        .key = key_print(routine.unit, &routine.key, device->key_text),
        .build_ns = routine.build_ns,
        .hits = routine.hits,
        .code_bytes = routine.code_bytes,
        .parts = routine.parts,
        .spills = routine.spills,
        .fused = routine.fused,
        .carried = routine.carried,
        .run_ns = counter(routine.time ? &routine.time->ns : NULL),
        .elements = counter(routine.time ? &routine.time->elements : NULL),
        .shader = routine.unit == UNIT_VERTEX  ? key_program(routine.key.vertex.shader)
                  : routine.unit == UNIT_PIXEL ? key_program(routine.key.pixel.shader)
                                               : 0,
        .granularity = routine.granularity,
        .lanes = routine_lanes(&routine),
        .instruction_set = routine_instruction_set(&routine),
        .patches = counter(routine.patches ? &routine.patches->writes : NULL),
        .waits = counter(routine.patches ? &routine.patches->waits : NULL),
        .copies = (uint32_t)counter(routine.patches ? &routine.patches->copies : NULL),
    };
    return 1;
}
