/* The options of the specializer's engines: def/engine/variant.def. */
#include "base/words.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"

#include <stdlib.h>
#include <string.h>

void *specialize_copy_options(const struct engine *engine)
{
    struct build_options *copy = malloc(sizeof *copy);
    if (copy)
        *copy = *(const struct build_options *)engine->options;
    return copy;
}

static int set_unknown(const char *option, const char *value, struct words words, struct error *error)
{
    char choices[ERROR_CAPACITY / 2];
    words_join(words, choices, sizeof choices);
    error_set(error, "%s is \"%.40s\", expected one of: %s", option, value, choices);
    return words_suggest_in(words, value, strlen(value), error);
}

int specialize_set_registers(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    unsigned most = allocate_most_registers(o->width ? o->width : 16), number = 0;
    size_t digits = strspn(value, "0123456789");
    for (size_t i = 0; i < digits && i < 3; i++)
        number = number * 10 + (unsigned)(value[i] - '0');
    if (!digits || digits > 3 || value[digits] || number > most)
        return error_set(error, "registers is \"%.40s\", expected a whole number from 0 to %u", value, most);
    o->limited = true;
    o->registers = number;
    return 0;
}

static const char *const profiles[] = {
    [PROFILE_NONE] = "none", [PROFILE_THESIS] = "thesis", [PROFILE_FULL] = "all"};

int specialize_set_passes(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    const struct words words = WORDS_OF_ROWS(profiles);
    unsigned index;
    if (!words_find(words, value, strlen(value), &index))
        return set_unknown("passes", value, words, error);
    o->profile = (enum profile)index;
    return 0;
}

static const char *const addresses[] = {
    [ADDRESSES_LOADED] = "loaded", [ADDRESSES_PATCHED] = "patched", [ADDRESSES_SHARED] = "shared"};

static const char *const labels[] = {[LABELS_KEY] = "key", [LABELS_RECORDING] = "recording"};

int specialize_set_labels(void *options, const char *value, struct error *error)
{
    const struct words words = WORDS_OF_ROWS(labels);
    unsigned index;
    if (!words_find(words, value, strlen(value), &index))
        return set_unknown("labels", value, words, error);
    ((struct build_options *)options)->labels = (enum labels)index;
    return 0;
}

static const char *const calls[] = {
    [CALLS_INLINE] = "inline", [CALLS_SAMPLING] = "sampling", [CALLS_SHARED] = "shared"};

int specialize_set_calls(void *options, const char *value, struct error *error)
{
    const struct words words = WORDS_OF_ROWS(calls);
    unsigned index;
    if (!words_find(words, value, strlen(value), &index))
        return set_unknown("calls", value, words, error);
    ((struct build_options *)options)->calls = (enum calls)index;
    return 0;
}

int specialize_set_addresses(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    const struct words words = WORDS_OF_ROWS(addresses);
    unsigned index;
    if (!words_find(words, value, strlen(value), &index))
        return set_unknown("addresses", value, words, error);
    o->addresses = (enum addresses)index;
    return 0;
}

static const char *pass_choice(const struct words *words, unsigned i)
{
    (void)words;
    return pass_name(i);
}

/* Sets or clears the bit of the pass, and does the opposite in `other`. */
static int name_pass(const char *option, const char *value, uint32_t *passes, uint32_t *other,
                     struct error *error)
{
    const struct words words = {.at = pass_choice};
    unsigned index;
    if (!words_find(words, value, strlen(value), &index))
        return set_unknown(option, value, words, error);
    *passes |= 1u << index;
    *other &= ~(1u << index);
    return 0;
}

int specialize_set_with(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    return name_pass("with", value, &o->enabled, &o->disabled, error);
}

/* The passes that can be left out, then the peephole rules. */
static const char *without_choice(const struct words *words, unsigned i)
{
    (void)words;
    if (i < PASS_COUNT)
        return pass_is_required(i) ? "" : pass_name(i);
    return peephole_name(i - PASS_COUNT);
}

int specialize_set_without(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    const struct words words = {.at = without_choice};
    unsigned index;
    if (!words_find(words, value, strlen(value), &index))
        return set_unknown("without", value, words, error);
    if (index < PASS_COUNT)
        return name_pass("without", value, &o->disabled, &o->enabled, error);
    o->without_rules |= 1u << (index - PASS_COUNT);
    return 0;
}

int specialize_set_unroll(void *options, const char *value, struct error *error)
{
    (void)value;
    return specialize_set_with(options, pass_name(PASS_unroll), error);
}

static const char *allocator_choice(const struct words *words, unsigned i)
{
    (void)words;
    return allocate_name(i);
}

int specialize_set_allocate(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    const struct words words = {.at = allocator_choice};
    unsigned index;
    if (!words_find(words, value, strlen(value), &index))
        return set_unknown("allocate", value, words, error);
    o->allocator = (enum allocator)index;
    return 0;
}

static const char *const encodings[] = {[ENCODING_BYTES] = "bytes", [ENCODING_TEXT] = "text"};

int specialize_set_encode(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    const struct words words = WORDS_OF_ROWS(encodings);
    unsigned index;
    if (!words_find(words, value, strlen(value), &index))
        return set_unknown("encode", value, words, error);
    o->encoding = (enum encoding)index;
    return 0;
}
