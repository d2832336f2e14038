/* `triptych fuzz`: draws random cases with every engine, width and number of threads (docs/fuzzing.md). */
#include "base/clock.h"
#include "base/file.h"
#include "engines/list.h"
#include "engines/specialize/passes/pass.h"
#include "command/fuzz/bisect/bisect.h"
#include "command/fuzz/campaign.h"
#include "command/support/choose.h"
#include "command/support/interrupt.h"
#include "command/support/option.h"
#include "command/tool/fuzz_results.h"
#include "triptych.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PATH_CAPACITY = 4096, NEVER = 0xffffffff };

struct settings {
    unsigned seed, first, count, jobs, enough, print;
    double seconds, limit, checkpoint;
    const char *engines, *threads, *folder, *json, *shard, *resume;
    struct variation variation;
    struct option_given set;
};

/* A campaign while it runs. */
struct watched {
    const struct command *self;
    const struct settings *settings;
    struct fuzz_results results;
    unsigned engines; /* those of --engines; the reference may be another */
    uint64_t part;    /* cases of the shard */
    uint64_t written; /* cases that the file of --resume has */
    double next;      /* when it is written again, in seconds */
    int status;
};

static uint64_t drawn(const struct campaign *campaign)
{
    return campaign->cases - campaign->outcomes[OUTCOME_REFUSED];
}

/* Writes the results so far, as those of an interrupted campaign. */
static void keep(struct watched *watched, const struct campaign *campaign)
{
    static struct campaign now;
    if (!watched->settings->resume || campaign->cases == watched->written || clock_seconds() < watched->next)
        return;
    now = *campaign; /* shares `done` */
    now.interrupted = true;
    watched->status = fuzz_results_write(watched->self, &watched->results, &now, watched->settings->resume);
    watched->written = campaign->cases;
    watched->next = clock_seconds() + watched->settings->checkpoint;
}

static bool watch(void *user, const struct campaign *campaign)
{
    struct watched *watched = user;
    tool_progress("%" PRIu64 " of %" PRIu64 " cases, %.0f a second, %u findings", campaign->cases,
                  watched->part, (double)campaign->cases / campaign->seconds, campaign->findings);
    keep(watched, campaign);
    return watched->status || interrupt_signal();
}

/* The reference of every comparison is the first engine, in whatever order the list is. `listed` is the
 * number of engines that are in the list. */
static int choose(const struct command *self, const struct settings *settings, struct runner_options *run,
                  unsigned *listed)
{
    struct choice engines, threads;
    unsigned reference;
    if (choose_engines(self, settings->engines, &engines) ||
        choose_variants(self, &settings->variation, &engines) ||
        choose_threads(self, settings->threads, &threads) || choose_engine(self, "emulate", 0, &reference))
        return STATUS_BAD;
    *listed = engines.count;
    run->engine[run->engines++] = engine_at(reference);
    for (unsigned i = 0; i < engines.count; i++)
        if (engines.index[i] != reference && run->engines < RUNNER_ENGINES)
            run->engine[run->engines++] = engine_at(engines.index[i]);
    if (threads.count > RUNNER_THREADS)
        return tool_fail(self, "%u numbers of threads, expected at most %d", threads.count, RUNNER_THREADS);
    run->threads = threads.count;
    memcpy(run->thread, threads.index, threads.count * sizeof *run->thread);
    return STATUS_OK;
}

/* --- Findings --- */

static const char *settings_of(const struct finding *finding, char text[SETTING_TEXT])
{
    return setting_write(&finding->settings, text);
}

static void describe(const struct settings *settings, const struct campaign_finding *found, char *text,
                     size_t size)
{
    const struct finding *finding = &found->finding;
    char renderer[SETTING_TEXT];
    int length = snprintf(text, size, "seed %u case %" PRIu64 ": %s", settings->seed, found->number,
                          outcome_name[finding->outcome]);
    if (finding->engine)
        length += snprintf(text + length, size - (size_t)length, ": %s with %u thread%s%s%s",
                           finding->engine->name, finding->threads, finding->threads == 1 ? "" : "s",
                           *settings_of(finding, renderer) ? " and " : "", renderer);
    snprintf(text + length, size - (size_t)length, ": %s", finding->what);
}

