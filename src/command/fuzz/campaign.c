#define _GNU_SOURCE
#include "command/fuzz/campaign.h"

#include "base/clock.h"
#include "command/fuzz/case/case.h"
#include "command/fuzz/reduce/minimize.h"

#include <errno.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { POLL_NS = 20000000, TRIES = 4000 };

/* The results of one process. A finding is complete before the tally that counts it. */
struct tally {
    uint64_t drawn; /* positions of the process's part of the list, from its first on */
    uint64_t outcomes[OUTCOME_COUNT];
    uint64_t pixels;
    uint64_t findings;
};

enum { TALLY_WORDS = sizeof(struct tally) / sizeof(uint64_t) };

/* The state that a process reports. Only the process writes it, except `stop`; after its end, its parent.
 *
 * Tally number n, the n-th that was published, is in slot n % 2. The slot of the next one is the other, so a
 * process that is killed while it writes leaves the last tally complete. */
struct worker {
    _Atomic uint64_t started; /* when the case that is being drawn was begun, in ns; 0: between cases */
    _Atomic uint64_t published;
    _Atomic uint64_t slot[2][TALLY_WORDS];
    struct campaign_finding finding[CAMPAIGN_FINDINGS];
    _Atomic bool stop;
};

struct process {
    pid_t pid; /* 0: none */
    bool done;
};

struct run {
    const struct campaign_options *options;
    struct ranges list; /* the numbers of the cases to draw */
    uint64_t size;      /* of the list */
    struct worker *job; /* shared */
    struct process process[CAMPAIGN_JOBS];
    uint64_t begin;
    struct campaign *campaign;
};

/* --- Tallies -------------------------------------------------------------------------------------------- */

static void read_tally(struct worker *job, struct tally *tally)
{
    uint64_t words[TALLY_WORDS], number;
    do {
        number = atomic_load(&job->published);
        for (int i = 0; i < TALLY_WORDS; i++)
            words[i] = atomic_load(&job->slot[number % 2][i]);
    } while (atomic_load(&job->published) != number);
    memcpy(tally, words, sizeof *tally);
}

static void publish_tally(struct worker *job, const struct tally *tally)
{
    uint64_t words[TALLY_WORDS], number = atomic_load(&job->published) + 1;
    memcpy(words, tally, sizeof words);
    for (int i = 0; i < TALLY_WORDS; i++)
        atomic_store(&job->slot[number % 2][i], words[i]);
    atomic_store(&job->published, number);
}

/* The position in the list of process j's next case. */
static uint64_t next_position(const struct run *run, unsigned j, const struct tally *tally)
{
    return j + tally->drawn * run->options->jobs;
}

/* Adds a case. Its finding, if the outcome is one, must not be null. */
static void add_case(struct worker *job, struct tally *tally, enum outcome outcome, uint64_t number,
                     const struct finding *finding)
{
    if (outcome > OUTCOME_LIMITED && tally->findings < CAMPAIGN_FINDINGS)
        job->finding[tally->findings++] = (struct campaign_finding){number, *finding};
    tally->outcomes[outcome]++;
    tally->drawn++;
    publish_tally(job, tally);
}

void campaign_case(uint64_t seed, uint64_t number, struct text *text)
{
    struct random random = random_start(seed, number);
    text_cut(text, 0);
    case_write(&random, text);
}

/* The settings of the renderer that a case is drawn with; they depend on its seed and number only. */
static struct setting_values settings_of(const struct campaign_options *options, uint64_t number)
{
    enum { OTHER = 0x5e77 }; /* the case itself is another sequence */
    struct random random = random_start(options->seed ^ OTHER, number);
    struct setting_values values = options->settings;
    for (unsigned i = 0; options->vary && setting_name(i); i++) {
        unsigned count = 0;
        while (setting_value_name(i, count))
            count++;
        values.of[i] = (uint8_t)random_below(&random, count);
    }
    return values;
}

/* --- In a process --------------------------------------------------------------------------------------- */

static void draw_case(const struct campaign_options *options, struct runner *runner, struct worker *job,
                      struct tally *tally, uint64_t pixels, uint64_t number, const struct text *text)
{
    struct finding finding;
    const struct setting_values settings = settings_of(options, number);
    atomic_store(&job->started, clock_ns());
    enum outcome outcome = runner_run(runner, "case", text->data, text->length, &settings, &finding);
    tally->pixels = pixels + runner_pixels(runner);
    add_case(job, tally, outcome, number, &finding);
    atomic_store(&job->started, 0);
}

