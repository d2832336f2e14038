#include "render/device/device_part.h"

#include "machine/code.h"
#include "machine/cpu.h"
#include "debug/debug.h"

#include <assert.h>
#include <stdlib.h>

/* --- Creation and destruction --- */

/* Twice the cache's budget, because routines that queued draws use may exceed it. Two of a draw's largest
 * routines leave at most three holes; one of them is large enough for the third routine. */
static size_t arena_bytes(size_t cache_bytes)
{
    const size_t minimum = (size_t)64 << 20, bytes = 2 * cache_bytes;
    static_assert((64 << 20) >= 5 * ROUTINE_BYTES_MAXIMUM,
                  "two of them and three holes of nearly their size");
    return bytes < minimum ? minimum : bytes;
}

/* A debugger's breakpoints are worth more than names in perf's map. */
static enum code_purpose purpose_of(unsigned listeners)
{
    return listeners >> DEBUG_gdb & 1    ? CODE_TO_DEBUG
           : listeners >> DEBUG_perf & 1 ? CODE_TO_PROFILE
                                         : CODE_TO_RUN;
}

/* Rendering what is recorded makes room for a routine, where there is none. */
static const struct routine *acquire_blit(void *owner, const union key *key, struct error *error)
{
    struct triptych_device *device = owner;
    struct error first = {{0}};
    bool recorded = device_commands(device);
    const struct routine *routine = cache_acquire(device->cache, UNIT_BLIT, key, recorded ? &first : error);
    if (routine || !recorded)
        return routine;
    device_finish(device);
    return cache_acquire(device->cache, UNIT_BLIT, key, error);
}

static void release_blit(void *owner, const struct routine *routine)
{
    const struct triptych_device *device = owner;
    cache_release(device->cache, routine);
}

static enum triptych_result create_parts(struct triptych_device *device, const struct device_options *options,
                                         unsigned listeners, struct error *error)
{
    size_t cache_bytes = options->cache_bytes ? options->cache_bytes : CACHE_BYTES;
    if (!device->engine->without_arena) {
        errno = 0;
        size_t bytes = options->code_bytes ? options->code_bytes : arena_bytes(cache_bytes);
        device->arena = code_create_for(purpose_of(listeners), bytes, NULL, error);
        if (!device->arena)
            return device_refusal(TRIPTYCH_ENGINE_FAILED);
    }
    device->cache = cache_create(device->engine, device->arena, cache_bytes, error);
    device->blits = (struct blits){device, acquire_blit, release_blit};
    if (device->cache && options->measure)
        cache_measure(device->cache);
    if (device->cache)
        cache_debug(device->cache, listeners);
    device->pool = pool_create(options->threads, options->create_thread, error);
    if (device->cache && device->pool)
        device->queue = queue_create(device->pool, options->arena_bytes, error);
    if (device->queue)
        device->queue->measured = options->measure;
    return device->queue ? TRIPTYCH_OK : TRIPTYCH_NO_MEMORY;
}

