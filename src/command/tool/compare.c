/* `triptych compare`: two PNG pictures, pixel by pixel. */
#include "image/png.h"
#include "command/support/difference.h"
#include "command/support/option.h"

#include <stdio.h>
#include <stdlib.h>

static int report(const struct command *self, char **paths, const struct picture picture[2],
                  const char *painting)
{
    if (picture[0].width != picture[1].width || picture[0].height != picture[1].height) {
        printf("different sizes: %s is %u x %u, %s is %u x %u\n", paths[0], picture[0].width,
               picture[0].height, paths[1], picture[1].width, picture[1].height);
        return STATUS_DIFFERENT;
    }
    struct difference difference;
    if (!compare_pictures(picture, picture + 1, &difference)) {
        puts("identical");
        return STATUS_OK;
    }
    char text[DIFFERENCE_TEXT];
    printf("different: %s\n", difference_describe(picture, &difference, text));
    return painting && difference_save(self, painting, picture, picture + 1) ? STATUS_BAD : STATUS_DIFFERENT;
}

struct settings {
    const char *painting;
};

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    struct error error = {""};
    struct picture picture[2] = {{0}};
    uint32_t *rgba[2] = {NULL, NULL};
    int status = STATUS_OK;
    for (int i = 0; i < 2 && !status; i++) {
        if (png_load(operands->value[i], &picture[i].width, &picture[i].height, &rgba[i], &error))
            status = tool_fail(self, "%s", error.text);
        picture[i].color = rgba[i];
    }
    if (!status)
        status = report(self, operands->value, picture, settings->painting);
    free(rgba[0]);
    free(rgba[1]);
    return status;
}

static const struct option options[] = {
    {"difference", "FILE.png", "picture to write of the differences, in red",
     OPTION_IS_FILE(struct settings, painting), .extension = "png"},
    {0},
};

static const struct operand operands[] = {
    {"FIRST", "a PNG picture", .kind = OPERAND_INPUT, .extension = "png"},
    {"SECOND", "a PNG picture", .kind = OPERAND_INPUT, .extension = "png"},
    {0},
};

const struct command command_compare = {
    .name = "compare",
    .summary = "compare two pictures pixel by pixel",
    .options = options,
    .operands = operands,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
