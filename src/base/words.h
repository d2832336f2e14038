/* Lists of words: the choices in an error message, and the word that a misspelled one resembles.
 *
 * A list is a function of an index, so that tables with other columns are lists without a copy. */
#ifndef BASE_WORDS_H
#define BASE_WORDS_H

#include "base/error.h"

#include <stddef.h>

struct words {
    /* The word of that index, null after the last, or an empty text for a row that is not a choice here. */
    const char *(*at)(const struct words *words, unsigned index);
    const void *list; /* for the function */
    unsigned count;   /* the same */
    size_t stride;    /* the same */
};

/* The list of an array of words, or of structures whose first member is the word. */
#define WORDS_OF_ROWS(rows)                                                                                  \
    ((struct words){words_row, (rows), (unsigned)(sizeof(rows) / sizeof *(rows)), sizeof *(rows)})
const char *words_row(const struct words *words, unsigned index);

/* Returns the first word that equals the given bytes, and its index; null, and the index unchanged, if there
 * is none. */
const char *words_find(struct words words, const char *given, size_t length, unsigned *index);

/* Returns another word that the given bytes most likely were meant to be, null if none is similar. The
 * measure is the restricted Damerau-Levenshtein distance: the number of letters to insert, delete, replace or
 * exchange with their neighbour, regardless of case. A word is similar up to a third of its length. A word
 * that begins with the given bytes, at least three, has the distance 1. */
const char *words_nearest(struct words words, const char *given, size_t length);

/* Writes "a, b, c". If the list does not fit, it ends with ", ...". */
void words_join(struct words words, char *text, size_t capacity);

enum { WORDS_SUGGESTION = 96 };

/* Writes `; did you mean "WORD"?`, or an empty text if no word is similar. Returns `text`. */
const char *words_suggest(struct words words, const char *given, size_t length, char text[WORDS_SUGGESTION]);

/* Adds the suggestion to a reason, whose end is cut off if there is no room. Always returns -1, like
 * error_set. */
int words_suggest_in(struct words words, const char *given, size_t length, struct error *error);

/* Reads the value of an option: writes its index in the list. Otherwise returns -1, the index is unchanged,
 * and the reason is `OPTION is "VALUE", expected one of: a, b`, with a suggestion. */
int words_choose(struct words words, const char *option, const char *value, unsigned *index,
                 struct error *error);

#endif
