/* `triptych convert`: a stream written anew; the forms are known by their files' extensions. */
#include "stream/stream.h"
#include "tool/option.h"

#include <stdio.h>
#include <string.h>

static const struct form {
    const char *extension;
    int (*read)(const char *path, struct stream **stream, struct error *error);
    int (*save)(const struct stream *stream, const char *path, struct error *error);
} forms[] = {
    {".tri", stream_read, stream_save}, /* text; canonical when written */
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
    return fail(self, "%s: unknown kind of stream, expected %s", path, known), NULL;
}

int command_convert(const struct command *self, int count, char **arguments)
{
    struct operands operands = {.least = 2, .most = 2};
    enum options_result result = options_read(self, NULL, 0, NULL, count, arguments, &operands);
    if (result != OPTIONS_GO)
        return options_status(result);
    const char *input = operands.value[0], *output = operands.value[1];
    const struct form *from = find_form(self, input);
    const struct form *to = from ? find_form(self, output) : NULL;
    if (!to)
        return STATUS_BAD;
    struct stream *stream;
    struct error error = {""};
    if (from->read(input, &stream, &error))
        return fail(self, "%s", error.text);
    int bad = to->save(stream, output, &error);
    stream_free(stream);
    return bad ? fail(self, "%s", error.text) : STATUS_OK;
}
