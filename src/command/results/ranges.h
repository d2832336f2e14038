/* Sets of numbers as ranges: which units of a campaign are done.
 *
 * The ranges are in ascending order and no two of them touch, so a set has one form. As text:
 * "0-49,60,62-70", or "" for the empty set. */
#ifndef COMMAND_RESULTS_RANGES_H
#define COMMAND_RESULTS_RANGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct ranges_item {
    uint64_t first, last;
};

/* Zero is the empty set. After a refused allocation `failed` is true, and numbers may be missing. */
struct ranges {
    size_t count, capacity;
    struct ranges_item *item;
    bool failed;
};

void ranges_free(struct ranges *ranges);

/* Makes the set empty, and keeps its memory. */
void ranges_clear(struct ranges *ranges);

/* Adds the numbers from first to last; some may be in the set already. */
void ranges_add(struct ranges *ranges, uint64_t first, uint64_t last);
void ranges_add_all(struct ranges *ranges, const struct ranges *other);

/* The number of numbers. */
uint64_t ranges_size(const struct ranges *ranges);

bool ranges_has(const struct ranges *ranges, uint64_t number);

/* The number at a position, from 0, in ascending order; the position is less than the size. */
uint64_t ranges_at(const struct ranges *ranges, uint64_t position);

/* Adds to `common` the numbers that both sets have. */
void ranges_common(const struct ranges *a, const struct ranges *b, struct ranges *common);

/* Adds to `missing` the numbers from first to last that the set does not have. */
void ranges_missing(const struct ranges *ranges, uint64_t first, uint64_t last, struct ranges *missing);

/* The text, which the caller frees; null if memory is refused or the set has failed. */
char *ranges_text(const struct ranges *ranges);

/* Reads a text into an empty set. Returns false if it is not the text of a set. */
bool ranges_read(const char *text, struct ranges *ranges);

#endif
