/* The program of lab 13's check.
 *
 *   check request         policy_request: at most twice the time of the best decision
 *   check next            policy_next: the best order of all
 *   check budget          policy_budget: within the frame, and never nothing
 *   check room            policy_displaces and policy_request: few builds of routines with similar heat
 *   check play TRACE      prints what policies need for the trace, and judges yours
 *
 * Ends with 1, after a line with what was expected, if something is wrong, with 2 if the trace is bad. */
#include "replay.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static unsigned seed = 1;

static unsigned random_below(unsigned end)
{
    seed = seed * 1664525 + 1013904223;
    return (seed >> 8) % end;
}

/* --- Step 1 --- */

static struct routine random_routine(void)
{
    struct routine routine = {.build_us = 1 + random_below(200), .bytes = 1000};
    routine.second_us = (1 + random_below(100)) * 1e-3;
    routine.first_us = routine.second_us * (1.05 + random_below(1000) * 0.02);
    return routine;
}

/* The times of some draws with one routine: of the policy, and of the best decision. */
static int check_uses(struct routine routine, unsigned draws)
{
    double taken = 0, uses = 0, saved = 0, coarse = 0;
    for (unsigned i = 0; i < draws; i++) {
        unsigned count = 1 + random_below(20);
        uses += count;
        taken += count * (routine.state == SECOND ? routine.second_us : routine.first_us);
        saved = count * (routine.first_us - routine.second_us);
        coarse = saved > coarse ? saved : coarse;
        routine.heat = (routine.heat + saved) / 2;
        routine.lost_us += routine.state == SECOND ? 0 : saved;
        if (routine.state == FIRST && policy_request(&routine)) {
            routine.state = SECOND;
            taken += routine.build_us;
        }
    }
    double never = uses * routine.first_us, always = routine.build_us + uses * routine.second_us;
    double best = never < always ? never : always;
    if (taken <= 2 * best + coarse)
        return 0;
    printf("%.0f uses of %.3f us, or %.3f us after a build of %.0f us: %.1f us with your policy, expected at "
           "most "
           "2 * %.1f us, the time of the best decision\n",
           uses, routine.first_us, routine.second_us, routine.build_us, taken, best);
    return 1;
}

static int check_request(void)
{
    for (unsigned trial = 0; trial < 2000; trial++)
        if (check_uses(random_routine(), 1 + random_below(1u << (1 + trial % 14))))
            return 1;
    return 0;
}

/* --- Step 2 --- */

/* Until a build has ended, each frame takes longer by the heat of its routine. The sum of these times, if
 * they are built in an order. */
static double order_cost(const struct routine *routines, const unsigned *order, size_t count)
{
    double cost = 0, at = 0;
    for (size_t i = 0; i < count; i++) {
        at += routines[order[i]].build_us;
        cost += at * routines[order[i]].heat;
    }
    return cost;
}

/* The least cost of all orders that begin with the first `fixed` of `order`. */
static double least_cost(const struct routine *routines, unsigned *order, size_t fixed, size_t count)
{
    double least = order_cost(routines, order, count);
    for (size_t i = fixed; i < count; i++) {
        unsigned other = order[fixed];
        order[fixed] = order[i], order[i] = other;
        double cost = least_cost(routines, order, fixed + 1, count);
        least = cost < least ? cost : least;
        other = order[fixed], order[fixed] = order[i], order[i] = other;
    }
    return least;
}

/* The order that policy_next makes. Returns 1 if an answer is not valid. */
static int policy_order(const struct routine *routines, unsigned *order, size_t count)
{
    const struct routine *waiting[ROUTINES_MAXIMUM];
    size_t left = count;
    for (size_t i = 0; i < count; i++)
        waiting[i] = routines + i;
    for (size_t i = 0; i < count; i++) {
        size_t position = policy_next(waiting, left);
        if (position >= left) {
            printf("policy_next: %zu with %zu waiting, expected a position in the queue\n", position, left);
            return 1;
        }
        order[i] = (unsigned)(waiting[position] - routines);
        memmove(waiting + position, waiting + position + 1, (--left - position) * sizeof *waiting);
    }
    return 0;
}

static int check_next(void)
{
    for (unsigned trial = 0; trial < 1000; trial++) {
        struct routine routines[6];
        unsigned order[6], other[6] = {0, 1, 2, 3, 4, 5};
        size_t count = 2 + trial % 5;
        for (size_t i = 0; i < count; i++) {
            routines[i] = random_routine();
            routines[i].heat = 1 + random_below(1000);
            routines[i].state = WAITING;
        }
        if (policy_order(routines, order, count))
            return 1;
        double cost = order_cost(routines, order, count), least = least_cost(routines, other, 0, count);
        if (cost > least * 1.000001) {
            printf("%zu builds wait. Your order loses %.0f, expected the order that loses %.0f. Yours is:\n",
                   count, cost, least);
            for (size_t i = 0; i < count; i++)
                printf("a build of %.0f us that saves %.0f us a frame\n", routines[order[i]].build_us,
                       routines[order[i]].heat);
            return 1;
        }
    }
    return 0;
}

