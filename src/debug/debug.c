#include "debug/debug.h"
#include "base/words.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct debug_record {
    void *of[DEBUG_LISTENERS];
};

static const char *const words[DEBUG_LISTENERS] = {
#define DEBUG(name, meaning) #name,
#include "def/debug.def"
#undef DEBUG
};

static const struct debug_interface *const interfaces[DEBUG_LISTENERS] = {
#define DEBUG(name, meaning) &debug_to_##name,
#include "def/debug.def"
#undef DEBUG
};

static int unknown_word(const char *word, int length, struct error *error)
{
    const struct words listeners = WORDS_OF_ROWS(words);
    char all[128];
    words_join(listeners, all, sizeof all);
    error_set(error, "debug is \"%.*s\", expected one or more of: %s", length, word, all);
    return words_suggest_in(listeners, word, (size_t)length, error);
}

int debug_read(const char *list, unsigned *listeners, struct error *error)
{
    *listeners = 0;
    while (list && *list) {
        int length = (int)strcspn(list, ","), i = 0;
        while (i < DEBUG_LISTENERS && (strncmp(words[i], list, (size_t)length) || words[i][length]))
            i++;
        if (i == DEBUG_LISTENERS)
            return unknown_word(list, length, error);
        *listeners |= 1u << i;
        list += length;
        list += *list == ',';
    }
    return 0;
}

int debug_open(unsigned listeners, struct error *error)
{
    int result = 0;
    for (int i = 0; i < DEBUG_LISTENERS; i++)
        if (listeners >> i & 1 && interfaces[i]->open(error))
            result = -1;
    return result;
}

struct debug_record *debug_add(unsigned listeners, const struct debug_code *code, struct error *error)
{
    struct debug_record *record = calloc(1, sizeof *record);
    if (!record || code->failed) {
        error_set(error, "out of memory for debugging %s", code->name);
        free(record);
        return NULL;
    }
    for (int i = 0; i < DEBUG_LISTENERS; i++)
        if (listeners >> i & 1)
            interfaces[i]->add(code, &record->of[i], error);
    return record;
}

void debug_remove(struct debug_record *record)
{
    for (int i = 0; record && i < DEBUG_LISTENERS; i++)
        if (record->of[i])
            interfaces[i]->remove(record->of[i]);
    free(record);
}
