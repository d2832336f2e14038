/* `triptych convert`: rewrites a stream. The first bytes of the input determine its form; the extension of
 * the output's name determines the other. */
#include "command/container/container.h"
#include "command/support/option.h"

#include <stdio.h>
#include <string.h>

static const struct form {
    const char *extension;
    int (*save)(const struct stream *stream, const char *path, struct error *error);
} forms[] = {
    {".tri", stream_save},     /* canonical text */
    {".trib", container_save}, /* container */
};

static const struct form *find_form(const struct command *self, const char *path)
{
    char known[64] = "";
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        if (dot && !strcmp(dot, forms[i].extension))
            return forms + i;
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i ? " or " : "",
                 forms[i].extension);
    }
    return tool_fail(self, "%s: unknown kind of stream, expected %s", path, known), NULL;
}

struct settings {
    bool salvage;
};

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    const char *input = operands->value[0], *output = operands->value[1];
    const struct form *to = find_form(self, output);
    if (!to || tool_check_output(self, output))
        return STATUS_BAD;
    struct stream *stream;
    struct error error = {""};
    if (settings->salvage ? container_read(input, CONTAINER_SALVAGE, &stream, &error)
                          : stream_read(input, &stream, &error))
        return tool_fail(self, "%s", error.text);
    int bad = to->save(stream, output, &error);
    stream_free(stream);
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

static const struct option options[] = {
    {"salvage", NULL, "keep the complete frames before the damage in a container",
     OPTION_IS_FLAG(struct settings, salvage)},
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
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
