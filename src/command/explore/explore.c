/* `triptych explore`: a page of HTML that shows how the routine of one draw call is made. */
#include "base/file.h"
#include "command/assets/asset.h"
#include "command/explore/page.h"
#include "command/support/choose.h"
#include "command/support/option.h"
#include "command/support/shared.h"
#include "command/support/session.h"
#include "emu/batch/batch.h"
#include "engines/external/external.h"
#include "engines/list.h"
#include "engines/mixed.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"
#include "engines/tiered/tiered.h"
#include "triptych.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { ENGINES_MAXIMUM = ROUTINE_TIERS * CHOICE_CAPACITY };

struct settings {
    const char *engines, *out;
    unsigned frame, draw, unit;
};

typedef int pane_function(struct page *page, const struct engine *engine, struct error *error);

/* --- Engines ------------------------------------------------------------------------------------------- */

struct engines {
    unsigned count;
    const struct engine *engine[ENGINES_MAXIMUM];
};

static pane_function *find_panes(const struct engine *engine)
{
    static const struct engine *const interpreters[] = {
        &engine_batch,
#define BATCH(lanes) &engine_batch_##lanes,
#include "def/engine/batch.def"
#undef BATCH
    };
    for (size_t i = 0; i < sizeof interpreters / sizeof *interpreters; i++)
        if (engine == interpreters[i])
            return pane_batch;
    return specialize_is_engine(engine) ? pane_specialize
           : stitch_is_engine(engine)   ? pane_stitch
           : external_is_engine(engine) ? pane_external
                                        : NULL;
}

/* Adds an engine; all tiers of a tiered one. */
static int add_engine(const struct command *self, const struct engine *engine, struct engines *engines)
{
    const struct engine *tier = tiered_engine(engine, 0);
    if (mixed_is_engine(engine))
        return tool_fail(self, "engine %s has nothing of its own to show, expected the engines of its units",
                         engine->name);
    if (!tier && !find_panes(engine))
        return tool_fail(self, "engine %s has nothing to show, expected one that builds routines",
                         engine->name);
    if (!tier)
        engines->engine[engines->count++] = engine;
    for (unsigned i = 0; (tier = tiered_engine(engine, i)); i++)
        if (find_panes(tier))
            engines->engine[engines->count++] = tier;
    return STATUS_OK;
}

static int read_engines(const struct command *self, const char *list, struct engines *engines)
{
    struct choice choice;
    if (choose_engines(self, list, &choice))
        return STATUS_BAD;
    engines->count = 0;
    for (unsigned i = 0; i < choice.count; i++)
        if (add_engine(self, engine_find(triptych_engine_name(choice.index[i])), engines))
            return STATUS_BAD;
    return STATUS_OK;
}

static bool is_repeated(const struct engines *engines, unsigned number)
{
    for (unsigned i = 0; i < number; i++)
        if (engines->engine[i] == engines->engine[number])
            return true;
    return false;
}

/* --- The page ------------------------------------------------------------------------------------------ */

static void print_head(struct page *page, const struct settings *settings, const char *path,
                       const struct engines *engines)
{
    fprintf(page->out, "{\"format\":1,\"frame\":%u,\"draw\":%u,\"unit\":\"%s\"", settings->frame,
            settings->draw, unit_name[page->unit]);
    page_member(page, "stream", path);
    page_member(page, "version", TRIPTYCH_VERSION);
    fputs(",\n\"engines\":[", page->out);
    for (unsigned i = 0; i < engines->count; i++) {
        if (is_repeated(engines, i))
            continue;
        page_item(page);
        fputs("{\"name\":", page->out);
        page_string(page, engines->engine[i]->name);
        page_member(page, "description", engines->engine[i]->description);
        fputc('}', page->out);
    }
    fputc(']', page->out);
}

static int print_engines(struct page *page, const struct engines *engines, struct error *error)
{
    for (unsigned i = 0; i < engines->count; i++) {
        const struct engine *engine = engines->engine[i];
        page->engine = engine->name;
        if (!is_repeated(engines, i) && find_panes(engine)(page, engine, error))
            return -1;
    }
    return 0;
}

/* The written text of a shader, in the stream or in a file; the caller frees it. Null if there is none:
 * then the shader is bytecode, or from a recording. */
static char *read_written(const struct stream *stream, const struct resource *resource, size_t *bytes)
{
    struct error ignored = {""};
    char *path = resource->path && !resource->embedded ? asset_path(stream->path, resource->path) : NULL;
    char *text = NULL;
    if (path && !asset_check_path(path, &ignored))
        file_read(path, SHADER_BYTES, &text, bytes, &ignored);
    else if (resource->written && (text = strdup(resource->written)))
        *bytes = strlen(text);
    free(path);
    return text;
}

