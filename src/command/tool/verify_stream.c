#include "command/tool/verify_stream.h"

#include "render/device/shuffle.h"
#include "command/support/difference.h"
#include "command/support/interrupt.h"
#include "command/support/session.h"
#include "triptych.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

enum { STEM_CAPACITY = 64, PATH_CAPACITY = 4096 };

const char verify_reference[] = "emulate";

struct configuration {
    unsigned engine, threads, settings; /* the last of the choice of settings */
    struct session session;
    bool differs;
};

/* The verification of one stream. */
struct verification {
    char name[STEM_CAPACITY];
    const char *path;
    const struct stream *stream;
    unsigned number;                /* of the stream */
    bool selected[CHOICE_CAPACITY]; /* the engines to compare, indexed like those of the settings */
    unsigned frames, all;           /* to draw; in the stream */
    unsigned drawn;
    struct configuration reference;
    struct configuration *others;
    unsigned count, different;
    struct readback expected, got;
    XXH3_state_t *digest; /* of the reference's pictures, frame by frame */
    cJSON *differences;   /* or null */
    cJSON *goldens;       /* or null */
};

/* Opens the configuration, whose engine and number of threads are set. */
static int open_configuration(const struct command *self, const struct stream *stream,
                              const struct setting_values *values, struct configuration *configuration)
{
    return session_open(self, stream, configuration->engine, configuration->threads, values,
                        &configuration->session);
}

/* Returns true if the configuration is the reference itself. */
static bool is_reference(const struct verify_settings *settings, const struct configuration *configuration)
{
    static const struct setting_values none;
    return !strcmp(triptych_engine_name(configuration->engine), verify_reference) &&
           configuration->threads == 1 &&
           !memcmp(&settings->renderer.values[configuration->settings], &none, sizeof none);
}

/* Appends an engine with all numbers of threads and all settings. */
static void list_others(const struct verify_settings *settings, unsigned engine,
                        struct verification *verification)
{
    const struct settings_choice *renderer = &settings->renderer;
    for (unsigned i = 0; i < settings->threads.count; i++)
        for (unsigned j = 0; j < renderer->count; j++) {
            const struct configuration made = {
                .engine = engine, .threads = settings->threads.index[i], .settings = j};
            if (!is_reference(settings, &made))
                verification->others[verification->count++] = made;
        }
}

static int open_other(const struct command *self, const struct verify_settings *settings,
                      const struct verification *verification, struct configuration *other)
{
    if (open_configuration(self, verification->stream, &settings->renderer.values[other->settings], other))
        return STATUS_BAD;
    device_shuffle(other->session.device, settings->shuffle);
    return STATUS_OK;
}

static int begin(const struct command *self, const struct verify_settings *settings,
                 struct verification *verification)
{
    size_t most = (size_t)settings->engines.count * settings->threads.count * settings->renderer.count;
    verification->others = calloc(most, sizeof *verification->others);
    verification->digest = XXH3_createState();
    if (!verification->others || !verification->digest)
        return tool_fail(self, "no memory to verify %s", verification->path);
    XXH3_64bits_reset(verification->digest);
    verification->reference.threads = 1;
    if (choose_engine(self, verify_reference, 0, &verification->reference.engine) ||
        open_configuration(self, verification->stream, NULL, &verification->reference))
        return STATUS_BAD;
    for (unsigned i = 0; i < settings->engines.count; i++)
        if (verification->selected[i])
            list_others(settings, settings->engines.index[i], verification);
    return STATUS_OK;
}

/* Closes a session, if it is open, and records for the report what its engine executed. */
static void close_configuration(const struct verify_settings *settings, struct configuration *configuration)
{
    struct session *session = &configuration->session;
    for (unsigned i = 0; session->device && settings->results.streams && i < settings->engines.count; i++)
        if (settings->engines.index[i] == configuration->engine)
            execution_add_device(&settings->results.executions[i], session->device);
    session_close(session);
}

static void end(const struct verify_settings *settings, struct verification *verification)
{
    close_configuration(settings, &verification->reference);
    for (unsigned i = 0; i < verification->count; i++)
        close_configuration(settings, &verification->others[i]);
    free(verification->others);
    XXH3_freeState(verification->digest);
    readback_free(&verification->expected);
    readback_free(&verification->got);
}

