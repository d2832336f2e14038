#include "replay.h"

#include <stdio.h>
#include <stdlib.h>

/* A replay that is under way. */
struct player {
    const struct trace *trace;
    const struct setting *setting;
    struct routine *routines;
    struct result result;
    bool known[ROUTINES_MAXIMUM];
    unsigned requested[ROUTINES_MAXIMUM]; /* the frame of the request */
    double saved_us[ROUTINES_MAXIMUM];    /* in this frame */
    unsigned queue[ROUTINES_MAXIMUM];
    size_t queued;
    long current; /* the routine that is built, or -1 */
    double left_us;
    size_t bytes;
};

static _Noreturn void refuse(const char *message)
{
    puts(message);
    exit(1);
}

/* Drops the code of a routine. */
static void drop(struct player *player, unsigned number)
{
    struct routine *routine = player->routines + number;
    routine->state = FIRST;
    routine->lost_us = 0;
    routine->drops++;
    player->result.drops++;
}

/* The resident of least heat that is not in `chosen`, or -1. */
static long coldest(const struct player *player, const bool *chosen)
{
    long found = -1;
    for (unsigned i = 0; i < player->trace->routines; i++)
        if (player->routines[i].state == SECOND && !chosen[i] &&
            (found < 0 || player->routines[i].heat < player->routines[found].heat))
            found = i;
    return found;
}

/* True if there is room, after drops, for the code of the routine. */
static bool make_room(struct player *player, const struct routine *newcomer)
{
    bool chosen[ROUTINES_MAXIMUM] = {0};
    size_t bytes = player->bytes + newcomer->bytes, room = player->setting->room;
    while (room && bytes > room) {
        long victim = coldest(player, chosen);
        if (victim < 0 || !policy_displaces(newcomer, player->routines + victim))
            return false;
        chosen[victim] = true;
        bytes -= player->routines[victim].bytes;
    }
    for (unsigned i = 0; i < player->trace->routines; i++)
        if (chosen[i])
            drop(player, i);
    player->bytes = bytes;
    return true;
}

static void finish(struct player *player, unsigned number, unsigned frame)
{
    struct routine *routine = player->routines + number;
    unsigned waited = frame - player->requested[number];
    player->result.builds++;
    player->result.longest_wait = waited > player->result.longest_wait ? waited : player->result.longest_wait;
    if (make_room(player, routine))
        routine->state = SECOND;
    else
        drop(player, number);
}

/* Begins the build that the policy chooses. */
static void begin(struct player *player)
{
    const struct routine *waiting[ROUTINES_MAXIMUM];
    for (size_t i = 0; i < player->queued; i++)
        waiting[i] = player->routines + player->queue[i];
    size_t position = policy_next(waiting, player->queued);
    if (position >= player->queued)
        refuse("policy_next: expected a position in the queue");
    player->current = player->queue[position];
    player->left_us = player->routines[player->current].build_us;
    for (player->queued--; position < player->queued; position++)
        player->queue[position] = player->queue[position + 1];
}

/* Builds for the time that the policy allows. Returns the time taken. */
static double build(struct player *player, double drawing_us, unsigned frame)
{
    if (player->current < 0 && !player->queued)
        return 0;
    double budget = policy_budget(drawing_us, player->setting->frame_us), taken = 0;
    if (!(budget >= 0))
        refuse("policy_budget: expected a time of 0 or more");
    while (taken < budget && (player->current >= 0 || player->queued)) {
        if (player->current < 0)
            begin(player);
        double part = budget - taken < player->left_us ? budget - taken : player->left_us;
        taken += part;
        player->left_us -= part;
        if (player->left_us <= 1e-9) {
            finish(player, (unsigned)player->current, frame);
            player->current = -1;
        }
    }
    return taken;
}

/* The first use of a routine: the drawing thread builds a tier. Returns the time. */
static double first_use(struct player *player, unsigned number)
{
    player->known[number] = true;
    if (player->setting->manner != WAIT)
        return player->setting->first_build_us;
    player->routines[number].state = SECOND;
    player->result.builds++;
    return player->routines[number].build_us;
}

static void request(struct player *player, unsigned number, unsigned frame)
{
    player->routines[number].state = WAITING;
    player->requested[number] = frame;
    player->queue[player->queued++] = number;
    player->result.requests++;
}

/* Draws. Returns the time of the uses. */
static double draw(struct player *player, const struct uses *uses, unsigned frame)
{
    struct routine *routine = player->routines + uses->routine;
    double saved = uses->count * (routine->first_us - routine->second_us);
    player->saved_us[uses->routine] += saved;
    if (routine->state == SECOND)
        return uses->count * routine->second_us;
    routine->lost_us += saved;
    if (routine->state == FIRST && player->setting->manner == YOURS && policy_request(routine))
        request(player, uses->routine, frame);
    return uses->count * routine->first_us;
}

static void cool(struct player *player)
{
    for (unsigned i = 0; i < player->trace->routines; i++) {
        player->routines[i].heat = (player->routines[i].heat + player->saved_us[i]) / 2;
        player->saved_us[i] = 0;
    }
}

static void play_frame(struct player *player, unsigned frame)
{
    struct result *result = &player->result;
    double drawing = 0, building = 0, warm = 0;
    for (unsigned i = 0; i < player->trace->counts[frame]; i++) {
        const struct uses *uses = player->trace->uses[frame] + i;
        if (!player->known[uses->routine])
            building += first_use(player, uses->routine);
        drawing += draw(player, uses, frame);
        warm += uses->count * player->routines[uses->routine].second_us;
    }
    cool(player);
    building += build(player, drawing + building, frame);
    double all = drawing + building;
    result->drawing_us += drawing;
    result->building_us += building;
    result->total_us += all;
    result->worst_us = all > result->worst_us ? all : result->worst_us;
    if (warm > 0 && all / warm > result->excess)
        result->excess = all / warm;
}

/* Requests that no build has ended. */
static void end(struct player *player)
{
    for (unsigned i = 0; i < player->trace->routines; i++) {
        unsigned waited = player->trace->frames - player->requested[i];
        if (player->routines[i].state == WAITING && waited > player->result.longest_wait)
            player->result.longest_wait = waited;
    }
}

struct result replay(const struct trace *trace, struct routine *routines, const struct setting *setting)
{
    struct player player = {.trace = trace, .routines = routines, .setting = setting, .current = -1};
    for (unsigned frame = 0; frame < trace->frames; frame++)
        play_frame(&player, frame);
    end(&player);
    return player.result;
}

double replay_optimum(const struct trace *trace, const struct routine *routines)
{
    double total = 0, uses[ROUTINES_MAXIMUM] = {0};
    for (unsigned frame = 0; frame < trace->frames; frame++)
        for (unsigned i = 0; i < trace->counts[frame]; i++)
            uses[trace->uses[frame][i].routine] += trace->uses[frame][i].count;
    for (unsigned i = 0; i < trace->routines; i++) {
        double first = uses[i] * routines[i].first_us,
               second = routines[i].build_us + uses[i] * routines[i].second_us;
        total += first < second ? first : second;
    }
    return total;
}
