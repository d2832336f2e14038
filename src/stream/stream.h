/* Draw streams: calls of the interface (triptych.h) as data, read from text, played on any device, written
 * back.
 *
 *   text --stream_read--> struct stream --stream_prepare--> struct player --player_frame--> pictures
 *
 * A stream that has been read is whole and checked: its assets are loaded, its sequences expanded, every draw
 * lies inside what is bound. Reading has no effect on any device. docs/streams.md is the reference of the
 * text.
 *
 * Layout: `resources` and `calls` stand in the order of the text; a sequence is a CALL_SEQUENCE followed by
 * its calls. `executed` lists the calls' numbers in the order in which they are executed, with the plays
 * replaced by what they play and without frames and sequences themselves; frame f is executed[frames[f]] to
 * executed[frames[f + 1] - 1].
 *
 * Functions that return int return 0, or -1 with one line of reason in `error`. */
#ifndef STREAM_STREAM_H
#define STREAM_STREAM_H

#include "base/error.h"
#include "container/call.h"

#include <stddef.h>
#include <stdint.h>

struct player;

enum stream_limit {
#define LIMIT(name, value, what) LIMIT_##name = value,
#include "stream/limit.def"
#undef LIMIT
};

struct stream {
    char *path;    /* of the file; empty when parsed from memory without one */
    int container; /* it comes from one: places are in that */
    int streamed; /* it has no more than its number of frames: resources and calls are read from `descriptor` as
                      they are played (stream/reader.h) */
    int descriptor;
    struct resource *resources;
    uint32_t resource_count;
    struct call *calls;
    uint32_t call_count;
    uint32_t *executed;
    uint32_t executed_count;
    uint32_t *frames; /* frame_count + 1 positions in `executed` */
    uint32_t frame_count;
};

/* The declaration that a CALL_DECLARE makes; returns how many elements. */
unsigned stream_declaration(const struct call *call,
                            struct triptych_declaration_element elements[TRIPTYCH_DECLARATION_ELEMENTS]);

/* What declares elements of vertices that lie in stream 0; returns how many, or 0 if all of them are attributes, which
 * need no stream of that number. */
unsigned stream_declare_layout(const struct layout *layout,
                               struct triptych_declaration_element elements[STREAM_ELEMENTS]);

/* The word of the element with that usage: an attribute's, or one like "color.5"; valid until the next call by this
 * thread. */
const char *stream_element_word(unsigned usage, unsigned usage_index);

/* The constants that a CALL_CONSTANT_MATRIX makes of the transforms, of which there are TRIPTYCH_TRANSFORM_COUNT.
 * Returns 0, or -1 if a number is not finite, as where there is no inverse. */
int stream_constants(const struct call *call, const float (*transforms)[4][4],
                     float constants[CONSTANTS_PER_CALL][4]);

/* The bytes that an attribute can lie in: those of the vertices, or of a buffer of any type. */
const void *resource_data(const struct resource *resource, size_t *bytes);

/* Reads a stream, text and the files it names or a container (stream/container.h). On failure *stream is null and the reason is FILE:LINE:COLUMN: what
 * was found, what was expected. */
int stream_read(const char *path, struct stream **stream, struct error *error);

/* The same of a text in memory; `path` is the name in reasons, and its folder is where asset paths begin. */
int stream_parse(const char *path, const char *text, size_t bytes, struct stream **stream,
                 struct error *error);

/* Null is allowed. */
void stream_free(struct stream *stream);

/* Canonical text, which reads as the same stream; the caller frees *text. `path` is the file it is meant for:
 * paths of assets are changed to begin at its folder. */
int stream_write(const struct stream *stream, const char *path, char **text, size_t *bytes,
                 struct error *error);

/* stream_write to the file, whole or not at all. */
int stream_save(const struct stream *stream, const char *path, struct error *error);

/* Creates the stream's resources on the device, which then should not be used otherwise until the player is
 * freed, except to read pictures and counters. The stream and the device must outlive the player. Calls
 * nothing else. */
int stream_prepare(const struct stream *stream, triptych_device *device, struct player **player,
                   struct error *error);

/* Null is allowed. Frees the stream's resources on the device too. */
void player_free(struct player *player);

/* Plays frame `frame` (0 to frame_count - 1) and finishes it (triptych_finish). After frame - 1 that executes
 * the frame's calls; otherwise the states, bindings and targets of all earlier frames are executed first,
 * from the defaults on, without their draws and clears. */
int player_frame(struct player *player, uint32_t frame, struct error *error);

/* Executes a frame's calls, whichever frame it is, on what the one that was played last left, and finishes it: nothing is
 * executed besides them. Not of a recording. */
int player_go_on(struct player *player, uint32_t frame, struct error *error);

/* What a query counted in the frame that was played last. */
struct query_count {
    const char *name; /* the stream's */
    uint64_t passed;
};

/* The i-th of the queries that ended in that frame, in the order of their definitions. Returns 0 past the
 * last. */
int player_query(struct player *player, uint32_t i, struct query_count *count);

/* Called after each frame; a result that is not 0 stops playing, and stream_play returns it. */
typedef int frame_callback(void *user, uint32_t frame, triptych_device *device, struct error *error);

/* Prepares and plays frames `first` to `last`. `callback` may be null. */
int stream_play(const struct stream *stream, triptych_device *device, uint32_t first, uint32_t last,
                frame_callback *callback, void *user, struct error *error);

#endif
