/* Regular expressions as automata of positions (Glushkov), for the kernel and for the plain C matcher.
 *
 * Each character of the expression, a literal, a class or a dot, is a *position*. A set of positions is a row
 * of bits. The automaton is in a position after it has read a character of the position's class. Position 0
 * is the start of an expression that begins with ^.
 *
 * Syntax: literals, `.`, classes as [a-z_] and [^...], \d \w \s \D \W \S \t \xHH and escaped punctuation,
 * ( ) and (?: ), |, * + ? {m} {m,} {m,n}; ^ only as the first and $ only as the last character, and then
 * without | outside of parentheses. Characters are bytes. No class contains the newline, which ends a text.
 *
 * Source: V. Glushkov, The abstract theory of automata, 1961; G. Navarro and M. Raffinot, Flexible Pattern
 * Matching in Strings, 2002, section 5.2. */
#ifndef CLIENTS_MATCHER_AUTOMATON_H
#define CLIENTS_MATCHER_AUTOMATON_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

enum { AUTOMATON_WORDS = 4, AUTOMATON_POSITIONS = 32 * AUTOMATON_WORDS };

struct position_set {
    uint32_t word[AUTOMATON_WORDS];
};

/* A set of bytes. */
struct byte_set {
    uint32_t word[8];
};

struct automaton {
    int positions;
    int words; /* that hold positions */
    bool from_start, to_end;
    bool empty; /* the empty text matches the expression without ^ and $ */
    struct position_set first, last;
    struct position_set follow[AUTOMATON_POSITIONS];
    int classes;
    struct byte_set class[AUTOMATON_POSITIONS];       /* all different */
    struct position_set members[AUTOMATON_POSITIONS]; /* the positions of each class */
    bool tabled; /* the kernel reads the positions of a byte from `table`; else it compares */
    uint32_t table[AUTOMATON_WORDS][256]; /* the positions whose class contains the byte */
};

/* Makes the automaton of an expression. Returns 0, or -1 with the reason. */
int automaton_make(struct automaton *automaton, const char *expression, struct error *error);

/* Returns true if every text matches. */
bool automaton_accepts_all(const struct automaton *automaton);

/* The automaton as a table of deterministic states, for plain C. */
struct dfa;

/* Returns null with the reason: memory, or too many states. */
struct dfa *dfa_create(const struct automaton *automaton, struct error *error);
void dfa_free(struct dfa *dfa);

/* Returns true if the text, which ends at a newline, contains a match. */
bool dfa_matches(const struct dfa *dfa, const uint8_t *text);

static inline bool position_in(const struct position_set *set, int position)
{
    return set->word[position / 32] >> position % 32 & 1;
}

static inline void position_add(struct position_set *set, int position)
{
    set->word[position / 32] |= 1u << position % 32;
}

static inline void position_join(struct position_set *set, const struct position_set *other)
{
    for (int w = 0; w < AUTOMATON_WORDS; w++)
        set->word[w] |= other->word[w];
}

static inline bool byte_in(const struct byte_set *set, int byte)
{
    return set->word[byte / 32] >> byte % 32 & 1;
}

static inline void byte_add(struct byte_set *set, int byte)
{
    set->word[byte / 32] |= 1u << byte % 32;
}

#endif
