/* The driver of `make peers`. It starts the renderers (peer.h), lets them measure the workloads in turns,
 * compares their pictures, and writes the reports.
 *
 *   drive OPTION... <RENDERERS
 *
 * A line of standard input is a renderer: NAME engine|peer|special one|all COMMAND..., or `missing REASON`
 * instead of the command. Renderers on one core are bound to the last core that the driver may use.
 *
 * For each workload, renderers take turns pass by pass, so that other processes of the machine disturb all of
 * them equally. A slow renderer has fewer passes, and frames with fewer layers. Every picture is compared
 * with the picture of the reference: an engine's picture must be equal, and a peer's picture similar. The
 * status is 1 if a picture differs or a renderer failed. */
#define _GNU_SOURCE /* sched_setaffinity */
#include "base/clock.h"
#include "drive.h"

#include <fcntl.h>
#include <fnmatch.h>
#include <sched.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const double frame_most = 0.4;              /* seconds: slower ones are drawn with fewer layers */
static const double share_tolerated = 0.005;       /* of pixels: at edges, rules of coverage differ */
static const double page_share_tolerated = 0.0005; /* of a page's, whose rectangles have whole pixels */

/* --- Processes ------------------------------------------------------------------------------------------ */

static void bind_to_last_core(void)
{
    cpu_set_t set, one;
    CPU_ZERO(&one);
    if (sched_getaffinity(0, sizeof set, &set))
        return;
    for (int i = CPU_SETSIZE - 1; i >= 0; i--)
        if (CPU_ISSET(i, &set)) {
            CPU_SET(i, &one);
            sched_setaffinity(0, sizeof one, &one);
            return;
        }
}

static void become(const struct renderer *renderer, int input, int output)
{
    if (renderer->cores == ONE)
        bind_to_last_core();
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    execvp(renderer->command[0], renderer->command);
    _exit(127);
}

static int launch(struct renderer *renderer)
{
    int to[2], from[2];
    if (pipe2(to, O_CLOEXEC))
        return -1;
    if (pipe2(from, O_CLOEXEC))
        return close(to[0]), close(to[1]), -1;
    renderer->process = fork();
    if (!renderer->process)
        become(renderer, to[0], from[1]);
    close(to[0]);
    close(from[1]);
    renderer->to = fdopen(to[1], "w");
    renderer->from = fdopen(from[0], "r");
    return renderer->process < 0 || !renderer->to || !renderer->from ? -1 : 0;
}

static void land(struct renderer *renderer)
{
    if (renderer->to)
        fclose(renderer->to);
    if (renderer->from)
        fclose(renderer->from);
    if (renderer->process > 0)
        waitpid(renderer->process, NULL, 0);
    renderer->to = renderer->from = NULL;
    renderer->process = 0;
}

/* Sends a command and reads the answer after "ok ". Lines that libraries print are not answers. Returns 0,
 * or -1 with the reason. */
static int ask(struct renderer *renderer, char answer[REASON_BYTES], const char *format, ...)
{
    char line[REASON_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vfprintf(renderer->to, format, arguments);
    va_end(arguments);
    fputc('\n', renderer->to);
    fflush(renderer->to);
    while (fgets(line, sizeof line, renderer->from)) {
        line[strcspn(line, "\n")] = 0;
        bool good = !strncmp(line, "ok", 2) && (!line[2] || line[2] == ' ');
        if (good || !strncmp(line, "error ", 6)) {
            snprintf(answer, REASON_BYTES, "%s", line + (good ? 2 + (line[2] == ' ') : 6));
            return good ? 0 : -1;
        }
    }
    snprintf(answer, REASON_BYTES, "the process ended");
    return -1;
}

void run_start(struct run *run)
{
    signal(SIGPIPE, SIG_IGN);
    for (unsigned i = 0; i < run->renderer_count; i++) {
        struct renderer *renderer = run->renderers + i;
        if (!renderer->command[0])
            continue;
        if (launch(renderer) || ask(renderer, renderer->reason, "hello")) {
            land(renderer);
            renderer->command[0] = NULL;
            run->bad = true; /* it is installed, but does not run */
            continue;
        }
        snprintf(renderer->description, sizeof renderer->description, "%s", renderer->reason);
        *renderer->reason = 0;
    }
}

void run_end(struct run *run)
{
    for (unsigned i = 0; i < run->renderer_count; i++)
        land(run->renderers + i);
}

/* --- Pictures ------------------------------------------------------------------------------------------- */

static int read_picture(const char *path, uint8_t *picture)
{
    FILE *file = fopen(path, "rb");
    size_t got = file ? fread(picture, (size_t)PIXELS * 4, 1, file) : 0;
    if (file)
        fclose(file);
    return got == 1 ? 0 : -1;
}

static double share_beyond(const uint8_t *a, const uint8_t *b, int tolerance)
{
    unsigned beyond = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        int far = 0;
        for (size_t channel = 4 * i; channel < 4 * i + 4; channel++)
            far |= abs(a[channel] - b[channel]) > tolerance;
        beyond += (unsigned)far;
    }
    return (double)beyond / PIXELS;
}

