/* Programs of the IR as lines, and the difference between two of them.
 *
 * An instruction is the same in both programs if it has the same origin, and is the n-th with that origin
 * in both. It is altered if it does something else, or if
 * an operand is another instruction; new numbers change nothing. */
#include "command/explore/page.h"

#include "base/memory_file.h"

#include <stdlib.h>
#include <string.h>

enum { NONE = UINT32_MAX };

/* --- Versions ------------------------------------------------------------------------------------------ */

static char *print_instructions(const struct version *version, const struct ir *ir)
{
    FILE *out = memory_file_open();
    char *text;
    size_t bytes;
    if (!out)
        return NULL;
    for (uint32_t n = 0; n < version->count; n++) {
        ir_print_instruction(ir, version->number[n], out);
        fputc('\n', out);
    }
    return memory_file_close(out, &text, &bytes) ? NULL : text;
}

static int note_texts(struct version *version, struct page *page, const struct ir *ir)
{
    char *text = print_instructions(version, ir), *at = text;
    for (uint32_t n = 0; text && n < version->count; n++) {
        size_t length = strcspn(at, "\n");
        version->text[n] = page_text(page, at, length);
        at += length + 1;
    }
    free(text);
    return text && !page->failed ? 0 : -1;
}

int version_take(struct version *version, struct page *page, const struct ir *ir)
{
    *version = (struct version){.instruction = malloc(ir->count * sizeof *version->instruction),
                                .number = malloc(ir->count * sizeof *version->number),
                                .text = malloc(ir->count * sizeof *version->text)};
    if (!version->instruction || !version->number || !version->text)
        return -1;
    for (uint32_t number = 1; number < ir->count; number++) {
        if (ir->instruction[number].op == IR_nop)
            continue;
        version->instruction[version->count] = ir->instruction[number];
        version->number[version->count++] = number;
    }
    return note_texts(version, page, ir);
}

void version_free(struct version *version)
{
    free(version->instruction);
    free(version->number);
    free(version->text);
    *version = (struct version){0};
}

/* --- Comparison ---------------------------------------------------------------------------------------- */

/* Indices are those of the versions. Arrays by number have IR_CAPACITY entries. */
struct comparison {
    const struct version *before, *after;
    uint32_t *kept_as;     /* by index before: the index after, or NONE */
    uint32_t *was;         /* by index after: the index before, or NONE */
    uint32_t *replaced_by; /* by index before, of removed ones: a number after that is used instead, or 0 */
    uint32_t *index;       /* by number before */
    uint32_t *chain;       /* by index before: the next one with the same origin, or NONE */
    uint32_t *first;       /* by origin: the first index before that is not matched yet, or NONE */
};

static int comparison_open(struct comparison *c, const struct version *before, const struct version *after)
{
    uint32_t *memory = malloc((3u * before->count + after->count + 2u * IR_CAPACITY) * sizeof *memory);
    *c = (struct comparison){.before = before, .after = after, .kept_as = memory};
    if (!memory)
        return -1;
    c->replaced_by = c->kept_as + before->count;
    c->chain = c->replaced_by + before->count;
    c->was = c->chain + before->count;
    c->index = c->was + after->count;
    c->first = c->index + IR_CAPACITY;
    return 0;
}

static void match(struct comparison *c)
{
    for (uint32_t number = 0; number < IR_CAPACITY; number++)
        c->index[number] = c->first[number] = NONE;
    for (uint32_t n = c->before->count; n-- > 0;) {
        uint32_t *first = &c->first[c->before->instruction[n].origin];
        c->kept_as[n] = NONE;
        c->replaced_by[n] = 0;
        c->chain[n] = *first;
        *first = n;
        c->index[c->before->number[n]] = n;
    }
    for (uint32_t n = 0; n < c->after->count; n++) {
        uint32_t *first = &c->first[c->after->instruction[n].origin];
        c->was[n] = *first;
        if (*first == NONE)
            continue;
        c->kept_as[*first] = n;
        *first = c->chain[*first];
    }
}

