/* `triptych verify`: checks that every engine, width and thread count draws the same bytes, stream by stream
 * (verify_stream.h).
 *
 * After a signal (interrupt.h), it reports the frames that all configurations have drawn. */
#include "engines/specialize/passes/pass.h"
#include "command/support/choose.h"
#include "command/support/difference.h"
#include "command/support/interrupt.h"
#include "command/support/option.h"
#include "command/support/shared.h"
#include "command/store/store.h"
#include "command/tool/verify_stream.h"
#include "triptych.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { FRAMES_DEFAULT = 8, FRAMES_MAXIMUM = 65536 };

static void tell_left_out(const struct choice *engines)
{
    for (unsigned i = 0; i < engines->left_out_count; i++)
        printf("left out %s: %s\n", triptych_engine_name(engines->left_out[i].index),
               engines->left_out[i].reason);
}

static void summarize(const struct verify_settings *settings, const struct verify_totals *totals)
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
    switch (verify_judge(settings, totals)) {
    case VERIFY_UNKNOWN: puts("no stream complete"); break;
    case VERIFY_IDENTICAL: puts("identical"); break;
    case VERIFY_DIFFERENT: printf("%u differ\n", totals->different); break;
    }
}

static unsigned count_streams(const struct operands *operands, const struct verify_settings *settings)
{
    bool selected[CHOICE_CAPACITY];
    unsigned count = 0;
    for (int i = 0; i < operands->count; i++)
        count += verify_results_select(&settings->results, (unsigned)i, selected) > 0;
    return count;
}

static int verify_all(const struct command *self, const struct operands *operands,
                      struct verify_settings *settings, enum verify_verdict *verdict)
{
    struct verify_totals totals = {.streams = count_streams(operands, settings),
                                   .different = settings->results.different};
    for (int i = 0; i < operands->count && !interrupt_signal(); i++)
        if (verify_stream(self, operands->value[i], (unsigned)i, settings, &totals))
            return STATUS_BAD;
    tell_left_out(&settings->engines);
    summarize(settings, &totals);
    *verdict = verify_judge(settings, &totals);
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

static bool is_only_reference(const struct verify_settings *settings)
{
    return !settings->golden.folder && settings->engines.count == 1 && settings->threads.count == 1 &&
           settings->threads.index[0] == 1 && settings->renderer.count == 1 && !settings->set.count &&
           !strcmp(triptych_engine_name(settings->engines.index[0]), verify_reference);
}

static int read_settings(const struct command *self, struct verify_settings *settings)
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
            verify_reference);
    if (!settings->golden.folder && (settings->golden.update || settings->golden.tolerance))
        return tool_fail(self, "--%s is given without --golden, expected both",
                         settings->golden.update ? "update" : "tolerance");
    settings->golden.differences = settings->folder;
    return STATUS_OK;
}

/* A folder of goldens must exist, unless they are written. */
static int check_goldens(const struct command *self, const struct verify_settings *settings, bool *made)
{
    const char *folder = settings->golden.folder;
    *made = false;
    if (!folder || access(folder, R_OK | X_OK) == 0)
        return STATUS_OK;
    return settings->golden.update ? tool_make_folder(self, folder, made)
                                   : tool_fail(self, "%s: cannot be read: %s", folder, strerror(errno));
}

static int begin_results(const struct command *self, struct verify_settings *settings,
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
    struct verify_settings *settings = data;
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

static const struct verify_settings defaults = {
    .frames = FRAMES_DEFAULT, .thread_list = "1,2", .golden.compression = PNG_LEVEL_DEFAULT};

static const struct option options[] = {
    {"engines", "LIST", "engines, separated by commas; all that can run here",
     OPTION_IS_LIST(struct verify_settings, engine_list), .words = triptych_engine_name},
    OPTIONS_OF_VARIATION(struct verify_settings, variation),
    {"threads", "LIST", "numbers of threads; 1,2", OPTION_IS_LIST(struct verify_settings, thread_list)},
    OPTION_SET(struct verify_settings, set),
    OPTION_PRECISION(struct verify_settings, precision),
    {"settings", "LIST|all", "also compare each value of these settings of the renderer",
     OPTION_IS_LIST(struct verify_settings, setting_list), .words = setting_name},
    {"frames", "N|all", "number of frames, spread over the stream; 8",
     OPTION_IS_TEXT(struct verify_settings, frames_text)},
    {"shuffle", "SEED", "seed of random orders of batches and tiles in all but the reference; 0",
     OPTION_IS_NUMBER(struct verify_settings, shuffle), .most = INT32_MAX},
    {"difference", "DIR", "folder for pictures of the differences",
     OPTION_IS_FOLDER(struct verify_settings, folder)},
    {"golden", "DIR", "also compare with the pictures DIR/STREAM.png or DIR/STREAM-FRAME.png",
     OPTION_IS_FOLDER(struct verify_settings, golden.folder)},
    {"tolerance", "N", "the difference to a golden of a channel that is allowed, of 255; 0",
     OPTION_IS_NUMBER(struct verify_settings, golden.tolerance), .most = 255},
    {"update", NULL, "write the pictures of --golden instead of comparing them",
     OPTION_IS_FLAG(struct verify_settings, golden.update)},
    OPTION_COMPRESSION(struct verify_settings, golden.compression),
    OPTION_NO_CACHE(struct verify_settings, no_cache),
    {"json", "FILE", "write the results", OPTION_IS_FILE(struct verify_settings, json), .extension = "json"},
    OPTION_SHARD(struct verify_settings, shard),
    OPTION_RESUME(struct verify_settings, resume),
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