static void name_file(const struct settings *settings, const struct campaign_finding *found,
                      char path[PATH_CAPACITY])
{
    snprintf(path, PATH_CAPACITY, "%s/%u-%" PRIu64 ".tri", settings->folder, settings->seed, found->number);
}

/* Saves the text as a stream whose first lines describe the failure. */
static int save(const struct command *self, const struct settings *settings,
                const struct campaign_finding *found, const char *description, const struct text *explanation,
                const struct text *text)
{
    struct error error = {{0}};
    struct text whole = {0};
    char path[PATH_CAPACITY];
    const char *rest = strchr(text->data, '\n');
    name_file(settings, found, path);
    text_add(&whole, "triptych 1\n# %s\n", description);
    whole.failed |= explanation->failed;
    for (const char *line = explanation->data; line && *line && !whole.failed; line = strchr(line, '\n') + 1)
        text_add(&whole, "# %.*s\n", (int)strcspn(line, "\n"), line);
    text_add(&whole, "%s", rest ? rest + 1 : "");
    int bad = whole.failed ? error_set(&error, "%s: out of memory", path)
                           : file_write(path, whole.data, whole.length, &error);
    text_free(&whole);
    if (bad)
        return tool_fail(self, "%s", error.text);
    printf("  %s\n", path);
    return STATUS_OK;
}

/* Names the first operation that differs. Does nothing for other outcomes or if the operation cannot be
 * found. */
static void explain(const struct finding *finding, const struct engine *reference, const struct text *text,
                    struct text *explanation)
{
    static struct bisection bisection;
    static const struct bisect_options anywhere = {.draw = BISECT_ANY, .x = BISECT_ANY, .y = BISECT_ANY};
    struct error error = {{0}};
    struct stream *stream;
    if (finding->outcome != OUTCOME_DIFFERENT || finding->engine == reference ||
        stream_parse("case", text->data, text->length, &stream, &error))
        return;
    if (bisect(stream, reference, finding->engine, &anywhere, &bisection, &error))
        text_add(explanation, "%s\n", error.text);
    else
        bisection_print(&bisection, explanation);
    stream_free(stream);
    printf("%s", explanation->data ? explanation->data : "");
}

/* Saves the reduced case, or the whole case with a note if it does not fail in a process of its own. */
static int save_smallest(const struct command *self, const struct settings *settings,
                         const struct campaign_options *options, const struct campaign_finding *found,
                         const char *description, const struct text *text)
{
    struct error error = {{0}};
    struct text smallest = {0}, explanation = {0};
    tool_progress("reducing case %" PRIu64, found->number);
    bool made = !campaign_minimize(options, &found->finding, text, &smallest, &error);
    tool_progress(NULL);
    if (!made)
        printf("  not reduced: %s\n", error.text);
    const struct text *rest = made ? &smallest : text;
    explain(&found->finding, options->run.engine[0], rest, &explanation);
    int bad = save(self, settings, found, description, &explanation, rest);
    text_free(&explanation);
    text_free(&smallest);
    return bad;
}

/* Returns true if a campaign that is continued has saved the case already. */
static bool is_saved(const struct settings *settings, const struct campaign *earlier,
                     const struct campaign_finding *found)
{
    char path[PATH_CAPACITY];
    name_file(settings, found, path);
    return ranges_has(&earlier->done, found->number) && !access(path, F_OK);
}