enum triptych_result device_create(const struct engine *engine, const struct device_options *options,
                                   struct triptych_device **result, struct error *error)
{
    unsigned listeners;
    struct setting_values settings = {{0}};
    *result = NULL;
    if (debug_read(options->debug, &listeners, error) || setting_read(options->settings, &settings, error))
        return TRIPTYCH_BAD_ARGUMENT;
    if (options->cache_bytes > CACHE_BYTES_MAXIMUM) {
        error_set(error, "cache of %zu bytes: expected at most %d", options->cache_bytes,
                  CACHE_BYTES_MAXIMUM);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (cpu_native_error()) {
        error_set(error, "%s", cpu_native_error());
        return TRIPTYCH_BAD_ARGUMENT;
    }
    errno = 0;
    const char *reason = engine_unavailable(engine); /* which may have ended when it is queried again */
    if (reason) {
        error_set(error, "engine %s: %s", engine->name, reason);
        return device_refusal(TRIPTYCH_ENGINE_FAILED);
    }
    struct triptych_device *device = calloc(1, sizeof *device);
    if (!device) {
        error_set(error, "out of memory for a device");
        return TRIPTYCH_NO_MEMORY;
    }
    device->engine = engine;
    device->binding.target = device->binding.main = &device->binding.none;
    device_derived_initialize(&device->derived);
    device_routines_initialize(&device->routines, device->derived.now->in_use);
    debug_open(listeners, &device->errors.debug);
    state_initialize(&device->state);
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        device->state.registers[stage] = &device->registers[stage];
    enum triptych_result status = create_parts(device, options, listeners, error);
    if (status == TRIPTYCH_OK) {
        device_set_settings(device, &settings);
        *result = device;
    } else {
        device_destroy(device);
    }
    return status;
}

void device_destroy(struct triptych_device *device)
{
    if (!device)
        return;
    if (device->queue)
        device_forget(device);
    device_free_palettes(device->derived.palettes);
    queue_destroy(device->queue);
    pool_destroy(device->pool);
    cache_destroy(device->cache);
    code_destroy(device->arena);
    device_free_targets(device);
    transient_destroy(&device->transient);
    queries_destroy(&device->queries);
    for (struct triptych_buffer *buffer = device->resources.buffers, *next; buffer; buffer = next) {
        next = buffer->next;
        buffer_destroy(buffer);
    }
    for (struct triptych_texture *texture = device->resources.textures, *next; texture; texture = next) {
        next = texture->next;
        surface_free_attachments(texture);
        texture_destroy(texture);
    }
    for (struct triptych_image *image = device->resources.images, *next; image; image = next) {
        next = image->next;
        attachment_release(image->attachment);
        free(image);
    }
    device_free_shaders(device);
    device_free_storage(device);
    free(device);
}

void device_debug_error(struct triptych_device *device, struct error *error)
{
    *error = device->errors.debug;
    if (!error->text[0])
        cache_debug_error(device->cache, error);
}

/* --- The target --- */

enum triptych_result device_has_target(const struct triptych_device *device, struct error *error)
{
    if (device->binding.target->width)
        return TRIPTYCH_OK;
    error_set(error, "no target: expected set_target first");
    return TRIPTYCH_BAD_CALL;
}

static enum triptych_result check_color_formats(const struct triptych_target_description *description,
                                                struct error *error)
{
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct format *format = target_format(description, t);
        if (format && !(format->roles & ROLE_TARGET)) {
            error_set(error, "format %s of colour target %u: expected one that can be a target", format->name,
                      t);
            return TRIPTYCH_UNSUPPORTED;
        }
        if (!format && description->color_format[t]) {
            error_set(error, "format %u of colour target %u: expected one of Direct3D 9's",
                      (unsigned)description->color_format[t], t);
            return TRIPTYCH_BAD_ARGUMENT;
        }
    }
    return TRIPTYCH_OK;
}