/* Does not return. The exit status is 0 when all cases have been drawn or the job was stopped. */
static void work(const struct run *run, unsigned j)
{
    const struct campaign_options *options = run->options;
    struct worker *job = &run->job[j];
    struct error error = {{0}};
    struct text text = {0};
    struct tally tally;
    struct runner *runner = runner_create(&options->run, &error);
    if (!runner) {
        fprintf(stderr, "triptych fuzz: %s\n", error.text);
        _exit(1);
    }
    read_tally(job, &tally);
    for (uint64_t pixels = tally.pixels, at; !atomic_load(&job->stop);) {
        if ((at = next_position(run, j, &tally)) >= run->size)
            break;
        uint64_t number = ranges_at(&run->list, at);
        campaign_case(options->seed, number, &text);
        if (text.failed)
            _exit(1);
        draw_case(options, runner, job, &tally, pixels, number, &text);
    }
    runner_destroy(runner);
    text_free(&text);
    fflush(NULL);
    _exit(0);
}

/* --- Around them ---------------------------------------------------------------------------------------- */

static int start(struct run *run, unsigned j, struct error *error)
{
    struct process *process = &run->process[j];
    pid_t parent = getpid();
    fflush(NULL);
    process->pid = fork();
    if (process->pid < 0) {
        process->pid = 0;
        return error_set(error, "cannot start a process: %s", strerror(errno));
    }
    if (!process->pid) {
        /* the parent process decides if the campaign ends */
        signal(SIGINT, SIG_IGN);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() == parent)
            work(run, j);
        _exit(1);
    }
    return 0;
}

/* A process has ended in the middle of a case. */
static void lose(struct run *run, unsigned j, struct tally *tally, enum outcome outcome, int status)
{
    struct worker *job = &run->job[j];
    uint64_t number = ranges_at(&run->list, next_position(run, j, tally));
    struct finding finding = {.outcome = outcome, .settings = settings_of(run->options, number)};
    if (outcome == OUTCOME_HUNG)
        snprintf(finding.what, sizeof finding.what, "takes longer than %g seconds", run->options->limit);
    else if (WIFSIGNALED(status))
        snprintf(finding.what, sizeof finding.what, "ends with signal %d, %s", WTERMSIG(status),
                 strsignal(WTERMSIG(status)));
    else
        snprintf(finding.what, sizeof finding.what, "ends with status %d", WEXITSTATUS(status));
    add_case(job, tally, outcome, number, &finding);
}

/* Looks after process j: it has ended well, is to be replaced, or goes on. A process that completes its case
 * just before it is killed has not lost it. */
static int attend(struct run *run, unsigned j, struct error *error)
{
    struct process *process = &run->process[j];
    struct worker *job = &run->job[j];
    struct tally tally;
    uint64_t published = atomic_load(&job->published), started = atomic_load(&job->started);
    bool hung = started && (double)(clock_ns() - started) > run->options->limit * 1e9;
    int status;
    if (!process->pid)
        return 0;
    if (hung)
        kill(process->pid, SIGKILL);
    if (waitpid(process->pid, &status, hung ? 0 : WNOHANG) != process->pid)
        return 0;
    process->pid = 0;
    process->done = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (process->done)
        return 0;
    if (!atomic_load(&job->started))
        return error_set(error, "a process ended between two cases");
    read_tally(job, &tally);
    if (!hung || atomic_load(&job->published) == published)
        lose(run, j, &tally, hung ? OUTCOME_HUNG : OUTCOME_CRASHED, status);
    atomic_store(&job->started, 0);
    process->done = next_position(run, j, &tally) >= run->size;
    return process->done || atomic_load(&job->stop) ? 0 : start(run, j, error);
}

/* --- Results -------------------------------------------------------------------------------------------- */

static double seconds_since(uint64_t begin)
{
    return (double)(clock_ns() - begin) / 1e9;
}

