/* The options of engine emulate: def/engine/emulate.def. */
#include "base/words.h"
#include "emu/emulate/emulate.h"
#include "emu/emulate/routine.h"

#include <stdlib.h>

void *emulate_copy_options(const struct engine *engine)
{
    struct emulate_options *copy = malloc(sizeof *copy);
    if (copy)
        *copy = *(const struct emulate_options *)engine->options;
    return copy;
}

static const char *const files[] = {[FILES_TYPED] = "typed", [FILES_ARRAY] = "array"};

int emulate_set_files(void *options, const char *value, struct error *error)
{
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(files), "files", value, &index, error))
        return -1;
    ((struct emulate_options *)options)->files = (enum emulate_files)index;
    return 0;
}

static const char *const decodings[] = {[DECODE_EACH] = "each", [DECODE_ONCE] = "once"};

int emulate_set_decode(void *options, const char *value, struct error *error)
{
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(decodings), "decode", value, &index, error))
        return -1;
    ((struct emulate_options *)options)->decode = (enum emulate_decode)index;
    return 0;
}
