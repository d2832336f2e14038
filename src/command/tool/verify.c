/* `triptych verify`: checks that every engine, width and thread count draws the same bytes.
 *
 * The reference is the emulator with one thread. It draws each frame once and keeps colours, depths and
 * stencils. Every other configuration draws the same frame on its own device and is compared immediately, so
 * memory does not grow with the number of frames. A device exists from its first frame to its last, so that
 * the devices for one frame use the same memory in turn. A configuration that differs is reported with its
 * first differing frame and skips the stream's remaining frames.
 *
 * After a signal (interrupt.h), it reports the frames that all configurations have drawn. */
#include "render/device/shuffle.h"
#include "engines/specialize/passes/pass.h"
#include "command/support/choose.h"
#include "command/support/difference.h"
#include "command/support/interrupt.h"
#include "command/support/option.h"
#include "command/support/shared.h"
#include "command/store/store.h"
#include "command/support/session.h"
#include "command/tool/verify_results.h"
#include "triptych.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

enum { STEM_CAPACITY = 64, PATH_CAPACITY = 4096, FRAMES_DEFAULT = 8, FRAMES_MAXIMUM = 65536 };

static const char reference_engine[] = "emulate";

struct configuration {
    unsigned engine, threads, settings; /* the last of the choice of settings */
    struct session session;
    bool differs;
};

