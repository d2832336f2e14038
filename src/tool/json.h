/* JSON reports, whole or not at all.
 *
 * cJSON tells of refused memory at every step; nobody asks it. Instead its memory comes from here: once a request was
 * refused no report is complete any more (tool.h), so none is written, and what hangs on nothing is freed at the end. */
#ifndef TOOL_JSON_H
#define TOOL_JSON_H

#include "tool/tool.h"

#include <cjson/cJSON.h>

/* From here on cJSON's memory is ours; until json_end, which frees all that is left of it. */
void json_begin(void);
void json_end(void);

/* The value's text, formatted, to be freed with cJSON_free; null after telling that memory is short. */
char *json_text(const struct command *self, const cJSON *json);

/* Writes the value, formatted, whole or not at all. Returns 0, or STATUS_BAD after telling why. */
int json_write(const struct command *self, const cJSON *json, const char *path);

#endif
