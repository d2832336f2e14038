#include "command/fuzz/run.h"

#include "render/device/device.h"
#include "render/texture/texture.h"
#include "command/stream/stream.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const outcome_name[OUTCOME_COUNT] = {
    [OUTCOME_SAME] = "same",       [OUTCOME_REFUSED] = "refused",
    [OUTCOME_LIMITED] = "limited", [OUTCOME_DIFFERENT] = "different",
    [OUTCOME_FAILED] = "failed",   [OUTCOME_CRASHED] = "crashed",
    [OUTCOME_HUNG] = "hung"};

/* Vertices that are processed without a draw after each frame: those that every case has. */
enum { PROCESSED = 3, CACHE_BYTES_FUZZ = 4 << 20 };

struct runner {
    struct runner_options options;
    struct triptych_device *device[RUNNER_ENGINES];
    struct player *player[RUNNER_ENGINES]; /* of the case */
    uint32_t *words; /* what the reference drew, frame after frame: tiles, depths, texels, counts of queries,
                        processed vertices, in that order */
    size_t capacity, count;
    enum triptych_result result; /* of processing the vertices */
    struct triptych_processed_vertex processed[PROCESSED];
};

static enum outcome find(struct finding *finding, enum outcome outcome, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static enum outcome find(struct finding *finding, enum outcome outcome, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(finding->what, sizeof finding->what, format, arguments);
    va_end(arguments);
    return finding->outcome = outcome;
}

/* --- Devices -------------------------------------------------------------------------------------------- */

struct runner *runner_create(const struct runner_options *options, struct error *error)
{
    struct runner *runner = calloc(1, sizeof *runner);
    struct device_options device = {.cache_bytes = CACHE_BYTES_FUZZ};
    if (!runner) {
        error_set(error, "out of memory for a runner");
        return NULL;
    }
    runner->options = *options;
    for (unsigned i = 0; i < options->threads; i++)
        device.threads = options->thread[i] > device.threads ? options->thread[i] : device.threads;
    for (unsigned i = 0; i < options->engines; i++)
        if (device_create(options->engine[i], &device, &runner->device[i], error)) {
            runner_destroy(runner);
            return NULL;
        }
    return runner;
}

void runner_destroy(struct runner *runner)
{
    if (!runner)
        return;
    for (unsigned i = 0; i < runner->options.engines; i++)
        device_destroy(runner->device[i]);
    free(runner->words);
    free(runner);
}

uint64_t runner_pixels(const struct runner *runner)
{
    struct triptych_statistics statistics;
    device_get_statistics(runner->device[0], &statistics);
    return statistics.pixels_shaded;
}

/* --- What was drawn ------------------------------------------------------------------------------------- */

/* A run of words of a device, and what they are. */
struct section {
    const char *what;
    const uint32_t *words;
    size_t count;
    uint32_t item, planes; /* the number of the tile or of another item; planes of a tile and sample */
};

typedef int section_visitor(void *user, const struct section *section);

/* Planes of a tile, copied to the order of tiles. */
static void copy_planes(const struct tile_order *order, const uint32_t *words, uint32_t planes,
                        uint32_t *copy)
{
    for (uint32_t p = 0; p < planes; p++)
        tile_order_copy(order, words + p * order->plane, &tile_order_alone, copy + p * TILE_PIXELS);
}

/* A target with several samples has one colour. */
static int visit_color(struct target *target, unsigned t, uint32_t tile, section_visitor *visit, void *user)
{
    alignas(64) static uint32_t copy[4 * SAMPLES_MAXIMUM * TILE_PIXELS];
    const struct target_color *color = &target->colors[t];
    if (!color->attachment)
        return 0;
    uint32_t planes = storage_planes[color->storage];
    struct section section = {"colour", copy, (size_t)target->samples * planes * TILE_PIXELS, tile, planes};
    copy_planes(&target->color_order,
                target_fill_color(target, tile) + color->plane * target->color_order.plane,
                target->samples * planes, copy);
    return visit(user, &section);
}

static int visit_depth(struct target *target, uint32_t tile, section_visitor *visit, void *user)
{
    alignas(64) static uint32_t copy[SAMPLES_MAXIMUM * TILE_PIXELS];
    struct section section = {"depth and stencil", copy, (size_t)target->samples * TILE_PIXELS, tile, 1};
    copy_planes(&target->depth_order, target_fill_depth(target, tile), target->samples, copy);
    return visit(user, &section);
}

static int visit_target(struct target *target, section_visitor *visit, void *user)
{
    int stop = 0;
    for (uint32_t tile = 0; tile < target->columns * target->rows && !stop; tile++) {
        for (unsigned t = 0; t < TARGETS && !stop; t++)
            stop = visit_color(target, t, tile, visit, user);
        if (target->depth && !stop)
            stop = visit_depth(target, tile, visit, user);
    }
    return stop;
}

static int visit_surface(struct triptych_device *device, const struct triptych_surface *surface,
                         section_visitor *visit, void *user)
{
    struct target view;
    if (!surface_attachment(surface))
        return 0;
    if (device_view(device, surface, &view, NULL) != TRIPTYCH_OK)
        return -1;
    int stop = visit_target(&view, visit, user);
    target_destroy(&view);
    return stop;
}

/* The tiles of images, and of textures that have been drawn to. */
static int visit_surfaces(struct triptych_device *device, section_visitor *visit, void *user)
{
    int stop = 0;
    for (struct triptych_image *image = device->resources.images; image && !stop; image = image->next)
        stop = visit_surface(device, &(struct triptych_surface){.image = image}, visit, user);
    for (struct triptych_texture *texture = device->resources.textures; texture && !stop;
         texture = texture->next)
        for (struct drawn_surface *drawn = texture->drawn; drawn && !stop; drawn = drawn->next)
            stop = visit_surface(
                device, &(struct triptych_surface){texture, drawn->level, drawn->slice, NULL}, visit, user);
    return stop;
}

/* The texels in rows without gaps, whatever their order in memory is. */
static int visit_texture(const struct triptych_texture *texture, uint32_t number, section_visitor *visit,
                         void *user)
{
    size_t bytes = texture_texel_bytes(texture);
    uint32_t *texels = malloc(bytes);
    if (!texels)
        return -1;
    texture_read_texels(texture, texels);
    int stop = visit(user, &(struct section){"texture, from the last,", texels, bytes / 4, number, 0});
    free(texels);
    return stop;
}

static int visit_textures(struct triptych_device *device, section_visitor *visit, void *user)
{
    uint32_t number = 0;
    int stop = 0;
    for (struct triptych_texture *texture = device->resources.textures; texture && !stop;
         texture = texture->next)
        stop = visit_texture(texture, number++, visit, user);
    return stop;
}

static int visit_queries(struct player *player, section_visitor *visit, void *user)
{
    struct query_count count;
    int stop = 0;
    for (uint32_t i = 0; !stop && player_query(player, i, &count); i++) {
        const uint32_t words[2] = {(uint32_t)count.passed, (uint32_t)(count.passed >> 32)};
        stop = visit(user, &(struct section){"query", words, 2, i, 0});
    }
    return stop;
}

/* The result, and if it is good the vertices. */
static int visit_vertices(const struct runner *runner, section_visitor *visit, void *user)
{
    const uint32_t result = (uint32_t)runner->result;
    int stop = visit(user, &(struct section){"result of processing vertices,", &result, 1, 0, 0});
    for (uint32_t i = 0; i < PROCESSED && !result && !stop; i++) {
        uint32_t words[sizeof *runner->processed / sizeof(uint32_t)];
        memcpy(words, &runner->processed[i], sizeof words);
        stop = visit(user, &(struct section){"processed vertex", words, sizeof words / sizeof *words, i, 0});
    }
    return stop;
}

/* Visits the words of a device and its player, in an order that depends only on the stream. Stops at a result
 * that is not 0. */
static int visit_sections(const struct runner *runner, unsigned engine, section_visitor *visit, void *user)
{
    struct triptych_device *device = runner->device[engine];
    int stop = visit_target(device_target(device), visit, user);
    if (!stop)
        stop = visit_surfaces(device, visit, user);
    if (!stop)
        stop = visit_textures(device, visit, user);
    if (!stop)
        stop = visit_queries(runner->player[engine], visit, user);
    return stop ? stop : visit_vertices(runner, visit, user);
}

static int keep_section(void *user, const struct section *section)
{
    struct runner *runner = user;
    if (runner->count + section->count > runner->capacity) {
        size_t capacity = 2 * (runner->count + section->count);
        uint32_t *larger = realloc(runner->words, capacity * sizeof *larger);
        if (!larger)
            return -1;
        runner->words = larger;
        runner->capacity = capacity;
    }
    memcpy(runner->words + runner->count, section->words, section->count * sizeof *section->words);
    runner->count += section->count;
    return 0;
}

struct comparison {
    const struct runner *runner;
    const struct target *target;
    size_t at; /* in the reference's words */
    struct finding *finding;
};

/* Where a word of a tile lies: the pixel in the target, the sample and the plane. */
static void describe_pixel(const struct comparison *comparison, const struct section *section, size_t word,
                           char text[96])
{
    uint32_t pixel = word % TILE_PIXELS, block = pixel / 16, lane = pixel % 16,
             plane = (uint32_t)(word / TILE_PIXELS);
    uint32_t columns = comparison->target->columns, blocks = TILE_SIZE / 4;
    uint32_t x = section->item % columns * TILE_SIZE + block % blocks * 4 + (lane & 1) + 2 * (lane >> 2 & 1);
    uint32_t y =
        section->item / columns * TILE_SIZE + block / blocks * 4 + (lane >> 1 & 1) + 2 * (lane >> 3 & 1);
    snprintf(text, 96, "%s of pixel %u,%u, sample %u, plane %u", section->what, x, y, plane / section->planes,
             plane % section->planes);
}

static int compare_section(void *user, const struct section *section)
{
    struct comparison *comparison = user;
    const uint32_t *expected = comparison->runner->words + comparison->at;
    char place[96];
    comparison->at += section->count;
    if (comparison->at > comparison->runner->count) {
        find(comparison->finding, OUTCOME_DIFFERENT, "%s %u is missing in the reference", section->what,
             section->item);
        return 1;
    }
    if (!memcmp(expected, section->words, section->count * sizeof *expected))
        return 0;
    size_t i = 0;
    while (expected[i] == section->words[i])
        i++;
    if (section->planes)
        describe_pixel(comparison, section, i, place);
    else
        snprintf(place, sizeof place, "word %zu of %s number %u", i, section->what, section->item);
    find(comparison->finding, OUTCOME_DIFFERENT, "%s: %08x, expected %08x", place, section->words[i],
         expected[i]);
    return 1;
}

/* --- One configuration ---------------------------------------------------------------------------------- */

/* Recordings, plans and stack frames have a largest size (ir/pool.c, engines/stitch/plan.c, emit.h), each its
 * own, and the emulator has none. */
static bool is_limit(const char *reason)
{
    return strstr(reason, "routine takes more than") || strstr(reason, "exceeds its room of") ||
           strstr(reason, "too many spill slots") || strstr(reason, "too many pointers");
}

/* Plays a frame and processes vertices in the state that it leaves. */
static int play_frame(struct runner *runner, unsigned engine, uint32_t frame, struct error *error)
{
    if (player_frame(runner->player[engine], frame, error))
        return -1;
    memset(runner->processed, 0, sizeof runner->processed);
    runner->result = device_process_vertices(runner->device[engine], 0, PROCESSED, runner->processed, error);
    return runner->result == TRIPTYCH_ENGINE_FAILED ? -1 : 0;
}

static enum outcome play_reference(struct runner *runner, uint32_t frames, struct finding *finding)
{
    struct error error = {{0}};
    finding->engine = runner->options.engine[0];
    finding->threads = runner->options.thread[0];
    device_limit_threads(runner->device[0], finding->threads);
    runner->count = 0;
    for (uint32_t frame = 0; frame < frames; frame++) {
        if (play_frame(runner, 0, frame, &error))
            return find(finding, OUTCOME_REFUSED, "%s", error.text);
        if (visit_sections(runner, 0, keep_section, runner))
            return find(finding, OUTCOME_REFUSED, "out of memory for the picture");
    }
    return OUTCOME_SAME;
}

static enum outcome play_other(struct runner *runner, uint32_t frames, unsigned engine, unsigned threads,
                               struct finding *finding)
{
    struct error error = {{0}};
    struct triptych_device *device = runner->device[engine];
    struct comparison comparison = {.runner = runner, .finding = finding};
    finding->engine = runner->options.engine[engine];
    finding->threads = threads;
    device_limit_threads(device, threads);
    device_set_settings(device, &finding->settings);
    for (uint32_t frame = 0; frame < frames; frame++) {
        if (play_frame(runner, engine, frame, &error))
            return find(finding, is_limit(error.text) ? OUTCOME_LIMITED : OUTCOME_FAILED, "%s", error.text);
        comparison.target = device_target(device);
        if (visit_sections(runner, engine, compare_section, &comparison))
            return OUTCOME_DIFFERENT;
    }
    if (comparison.at != runner->count)
        return find(finding, OUTCOME_DIFFERENT, "%zu words, expected %zu", comparison.at, runner->count);
    return OUTCOME_SAME;
}

/* --- One case ------------------------------------------------------------------------------------------- */

/* An engine plays all frames with each number of threads. The reference has done so with the first. */
static enum outcome play_all(struct runner *runner, uint32_t frames, struct finding *finding)
{
    const struct runner_options *options = &runner->options;
    enum outcome outcome = play_reference(runner, frames, finding), limited = OUTCOME_SAME;
    for (unsigned e = 0; e < options->engines && !outcome; e++)
        for (unsigned t = e ? 0 : 1; t < options->threads && !outcome; t++) {
            outcome = play_other(runner, frames, e, options->thread[t], finding);
            if (outcome == OUTCOME_LIMITED) {
                limited = outcome;
                outcome = OUTCOME_SAME;
                break;
            }
        }
    return outcome ? outcome : limited;
}

static enum outcome play(struct runner *runner, const struct stream *stream, struct finding *finding)
{
    static const struct setting_values defaults;
    struct error error = {{0}};
    for (unsigned e = 0; e < runner->options.engines; e++) {
        device_set_settings(runner->device[e], e ? &finding->settings : &defaults);
        if (stream_prepare(stream, runner->device[e], &runner->player[e], &error))
            return find(finding, OUTCOME_REFUSED, "%s", error.text);
    }
    return play_all(runner, stream->frame_count, finding);
}

enum outcome runner_run(struct runner *runner, const char *path, const char *text, size_t bytes,
                        const struct setting_values *settings, struct finding *finding)
{
    struct error error = {{0}};
    struct stream *stream;
    *finding = (struct finding){.outcome = OUTCOME_SAME, .settings = *settings};
    if (stream_parse(path, text, bytes, &stream, &error))
        return find(finding, OUTCOME_REFUSED, "%s", error.text);
    enum outcome outcome = play(runner, stream, finding);
    for (unsigned e = 0; e < runner->options.engines; e++) {
        player_free(runner->player[e]);
        runner->player[e] = NULL;
    }
    stream_free(stream);
    return finding->outcome = outcome;
}