/* --- Step 3 --- */

static int check_budget(void)
{
    for (unsigned frame = 1000; frame <= 32000; frame *= 2)
        for (unsigned drawing = 0; drawing <= 3 * frame; drawing += frame / 10) {
            double left = drawing < frame ? frame - drawing : 0, budget = policy_budget(drawing, frame);
            double longer = drawing > frame ? drawing : frame, most = left > longer / 10 ? left : longer / 10;
            double least = left / 2 > frame / 1000.0 ? left / 2 : frame / 1000.0;
            if (budget > most * 1.000001 || !(budget >= least)) {
                printf("drawing took %u us of a frame of %u us: %.0f us for builds, expected %s %.0f us\n",
                       drawing, frame, budget, budget > most ? "at most" : "at least",
                       budget > most ? most : least);
                return 1;
            }
        }
    return 0;
}

/* --- Step 4 --- */

static int check_heats(double newcomer, double resident, bool expected)
{
    struct routine first = random_routine(), second = random_routine();
    first.heat = newcomer, first.state = WAITING;
    second.heat = resident, second.state = SECOND;
    if (policy_displaces(&first, &second) == expected)
        return 0;
    printf("policy_displaces: a newcomer that saves %.0f us a frame, and a resident that saves %.0f: "
           "expected that "
           "it is %s\n",
           newcomer, resident, expected ? "dropped" : "kept");
    return 1;
}

/* Two routines of almost the same heat, with room for one. A third comes later, and is much hotter. */
static int check_two(void)
{
    enum { FRAMES = 400, LATE = 300, MOST = 16 };
    static struct trace trace;
    trace.routines = 3, trace.frames = FRAMES;
    for (unsigned frame = 0; frame < FRAMES; frame++) {
        trace.counts[frame] = frame < LATE ? 2 : 3;
        trace.uses[frame][0] = (struct uses){0, frame % 2 ? 120 : 80};
        trace.uses[frame][1] = (struct uses){1, frame % 2 ? 80 : 120};
        trace.uses[frame][2] = (struct uses){2, 2000};
    }
    struct routine routines[3];
    for (unsigned i = 0; i < 3; i++)
        routines[i] = (struct routine){.build_us = 100, .first_us = 0.5, .second_us = 0.1, .bytes = 1000};
    struct result result = replay(&trace, routines, &(struct setting){YOURS, 1000, 1500, 1});
    if (result.builds > MOST)
        printf("two routines of almost the same heat, and room for one: %u builds in %u frames, expected at "
               "most %u\n",
               result.builds, FRAMES, MOST);
    else if (routines[2].state != SECOND)
        printf("a routine ten times as hot as those before: its second tier is absent after %u frames\n",
               FRAMES - LATE);
    else
        return 0;
    return 1;
}

static int check_room(void)
{
    return check_heats(100, 100, false) || check_heats(110, 100, false) || check_heats(1000, 100, true) ||
           check_heats(1, 0, true) || check_two();
}

/* --- The trace --- */

static _Noreturn void bad_trace(const char *expected)
{
    printf("the trace: expected %s\n", expected);
    exit(2);
}

static void read_routine(FILE *file, struct trace *trace)
{
    unsigned number, instructions, bytes;
    if (fscanf(file, "%u %u %u", &number, &instructions, &bytes) != 3 || number != trace->routines ||
        number >= ROUTINES_MAXIMUM)
        bad_trace("routine NUMBER INSTRUCTIONS BYTES, in the order of the numbers, at most 64");
    trace->instructions[number] = instructions;
    trace->bytes[number] = bytes;
    trace->routines++;
}

static void read_uses(const char *word, struct trace *trace)
{
    struct uses uses;
    unsigned frame = trace->frames - 1, *count;
    if (!trace->frames || sscanf(word, "%u:%u", &uses.routine, &uses.count) != 2 ||
        uses.routine >= trace->routines)
        bad_trace("ROUTINE:USES after frame");
    count = trace->counts + frame;
    if (*count == USES_MAXIMUM)
        bad_trace("at most 64 routines in a frame");
    trace->uses[frame][(*count)++] = uses;
}

static void read_trace(const char *path, struct trace *trace)
{
    char word[64];
    FILE *file = fopen(path, "r");
    if (!file)
        bad_trace(path);
    while (fscanf(file, "%63s", word) == 1) {
        if (word[0] == '#')
            fscanf(file, "%*[^\n]");
        else if (!strcmp(word, "routine"))
            read_routine(file, trace);
        else if (strcmp(word, "frame"))
            read_uses(word, trace);
        else if (trace->frames++ == FRAMES_MAXIMUM)
            bad_trace("at most 600 frames");
    }
    fclose(file);
}

