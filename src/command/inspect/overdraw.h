/* The heat map of overdraw: a picture of how often each pixel was counted. */
#ifndef COMMAND_INSPECT_OVERDRAW_H
#define COMMAND_INSPECT_OVERDRAW_H

#include <cjson/cJSON.h>
#include <stdint.h>

/* The colour of a count as an RGBA8 word: black for 0, then from blue over green and red to white. */
uint32_t overdraw_color(uint32_t count);

/* "pixels", "counted", "most", "mean" (over pixels with any), and "rows": for each colour of the picture the
 * least and the most count with this colour, the number of such pixels and the colour. */
cJSON *overdraw_report(const uint32_t *count, unsigned width, unsigned height);

/* Prints it as text for people. */
void overdraw_print(const cJSON *report);

#endif
