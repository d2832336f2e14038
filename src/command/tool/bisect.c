/* `triptych bisect`: the first operation of the specification whose value differs between two engines. */
#include "command/fuzz/bisect/bisect.h"

#include "engines/list.h"
#include "command/support/choose.h"
#include "command/support/json.h"
#include "command/support/option.h"
#include "command/support/shared.h"
#include "command/store/store.h"
#include "command/support/session.h"
#include "triptych.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NONE = OPTION_STREAM_MAXIMUM + 1, PIXEL_MAXIMUM = 8192, NAME_CAPACITY = 16 };

/* Reads `X,Y`. */
static int read_pixel(const struct command *self, const char *text, struct bisect_options *options)
{
    char piece[NAME_CAPACITY];
    unsigned place[2], count = 0;
    const char *next = option_next_item(text, piece, sizeof piece);
    while (next && count < 2 && option_read_number(piece, 0, PIXEL_MAXIMUM - 1, place + count)) {
        count++;
        next = option_next_item(next, piece, sizeof piece);
    }
    if (count == 2 && !next) {
        options->x = (int32_t)place[0];
        options->y = (int32_t)place[1];
        return STATUS_OK;
    }
    return tool_fail(self, "--pixel is \"%s\", expected X,Y, each from 0 to %d", text, PIXEL_MAXIMUM - 1);
}

static cJSON *values(const struct bisection *b, const uint32_t value[2])
{
    cJSON *object = cJSON_CreateObject();
    char bits[16];
    for (int i = 0; i < 2; i++) {
        snprintf(bits, sizeof bits, "%08x", value[i]);
        cJSON_AddStringToObject(object, b->engine[i]->name, bits);
    }
    return object;
}

static void add_text(cJSON *json, const char *name, const char *text)
{
    if (text && *text)
        cJSON_AddStringToObject(json, name, text);
}

static cJSON *report(const char *path, const struct bisection *b)
{
    static const char *const outcomes[] = {[BISECT_SAME] = "same",
                                           [BISECT_CALL] = "call",
                                           [BISECT_NARROWED] = "narrowed",
                                           [BISECT_FOUND] = "found"};
    cJSON *json = cJSON_CreateObject();
    add_text(json, "stream", path);
    add_text(json, "outcome", outcomes[b->outcome]);
    if (b->outcome == BISECT_SAME)
        return json;
    add_text(json, "unit", unit_name[b->unit]);
    add_text(json, "key", b->key);
    cJSON_AddNumberToObject(json, "draw", (double)b->draw);
    cJSON_AddNumberToObject(json, "frame", b->frame);
    cJSON_AddNumberToObject(json, "draw_of_frame", b->draw_of_frame);
    cJSON_AddNumberToObject(json, "lane", b->lane);
    if (b->unit == UNIT_PIXEL) {
        cJSON_AddNumberToObject(json, "x", b->x);
        cJSON_AddNumberToObject(json, "y", b->y);
    }
    add_text(json, "place", b->place);
    add_text(json, "operation", b->operation);
    if (b->operation)
        cJSON_AddItemToObject(json, "values", values(b, b->value));
    add_text(json, "output", b->output_name);
    cJSON_AddItemToObject(json, "outputs", values(b, b->output));
    add_text(json, "pass", b->pass);
    add_text(json, "fragment", b->fragment);
    add_text(json, "reason", b->reason);
    return json;
}

static int tell(const struct command *self, const char *path, const struct bisection *b,
                const char *json_path)
{
    struct text text = {0};
    int status = b->outcome == BISECT_SAME ? STATUS_OK : STATUS_DIFFERENT;
    bisection_print(b, &text);
    tool_progress(NULL);
    if (text.failed)
        status = tool_fail(self, "no memory for the report");
    else
        fputs(text.data, stdout);
    text_free(&text);
    if (!json_path)
        return status;
    cJSON *json = report(path, b);
    if (json_write(self, json, json_path))
        status = STATUS_BAD;
    cJSON_Delete(json);
    return status;
}

static void show_progress(uint64_t draw, uint64_t draws)
{
    tool_progress("draw %" PRIu64 " of %" PRIu64, draw, draws);
}

static int find(const struct command *self, const char *path, const struct choice *engines,
                const struct bisect_options *options, const char *json_path)
{
    struct error error = {""};
    struct bisection bisection;
    struct stream *stream = session_load(self, path);
    if (!stream)
        return STATUS_BAD;
    tool_progress("comparing %s and %s on %s", engine_at(engines->index[0])->name,
                  engine_at(engines->index[1])->name, path);
    int bad = bisect(stream, engine_at(engines->index[0]), engine_at(engines->index[1]), options, &bisection,
                     &error);
    int status = bad ? tool_fail(self, "%s: %s", path, error.text) : tell(self, path, &bisection, json_path);
    stream_free(stream);
    return status;
}

static const char notes[] = "The routines of both engines run on the same inputs, draw by draw, until the "
                            "outputs differ. Then every value\n"
                            "that they compute is compared. The first engine is the reference. Exit status "
                            "1: a difference was found.";

struct settings {
    const char *engines, *pixel, *json;
    unsigned draw;
    bool no_cache;
};

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    struct bisect_options wanted = {
        .draw = BISECT_ANY, .x = BISECT_ANY, .y = BISECT_ANY, .progress = show_progress};
    struct choice engines;
    store_off |= settings->no_cache;
    if (choose_engines(self, settings->engines, &engines) || tool_check_output(self, settings->json) ||
        (settings->pixel && read_pixel(self, settings->pixel, &wanted)))
        return STATUS_BAD;
    if (engines.count != 2)
        return tool_fail(self, "--engines names %u, expected two", engines.count);
    if (settings->draw != NONE)
        wanted.draw = settings->draw;
    return find(self, operands->value[0], &engines, &wanted, settings->json);
}

static const struct settings defaults = {.engines = "emulate,specialize", .draw = NONE};

static const struct option options[] = {
    {"engines", "A,B", "the two engines; emulate,specialize", OPTION_IS_LIST(struct settings, engines),
     .words = triptych_engine_name},
    {"draw", "N", "examine only this draw of the stream, numbered from 0",
     OPTION_IS_NUMBER(struct settings, draw), .most = OPTION_STREAM_MAXIMUM},
    {"pixel", "X,Y", "examine only this pixel", OPTION_IS_TEXT(struct settings, pixel)},
    {"json", "FILE", "also write the report to FILE", OPTION_IS_FILE(struct settings, json),
     .extension = "json"},
    OPTION_NO_CACHE(struct settings, no_cache),
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream", .kind = OPERAND_INPUT, .extension = "tri trib"},
    {0},
};

const struct command command_bisect = {
    .name = "bisect",
    .summary = "name the first operation whose value differs between two engines",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
