/* Random regular expressions as trees, and their definition: the set of ends of a match for a set of begins.
 * The definition is independent of the automata. */
#ifndef CLIENTS_MATCHER_REGEX_H
#define CLIENTS_MATCHER_REGEX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Texts have at most this many bytes, so that a set of places is a word. */
enum { REGEX_TEXT = 60, REGEX_EXPRESSION = 512, REGEX_NODES = 64, REGEX_POSITIONS = 100 };

struct regex_node {
    enum { NODE_CHARACTER, NODE_SEQUENCE, NODE_CHOICE, NODE_REPEAT } kind;
    int left, right; /* numbers of nodes */
    int least, most; /* of a repetition; -1: unlimited */
    bool in[256];    /* of a character */
    char text[24];   /* of a character */
};

struct regex_expression {
    bool from_start, to_end;
    int nodes, root;
    struct regex_node node[REGEX_NODES];
    size_t length;
    char text[REGEX_EXPRESSION];
};

/* Makes an expression and its text. */
void regex_make(struct regex_expression *expression, uint64_t *seed);

/* Makes a text of the characters that the expressions prefer. Returns its length. */
size_t regex_line(uint8_t text[REGEX_TEXT], uint64_t *seed);

/* Returns true if the text contains a match. */
bool regex_matches(const struct regex_expression *expression, const uint8_t *text, size_t bytes);

uint32_t regex_below(uint64_t *seed, uint32_t limit);

#endif
