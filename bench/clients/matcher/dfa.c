/* The plain C matcher: sets of positions become states of a table (subset construction), found by a search
 * over the states that there are. */
#include "bench/clients/matcher/automaton.h"

#include <stdlib.h>
#include <string.h>

enum { STATES_MAXIMUM = 4096 };

struct dfa {
    bool from_start, to_end, all;
    int states;
    struct position_set set[STATES_MAXIMUM];
    uint16_t next[STATES_MAXIMUM][256];
    bool accepts[STATES_MAXIMUM];
};

static bool intersects(const struct position_set *a, const struct position_set *b)
{
    for (int w = 0; w < AUTOMATON_WORDS; w++)
        if (a->word[w] & b->word[w])
            return true;
    return false;
}

/* The number of the state of a set. Returns -1 if there are too many. */
static int state_of(struct dfa *dfa, const struct automaton *a, const struct position_set *set)
{
    for (int state = 0; state < dfa->states; state++)
        if (!memcmp(&dfa->set[state], set, sizeof *set))
            return state;
    if (dfa->states == STATES_MAXIMUM)
        return -1;
    dfa->set[dfa->states] = *set;
    dfa->accepts[dfa->states] = intersects(set, &a->last);
    return dfa->states++;
}

static struct position_set followers(const struct automaton *a, const struct position_set *set)
{
    struct position_set next = {{0}};
    if (!a->from_start)
        next = a->first;
    for (int p = 0; p < a->positions; p++)
        if (position_in(set, p))
            position_join(&next, &a->follow[p]);
    return next;
}

/* Fills the row of a state. Bytes with the same positions lead to the same state. */
static int fill_row(struct dfa *dfa, const struct automaton *a, int state)
{
    const struct position_set next = followers(a, &dfa->set[state]);
    for (int byte = 0; byte < 256; byte++) {
        struct position_set set;
        for (int w = 0; w < AUTOMATON_WORDS; w++)
            set.word[w] = next.word[w] & a->table[w][byte];
        int to = state_of(dfa, a, &set);
        if (to < 0)
            return -1;
        dfa->next[state][byte] = (uint16_t)to;
    }
    return 0;
}

struct dfa *dfa_create(const struct automaton *a, struct error *error)
{
    struct dfa *dfa = calloc(1, sizeof *dfa);
    struct position_set start = {{a->from_start}};
    if (!dfa) {
        error_set(error, "out of memory for the table of an expression");
        return NULL;
    }
    dfa->from_start = a->from_start;
    dfa->to_end = a->to_end;
    dfa->all = automaton_accepts_all(a);
    state_of(dfa, a, &start);
    for (int state = 0; state < dfa->states; state++)
        if (fill_row(dfa, a, state)) {
            error_set(error, "the expression has more than %d states", STATES_MAXIMUM);
            dfa_free(dfa);
            return NULL;
        }
    return dfa;
}

void dfa_free(struct dfa *dfa)
{
    free(dfa);
}

bool dfa_matches(const struct dfa *dfa, const uint8_t *text)
{
    unsigned state = 0;
    if (dfa->all)
        return true;
    for (; *text != '\n'; text++) {
        state = dfa->next[state][*text];
        if (dfa->accepts[state] && !dfa->to_end)
            return true;
    }
    return dfa->to_end && dfa->accepts[state];
}
