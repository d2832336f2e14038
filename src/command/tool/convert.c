/* `triptych convert`: rewrites a stream. The first bytes of the input determine its form; the extension of
 * the output's name determines the other. */
#include "base/file.h"
#include "command/container/container.h"
#include "command/support/option.h"
#include "command/support/shared.h"
#include "command/store/store.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { FORM_BY_NAME = 0xffff };

struct settings {
    bool salvage, no_cache;
    unsigned form;
};

static const struct form {
    const char *name; /* its extension is the same */
    int (*save)(const struct stream *stream, const char *path, struct error *error);
} forms[] = {
    {"tri", stream_save},     /* canonical text */
    {"trib", container_save}, /* container */
};

enum { FORMS = sizeof forms / sizeof *forms };

static const char *form_at(unsigned index)
{
    return index < FORMS ? forms[index].name : NULL;
}

/* Standard output has no extension: its default is the first form. */
static const struct form *find_form(const struct command *self, const char *path, unsigned form)
{
    const char *dot = strrchr(path, '.');
    char suggestion[WORDS_SUGGESTION] = "";
    if (form == FORM_BY_NAME && file_is_standard(path))
        form = 0;
    if (form != FORM_BY_NAME || (dot && words_find(WORDS_OF_ROWS(forms), dot + 1, strlen(dot + 1), &form)))
        return forms + form;
    if (dot)
        words_suggest(WORDS_OF_ROWS(forms), dot + 1, strlen(dot + 1), suggestion);
    return tool_fail(self, "%s: unknown kind of stream, expected .tri or .trib%s", path, suggestion), NULL;
}

static int check_output(const struct command *self, const char *path, const struct form *form)
{
    if (!strcmp(path, file_standard_output) && form->save == container_save && isatty(STDOUT_FILENO))
        return tool_fail(self,
                         "OUTPUT is \"-\", expected a file or a pipe: a container is not for a terminal");
    return tool_check_output(self, path);
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    const char *input = operands->value[0], *output = operands->value[1];
    store_off |= settings->no_cache;
    const struct form *to = find_form(self, output, settings->form);
    if (!to || check_output(self, output, to))
        return STATUS_BAD;
    struct stream *stream;
    struct error error = {""};
    tool_progress("reading %s", input);
    if (settings->salvage ? container_read(input, CONTAINER_SALVAGE, &stream, &error)
                          : stream_read(input, &stream, &error))
        return tool_fail(self, "%s", error.text);
    tool_progress("writing %s", output);
    int bad = to->save(stream, output, &error);
    tool_progress(NULL);
    if (settings->salvage && !bad)
        printf("%u frame%s kept\n", stream->frame_count, stream->frame_count == 1 ? "" : "s");
    stream_free(stream);
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

static const struct settings defaults = {.form = FORM_BY_NAME};

static const struct option options[] = {
    {"format", "FORM", "tri or trib; that of the extension of OUTPUT, tri for -",
     OPTION_IS_INDEX(struct settings, form), .words = form_at},
    {"salvage", NULL, "keep the complete frames before the damage in a container",
     OPTION_IS_FLAG(struct settings, salvage)},
    OPTION_NO_CACHE(struct settings, no_cache),
    {0},
};

static const struct operand operands[] = {
    {"INPUT", "a draw stream in any form", .kind = OPERAND_INPUT, .extension = "tri trib"},
    {"OUTPUT", "FILE.tri: canonical text; FILE.trib: a container", .kind = OPERAND_OUTPUT,
     .extension = "tri trib"},
    {0},
};

const struct command command_convert = {
    .name = "convert",
    .summary = "rewrite a stream in another form",
    .options = options,
    .operands = operands,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