static int save_picture(const struct command *self, const struct verify_settings *settings,
                        const struct verification *verification, const struct configuration *configuration,
                        unsigned frame)
{
    char path[PATH_CAPACITY];
    char renderer[SETTING_TEXT];
    setting_write(&settings->renderer.values[configuration->settings], renderer);
    snprintf(path, sizeof path, "%s/%s-%s-%u%s%s-frame-%u.png", settings->folder, verification->name,
             triptych_engine_name(configuration->engine), configuration->threads, *renderer ? "-" : "",
             renderer, frame);
    struct picture expected = readback_picture(&verification->expected),
                   got = readback_picture(&verification->got);
    return difference_save(self, path, &expected, &got, settings->golden.compression);
}

/* Describes the first query whose count differs. */
static bool compare_queries(const struct readback *expected, const struct readback *got,
                            char text[DIFFERENCE_TEXT])
{
    for (unsigned i = 0; i < expected->query_count; i++)
        if (i >= got->query_count || expected->queries[i].passed != got->queries[i].passed) {
            snprintf(text, DIFFERENCE_TEXT, "query %s: %llu and %llu samples passed",
                     expected->queries[i].name, (unsigned long long)expected->queries[i].passed,
                     (unsigned long long)(i < got->query_count ? got->queries[i].passed : 0));
            return true;
        }
    return false;
}

static int compare_frame(const struct command *self, const struct verify_settings *settings,
                         struct verification *verification, struct configuration *configuration,
                         unsigned frame)
{
    struct picture expected = readback_picture(&verification->expected),
                   got = readback_picture(&verification->got);
    struct difference difference;
    char text[DIFFERENCE_TEXT], renderer[SETTING_TEXT];
    if (compare_pictures(&expected, &got, &difference))
        difference_describe(&expected, &difference, text);
    else if (!compare_queries(&verification->expected, &verification->got, text))
        return STATUS_OK;
    configuration->differs = true;
    setting_write(&settings->renderer.values[configuration->settings], renderer);
    tool_progress(NULL);
    printf("%s: frame %u: %s with 1 thread and %s with %u%s%s differ: %s\n", verification->name, frame,
           verify_reference, triptych_engine_name(configuration->engine), configuration->threads,
           *renderer ? " and " : "", renderer, text);
    if (verification->differences)
        verify_results_difference(verification->differences, triptych_engine_name(configuration->engine),
                                  configuration->threads, renderer, frame, &difference, text);
    return settings->folder ? save_picture(self, settings, verification, configuration, frame) : STATUS_OK;
}

static int draw(const struct command *self, const struct verification *verification,
                struct configuration *configuration, unsigned frame, struct readback *capture)
{
    tool_progress("%s: frame %u of %u: %s with %u threads", verification->name, frame, verification->all,
                  triptych_engine_name(configuration->engine), configuration->threads);
    return session_play(self, &configuration->session, frame) ||
                   readback_take(self, &configuration->session, READBACK_SAMPLES, capture)
               ? STATUS_BAD
               : STATUS_OK;
}

static void add_frame(struct verification *verification)
{
    const struct readback *expected = &verification->expected;
    size_t pixels = (size_t)expected->width * expected->height;
    XXH3_64bits_update(verification->digest, expected->color, pixels * sizeof *expected->color);
    if (expected->has_depth)
        XXH3_64bits_update(verification->digest, expected->depth, pixels * sizeof *expected->depth);
    if (expected->has_stencil)
        XXH3_64bits_update(verification->digest, expected->stencil, pixels);
    if (expected->numbers)
        XXH3_64bits_update(verification->digest, expected->numbers,
                           pixels * expected->targets * 4 * sizeof *expected->numbers);
    for (unsigned i = 0; i < expected->query_count; i++)
        XXH3_64bits_update(verification->digest, &expected->queries[i].passed,
                           sizeof expected->queries[i].passed);
    verification->drawn++;
}

static int compare_others(const struct command *self, const struct verify_settings *settings,
                          struct verification *verification, unsigned frame)
{
    for (unsigned i = 0; i < verification->count && !interrupt_signal(); i++) {
        struct configuration *configuration = verification->others + i;
        if (configuration->differs)
            continue;
        if ((!configuration->session.device && open_other(self, settings, verification, configuration)) ||
            draw(self, verification, configuration, frame, &verification->got) ||
            compare_frame(self, settings, verification, configuration, frame))
            return STATUS_BAD;
        verification->different += configuration->differs;
        if (configuration->differs || verification->drawn + 1 == verification->frames)
            close_configuration(settings, configuration);
    }
    return STATUS_OK;
}

