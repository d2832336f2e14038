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

int command_compare(const struct command *self, int count, char **arguments)
{
    const char *painting = NULL;
    const struct option options[] = {
        {"difference", "FILE.png", "picture to write of the differences, in red", OPTION_TEXT, &painting, 0,
         0},
    };
    struct operands operands = {.least = 2, .most = 2};
    enum options_result result = options_read(self, options, 1, NULL, count, arguments, &operands);
    if (result != OPTIONS_GO)
        return options_status(result);

    struct error error = {""};
    struct picture picture[2] = {{0}};
    uint32_t *rgba[2] = {NULL, NULL};
    int status = STATUS_OK;
    for (int i = 0; i < 2 && !status; i++) {
        if (png_load(operands.value[i], &picture[i].width, &picture[i].height, &rgba[i], &error))
            status = tool_fail(self, "%s", error.text);
        picture[i].color = rgba[i];
    }
    if (!status)
        status = report(self, operands.value, picture, painting);
    free(rgba[0]);
    free(rgba[1]);
    return status;
}
