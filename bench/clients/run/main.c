/* Programs that are not graphics, in three ways: plain C, a library, and kernels of Triptych's engines.
 *
 *   clients                      the table; a run is measured by processor time, and by wall time on 1 and 2
 *                                threads
 *   clients --json FILE          the same to a file
 *   clients --compare N          compares N random cases of each client with its library
 *   clients --run JOB WAY N      runs a job N times: for valgrind, which counts instructions
 *   clients --jobs               the names of the jobs
 *
 * WAY is plain, library or an engine. The engines have different numbers of lanes. Results of all ways are
 * compared before they are measured; a difference ends the program with 1. */
#include "base/clock.h"
#include "bench/clients/run/scale.h"
#include "bench/clients/run/work.h"
#include "command/bench/machine.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { JOBS = 16, REPETITIONS = 7 };

/* A run on threads is repeated until it takes this time, in seconds. */
static const double together = 0.02;

static const char *const ways[] = {"plain",        "library",      "emulate",       "batch-4",
                                   "batch-8",      "batch-16",     "batch",         "specialize-1",
                                   "specialize-4", "specialize-8", "specialize-16", "specialize-8x2",
                                   "specialize",   "external"};
enum { WAYS = sizeof ways / sizeof ways[0] };

/* The jobs of each thread have memory of their own. */
static struct work jobs[SCALE_THREADS][JOBS];
static size_t job_count;

_Noreturn void work_fail(const char *reason)
{
    fprintf(stderr, "clients: %s\n", reason);
    exit(2);
}

void *work_memory(size_t bytes)
{
    void *memory = calloc(1, bytes);
    if (!memory)
        work_fail("out of memory");
    return memory;
}

struct kernel *work_kernel(const struct kernel_text *text, const void *choice, unsigned stride)
{
    struct error error = {{0}};
    struct kernel *kernel = kernel_create(text, choice, stride, "specialize", &error);
    if (!kernel)
        work_fail(error.text);
    return kernel;
}

static enum way way_of(const char *name)
{
    return !strcmp(name, "plain") ? WAY_PLAIN : !strcmp(name, "library") ? WAY_LIBRARY : WAY_KERNEL;
}

/* The kernel of a way, or null for the ways without one. */
static struct kernel *kernel_of(const struct work *job, const char *way)
{
    struct error error = {{0}};
    if (way_of(way) != WAY_KERNEL)
        return NULL;
    struct kernel *kernel = kernel_create(job->text, job->choice, job->stride, way, &error);
    if (!kernel)
        work_fail(error.text);
    return kernel;
}

static size_t make_jobs(struct work *work)
{
    size_t count = work_cipher(work);
    count += work_filter(work + count);
    return count + work_matcher(work + count);
}

/* --- Comparison ----------------------------------------------------------------------------------------- */

static int largest_difference(const uint8_t *a, const uint8_t *b, size_t bytes)
{
    int most = 0;
    for (size_t i = 0; i < bytes; i++)
        most = abs(a[i] - b[i]) > most ? abs(a[i] - b[i]) : most;
    return most;
}

/* Compares the result of a way with that of plain C. Only the library may differ, by the job's bound. */
static void compare(struct work *job, const char *way, const struct kernel *kernel, const uint8_t *expected)
{
    memset(job->out, 0xee, job->out_bytes);
    job->run(job, way_of(way), kernel);
    int bound = way_of(way) == WAY_LIBRARY ? job->bound : 0;
    int difference = largest_difference(expected, job->out, job->out_bytes);
    if (difference <= bound)
        return;
    fprintf(stderr, "clients: %s: %s differs from plain C by %d, expected at most %d\n", job->name, way,
            difference, bound);
    exit(1);
}

static int compare_random(unsigned cases)
{
    unsigned cipher = work_cipher_differences(cases), filter = work_filter_differences(cases);
    unsigned matcher = work_matcher_differences(cases);
    printf("differences in %u cases each: cipher %u, filter %u, matcher %u\n", cases, cipher, filter,
           matcher);
    return cipher || filter || matcher;
}

/* --- Measurement ---------------------------------------------------------------------------------------- */

/* The least time of several runs, in ns a byte. */
static double measure(struct work *job, const char *way, const struct kernel *kernel)
{
    double least = 1e30;
    for (int n = 0; n < REPETITIONS; n++) {
        double start = clock_seconds_of(CLOCK_THREAD_CPUTIME_ID);
        job->run(job, way_of(way), kernel);
        double time = clock_seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
        least = time < least ? time : least;
    }
    return least * 1e9 / (double)job->bytes;
}

/* Adds the speed on each number of threads. Libraries are left out: they can have threads of their own. */
static void add_threads(cJSON *row, size_t job, const char *way, const struct kernel *kernel, double ns)
{
    cJSON *list = cJSON_AddArrayToObject(row, "threads");
    struct work *const work[SCALE_THREADS] = {&jobs[0][job], &jobs[1][job]};
    double one = 0;
    for (unsigned count = 1; count <= SCALE_THREADS && way_of(way) != WAY_LIBRARY; count++) {
        double run_seconds = ns * (double)work[0]->bytes / 1e9;
        double time = scale_measure(work, count, way_of(way), kernel, run_seconds, together);
        one = count == 1 ? time : one;
        cJSON *each = cJSON_CreateObject();
        cJSON_AddNumberToObject(each, "threads", count);
        cJSON_AddNumberToObject(each, "ns_a_byte", time);
        cJSON_AddNumberToObject(each, "times", one / time);
        cJSON_AddItemToArray(list, each);
        printf(" %7.2f", count == 1 ? 1e3 / time : one / time);
    }
    printf("\n");
}