/* A frame counts as drawn when every configuration has drawn it. */
static int verify_frame(const struct command *self, struct verify_settings *settings,
                        struct verification *verification, unsigned frame)
{
    if (draw(self, verification, &verification->reference, frame, &verification->expected) ||
        (settings->golden.folder &&
         golden_check(self, &settings->golden, &verification->reference.session, verification->name, frame,
                      verification->frames == 1, verification->goldens)) ||
        compare_others(self, settings, verification, frame))
        return STATUS_BAD;
    if (!interrupt_signal())
        add_frame(verification);
    return STATUS_OK;
}

static void add_stream(struct verify_settings *settings, struct verification *verification,
                       const char *digest)
{
    cJSON *json = verify_results_add(&settings->results, verification->number, verification->name,
                                     verification->selected);
    cJSON_AddNumberToObject(json, "frames", verification->drawn);
    cJSON_AddBoolToObject(json, "complete", verification->drawn == verification->frames);
    cJSON_AddNumberToObject(json, "configurations", verification->count + 1);
    cJSON_AddStringToObject(json, "xxh3", digest);
    verify_results_verdict(json, verification->different ? VERIFY_DIFFERENT
                                 : verification->drawn   ? VERIFY_IDENTICAL
                                                         : VERIFY_UNKNOWN);
    cJSON_AddItemToObject(json, "differences", verification->differences);
    if (settings->golden.folder)
        cJSON_AddItemToObject(json, "goldens", verification->goldens);
    else
        cJSON_Delete(verification->goldens);
}

static void report(struct verify_settings *settings, struct verification *verification)
{
    char digest[24];
    snprintf(digest, sizeof digest, "%016llx", (unsigned long long)XXH3_64bits_digest(verification->digest));
    tool_progress(NULL);
    if (!verification->different && verification->drawn)
        printf("%s: identical, %u of %u frames, %u configurations, %u x %u, xxh3 %s\n", verification->name,
               verification->drawn, verification->all, verification->count + 1, verification->expected.width,
               verification->expected.height, digest);
    fflush(stdout);
    if (settings->results.streams)
        add_stream(settings, verification, digest);
}

static int verify_frames(const struct command *self, struct verify_settings *settings,
                         struct verification *verification)
{
    if (begin(self, settings, verification))
        return STATUS_BAD;
    for (unsigned i = 0; i < verification->frames && !interrupt_signal(); i++)
        if (verify_frame(self, settings, verification,
                         session_spread(i, verification->frames, verification->all)))
            return STATUS_BAD;
    return STATUS_OK;
}

/* Streams of a campaign that is continued count as well. */
enum verify_verdict verify_judge(const struct verify_settings *settings, const struct verify_totals *totals)
{
    if (totals->different)
        return VERIFY_DIFFERENT;
    return totals->complete || !interrupt_signal() || ranges_size(&settings->results.earlier.done)
               ? VERIFY_IDENTICAL
               : VERIFY_UNKNOWN;
}

int verify_stream(const struct command *self, const char *path, unsigned number,
                  struct verify_settings *settings, struct verify_totals *totals)
{
    struct verification verification = {.path = path, .number = number};
    if (!verify_results_select(&settings->results, number, verification.selected))
        return STATUS_OK;
    struct stream *stream = session_load_frames(self, path);
    if (!stream)
        return STATUS_BAD;
    stream->precision = settings->precision;
    verification.stream = stream;
    verification.all = stream->frame_count;
    tool_path_stem(path, verification.name, sizeof verification.name);
    verification.frames = verification.all;
    if (!settings->all_frames && settings->frames < verification.all)
        verification.frames = settings->frames;
    if (settings->results.streams) {
        verification.differences = cJSON_CreateArray();
        verification.goldens = cJSON_CreateArray();
    }
    unsigned goldens_different = settings->golden.different;
    int status = verify_frames(self, settings, &verification);
    if (!status) {
        report(settings, &verification);
        totals->different += verification.different || settings->golden.different > goldens_different;
        totals->complete += verification.drawn == verification.frames;
    } else {
        cJSON_Delete(verification.differences);
        cJSON_Delete(verification.goldens);
    }
    end(settings, &verification);
    stream_free(stream);
    return status || interrupt_signal()
               ? status
               : verify_results_keep(&settings->results, verify_judge(settings, totals));
}
