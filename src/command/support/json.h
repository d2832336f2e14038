/* JSON reports: complete, or not written.
 *
 * cJSON reports refused memory at every call; the project does not check each of them. Instead, cJSON
 * allocates from here: after the first refusal the report is marked incomplete (tool.h) and is not written.
 * json_end frees all memory that is left, including values that were never attached. */
#ifndef COMMAND_SUPPORT_JSON_H
#define COMMAND_SUPPORT_JSON_H

#include "command/support/tool.h"

#include <cjson/cJSON.h>

/* From json_begin to json_end, cJSON allocates through this module. json_end frees what is left. */
void json_begin(void);
void json_end(void);

/* The value as formatted text; free it with cJSON_free. Returns null after printing an error if memory is
 * short. */
char *json_text(const struct command *self, const cJSON *json);

/* Writes the value as formatted text, atomically. Returns 0, or STATUS_BAD after printing the reason. */
int json_write(const struct command *self, const cJSON *json, const char *path);

#endif