/* Adds the cases at the positions from `first` on that process j has drawn. */
static void add_done(const struct run *run, unsigned j, const struct tally *tally, uint64_t first,
                     struct ranges *done)
{
    for (uint64_t k = first > j ? (first - j + run->options->jobs - 1) / run->options->jobs : 0;
         k < tally->drawn; k++) {
        uint64_t number = ranges_at(&run->list, j + k * run->options->jobs);
        ranges_add(done, number, number);
    }
}

/* Adds the cases at the positions below `end`. */
static void add_first(const struct run *run, uint64_t end, struct ranges *done)
{
    for (size_t i = 0; i < run->list.count && end; i++) {
        const struct ranges_item *item = &run->list.item[i];
        uint64_t size = item->last - item->first + 1, count = size < end ? size : end;
        ranges_add(done, item->first, item->first + count - 1);
        end -= count;
    }
}

/* All cases below a position are drawn; the processes have drawn some beyond it. */
static void gather_done(const struct run *run, const struct tally *tally, struct ranges *done)
{
    uint64_t end = run->size;
    for (unsigned j = 0; j < run->options->jobs; j++) {
        uint64_t next = next_position(run, j, &tally[j]);
        if (next < end)
            end = next;
    }
    add_first(run, end, done);
    for (unsigned j = 0; j < run->options->jobs; j++)
        add_done(run, j, &tally[j], end, done);
}

static void add_tally(struct campaign *campaign, struct worker *job, const struct tally *tally)
{
    for (unsigned o = 0; o < OUTCOME_COUNT; o++) {
        campaign->outcomes[o] += tally->outcomes[o];
        campaign->cases += tally->outcomes[o];
    }
    campaign->pixels += tally->pixels;
    for (uint64_t i = 0; i < tally->findings && campaign->findings < CAMPAIGN_FINDINGS; i++)
        campaign->finding[campaign->findings++] = job->finding[i];
}

/* Empties the results, except for the earlier ones. */
static void reset(struct campaign *campaign, const struct campaign *earlier)
{
    struct ranges done = campaign->done;
    ranges_clear(&done);
    *campaign = earlier ? *earlier : (struct campaign){0};
    campaign->done = done;
    campaign->interrupted = false;
    if (earlier)
        ranges_add_all(&campaign->done, &earlier->done);
}

static void gather(struct run *run)
{
    struct campaign *campaign = run->campaign;
    struct tally tally[CAMPAIGN_JOBS];
    bool interrupted = campaign->interrupted;
    reset(campaign, run->options->earlier);
    campaign->interrupted = interrupted;
    for (unsigned j = 0; j < run->options->jobs; j++) {
        read_tally(&run->job[j], &tally[j]);
        add_tally(campaign, &run->job[j], &tally[j]);
    }
    gather_done(run, tally, &campaign->done);
    campaign->seconds += seconds_since(run->begin);
}

