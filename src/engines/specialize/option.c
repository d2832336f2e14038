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

static int read_number(const char *option, const char *value, unsigned least, unsigned most, unsigned *number,
                       struct error *error)
{
    enum { DIGITS = 9 };
    size_t digits = strspn(value, "0123456789");
    *number = 0;
    for (size_t i = 0; i < digits && i < DIGITS; i++)
        *number = *number * 10 + (unsigned)(value[i] - '0');
    if (!digits || digits > DIGITS || value[digits] || *number < least || *number > most)
        return error_set(error, "%s is \"%.40s\", expected a whole number from %u to %u", option, value,
                         least, most);
    return 0;
}

int specialize_set_registers(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    unsigned most = allocate_most_registers(o->width ? o->width : 16);
    if (read_number("registers", value, 0, most, &o->registers, error))
        return -1;
    o->limited = true;
    return 0;
}

int specialize_set_track(void *options, const char *value, struct error *error)
{
    enum { MOST = 65535 };
    return read_number("track", value, 1, MOST, &((struct build_options *)options)->track, error);
}

int specialize_set_sixteen(void *options, const char *value, struct error *error)
{
    enum { MOST = 1000000 };
    return read_number("sixteen", value, 0, MOST, &((struct build_options *)options)->sixteen, error);
}

static const char *const profiles[] = {
    [PROFILE_NONE] = "none", [PROFILE_THESIS] = "thesis", [PROFILE_FULL] = "all"};

int specialize_set_passes(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(profiles), "passes", value, &index, error))
        return -1;
    o->profile = (enum profile)index;
    return 0;
}

static const char *const addresses[] = {
    [ADDRESSES_LOADED] = "loaded", [ADDRESSES_PATCHED] = "patched", [ADDRESSES_SHARED] = "shared"};

static const char *const labels[] = {[LABELS_KEY] = "key", [LABELS_RECORDING] = "recording"};

int specialize_set_labels(void *options, const char *value, struct error *error)
{
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(labels), "labels", value, &index, error))
        return -1;
    ((struct build_options *)options)->labels = (enum labels)index;
    return 0;
}

static const char *const calls[] = {
    [CALLS_INLINE] = "inline", [CALLS_SAMPLING] = "sampling", [CALLS_SHARED] = "shared"};

int specialize_set_calls(void *options, const char *value, struct error *error)
{
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(calls), "calls", value, &index, error))
        return -1;
    ((struct build_options *)options)->calls = (enum calls)index;
    return 0;
}

int specialize_set_addresses(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(addresses), "addresses", value, &index, error))
        return -1;
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
    unsigned index;
    if (words_choose((struct words){.at = pass_choice}, option, value, &index, error))
        return -1;
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
    unsigned index;
    if (words_choose((struct words){.at = without_choice}, "without", value, &index, error))
        return -1;
    if (index < PASS_COUNT)
        return name_pass("without", value, &o->disabled, &o->enabled, error);
    o->without_rules |= 1ull << (index - PASS_COUNT);
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
    unsigned index;
    if (words_choose((struct words){.at = allocator_choice}, "allocate", value, &index, error))
        return -1;
    o->allocator = (enum allocator)index;
    return 0;
}

static const char *const encodings[] = {[ENCODING_BYTES] = "bytes", [ENCODING_TEXT] = "text"};

int specialize_set_encode(void *options, const char *value, struct error *error)
{
    struct build_options *o = options;
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(encodings), "encode", value, &index, error))
        return -1;
    o->encoding = (enum encoding)index;
    return 0;
}
