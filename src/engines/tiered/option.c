/* The options of the tiered engines: def/engine/tiered.def. */
#include "base/words.h"
#include "emu/batch/batch.h"
#include "emu/emulate/emulate.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"
#include "engines/tiered/tier.h"

#include <stdlib.h>
#include <string.h>

void *tiered_copy_options(const struct engine *engine)
{
    struct tiered_options *copy = malloc(sizeof *copy);
    if (copy)
        *copy = *(const struct tiered_options *)engine->options;
    return copy;
}

/* --- Tiers ---------------------------------------------------------------------------------------------- */

static const struct engine *const choices[] = {
#define TIER(symbol) &engine_##symbol,
#include "def/engine/tier.def"
#undef TIER
};

static const char *choice_name(const struct words *words, unsigned i)
{
    (void)words;
    return i < sizeof choices / sizeof *choices ? choices[i]->name : NULL;
}

static int add_tier(struct tiered_options *options, const char *name, size_t length, struct error *error)
{
    const struct words words = {.at = choice_name};
    unsigned index;
    if (options->count == TIERS)
        return error_set(error, "tiers has more than %d engines", TIERS);
    if (!words_find(words, name, length, &index)) {
        char names[ERROR_CAPACITY / 2];
        words_join(words, names, sizeof names);
        error_set(error, "found the tier \"%.*s\", expected one of: %s", (int)(length < 40 ? length : 40),
                  name, names);
        return words_suggest_in(words, name, length, error);
    }
    options->tier[options->count++] = choices[index];
    return 0;
}

int tiered_set_tiers(void *options, const char *value, struct error *error)
{
    struct tiered_options *o = options;
    o->count = 0;
    for (const char *at = value;; at++) {
        size_t length = strcspn(at, "+");
        if (add_tier(o, at, length, error))
            return -1;
        at += length;
        if (!*at)
            break;
    }
    return o->count >= 2 ? 0 : error_set(error, "tiers is \"%.40s\", expected at least 2 engines", value);
}

/* --- Numbers -------------------------------------------------------------------------------------------- */

/* Reads a whole number of at most 7 digits. Returns the text after it, or null. */
static const char *read_number(const char *text, uint64_t least, uint64_t most, uint64_t *number)
{
    size_t digits = strspn(text, "0123456789");
    *number = 0;
    for (size_t i = 0; i < digits && digits < 8; i++)
        *number = *number * 10 + (uint64_t)(text[i] - '0');
    return digits && digits < 8 && *number >= least && *number <= most ? text + digits : NULL;
}

enum { MOST = 1000000, KEEP_KIB = 65536, HYSTERESIS = 1000 };

static int set_numbers(struct tier_numbers *numbers, const char *name, const char *value, struct error *error)
{
    const char *at = value;
    for (numbers->count = 0; at && numbers->count < TIERS; at++) {
        at = read_number(at, 0, MOST, &numbers->at[numbers->count]);
        if (!at)
            break;
        numbers->count++;
        if (!*at)
            return 0;
        if (*at != '+')
            break;
    }
    return error_set(error,
                     "%s is \"%.40s\", expected at most %d whole numbers from 0 to %d with + between them",
                     name, value, TIERS, MOST);
}

int tiered_set_runs(void *options, const char *value, struct error *error)
{
    return set_numbers(&((struct tiered_options *)options)->runs, "runs", value, error);
}

int tiered_set_elements(void *options, const char *value, struct error *error)
{
    return set_numbers(&((struct tiered_options *)options)->elements, "elements", value, error);
}

static int set_number(const char *name, const char *value, uint64_t most, uint64_t *number,
                      struct error *error)
{
    const char *end = read_number(value, 1, most, number);
    if (end && !*end)
        return 0;
    return error_set(error, "%s is \"%.40s\", expected a whole number from 1 to %u", name, value,
                     (unsigned)most);
}

int tiered_set_keep(void *options, const char *value, struct error *error)
{
    uint64_t kib;
    if (set_number("keep", value, KEEP_KIB, &kib, error))
        return -1;
    ((struct tiered_options *)options)->keep = (size_t)kib << 10;
    return 0;
}

int tiered_set_hysteresis(void *options, const char *value, struct error *error)
{
    return set_number("hysteresis", value, HYSTERESIS, &((struct tiered_options *)options)->hysteresis,
                      error);
}

int tiered_set_wait(void *options, const char *value, struct error *error)
{
    (void)value, (void)error;
    ((struct tiered_options *)options)->waits = true;
    return 0;
}
