/* Passes that remove: statements, sequences, resources with their uses, lines of blocks, flow control,
 * clauses. */
#include "command/fuzz/reduce/reduce.h"

#include <string.h>

static bool is(const struct reduction *r, const struct statement *statement, const char *text)
{
    return reduction_word_is(r->word + statement->first, text);
}

/* The end of the sequence that the statement begins: the word after its `end`. */
static uint32_t sequence_end(const struct reduction *r, const struct statement *statement)
{
    return statement->close ? statement->close + 1 : r->count;
}

/* Calls, blocks and sequences as wholes. The first line is the format's name. */
void reduce_statements(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *statement = r->statement + s;
        if (statement->depth || is(r, statement, "end"))
            continue;
        reduction_add_range(r, statement->first,
                            is(r, statement, "sequence") ? sequence_end(r, statement) : statement->end);
    }
    reduction_remove_ranges(r);
}

void reduce_inner(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++)
        if (r->statement[s].depth)
            reduction_add_range(r, r->statement[s].first, r->statement[s].end);
    reduction_remove_ranges(r);
}

static bool mentions(const struct reduction *r, const struct statement *statement, const struct word *name)
{
    uint32_t end = statement->open ? statement->open : statement->end;
    for (uint32_t i = statement->first + 1; i < end; i++)
        if (!r->word[i].gone && r->word[i].length == name->length &&
            !memcmp(r->word[i].text, name->text, name->length))
            return true;
    return false;
}

/* A sequence's calls in its position, without its name and the calls that play it. */
void reduce_inline(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *sequence = r->statement + s;
        if (!is(r, sequence, "sequence") || r->word[sequence->first].gone || !sequence->close)
            continue;
        reduction_drop(r, sequence->first, sequence->end);
        reduction_drop(r, sequence->close, sequence->close + 1);
        for (uint32_t p = 1; p < r->statements; p++)
            if (is(r, r->statement + p, "play") &&
                mentions(r, r->statement + p, r->word + sequence->first + 1))
                reduction_drop(r, r->statement[p].first, r->statement[p].end);
        reduction_try(r);
    }
}

static bool defines_name(const struct reduction *r, const struct statement *statement)
{
    static const char *const kinds[] = {"texture", "vertices", "indices", "buffer",
                                        "shader",  "mesh",     "query",   "image"};
    if (statement->end - statement->first < 2 || statement->depth)
        return false;
    for (unsigned i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (is(r, statement, kinds[i]))
            return true;
    return false;
}

/* A resource and every statement that names it. */
void reduce_names(struct reduction *r)
{
    for (uint32_t s = r->statements; s-- > 1;) {
        if (!defines_name(r, r->statement + s) || r->word[r->statement[s].first].gone)
            continue;
        const struct word name = r->word[r->statement[s].first + 1];
        for (uint32_t t = 1; t < r->statements; t++)
            if (mentions(r, r->statement + t, &name))
                reduction_drop(r, r->statement[t].first, r->statement[t].end);
        reduction_try(r);
    }
}

/* Lines of blocks: instructions, vertices, rows. */
void reduce_lines(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *statement = r->statement + s;
        if (!statement->open)
            continue;
        uint32_t end = statement->close ? statement->close : statement->end;
        for (uint32_t i = statement->open + 1, next; i < end; i = next) {
            for (next = i + 1; next < end && r->word[next].line == r->word[i].line; next++)
                ;
            reduction_add_range(r, i, next);
        }
        reduction_remove_ranges(r);
    }
}

/* --- Flow control in shaders ---------------------------------------------------------------------------- */

static bool begins_with(const struct word *word, const char *text)
{
    return word->length >= strlen(text) && !memcmp(word->text, text, strlen(text));
}

static int flow_step(const struct word *word)
{
    if (begins_with(word, "if") || reduction_word_is(word, "loop") || reduction_word_is(word, "rep"))
        return 1;
    return reduction_word_is(word, "endif") || reduction_word_is(word, "endloop") ||
                   reduction_word_is(word, "endrep")
               ? -1
               : 0;
}

static uint32_t line_end(const struct reduction *r, uint32_t index)
{
    uint32_t end = index;
    while (end < r->count && r->word[end].line == r->word[index].line)
        end++;
    return end;
}

static bool begins_line(const struct reduction *r, uint32_t index)
{
    return !r->word[index].gone && r->word[index].in_shader && r->word[index - 1].line != r->word[index].line;
}

/* The ends of what begins at `first`: its `else` (0: none) and its end; false if there is none. */
static bool flow_ends(const struct reduction *r, uint32_t first, uint32_t *otherwise, uint32_t *last)
{
    int depth = 1;
    *otherwise = 0;
    for (uint32_t i = first + 1; i < r->count && r->word[i].in_shader; i++) {
        if (!begins_line(r, i))
            continue;
        depth += flow_step(r->word + i);
        if (depth == 1 && reduction_word_is(r->word + i, "else"))
            *otherwise = i;
        *last = i;
        if (!depth)
            return true;
    }
    return false;
}

/* A region whole, then its lines without the control, then without one of its two branches. */
void reduce_flow(struct reduction *r)
{
    for (uint32_t i = 1; i < r->count; i++) {
        uint32_t otherwise, last;
        if (!begins_line(r, i) || flow_step(r->word + i) <= 0 || !flow_ends(r, i, &otherwise, &last))
            continue;
        reduction_drop(r, i, line_end(r, last));
        if (reduction_try(r))
            continue;
        if (otherwise) {
            reduction_drop(r, otherwise, last);
            if (reduction_try(r))
                otherwise = 0;
        }
        for (int second = 0; second < (otherwise ? 2 : 1); second++) {
            uint32_t body = line_end(r, i), middle = otherwise ? otherwise : last;
            reduction_drop(r, i, second ? line_end(r, middle) : body);
            reduction_drop(r, second ? last : middle, line_end(r, last));
            if (reduction_try(r))
                break;
        }
    }
}

/* --- Clauses -------------------------------------------------------------------------------------------- */

/* Parts of a statement's line: from a word that is a name to the next one, then single words. */
void reduce_clauses(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *statement = r->statement + s;
        uint32_t end = statement->open ? statement->open : line_end(r, statement->first);
        for (uint32_t i = statement->first + 1, next; i < end; i = next) {
            for (next = i + 1; next < end && !reduction_word_is_name(r->word + next); next++)
                ;
            reduction_add_range(r, i, next);
        }
        reduction_remove_ranges(r);
        for (uint32_t i = statement->first + 1; i < end; i++)
            reduction_add_range(r, i, i + 1);
        reduction_remove_ranges(r);
    }
}
