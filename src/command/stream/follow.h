/* Following: finds out if the calls of a stream can be executed one after the other, without a device. */
#ifndef COMMAND_STREAM_FOLLOW_H
#define COMMAND_STREAM_FOLLOW_H

#include "command/stream/stream.h"

/* Follows all executed calls of a stream. */
int follower_check(const struct stream *stream, struct error *error);

/* Follows calls one after the other. The stream's resources may change between them. Null if memory is
 * short. */
struct follower *follower_create(const struct stream *stream);
void follower_free(struct follower *follower);

/* A resource was defined under this number: forgets an earlier one. */
void follower_define(struct follower *follower, uint32_t number);

/* Follows a call that is executed, or the end of a frame. A reason begins with the position. */
int follower_call(struct follower *follower, const struct call *call, struct error *error);
int follower_frame(struct follower *follower, struct error *error);

#endif
