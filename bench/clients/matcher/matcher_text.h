/* The text of the matcher, for a binding: one line in each lane. */
#ifndef CLIENTS_MATCHER_MATCHER_TEXT_H
#define CLIENTS_MATCHER_MATCHER_TEXT_H

#include "contract/language.h"

#include "bench/clients/matcher/class.h"
#include "bench/clients/matcher/matcher.h"

#include <string.h>

/* Variables of the loop. The words of the state are variables 0 to AUTOMATON_WORDS - 1. */
enum { MATCHER_HITS = AUTOMATON_WORDS, MATCHER_PLACE, MATCHER_ALIVE };

struct matcher_state {
    itg word[AUTOMATON_WORDS]; /* the active positions */
    itg hits;                  /* not 0: a match was found */
    msk alive;                 /* the line has not ended */
};

static inline msk matcher_in_range(struct env *e, itg c, int low, int high)
{
    if (low == high)
        return eq_i(E, c, lit_i(E, low));
    if (low == 0)
        return gt_i(E, lit_i(E, high + 1), c);
    msk above = gt_i(E, c, lit_i(E, low - 1));
    if (high == 255)
        return above;
    msk below = gt_i(E, lit_i(E, high + 1), c);
    return and_m(E, above, below);
}

/* Lanes whose byte is in the set, which is not empty. */
static inline msk matcher_in_set(struct env *e, const struct byte_set *set, itg c)
{
    msk in = lit_m(E, 0);
    for (int low = 0; low < 256; low++) {
        int high = low;
        if (!byte_in(set, low))
            continue;
        while (high < 255 && byte_in(set, high + 1))
            high++;
        msk range = matcher_in_range(E, c, low, high);
        in = or_m(E, in, range);
        low = high;
    }
    return in;
}

/* The positions whose class contains the byte, by comparisons. */
static inline void matcher_compare(struct env *e, const struct automaton *a, itg c, itg set[AUTOMATON_WORDS])
{
    for (int w = 0; w < a->words; w++)
        set[w] = lit_i(E, 0);
    for (int class = 0; class < a->classes; class ++) {
        bool all = class_is_all(&a->class[class]);
        msk in = all ? lit_m(E, -1) : matcher_in_set(E, &a->class[class], c);
        for (int w = 0; w < a->words; w++) {
            itg members = lit_i(E, (int32_t)a->members[class].word[w]);
            itg active = and_i(E, mask_i(E, in), members);
            set[w] = or_i(E, set[w], active);
        }
    }
}

static inline void matcher_look_up(struct env *e, const struct automaton *a, itg c, itg set[AUTOMATON_WORDS])
{
    for (int w = 0; w < a->words; w++)
        set[w] = gather_i(E, BASE_JOB, (int)offsetof(struct matcher_job, table), c, 4, 1024 * w);
}

/* The positions that follow some position by one in the same word: a shift. */
static inline uint32_t matcher_shifted(const struct automaton *a, int word)
{
    uint32_t to = 0;
    for (int p = 32 * word; p < 32 * word + 31 && p + 1 < a->positions; p++)
        to |= (uint32_t)position_in(&a->follow[p], p + 1) << (p + 1) % 32;
    return to;
}

/* The positions that follow themselves. */
static inline uint32_t matcher_repeated(const struct automaton *a, int word)
{
    uint32_t repeated = 0;
    for (int p = 32 * word; p < 32 * word + 32 && p < a->positions; p++)
        repeated |= (uint32_t)position_in(&a->follow[p], p) << p % 32;
    return repeated;
}

/* The followers of a position that are neither the position nor the next one of its word. */
static inline struct position_set matcher_others(const struct automaton *a, int p)
{
    struct position_set set = a->follow[p];
    set.word[p / 32] &= ~(1u << p % 32);
    if (p % 32 < 31)
        set.word[p / 32] &= ~(2u << p % 32);
    return set;
}

static inline bool matcher_is_empty(const struct position_set *set)
{
    return !(set->word[0] | set->word[1] | set->word[2] | set->word[3]);
}

/* Adds `to` in the lanes in which a position of `from` is active. */
static inline void matcher_jump(struct env *e, const struct automaton *a, const itg state[AUTOMATON_WORDS],
                                const struct position_set *from, const struct position_set *to,
                                itg next[AUTOMATON_WORDS])
{
    itg active = lit_i(E, 0);
    for (int w = 0; w < a->words; w++) {
        itg some = and_i(E, state[w], lit_i(E, (int32_t)from->word[w]));
        active = or_i(E, active, some);
    }
    msk none = eq_i(E, active, lit_i(E, 0));
    for (int w = 0; w < a->words; w++) {
        if (!to->word[w])
            continue;
        itg added = select_i(E, none, lit_i(E, 0), lit_i(E, (int32_t)to->word[w]));
        next[w] = or_i(E, next[w], added);
    }
}

