/* Whether calls can be executed, found out by following the state through them (check.c), and whether a call that
 * comes from a container is one that the text could say (valid.c). */
#ifndef STREAM_CHECK_H
#define STREAM_CHECK_H

#include "stream/stream.h"

/* Fills the whole stream's `executed`, of which there is room for `most`, and `frames`; there may be none. */
int stream_expand(struct stream *stream, uint32_t most, struct error *error);

/* Executes calls `first` to `last` - 1 into `executed`, for which there is room; calls the function, which may be null,
 * at each frame's end. */
typedef int expand_frame(void *user, const struct call *call);
int stream_expand_calls(struct stream *stream, uint32_t first, uint32_t last, expand_frame *frame,
                        void *user);

/* Follows all executed calls. */
int stream_check(const struct stream *stream, struct error *error);

/* Follows calls one after the other; the stream's resources may change between them. Null if memory is short. */
struct follower *follower_create(const struct stream *stream);
void follower_free(struct follower *follower);

/* Forgets what was of that number: a resource has been defined in its place. */
void follower_define(struct follower *follower, uint32_t number);

/* A call that is executed; the end of a frame; both give their reason with its place. */
int follower_call(struct follower *follower, const struct call *call, struct error *error);
int follower_frame(struct follower *follower, struct error *error);

/* Sets "PATH:LINE:COLUMN: REASON", or in a container "PATH: offset N (byte B, CALL): REASON". Returns -1. */
int stream_fail(const struct stream *stream, const struct call *call, const char *reason,
                struct error *error);

/* Whether a call read from a container names resources of the right kinds, and says nothing that has no text. */
int call_check(const struct stream *stream, struct call *call, struct error *error);

/* The same of vertices: bits of a word that belong to no number have no text. */
int vertices_check_bits(const struct resource *resource, struct error *error);

/* Whether an update's box is a part of its texture, and its source as many bytes as it takes. */
int check_update(const struct stream *stream, const struct call *call, struct error *error);

/* Whether surfaces can be drawn to, and what target they make; whether a copy can be made (stream/surface.c).
 */
int check_attach(const struct stream *stream, const struct call *call,
                 struct triptych_target_description *description, struct error *error);
int check_copy(const struct stream *stream, const struct call *call,
               const struct triptych_target_description *target, struct error *error);

/* Remembers which textures a call changes. */
void stream_note_changes(struct stream *stream, const struct call *call);

/* Parts of vertex formats: all that the code is made of, no bits left over. */
int check_fvf(uint32_t fvf);

#endif
