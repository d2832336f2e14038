/* The options of engine emulate: def/engine/emulate.def. */
#include "base/words.h"
#include "emu/emulate/emulate.h"
#include "emu/emulate/routine.h"

#include <stdlib.h>
#include <string.h>

void *emulate_copy_options(const struct engine *engine)
{
    struct emulate_options *copy = malloc(sizeof *copy);
    if (copy)
        *copy = *(const struct emulate_options *)engine->options;
    return copy;
}

/* Writes the number of the value among the words. */
static int find_value(const char *option, const char *value, struct words words, unsigned *index,
                      struct error *error)
{
    if (words_find(words, value, strlen(value), index))
        return 0;
    char choices[ERROR_CAPACITY / 2];
    words_join(words, choices, sizeof choices);
    error_set(error, "%s is \"%.40s\", expected one of: %s", option, value, choices);
    return words_suggest_in(words, value, strlen(value), error);
}

static const char *const files[] = {[FILES_TYPED] = "typed", [FILES_ARRAY] = "array"};

int emulate_set_files(void *options, const char *value, struct error *error)
{
    unsigned index;
    if (find_value("files", value, WORDS_OF_ROWS(files), &index, error))
        return -1;
    ((struct emulate_options *)options)->files = (enum emulate_files)index;
    return 0;
}

static const char *const decodings[] = {[DECODE_EACH] = "each", [DECODE_ONCE] = "once"};

int emulate_set_decode(void *options, const char *value, struct error *error)
{
    unsigned index;
    if (find_value("decode", value, WORDS_OF_ROWS(decodings), &index, error))
        return -1;
    ((struct emulate_options *)options)->decode = (enum emulate_decode)index;
    return 0;
}