static int compare_findings(const void *a, const void *b)
{
    const struct campaign_finding *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

static bool is_running(const struct run *run)
{
    for (unsigned j = 0; j < run->options->jobs; j++)
        if (run->process[j].pid)
            return true;
    return false;
}

static void stop_all(struct run *run)
{
    for (unsigned j = 0; j < run->options->jobs; j++)
        atomic_store(&run->job[j].stop, true);
}

static void kill_all(struct run *run)
{
    for (unsigned j = 0; j < run->options->jobs; j++)
        if (run->process[j].pid) {
            kill(run->process[j].pid, SIGKILL);
            waitpid(run->process[j].pid, NULL, 0);
        }
}

static int hold(struct run *run, campaign_watch *watch, void *user, struct error *error)
{
    const struct campaign_options *options = run->options;
    struct campaign *campaign = run->campaign;
    gather(run);
    for (unsigned j = 0; j < options->jobs && campaign->findings < options->enough; j++)
        if (j < run->size && start(run, j, error))
            return -1;
    while (is_running(run)) {
        nanosleep(&(struct timespec){0, POLL_NS}, NULL);
        for (unsigned j = 0; j < options->jobs; j++)
            if (attend(run, j, error))
                return -1;
        gather(run);
        campaign->interrupted |= watch && watch(user, campaign);
        if (campaign->interrupted || campaign->findings >= options->enough ||
            (options->seconds > 0 && seconds_since(run->begin) >= options->seconds))
            stop_all(run);
    }
    return 0;
}

/* The cases that the earlier results do not have. */
static int list_cases(struct run *run, struct error *error)
{
    const struct campaign_options *options = run->options;
    static const struct ranges none;
    ranges_missing(options->earlier ? &options->earlier->done : &none, options->first,
                   options->first + options->count - 1, &run->list);
    run->size = ranges_size(&run->list);
    return run->list.failed ? error_set(error, "no memory for the list of the cases") : 0;
}

static int run_list(struct run *run, campaign_watch *watch, void *user, struct error *error)
{
    size_t bytes = run->options->jobs * sizeof(struct worker);
    run->job = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (run->job == MAP_FAILED)
        return error_set(error, "no memory that processes share: %s", strerror(errno));
    int result = hold(run, watch, user, error);
    kill_all(run);
    gather(run);
    munmap(run->job, bytes);
    qsort(run->campaign->finding, run->campaign->findings, sizeof *run->campaign->finding, compare_findings);
    if (!result && run->campaign->done.failed)
        result = error_set(error, "no memory for the numbers of the cases");
    return result;
}

int campaign_run(const struct campaign_options *options, campaign_watch *watch, void *user,
                 struct campaign *campaign, struct error *error)
{
    struct run run = {.options = options, .begin = clock_ns(), .campaign = campaign};
    reset(campaign, options->earlier);
    int result = options->count && list_cases(&run, error) ? -1 : run_list(&run, watch, user, error);
    ranges_free(&run.list);
    return result;
}

void campaign_free(struct campaign *campaign)
{
    ranges_free(&campaign->done);
    *campaign = (struct campaign){0};
}

/* --- One text ------------------------------------------------------------------------------------------- */

/* Does not return. */
static void try_here(const struct campaign_options *options, const char *path, const char *text, size_t bytes,
                     struct finding *finding)
{
    struct error error = {{0}};
    struct finding own;
    struct runner *runner = runner_create(&options->run, &error);
    if (!runner)
        _exit(1);
    runner_run(runner, path, text, bytes, &options->settings, &own);
    *finding = own;
    _exit(0);
}

/* Waits until the process ends or its time is over. */
static enum outcome await(pid_t pid, double limit)
{
    uint64_t begin = clock_ns();
    int status;
    while (waitpid(pid, &status, WNOHANG) != pid) {
        if ((double)(clock_ns() - begin) > limit * 1e9) {
            kill(pid, SIGKILL);
            waitpid(pid, &status, 0);
            return OUTCOME_HUNG;
        }
        nanosleep(&(struct timespec){0, 200000}, NULL);
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? OUTCOME_SAME : OUTCOME_CRASHED;
}

/* Draws a text in a process of its own, so that a crash or a hang is an outcome like others. */
static enum outcome try_text(const struct campaign_options *options, const char *path, const char *text,
                             size_t bytes, struct finding *finding)
{
    struct finding *shared =
        mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    *finding = (struct finding){.outcome = OUTCOME_REFUSED};
    if (shared == MAP_FAILED)
        return OUTCOME_REFUSED;
    fflush(NULL);
    pid_t pid = fork();
    if (!pid)
        try_here(options, path, text, bytes, shared);
    if (pid > 0) {
        enum outcome end = await(pid, options->limit);
        *finding = end ? (struct finding){.outcome = end} : *shared;
    }
    munmap(shared, sizeof *shared);
    return finding->outcome;
}

struct failure {
    struct campaign_options options;
    const struct finding *finding;
};

static bool fails(void *user, const char *text, size_t bytes)
{
    struct failure *failure = user;
    struct finding now;
    try_text(&failure->options, "case", text, bytes, &now);
    return now.outcome == failure->finding->outcome && now.engine == failure->finding->engine;
}

int campaign_minimize(const struct campaign_options *options, const struct finding *finding,
                      const struct text *text, struct text *smallest, struct error *error)
{
    struct failure failure = {*options, finding};
    struct runner_options *run = &failure.options.run;
    failure.options.settings = finding->settings;
    if (finding->engine && finding->engine != run->engine[0]) {
        run->engine[1] = finding->engine;
        run->engines = 2;
    }
    return minimize(text->data, text->length, fails, &failure, TRIES, smallest, NULL, error);
}
