#include "engines/variant.h"

#include "base/words.h"
#include "emu/batch/batch.h"
#include "emu/emulate/emulate.h"
#include "engines/external/external.h"
#include "engines/mixed.h"
#include "engines/specialize/specialize.h"
#include "engines/tiered/tiered.h"

#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct engine_option options[] = {
#define VARIANT(name, engines, values, meaning)                                                              \
    {#name, values, meaning, engines##_is_engine, engines##_copy_options, engines##_set_##name},
#include "def/engine/variant.def"
#include "def/engine/emulate.def"
#include "def/engine/batch_option.def"
#include "def/engine/mixed.def"
#include "def/engine/external.def"
#include "def/engine/tiered.def"
#undef VARIANT
};

struct variant {
    struct engine engine;
    void *options;
    char name[ENGINE_NAME_CAPACITY];
};

static struct {
    pthread_mutex_t lock;
    unsigned count; /* read without the lock: the variants below it do not change */
    struct variant *variant[ENGINE_VARIANTS];
} variants = {.lock = PTHREAD_MUTEX_INITIALIZER};

static void free_variant(struct variant *variant)
{
    if (variant)
        free(variant->options);
    free(variant);
}

__attribute__((destructor)) static void free_variants(void)
{
    for (unsigned i = 0; i < variants.count; i++)
        free_variant(variants.variant[i]);
    variants.count = 0;
}

const struct engine_option *engine_option_at(unsigned i)
{
    return i < sizeof options / sizeof *options ? options + i : NULL;
}

bool engine_takes_options(const struct engine *engine)
{
    for (unsigned i = 0; engine_option_at(i); i++)
        if (options[i].takes(engine))
            return true;
    return false;
}

bool engine_takes_option(const struct engine *engine, const char *name)
{
    for (unsigned i = 0; engine_option_at(i); i++)
        if (!strcmp(options[i].name, name) && options[i].takes(engine))
            return true;
    return false;
}

const struct engine *engine_variant_at(unsigned i)
{
    return i < __atomic_load_n(&variants.count, __ATOMIC_ACQUIRE) ? &variants.variant[i]->engine : NULL;
}

/* --- Making a variant ----------------------------------------------------------------------------------- */

/* The names of the options that an engine takes, for messages. */
static const char *option_choice(const struct words *words, unsigned i)
{
    const struct engine_option *option = engine_option_at(i);
    return !option ? NULL : option->takes(words->list) ? option->name : "";
}

/* Applies one option: `text` is NAME or NAME=VALUE. */
static int apply(const struct engine *base, void *values, const char *text, struct error *error)
{
    const struct words names = {option_choice, .list = base};
    size_t length = strcspn(text, "=");
    const char *value = text[length] ? text + length + 1 : NULL;
    unsigned index;
    if (!words_find(names, text, length, &index)) {
        char choices[ERROR_CAPACITY / 2];
        words_join(names, choices, sizeof choices);
        error_set(error, "found the option \"%.*s\", expected one of: %s", (int)length, text, choices);
        return words_suggest_in(names, text, length, error);
    }
    if (!value && *options[index].values)
        return error_set(error, "%s has no value, expected %s", text, options[index].values);
    if (value && !*options[index].values)
        return error_set(error, "%.*s takes no value, found \"%s\"", (int)length, text, value);
    return options[index].set(values, value, error);
}

static int apply_all(const struct engine *base, void *values, const char *list, struct error *error)
{
    char text[ENGINE_NAME_CAPACITY];
    for (const char *at = list; at; at = strchr(at, ':') ? strchr(at, ':') + 1 : NULL) {
        snprintf(text, sizeof text, "%.*s", (int)strcspn(at, ":"), at);
        if (apply(base, values, text, error))
            return -1;
    }
    return 0;
}

/* The way to copy the options of an engine that takes some. */
static const struct engine_option *any_option(const struct engine *engine)
{
    const struct engine_option *option = options;
    while (!option->takes(engine))
        option++;
    return option;
}

static struct variant *make(const struct engine *base, const char *name, size_t length, struct error *error)
{
    struct variant *variant = calloc(1, sizeof *variant);
    void *values = variant ? any_option(base)->copy_options(base) : NULL;
    if (!values) {
        errno = ENOMEM;
        error_set(error, "out of memory for an engine");
        return free_variant(variant), NULL;
    }
    variant->options = values;
    memcpy(variant->name, name, strlen(name) + 1);
    variant->engine = *base;
    variant->engine.name = variant->name;
    variant->engine.options = values;
    if (apply_all(base, values, name + length + 1, error))
        return free_variant(variant), NULL;
    return variant;
}

static const struct engine *find(const char *name)
{
    for (unsigned i = 0; i < variants.count; i++)
        if (!strcmp(variants.variant[i]->name, name))
            return &variants.variant[i]->engine;
    return NULL;
}

static const struct engine *find_locked(const char *name)
{
    pthread_mutex_lock(&variants.lock);
    const struct engine *found = find(name);
    pthread_mutex_unlock(&variants.lock);
    return found;
}

/* With the lock held: adds the variant, or frees it if another thread has added one of its name. */
static const struct engine *add(struct variant *variant, struct error *error)
{
    const struct engine *found = find(variant->name);
    if (found)
        return free_variant(variant), found;
    if (variants.count == ENGINE_VARIANTS) {
        error_set(error, "there are %d variants of engines already, no more can be made", ENGINE_VARIANTS);
        return free_variant(variant), NULL;
    }
    variants.variant[variants.count] = variant;
    __atomic_store_n(&variants.count, variants.count + 1, __ATOMIC_RELEASE);
    return &variant->engine;
}

/* Makes the variant without the lock: its options may name other variants. */
static const struct engine *find_or_make(const struct engine *base, const char *name, size_t length,
                                         struct error *error)
{
    const struct engine *found = find_locked(name);
    struct variant *variant = found ? NULL : make(base, name, length, error);
    if (!variant)
        return found;
    pthread_mutex_lock(&variants.lock);
    found = add(variant, error);
    pthread_mutex_unlock(&variants.lock);
    return found;
}

const struct engine *engine_vary(const struct engine *base, const char *name, size_t length,
                                 struct error *error)
{
    struct error reason = {""};
    const struct engine *variant = NULL;
    if (!engine_takes_options(base)) {
        error_set(&reason, "%s takes no options", base->name);
    } else if (strlen(name) >= ENGINE_NAME_CAPACITY) {
        error_set(&reason, "the name has %zu bytes, expected at most %d", strlen(name),
                  ENGINE_NAME_CAPACITY - 1);
    } else {
        variant = find_or_make(base, name, length, &reason);
    }
    if (!variant)
        error_set(error, "engine %.120s: %s", name, reason.text);
    return variant;
}