struct settings {
    const char *engine_list, *thread_list, *setting_list, *frames_text, *json, *shard, *resume;
    struct golden golden; /* without a folder: none */
    struct variation variation;
    struct option_given set;
    unsigned precision;
    struct choice engines, threads;
    struct settings_choice renderer; /* settings of all configurations but the reference */
    const char *folder;              /* for pictures of differences, or null */
    bool all_frames, no_cache;
    unsigned frames;  /* the number to draw, spread over a longer stream */
    unsigned shuffle; /* seed of the order of tasks in all configurations but the reference; 0: in order */
    struct verify_results results;
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
static bool is_reference(const struct settings *settings, const struct configuration *configuration)
{
    static const struct setting_values none;
    return !strcmp(triptych_engine_name(configuration->engine), reference_engine) &&
           configuration->threads == 1 &&
           !memcmp(&settings->renderer.values[configuration->settings], &none, sizeof none);
}

/* Appends an engine with all numbers of threads and all settings. */
static void list_others(const struct settings *settings, unsigned engine, struct verification *verification)
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

static int open_other(const struct command *self, const struct settings *settings,
                      const struct verification *verification, struct configuration *other)
{
    if (open_configuration(self, verification->stream, &settings->renderer.values[other->settings], other))
        return STATUS_BAD;
    device_shuffle(other->session.device, settings->shuffle);
    return STATUS_OK;
}

static int begin(const struct command *self, const struct settings *settings,
                 struct verification *verification)
{
    size_t most = (size_t)settings->engines.count * settings->threads.count * settings->renderer.count;
    verification->others = calloc(most, sizeof *verification->others);
    verification->digest = XXH3_createState();
    if (!verification->others || !verification->digest)
        return tool_fail(self, "no memory to verify %s", verification->path);
    XXH3_64bits_reset(verification->digest);
    verification->reference.threads = 1;
    if (choose_engine(self, reference_engine, 0, &verification->reference.engine) ||
        open_configuration(self, verification->stream, NULL, &verification->reference))
        return STATUS_BAD;
    for (unsigned i = 0; i < settings->engines.count; i++)
        if (verification->selected[i])
            list_others(settings, settings->engines.index[i], verification);
    return STATUS_OK;
}

/* Closes a session, if it is open, and records for the report what its engine executed. */
static void close_configuration(const struct settings *settings, struct configuration *configuration)
{
    struct session *session = &configuration->session;
    for (unsigned i = 0; session->device && settings->results.streams && i < settings->engines.count; i++)
        if (settings->engines.index[i] == configuration->engine)
            execution_add_device(&settings->results.executions[i], session->device);
    session_close(session);
}

static void end(const struct settings *settings, struct verification *verification)
{
    close_configuration(settings, &verification->reference);
    for (unsigned i = 0; i < verification->count; i++)
        close_configuration(settings, &verification->others[i]);
    free(verification->others);
    XXH3_freeState(verification->digest);
    readback_free(&verification->expected);
    readback_free(&verification->got);
}

static int save_picture(const struct command *self, const struct settings *settings,
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

static int compare_frame(const struct command *self, const struct settings *settings,
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
           reference_engine, triptych_engine_name(configuration->engine), configuration->threads,
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

static int compare_others(const struct command *self, const struct settings *settings,
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
static int verify_frame(const struct command *self, struct settings *settings,
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

static void add_stream(struct settings *settings, struct verification *verification, const char *digest)
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

static void report(struct settings *settings, struct verification *verification)
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

static int verify_frames(const struct command *self, struct settings *settings,
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

/* The number of streams so far. */
struct totals {
    unsigned streams, complete, different; /* with units in the shard; of these */
};

/* Streams of a campaign that is continued count as well. */
static enum verify_verdict judge(const struct settings *settings, const struct totals *totals)
{
    if (totals->different)
        return VERIFY_DIFFERENT;
    return totals->complete || !interrupt_signal() || ranges_size(&settings->results.earlier.done)
               ? VERIFY_IDENTICAL
               : VERIFY_UNKNOWN;
}

static int verify_stream(const struct command *self, const char *path, unsigned number,
                         struct settings *settings, struct totals *totals)
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
    return status || interrupt_signal() ? status
                                        : verify_results_keep(&settings->results, judge(settings, totals));
}

static void tell_left_out(const struct choice *engines)
{
    for (unsigned i = 0; i < engines->left_out_count; i++)
        printf("left out %s: %s\n", triptych_engine_name(engines->left_out[i].index),
               engines->left_out[i].reason);
}

static void summarize(const struct settings *settings, const struct totals *totals)
{
    if (interrupt_signal())
        printf("interrupted by %s: %u of ", interrupt_name(), totals->complete);
    if (settings->golden.update)
        printf("%u goldens written to %s\n", settings->golden.written, settings->golden.folder);
    else if (settings->golden.folder)
        printf("%u goldens, %u differ or are missing\n", settings->golden.compared,
               settings->golden.different);
    printf("%u stream%s, %u engine%s, ", totals->streams, totals->streams == 1 ? "" : "s",
           settings->engines.count, settings->engines.count == 1 ? "" : "s");
    switch (judge(settings, totals)) {
    case VERIFY_UNKNOWN: puts("no stream complete"); break;
    case VERIFY_IDENTICAL: puts("identical"); break;
    case VERIFY_DIFFERENT: printf("%u differ\n", totals->different); break;
    }
}

static unsigned count_streams(const struct operands *operands, const struct settings *settings)
{
    bool selected[CHOICE_CAPACITY];
    unsigned count = 0;
    for (int i = 0; i < operands->count; i++)
        count += verify_results_select(&settings->results, (unsigned)i, selected) > 0;
    return count;
}

static int verify_all(const struct command *self, const struct operands *operands, struct settings *settings,
                      enum verify_verdict *verdict)
{
    struct totals totals = {.streams = count_streams(operands, settings),
                            .different = settings->results.different};
    for (int i = 0; i < operands->count && !interrupt_signal(); i++)
        if (verify_stream(self, operands->value[i], (unsigned)i, settings, &totals))
            return STATUS_BAD;
    tell_left_out(&settings->engines);
    summarize(settings, &totals);
    *verdict = judge(settings, &totals);
    if (interrupt_signal())
        return interrupt_status();
    return totals.different ? STATUS_DIFFERENT : STATUS_OK;
}

static const char notes[] =
    "The reference is emulate with 1 thread and the default settings. Every colour, depth and stencil byte "
    "of every other "
    "configuration\n"
    "must equal its bytes. Frames are numbered from 0. Last line: \"N streams, N engines, identical\", or "
    "the number\n"
    "of streams that differ; engines are those of --engines, the reference only if it is one of them. After "
    "SIGINT or SIGTERM it reports what it has drawn; the status is 130 or "
    "143.\n"
    "A shard has some of the pairs of a stream and an engine; triptych merge joins the results of all.";

static bool is_only_reference(const struct settings *settings)
{
    return !settings->golden.folder && settings->engines.count == 1 && settings->threads.count == 1 &&
           settings->threads.index[0] == 1 && settings->renderer.count == 1 && !settings->set.count &&
           !strcmp(triptych_engine_name(settings->engines.index[0]), reference_engine);
}

static int read_settings(const struct command *self, struct settings *settings)
{
    const char *frames = settings->frames_text;
    settings->all_frames = frames && !strcmp(frames, "all");
    if (frames && !settings->all_frames && !option_read_number(frames, 1, FRAMES_MAXIMUM, &settings->frames))
        return tool_fail(self, "--frames is \"%s\", expected all or a number from 1 to %d", frames,
                         FRAMES_MAXIMUM);
    if (choose_engines(self, settings->engine_list, &settings->engines) ||
        choose_variants(self, &settings->variation, &settings->engines) ||
        choose_threads(self, settings->thread_list, &settings->threads) ||
        choose_varied_settings(self, &settings->set, settings->setting_list, &settings->renderer) ||
        tool_check_output(self, settings->json) || tool_check_output(self, settings->resume))
        return STATUS_BAD;
    if (is_only_reference(settings))
        return tool_fail(
            self, "%s with 1 thread is the reference itself, expected another engine or number of threads",
            reference_engine);
    if (!settings->golden.folder && (settings->golden.update || settings->golden.tolerance))
        return tool_fail(self, "--%s is given without --golden, expected both",
                         settings->golden.update ? "update" : "tolerance");
    settings->golden.differences = settings->folder;
    return STATUS_OK;
}

/* A folder of goldens must exist, unless they are written. */
static int check_goldens(const struct command *self, const struct settings *settings, bool *made)
{
    const char *folder = settings->golden.folder;
    *made = false;
    if (!folder || access(folder, R_OK | X_OK) == 0)
        return STATUS_OK;
    return settings->golden.update ? tool_make_folder(self, folder, made)
                                   : tool_fail(self, "%s: cannot be read: %s", folder, strerror(errno));
}

static int begin_results(const struct command *self, struct settings *settings,
                         const struct operands *operands)
{
    static struct execution executions[CHOICE_CAPACITY];
    settings->results = (struct verify_results){.self = self,
                                                .operands = operands,
                                                .engines = &settings->engines,
                                                .threads = &settings->threads,
                                                .golden = &settings->golden,
                                                .frames = settings->all_frames ? 0 : settings->frames,
                                                .shuffle = settings->shuffle,
                                                .renderer = &settings->renderer,
                                                .path = settings->json,
                                                .resume = settings->resume,
                                                .executions = executions};
    memset(executions, 0, sizeof executions);
    if (shard_read(self, settings->shard, &settings->results.shard) ||
        verify_results_begin(&settings->results))
        return verify_results_free(&settings->results), STATUS_BAD;
    return STATUS_OK;
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    struct settings *settings = data;
    bool made, made_goldens;
    enum verify_verdict verdict;
    store_off |= settings->no_cache;
    if (read_settings(self, settings) || check_goldens(self, settings, &made_goldens) ||
        tool_make_folder(self, settings->folder, &made) || begin_results(self, settings, operands))
        return STATUS_BAD;
    interrupt_defer();
    int status = verify_all(self, operands, settings, &verdict);
    if (settings->results.streams && status != STATUS_BAD &&
        verify_results_write(&settings->results, verdict, interrupt_name()))
        status = STATUS_BAD;
    verify_results_free(&settings->results);
    readback_free(&settings->golden.readback);
    if (made_goldens)
        rmdir(settings->golden.folder); /* succeeds only if nothing was drawn */
    if (made)
        rmdir(settings->folder); /* succeeds only if nothing differed */
    return status;
}

static const struct settings defaults = {
    .frames = FRAMES_DEFAULT, .thread_list = "1,2", .golden.compression = PNG_LEVEL_DEFAULT};

static const struct option options[] = {
    {"engines", "LIST", "engines, separated by commas; all that can run here",
     OPTION_IS_LIST(struct settings, engine_list), .words = triptych_engine_name},
    OPTIONS_OF_VARIATION(struct settings, variation),
    {"threads", "LIST", "numbers of threads; 1,2", OPTION_IS_LIST(struct settings, thread_list)},
    OPTION_SET(struct settings, set),
    OPTION_PRECISION(struct settings, precision),
    {"settings", "LIST|all", "also compare each value of these settings of the renderer",
     OPTION_IS_LIST(struct settings, setting_list), .words = setting_name},
    {"frames", "N|all", "number of frames, spread over the stream; 8",
     OPTION_IS_TEXT(struct settings, frames_text)},
    {"shuffle", "SEED", "seed of random orders of batches and tiles in all but the reference; 0",
     OPTION_IS_NUMBER(struct settings, shuffle), .most = INT32_MAX},
    {"difference", "DIR", "folder for pictures of the differences",
     OPTION_IS_FOLDER(struct settings, folder)},
    {"golden", "DIR", "also compare with the pictures DIR/STREAM.png or DIR/STREAM-FRAME.png",
     OPTION_IS_FOLDER(struct settings, golden.folder)},
    {"tolerance", "N", "the difference to a golden of a channel that is allowed, of 255; 0",
     OPTION_IS_NUMBER(struct settings, golden.tolerance), .most = 255},
    {"update", NULL, "write the pictures of --golden instead of comparing them",
     OPTION_IS_FLAG(struct settings, golden.update)},
    OPTION_COMPRESSION(struct settings, golden.compression),
    OPTION_NO_CACHE(struct settings, no_cache),
    {"json", "FILE", "write the results", OPTION_IS_FILE(struct settings, json), .extension = "json"},
    OPTION_SHARD(struct settings, shard),
    OPTION_RESUME(struct settings, resume),
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream", .kind = OPERAND_INPUT, .extension = "tri trib", .repeated = true},
    {0},
};

const struct command command_verify = {
    .name = "verify",
    .summary = "check that all engines, widths and thread counts give the same bytes",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
