/* Variants of engines: an engine with options in its name, as in "specialize-8:registers=6:without=fold".
 *
 * A variant has a name, options and so routines of its own, and gives the same bits as the engine. It is made
 * when its name is first used, and stays until the library is unloaded. The same name is the same engine;
 * options in another order are another one. The options are the rows of def/engine/variant.def. */
#ifndef ENGINES_VARIANT_H
#define ENGINES_VARIANT_H

#include "contract/engine.h"

enum {
    ENGINE_VARIANT = 4096, /* the number of the first variant in engine_at; all other engines are below it */
    ENGINE_VARIANTS = 1024,
    ENGINE_NAME_CAPACITY = 256 /* bytes of a name with its options */
};

/* Returns the variant with that number, from 0 in the order of their first use; null past the last. */
const struct engine *engine_variant_at(unsigned i);

/* Returns the variant of `base` with the options in `name`, which begins with the name of `base`, `length`
 * bytes, and a colon. Returns null with the reason; errno is ENOMEM if memory is refused.
 * Thread-safe. */
const struct engine *engine_vary(const struct engine *base, const char *name, size_t length,
                                 struct error *error);

/* Row i of def/engine/variant.def, null past the last. */
struct engine_option {
    const char *name, *values, *meaning;
    bool (*takes)(const struct engine *engine);
    void *(*copy_options)(const struct engine *engine);
    int (*set)(void *options, const char *value, struct error *error);
};
const struct engine_option *engine_option_at(unsigned i);

/* Returns true if an engine takes at least one option. */
bool engine_takes_options(const struct engine *engine);

/* Returns true if an engine takes the option of that name. */
bool engine_takes_option(const struct engine *engine, const char *name);

#endif
