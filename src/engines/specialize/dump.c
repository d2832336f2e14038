/* Prints the phases of a build: the key, the recording, the program after each run of a pass, the live
 * intervals, and the machine code with the line of the specification of each instruction. The lines of a
 * shader are repeated before the instructions that they become. */
#include "base/bits.h"
#include "base/words.h"
#include "machine/code.h"
#include "machine/disassemble.h"
#include "engines/specialize/build.h"
#include "engines/specialize/parts.h"
#include "engines/specialize/sixteen.h"
#include "engines/specialize/specialize.h"

#include <stdlib.h>
#include <string.h>

struct dump {
    const char *show;
    FILE *out;
    struct builder *builder;
    const struct program_text *text; /* of the shader, or null */
    uint32_t line;                   /* the next entry of the emitter's line table */
    uint32_t shader_line;            /* the line of the shader that was printed last */
    uint32_t ran;                    /* bit p: pass p has run */
    uint32_t programs;               /* whose passes have begun to run, in a build with calls */
};

/* Returns true if `name` is one of the comma-separated words of `show`. */
static bool names_word(const char *show, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = show; *at; at += strcspn(at, ","), at += *at == ',')
        if (strcspn(at, ",") == length && !memcmp(at, name, length))
            return true;
    return false;
}

/* The same, or `all` is. */
static bool shows(const char *show, const char *name)
{
    return names_word(show, name) || names_word(show, "all");
}

const char *specialize_phase_name(unsigned index)
{
    static const char *const phases[] = {"all", "key", "record", "intervals", "asm", "text", "parts"};
    const unsigned count = sizeof phases / sizeof *phases;
    return index < count ? phases[index] : index - count < PASS_COUNT ? pass_name(index - count) : NULL;
}

static const char *phase_choice(const struct words *words, unsigned index)
{
    (void)words;
    return specialize_phase_name(index);
}

static int check_words(const char *show, struct error *error)
{
    const struct words phases = {.at = phase_choice};
    for (const char *at = show; *at; at += strcspn(at, ","), at += *at == ',') {
        size_t length = strcspn(at, ",");
        unsigned index;
        if (words_find(phases, at, length, &index))
            continue;
        error_set(error,
                  "--show has \"%.*s\", expected key, record, a pass, intervals, asm, text, parts or all; "
                  "or, of external, vector or whole",
                  (int)length, at);
        return words_suggest_in(phases, at, length, error);
    }
    return 0;
}

/* With calls, the passes run on several programs: the routine, each subroutine, then all in one. */
static void print_program(struct dump *dump, const struct ir *ir)
{
    unsigned number = dump->programs++;
    if (!number)
        fputs("\n== program: the routine, with calls\n", dump->out);
    else if (number <= dump->builder->subroutines.count)
        fprintf(dump->out, "\n== program: subroutine %u\n", number - 1);
    else
        fputs("\n== program: the routine and its subroutines\n", dump->out);
    if (shows(dump->show, "record"))
        ir_print(ir, dump->text, dump->out);
}

/* Both estimates of the pass shape, and what follows from them. */
static void print_shapes(const struct pass_shapes *shapes, FILE *out)
{
    unsigned least = 0;
    while (least < 100 && !specialize_prefers_sixteen(shapes, 100, least))
        least++;
    if (!shapes->two) {
        fprintf(out, "one register for each value: %u cycles a block\n", shapes->one);
        return;
    }
    fprintf(out, "one register for each value: %u cycles a block; two: %u", shapes->one, shapes->two);
    if (shapes->four)
        fprintf(out, "; four, for two blocks: %u", shapes->four);
    fputc('\n', out);
    if (specialize_is_worth(shapes))
        fprintf(out, "two where at least %u %% of a call's blocks are covered in both halves\n", least);
    else
        fputs("one, for all calls\n", out);
}

static void after_pass(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    struct dump *dump = context;
    if (pass == PASS_COUNT) {
        print_program(dump, ir);
        return;
    }
    dump->ran |= 1u << pass;
    if (!shows(dump->show, pass_name(pass)))
        return;
    fprintf(dump->out, "\n== after %s: %s\n", pass_name(pass), pass_description(pass));
    if (pass == PASS_shape && dump->builder->pass.shapes.one)
        print_shapes(&dump->builder->pass.shapes, dump->out);
    else if (changed)
        ir_print(ir, dump->text, dump->out);
    else
        fputs("nothing changed\n", dump->out);
}

