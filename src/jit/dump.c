/* What a build did, stage by stage, for people: the key, the recording, the IR after each pass that changed
 * it, live intervals, and the machine code beside the spec line that each instruction comes from. */
#include "base/code.h"
#include "base/disassemble.h"
#include "jit/build.h"
#include "jit/jit.h"

#include <stdlib.h>
#include <string.h>

struct dump {
    const char *show;
    FILE *out;
    struct builder *builder;
    uint32_t line; /* of the code: next entry of the emitter's line table */
};

/* Whether `name` is one of the comma-separated words of `show`, or `all` is. */
static int shows(const char *show, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = show; *at; at += strcspn(at, ","), at += *at == ',') {
        size_t word = strcspn(at, ",");
        if ((word == length && !memcmp(at, name, length)) || (word == 3 && !memcmp(at, "all", 3)))
            return 1;
    }
    return 0;
}

static int is_stage(const char *word, size_t length)
{
    static const char *const stages[] = {"all", "key", "record", "intervals", "asm"};
    for (size_t i = 0; i < sizeof stages / sizeof stages[0]; i++)
        if (strlen(stages[i]) == length && !memcmp(stages[i], word, length))
            return 1;
    for (unsigned p = 0; p < PASS_COUNT; p++)
        if (strlen(jit_pass_name(p)) == length && !memcmp(jit_pass_name(p), word, length))
            return 1;
    return 0;
}

static int check_words(const char *show, struct error *error)
{
    for (const char *at = show; *at; at += strcspn(at, ","), at += *at == ',') {
        size_t length = strcspn(at, ",");
        if (!is_stage(at, length))
            return error_set(
                error, "nothing is called `%.*s` here: expected key, record, a pass, intervals, asm or all",
                (int)length, at);
    }
    return 0;
}

static void after_pass(void *context, enum pass pass, const struct ir *ir)
{
    struct dump *dump = context;
    if (!shows(dump->show, jit_pass_name(pass)))
        return;
    fprintf(dump->out, "\n== after %s: %s\n", jit_pass_name(pass), jit_pass_description(pass));
    ir_print(ir, dump->out);
}

/* The spec line that the code at `offset` belongs to, printed when it changes. */
static void print_line(void *context, size_t offset, size_t length, const char *text)
{
    struct dump *dump = context;
    const struct emitter *m = &dump->builder->emitter;
    const struct ir_instruction *i = NULL;
    while (dump->line < m->lines && m->line[dump->line].offset <= offset)
        i = &m->ir->instruction[m->line[dump->line++].instruction];
    (void)length;
    fprintf(dump->out, "%6zx  %-58s", offset, text);
    if (i && i->line)
        fprintf(dump->out, " ; %%%u %s %s:%u", (unsigned)(i - m->ir->instruction),
                ir_op_information[i->op].name, m->ir->file[i->file], i->line);
    fputc('\n', dump->out);
}

static void dump_code(struct dump *dump, size_t bytes)
{
    const struct emitter *m = &dump->builder->emitter;
    fprintf(dump->out, "\n== asm: %u bytes of code, %zu of constants, %u spilled\n", m->code_bytes,
            bytes - m->code_bytes, m->allocation->spills);
    disassemble(m->code, m->code_bytes, 0, print_line, dump);
    for (uint32_t i = 0; i < m->literals; i++) {
        float value;
        memcpy(&value, &m->literal_bits[i], sizeof value);
        fprintf(dump->out, "%6x  constant 0x%08x (%.9g) in %u lanes%s\n",
                (unsigned)m->labels[m->literal_label[i]], (unsigned)m->literal_bits[i], (double)value,
                m->width, m->literal_lanes[i] ? "" : ", broadcast");
    }
}

static int dump_stages(struct dump *dump, const struct build_options *options, enum unit unit,
                       const union key *key, struct error *error)
{
    struct builder *b = dump->builder;
    char text[KEY_TEXT_CAPACITY];
    if (shows(dump->show, "key"))
        fprintf(dump->out, "== key of the %s routine\n%s\n", unit_name[unit], key_print(unit, key, text));
    if (shows(dump->show, "record")) {
        ir_record(&b->ir, unit, key);
        fprintf(dump->out, "\n== record: the spec's operations for this key\n");
        ir_print(&b->ir, dump->out);
    }
    size_t bytes = build_code(b, options, unit, key, after_pass, dump, error);
    if (!bytes)
        return -1;
    if (shows(dump->show, "intervals")) {
        fprintf(dump->out, "\n== intervals: from definition to last use; = in a register, . in memory\n");
        allocate_print(&b->ir, &b->allocation, dump->out);
    }
    if (shows(dump->show, "asm"))
        dump_code(dump, bytes);
    return 0;
}

int jit_dump(const struct engine *engine, enum unit unit, const union key *key, const char *show, FILE *out,
             struct error *error)
{
    const struct build_options *options = engine_options(engine, unit);
    if (!options)
        return error_set(error, "engine %s is none of the specializer's", engine->name);
    if (check_words(show, error))
        return -1;
    struct builder *b = builder_take(error);
    if (!b)
        return -1;
    struct dump dump = {.show = show, .out = out, .builder = b};
    int result = dump_stages(&dump, options, unit, key, error);
    builder_give(b);
    return result;
}
