/* The text of a draw stream as words, and candidates for a smaller one.
 *
 * The words stay in one array. A candidate marks some words as gone or replaces their text, and is tried. If
 * it fails like the original it is kept, else it is undone. Indices therefore stay valid during a pass;
 * between passes the marked words are removed. A word contains its line number, and lines are the unit of the
 * text format: a statement is a line, or the lines of a block up to its closing brace. Comments are not
 * words. */
#ifndef COMMAND_FUZZ_REDUCE_REDUCE_H
#define COMMAND_FUZZ_REDUCE_REDUCE_H

#include "command/fuzz/reduce/minimize.h"

#include <stdint.h>

struct word {
    const char *text; /* not terminated: of the original, or of `spelling` */
    uint32_t length;
    uint32_t line;
    bool gone;
    bool in_shader;
};

/* Words first to end - 1. Braces of a block are at `open` and `close`, 0: none. A sequence is the
 * statement of its first line, and `close` is the first word of its `end`. */
struct statement {
    uint32_t first, end, open, close;
    uint32_t depth; /* 1: in a sequence */
};

struct range {
    uint32_t first, end;
};

struct undo {
    uint32_t index;
    struct word word;
};

struct spelling;

struct reduction {
    struct word *word;
    uint32_t count;
    struct statement *statement; /* found anew by reduction_sweep */
    uint32_t statements;
    struct range *range; /* capacity `count`: of the pass that runs */
    uint32_t ranges;
    struct undo *undo; /* of the candidate that is being made */
    uint32_t undos, undo_capacity;
    struct spelling *spelling; /* replacements that were made */
    struct text candidate, kept;
    uint64_t *tried; /* hashes of texts that did not fail, open addressing */
    uint32_t tried_count, tried_capacity;
    minimize_test *still_fails;
    void *user;
    unsigned tries, limit;
    unsigned accepted;
    bool failed; /* no memory */
};

int reduction_start(struct reduction *reduction, const char *text, size_t bytes, minimize_test *still_fails,
                    void *user, unsigned limit, struct error *error);
void reduction_free(struct reduction *reduction);

/* Sweeps out what is gone and finds the statements. */
void reduction_sweep(struct reduction *reduction);

/* Making a candidate: words go, or are replaced by other text. */
void reduction_drop(struct reduction *reduction, uint32_t first, uint32_t end);
void reduction_put(struct reduction *reduction, uint32_t index, const char *text, size_t length);
void reduction_put_number(struct reduction *reduction, uint32_t index, long long number);

/* Tries the candidate: keeps it and returns true if it fails, else undoes it. */
bool reduction_try(struct reduction *reduction);
bool reduction_exhausted(const struct reduction *reduction);

/* Adds a range of words to those of the pass. */
void reduction_add_range(struct reduction *reduction, uint32_t first, uint32_t end);

/* Removes all ranges that it can: in groups of all of them, halves, quarters, down to one; from the last to
 * the first, because later statements depend on earlier ones. */
void reduction_remove_ranges(struct reduction *reduction);

bool reduction_word_is(const struct word *word, const char *text);
bool reduction_word_is_name(const struct word *word); /* begins with a letter or an underscore */
bool reduction_word_integer(const struct word *word, long long *value);

/* The passes. */
typedef void reduce_pass(struct reduction *reduction);
reduce_pass reduce_statements, reduce_inner, reduce_inline, reduce_names, reduce_lines, reduce_flow,
    reduce_clauses, reduce_draws, reduce_vertices, reduce_items, reduce_columns, reduce_textures,
    reduce_words, reduce_operands, reduce_numbers;

#endif
