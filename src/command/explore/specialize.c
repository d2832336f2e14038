/* The panes of the specializer: its passes, live intervals, and machine code. */
#include "base/bits.h"
#include "command/explore/page.h"
#include "engines/specialize/build.h"
#include "engines/specialize/sixteen.h"
#include "engines/specialize/specialize.h"
#include "machine/disassemble.h"

#include <stdlib.h>
#include <string.h>

enum { RUNS_MAXIMUM = 1024 };

/* A run of a pass, for the table of all runs. */
struct pass_run {
    unsigned pass, round; /* from 1; 0: the pass runs once, after the rounds */
    unsigned left;        /* the number of instructions that are left */
    bool changed;
    struct change change;
};

struct building {
    struct page *page;
    struct builder *builder;
    struct version before;
    struct pass_run run[RUNS_MAXIMUM];
    unsigned runs;
    uint32_t line; /* the next entry of the emitter's line table */
    bool failed;
};

/* --- Passes -------------------------------------------------------------------------------------------- */

enum group { THESIS, FULL, OPTIONAL, ONCE, LAST };

/* Returns true if the pass is not repeated. */
static bool runs_once(unsigned pass)
{
    static const uint8_t groups[PASS_COUNT] = {
#define PASS(name, group, wakes, meaning) group,
#include "def/engine/pass.def"
#undef PASS
    };
    return groups[pass] >= ONCE;
}

/* The number of the round, 0 for a pass that is not repeated. */
static unsigned next_round(const struct building *b, unsigned pass)
{
    if (runs_once(pass))
        return 0;
    if (!b->runs)
        return 1;
    const struct pass_run *last = &b->run[b->runs - 1];
    return last->round + (pass <= last->pass);
}

static uint32_t count_instructions(const struct ir *ir)
{
    uint32_t count = 0;
    for (uint32_t n = 1; n < ir->count; n++)
        count += ir->instruction[n].op != IR_nop;
    return count;
}

/* Prints a pane with the difference from the program before, which the new one becomes. */
static void print_version(struct building *b, const char *name, const char *title, const char *note,
                          const struct ir *ir, struct change *change)
{
    struct version after;
    if (version_take(&after, b->page, ir))
        b->failed = true;
    page_begin_pane(b->page, "ir", name, title, note);
    if (!b->failed && version_print(b->page, &b->before, &after, change))
        b->failed = true;
    page_end_pane(b->page);
    version_free(&b->before);
    b->before = after;
}

static void after_pass(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    struct building *b = context;
    if (b->failed || b->runs == RUNS_MAXIMUM)
        return;
    struct pass_run *run = &b->run[b->runs];
    *run = (struct pass_run){pass, next_round(b, pass), count_instructions(ir), changed, {0}};
    b->runs++;
    if (!changed)
        return;
    char name[32], title[64], note[128];
    snprintf(name, sizeof name, "run-%u", b->runs);
    int length = snprintf(title, sizeof title, "%u. %s", b->runs, pass_name(pass));
    if (run->round)
        snprintf(title + length, sizeof title - (size_t)length, ", round %u", run->round);
    snprintf(note, sizeof note, "%s.", pass_description(pass));
    print_version(b, name, title, note, ir, &run->change);
}

static void print_runs(const struct building *b)
{
    struct page *page = b->page;
    const struct pass_shapes *shapes = &b->builder->pass.shapes;
    char note[200] = "All runs of passes, in order.";
    int length = (int)strlen(note);
    if (shapes->two)
        length +=
            snprintf(note + length, sizeof note - (size_t)length,
                     " A block is estimated to take %u cycles with one register for each value, %u with "
                     "two%s",
                     shapes->one, shapes->two, shapes->four ? "" : ".");
    if (shapes->two && shapes->four)
        snprintf(note + length, sizeof note - (size_t)length, ", %u with four for two blocks.", shapes->four);
    page_begin_pane(page, "runs", "passes", "Passes", note);
    for (unsigned r = 0; r < b->runs; r++) {
        const struct pass_run *run = &b->run[r];
        page_item(page);
        fprintf(page->out, "[%u,\"%s\",%d,%u,%u,%u,%u,", run->round, pass_name(run->pass), run->changed,
                run->change.removed, run->change.added, run->change.altered, run->left);
        page_string(page, pass_description(run->pass));
        fputc(']', page->out);
    }
    page_end_pane(page);
}

/* --- Intervals ----------------------------------------------------------------------------------------- */

static void print_interval(struct page *page, const struct ir *ir, const struct allocation *a,
                           uint32_t number)
{
    const struct ir_instruction *i = &ir->instruction[number];
    page_item(page);
    fprintf(page->out, "[%u,%u,%d,%u,%d,\"%s\",%u,\"%s\"]", number, a->last[number],
            a->split[number] == NEVER ? -1 : (int)a->split[number], a->reg[number],
            a->slot[number] == NO_SLOT ? -1 : (int)a->slot[number], ir_op_information[i->op].name, i->origin,
            (const char *[]){"", "flt", "itg", "fix", "msk"}[i->type]);
}

