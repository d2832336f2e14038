/* The answer is sent as a head, then the reason or the bytes. The head has their length, because another fork
 * may hold the pipe open so that its end is not seen. */
#define _GNU_SOURCE
#include "command/import/isolate.h"

#include "base/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

struct head {
    uint64_t bytes;
    uint32_t failed; /* the bytes are the reason of a failure */
};

int isolate_append(struct answer *answer, const void *data, size_t bytes)
{
    if (bytes > answer->capacity - answer->bytes) {
        size_t capacity = 2 * answer->capacity + bytes + 4096;
        uint8_t *larger = realloc(answer->data, capacity);
        if (!larger)
            return -1;
        answer->data = larger;
        answer->capacity = capacity;
    }
    if (bytes)
        memcpy(answer->data + answer->bytes, data, bytes);
    answer->bytes += bytes;
    return 0;
}

/* --- The new process --- */

/* Memory limits include what is mapped when the process starts; sanitizers map terabytes. */
static uint64_t mapped_bytes(void)
{
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (file) {
        if (fscanf(file, "%llu", &pages) != 1)
            pages = 0;
        fclose(file);
    }
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

/* Keeps a limit that is already lower. */
static void set_limit(int what, uint64_t value)
{
    struct rlimit limit;
    if (getrlimit((__rlimit_resource_t)what, &limit))
        return;
    if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur > value)
        limit.rlim_cur = value;
    setrlimit((__rlimit_resource_t)what, &limit);
}

static void restrict_process(const struct isolate_limits *limits)
{
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_FSIZE, 0);
    set_limit(RLIMIT_CPU, limits->seconds);
    set_limit(RLIMIT_AS, mapped_bytes() + limits->memory);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
}

/* The handlers are those of the parent; a sanitizer's would print. */
static void reset_signals(void)
{
    static const int fatal[] = {SIGSEGV, SIGBUS, SIGFPE,  SIGILL, SIGABRT, SIGTRAP, SIGSYS, SIGXCPU,
                                SIGPIPE, SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGALRM, SIGXFSZ};
    sigset_t none;
    for (size_t i = 0; i < sizeof fatal / sizeof *fatal; i++)
        signal(fatal[i], SIG_DFL);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
}

static void silence(void)
{
    int nothing = open("/dev/null", O_RDWR);
    for (int descriptor = 0; descriptor < 3; descriptor++)
        if (nothing >= 0)
            dup2(nothing, descriptor);
        else
            close(descriptor);
}

static int write_all(int to, const void *data, size_t bytes)
{
    const char *at = data;
    while (bytes) {
        ssize_t put = write(to, at, bytes);
        if (put < 0 && errno != EINTR)
            return -1;
        at += put > 0 ? put : 0;
        bytes -= put > 0 ? (size_t)put : 0;
    }
    return 0;
}

static _Noreturn void answer_and_end(int to, const struct isolate_limits *limits, isolated_work *work,
                                     void *user)
{
    struct answer answer = {0};
    struct error error = {{0}};
    reset_signals();
    silence();
    restrict_process(limits);
    struct head head = {.failed = work(user, &answer, &error) != 0};
    const void *data = head.failed ? (const void *)error.text : answer.data;
    head.bytes = head.failed ? strlen(error.text) : answer.bytes;
    _exit(write_all(to, &head, sizeof head) || write_all(to, data, head.bytes));
}

/* --- The old one --- */

enum outcome { ANSWERED, ENDED, TIMED_OUT, TOO_LONG, NO_MEMORY };

static enum outcome read_all(int from, void *data, size_t bytes, int64_t deadline)
{
    char *at = data;
    while (bytes) {
        struct pollfd ready = {.fd = from, .events = POLLIN};
        int64_t left = deadline - (int64_t)(clock_ns() / 1000000);
        int count = left > 0 ? poll(&ready, 1, left < 60000 ? (int)left : 60000) : 0;
        if (left <= 0)
            return TIMED_OUT;
        if (count <= 0)
            continue;
        ssize_t got = read(from, at, bytes);
        if (!got || (got < 0 && errno != EINTR))
            return ENDED;
        at += got > 0 ? got : 0;
        bytes -= got > 0 ? (size_t)got : 0;
    }
    return ANSWERED;
}

