/* The program of lab 12's check.
 *
 *   check needed      no two states with equal keys need different routines
 *   check tight       no two states with different keys could share a routine
 *   check cache       misses of misses_fifo and misses_lru
 *   check replay      prints the misses of a list of draws for four sizes of the cache
 *
 * Ends with 1, after a line with what was expected, if something is wrong. */
#include "state.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TRIALS = 10000, PIXELS = 4000, DRAWS = 6000, ROOM_MAXIMUM = 64 };

static const unsigned values[] = {
#define FIELD(name, values) values,
    STATE_FIELDS
#undef FIELD
};
static const char *const names[] = {
#define FIELD(name, values) #name,
    STATE_FIELDS
#undef FIELD
};
enum { FIELDS = sizeof values / sizeof *values };

static uint32_t seed = 1;

static unsigned random_below(unsigned end)
{
    seed = seed * 1664525 + 1013904223;
    return (seed >> 8) % end;
}

static unsigned *field(struct state *state, int number)
{
    return (unsigned *)state + number;
}

static struct state random_state(void)
{
    struct state state;
    for (int i = 0; i < FIELDS; i++)
        *field(&state, i) = random_below(values[i]);
    return state;
}

/* alpha_reference and fog_density are read when a routine runs, so routines do not differ by them. */
static int is_read_when_it_runs(int number)
{
    return values[number] == 256;
}

/* Two states can share a routine if they draw all pixels alike, for all values that are read when it runs. */
static int draw_alike(struct state a, struct state b)
{
    for (int i = 0; i < PIXELS; i++) {
        struct pixel pixel = {random_below(256), random_below(256), random_below(256), random_below(256)};
        a.alpha_reference = b.alpha_reference = i % 4 ? random_below(256) : random_below(64);
        a.fog_density = b.fog_density = random_below(256);
        if (shade(&a, &pixel) != shade(&b, &pixel))
            return 0;
    }
    return 1;
}

static int equal_keys(const struct state *a, const struct state *b)
{
    struct key first = key_of(a), second = key_of(b);
    return !memcmp(&first, &second, sizeof first);
}

static void print_state(const struct state *state)
{
    for (int i = 0; i < FIELDS; i++)
        printf("%s%s=%u", i ? " " : "", names[i], *field((struct state *)state, i));
    putchar('\n');
}

/* --- Keys --- */

/* True if the pair is wrong in the way that is looked for. */
typedef int wrong_pair(const struct state *a, const struct state *b);

static int lacks(const struct state *a, const struct state *b)
{
    return equal_keys(a, b) && !draw_alike(*a, *b);
}

static int exceeds(const struct state *a, const struct state *b)
{
    return !equal_keys(a, b) && draw_alike(*a, *b);
}

static int check_pairs(wrong_pair *wrong, const char *message)
{
    for (int trial = 0; trial < TRIALS; trial++) {
        struct state a = random_state(), b = a;
        int number = (int)random_below(FIELDS);
        *field(&b, number) = random_below(values[number]);
        if (wrong(&a, &b)) {
            printf(message, names[number], *field(&a, number), *field(&b, number));
            print_state(&a);
            return 1;
        }
    }
    return 0;
}

/* Whole states, which share a key by chance if fields overlap in it. */
static int check_collisions(void)
{
    enum { STATES = 4000 };
    static struct state states[STATES];
    static struct key keys[STATES];
    for (int i = 0; i < STATES; i++) {
        states[i] = random_state();
        keys[i] = key_of(states + i);
        for (int j = 0; j < i; j++)
            if (!memcmp(keys + i, keys + j, sizeof *keys) && !draw_alike(states[i], states[j])) {
                printf("two states that draw differently have the same key, %02x %02x:\n", keys[i].bytes[0],
                       keys[i].bytes[1]);
                print_state(states + i);
                print_state(states + j);
                return 1;
            }
    }
    return 0;
}

static int check_needed(void)
{
    return check_pairs(lacks, "with %s %u and %u pixels are drawn differently, but the keys are equal: ") ||
           check_collisions();
}

static int check_tight(void)
{
    return check_pairs(exceeds, "with %s %u and %u all pixels are drawn alike, but the keys differ: ");
}

/* --- Cache --- */

/* The definition of both: the time of each routine is when it was generated or, with `uses`, used last. */
static size_t simulate(const struct key *draws, size_t count, size_t room, int uses)
{
    struct key keys[ROOM_MAXIMUM];
    size_t times[ROOM_MAXIMUM], filled = 0, misses = 0;
    for (size_t i = 0; i < count; i++) {
        size_t at = 0, oldest = 0;
        while (at < filled && memcmp(keys + at, draws + i, sizeof *draws))
            at++;
        for (size_t j = 1; j < filled; j++)
            oldest = times[j] < times[oldest] ? j : oldest;
        int missed = at == filled;
        if (missed)
            at = filled < room ? filled++ : oldest;
        keys[at] = draws[i];
        if (missed || uses)
            times[at] = i;
        misses += (size_t)missed;
    }
    return misses;
}

static struct key number_key(unsigned number)
{
    return (struct key){{(uint8_t)number, (uint8_t)(number >> 8)}};
}

static int check_misses(const struct key *draws, size_t count, size_t room)
{
    size_t fifo = misses_fifo(draws, count, room), lru = misses_lru(draws, count, room);
    size_t expected_fifo = simulate(draws, count, room, 0), expected_lru = simulate(draws, count, room, 1);
    if (fifo != expected_fifo)
        printf("misses_fifo of %zu draws, room %zu: %zu, expected %zu\n", count, room, fifo, expected_fifo);
    else if (lru != expected_lru)
        printf("misses_lru of %zu draws, room %zu: %zu, expected %zu\n", count, room, lru, expected_lru);
    else
        return 0;
    return 1;
}

static int check_cache(void)
{
    static struct key draws[DRAWS];
    for (size_t room = 1; room <= ROOM_MAXIMUM; room = room * 3 / 2 + 1)
        for (unsigned kinds = 2; kinds < 200; kinds *= 3) {
            for (int i = 0; i < DRAWS; i++)
                draws[i] = number_key(random_below(4) ? random_below(kinds) / 4 : random_below(kinds));
            if (check_misses(draws, DRAWS, room))
                return 1;
        }
    return 0;
}

/* A game's frames: four materials between all others, twenty in turn, and a new one now and then. */
static int replay(void)
{
    static struct key draws[DRAWS];
    for (int i = 0; i < DRAWS; i++)
        draws[i] = number_key(i % 3 == 0    ? (unsigned)i / 3 % 4
                              : i % 97 == 0 ? 100 + (unsigned)i / 970
                                            : 4 + (unsigned)i / 3 % 20);
    for (size_t room = 8; room <= 32; room += 8)
        printf("%zu %zu %zu\n", room, misses_fifo(draws, DRAWS, room), misses_lru(draws, DRAWS, room));
    return 0;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    return !strcmp(command, "needed")  ? check_needed()
           : !strcmp(command, "tight") ? check_tight()
           : !strcmp(command, "cache") ? check_cache()
                                       : replay();
}
