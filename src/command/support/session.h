/* A device that plays one stream frame by frame, and copies of the targets that it drew. */
#ifndef COMMAND_SUPPORT_SESSION_H
#define COMMAND_SUPPORT_SESSION_H

#include "image/compare.h"
#include "command/stream/stream.h"
#include "command/support/tool.h"
#include "contract/key.h"
#include "setting/setting.h"

#include <stdbool.h>

/* Reads and checks a stream. Returns null after printing the reason. */
struct stream *session_load(const struct command *self, const char *path);

/* The same for a stream whose frames are played in order. Frames of a recording are read while they are
 * played; the stream in memory has only their number (command/container/reader.h). */
struct stream *session_load_frames(const struct command *self, const char *path);

/* A zero session is closed. The stream must outlive the session. */
struct session {
    const struct command *self;
    const struct stream *stream;
    triptych_device *device;
    struct player *player;
    bool told; /* the warning about TRIPTYCH_DEBUG was printed */
};

/* Opens a session with the engine of that number (triptych_engine_name) and settings of the renderer; null:
 * the defaults. Functions that return int return 0,
 * or STATUS_BAD after printing the reason. A session must be closed even after a failure. */
int session_open(const struct command *self, const struct stream *stream, unsigned engine, unsigned threads,
                 const struct setting_values *settings, struct session *session);
/* The same with routine calls measured if `measure` is true (struct triptych_options). */
int session_open_measured(const struct command *self, const struct stream *stream, unsigned engine,
                          unsigned threads, const struct setting_values *settings, bool measure,
                          struct session *session);
void session_close(struct session *session);

/* Plays a frame, numbered from 0, and waits until it is drawn. */
int session_play(const struct command *self, struct session *session, unsigned frame);

/* Sets the states that the frame begins with, so that a following session_play executes only its calls. A
 * measurement of a frame begins after it. */
int session_seek(const struct command *self, struct session *session, unsigned frame);

/* Finds a draw of a frame, both numbered from 0: its position in `executed`. Returns 0, or STATUS_BAD after
 * printing the reason (draw.c). */
int session_find_draw(const struct command *self, const struct stream *stream, unsigned frame, unsigned draw,
                      uint32_t *position);

/* The key of a unit's routine at the draw of that position, in a device with the engine of that number. The
 * program of a shader in the key is valid until the stream is freed. Returns 0, or STATUS_BAD after
 * printing the reason. */
int session_read_key(const struct command *self, const struct stream *stream, uint32_t draw, unsigned engine,
                     const struct setting_values *settings, enum unit unit, union key *key);

/* The i-th of `count` frames spread evenly over `all` frames, the first and the last included. */
unsigned session_spread(unsigned i, unsigned count, unsigned all);

/* Returns true if row 0 of the target is the lower one of the picture, by the device's present convention
 * windoworigin. */
bool session_is_lower(struct triptych_device *device);

/* A copy of a device's target, or of all its samples, stored as one image below the other. A zero readback is
 * empty. Memory is reused from one readback to the next. */
struct readback {
    unsigned width, height;
    bool has_depth, has_stencil;
    uint32_t *color;
    float *depth;
    uint8_t *stencil;
    float *numbers;   /* four per pixel and target, if RGBA8 does not hold them exactly; else null */
    unsigned targets; /* the number of targets in `numbers` */
    size_t capacity;  /* in pixels, of all arrays but `numbers` */
    struct query_count *queries;
    unsigned query_count;
};

/* Colours of pixels; or also depth and stencil; or all of them for each sample. Pixels are those of the
 * picture, from its upper row on. Samples are those of the target, from row 0 on. */
enum readback_what { READBACK_COLORS, READBACK_PIXELS, READBACK_SAMPLES };
int readback_take(const struct command *self, const struct session *session, enum readback_what what,
                  struct readback *readback);
void readback_free(struct readback *readback);
struct picture readback_picture(const struct readback *readback);

#endif
