/* The command `triptych`. */
#include "command/support/interrupt.h"
#include "command/tool/command_line.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* Commands need less than half of STACK_LEAST. STACK is that of usual systems. */
enum { STACK_LEAST = 1 << 20, STACK = 8 << 20, STATUS_REFUSED = 2 };

struct call {
    int count;
    char **arguments;
    int status;
};

/* If standard output is closed, the next file to be opened would become standard output and be printed into.
 */
static int open_standard(void)
{
    int descriptor;
    do
        descriptor = open("/dev/null", O_RDONLY);
    while (descriptor >= 0 && descriptor <= STDERR_FILENO);
    return descriptor < 0 ? -1 : close(descriptor);
}

static bool has_small_stack(void)
{
    struct rlimit limit;
    return !getrlimit(RLIMIT_STACK, &limit) && limit.rlim_cur < STACK_LEAST;
}

static void *run_call(void *user)
{
    struct call *call = user;
    call->status = command_line_run(call->count, call->arguments);
    return NULL;
}

/* Under a small limit (ulimit -s), runs the command on a stack that the limit does not concern. */
static int run_in_thread(int count, char **arguments)
{
    struct call call = {count, arguments, STATUS_REFUSED};
    pthread_attr_t attributes;
    pthread_t thread;
    int reason = pthread_attr_init(&attributes);
    if (!reason)
        reason = pthread_attr_setstacksize(&attributes, STACK);
    if (!reason)
        reason = pthread_create(&thread, &attributes, run_call, &call);
    if (!reason)
        reason = pthread_join(thread, NULL);
    if (reason)
        fprintf(stderr, "triptych: cannot make a stack of %d bytes: %s\n", STACK, strerror(reason));
    return call.status;
}

/* A write beyond a limit on file sizes is an error, not the end of the process. */
int main(int count, char **arguments)
{
    interrupt_catch();
    signal(SIGXFSZ, SIG_IGN);
    open_standard();
    return has_small_stack() ? run_in_thread(count, arguments) : command_line_run(count, arguments);
}
