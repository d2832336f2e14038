#include "command/run/start.h"

#include "command/run/salvage.h"
#include "command/support/tool.h"

#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static volatile pid_t child; /* 0: not started */

/* A terminal sends its signals to the program as well; only those of other processes are passed on. */
static void pass_on(int number, siginfo_t *about, void *context)
{
    (void)context;
    if (child && about->si_code <= 0)
        kill(child, number);
}

static void pass_signals_on(void)
{
    static const int numbers[] = {SIGINT, SIGQUIT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_sigaction = pass_on, .sa_flags = SA_SIGINFO | SA_RESTART}, old;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (!sigaction(numbers[i], NULL, &old) && old.sa_handler != SIG_IGN)
            sigaction(numbers[i], &action, NULL);
}

/* Returns true if the file is the one of `before`. A zero `before` is a missing file. */
static bool is_unchanged(const char *path, const struct stat *before)
{
    struct stat now;
    if (stat(path, &now))
        return true;
    return S_ISREG(now.st_mode) && now.st_ino == before->st_ino && now.st_size == before->st_size &&
           now.st_mtim.tv_sec == before->st_mtim.tv_sec && now.st_mtim.tv_nsec == before->st_mtim.tv_nsec;
}

static int run_child(const struct command *self, const char *program, char **arguments, int *status)
{
    pid_t started;
    pass_signals_on();
    const int reason = posix_spawnp(&started, program, NULL, NULL, arguments, environ);
    if (reason)
        return tool_fail(self, "%s: cannot start: %s", program, strerror(reason));
    child = started;
    while (waitpid(started, status, 0) < 0)
        if (errno != EINTR)
            return tool_fail(self, "%s: its end is not known: %s", program, strerror(errno));
    child = 0;
    return STATUS_OK;
}

static int start_and_watch(const struct command *self, const char *program, char **arguments,
                           const char *record)
{
    struct stat before = {0};
    struct timespec begin;
    int status = 0;
    clock_gettime(CLOCK_REALTIME_COARSE, &begin); /* the clock of files */
    if (stat(record, &before))
        before = (struct stat){0};
    if (run_child(self, program, arguments, &status))
        return STATUS_BAD;
    if (!salvage_recordings(self, record, &begin) && is_unchanged(record, &before))
        tool_fail(self, "%s: nothing was recorded, because %s has drawn nothing with Triptych", record,
                  arguments[0]);
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

int place_start(const struct command *self, const char *program, char **arguments, const char *record)
{
    if (record)
        return start_and_watch(self, program, arguments, record);
    execvp(program, arguments);
    return tool_fail(self, "%s: cannot start: %s", program, strerror(errno));
}
