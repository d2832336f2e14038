/* The panes of the engines without a compiler of their own: the parts of the stitcher, the schedule of the
 * batch interpreter, and the text that the external engine compiles. */
#include "base/memory_file.h"
#include "command/explore/page.h"
#include "emu/batch/batch.h"
#include "engines/external/external.h"
#include "engines/stitch/plan.h"
#include "engines/stitch/stitch.h"
#include "machine/disassemble.h"

#include <stdlib.h>
#include <string.h>

enum { ARENA_BYTES = 8 << 20 };

/* --- The stitcher -------------------------------------------------------------------------------------- */

struct listing {
    struct page *page;
    const uint8_t *code; /* of the part */
    uint32_t offset;
    uint32_t kin; /* the part's own number */
};

static void print_instruction(void *context, size_t offset, size_t length, const char *text)
{
    const struct listing *l = context;
    page_item(l->page);
    fprintf(l->page->out, "[%u,%zu,\"", l->kin, l->offset + offset);
    for (size_t at = 0; at < length; at++)
        fprintf(l->page->out, "%02x", l->code[offset + at]);
    fprintf(l->page->out, "\",%u,\"\"]", page_text(l->page, text, strlen(text)));
}

/* The text of a part; the caller frees it. */
static char *part_text(const struct part *part)
{
    FILE *out = memory_file_open();
    char *text;
    size_t bytes;
    if (!out)
        return NULL;
    plan_print_part(part, out);
    return memory_file_close(out, &text, &bytes) ? NULL : text;
}

/* Prints a part as a line without bytes, and then its instructions. */
static void print_part(struct page *page, const struct part *part, const struct code_span *span, uint32_t kin)
{
    struct listing listing = {page, span->writable + part->offset, part->offset, kin};
    char *text = part_text(part);
    page->failed |= !text;
    page_item(page);
    fputc('[', page->out);
    page_kin_of_line(page, part->file, part->line, kin);
    fprintf(page->out, ",-1,\"\",%u,", text ? page_text(page, text, strlen(text)) : 0);
    page_string(page, stitch_fragment_text(part->fragment).meaning);
    fputc(']', page->out);
    disassemble(span->writable + part->offset, part->fragment->bytes, part->offset, print_instruction,
                &listing);
    free(text);
}

static int print_plan(struct page *page, struct plan *plan, const char *reason, struct code_arena *arena,
                      struct error *error)
{
    struct code_span span;
    char note[256];
    if (plan_check(plan, error) || plan_join(plan, arena, &span, error))
        return -1;
    snprintf(note, sizeof note, "Fragments for %s%s%s: %u parts, %u bytes.",
             reason ? "single operations" : "whole stages",
             reason && *reason ? ", because stage fragments do not cover " : "", reason ? reason : "",
             plan->count, plan->bytes);
    page_begin_pane(page, "code", "code", "Fragments and code", note);
    uint32_t kin = page_own_kin(page, plan->count);
    for (unsigned i = 0; i < plan->count; i++)
        print_part(page, &plan->part[i], &span, kin + i);
    page_end_pane(page);
    code_free(arena, &span);
    return 0;
}

int pane_stitch(struct page *page, const struct engine *engine, struct error *error)
{
    struct code_arena *arena = code_create(ARENA_BYTES, NULL, error);
    struct plan *plan = arena ? plan_take(error) : NULL;
    int result = -1;
    if (plan) {
        const char *reason = stitch_plan(plan, engine, page->unit, page->key);
        result = print_plan(page, plan, reason, arena, error);
        plan_give(plan);
    }
    code_destroy(arena);
    return result;
}

/* --- The batch interpreter ----------------------------------------------------------------------------- */

/* Where a value is: the offset of its row, or of its single group, in the scratch memory. */
static void print_row(FILE *out, uint32_t offset, bool once)
{
    fprintf(out, once ? " [0x%x once]" : " [0x%x]", (unsigned)offset);
}

