/* The options of the external engine: def/engine/external.def. */
#include "base/words.h"
#include "engines/external/external.h"

#include <stdlib.h>

static const char *const languages[] = {[EXTERNAL_VECTORS] = "vectors",
                                        [EXTERNAL_PLAIN] = "plain",
                                        [EXTERNAL_PORTABLE] = "portable",
                                        [EXTERNAL_PIXELS] = "pixels"};

void *external_copy_options(const struct engine *engine)
{
    struct external_options *copy = malloc(sizeof *copy);
    if (copy)
        *copy = *external_options(engine);
    return copy;
}

int external_set_c(void *options, const char *value, struct error *error)
{
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(languages), "c", value, &index, error))
        return -1;
    ((struct external_options *)options)->language = (enum external_language)index;
    return 0;
}

int external_set_optimize(void *options, const char *value, struct error *error)
{
    if (value[0] < '0' || value[0] > '3' || value[1])
        return error_set(error, "optimize is \"%.40s\", expected a number from 0 to 3", value);
    ((struct external_options *)options)->optimize = value[0];
    return 0;
}