/* Returns true if the operand is the same instruction. If another one replaces a removed one, notes it. */
static bool same_operand(struct comparison *c, unsigned before, unsigned after)
{
    if (!before || !after)
        return before == after;
    uint32_t index = c->index[before], kept = index == NONE ? NONE : c->kept_as[index];
    if (index != NONE && kept == NONE)
        c->replaced_by[index] = after;
    return kept != NONE && c->after->number[kept] == after;
}

static bool is_same(struct comparison *c, uint32_t before, uint32_t after)
{
    const struct ir_instruction *x = &c->before->instruction[before], *y = &c->after->instruction[after];
    bool same = x->op == y->op && x->type == y->type && x->base == y->base && x->scale == y->scale &&
                x->k == y->k && x->field == y->field;
    for (int o = 0; o < 3; o++)
        same &= same_operand(c, x->operand[o], y->operand[o]);
    return same;
}

/* --- Printing ------------------------------------------------------------------------------------------ */

enum mark { MARK_SAME, MARK_ADDED, MARK_ALTERED, MARK_REMOVED };

static void print_line(struct page *page, enum mark mark, const struct version *version, uint32_t n,
                       const char *more, uint32_t value)
{
    page_item(page);
    fprintf(page->out, "[%d,%u,%u,%u", (int)mark, version->number[n], version->text[n],
            version->instruction[n].origin);
    if (more)
        fprintf(page->out, ",%u", value);
    fputc(']', page->out);
}

/* A run of lines that are equal to lines of the version before, by their index and number. */
struct run {
    uint32_t first, count;
};

static void end_run(struct page *page, struct run *run)
{
    if (!run->count)
        return;
    page_item(page);
    fprintf(page->out, "[%u,%u]", run->first, run->count);
    run->count = 0;
}

static void print_removed(struct page *page, struct comparison *c, uint32_t from, uint32_t to,
                          struct run *run, struct change *change)
{
    for (uint32_t n = from; n < to; n++) {
        if (c->kept_as[n] != NONE)
            continue;
        end_run(page, run);
        print_line(page, MARK_REMOVED, c->before, n, "", c->replaced_by[n]);
        change->removed++;
    }
}

static void print_kept(struct page *page, struct comparison *c, uint32_t n, struct run *run,
                       struct change *change)
{
    uint32_t was = c->was[n];
    bool same = is_same(c, was, n);
    if (same && c->before->number[was] == c->after->number[n] && c->before->text[was] == c->after->text[n]) {
        if (run->count && run->first + run->count != was)
            end_run(page, run);
        run->first = run->count ? run->first : was;
        run->count++;
        return;
    }
    end_run(page, run);
    if (same)
        print_line(page, MARK_SAME, c->after, n, NULL, 0);
    else
        print_line(page, MARK_ALTERED, c->after, n, "", c->before->text[was]);
    change->altered += !same;
}

static void print_difference(struct page *page, struct comparison *c, struct change *change)
{
    struct run run = {0, 0};
    uint32_t next = 0; /* of the version before */
    for (uint32_t n = 0; n < c->after->count; n++)
        if (c->was[n] != NONE)
            is_same(c, c->was[n], n); /* notes what replaces removed instructions */
    for (uint32_t n = 0; n < c->after->count; n++) {
        if (c->was[n] == NONE) {
            end_run(page, &run);
            print_line(page, MARK_ADDED, c->after, n, NULL, 0);
            change->added++;
            continue;
        }
        print_removed(page, c, next, c->was[n], &run, change);
        next = next > c->was[n] ? next : c->was[n] + 1;
        print_kept(page, c, n, &run, change);
    }
    print_removed(page, c, next, c->before->count, &run, change);
    end_run(page, &run);
}

int version_print(struct page *page, const struct version *before, const struct version *after,
                  struct change *change)
{
    struct comparison c;
    *change = (struct change){0};
    if (!before) {
        for (uint32_t n = 0; n < after->count; n++)
            print_line(page, MARK_SAME, after, n, NULL, 0);
        return 0;
    }
    if (comparison_open(&c, before, after))
        return -1;
    match(&c);
    print_difference(page, &c, change);
    free(c.kept_as);
    return 0;
}
