/* Differences of pictures, as a sentence and as a picture. */
#ifndef COMMAND_SUPPORT_DIFFERENCE_H
#define COMMAND_SUPPORT_DIFFERENCE_H

#include "image/compare.h"
#include "command/support/tool.h"

enum { DIFFERENCE_TEXT = 320 };

/* Describes the difference in one sentence: the position of the first differing pixel, its values in both
 * pictures, the number of pixels that differ, and the largest distance. */
char *difference_describe(const struct picture *picture, const struct difference *difference,
                          char text[DIFFERENCE_TEXT]);

/* Writes a picture of the differences (image/compare.h) as a PNG of that level of compression (image/png.h).
 * Returns 0, or STATUS_BAD after printing the reason. */
int difference_save(const struct command *self, const char *path, const struct picture *first,
                    const struct picture *second, unsigned compression);

#endif
