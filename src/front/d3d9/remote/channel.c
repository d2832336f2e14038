#define _GNU_SOURCE /* syscall */
#include "channel.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

/* A call takes about a microsecond, and waking a process some tens of them. */
enum { SPINS = 4000 };

/* The structure that the kernel expects of this process. */
static void sleep_on(struct d3d9_channel *channel, uint32_t turn)
{
    struct timespec second = {.tv_sec = 1};
    channel->sleepers++;
    syscall(SYS_futex, &channel->turn, FUTEX_WAIT, turn, &second, NULL, 0);
    channel->sleepers--;
}

uint32_t d3d9_channel_wait(struct d3d9_channel *channel, uint32_t turn)
{
    for (int i = 0; i < SPINS && channel->turn == turn; i++)
        __builtin_ia32_pause();
    if (channel->turn == turn)
        sleep_on(channel, turn);
    return channel->turn;
}

void d3d9_channel_pass(struct d3d9_channel *channel, uint32_t turn)
{
    channel->turn = turn;
    if (channel->sleepers)
        syscall(SYS_futex, &channel->turn, FUTEX_WAKE, 2, NULL, NULL, 0);
}
