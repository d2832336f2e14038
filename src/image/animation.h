/* Animations: pictures of one size that are shown for equal times, written one after the other.
 *
 * - APNG (Animated PNG, PNG specification third edition, section 11.3.6): exact colours and alpha; endless.
 * - Y4M (YUV4MPEG2, mjpegtools' yuv4mpeg(5)): uncompressed; Y'CbCr of BT.601 in the limited range, without
 *   subsampling (C444), without alpha.
 *
 * Functions that return int return 0, or -1 with a reason that begins with the path. The file is written like
 * those of base/file.h: whole or not at all, or directly to standard output. */
#ifndef IMAGE_ANIMATION_H
#define IMAGE_ANIMATION_H

#include "base/file.h"

#include <stdint.h>

enum animation_form { ANIMATION_APNG, ANIMATION_Y4M };

enum { ANIMATION_RATE_MAXIMUM = 1000, ANIMATION_FRAMES_MAXIMUM = 65536 };

struct animation {
    const char *path;
    enum animation_form form;
    unsigned frames, rate; /* the number of frames in all, and how many are shown in a second */
    unsigned level;        /* of APNG (image/png.h); may be changed after animation_begin */
    unsigned added;
    unsigned width, height; /* of the first frame, which all others must have */
    uint32_t sequence;      /* of APNG: the number of the next chunk */
    uint8_t *planes;        /* of Y4M: one frame */
    struct file_output output;
};

/* `path` must remain valid. After a failure, nothing has to be discarded. */
int animation_begin(struct animation *animation, enum animation_form form, const char *path, unsigned frames,
                    unsigned rate, struct error *error);

/* Adds a frame of RGBA8 words (image/png.h). After a failure, call animation_discard. */
int animation_add(struct animation *animation, unsigned width, unsigned height, const uint32_t *rgba,
                  struct error *error);

/* Finishes the file after all its frames. A failure discards it. */
int animation_end(struct animation *animation, struct error *error);
void animation_discard(struct animation *animation);

#endif
