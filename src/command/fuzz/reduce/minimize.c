#include "command/fuzz/reduce/reduce.h"

/* The passes that remove most come first. */
static reduce_pass *const passes[] = {reduce_statements, reduce_inner,    reduce_inline,  reduce_names,
                                      reduce_lines,      reduce_flow,     reduce_clauses, reduce_draws,
                                      reduce_vertices,   reduce_items,    reduce_columns, reduce_textures,
                                      reduce_words,      reduce_operands, reduce_numbers};

/* Without comments and with one space between words the text may already be another to the test. */
static bool begin(struct reduction *reduction, const char *text, size_t bytes)
{
    reduction->tries++;
    if (!reduction->still_fails(reduction->user, text, bytes))
        return false;
    text_add_bytes(&reduction->kept, text, bytes);
    reduction_put(reduction, 0, reduction->word->text, reduction->word->length);
    reduction_try(reduction);
    return true;
}

static unsigned go_round(struct reduction *reduction)
{
    unsigned rounds = 0, before;
    do {
        before = reduction->accepted;
        for (unsigned i = 0; i < sizeof passes / sizeof *passes && !reduction_exhausted(reduction); i++) {
            passes[i](reduction);
            reduction_sweep(reduction);
        }
        rounds++;
    } while (reduction->accepted != before && !reduction_exhausted(reduction));
    return rounds;
}

int minimize(const char *text, size_t bytes, minimize_test *still_fails, void *user, unsigned tries,
             struct text *smallest, struct minimized *minimized, struct error *error)
{
    struct reduction reduction;
    int result =
        reduction_start(&reduction, text, bytes, still_fails, user, tries ? tries : MINIMIZE_TRIES, error);
    if (!result && (!reduction.count || !begin(&reduction, text, bytes)))
        result = error_set(error, "the stream to reduce does not fail");
    if (!result) {
        unsigned rounds = go_round(&reduction);
        if (minimized)
            *minimized = (struct minimized){reduction.tries, rounds, !reduction_exhausted(&reduction)};
        *smallest = reduction.kept;
        reduction.kept = (struct text){0};
    }
    if (!result && (reduction.failed || smallest->failed)) {
        text_free(smallest);
        result = error_set(error, "out of memory while reducing a stream");
    }
    reduction_free(&reduction);
    return result;
}
