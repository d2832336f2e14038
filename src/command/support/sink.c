#include "command/support/sink.h"
#include "base/file.h"
#include "image/exr.h"
#include "image/png.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CHANNELS = 4, COLORS = CHANNELS * TRIPTYCH_TARGETS, NAME_CAPACITY = 24, PATH_CAPACITY = 4096 };

/* --- Pictures as single files --------------------------------------------------------------------------- */

static int save_png(const char *path, const struct readback *readback, unsigned compression,
                    struct error *error)
{
    return png_save_level(path, readback->width, readback->height, readback->color, compression, error);
}

/* Bytes become numbers from 0 to 1 in binary16, from which they can be recovered. Numbers and depth keep
 * their 32 bits. Names of channels of targets after the first begin with the target's number. */
static size_t color_channels(const struct readback *readback, const float *values,
                             struct exr_channel channels[COLORS], char names[COLORS][NAME_CAPACITY])
{
    static const char letters[] = "RGBA";
    unsigned targets = readback->numbers ? readback->targets : 1, count = targets * CHANNELS;
    for (unsigned i = 0; i < count; i++) {
        if (i < CHANNELS)
            snprintf(names[i], NAME_CAPACITY, "%c", letters[i]);
        else
            snprintf(names[i], NAME_CAPACITY, "target%u.%c", i / CHANNELS, letters[i % CHANNELS]);
        channels[i] =
            (struct exr_channel){names[i], values + i, count, readback->numbers ? EXR_FLOAT : EXR_HALF};
    }
    return count;
}

/* Stencil is a channel of numbers from 0 to 255. */
static int save_exr(const char *path, const struct readback *readback, unsigned compression,
                    struct error *error)
{
    (void)compression; /* is of PNG */
    size_t pixels = (size_t)readback->width * readback->height;
    float *values = malloc(pixels * (CHANNELS + 1) * sizeof *values);
    if (!values)
        return error_set(error, "%s: no memory for %zu pixels", path, pixels);
    for (size_t i = 0; i < pixels; i++)
        for (unsigned channel = 0; channel < CHANNELS; channel++)
            values[i * CHANNELS + channel] = (float)(readback->color[i] >> 8 * channel & 255) / 255;
    struct exr_channel channels[COLORS + 2];
    char names[COLORS][NAME_CAPACITY];
    size_t count = color_channels(readback, readback->numbers ? readback->numbers : values, channels, names);
    if (readback->has_depth)
        channels[count++] = (struct exr_channel){"Z", readback->depth, 1, EXR_FLOAT};
    float *stencil = values + pixels * CHANNELS;
    for (size_t i = 0; i < pixels && readback->has_stencil; i++)
        stencil[i] = readback->stencil[i];
    if (readback->has_stencil)
        channels[count++] = (struct exr_channel){"stencil", stencil, 1, EXR_HALF};
    int bad = exr_save(path, readback->width, readback->height, channels, count, error);
    free(values);
    return bad;
}

/* --- Forms ---------------------------------------------------------------------------------------------- */

/* `save` writes one picture; without it, the form holds all. */
static const struct sink_form {
    const char *name; /* its extension is the same */
    int (*save)(const char *path, const struct readback *readback, unsigned compression, struct error *error);
    enum animation_form animation;
} forms[] = {
    {"png", save_png, 0}, /* colour and alpha */
    {"exr", save_exr, 0}, /* colour, alpha, depth, stencil */
    {"apng", NULL, ANIMATION_APNG},
    {"y4m", NULL, ANIMATION_Y4M},
};

enum { FORMS = sizeof forms / sizeof *forms };

const char *sink_form_name(unsigned index)
{
    return index < FORMS ? forms[index].name : NULL;
}

/* Standard output has no extension: its default is the first form. */
static int choose_form(struct sink *sink)
{
    const struct sink_options *options = &sink->options;
    const char *dot = strrchr(options->path, '.');
    unsigned index = options->form;
    if (index == SINK_BY_NAME && file_is_standard(options->path))
        index = 0;
    if (index == SINK_BY_NAME &&
        (!dot || !words_find(WORDS_OF_ROWS(forms), dot + 1, strlen(dot + 1), &index))) {
        char suggestion[WORDS_SUGGESTION] = "";
        if (dot)
            words_suggest(WORDS_OF_ROWS(forms), dot + 1, strlen(dot + 1), suggestion);
        return tool_fail(sink->self, "%s: unknown kind of picture, expected .png, .exr, .apng or .y4m%s",
                         options->path, suggestion);
    }
    sink->form = forms + index;
    if (options->rate && sink->form->save)
        return tool_fail(sink->self, "--rate is given for a picture, expected an animation: .apng or .y4m");
    if (options->columns && !(sink->form == forms))
        return tool_fail(sink->self, "%s: a contact sheet is a PNG picture, expected .png", options->path);
    return STATUS_OK;
}

/* --- Names ---------------------------------------------------------------------------------------------- */

/* Finds the number in the path: its position, its length, and its width. Returns 0 if there is none, 1 if
 * there is one, and -1 if the path has another % as well. */