/* The other followers: positions with the same ones jump together. */
static inline void matcher_jumps(struct env *e, const struct automaton *a, const itg state[AUTOMATON_WORDS],
                                 itg next[AUTOMATON_WORDS])
{
    struct position_set done = {{0}};
    for (int p = 0; p < a->positions; p++) {
        struct position_set to = matcher_others(a, p), from = {{0}};
        if (position_in(&done, p) || matcher_is_empty(&to))
            continue;
        for (int q = p; q < a->positions; q++) {
            struct position_set same = matcher_others(a, q);
            if (!memcmp(&same, &to, sizeof to))
                position_add(&from, q);
        }
        position_join(&done, &from);
        matcher_jump(E, a, state, &from, &to, next);
    }
}

/* The positions after another byte, before its class is known. */
static inline void matcher_follow(struct env *e, const struct automaton *a, const itg state[AUTOMATON_WORDS],
                                  itg next[AUTOMATON_WORDS])
{
    for (int w = 0; w < a->words; w++) {
        itg moved = shl_i(E, state[w], 1);
        itg reached = and_i(E, moved, lit_i(E, (int32_t)matcher_shifted(a, w)));
        itg stayed = and_i(E, state[w], lit_i(E, (int32_t)matcher_repeated(a, w)));
        itg begun = lit_i(E, a->from_start ? 0 : (int32_t)a->first.word[w]);
        itg both = or_i(E, reached, stayed);
        next[w] = or_i(E, both, begun);
    }
    matcher_jumps(E, a, state, next);
}

/* Notes a match in the lanes that are alive. */
static inline void matcher_note(struct env *e, const struct automaton *a, struct matcher_state *state,
                                msk where)
{
    for (int w = 0; w < a->words; w++) {
        itg last = and_i(E, state->word[w], lit_i(E, (int32_t)a->last.word[w]));
        itg hits = and_i(E, last, mask_i(E, where));
        state->hits = or_i(E, state->hits, hits);
    }
}

static inline void matcher_step(struct env *e, const struct automaton *a, itg c, struct matcher_state *state)
{
    itg next[AUTOMATON_WORDS], set[AUTOMATON_WORDS];
    msk ends = eq_i(E, c, lit_i(E, '\n'));
    if (a->to_end) {
        msk now = and_m(E, state->alive, ends);
        matcher_note(E, a, state, now);
    }
    state->alive = andn_m(E, state->alive, ends);
    matcher_follow(E, a, state->word, next);
    if (a->tabled)
        matcher_look_up(E, a, c, set);
    else
        matcher_compare(E, a, c, set);
    for (int w = 0; w < a->words; w++)
        state->word[w] = and_i(E, next[w], set[w]);
    if (!a->to_end)
        matcher_note(E, a, state, state->alive);
}

/* Four bytes. Lanes whose line has ended read the same bytes again. */
static inline void matcher_word(struct env *e, const struct automaton *a)
{
    struct matcher_state state = {.hits = get_i(E, MATCHER_HITS)};
    itg place = get_i(E, MATCHER_PLACE);
    state.alive = get_m(E, MATCHER_ALIVE);
    for (int w = 0; w < a->words; w++)
        state.word[w] = get_i(E, w);
    itg bytes = gather_i(E, BASE_JOB, (int)offsetof(struct matcher_job, text), place, 1, 0);
    for (int byte = 0; byte < 4; byte++) {
        itg shifted = ushr_i(E, bytes, 8 * byte);
        itg c = and_i(E, shifted, lit_i(E, 255));
        matcher_step(E, a, c, &state);
    }
    msk none = eq_i(E, state.hits, lit_i(E, 0));
    state.alive = and_m(E, state.alive, none);
    itg advance = and_i(E, mask_i(E, state.alive), lit_i(E, 4));
    for (int w = 0; w < a->words; w++)
        set_i(E, w, state.word[w]);
    set_i(E, MATCHER_PLACE, add_i(E, place, advance));
    set_i(E, MATCHER_HITS, state.hits);
    set_m(E, MATCHER_ALIVE, state.alive);
}

/* INPUT has the offset of the line in the text. */
static inline void matcher_text(struct env *e, const struct automaton *a)
{
    if (automaton_accepts_all(a)) {
        store_i(E, BASE_OUTPUT, 0, lit_i(E, 1));
        return;
    }
    for (int w = 0; w < a->words; w++)
        set_i(E, w, lit_i(E, w == 0 && a->from_start));
    set_i(E, MATCHER_HITS, lit_i(E, 0));
    set_i(E, MATCHER_PLACE, load_i(E, BASE_INPUT, 0));
    set_m(E, MATCHER_ALIVE, lit_m(E, -1));
    LOOP(E, MATCHER_ALIVE)
    matcher_word(E, a);
    itg hits = get_i(E, MATCHER_HITS);
    msk none = eq_i(E, hits, lit_i(E, 0));
    itg found = select_i(E, none, lit_i(E, 0), lit_i(E, 1));
    store_i(E, BASE_OUTPUT, 0, found);
}

#endif
