/* A process that imports many models. A new process for every import would copy its page tables, which are
 * large with sanitizers. This process exists until it crashes, or for LIFE imports. Requests and answers are
 * in memory that both processes share, and a byte through a pipe announces each. If the parent closes the
 * pipe, the process ends.
 *
 * Coverage is sent back too, so that libFuzzer observes how a scene becomes a mesh: the edge counters
 * (section __sancov_cntrs, absent in other builds) are added to those of the parent.
 *
 * A crash in the library is expected. The linker puts functions before the two in which Assimp reads and
 * frees (--wrap), so the parent can distinguish the two cases: a crash elsewhere is a finding. */
#define _GNU_SOURCE
#include "tests/command/fuzz/targets/importer.h"

#include "command/import/assimp.h"
#include "command/assets/mesh.h"
#include "command/assets/transfer.h"
#include "tests/command/fuzz/targets/target.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    LIFE = 512,
    ANSWER = 16 << 20,
    MEMORY = 512 << 20,
    PROCESSOR_MICROSECONDS = 50000,
    MILLISECONDS = 4000
};

struct exchange {
    volatile int in_assimp;
    unsigned parts;
    int failed;
    char path[64];
    struct error reason;
    size_t bytes;
    uint8_t data[ANSWER];
};

static struct exchange *exchange;
static uint8_t *covered; /* the importer's counters */
static pid_t importer;
static int channel, served;

extern uint8_t __start___sancov_cntrs[] __attribute__((weak));
extern uint8_t __stop___sancov_cntrs[] __attribute__((weak));

static size_t counter_bytes(void)
{
    return (size_t)(__stop___sancov_cntrs - __start___sancov_cntrs);
}

/* --- Sanitizers ----------------------------------------------------------------------------------------- */

const char *__asan_default_options(void);
void __asan_on_error(void);
void __sanitizer_set_death_callback(void (*callback)(void)) __attribute__((weak));

/* malloc returns null if memory is refused, as in the C library, because imports have a limit. Freed memory
 * is reused earlier than usual, because a fork of a larger process needs more time. */
const char *__asan_default_options(void)
{
    return "allocator_may_return_null=1:quarantine_size_mb=32";
}

/* Ends the process without a report if Assimp damages the heap. A report would start a symbolizer. */
void __asan_on_error(void)
{
    if (exchange && exchange->in_assimp)
        _exit(1);
}

/* The end of an importer's process is not a finding, so a sanitizer there must not report it to libFuzzer. */
static void forget_callback(void)
{
    if (__sanitizer_set_death_callback)
        __sanitizer_set_death_callback(NULL);
}

/* --- The code that is running ------------------------------------------------------------------------- */

const struct aiScene *__real_assimp_import(const struct assimp *assimp, const char *path, unsigned steps,
                                           struct aiFileIO *files, const struct aiPropertyStore *properties);
const struct aiScene *__wrap_assimp_import(const struct assimp *assimp, const char *path, unsigned steps,
                                           struct aiFileIO *files, const struct aiPropertyStore *properties);
void __real_assimp_release(const struct assimp *assimp, const struct aiScene *scene);
void __wrap_assimp_release(const struct assimp *assimp, const struct aiScene *scene);

static void set_in_assimp(int in_assimp)
{
    if (exchange)
        exchange->in_assimp = in_assimp;
}

const struct aiScene *__wrap_assimp_import(const struct assimp *assimp, const char *path, unsigned steps,
                                           struct aiFileIO *files, const struct aiPropertyStore *properties)
{
    set_in_assimp(1);
    const struct aiScene *scene = __real_assimp_import(assimp, path, steps, files, properties);
    set_in_assimp(0);
    return scene;
}

void __wrap_assimp_release(const struct assimp *assimp, const struct aiScene *scene)
{
    set_in_assimp(1);
    __real_assimp_release(assimp, scene);
    set_in_assimp(0);
}

int importer_died_in_assimp(void)
{
    return exchange->in_assimp;
}

/* --- The importer --------------------------------------------------------------------------------------- */

static void restrict_process(void)
{
    static const int fatal[] = {SIGSEGV, SIGBUS,  SIGFPE, SIGILL,  SIGABRT,
                                SIGTRAP, SIGXFSZ, SIGINT, SIGTERM, SIGALRM};
    struct rlimit memory, none = {0};
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    expect(file && fscanf(file, "%llu", &pages) == 1 && !fclose(file), "statm");
    memory.rlim_cur = memory.rlim_max = pages * (rlim_t)sysconf(_SC_PAGESIZE) + MEMORY;
    setrlimit(RLIMIT_AS, &memory);
    setrlimit(RLIMIT_CORE, &none);
    setrlimit(RLIMIT_FSIZE, &none);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (size_t i = 0; i < sizeof fatal / sizeof *fatal; i++)
        signal(fatal[i], SIG_DFL);
    int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    for (int descriptor = 0; nothing >= 0 && descriptor < 3; descriptor++)
        dup2(nothing, descriptor);
}