static int report_finding(const struct command *self, const struct settings *settings,
                          const struct campaign_options *options, const struct campaign_finding *found)
{
    char description[2 * FINDING_TEXT];
    struct text text = {0};
    describe(settings, found, description, sizeof description);
    printf("%s\n", description);
    if (is_saved(settings, options->earlier, found))
        return STATUS_OK;
    campaign_case(settings->seed, found->number, &text);
    int bad = text.failed ? tool_fail(self, "out of memory for a case")
                          : save_smallest(self, settings, options, found, description, &text);
    text_free(&text);
    return bad;
}

/* --- Report --- */

static const char *ending(uint64_t count)
{
    return count == 1 ? "" : "s";
}

static void summarize(unsigned engines, unsigned threads, const struct campaign *campaign)
{
    tool_progress(NULL);
    printf("%" PRIu64 " case%s, %u engine%s, %u number%s of threads: ", campaign->cases,
           ending(campaign->cases), engines, ending(engines), threads, ending(threads));
    printf("%.0f a second, %.1f pixels a case, %" PRIu64 " refused, %" PRIu64 " limited, %u finding%s%s\n",
           (double)campaign->cases / campaign->seconds,
           (double)campaign->pixels / (double)(drawn(campaign) ? drawn(campaign) : 1),
           campaign->outcomes[OUTCOME_REFUSED], campaign->outcomes[OUTCOME_LIMITED], campaign->findings,
           ending(campaign->findings), campaign->interrupted ? ", interrupted" : "");
}

/* The files are written before the cases are reduced, which takes long. */
static int write_results(const struct watched *watched, const struct campaign *campaign)
{
    const char *const paths[] = {watched->settings->resume, watched->settings->json};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        if (paths[i] && fuzz_results_write(watched->self, &watched->results, campaign, paths[i]))
            return STATUS_BAD;
    return STATUS_OK;
}

static int report(const struct watched *watched, const struct campaign_options *options,
                  const struct campaign *campaign)
{
    int status = write_results(watched, campaign);
    for (unsigned i = 0; i < campaign->findings && !status; i++)
        status = report_finding(watched->self, watched->settings, options, &campaign->finding[i]);
    summarize(watched->engines, options->run.threads, campaign);
    return status ? status : campaign->findings ? STATUS_DIFFERENT : STATUS_OK;
}

/* --- The command --- */

static int print_case(const struct command *self, const struct settings *settings)
{
    struct text text = {0};
    campaign_case(settings->seed, settings->print, &text);
    int bad = text.failed;
    if (!bad)
        fwrite(text.data, 1, text.length, stdout);
    text_free(&text);
    return bad ? tool_fail(self, "out of memory for a case") : STATUS_OK;
}

/* Draws the cases of the shard that `earlier` does not have. */
static int hold(struct watched *watched, struct campaign_options *options)
{
    static struct campaign campaign;
    const struct command *self = watched->self;
    struct error error = {{0}};
    interrupt_defer();
    int bad = campaign_run(options, watch, watched, &campaign, &error) ? tool_fail(self, "%s", error.text)
                                                                       : watched->status;
    int status = report(watched, options, &campaign);
    if (!bad)
        bad = campaign.interrupted && status != STATUS_BAD ? interrupt_status() : status;
    campaign_free(&campaign);
    return bad;
}

static int fuzz(const struct command *self, const struct settings *settings)
{
    static struct campaign earlier;
    struct campaign_options options = {.vary = !settings->set.count,
                                       .settings = choose_settings(&settings->set),
                                       .seed = settings->seed,
                                       .seconds = settings->seconds,
                                       .limit = settings->limit,
                                       .jobs = settings->jobs,
                                       .enough = settings->enough,
                                       .earlier = &earlier};
    struct watched watched = {
        .self = self,
        .settings = settings,
        .results = {settings->seed, settings->first, settings->count, .options = &options}};
    bool made;
    if (choose(self, settings, &options.run, &watched.engines) ||
        shard_read(self, settings->shard, &watched.results.shard) ||
        tool_check_output(self, settings->json) || tool_check_output(self, settings->resume) ||
        (settings->resume && fuzz_results_read(self, &watched.results, settings->resume, &earlier)) ||
        tool_make_folder(self, settings->folder, &made))
        return campaign_free(&earlier), STATUS_BAD;
    shard_part(&watched.results.shard, settings->count, &options.first, &options.count);
    options.first += settings->first;
    watched.part = options.count;
    watched.written = earlier.cases;
    watched.next = clock_seconds() + settings->checkpoint;
    int status = hold(&watched, &options);
    if (made)
        rmdir(settings->folder); /* succeeds only if nothing was found */
    campaign_free(&earlier);
    return status;
}

