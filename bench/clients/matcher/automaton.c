/* Makes automata while parsing: a part of an expression is its first and last positions, and concatenation
 * and repetition add the pairs of positions that follow each other. A counted repetition parses its part
 * again. */
#include "bench/clients/matcher/automaton.h"

#include "bench/clients/matcher/class.h"

#include <stdlib.h>
#include <string.h>

/* A part of the expression. */
struct part {
    struct position_set first, last;
    bool empty; /* the part matches the empty text */
};

enum { MOST_TIMES = 64, MOST_DEPTH = 32, UNLIMITED = -1 };

static struct part parse_alternatives(struct class_reader *reader, struct automaton *a);

static void link_sets(struct automaton *a, const struct position_set *from, const struct position_set *to)
{
    for (int p = 0; p < a->positions; p++)
        if (position_in(from, p))
            position_join(&a->follow[p], to);
}

static struct part concatenate(struct automaton *a, struct part left, struct part right)
{
    link_sets(a, &left.last, &right.first);
    struct part both = {left.first, right.last, left.empty && right.empty};
    if (left.empty)
        position_join(&both.first, &right.first);
    if (right.empty)
        position_join(&both.last, &left.last);
    return both;
}

/* Adds a position of a class. */
static struct part add_position(struct class_reader *reader, struct automaton *a, const struct byte_set *set)
{
    struct part part = {.empty = false};
    if (a->positions == AUTOMATON_POSITIONS) {
        class_fail(reader, "the expression has more than %d positions", AUTOMATON_POSITIONS - 1);
        return part;
    }
    int number = a->positions++, class = 0;
    memset(&a->follow[number], 0, sizeof a->follow[number]);
    while (class < a->classes && memcmp(&a->class[class], set, sizeof *set))
        class ++;
    if (class == a->classes)
        a->class[a->classes++] = *set;
    position_add(&a->members[class], number);
    position_add(&part.first, number);
    position_add(&part.last, number);
    return part;
}

static struct part parse_atom(struct class_reader *reader, struct automaton *a)
{
    struct byte_set set;
    if (*reader->at != '(') {
        class_read(reader, &set);
        return reader->failed ? (struct part){.empty = true} : add_position(reader, a, &set);
    }
    reader->at += strncmp(reader->at, "(?:", 3) ? 1 : 3;
    if (++reader->depth > MOST_DEPTH)
        class_fail(reader, "parentheses are nested more than %d deep", MOST_DEPTH);
    struct part part = reader->failed ? (struct part){.empty = true} : parse_alternatives(reader, a);
    reader->depth--;
    if (*reader->at == ')')
        reader->at++;
    else
        class_fail(reader, "found the end, expected )");
    return part;
}

struct times {
    int least, most; /* UNLIMITED */
};

static int read_number(struct class_reader *reader)
{
    int number = 0;
    if (*reader->at < '0' || *reader->at > '9')
        class_fail(reader, "found \"%.4s\", expected a number of repetitions", reader->at);
    while (*reader->at >= '0' && *reader->at <= '9' && number <= MOST_TIMES)
        number = 10 * number + *reader->at++ - '0';
    if (number > MOST_TIMES)
        class_fail(reader, "found %d repetitions, expected at most %d", number, MOST_TIMES);
    return number;
}

static struct times read_counts(struct class_reader *reader)
{
    struct times times;
    reader->at++;
    times.least = times.most = read_number(reader);
    if (*reader->at == ',')
        times.most = *++reader->at == '}' ? UNLIMITED : read_number(reader);
    if (*reader->at == '}' && (times.most == UNLIMITED || times.least <= times.most))
        reader->at++;
    else
        class_fail(reader, "found \"%.4s\", expected } after {least,most}", reader->at);
    return times;
}

static struct times read_times(struct class_reader *reader)
{
    switch (*reader->at) {
    case '*': reader->at++; return (struct times){0, UNLIMITED};
    case '+': reader->at++; return (struct times){1, UNLIMITED};
    case '?': reader->at++; return (struct times){0, 1};
    case '{': return read_counts(reader);
    default: return (struct times){1, 1};
    }
}

/* Parses the atom at `start` again. */
static struct part parse_copy(struct class_reader *reader, struct automaton *a, const char *start)
{
    const char *end = reader->at;
    reader->at = start;
    struct part part = parse_atom(reader, a);
    reader->at = end;
    return part;
}

