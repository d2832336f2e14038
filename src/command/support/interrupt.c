#include "command/support/interrupt.h"
#include "base/leftover.h"

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

static const struct {
    int number;
    const char *name;
} signals[] = {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}};

static volatile sig_atomic_t waiting, received;

static void on_signal(int number)
{
    if (waiting && !received) {
        received = number;
        return;
    }
    leftovers_remove();
    signal(number, SIG_DFL);
    raise(number);
}

/* System calls are restarted after the handler, because the command polls between them. */
void interrupt_catch(void)
{
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART}, before;
    sigfillset(&action.sa_mask);
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        if (!sigaction(signals[i].number, NULL, &before) && before.sa_handler != SIG_IGN)
            sigaction(signals[i].number, &action, NULL);
}

void interrupt_defer(void)
{
    waiting = true;
}

int interrupt_signal(void)
{
    return received;
}

const char *interrupt_name(void)
{
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        if (signals[i].number == received)
            return signals[i].name;
    return NULL;
}

int interrupt_status(void)
{
    return 128 + received;
}