static void print_intervals(const struct building *b)
{
    const struct ir *ir = &b->builder->ir;
    const struct allocation *a = &b->builder->allocation;
    struct page *page = b->page;
    char note[160];
    snprintf(
        note, sizeof note,
        "Values in registers, from definition to last use, by position in the program of %u instructions; %u "
        "spilled.",
        ir->count - 1, a->spills);
    page_begin_pane(page, "intervals", "intervals", "Live intervals", note);
    for (uint32_t number = 1; number < ir->count; number++)
        if (a->residence[number] == RESIDENCE_REGISTER && allocate_web(a, number) == number)
            print_interval(page, ir, a, number);
    fprintf(page->out, "],\"positions\":%u,\"loops\":[", ir->count);
    page->begun = false;
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op == IR_loop) {
            page_item(page);
            fprintf(page->out, "[%u,%u]", number, ir_other_end(ir, number));
        }
    page_end_pane(page);
}

/* --- Code ---------------------------------------------------------------------------------------------- */

static void print_instruction(void *context, size_t offset, size_t length, const char *text)
{
    struct building *b = context;
    const struct emitter *m = &b->builder->emitter;
    struct page *page = b->page;
    while (b->line < m->lines && m->line[b->line].offset <= offset)
        b->line++;
    unsigned number = b->line ? m->line[b->line - 1].instruction : 0;
    const struct ir_instruction *i = &m->ir->instruction[number];
    page_item(page);
    fprintf(page->out, "[%u,%zu,\"", number ? i->origin : 0, offset);
    for (size_t at = 0; at < length; at++)
        fprintf(page->out, "%02x", m->code[offset + at]);
    fprintf(page->out, "\",%u,", page_text(page, text, strlen(text)));
    if (number)
        fprintf(page->out, "\"%%%u %s\"]", number, ir_op_information[i->op].name);
    else
        fputs("\"\"]", page->out);
}

static void print_literals(const struct emitter *m, struct page *page)
{
    for (uint32_t n = 0; n < m->literals; n++) {
        char text[96];
        snprintf(text, sizeof text, "constant 0x%08x (%.9g) in %u lanes%s", (unsigned)m->literal_bits[n],
                 (double)bits_to_float(m->literal_bits[n]), m->width,
                 m->literal_lanes[n] ? "" : ", broadcast");
        page_item(page);
        fprintf(page->out, "[0,%d,\"\",%u,\"\"]", (int)m->labels[m->literal_label[n]],
                page_text(page, text, strlen(text)));
    }
}

static void print_code(struct building *b, size_t bytes)
{
    const struct emitter *m = &b->builder->emitter;
    char note[160];
    snprintf(note, sizeof note, "%u lanes, %u bytes of code, %zu of constants, %u values spilled.", m->width,
             m->code_bytes, bytes - m->code_bytes, m->allocation->spills);
    page_begin_pane(b->page, "code", "code", "Machine code", note);
    disassemble(m->code, m->code_bytes, 0, print_instruction, b);
    print_literals(m, b->page);
    page_end_pane(b->page);
}

/* --- All ----------------------------------------------------------------------------------------------- */

static int print_phases(struct building *b, const struct engine *engine, struct error *error)
{
    struct page *page = b->page;
    struct build_options options = specialize_options(engine, page->unit);
    struct pass_shapes shapes = {0};
    if (specialize_may_sixteen(&options, page->unit))
        options.shapes = &shapes;
    struct change none;
    if (version_take(&b->before, page, page->recording->ir))
        return error_set(error, "out of memory for a page");
    size_t bytes = specialize_recording(b->builder, page->recording->ir, &options, page->unit, page->key,
                                        after_pass, b, error);
    if (!bytes)
        return -1;
    print_version(b, "final", "Result of the passes",
                  "The program before the allocation of registers, numbered anew.", &b->builder->ir, &none);
    print_runs(b);
    print_intervals(b);
    print_code(b, bytes);
    return b->failed || page->failed ? error_set(error, "out of memory for a page") : 0;
}

int pane_specialize(struct page *page, const struct engine *engine, struct error *error)
{
    struct building *b = calloc(1, sizeof *b);
    if (!b)
        return error_set(error, "out of memory for a page");
    b->page = page;
    b->builder = specialize_take(error);
    int result = b->builder ? print_phases(b, engine, error) : -1;
    if (b->builder)
        specialize_give(b->builder);
    version_free(&b->before);
    free(b);
    return result;
}