static cJSON *row_of(const char *way, double ns, const struct kernel *kernel)
{
    const struct kernel_size size = kernel ? kernel_size(kernel) : (struct kernel_size){0};
    cJSON *row = cJSON_CreateObject();
    cJSON_AddStringToObject(row, "way", way);
    cJSON_AddNumberToObject(row, "lanes", size.lanes);
    cJSON_AddNumberToObject(row, "ns_a_byte", ns);
    cJSON_AddNumberToObject(row, "recorded", size.recorded);
    cJSON_AddNumberToObject(row, "left", size.instructions);
    cJSON_AddNumberToObject(row, "code_bytes", size.code_bytes);
    cJSON_AddNumberToObject(row, "build_us", (double)size.build_ns / 1e3);
    printf("  %-14s %5u %8.0f %8u %8u %8u %9.1f", way, size.lanes, 1e3 / ns, size.recorded, size.instructions,
           size.code_bytes, (double)size.build_ns / 1e3);
    return row;
}

static cJSON *measure_way(size_t number, const char *way, const uint8_t *expected)
{
    struct work *job = &jobs[0][number];
    struct kernel *kernel = kernel_of(job, way);
    compare(job, way, kernel, expected);
    double ns = measure(job, way, kernel);
    cJSON *row = row_of(way, ns, kernel);
    add_threads(row, number, way, kernel, ns);
    for (int thread = 1; thread < SCALE_THREADS && way_of(way) != WAY_LIBRARY; thread++)
        compare(&jobs[thread][number], way, kernel, expected);
    kernel_free(kernel);
    return row;
}

static cJSON *measure_job(size_t number)
{
    struct work *job = &jobs[0][number];
    uint8_t *expected = work_memory(job->out_bytes);
    cJSON *report = cJSON_CreateObject(), *rows = cJSON_AddArrayToObject(report, "ways");
    cJSON_AddStringToObject(report, "job", job->name);
    cJSON_AddStringToObject(report, "about", job->about);
    cJSON_AddStringToObject(report, "library", job->library);
    printf("%s: %s; library: %s\n", job->name, job->about, job->library);
    job->run(job, WAY_PLAIN, NULL);
    memcpy(expected, job->out, job->out_bytes);
    for (int w = 0; w < WAYS; w++) {
        if (way_of(ways[w]) == WAY_KERNEL && kernel_unavailable(ways[w]))
            continue;
        cJSON_AddItemToArray(rows, measure_way(number, ways[w], expected));
    }
    free(expected);
    return report;
}

static int write_json(cJSON *report, const char *path)
{
    char *text = cJSON_Print(report);
    FILE *file = path && text ? fopen(path, "w") : NULL;
    bool bad = path && (!file || fprintf(file, "%s\n", text) < 0);
    if (file)
        bad |= fclose(file) != 0;
    if (bad)
        fprintf(stderr, "clients: %s cannot be written\n", path);
    free(text);
    return bad ? 2 : 0;
}

static int measure_all(const char *path)
{
    for (int thread = 1; thread < SCALE_THREADS; thread++)
        make_jobs(jobs[thread]);
    const struct machine machine = machine_describe();
    cJSON *report = cJSON_CreateObject();
    cJSON_AddItemToObject(report, "machine", machine_json(&machine));
    cJSON *list = cJSON_AddArrayToObject(report, "jobs");
    printf("  %-14s %5s %8s %8s %8s %8s %9s %7s %7s\n", "", "lanes", "MB/s", "recorded", "left", "bytes",
           "build, us", "wall", "two: x");
    for (size_t n = 0; n < job_count; n++)
        cJSON_AddItemToArray(list, measure_job(n));
    int result = write_json(report, path);
    cJSON_Delete(report);
    return result;
}

static int run_job(const char *name, const char *way, long count)
{
    for (size_t n = 0; n < job_count; n++)
        if (!strcmp(jobs[0][n].name, name)) {
            struct kernel *kernel = kernel_of(&jobs[0][n], way);
            while (count-- > 0)
                jobs[0][n].run(&jobs[0][n], way_of(way), kernel);
            kernel_free(kernel);
            return 0;
        }
    work_fail("there is no such job: --jobs lists them");
}

static void list_jobs(void)
{
    for (size_t n = 0; n < job_count; n++)
        printf("%s\t%zu\n", jobs[0][n].name, jobs[0][n].bytes);
}

int main(int count, char **argument)
{
    if (count == 3 && !strcmp(argument[1], "--compare"))
        return compare_random((unsigned)strtoul(argument[2], NULL, 10));
    job_count = make_jobs(jobs[0]);
    if (count == 5 && !strcmp(argument[1], "--run"))
        return run_job(argument[2], argument[3], strtol(argument[4], NULL, 10));
    if (count == 2 && !strcmp(argument[1], "--jobs"))
        return list_jobs(), 0;
    if (count == 3 && !strcmp(argument[1], "--json"))
        return measure_all(argument[2]);
    if (count > 1)
        work_fail("expected --json FILE, --compare N, --run JOB WAY N, --jobs, or nothing");
    return measure_all(NULL);
}
