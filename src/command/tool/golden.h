/* Golden pictures: the first target of a frame compared with a picture in a folder.
 *
 * The golden of frame N of the stream NAME is NAME-N.png, or for frame 0 also NAME.png. Frame 0 must have
 * one; other frames are compared if they have one. */
#ifndef COMMAND_TOOL_GOLDEN_H
#define COMMAND_TOOL_GOLDEN_H

#include "command/support/json.h"
#include "command/support/session.h"

/* A zero member means the default: no tolerance, no pictures of differences, no update, no report. */
struct golden {
    const char *folder;
    const char *differences; /* the folder for pictures of differences */
    unsigned tolerance;      /* the difference of a channel that is allowed */
    bool update;             /* write the pictures instead */
    unsigned compression;    /* of pictures that are written (image/png.h) */
    struct readback readback;
    unsigned compared, different, written; /* so far */
};

/* Compares the frame that the session drew last. `single` is true if it is the only one of its stream that is
 * drawn. Prints a line if it differs or if its golden is missing, and adds to `report` unless it is null.
 * Returns 0, or STATUS_BAD after printing the reason. */
int golden_check(const struct command *self, struct golden *golden, const struct session *session,
                 const char *name, unsigned frame, bool single, cJSON *report);

#endif
