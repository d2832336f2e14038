/* `triptych dump`: how an engine makes the routine of one draw call. */
#include "machine/code.h"
#include "contract/key.h"
#include "engines/external/external.h"
#include "engines/specialize/specialize.h"
#include "shader/program/program.h"
#include "engines/stitch/stitch.h"
#include "engines/tiered/tiered.h"
#include "engines/list.h"
#include "engines/mixed.h"
#include "engines/specialize/passes/pass.h"
#include "command/support/choose.h"
#include "command/support/option.h"
#include "command/support/shared.h"
#include "command/store/store.h"
#include "command/support/session.h"
#include "triptych.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH_MAXIMUM = 256, ARENA_BYTES = 8 << 20 };

struct settings {
    const char *engine, *show;
    unsigned frame, draw, width, unit;
    bool spans, white, gradients, joined, no_cache;
    struct variation variation;
    struct option_given set;
};

static int dump_jit(const struct engine *engine, struct code_arena *arena, enum unit unit,
                    const union key *key, const char *show, struct error *error)
{
    (void)arena;
    return specialize_dump(engine, unit, key, show ? show : "key,asm", stdout, error);
}

/* Stitched routines have no stages to choose from; their fragments are shown. */
static int dump_stitch(const struct engine *engine, struct code_arena *arena, enum unit unit,
                       const union key *key, const char *show, struct error *error)
{
    if (show)
        return error_set(error, "--show is \"%s\", expected none: a routine of %s has no stages", show,
                         engine->name);
    return stitch_dump(engine, arena, unit, key, stdout, error);
}

/* Shows the tiers with code, in order; with stages, only those that have some. */
static int dump_tiered(const struct engine *engine, struct code_arena *arena, enum unit unit,
                       const union key *key, const char *show, struct error *error)
{
    int bad = 0;
    const struct engine *tier;
    for (unsigned i = 0; !bad && (tier = tiered_engine(engine, i)); i++)
        if (stitch_is_engine(tier) && !show)
            bad = dump_stitch(tier, arena, unit, key, NULL, error);
        else if (specialize_is_engine(tier))
            bad = dump_jit(tier, arena, unit, key, show, error);
    return bad;
}

static int dump_external(const struct engine *engine, struct code_arena *arena, enum unit unit,
                         const union key *key, const char *show, struct error *error)
{
    (void)arena;
    return external_dump(engine, unit, key, show ? show : "key,text,asm", stdout, error);
}

static const struct dumper {
    const struct engine *engine;
    int (*dump)(const struct engine *engine, struct code_arena *arena, enum unit unit, const union key *key,
                const char *show, struct error *error);
} dumpers[] = {
#define SPECIALIZE(id, ...) {&engine_##id, dump_jit},
#include "def/engine/specialize.def"
#undef SPECIALIZE
    {&engine_stitch, dump_stitch}, {&engine_stitch_operation, dump_stitch}, {&engine_external, dump_external},
    {&engine_tiered, dump_tiered}, {&engine_tiered_swap, dump_tiered},
};

static const struct dumper *find_dumper(const struct command *self, unsigned engine)
{
    char names[256] = "";
    for (size_t i = 0; i < sizeof dumpers / sizeof *dumpers; i++) {
        if (dumpers[i].engine->build == engine_at(engine)->build)
            return dumpers + i;
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? ", " : "",
                 dumpers[i].engine->name);
    }
    return tool_fail(self, "engine %s makes no code, expected one of: %s", triptych_engine_name(engine),
                     names),
           NULL;
}

/* The engine that makes the unit's routines. */
static unsigned engine_of_unit(unsigned engine, enum unit unit)
{
    const struct engine *own = mixed_engine(engine_at(engine), unit);
    return own ? engine_number(own) : engine;
}

/* Prints the shader that the key numbers, if there is one, with the numbers of its lines. */
static int print_shader(enum unit unit, const union key *key, struct error *error)
{
    const struct program *program = key_shader(unit, key);
    struct program_text text;
    if (!program)
        return 0;
    if (program_text_open(program, &text, error))
        return -1;
    printf("shader %u, %u instruction slots, %u steps:\n", program->number, program->slots, program->steps);
    for (uint32_t line = 0; line < text.lines; line++)
        printf("%5u  %s\n", line + 1, text.line[line]);
    putchar('\n');
    program_text_free(&text);
    return 0;
}

