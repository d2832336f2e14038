#include "engines/specialize/parts.h"

#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "machine/disassemble.h"
#include "machine/mxcsr.h"

#include <string.h>

const char *specialize_part_name(unsigned part)
{
    static const char *const names[] = {"compact", "hints", "allocate", "select", "encode", "assemble"};
    if (part == BUILD_RECORD)
        return "record";
    if (part < BUILD_COMPACT)
        return pass_name(part - BUILD_PASSES);
    return part < BUILD_PARTS ? names[part - BUILD_COMPACT] : NULL;
}

static uint32_t count_instructions(const struct ir *ir)
{
    uint32_t count = 0;
    for (uint32_t n = 1; n < ir->count; n++)
        count += ir->instruction[n].op != IR_nop;
    return count;
}

/* The context of the observer. */
struct measurement {
    struct build_parts *parts;
    uint64_t since; /* the end of the previous part */
    uint32_t left;  /* instructions, at that time */
};

static void after_pass(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    struct measurement *m = context;
    if (pass == PASS_COUNT) { /* another program follows */
        m->left = count_instructions(ir);
        m->parts->part[BUILD_COMPACT].ns += clock_ns() - m->since;
        m->since = clock_ns();
        return;
    }
    struct build_part *part = &m->parts->part[BUILD_PASSES + pass];
    part->ns += clock_ns() - m->since;
    uint32_t left = changed ? count_instructions(ir) : m->left;
    if (!part->runs++)
        part->first_left = left;
    part->removed += (int32_t)(m->left - left);
    m->left = left;
    m->since = clock_ns();
}

static void end_part(struct measurement *m, unsigned part)
{
    uint64_t now = clock_ns();
    m->parts->part[part].ns += now - m->since;
    m->since = clock_ns();
}

static void measure_passes(struct builder *b, const struct build_options *options, struct measurement *m)
{
    m->parts->recorded = m->left = count_instructions(&b->ir);
    m->since = clock_ns();
    specialize_run_passes(b, options, after_pass, m);
    end_part(m, BUILD_COMPACT);
    m->parts->left = m->left;
}

static size_t emit_once(struct builder *b, enum unit unit, const union key *key, struct measurement *m,
                        unsigned part, struct error *error)
{
    m->since = clock_ns();
    size_t bytes = emit_routine(&b->emitter, unit, key, error);
    end_part(m, part);
    return bytes;
}

static void subtract(struct build_part *part, uint64_t ns)
{
    part->ns -= part->ns < ns ? part->ns : ns;
}

/* Each round does more than the one before; the first only loads caches. */
static int measure_code(struct builder *b, enum unit unit, const union key *key, struct measurement *m,
                        struct error *error)
{
    struct build_part *part = m->parts->part;
    struct emitter *emitter = &b->emitter;
    emitter->silent = true;
    emit_once(b, unit, key, m, BUILD_SELECT, NULL);
    emit_once(b, unit, key, m, BUILD_SELECT, NULL);
    emitter->silent = false;
    emitter->unread = emitter->textual;
    m->parts->bytes = (uint32_t)emit_once(b, unit, key, m, BUILD_ENCODE, error);
    if (emitter->textual) {
        emitter->unread = false;
        m->parts->bytes = (uint32_t)emit_once(b, unit, key, m, BUILD_ASSEMBLE, error);
        subtract(&part[BUILD_ASSEMBLE], part[BUILD_ENCODE].ns);
    }
    subtract(&part[BUILD_ENCODE], part[BUILD_SELECT].ns);
    return m->parts->bytes ? 0 : -1;
}

static int measure(struct builder *b, const struct build_options *options, enum unit unit,
                   const union key *key, struct build_parts *parts, struct error *error)
{
    struct measurement m = {.parts = parts, .since = clock_ns()};
    ir_record(&b->ir, unit, key);
    end_part(&m, BUILD_RECORD);
    if (!b->ir.overflow)
        measure_passes(b, options, &m);
    if (b->ir.overflow)
        return error_set(error, "the %s routine takes more than %d operations", unit_name[unit],
                         IR_CAPACITY - 1);
    m.since = clock_ns();
    if (options->allocator == ALLOCATOR_hints)
        specialize_write_hints(b, options);
    end_part(&m, BUILD_HINTS);
    if (specialize_allocate(b, options, error))
        return -1;
    end_part(&m, BUILD_ALLOCATE);
    parts->spills = b->allocation.spills;
    return measure_code(b, unit, key, &m, error);
}

