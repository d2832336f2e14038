/* Prints the steps of building an external routine: its key, its text, its compiled code. */
#include "base/words.h"
#include "machine/disassemble.h"
#include "engines/external/external.h"

#include <string.h>

enum { SHOW_KEY = 1, SHOW_VECTOR = 2, SHOW_TEXT = 4, SHOW_ASM = 8, SHOW_WHOLE = 16 };

static int read_show(const char *show, unsigned *wanted, struct error *error)
{
    static const struct {
        const char *name;
        unsigned what;
    } words[] = {{"key", SHOW_KEY}, {"vector", SHOW_VECTOR}, {"text", SHOW_TEXT},
                 {"asm", SHOW_ASM}, {"whole", SHOW_WHOLE},   {"all", 15}};
    for (*wanted = 0;; show++) {
        size_t length = strcspn(show, ","), i = 0, count = sizeof words / sizeof *words;
        while (i < count && (strlen(words[i].name) != length || strncmp(words[i].name, show, length)))
            i++;
        if (i == count) {
            error_set(error, "--show has \"%.*s\", expected key, vector, text, whole, asm or all",
                      (int)length, show);
            return words_suggest_in(WORDS_OF_ROWS(words), show, length, error);
        }
        *wanted |= words[i].what;
        show += length;
        if (!*show)
            return 0;
    }
}

static void print_line(void *context, size_t offset, size_t length, const char *text)
{
    (void)length;
    fprintf(context, "%6zx  %s\n", offset, text);
}

static int dump_code(const struct engine *engine, const struct ir *ir, enum unit unit, const union key *key,
                     FILE *out, struct error *error)
{
    struct routine *routine = external_routine(engine, ir, unit, key, error);
    if (!routine)
        return -1;
    fprintf(out, "\n== asm: %u bytes\n", routine->code_bytes);
    disassemble(routine->code, routine->code_bytes, 0, print_line, out);
    engine->free(NULL, routine);
    return 0;
}

int external_dump(const struct engine *engine, enum unit unit, const union key *key, const char *show,
                  FILE *out, struct error *error)
{
    char text[KEY_TEXT_CAPACITY];
    unsigned wanted;
    if (read_show(show, &wanted, error))
        return -1;
    struct ir *ir = ir_take(unit, key, error);
    if (!ir)
        return -1;
    int bad = 0;
    if (wanted & SHOW_KEY)
        fprintf(out, "== key of the %s routine\n%s\n", unit_name[unit], key_print(unit, key, text));
    if (wanted & SHOW_VECTOR)
        fprintf(out, "\n== vector: the operations that the text is written in\n");
    if (wanted & (SHOW_VECTOR | SHOW_WHOLE))
        external_print_beginning(external_options(engine)->language, out);
    if (wanted & SHOW_TEXT)
        fprintf(out, "\n== text\n");
    if (wanted & (SHOW_TEXT | SHOW_WHOLE)) {
        bad = external_print(external_options(engine)->language, ir, unit, key, out);
        if (bad)
            error_set(error, "out of memory for the text of a %s routine", unit_name[unit]);
    }
    if (!bad && wanted & SHOW_ASM)
        bad = dump_code(engine, ir, unit, key, out, error);
    ir_give(ir);
    return bad;
}