static const char notes[] = "Case N of seed S is always the same draw stream. Failing cases are reduced and "
                            "saved in the folder as streams.\n"
                            "Exit status 1: there are findings. After SIGINT or SIGTERM it reports its "
                            "findings; the status is 130 or 143.\n"
                            "Shard I of N draws consecutive cases. The shards' results, merged by triptych "
                            "merge, are those of one run.\n"
                            "--shard auto is the task of the Slurm array times the rank of the MPI launcher. "
                            "Without --shard,\nneither is read. With --resume, no case is drawn twice.";

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    (void)operands;
    return settings->print != NEVER ? print_case(self, settings) : fuzz(self, settings);
}

static const struct settings defaults = {.seed = 1,
                                         .count = 1000,
                                         .jobs = 1,
                                         .enough = 10,
                                         .print = NEVER,
                                         .limit = 60,
                                         .checkpoint = 30,
                                         .threads = "1,2",
                                         .folder = "findings"};

static const struct option options[] = {
    {"seed", "S", "seed of the campaign; 1", OPTION_IS_NUMBER(struct settings, seed), .most = NEVER},
    {"first", "N", "first case; 0", OPTION_IS_NUMBER(struct settings, first), .most = NEVER},
    {"count", "N", "number of cases; 1000", OPTION_IS_NUMBER(struct settings, count), .least = 1,
     .most = NEVER},
    {"seconds", "T", "end after this time", OPTION_IS_SECONDS(struct settings, seconds), .most = 10000000},
    {"engines", "LIST", "engines, separated by commas; all that can run here",
     OPTION_IS_LIST(struct settings, engines), .words = triptych_engine_name},
    OPTIONS_OF_VARIATION(struct settings, variation),
    {"threads", "LIST", "numbers of threads; 1,2", OPTION_IS_LIST(struct settings, threads)},
    {"set", "NAME=VALUE", "a setting of the renderer, for all cases; random ones for each",
     OPTION_IS_WORDS(struct settings, set), .words = setting_choice},
    {"jobs", "N", "processes; 1", OPTION_IS_NUMBER(struct settings, jobs), .least = 1, .most = CAMPAIGN_JOBS},
    {"limit", "T", "most seconds per case; 60", OPTION_IS_SECONDS(struct settings, limit), .least = 1,
     .most = 100000},
    {"findings", "N", "end after this number of findings; 10", OPTION_IS_NUMBER(struct settings, enough),
     .least = 1, .most = CAMPAIGN_FINDINGS},
    {"output", "DIR", "folder for findings; findings", OPTION_IS_FOLDER(struct settings, folder)},
    {"json", "FILE", "write the results", OPTION_IS_FILE(struct settings, json), .extension = "json"},
    OPTION_SHARD(struct settings, shard),
    OPTION_RESUME(struct settings, resume),
    {"checkpoint", "T", "seconds between two writes of --resume; 30",
     OPTION_IS_SECONDS(struct settings, checkpoint), .most = 100000},
    {"print", "N", "write case N to standard output instead", OPTION_IS_NUMBER(struct settings, print),
     .most = NEVER},
    {0},
};

const struct command command_fuzz = {
    .name = "fuzz",
    .summary = "draw random cases with every engine and compare",
    .options = options,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