/* Passes that did not run leave what the one before left. */
static void fill_gaps(struct build_parts *parts)
{
    uint32_t left = parts->recorded;
    for (unsigned p = BUILD_RECORD; p < BUILD_PARTS; p++) {
        struct build_part *part = &parts->part[p];
        if (p >= BUILD_COMPACT)
            left = parts->left;
        else if (part->runs)
            left = part->first_left;
        part->first_left = left;
    }
}

int specialize_measure(const struct engine *engine, enum unit unit, const union key *key,
                       struct build_parts *parts, struct error *error)
{
    memset(parts, 0, sizeof *parts);
    struct builder *b = specialize_take(error);
    if (!b)
        return -1;
    const struct build_options options = specialize_options(engine, unit);
    unsigned saved = mxcsr_enter();
    int result = measure(b, &options, unit, key, parts, error);
    mxcsr_leave(saved);
    specialize_give(b);
    fill_gaps(parts);
    return result;
}

/* --- Rules ---------------------------------------------------------------------------------------------- */

struct code_size {
    uint32_t instructions, bytes;
};

static int build_size(struct builder *b, const struct build_options *options, enum unit unit,
                      const union key *key, struct code_size *size, struct error *error)
{
    size->bytes = (uint32_t)specialize_code(b, options, unit, key, NULL, NULL, error);
    size->instructions = disassemble_count(b->emitter.code, b->emitter.code_bytes).instructions;
    return size->bytes ? 0 : -1;
}

static int compare_rules(struct builder *b, const struct build_options *options, enum unit unit,
                         const union key *key, struct build_rule rules[PEEPHOLES], uint32_t *instructions,
                         struct error *error)
{
    struct code_size with, without;
    if (build_size(b, options, unit, key, &with, error))
        return -1;
    *instructions = with.instructions;
    for (unsigned r = 0; r < PEEPHOLES; r++)
        rules[r].fired = b->pass.rules.fired[r] + b->emitter.rules.fired[r];
    for (unsigned r = 0; r < PEEPHOLES; r++) {
        struct build_options fewer = *options;
        fewer.without_rules |= 1ull << r;
        if (!rules[r].fired)
            continue;
        if (build_size(b, &fewer, unit, key, &without, error))
            return -1;
        rules[r].instructions = (int32_t)(without.instructions - with.instructions);
        rules[r].bytes = (int32_t)(without.bytes - with.bytes);
    }
    return 0;
}

int specialize_measure_rules(const struct engine *engine, enum unit unit, const union key *key,
                             struct build_rule rules[PEEPHOLES], uint32_t *instructions, struct error *error)
{
    struct builder *b = specialize_take(error);
    const struct build_options options = specialize_options(engine, unit);
    memset(rules, 0, PEEPHOLES * sizeof *rules);
    int result = b ? compare_rules(b, &options, unit, key, rules, instructions, error) : -1;
    if (b)
        specialize_give(b);
    return result;
}

void specialize_print_parts(const struct build_parts *parts, FILE *out)
{
    uint64_t total = 0;
    for (unsigned p = 0; p < BUILD_PARTS; p++)
        total += parts->part[p].ns;
    fprintf(out, "%-10s %8s %6s %5s %8s %6s\n", "part", "us", "share", "runs", "removed", "left");
    for (unsigned p = 0; p < BUILD_PARTS; p++) {
        const struct build_part *part = &parts->part[p];
        bool pass = p >= BUILD_PASSES && p < BUILD_COMPACT;
        if (pass && !part->runs)
            continue;
        fprintf(out, "%-10s %8.1f %5.1f%%", specialize_part_name(p), (double)part->ns / 1e3,
                total ? 100.0 * (double)part->ns / (double)total : 0.0);
        if (pass)
            fprintf(out, " %5u %8d %6u", part->runs, (int)part->removed, part->first_left);
        else if (p == BUILD_RECORD)
            fprintf(out, " %5s %8s %6u", "", "", part->first_left);
        fputc('\n', out);
    }
    fprintf(out, "%-10s %8.1f; %u instructions become %u, %u bytes, %u spilled\n", "all", (double)total / 1e3,
            parts->recorded, parts->left, parts->bytes, parts->spills);
}
