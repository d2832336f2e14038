#include "tool/json.h"
#include "base/file.h"

#include <string.h>

int json_write(const struct command *self, const cJSON *json, const char *path)
{
    struct error error = {""};
    char *text = cJSON_Print(json);
    if (!text)
        return fail(self, "no memory for %s", path);
    size_t length = strlen(text);
    text[length] = '\n'; /* in place of the zero byte: files of text end with a line's end */
    int bad = file_write(path, text, length + 1, &error);
    cJSON_free(text);
    return bad ? fail(self, "%s", error.text) : STATUS_OK;
}
