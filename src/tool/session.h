/* A device with one stream on it, frame by frame, and what it drew. */
#ifndef TOOL_SESSION_H
#define TOOL_SESSION_H

#include "base/compare.h"
#include "stream/stream.h"
#include "tool/tool.h"

#include <stdbool.h>

/* Reads and checks a stream. Null after telling what is wrong with it. */
struct stream *session_load(const struct command *self, const char *path);

/* The same of a stream whose frames are played in their order: of a recording they are read as they are played, and the
 * stream has no more than their number (stream/reader.h). */
struct stream *session_load_frames(const struct command *self, const char *path);

/* Zero is a closed session. The stream must outlive it. */
struct session {
    const struct command *self;
    const struct stream *stream;
    triptych_device *device;
    struct player *player;
    bool told; /* what of TRIPTYCH_DEBUG cannot be done */
};

/* Opens a session with the engine of that number (triptych_engine_name). The functions that return an int
 * return 0, or STATUS_BAD after telling why; a session that failed is still to be closed. */
int session_open(const struct command *self, const struct stream *stream, unsigned engine, unsigned threads,
                 struct session *session);
/* The same with the calls of routines measured (struct triptych_options). */
int session_open_measured(const struct command *self, const struct stream *stream, unsigned engine,
                          unsigned threads, bool measure, struct session *session);
void session_close(struct session *session);

/* Plays a frame (from 0) and waits until it is drawn. */
int session_play(const struct command *self, struct session *session, unsigned frame);

/* The i-th of `count` frames spread evenly over `all`, the first and the last among them. */
unsigned session_spread(unsigned i, unsigned count, unsigned all);

/* A copy of a device's target, or of all its samples one below the other. Zero is empty; memory is kept from
 * one reading to the next. */
struct capture {
    unsigned width, height;
    bool has_depth, has_stencil;
    uint32_t *color;
    float *depth;
    uint8_t *stencil;
    float *numbers;   /* four a pixel and target where RGBA8 does not say it all; else null */
    unsigned targets; /* of those numbers */
    size_t capacity;  /* pixels, of all but the numbers */
    struct query_count *queries;
    unsigned query_count;
};

enum capture_what { CAPTURE_PIXELS, CAPTURE_SAMPLES };
int capture_read(const struct command *self, const struct session *session, enum capture_what what,
                 struct capture *capture);
void capture_free(struct capture *capture);
struct picture capture_picture(const struct capture *capture);

#endif
