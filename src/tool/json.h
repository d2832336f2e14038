/* JSON reports as files. */
#ifndef TOOL_JSON_H
#define TOOL_JSON_H

#include "tool/tool.h"

#include <cjson/cJSON.h>

/* Writes the value, formatted, whole or not at all. Returns 0, or STATUS_BAD after telling why. */
int json_write(const struct command *self, const cJSON *json, const char *path);

#endif
