/* Differences of pictures, told and shown. */
#ifndef TOOL_DIFFERENCE_H
#define TOOL_DIFFERENCE_H

#include "base/compare.h"
#include "tool/tool.h"

enum { DIFFERENCE_TEXT = 320 };

/* One sentence: where the first differing pixel is, its values in both pictures, how many differ and how
 * much. */
char *difference_describe(const struct picture *picture, const struct difference *difference,
                          char text[DIFFERENCE_TEXT]);

/* Writes the picture of the difference (base/compare.h) as a PNG. Returns 0, or STATUS_BAD after telling why.
 */
int difference_save(const struct command *self, const char *path, const struct picture *first,
                    const struct picture *second);

#endif