/* Removes the positions from `first` on, whose repetition is {0}. */
static void remove_positions(struct automaton *a, int first)
{
    for (int p = first; p < a->positions; p++)
        for (int class = 0; class < a->classes; class ++)
            a->members[class].word[p / 32] &= ~(1u << p % 32);
    a->positions = first;
}

static struct part parse_repeated(struct class_reader *reader, struct automaton *a)
{
    const char *start = reader->at;
    int before = a->positions;
    struct part copy = parse_atom(reader, a), all = {.empty = true};
    struct times times = read_times(reader);
    if (strchr("*+?{", *reader->at) && *reader->at)
        class_fail(reader, "found \"%c\" after a repetition, expected parentheses", *reader->at);
    if (times.most == 0)
        remove_positions(a, before);
    int copies = times.most != UNLIMITED ? times.most : times.least ? times.least : 1;
    for (int n = 0; n < copies && !reader->failed; n++) {
        if (n)
            copy = parse_copy(reader, a, start);
        if (times.most == UNLIMITED && n == copies - 1)
            link_sets(a, &copy.last, &copy.first);
        copy.empty |= n >= times.least;
        all = concatenate(a, all, copy);
    }
    return all;
}

static struct part parse_sequence(struct class_reader *reader, struct automaton *a)
{
    struct part all = {.empty = true};
    while (!reader->failed && *reader->at && *reader->at != '|' && *reader->at != ')' &&
           !(*reader->at == '$' && !reader->at[1])) {
        struct part next = parse_repeated(reader, a);
        all = concatenate(a, all, next);
    }
    return all;
}

static struct part parse_alternatives(struct class_reader *reader, struct automaton *a)
{
    struct part all = parse_sequence(reader, a);
    while (!reader->failed && *reader->at == '|') {
        reader->at++;
        reader->alternatives += !reader->depth;
        struct part next = parse_sequence(reader, a);
        position_join(&all.first, &next.first);
        position_join(&all.last, &next.last);
        all.empty |= next.empty;
    }
    return all;
}

/* Position 0 is before the first character. An empty text matches ^$ if nothing has been read. */
static void add_start(struct automaton *a)
{
    a->follow[0] = a->first;
    if (a->empty && a->to_end)
        position_add(&a->last, 0);
}

/* The comparisons of a kernel for a class: one for a single byte, three operations for a range. */
static int class_cost(const struct byte_set *set)
{
    int cost = 0;
    for (int byte = 0; byte < 256; byte++)
        if (byte_in(set, byte) && (byte == 0 || !byte_in(set, byte - 1)))
            cost += byte < 255 && byte_in(set, byte + 1) ? 3 : 1;
    return cost + 2;
}

static void make_table(struct automaton *a)
{
    int cost = 0;
    for (int class = 0; class < a->classes; class ++) {
        cost += class_is_all(&a->class[class]) ? 0 : class_cost(&a->class[class]);
        for (int byte = 0; byte < 256; byte++)
            for (int w = 0; w < AUTOMATON_WORDS && byte_in(&a->class[class], byte); w++)
                a->table[w][byte] |= a->members[class].word[w];
    }
    a->tabled = cost > 12 * a->words;
}

int automaton_make(struct automaton *a, const char *expression, struct error *error)
{
    struct class_reader reader = {.at = expression, .start = expression, .error = error};
    memset(a, 0, sizeof *a);
    a->positions = 1;
    a->from_start = *expression == '^';
    reader.at += a->from_start;
    struct part all = parse_alternatives(&reader, a);
    a->to_end = *reader.at == '$';
    if (reader.at[a->to_end])
        class_fail(&reader, "found \"%c\", expected the end of the expression", *reader.at);
    if (reader.alternatives && (a->from_start || a->to_end))
        class_fail(&reader, "^ and $ need parentheses around alternatives");
    a->first = all.first;
    a->last = all.last;
    a->empty = all.empty;
    a->words = (a->positions + 31) / 32;
    if (a->from_start)
        add_start(a);
    make_table(a);
    return reader.failed ? -1 : 0;
}

bool automaton_accepts_all(const struct automaton *a)
{
    return a->empty && !(a->from_start && a->to_end);
}