/* Tiers of Triptych: the time of a build, without and for each instruction of the routine, and that of a use
 * for each instruction. They are rounded from times of a machine with AVX2 (triptych bench --builds, and
 * bench). */
struct tier {
    const char *name;
    double build_us, build_each_us, use_each_us;
};
static const struct tier batch = {"batch", 10, 0, 0.0016}, stitch = {"stitch", 1, 0, 0.000225},
                         specialize = {"specialize", 0, 0.14, 0.0002},
                         external = {"external", 200000, 0, 0.0002};

static void set_routines(const struct trace *trace, const struct tier *first, const struct tier *second,
                         struct routine *routines)
{
    memset(routines, 0, ROUTINES_MAXIMUM * sizeof *routines);
    for (unsigned i = 0; i < trace->routines; i++) {
        double length = trace->instructions[i];
        routines[i] = (struct routine){.build_us = second->build_us + second->build_each_us * length,
                                       .first_us = first->use_each_us * length,
                                       .second_us = second->use_each_us * length,
                                       .bytes = trace->bytes[i]};
    }
}

enum { FRAME_US = 25000 };

static struct result play(const struct trace *trace, const struct tier *first, const struct tier *second,
                          enum manner manner, size_t room, double *optimum)
{
    struct routine routines[ROUTINES_MAXIMUM];
    set_routines(trace, first, second, routines);
    *optimum = replay_optimum(trace, routines);
    return replay(trace, routines, &(struct setting){manner, FRAME_US, room, first->build_us});
}

static void print_row(const char *tiers, const char *policy, const struct result *result, double optimum)
{
    printf("%-20s %-14s %8.1f %9.2f %8.2f %6u %6u %8.3f\n", tiers, policy, result->worst_us * 1e-3,
           result->excess, result->total_us * 1e-6, result->builds, result->drops,
           result->total_us / optimum);
}

static void print_pair(const struct trace *trace, const struct tier *first, const struct tier *second)
{
    static const char *const names[] = {"yours", "wait", "never"};
    char tiers[64];
    snprintf(tiers, sizeof tiers, "%s, %s", first->name, second->name);
    for (int manner = NEVER; manner >= YOURS; manner--) {
        double optimum;
        struct result result = play(trace, first, second, (enum manner)manner, 0, &optimum);
        print_row(tiers, names[manner], &result, optimum);
    }
}

static void print_table(const struct trace *trace)
{
    printf("%-20s %-14s %8s %9s %8s %6s %6s %8s\n", "tiers", "policy", "worst ms", "/ warm", "all s",
           "builds", "drops", "/ best");
    print_pair(trace, &stitch, &specialize);
    print_pair(trace, &batch, &specialize);
    print_pair(trace, &batch, &external);
    print_pair(trace, &stitch, &external);
    for (unsigned room = 16; room >= 4; room /= 2) {
        double optimum;
        char policy[32];
        struct result result = play(trace, &stitch, &specialize, YOURS, room * 1024, &optimum);
        snprintf(policy, sizeof policy, "yours, %u KiB", room);
        print_row("stitch, specialize", policy, &result, optimum);
    }
}

/* Judges one pair: the worst frame, all work, and the builds that are requested. */
static int judge(const struct trace *trace, const struct tier *first, const struct tier *second,
                 double excess, double work)
{
    double optimum;
    struct result result = play(trace, first, second, YOURS, 0, &optimum);
    struct result again = play(trace, first, second, YOURS, 0, &optimum);
    if (memcmp(&result, &again, sizeof result))
        printf("%s, %s: two replays differ, expected a policy without state\n", first->name, second->name);
    else if (result.excess > excess)
        printf("%s, %s: a frame takes %.2f times as long as it does warm, expected at most %.2f\n",
               first->name, second->name, result.excess, excess);
    else if (result.total_us > work * optimum)
        printf("%s, %s: all frames take %.3f times as long as with foresight, expected at most %.3f\n",
               first->name, second->name, result.total_us / optimum, work);
    else if (result.longest_wait > 10)
        printf("%s, %s: a request waits for %u frames, expected at most 10\n", first->name, second->name,
               result.longest_wait);
    else
        return 0;
    return 1;
}

static int play_trace(const char *path)
{
    static struct trace trace;
    read_trace(path, &trace);
    print_table(&trace);
    return judge(&trace, &stitch, &specialize, 1.25, 1.02) || judge(&trace, &batch, &specialize, 9, 1.15);
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    return !strcmp(command, "request")              ? check_request()
           : !strcmp(command, "next")               ? check_next()
           : !strcmp(command, "budget")             ? check_budget()
           : !strcmp(command, "room")               ? check_room()
           : !strcmp(command, "play") && count == 3 ? play_trace(argument[2])
                                                    : 2;
}