static void print_step(FILE *out, const struct schedule_step *step, const struct ir_instruction *i)
{
    fprintf(out, "%-10s", ir_op_information[i->op].name);
    if (i->type && i->op != IR_get)
        print_row(out, step->to, step->once);
    else if (i->op == IR_get)
        print_row(out, step->to, false);
    fputs(" <-", out);
    for (int o = 0; o < ir_op_information[i->op].operands + (i->op == IR_get); o++)
        print_row(out, step->operand[o], !step->stride[o]);
    if (i->op == IR_when || i->op == IR_again)
        fprintf(out, " %s %d steps", i->op == IR_when ? "skips" : "repeats",
                step->k < 0 ? -step->k : step->k);
}

static void print_schedule(struct page *page, const struct schedule *schedule, const uint16_t *numbers)
{
    const struct ir *ir = page->recording->ir;
    char note[192];
    snprintf(
        note, sizeof note,
        "%u steps for batches of %u lanes, in %u bytes of scratch memory with %u literals at its begin. A "
        "value is a row of words, or one group of four.",
        schedule->count - 1, schedule->lanes, schedule->scratch_bytes, schedule->literals);
    page_begin_pane(page, "text", "schedule", "Schedule", note);
    for (uint32_t n = 0; n + 1 < schedule->count; n++) {
        FILE *out = memory_file_open();
        char *text = NULL;
        size_t bytes;
        if (out)
            print_step(out, &schedule->step[n], &ir->instruction[numbers[n]]);
        if (!out || memory_file_close(out, &text, &bytes)) {
            page->failed = true;
            break;
        }
        page_item(page);
        fprintf(page->out, "[%u,%u]", numbers[n], page_text(page, text, bytes));
        free(text);
    }
    page_end_pane(page);
}

int pane_batch(struct page *page, const struct engine *engine, struct error *error)
{
    const struct ir *ir = page->recording->ir;
    uint16_t *numbers = malloc(ir->count * sizeof *numbers);
    struct schedule *schedule =
        numbers ? schedule_create(ir, (unsigned)engine->width, batch_fuses(engine), numbers, error) : NULL;
    if (schedule)
        print_schedule(page, schedule, numbers);
    free(numbers);
    schedule_free(schedule);
    return schedule ? 0 : error_set(error, "out of memory for a schedule");
}

/* --- The external engine ------------------------------------------------------------------------------- */

/* The number of the instruction in the comment of a line of the text, or 0. */
static unsigned line_number(const char *line, size_t length)
{
    const char *end = line + length;
    for (const char *at = line; at + 4 < end; at++)
        if (!memcmp(at, "// %", 4))
            return (unsigned)strtoul(at + 4, NULL, 10);
    return 0;
}

static void print_lines(struct page *page, const char *text)
{
    page_begin_pane(page, "text", "text", "Text in C",
                    "The routine as it is compiled; triptych dump --show vector prints the operations.");
    for (const char *at = text; *at;) {
        size_t length = strcspn(at, "\n");
        page_item(page);
        fprintf(page->out, "[%u,%u]", line_number(at, length), page_text(page, at, length));
        at += length + (at[length] == '\n');
    }
    page_end_pane(page);
}

static int print_compiled_code(struct page *page, const struct engine *engine, struct error *error)
{
    struct routine *routine = external_routine(engine, page->recording->ir, page->unit, page->key, error);
    char note[96];
    if (!routine)
        return -1;
    snprintf(note, sizeof note, "%u bytes, from the system's compiler.", routine->code_bytes);
    page_begin_pane(page, "code", "code", "Machine code", note);
    struct listing listing = {page, routine->code, 0, 0};
    disassemble(routine->code, routine->code_bytes, 0, print_instruction, &listing);
    page_end_pane(page);
    engine->free(NULL, routine);
    return 0;
}

int pane_external(struct page *page, const struct engine *engine, struct error *error)
{
    FILE *out = memory_file_open();
    char *text = NULL;
    size_t bytes;
    int result = out ? external_print(external_options(engine)->language, page->recording->ir, page->unit,
                                      page->key, out)
                     : -1;
    if (out && memory_file_close(out, &text, &bytes))
        result = -1;
    if (result)
        error_set(error, "out of memory for the text of a %s routine", unit_name[page->unit]);
    else
        print_lines(page, text);
    free(text);
    return result ? result : print_compiled_code(page, engine, error);
}
