/* Draw streams: calls of the interface (triptych.h) as data. They are read from text or containers, played on
 * any device, and written.
 *
 *   text --stream_read--> struct stream --stream_prepare--> struct player --player_frame--> pictures
 *
 * A stream that was read is complete and checked: its assets are loaded, its sequences are expanded, and
 * every draw is within its bindings. Reading does not use a device. docs/streams.md is the reference of the
 * text.
 *
 * `resources` and `calls` are in the order of the text. A sequence is a CALL_SEQUENCE followed by its calls.
 * `executed` lists the numbers of calls in the order of execution. Plays are replaced by their sequences;
 * frames and sequences are left out. Frame f is executed[frames[f]] to executed[frames[f + 1] - 1].
 *
 * Functions that return int return 0, or -1 with one line of reason in `error`. */
#ifndef COMMAND_STREAM_STREAM_H
#define COMMAND_STREAM_STREAM_H

#include "base/error.h"
#include "capture/call.h"

#include <stddef.h>
#include <stdint.h>

struct player;

enum stream_limit {
#define LIMIT(name, value, what) LIMIT_##name = value,
#include "command/stream/limit.def"
#undef LIMIT
};

struct stream {
    char *path;     /* of the file; a name without a file if parsed from memory */
    bool container; /* it was read from a container */
    /* only the number of frames is known: resources and calls are read from `descriptor` while they are
     * played (command/container/reader.h) */
    bool streamed;
    int descriptor;
    struct resource *resources;
    uint32_t resource_count;
    struct call *calls;
    uint32_t call_count;
    uint32_t *executed;
    uint32_t executed_count;
    uint32_t *frames; /* frame_count + 1 positions in `executed` */
    uint32_t frame_count;
    uint32_t precision; /* the state `precision` at the beginning; commands may change it (--precision) */
};

/* Returns true if the call draws primitives. */
static inline bool stream_is_draw(const struct call *call)
{
    return call->type == CALL_DRAW || call->type == CALL_DRAW_INDEXED || call->type == CALL_DRAW_MESH ||
           call->type == CALL_DRAW_USER || call->type == CALL_DRAW_INDEXED_USER;
}

/* The same for executed[position]. */
static inline bool stream_draws_at(const struct stream *stream, uint32_t position)
{
    return stream_is_draw(&stream->calls[stream->executed[position]]);
}

/* Makes the declaration of a CALL_DECLARE. Returns the number of elements. */
unsigned stream_declaration(const struct call *call,
                            struct triptych_declaration_element elements[TRIPTYCH_DECLARATION_ELEMENTS]);

/* Makes a declaration of vertices in stream 0. Returns the number of elements, or 0 if all are attributes,
 * which need no declaration. */
unsigned stream_declare_layout(const struct layout *layout,
                               struct triptych_declaration_element elements[STREAM_ELEMENTS]);

/* Returns the word of the element with this usage: an attribute's, or one like "color.5". It is valid until
 * the thread's next call. */
const char *stream_element_word(unsigned usage, unsigned usage_index);

/* Computes the constants of a CALL_CONSTANT_MATRIX from the TRIPTYCH_TRANSFORM_COUNT transforms. Returns 0,
 * or -1 if a number is not finite, as when there is no inverse. */
int stream_constants(const struct call *call, const float (*transforms)[4][4],
                     float constants[CONSTANTS_PER_CALL][4]);

/* The columns of a matrix as constants of a shader, as the instruction m4x4 reads them; of its inverse, of
 * its transpose. Changes the matrix. Returns 0, or -1 if a number is not finite. */
int stream_store_columns(double matrix[4][4], bool inverse, bool transposed,
                         float constants[CONSTANTS_PER_CALL][4]);

/* Reads a stream from text, with the files that it names, or from a container
 * (command/container/container.h). On failure *stream is null, and the reason is FILE:LINE:COLUMN, what was
 * found, and what was expected. */
int stream_read(const char *path, struct stream **stream, struct error *error);

/* Reads a stream from memory. `path` is its name in reasons, and paths of assets are relative to its
 * folder. */
int stream_parse(const char *path, const char *text, size_t bytes, struct stream **stream,
                 struct error *error);

/* Sets "PATH:LINE:COLUMN: REASON", or for a call of a container "PATH: offset N (byte B, CALL): REASON".
 * Returns -1. */
int stream_fail(const struct stream *stream, const struct call *call, const char *reason,
                struct error *error);

/* Null is allowed. */
void stream_free(struct stream *stream);

/* Writes canonical text, which is read as the same stream. The caller frees *text. Paths of assets are
 * changed to begin at the folder of `path`, the intended file. For tests: text in memory. */
int stream_write(const struct stream *stream, const char *path, char **text, size_t *bytes,
                 struct error *error);

/* Returns the canonical line of a call, without its end, which the caller frees; null if memory is short. */
char *stream_write_call(const struct stream *stream, const struct call *call);

/* stream_write to the file, whole or not at all. */
int stream_save(const struct stream *stream, const char *path, struct error *error);

/* Creates the stream's resources on the device. Until the player is freed, the device must not be used
 * otherwise, except to read pictures and counters. The stream and the device must outlive the player. */
int stream_prepare(const struct stream *stream, triptych_device *device, struct player **player,
                   struct error *error);

/* Null is allowed. Frees the stream's resources on the device too. */
void player_free(struct player *player);

/* Plays frame `frame`, 0 to frame_count - 1, and ends it (triptych_end_frame). If the previous call played
 * frame - 1, only the calls of the frame are executed. Otherwise the states, bindings and targets of all
 * earlier frames are executed first, from the defaults on, without draws and clears. */
int player_frame(struct player *player, uint32_t frame, struct error *error);

/* Executes what player_frame would before the calls of this frame, so that a following player_frame executes
 * only these. Has no effect for recordings that are read frame by frame. */
int player_seek(struct player *player, uint32_t frame, struct error *error);

/* Executes the calls of any frame in the state that the last played frame has left, and finishes it. Not for
 * recordings. */
int player_go_on(struct player *player, uint32_t frame, struct error *error);

/* Returns the number of the resource whose object on the device this is: a buffer, texture, shader or query;
 * NO_RESOURCE if it is none. */
uint32_t player_resource(const struct player *player, const void *object);

/* The result of a query in the frame that was played last. */
struct query_count {
    const char *name; /* the name in the stream */
    uint64_t passed;
};

/* Reads query `i` of those that ended in that frame, in the order of their definitions. Returns 0 past the
 * last. */
bool player_query(struct player *player, uint32_t i, struct query_count *count);

/* Called after each frame. If it returns another value than 0, playing stops, and stream_play returns the
 * value. */
typedef int frame_callback(void *user, uint32_t frame, triptych_device *device, struct error *error);

/* Prepares and plays frames `first` to `last`. `callback` may be null. For tests: a whole stream in one
 * call. */
int stream_play(const struct stream *stream, triptych_device *device, uint32_t first, uint32_t last,
                frame_callback *callback, void *user, struct error *error);

#endif