/* Fills `text` with the first written text of the program, else with the canonical one. A file that is
 * missing or has changed does not matter, but refused memory is a failure. */
static int read_shader(const struct stream *stream, const struct program *program, struct program_text *text,
                       struct error *error)
{
    errno = 0;
    for (uint32_t r = 0; r < stream->resource_count && errno != ENOMEM; r++) {
        const struct resource *resource = &stream->resources[r];
        struct error ignored = {""};
        size_t bytes;
        if (resource->type != RESOURCE_SHADER || resource->program != program)
            continue;
        char *written = read_written(stream, resource, &bytes);
        if (written && !program_text_read(program, written, bytes, text, &ignored))
            return 0;
    }
    return errno == ENOMEM ? error_set(error, "out of memory for the text of a shader")
                           : program_text_open(program, text, error);
}

/* The subject of a page. */
struct subject {
    const struct settings *settings;
    const struct stream *stream;
    enum unit unit;
    union key key;
    struct engines engines;
};

static int print_panes(struct page *page, const struct subject *s, struct error *error)
{
    const struct program *program = key_shader(s->unit, &s->key);
    struct program_text text = {0};
    if (program && read_shader(s->stream, program, &text, error))
        return -1;
    print_head(page, s->settings, s->stream->path, &s->engines);
    int result = page_sources(page, program ? &text : NULL, error);
    program_text_free(&text);
    return result ? result : print_engines(page, &s->engines, error);
}

/* The caller frees *html. */
static int make_page(const struct subject *s, char **html, size_t *bytes, struct error *error)
{
    struct explore_recording recording;
    struct page page = {0};
    int result = explore_record(&recording, s->unit, &s->key, error);
    if (!result)
        result = page_open(&page, &recording, s->unit, &s->key, error);
    if (!result)
        result = print_panes(&page, s, error);
    if (!result)
        result = page_close(&page, html, bytes, error);
    else
        page_discard(&page);
    explore_record_free(&recording);
    return result;
}

static int write_page(const struct command *self, const struct subject *s)
{
    const struct settings *settings = s->settings;
    struct error error = {""};
    char *html = NULL;
    size_t bytes = 0;
    tool_progress(NULL);
    int bad = make_page(s, &html, &bytes, &error) || file_write(settings->out, html, bytes, &error);
    free(html);
    if (bad)
        return tool_fail(self, "%s", error.text);
    printf("%s: the %s routine of draw %u in frame %u of %s, %zu KB\n", settings->out, unit_name[s->unit],
           settings->draw, settings->frame, s->stream->path, (bytes + 1023) / 1024);
    return STATUS_OK;
}

/* Keys do not depend on the engine, and engine 0 generates no code. */
static int explore(const struct command *self, const char *path, const struct settings *settings)
{
    struct subject s = {.settings = settings, .unit = (enum unit)settings->unit};
    if (read_engines(self, settings->engines, &s.engines) || tool_check_output(self, settings->out))
        return STATUS_BAD;
    struct stream *stream = session_load(self, path);
    if (!stream)
        return STATUS_BAD;
    uint32_t draw = 0;
    s.stream = stream;
    int status = session_find_draw(self, stream, settings->frame, settings->draw, &draw);
    if (!status)
        status = session_read_key(self, stream, draw, 0, NULL, s.unit, &s.key);
    if (!status)
        status = write_page(self, &s);
    stream_free(stream);
    return status;
}

/* --- The command line ---------------------------------------------------------------------------------- */

static const char notes[] =
    "Open the page with any browser: it needs no network and no other file. It shows the key, the\n"
    "specification, the shader, the recording, and what each engine makes of them. Point at a line: its kin "
    "in\n"
    "all columns are marked. docs/explorer.md describes the page.";

static int run(const struct command *self, void *data, const struct operands *operands)
{
    return explore(self, operands->value[0], data);
}

static const char *unit_at(unsigned index)
{
    return index < UNIT_COUNT ? unit_name[index] : NULL;
}

static const struct settings defaults = {.engines = "specialize", .unit = UNIT_PIXEL, .out = "explore.html"};

static const struct option options[] = {
    OPTION_DRAW(struct settings, draw),
    OPTION_FRAME(struct settings, frame),
    {"unit", "UNIT", "vertex, setup or pixel; pixel", OPTION_IS_INDEX(struct settings, unit),
     .words = unit_at},
    {"engines", "LIST", "engines, separated by commas; specialize", OPTION_IS_LIST(struct settings, engines),
     .words = triptych_engine_name},
    {"out", "FILE", "the page; explore.html", OPTION_IS_FILE(struct settings, out), .extension = "html"},
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream", .kind = OPERAND_INPUT, .extension = "tri trib"},
    {0},
};

const struct command command_explore = {
    .name = "explore",
    .summary = "write a page that shows how a routine is made",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
