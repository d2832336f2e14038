#include "command/results/ranges.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The text of a range with its comma: two numbers of up to 20 digits. */
enum { ITEM_TEXT = 48, CAPACITY_FIRST = 16, DIGITS_MAXIMUM = 18 };

void ranges_free(struct ranges *ranges)
{
    free(ranges->item);
    *ranges = (struct ranges){0};
}

void ranges_clear(struct ranges *ranges)
{
    ranges->count = 0;
    ranges->failed = false;
}

static bool grow(struct ranges *ranges)
{
    if (ranges->count < ranges->capacity)
        return true;
    size_t capacity = ranges->capacity ? 2 * ranges->capacity : CAPACITY_FIRST;
    struct ranges_item *item = realloc(ranges->item, capacity * sizeof *item);
    if (!item)
        return !(ranges->failed = true);
    ranges->item = item;
    ranges->capacity = capacity;
    return true;
}

/* The first range that ends at or after the number; `count` if there is none. */
static size_t find(const struct ranges *ranges, uint64_t number)
{
    size_t low = 0, high = ranges->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (ranges->item[middle].last < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Replaces the ranges from..to-1 by one. */
static void replace(struct ranges *ranges, size_t from, size_t to, struct ranges_item item)
{
    memmove(ranges->item + from + 1, ranges->item + to, (ranges->count - to) * sizeof item);
    ranges->count -= to - from;
    ranges->item[from] = item;
    ranges->count++;
}

void ranges_add(struct ranges *ranges, uint64_t first, uint64_t last)
{
    size_t from = find(ranges, first ? first - 1 : 0), to = from;
    struct ranges_item item = {first, last};
    if (!grow(ranges))
        return;
    while (to < ranges->count && ranges->item[to].first <= (last == UINT64_MAX ? last : last + 1))
        to++;
    if (to > from) {
        if (ranges->item[from].first < first)
            item.first = ranges->item[from].first;
        if (ranges->item[to - 1].last > last)
            item.last = ranges->item[to - 1].last;
    }
    replace(ranges, from, to, item);
}

void ranges_add_all(struct ranges *ranges, const struct ranges *other)
{
    for (size_t i = 0; i < other->count; i++)
        ranges_add(ranges, other->item[i].first, other->item[i].last);
    ranges->failed |= other->failed;
}

uint64_t ranges_size(const struct ranges *ranges)
{
    uint64_t size = 0;
    for (size_t i = 0; i < ranges->count; i++)
        size += ranges->item[i].last - ranges->item[i].first + 1;
    return size;
}

bool ranges_has(const struct ranges *ranges, uint64_t number)
{
    size_t i = find(ranges, number);
    return i < ranges->count && ranges->item[i].first <= number;
}

uint64_t ranges_at(const struct ranges *ranges, uint64_t position)
{
    size_t i = 0;
    for (uint64_t size; i + 1 < ranges->count; i++, position -= size) {
        size = ranges->item[i].last - ranges->item[i].first + 1;
        if (position < size)
            break;
    }
    return ranges->item[i].first + position;
}

void ranges_common(const struct ranges *a, const struct ranges *b, struct ranges *common)
{
    for (size_t i = 0, j = 0; i < a->count && j < b->count;) {
        const struct ranges_item *x = &a->item[i], *y = &b->item[j];
        uint64_t first = x->first > y->first ? x->first : y->first;
        uint64_t last = x->last < y->last ? x->last : y->last;
        if (first <= last)
            ranges_add(common, first, last);
        if (x->last < y->last)
            i++;
        else
            j++;
    }
}

void ranges_missing(const struct ranges *ranges, uint64_t first, uint64_t last, struct ranges *missing)
{
    size_t i = find(ranges, first);
    uint64_t next = first;
    for (; i < ranges->count && ranges->item[i].first <= last; i++) {
        if (next < ranges->item[i].first)
            ranges_add(missing, next, ranges->item[i].first - 1);
        if (ranges->item[i].last >= last)
            return;
        next = ranges->item[i].last + 1;
    }
    if (next <= last)
        ranges_add(missing, next, last);
}

char *ranges_text(const struct ranges *ranges)
{
    char *text = ranges->failed ? NULL : malloc(ranges->count * ITEM_TEXT + 1), *at = text;
    if (!text)
        return NULL;
    *at = 0;
    for (size_t i = 0; i < ranges->count; i++) {
        const struct ranges_item *item = &ranges->item[i];
        at += snprintf(at, ITEM_TEXT, "%s%" PRIu64, i ? "," : "", item->first);
        if (item->last > item->first)
            at += snprintf(at, ITEM_TEXT, "-%" PRIu64, item->last);
    }
    return text;
}

/* Reads a decimal number without superfluous zeros. */
static bool read_number(const char **text, uint64_t *number)
{
    size_t digits = strspn(*text, "0123456789");
    if (!digits || digits > DIGITS_MAXIMUM || (digits > 1 && **text == '0'))
        return false;
    *number = strtoull(*text, NULL, 10);
    *text += digits;
    return true;
}

static bool read_item(const char **text, struct ranges_item *item)
{
    if (!read_number(text, &item->first))
        return false;
    item->last = item->first;
    if (**text != '-')
        return true;
    (*text)++;
    return read_number(text, &item->last) && item->last > item->first;
}

bool ranges_read(const char *text, struct ranges *ranges)
{
    struct ranges_item item;
    while (*text) {
        if (!read_item(&text, &item))
            return false;
        if (ranges->count && item.first <= ranges->item[ranges->count - 1].last + 1)
            return false;
        ranges_add(ranges, item.first, item.last);
        if (*text == ',' && text[1])
            text++;
        else if (*text)
            return false;
    }
    return !ranges->failed;
}