static int draw_picture(struct run *run, unsigned r, bool less, uint8_t *picture, char reason[REASON_BYTES])
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%u.raw", run->folder, r);
    if (ask(run->renderers + r, reason, "image %s %s", less ? "less" : "full", path))
        return -1;
    int bad = read_picture(path, picture);
    if (bad)
        snprintf(reason, REASON_BYTES, "no picture in %.200s", path);
    unlink(path);
    return bad;
}

static void compare(struct run *run, const struct workload *workload, struct cell *cells)
{
    static uint8_t reference[2][PIXELS * 4], picture[PIXELS * 4];
    char reason[REASON_BYTES];
    int r = run->reference;
    if (r < 0 || !cells[r].measured || draw_picture(run, (unsigned)r, false, reference[0], reason) ||
        draw_picture(run, (unsigned)r, true, reference[1], reason))
        return;
    for (unsigned i = 0; i < run->renderer_count; i++) {
        struct cell *cell = cells + i;
        if (!cell->measured)
            continue;
        if (draw_picture(run, i, cell->less, picture, cell->reason)) {
            cell->measured = false;
            continue;
        }
        bool exact = run->renderers[i].side == ENGINE && run->renderers[r].side == ENGINE;
        cell->share = share_beyond(picture, reference[cell->less], exact ? 0 : (int)workload->tolerance);
        double tolerated = workload->group == PAGE ? page_share_tolerated : share_tolerated;
        cell->agreement = !memcmp(picture, reference[cell->less], sizeof picture) ? IDENTICAL
                          : !exact && cell->share <= tolerated                    ? SIMILAR
                                                                                  : DIFFERENT;
    }
}

/* --- Measuring ------------------------------------------------------------------------------------------ */

static void fail(struct cell *cell, const char *reason)
{
    cell->measured = false;
    snprintf(cell->reason, sizeof cell->reason, "%s", reason);
}

static void open_all(struct run *run, const struct workload *workload, struct cell *cells)
{
    for (unsigned i = 0; i < run->renderer_count; i++) {
        char answer[REASON_BYTES];
        double less_ms = 0;
        struct cell *cell = cells + i;
        if (!run->renderers[i].to)
            continue;
        cell->measured = true;
        if (ask(run->renderers + i, answer, "open %s", workload->name))
            fail(cell, answer);
        else if (!strcmp(answer, "none"))
            *cell = (struct cell){.absent = true};
        else if (sscanf(answer, "%lf %lf %lf %lf", &cell->cold[TIME], &cell->cold[WORK], &less_ms,
                        &cell->build_us) != 4)
            fail(cell, "no numbers from open");
        cell->less = less_ms * workload->full / workload->less > frame_most * 1e3;
    }
}

static void measure_one(struct run *run, const struct workload *workload, unsigned i, struct cell *cell)
{
    char answer[REASON_BYTES];
    double time, work, start = clock_seconds();
    if (ask(run->renderers + i, answer, "measure %s %g", cell->less ? "less" : "full", run->seconds)) {
        fail(cell, answer);
        return;
    }
    if (sscanf(answer, "%lf %lf", &time, &work) != 2) {
        fail(cell, "no numbers from measure");
        return;
    }
    double layers = workload->rate == MS ? 1 : cell->less ? workload->less : workload->full;
    cell->ms[TIME][cell->count] = time / layers;
    cell->ms[WORK][cell->count++] = work / layers;
    cell->spent += clock_seconds() - start;
}

static void measure_workload(struct run *run, const struct workload *workload, struct cell *cells)
{
    open_all(run, workload, cells);
    compare(run, workload, cells);
    for (unsigned pass = 0; pass < run->passes; pass++)
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (cells[i].measured && (!cells[i].count || cells[i].spent < run->budget))
                measure_one(run, workload, i, cells + i);
    for (unsigned i = 0; i < run->renderer_count; i++) {
        char answer[REASON_BYTES];
        if (run->renderers[i].to)
            ask(run->renderers + i, answer, "close");
        run->bad |= run->renderers[i].to && !cells[i].absent &&
                    (!cells[i].measured || cells[i].agreement == DIFFERENT);
    }
}

void run_measure(struct run *run)
{
    for (unsigned i = 0; i < run->count; i++) {
        if (isatty(STDERR_FILENO))
            fprintf(stderr, "\r\033[K%u of %u: %s", i + 1, run->count, run->workloads[i]->name);
        measure_workload(run, run->workloads[i], run->cells[i]);
    }
    if (isatty(STDERR_FILENO))
        fprintf(stderr, "\r\033[K");
}