enum triptych_result device_check_target(const struct triptych_target_description *description,
                                         struct error *error)
{
    unsigned width = description->width, height = description->height;
    if (!width || !height || width > TARGET_SIZE_MAXIMUM || height > TARGET_SIZE_MAXIMUM) {
        error_set(error, "target of %u x %u pixels: expected 1 to %d a side", width, height,
                  TARGET_SIZE_MAXIMUM);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if ((unsigned)description->depth_format >= TRIPTYCH_DEPTH_COUNT) {
        error_set(error, "depth format %u: expected 0 to %u", (unsigned)description->depth_format,
                  TRIPTYCH_DEPTH_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (samples_exponent(description->samples) < 0) {
        error_set(error, "%u samples per pixel: expected 1, 2, 4 or 8", description->samples);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    for (unsigned t = 1; t < TARGETS && description->samples > 1; t++)
        if (description->color_format[t]) {
            error_set(error, "colour target %u: expected only one with several samples per pixel", t);
            return TRIPTYCH_BAD_ARGUMENT;
        }
    return check_color_formats(description, error);
}

/* --- Textures --- */

enum triptych_result device_texture_create(struct triptych_device *device,
                                           const struct triptych_texture_description *description,
                                           struct triptych_texture **texture, struct error *error)
{
    enum triptych_result result = texture_create(description, device->resources.tiled, texture, error);
    if (result != TRIPTYCH_OK)
        return result;
    (*texture)->epoch = (*texture)->written = UINT64_MAX;
    (*texture)->next = device->resources.textures;
    device->resources.textures = *texture;
    return TRIPTYCH_OK;
}

enum triptych_result device_texture_update(struct triptych_device *device, struct triptych_texture *texture,
                                           unsigned face, unsigned level, const struct triptych_box *box,
                                           const void *data, size_t row_pitch, size_t slice_pitch,
                                           struct error *error)
{
    enum triptych_result result =
        texture_check_update(texture, face, level, box, row_pitch, slice_pitch, error);
    if (result != TRIPTYCH_OK)
        return result;
    struct texture_span span = texture_level_span(texture, face, level);
    if (box)
        span.begin = span.end;
    device_change_texture(device, texture, span);
    texture_update(texture, face, level, box, data, row_pitch, slice_pitch);
    device_load_texture(device, texture, level, level);
    return TRIPTYCH_OK;
}

enum triptych_result device_texture_read(struct triptych_device *device, struct triptych_texture *texture,
                                         unsigned face, unsigned level, const struct triptych_box *box,
                                         void *data, size_t row_pitch, size_t slice_pitch,
                                         struct error *error)
{
    enum triptych_result result =
        texture_check_update(texture, face, level, box, row_pitch, slice_pitch, error);
    if (result != TRIPTYCH_OK)
        return result;
    device_store_texture(device, texture);
    texture_read(texture, face, level, box, data, row_pitch, slice_pitch);
    return TRIPTYCH_OK;
}

enum triptych_result device_texture_generate_mips(struct triptych_device *device,
                                                  struct triptych_texture *texture, struct error *error)
{
    struct texture_mips mips;
    errno = 0;
    if (texture_prepare_mips(texture, &device->blits, &mips, error))
        return device_refusal(TRIPTYCH_ENGINE_FAILED);
    device_change_texture(device, texture, texture_mip_span(texture));
    texture_generate_mips(texture, &mips);
    texture_drop_mips(&device->blits, &mips);
    device_load_texture(device, texture, 1, TEXTURE_LEVELS);
    return TRIPTYCH_OK;
}

/* --- For tools --- */

void device_get_statistics(const struct triptych_device *device, struct triptych_statistics *statistics)
{
    const struct queue_statistics *queue = &device->queue->statistics;
    struct cache_statistics cache = cache_statistics(device->cache);
    for (uint32_t i = 0; i < device->routines.count; i++)
        cache.hits += device->routines.held[i].hits;
    *statistics = (struct triptych_statistics){
        .draws = device->counts.draws,
        .triangles = device->counts.triangles,
        .vertices_shaded = queue->vertices_shaded,
        .triangles_set_up = queue->triangles_set_up,
        .triangles_visible = queue->triangles_visible,
        .pixels_shaded = queue->pixels_shaded,
        .cache_hits = cache.hits,
        .cache_misses = cache.misses,
        .cache_evictions = cache.evictions,
        .vertex_ns = queue->geometry_ns,
        .pixel_ns = queue->tiles_ns,
    };
}

void device_count_hits(struct triptych_device *device)
{
    device_routines_count_hits(&device->routines, device->cache);
}

void device_on_draw(struct triptych_device *device, device_draw_callback *callback, void *user)
{
    device->hook.on_draw = callback;
    device->hook.user = user;
}

const struct engine *device_engine(const struct triptych_device *device)
{
    return device->engine;
}
