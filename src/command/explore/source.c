/* The sources that all engines share: the key, the specification and the shader, and the place of each
 * recorded instruction in them. */
#include "command/explore/embed.h"
#include "command/explore/page.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

/* --- The key -------------------------------------------------------------------------------------------
 *
 * The instructions that exist because of a field are those that a recording for the key with the field 0 does
 * not have. Two instructions are equal if they do the same at the same place. The operands are not compared,
 * nor are offsets in memory, because these depend on the layout of records. */

struct labelled {
    uint64_t label;
    uint32_t number;
};

static int order_labels(const void *a, const void *b)
{
    const struct labelled *x = a, *y = b;
    if (x->label != y->label)
        return x->label < y->label ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

/* The label of each place: a hash of its lines and those of its callers. */
static uint64_t *label_places(const struct explore_recording *r)
{
    uint64_t *label = calloc(r->place_count, sizeof *label);
    for (uint32_t p = 1; label && p < r->place_count; p++) {
        const struct explore_place *place = &r->places[p];
        uint64_t caller = place->caller == EXPLORE_NO_PLACE ? 0 : label[place->caller];
        label[p] = XXH3_64bits_withSeed(place->file, strlen(place->file), caller * 31 + place->line);
    }
    return label;
}

static uint64_t label_instruction(const struct explore_recording *r, const uint64_t *place, uint32_t number)
{
    const struct ir_instruction *i = &r->ir->instruction[number];
    bool memory = ir_properties(i) & (IR_READS | IR_WRITES);
    const uint64_t words[] = {r->place[number] == EXPLORE_NO_PLACE ? 0 : place[r->place[number]],
                              (uint64_t)i->op << 16 | (uint64_t)i->type << 8 | i->base,
                              memory ? 0 : (uint32_t)i->k, ir_step_of(r->ir, number)};
    return XXH3_64bits(words, sizeof words);
}

/* The labels of a recording's instructions, sorted; null if memory is refused. */
static struct labelled *label_recording(const struct explore_recording *r)
{
    uint64_t *place = label_places(r);
    struct labelled *labelled = malloc(r->ir->count * sizeof *labelled);
    if (!place || !labelled) {
        free(place);
        free(labelled);
        return NULL;
    }
    for (uint32_t n = 0; n < r->ir->count; n++)
        labelled[n] = (struct labelled){n ? label_instruction(r, place, n) : 0, n};
    free(place);
    qsort(labelled, r->ir->count, sizeof *labelled, order_labels);
    return labelled;
}

static int order_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Prints the numbers of `all` whose labels are not in `other`, as an even list of first and last ones. */
static void print_missing(struct page *page, const struct labelled *all, uint32_t count,
                          const struct labelled *other, uint32_t other_count)
{
    uint32_t missing = 0, *number = malloc(count * sizeof *number);
    if (!number) {
        page->failed = true;
        return;
    }
    for (uint32_t n = 0, m = 0; n < count; n++) {
        while (m < other_count && other[m].label < all[n].label)
            m++;
        if (m < other_count && other[m].label == all[n].label)
            m++;
        else if (all[n].number)
            number[missing++] = all[n].number;
    }
    qsort(number, missing, sizeof *number, order_numbers);
    for (uint32_t n = 0; n < missing; n++) {
        if (!n || number[n] != number[n - 1] + 1)
            fprintf(page->out, "%s%u,", n ? "," : "", number[n]);
        if (n + 1 == missing || number[n + 1] != number[n] + 1)
            fprintf(page->out, "%u", number[n]);
    }
    free(number);
}

/* Prints the instructions that exist because of the field; none if the other recording is too long. */
static void print_caused(struct page *page, const struct key_field *field, const struct labelled *all)
{
    union key without = *page->key;
    struct explore_recording other;
    struct labelled *labelled = NULL;
    struct error ignored = {""};
    memset((uint8_t *)&without + field->offset, 0, field->count);
    bool recorded = !explore_record(&other, page->unit, &without, &ignored);
    if (recorded)
        labelled = label_recording(&other);
    if (labelled)
        print_missing(page, all, page->recording->ir->count, labelled, other.ir->count);
    page->failed |= !labelled && (recorded || !other.ir || !other.ir->overflow);
    free(labelled);
    explore_record_free(&other);
}

static void print_value(struct page *page, const uint8_t *value, unsigned count)
{
    while (count > 1 && !value[count - 1])
        count--;
    fputc('"', page->out);
    for (unsigned i = 0; i < count; i++)
        fprintf(page->out, "%s%u", i ? "," : "", value[i]);
    fputc('"', page->out);
}

static void print_key(struct page *page, const struct labelled *all)
{
    size_t count;
    const struct key_field *fields = key_fields(page->unit, &count);
    page_begin_pane(
        page, "key", "key", "Key",
        "The fields that are not zero. The operations of a field are those that the recording would "
        "not have if it were zero.");
    for (size_t f = 0; f < count; f++) {
        const uint8_t *value = (const uint8_t *)page->key + fields[f].offset;
        unsigned at = key_next(value, 0, fields[f].count);
        if (at == fields[f].count)
            continue;
        page_item(page);
        fprintf(page->out, "[\"%s\",", fields[f].name);
        print_value(page, value, fields[f].count);
        fputc(',', page->out);
        page_string(page, fields[f].meaning);
        fputs(",[", page->out);
        print_caused(page, fields + f, all);
        fputs("]]", page->out);
    }
    page_end_pane(page);
}

/* --- The specification --------------------------------------------------------------------------------- */

/* Prints the files that have places, and notes the number of each place's file. */
static int print_files(struct page *page, uint32_t *file)
{
    const struct explore_recording *r = page->recording;
    uint32_t files = 0;
    fputs(",\n\"files\":[", page->out);
    for (uint32_t p = 1; p < r->place_count; p++) {
        uint32_t same = 1;
        while (same < p && strcmp(r->places[same].file, r->places[p].file))
            same++;
        file[p] = same < p ? file[same] : files++;
        if (same < p)
            continue;
        const char *text = embed_spec_text(r->places[p].file);
        fprintf(page->out, "%s{\"path\":", file[p] ? ",\n" : "");
        page_string(page, r->places[p].file);
        page_member(page, "text", text ? text : "");
        fputc('}', page->out);
    }
    fputc(']', page->out);
    return 0;
}

/* Place 0 is none. */
static void print_places(struct page *page, const uint32_t *file)
{
    const struct explore_recording *r = page->recording;
    fputs(",\n\"places\":[[0,0,0,0]", page->out);
    for (uint32_t p = 1; p < r->place_count; p++) {
        const struct explore_place *place = &r->places[p];
        fprintf(page->out, ",[%u,%u,%u,%u]", file[p], place->line,
                page_text(page, place->function, strlen(place->function)),
                place->caller == EXPLORE_NO_PLACE ? 0 : place->caller);
    }
    fputs("],\n\"place\":[0", page->out);
    for (uint32_t n = 1; n < r->ir->count; n++)
        fprintf(page->out, ",%u", r->place[n] == EXPLORE_NO_PLACE ? 0 : r->place[n]);
    fputc(']', page->out);
}

static int print_spec(struct page *page, struct error *error)
{
    uint32_t *file = calloc(page->recording->place_count, sizeof *file);
    if (!file)
        return error_set(error, "out of memory for the places of a recording");
    print_files(page, file);
    print_places(page, file);
    free(file);
    return 0;
}

/* --- The shader ---------------------------------------------------------------------------------------- */

static void print_steps(struct page *page, const struct program_text *text)
{
    const struct ir *ir = page->recording->ir;
    fputs("],\"line\":[0", page->out);
    for (uint32_t n = 1; n < ir->count; n++) {
        uint32_t step = ir_step_of(ir, n);
        fprintf(page->out, ",%u", step < text->steps ? text->line_of_step[step] : 0);
    }
    fputs("]}", page->out);
}

static void print_shader(struct page *page, const struct program_text *text)
{
    const struct program *program = key_shader(page->unit, page->key);
    fputs(",\n\"shader\":{\"name\":", page->out);
    page_string(page, program->name);
    fprintf(page->out, ",\"slots\":%u,\"lines\":[", program->slots);
    for (uint32_t line = 0; line < text->lines; line++) {
        fputs(line ? "," : "", page->out);
        page_string(page, text->line[line]);
    }
    print_steps(page, text);
}

static int print_recording(struct page *page)
{
    struct version version;
    struct change change;
    int result = version_take(&version, page, page->recording->ir);
    page_begin_pane(page, "ir", "record", "Recording",
                    "The operations of the specification for this key, as they are recorded.");
    if (!result)
        result = version_print(page, NULL, &version, &change);
    page_end_pane(page);
    version_free(&version);
    return result;
}

int page_sources(struct page *page, const struct program_text *shader, struct error *error)
{
    struct labelled *all = label_recording(page->recording);
    if (!all)
        return error_set(error, "out of memory for the labels of a recording");
    int result = print_spec(page, error);
    if (shader)
        print_shader(page, shader);
    fputs(",\n\"panes\":[", page->out);
    if (!result) {
        print_key(page, all);
        result = print_recording(page);
    }
    free(all);
    return result ? error_set(error, "out of memory for a page") : 0;
}