/* --- The command ---------------------------------------------------------------------------------------- */

static void stop(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));

static void stop(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("peers: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    exit(2);
}

static void read_renderer(struct run *run, char *line)
{
    if (run->renderer_count == RENDERERS_MAXIMUM)
        stop("more than %d renderers", RENDERERS_MAXIMUM);
    struct renderer *renderer = run->renderers + run->renderer_count++;
    char side[16], cores[16];
    int used = 0;
    if (sscanf(line, "%47s %15s %15s %n", renderer->name, side, cores, &used) != 3 || !used)
        stop("found '%s', expected NAME engine|peer|special one|all COMMAND", line);
    renderer->side = !strcmp(side, "engine") ? ENGINE : !strcmp(side, "peer") ? PEER : SPECIAL;
    renderer->cores = strcmp(cores, "all") ? ONE : ALL;
    snprintf(renderer->text, sizeof renderer->text, "%s", line + used);
    if (!strncmp(renderer->text, "missing ", 8)) {
        snprintf(renderer->reason, sizeof renderer->reason, "%.250s", renderer->text + 8);
        return;
    }
    unsigned count = 0;
    for (char *word = strtok(renderer->text, " "); word && count < 31; word = strtok(NULL, " "))
        renderer->command[count++] = word;
    if (!count)
        stop("renderer %s has no command", renderer->name);
}

static void read_renderers(struct run *run)
{
    char line[1400];
    while (fgets(line, sizeof line, stdin)) {
        line[strcspn(line, "\n")] = 0;
        if (*line)
            read_renderer(run, line);
    }
    if (!run->renderer_count)
        stop("no renderers, expected a line for each on standard input");
}

static void choose_workloads(struct run *run, const char *pattern)
{
    for (unsigned i = 0; i < workload_count; i++)
        if (!fnmatch(pattern, workloads[i].name, 0))
            run->workloads[run->count++] = workloads + i;
    if (!run->count)
        stop("no workload is named like '%s'", pattern);
    run->cells = calloc(run->count, sizeof *run->cells);
    if (!run->cells)
        stop("no memory for %u workloads", run->count);
}

/* Chooses the reference: the reported engine on one core, which draws quickly; else any engine, else any
 * renderer. */
static void choose_reference(struct run *run)
{
    int best = -1;
    run->reference = -1;
    for (unsigned i = 0; i < run->renderer_count; i++) {
        const struct renderer *renderer = run->renderers + i;
        int worth = renderer->side == ENGINE ? !strcmp(renderer->name, run->engine) ? 2 : 1 : 0;
        if (renderer->to && worth > best) {
            best = worth;
            run->reference = (int)i;
        }
    }
}

static double number_of(const char *option, const char *text, double least, double most)
{
    char *end;
    double value = strtod(text, &end);
    if (*end || end == text || value < least || value > most)
        stop("%s: found '%s', expected %g to %g", option, text, least, most);
    return value;
}

int main(int count, char **arguments)
{
    struct run run = {.passes = 5,
                      .seconds = 0.12,
                      .budget = 3,
                      .folder = "build/peers",
                      .engine = "specialize",
                      .clock = WORK};
    const char *pattern = "*", *json = NULL, *csv = NULL, *text = NULL;
    for (int i = 1; i < count; i += 2) {
        const char *option = arguments[i], *value = i + 1 < count ? arguments[i + 1] : "";
        if (!strcmp(option, "--passes"))
            run.passes = (unsigned)number_of(option, value, 1, PASSES_MAXIMUM);
        else if (!strcmp(option, "--seconds"))
            run.seconds = number_of(option, value, 0.001, 60);
        else if (!strcmp(option, "--budget"))
            run.budget = number_of(option, value, 0, 3600);
        else if (!strcmp(option, "--workload"))
            pattern = value;
        else if (!strcmp(option, "--engine"))
            run.engine = value;
        else if (!strcmp(option, "--folder"))
            run.folder = value;
        else if (!strcmp(option, "--clock"))
            run.clock = strcmp(value, "time") ? WORK : TIME;
        else if (!strcmp(option, "--json"))
            json = value;
        else if (!strcmp(option, "--csv"))
            csv = value;
        else if (!strcmp(option, "--text"))
            text = value;
        else
            stop("found '%s', expected an option", option);
    }
    run.machine = machine_describe();
    read_renderers(&run);
    choose_workloads(&run, pattern);
    run_start(&run);
    choose_reference(&run);
    run_measure(&run);
    run_end(&run);
    int bad = report_text(&run, stdout);
    FILE *file = text ? fopen(text, "w") : NULL;
    bad |= text && (!file || report_text(&run, file));
    bad |= file && fclose(file);
    bad |= json && report_json(&run, json);
    bad |= csv && report_csv(&run, csv);
    free(run.cells);
    if (bad)
        stop("a report cannot be written");
    return run.bad;
}