static int dump_key(const struct command *self, const struct dumper *dumper, const struct engine *engine,
                    enum unit unit, const union key *key, const char *show)
{
    struct error error = {""};
    struct code_arena *arena = code_create(ARENA_BYTES, NULL, &error);
    tool_progress(NULL);
    bool is_file = show && !strcmp(show, "whole"); /* of C, and nothing else */
    int bad = !arena || (!is_file && print_shader(unit, key, &error)) ||
              dumper->dump(engine, arena, unit, key, show, &error);
    code_destroy(arena);
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

/* Fails if the routine has no other readings than the ordinary one. */
static int check_readings(const struct command *self, enum unit unit, const union key *key)
{
    if (unit != UNIT_PIXEL)
        return tool_fail(self, "--spans is for pixel routines, found --unit %s", unit_name[unit]);
    if (key->pixel.samples || !pixel_shades(&key->pixel))
        return tool_fail(self, "the draw has no span reading, expected one sample, and computed colours");
    return STATUS_OK;
}

/* Makes the key that of the reading's routine (docs/spans.md). */
static int choose_reading(const struct command *self, enum unit unit, enum span span, bool joined,
                          union key *key)
{
    if (check_readings(self, unit, key))
        return STATUS_BAD;
    if (joined && span)
        return tool_fail(self, "--joined is a reading of its own, without --spans, --white or --gradients");
    if (span == SPAN_WHITE && !key->pixel.varying[VARYING_diffuse])
        return tool_fail(self, "--white is for draws that read the diffuse colour");
    if (span == SPAN_GRADIENT && key->pixel.varying[VARYING_diffuse] != INTERPOLATION_SMOOTH)
        return tool_fail(self, "--gradients is for draws whose diffuse colour is interpolated");
    key->pixel.span = span;
    key->pixel.joined = joined;
    return STATUS_OK;
}

static int dump(const struct command *self, const char *path, const struct settings *settings,
                unsigned engine, enum unit unit)
{
    const struct dumper *dumper = find_dumper(self, engine);
    struct stream *stream = dumper ? session_load(self, path) : NULL;
    if (!stream)
        return STATUS_BAD;
    const struct setting_values values = choose_settings(&settings->set);
    uint32_t draw = 0;
    union key key;
    int status = session_find_draw(self, stream, settings->frame, settings->draw, &draw);
    if (!status)
        status = session_read_key(self, stream, draw, engine, &values, unit, &key);
    const enum span span = settings->white       ? SPAN_WHITE
                           : settings->gradients ? SPAN_GRADIENT
                           : settings->spans     ? SPAN_LEVEL
                                                 : SPAN_NONE;
    if (!status && (span || settings->joined))
        status = choose_reading(self, unit, span, settings->joined, &key);
    if (!status)
        status = dump_key(self, dumper, engine_at(engine), unit, &key, settings->show);
    stream_free(stream);
    return status;
}

static const char notes[] =
    "The text of the draw's shader comes first, and each of its lines again before what it becomes.\n"
    "Stages of specialize: key, record (the operations as recorded), the name of a pass (the operations\n"
    "after it; triptych list passes), intervals (registers), asm (the code), all; and, not in all, text "
    "(the\n"
    "code as assembly for NASM) and parts (times of the parts of a build, which differ from run to run).\n"
    "Stages of external: key, vector (the operations that the text is made from), text (C), asm, all; whole\n"
    "(vector and text as one file of C).\n"
    "The stitching engines show their fragments, holes and code.";

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    unsigned engine;
    store_off |= settings->no_cache;
    if (choose_engine(self, settings->engine, settings->width, &engine))
        return STATUS_BAD;
    struct choice choice = {.count = 1, .index = {engine}};
    if (choose_variants(self, &settings->variation, &choice))
        return STATUS_BAD;
    enum unit unit = (enum unit)settings->unit;
    return dump(self, operands->value[0], settings, engine_of_unit(choice.index[0], unit), unit);
}

static const char *unit_at(unsigned index)
{
    return index < UNIT_COUNT ? unit_name[index] : NULL;
}

/* The stages of specialize, then those that only external has. */
static const char *stage_at(unsigned index)
{
    static const char *const external[] = {"vector", "whole"};
    unsigned own = 0;
    while (own < index && specialize_phase_name(own))
        own++;
    if (specialize_phase_name(own))
        return specialize_phase_name(own);
    return index - own < sizeof external / sizeof *external ? external[index - own] : NULL;
}

static const struct settings defaults = {.engine = "specialize", .unit = UNIT_PIXEL};

static const struct option options[] = {
    OPTION_DRAW(struct settings, draw),
    OPTION_FRAME(struct settings, frame),
    {"unit", "UNIT", "vertex, setup or pixel; pixel", OPTION_IS_INDEX(struct settings, unit),
     .words = unit_at},
    {"show", "LIST", "stages, separated by commas; key,asm", OPTION_IS_LIST(struct settings, show),
     .words = stage_at},
    {"engine", "NAME", "engine of the routine; specialize", OPTION_IS_WORD(struct settings, engine),
     .words = triptych_engine_name, .suffixed = true},
    {"width", "LANES", "lanes of the engine's variant", OPTION_IS_NUMBER(struct settings, width), .least = 1,
     .most = WIDTH_MAXIMUM},
    {"spans", NULL, "the pixel routine of the span reading", OPTION_IS_FLAG(struct settings, spans)},
    {"white", NULL, "that of the span reading whose diffuse colour is white",
     OPTION_IS_FLAG(struct settings, white)},
    {"gradients", NULL, "that of the span reading whose colours vary",
     OPTION_IS_FLAG(struct settings, gradients)},
    {"joined", NULL, "the pixel routine of the reading for joined rectangles",
     OPTION_IS_FLAG(struct settings, joined)},
    OPTIONS_OF_VARIATION(struct settings, variation),
    OPTION_SET(struct settings, set),
    OPTION_NO_CACHE(struct settings, no_cache),
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream", .kind = OPERAND_INPUT, .extension = "tri trib"},
    {0},
};

const struct command command_dump = {
    .name = "dump",
    .summary = "show how the routine of one draw call is made",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
