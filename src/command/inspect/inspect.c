/* `triptych inspect`: the state at a draw, what happened to a pixel, and overdraw.
 *
 * The draws are played by an engine that observes the emulator (watch.h). */
#include "command/inspect/overdraw.h"
#include "command/inspect/print.h"
#include "command/inspect/inspection.h"
#include "command/support/json.h"
#include "command/support/option.h"
#include "command/support/choose.h"
#include "command/support/shared.h"
#include "command/support/session.h"
#include "image/png.h"
#include "image/rows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NONE = OPTION_STREAM_MAXIMUM + 1, PIXEL_MAXIMUM = 8192, NAME_CAPACITY = 16 };

struct settings {
    unsigned frame, draw, count;
    const char *pixel, *overdraw, *json;
    struct option_given set;
};

/* Reads `X,Y`. */
static int read_pixel(const struct command *self, const char *text, struct trail_options *options)
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

/* The words of enum watch_what. */
static const char *what_at(unsigned index)
{
    static const char *const words[] = {
        [WATCH_COVERED] = "covered", [WATCH_SHADED] = "shaded", [WATCH_PASSED] = "passed"};
    return index < sizeof words / sizeof *words ? words[index] : NULL;
}

static int save_overdraw(const struct command *self, const char *path, const struct trail *trail)
{
    struct error error = {""};
    unsigned width, height;
    const uint32_t *count = inspection_counts(trail, &width, &height);
    size_t pixels = (size_t)width * height;
    uint32_t *picture = malloc(pixels * sizeof *picture);
    if (!picture)
        return tool_fail(self, "no memory for a picture of %zu pixels", pixels);
    for (size_t i = 0; i < pixels; i++)
        picture[i] = overdraw_color(count[i]);
    if (inspection_is_lower(trail))
        rows_reverse(picture, width * sizeof *picture, height);
    int bad = png_save(path, width, height, picture, &error);
    free(picture);
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

static void add_overdraw(struct trail *trail, cJSON *report)
{
    unsigned width, height;
    const uint32_t *count = inspection_counts(trail, &width, &height);
    cJSON_AddItemToObject(report, "overdraw", overdraw_report(count, width, height));
}

static int add_history(const struct command *self, struct trail *trail, const char *path, cJSON *report)
{
    struct error error = {""};
    cJSON *history = inspection_history(trail, &error);
    if (*error.text)
        return tool_fail(self, "%s: %s", path, error.text);
    cJSON_AddItemToObject(report, "pixel", history);
    return STATUS_OK;
}

static int check_complete(const struct command *self)
{
    return tool_report_is_complete() ? STATUS_OK : tool_fail(self, "out of memory: the report is incomplete");
}

/* Text for people: the list of draws if nothing else is requested. */
static int print(const struct command *self, const struct settings *settings, const cJSON *report)
{
    const cJSON *pixel = cJSON_GetObjectItem(report, "pixel");
    const cJSON *overdraw = cJSON_GetObjectItem(report, "overdraw");
    tool_progress(NULL);
    if (settings->draw != NONE)
        print_state(cJSON_GetObjectItem(report, "state"));
    else if (!pixel && !overdraw)
        print_draws(cJSON_GetObjectItem(report, "draws"));
    if (overdraw)
        overdraw_print(overdraw);
    if (pixel)
        print_history(pixel);
    return check_complete(self);
}

/* Makes the whole report before anything is printed or written. */
static int make(const struct command *self, const struct settings *settings, struct trail *trail,
                const char *path, cJSON *json)
{
    int status = STATUS_OK;
    const struct setting_values values = choose_settings(&settings->set);
    char text[SETTING_TEXT];
    cJSON_AddStringToObject(json, "settings", setting_write(&values, text));
    cJSON_AddItemToObject(json, "draws", inspection_draws(trail));
    cJSON_AddItemToObject(json, "state", inspection_state(trail));
    if (settings->pixel)
        status = add_history(self, trail, path, json);
    if (settings->overdraw && !status)
        add_overdraw(trail, json);
    if (inspection_is_starved(trail))
        tool_report_mark_incomplete();
    return status ? status : check_complete(self);
}

static int report(const struct command *self, const struct settings *settings, struct trail *trail,
                  const char *path)
{
    cJSON *json = cJSON_CreateObject();
    int status = make(self, settings, trail, path, json);
    if (!status)
        status = print(self, settings, json);
    if (settings->overdraw && !status)
        status = save_overdraw(self, settings->overdraw, trail);
    if (settings->json && !status)
        status = json_write(self, json, settings->json);
    cJSON_Delete(json);
    return status;
}

static int inspect(const struct command *self, const struct settings *settings, const char *path,
                   const struct trail_options *options)
{
    struct error error = {""};
    struct stream *stream = session_load(self, path);
    if (!stream)
        return STATUS_BAD;
    tool_progress("playing %s", path);
    struct trail *trail = inspection_open(stream, options, &error);
    int status = trail ? report(self, settings, trail, path) : tool_fail(self, "%s", error.text);
    if (trail)
        inspection_close(trail);
    stream_free(stream);
    return status;
}

static const char notes[] = "Without --draw, --pixel and --overdraw, lists the draws of the frame. --draw "
                            "shows the state at a draw:\n"
                            "targets, shaders, textures, buffers, and states that differ from their "
                            "defaults. --pixel and --overdraw\n"
                            "take the draws from the beginning of the frame up to --draw, without it all of "
                            "them, as far as they go to\n"
                            "the target of that draw.";

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    struct trail_options asked = {.frame = settings->frame,
                                  .draw = settings->draw == NONE ? TRAIL_LAST : settings->draw,
                                  .x = -1,
                                  .y = -1,
                                  .counts = settings->overdraw,
                                  .settings = choose_settings(&settings->set),
                                  .what = settings->count == NONE ? WATCH_COVERED
                                                                  : (enum watch_what)settings->count};
    if (settings->count != NONE && !settings->overdraw)
        return tool_fail(self, "--count is given without --overdraw, expected both");
    if ((settings->pixel && read_pixel(self, settings->pixel, &asked)) ||
        tool_check_picture(self, settings->overdraw) || tool_check_output(self, settings->json))
        return STATUS_BAD;
    return inspect(self, settings, operands->value[0], &asked);
}

static const struct settings defaults = {.draw = NONE, .count = NONE};

static const struct option options[] = {
    {"draw", "N", "show the state at this draw of the frame, from 0", OPTION_IS_NUMBER(struct settings, draw),
     .most = OPTION_STREAM_MAXIMUM},
    OPTION_FRAME(struct settings, frame),
    {"pixel", "X,Y", "show the history of this pixel", OPTION_IS_TEXT(struct settings, pixel)},
    {"overdraw", "FILE", "draw how often each pixel is covered as a heat map, a PNG",
     OPTION_IS_FILE(struct settings, overdraw), .extension = "png"},
    {"count", "WHAT", "what --overdraw counts: pixels covered, shaded or passed; covered",
     OPTION_IS_INDEX(struct settings, count), .words = what_at},
    OPTION_SET(struct settings, set),
    {"json", "FILE", "also write the report to FILE", OPTION_IS_FILE(struct settings, json),
     .extension = "json"},
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream", .kind = OPERAND_INPUT, .extension = "tri trib"},
    {0},
};

const struct command command_inspect = {
    .name = "inspect",
    .summary = "show the state at a draw, the history of a pixel, overdraw",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
