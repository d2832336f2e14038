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
static const uint64_t nothing = UINT64_MAX;

/* The state that a process reports. Only the process writes it, except `stop`. */
struct worker {
    _Atomic uint64_t number;  /* of the case being drawn */
    _Atomic uint64_t started; /* when, in ns; 0: between cases */
    _Atomic uint64_t outcomes[OUTCOME_COUNT];
    _Atomic uint64_t pixels;
    _Atomic unsigned findings; /* complete ones */
    struct campaign_finding finding[CAMPAIGN_FINDINGS];
    _Atomic bool stop;
};

struct process {
    pid_t pid;     /* 0: none */
    uint64_t next; /* case to begin with */
    bool done;
};

struct run {
    const struct campaign_options *options;
    struct worker *job; /* shared */
    struct process process[CAMPAIGN_JOBS];
    uint64_t begin;
    struct campaign *campaign;
};

void campaign_case(uint64_t seed, uint64_t number, struct text *text)
{
    struct random random = random_start(seed, number);
    text_cut(text, 0);
    case_write(&random, text);
}

/* --- In a process --------------------------------------------------------------------------------------- */

static void tell(struct worker *job, uint64_t number, const struct finding *finding)
{
    unsigned i = atomic_load(&job->findings);
    if (i == CAMPAIGN_FINDINGS)
        return;
    job->finding[i] = (struct campaign_finding){number, *finding};
    atomic_store(&job->findings, i + 1);
}

static void draw_case(struct runner *runner, struct worker *job, uint64_t number, const struct text *text)
{
    struct finding finding;
    atomic_store(&job->number, number);
    atomic_store(&job->started, clock_ns());
    enum outcome outcome = runner_run(runner, "case", text->data, text->length, &finding);
    atomic_store(&job->started, 0);
    if (outcome > OUTCOME_LIMITED)
        tell(job, number, &finding);
    atomic_fetch_add(&job->outcomes[outcome], 1);
}

/* Does not return. The exit status is 0 when all cases have been drawn or the job was stopped. */
static void work(const struct campaign_options *options, struct worker *job, uint64_t number)
{
    struct error error = {{0}};
    struct text text = {0};
    struct runner *runner = runner_create(&options->run, &error);
    uint64_t pixels = atomic_load(&job->pixels);
    if (!runner) {
        fprintf(stderr, "triptych fuzz: %s\n", error.text);
        _exit(1);
    }
    for (; number < options->count && !atomic_load(&job->stop); number += options->jobs) {
        campaign_case(options->seed, options->first + number, &text);
        if (text.failed)
            _exit(1);
        draw_case(runner, job, options->first + number, &text);
        atomic_store(&job->pixels, pixels + runner_pixels(runner));
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
            work(run->options, &run->job[j], process->next);
        _exit(1);
    }
    return 0;
}

/* A process has ended in the middle of a case. */
static void lose(struct run *run, unsigned j, enum outcome outcome, int status)
{
    struct worker *job = &run->job[j];
    struct finding finding = {.outcome = outcome};
    if (outcome == OUTCOME_HUNG)
        snprintf(finding.what, sizeof finding.what, "takes longer than %g seconds", run->options->limit);
    else if (WIFSIGNALED(status))
        snprintf(finding.what, sizeof finding.what, "ends with signal %d, %s", WTERMSIG(status),
                 strsignal(WTERMSIG(status)));
    else
        snprintf(finding.what, sizeof finding.what, "ends with status %d", WEXITSTATUS(status));
    uint64_t number = atomic_load(&job->number);
    tell(job, number, &finding);
    atomic_fetch_add(&job->outcomes[outcome], 1);
    atomic_store(&job->started, 0);
    run->process[j].next = number - run->options->first + run->options->jobs;
}

/* Looks after process j: it has ended well, is to be replaced, or goes on. */
static int attend(struct run *run, unsigned j, struct error *error)
{
    struct process *process = &run->process[j];
    struct worker *job = &run->job[j];
    uint64_t started = atomic_load(&job->started);
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
    if (!atomic_load(&job->started) || atomic_load(&job->number) == nothing)
        return error_set(error, "a process ended between two cases");
    lose(run, j, hung ? OUTCOME_HUNG : OUTCOME_CRASHED, status);
    process->done = process->next >= run->options->count;
    return process->done || atomic_load(&job->stop) ? 0 : start(run, j, error);
}

static void gather(struct run *run)
{
    struct campaign *campaign = run->campaign;
    const struct campaign_options *options = run->options;
    *campaign = (struct campaign){.interrupted = campaign->interrupted};
    for (unsigned j = 0; j < options->jobs; j++) {
        struct worker *job = &run->job[j];
        for (unsigned o = 0; o < OUTCOME_COUNT; o++) {
            uint64_t count = atomic_load(&job->outcomes[o]);
            campaign->outcomes[o] += count;
            campaign->cases += count;
        }
        campaign->pixels += atomic_load(&job->pixels);
        unsigned findings = atomic_load(&job->findings);
        for (unsigned i = 0; i < findings && campaign->findings < CAMPAIGN_FINDINGS; i++)
            campaign->finding[campaign->findings++] = job->finding[i];
    }
    campaign->seconds = (double)(clock_ns() - run->begin) / 1e9;
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
    for (unsigned j = 0; j < options->jobs; j++) {
        run->process[j].next = j;
        run->job[j].number = nothing;
        if (j < options->count && start(run, j, error))
            return -1;
    }
    while (is_running(run)) {
        nanosleep(&(struct timespec){0, POLL_NS}, NULL);
        for (unsigned j = 0; j < options->jobs; j++)
            if (attend(run, j, error))
                return -1;
        gather(run);
        campaign->interrupted |= watch && watch(user, campaign);
        if (campaign->interrupted || campaign->findings >= options->enough ||
            (options->seconds > 0 && campaign->seconds >= options->seconds))
            stop_all(run);
    }
    return 0;
}

int campaign_run(const struct campaign_options *options, campaign_watch *watch, void *user,
                 struct campaign *campaign, struct error *error)
{
    size_t bytes = options->jobs * sizeof(struct worker);
    struct run run = {.options = options, .begin = clock_ns(), .campaign = campaign};
    run.job = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (run.job == MAP_FAILED)
        return error_set(error, "no memory that processes share: %s", strerror(errno));
    *campaign = (struct campaign){.cases = 0};
    int result = hold(&run, watch, user, error);
    kill_all(&run);
    gather(&run);
    munmap(run.job, bytes);
    return result;
}

/* --- One text ------------------------------------------------------------------------------------------- */

/* Does not return. */
static void try_here(const struct runner_options *options, const char *path, const char *text, size_t bytes,
                     struct finding *finding)
{
    struct error error = {{0}};
    struct finding own;
    struct runner *runner = runner_create(options, &error);
    if (!runner)
        _exit(1);
    runner_run(runner, path, text, bytes, &own);
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
        try_here(&options->run, path, text, bytes, shared);
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
    if (finding->engine && finding->engine != run->engine[0]) {
        run->engine[1] = finding->engine;
        run->engines = 2;
    }
    return minimize(text->data, text->length, fails, &failure, TRIES, smallest, NULL, error);
}