static int find_number(const char *path, size_t *at, size_t *length, unsigned *width, bool *zeros)
{
    enum { DIGITS = 2 };
    const char *percent = strchr(path, '%'), *end = percent + 1;
    if (!percent)
        return 0;
    *zeros = *end == '0';
    for (*width = 0; isdigit((unsigned char)*end); end++)
        *width = *width * 10 + (unsigned)(*end - '0');
    *at = (size_t)(percent - path);
    *length = (size_t)(end + 1 - percent);
    return *end == 'd' && *length <= 2 + 1 + DIGITS && !strchr(end, '%') ? 1 : -1;
}

static int name_picture(const struct sink *sink, unsigned number, char name[PATH_CAPACITY],
                        struct error *error)
{
    const char *path = sink->options.path;
    size_t at = 0, length = 0;
    unsigned width = 0;
    bool zeros = false;
    int digits;
    if (!sink->options.numbered || !find_number(path, &at, &length, &width, &zeros))
        digits = snprintf(name, PATH_CAPACITY, "%s", path);
    else
        digits = snprintf(name, PATH_CAPACITY, zeros ? "%.*s%0*u%s" : "%.*s%*u%s", (int)at, path, (int)width,
                          number, path + at + length);
    return digits < PATH_CAPACITY ? 0 : error_set(error, "%s: is too long a path", path);
}

/* Several files need a number in their name. One file must not have one. */
static int check_name(const struct sink *sink)
{
    const struct sink_options *options = &sink->options;
    bool single = options->columns || !sink->form->save;
    size_t at, length;
    unsigned width;
    bool zeros;
    int numbers = options->numbered ? find_number(options->path, &at, &length, &width, &zeros) : 0;
    if (numbers < 0)
        return tool_fail(sink->self,
                         "--out is \"%s\", expected one number of the picture, like %%d or %%04d, and "
                         "no other %%",
                         options->path);
    if (numbers && single)
        return tool_fail(sink->self,
                         "--out is \"%s\", expected a name without %%d: one file has all pictures",
                         options->path);
    if (!numbers && !single && options->count > 1)
        return tool_fail(
            sink->self,
            "--out is \"%s\", expected a name with a number, like f%%04d.png, for %u pictures; or "
            "--sheet, or the form apng or y4m",
            file_is_standard(options->path) ? "-" : options->path, options->count);
    return STATUS_OK;
}

/* --- Files ---------------------------------------------------------------------------------------------- */

static int check_output(const struct sink *sink)
{
    struct error error = {""};
    char name[PATH_CAPACITY];
    if (!strcmp(sink->options.path, file_standard_output) && isatty(STDOUT_FILENO))
        return tool_fail(sink->self,
                         "--out is \"-\", expected a file or a pipe: a picture is not for a terminal");
    if (name_picture(sink, sink->options.first, name, &error))
        return tool_fail(sink->self, "%s", error.text);
    return tool_check_output(sink->self, name);
}

int sink_open(const struct command *self, const struct sink_options *options, struct sink *sink)
{
    struct error error = {""};
    *sink = (struct sink){.self = self, .options = *options};
    if (choose_form(sink) || check_name(sink) || check_output(sink))
        return STATUS_BAD;
    if (options->columns)
        sink->sheet = sheet_create(options->columns, options->count);
    else if (!sink->form->save &&
             animation_begin(&sink->animation, sink->form->animation, options->path, options->count,
                             options->rate ? options->rate : SINK_RATE, &error))
        return tool_fail(self, "%s", error.text);
    sink->animation.level = options->compression;
    return STATUS_OK;
}

enum readback_what sink_needs(const struct sink *sink)
{
    return sink->form->save == save_exr ? READBACK_PIXELS : READBACK_COLORS;
}

static int save_next(struct sink *sink, const struct readback *readback, struct error *error)
{
    char name[PATH_CAPACITY];
    return name_picture(sink, sink->options.first++, name, error) ||
           sink->form->save(name, readback, sink->options.compression, error);
}

int sink_add(struct sink *sink, const struct readback *readback)
{
    struct error error = {""};
    int bad = sink->options.columns
                  ? sheet_add(&sink->sheet, readback->width, readback->height, readback->color, &error)
              : sink->form->save ? save_next(sink, readback, &error)
                                 : animation_add(&sink->animation, readback->width, readback->height,
                                                 readback->color, &error);
    return bad ? tool_fail(sink->self, "%s", error.text) : STATUS_OK;
}

int sink_close(struct sink *sink, int status)
{
    struct error error = {""};
    int bad = 0;
    if (sink->options.columns && !status)
        bad = png_save_level(sink->options.path, sheet_width(&sink->sheet), sheet_height(&sink->sheet),
                             sink->sheet.rgba, sink->options.compression, &error);
    else if (!sink->form->save && !status)
        bad = animation_end(&sink->animation, &error);
    else if (!sink->form->save)
        animation_discard(&sink->animation);
    sheet_free(&sink->sheet);
    return bad ? tool_fail(sink->self, "%s", error.text) : status;
}