static void print_absent_passes(const struct dump *dump)
{
    for (unsigned p = 0; p < PASS_COUNT; p++)
        if (!(dump->ran >> p & 1) && shows(dump->show, pass_name(p)))
            fprintf(dump->out, "\n== %s: this engine does not run it\n", pass_name(p));
}

/* Prints an instruction, and the line of the specification if it is not that of the instruction before. */
static void print_line(void *context, size_t offset, size_t length, const char *text)
{
    struct dump *dump = context;
    const struct emitter *m = &dump->builder->emitter;
    const struct ir_instruction *i = NULL;
    while (dump->line < m->lines && m->line[dump->line].offset <= offset)
        i = &m->ir->instruction[m->line[dump->line++].instruction];
    (void)length;
    if (i)
        ir_print_source(m->ir, dump->text, i->origin, &dump->shader_line, dump->out);
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
        float value = bits_to_float(m->literal_bits[i]);
        fprintf(dump->out, "%6x  constant 0x%08x (%.9g) in %u lanes%s\n",
                (unsigned)m->labels[m->literal_label[i]], (unsigned)m->literal_bits[i], (double)value,
                m->width, m->literal_lanes[i] ? "" : ", broadcast");
    }
}

/* The text that an assembler makes the code of, whether or not the engine does it. */
static int dump_text(struct dump *dump, const struct build_options *options, enum unit unit,
                     const union key *key, struct error *error)
{
    struct build_options textual = *options;
    textual.encoding = ENCODING_TEXT;
    if (!specialize_code(dump->builder, &textual, unit, key, NULL, NULL, error))
        return -1;
    const struct encode_text *text = &dump->builder->emitter.text;
    fprintf(dump->out, "\n== text: %zu characters\n", (size_t)(text->at - text->start));
    fwrite(text->start, 1, (size_t)(text->at - text->start), dump->out);
    return 0;
}

static int dump_phases(struct dump *dump, const struct build_options *options, enum unit unit,
                       const union key *key, struct error *error)
{
    struct builder *b = dump->builder;
    char text[KEY_TEXT_CAPACITY];
    if (shows(dump->show, "key"))
        fprintf(dump->out, "== key of the %s routine\n%s\n", unit_name[unit], key_print(unit, key, text));
    if (shows(dump->show, "record")) {
        ir_record(&b->ir, unit, key);
        fprintf(dump->out, "\n== record: the spec's operations for this key\n");
        ir_print(&b->ir, dump->text, dump->out);
    }
    size_t bytes = specialize_code(b, options, unit, key, after_pass, dump, error);
    if (!bytes)
        return -1;
    print_absent_passes(dump);
    if (shows(dump->show, "intervals")) {
        fprintf(dump->out, "\n== intervals: from definition to last use; = in a register, . in memory\n");
        allocate_print(&b->ir, &b->allocation, dump->out);
    }
    if (shows(dump->show, "asm"))
        dump_code(dump, bytes);
    return 0;
}

static int dump_parts(const struct engine *engine, enum unit unit, const union key *key, FILE *out,
                      struct error *error)
{
    struct build_parts parts;
    if (specialize_measure(engine, unit, key, &parts, error) ||
        specialize_measure(engine, unit, key, &parts, error))
        return -1;
    fprintf(out,
            "\n== parts: the time of each part of a second build, and what is left after its first run\n");
    specialize_print_parts(&parts, out);
    return 0;
}

int specialize_dump(const struct engine *engine, enum unit unit, const union key *key, const char *show,
                    FILE *out, struct error *error)
{
    if (!specialize_is_engine(engine))
        return error_set(error, "engine %s is not one of the specializer's", engine->name);
    if (check_words(show, error))
        return -1;
    struct builder *b = specialize_take(error);
    if (!b)
        return -1;
    struct build_options options = specialize_options(engine, unit);
    struct pass_shapes shapes = {0};
    if (specialize_may_sixteen(&options, unit))
        options.shapes = &shapes;
    const struct program *program = key_shader(unit, key);
    struct program_text text = {0};
    struct dump dump = {.show = show, .out = out, .builder = b, .text = program ? &text : NULL};
    int result = program ? program_text_open(program, &text, error) : 0;
    if (!result)
        result = dump_phases(&dump, &options, unit, key, error);
    if (!result && names_word(show, "text"))
        result = dump_text(&dump, &options, unit, key, error);
    if (!result && names_word(show, "parts"))
        result = dump_parts(engine, unit, key, out, error);
    program_text_free(&text);
    specialize_give(b);
    return result;
}