/* The signal of the timer ends a longer import. */
static void set_timer(int microseconds)
{
    struct itimerval timer = {.it_value = {0, microseconds}};
    setitimer(ITIMER_PROF, &timer, NULL);
}

static void import(void)
{
    struct mesh mesh = {0};
    struct answer answer = {0};
    struct error error = {{0}};
    exchange->failed =
        mesh_import_model(&mesh, exchange->path, exchange->parts, &error) ||
        (transfer_write(&mesh, &answer) && error_set(&error, "%s: not enough memory", exchange->path)) ||
        (answer.bytes > ANSWER && error_set(&error, "%s: a long answer", exchange->path));
    exchange->reason = error;
    exchange->bytes = exchange->failed ? 0 : answer.bytes;
    if (exchange->bytes)
        memcpy(exchange->data, answer.data, answer.bytes);
    free(answer.data);
    mesh_free(&mesh);
}

static _Noreturn void serve(int requests)
{
    char byte;
    restrict_process();
    while (read(requests, &byte, 1) == 1) {
        if (covered)
            memset(__start___sancov_cntrs, 0, counter_bytes());
        set_timer(PROCESSOR_MICROSECONDS);
        import();
        set_timer(0);
        if (covered)
            memcpy(covered, __start___sancov_cntrs, counter_bytes());
        if (send(requests, &byte, 1, MSG_NOSIGNAL) != 1)
            break;
    }
    _exit(0);
}

/* --- The parent ---------------------------------------------------------------------------------- */

static void *share(size_t bytes)
{
    void *memory =
        mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    expect(memory != MAP_FAILED, "shared memory");
    return memory;
}

/* Returns how it had ended before, or that it is killed. */
static int end_importer(void)
{
    int status = 0;
    close(channel);
    kill(importer, SIGKILL);
    waitpid(importer, &status, 0);
    importer = 0;
    return status;
}

static void forget_importer(void)
{
    if (importer)
        end_importer();
}

void importer_prepare(void)
{
    if (!exchange) {
        exchange = share(sizeof *exchange);
        covered = counter_bytes() ? share(counter_bytes()) : NULL;
        pthread_atfork(NULL, NULL, forget_callback);
        atexit(forget_importer);
    }
    exchange->in_assimp = 0;
}

static void start_importer(void)
{
    int ends[2];
    expect(!socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), "a channel");
    importer = fork();
    expect(importer >= 0, "a process");
    if (!importer) {
        close(ends[0]);
        serve(ends[1]);
    }
    close(ends[1]);
    channel = ends[0];
    served = 0;
}

static enum import_end ask(void)
{
    char byte = 0;
    struct pollfd ready = {.events = POLLIN};
    if (!importer)
        start_importer();
    ready.fd = channel;
    expect(send(channel, &byte, 1, MSG_NOSIGNAL) == 1, "an importer");
    if (poll(&ready, 1, MILLISECONDS) != 1 || read(channel, &byte, 1) != 1)
        return IMPORT_DIED;
    return exchange->failed ? IMPORT_REFUSED : IMPORT_ANSWERED;
}

static void add_counter(uint8_t *counter, uint8_t more)
{
    unsigned sum = *counter + more;
    *counter = (uint8_t)(sum < 255 ? sum : 255);
}

/* Adds the importer's counters. Nearly all of them are 0. */
static void add_coverage(void)
{
    size_t bytes = covered ? counter_bytes() : 0;
    for (size_t i = 0; i < bytes; i += sizeof(uint64_t)) {
        size_t some = bytes - i < sizeof(uint64_t) ? bytes - i : sizeof(uint64_t);
        uint64_t word = 0;
        memcpy(&word, covered + i, some);
        for (size_t j = i; word && j < i + some; j++)
            add_counter(&__start___sancov_cntrs[j], covered[j]);
    }
}

static void take_answer(struct answer *answer)
{
    answer->capacity = answer->bytes = exchange->bytes;
    answer->data = malloc(answer->bytes);
    expect(answer->data, "memory");
    memcpy(answer->data, exchange->data, answer->bytes);
}

static enum import_end fail_end(const char *path, int status, struct error *error)
{
    int is_slow = WIFSIGNALED(status) && (WTERMSIG(status) == SIGPROF || WTERMSIG(status) == SIGKILL);
    exchange->in_assimp |= is_slow;
    error_set(error, "%s: its importer ended with %s", path,
              WIFSIGNALED(status) ? sigdescr_np(WTERMSIG(status)) : "a report");
    return IMPORT_DIED;
}

enum import_end importer_run(const char *path, unsigned parts, struct answer *answer, struct error *error)
{
    snprintf(exchange->path, sizeof exchange->path, "%s", path);
    exchange->parts = parts;
    enum import_end end = ask();
    if (end == IMPORT_DIED)
        return fail_end(path, end_importer(), error);
    add_coverage();
    *error = exchange->reason;
    if (end == IMPORT_ANSWERED)
        take_answer(answer);
    if (++served == LIFE)
        end_importer();
    return end;
}
