/* Questions about a frame. */
#ifndef COMMAND_INSPECT_QUESTION_H
#define COMMAND_INSPECT_QUESTION_H

#include <stdbool.h>
#include <stdint.h>

/* When a pixel is counted: for each primitive that covers any of its samples, that is shaded there, or that
 * passes all tests. */
enum watch_what { WATCH_COVERED, WATCH_SHADED, WATCH_PASSED };

enum { TRAIL_LAST = UINT32_MAX };

struct trail_options {
    uint32_t frame, draw; /* from 0, the draw within the frame; TRAIL_LAST: the frame's last */
    int32_t x, y;         /* the pixel; x < 0: none */
    bool counts;          /* pixels are counted */
    enum watch_what what; /* when */
};

#endif
