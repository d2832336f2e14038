/* Questions about a frame. */
#ifndef COMMAND_INSPECT_QUESTION_H
#define COMMAND_INSPECT_QUESTION_H

#include "setting/setting.h"

#include <stdbool.h>
#include <stdint.h>

/* When a pixel is counted: for each primitive that covers any of its samples, that is shaded there, or that
 * passes all tests. */
enum watch_what { WATCH_COVERED, WATCH_SHADED, WATCH_PASSED };

enum { TRAIL_LAST = UINT32_MAX };

/* The primitive that a pixel shows: the last that passed there and wrote colours. */
struct watch_owner {
    uint32_t draw; /* of the frame, and 1; 0: none */
    uint32_t primitive;
};

struct trail_options {
    uint32_t frame, draw; /* from 0, the draw within the frame; TRAIL_LAST: the frame's last */
    int32_t x, y;         /* the pixel; x < 0: none */
    bool counts;          /* pixels are counted */
    bool owners;          /* the primitive that each pixel shows is noted */
    enum watch_what what; /* when */
    struct setting_values settings;
};

#endif