static enum outcome receive(int from, const struct isolate_limits *limits, struct head *head,
                            struct answer *answer)
{
    int64_t deadline = (int64_t)(clock_ns() / 1000000) + limits->milliseconds;
    enum outcome outcome = read_all(from, head, sizeof *head, deadline);
    if (outcome)
        return outcome;
    if (head->bytes > (head->failed ? ERROR_CAPACITY : limits->answer))
        return TOO_LONG;
    answer->data = malloc((size_t)head->bytes + 1);
    if (!answer->data)
        return NO_MEMORY;
    answer->bytes = (size_t)head->bytes;
    answer->capacity = answer->bytes + 1;
    answer->data[answer->bytes] = 0;
    return read_all(from, answer->data, answer->bytes, deadline);
}

/* Waits for the end of the process. If SIGCHLD is ignored, its status is lost. */
static int end_process(pid_t process, bool kill_it)
{
    int status = 0;
    pid_t waited;
    if (kill_it)
        kill(process, SIGKILL);
    while ((waited = waitpid(process, &status, 0)) < 0 && errno == EINTR)
        ;
    return waited == process ? status : 0;
}

static int fail_end(const char *name, const struct isolate_limits *limits, int status, struct error *error)
{
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
        return error_set(error, "%s: reading it takes more than %u seconds of processor time", name,
                         limits->seconds);
    if (WIFSIGNALED(status))
        return error_set(error, "%s: reading it ended with %s, expected a file that is not damaged", name,
                         sigdescr_np(WTERMSIG(status)));
    return error_set(error, "%s: reading it ended early, expected a file that is not damaged", name);
}

/* Copies the reason that the process sent, as one line. */
static int fail_work(const char *name, struct answer *answer, struct error *error)
{
    char *text = (char *)answer->data;
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            *c = ' ';
    return *text ? error_set(error, "%s", text) : error_set(error, "%s: no reason was given", name);
}

static int conclude(const char *name, const struct isolate_limits *limits, enum outcome outcome, int status,
                    const struct head *head, struct answer *answer, struct error *error)
{
    switch (outcome) {
    case ANSWERED: return head->failed ? fail_work(name, answer, error) : 0;
    case TIMED_OUT:
        return error_set(error, "%s: reading it takes more than %g seconds", name,
                         limits->milliseconds / 1000.0);
    case TOO_LONG: return error_set(error, "%s: more than %zu bytes when read", name, limits->answer);
    case NO_MEMORY: return error_set(error, "%s: not enough memory", name);
    case ENDED: break;
    }
    return fail_end(name, limits, status, error);
}

int isolate_run(const char *name, const struct isolate_limits *limits, isolated_work *work, void *user,
                struct answer *answer, struct error *error)
{
    int ends[2];
    struct head head = {0};
    *answer = (struct answer){0};
    if (pipe2(ends, O_CLOEXEC))
        return error_set(error, "%s: cannot make a pipe: %s", name, strerrordesc_np(errno));
    pid_t process = fork();
    if (!process)
        answer_and_end(ends[1], limits, work, user);
    int reason = errno;
    close(ends[1]);
    if (process < 0) {
        close(ends[0]);
        return error_set(error, "%s: cannot start a process to read it: %s", name, strerrordesc_np(reason));
    }
    enum outcome outcome = receive(ends[0], limits, &head, answer);
    close(ends[0]);
    int status = end_process(process, outcome != ANSWERED && outcome != ENDED);
    int result = conclude(name, limits, outcome, status, &head, answer, error);
    if (result) {
        free(answer->data);
        *answer = (struct answer){0};
    }
    return result;
}
