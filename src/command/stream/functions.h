/* The functions of each call that its row in capture/call.def does not imply. The table is in
 * command/calls. */
#ifndef COMMAND_STREAM_FUNCTIONS_H
#define COMMAND_STREAM_FUNCTIONS_H

#include "command/stream/stream.h"

struct follower;
struct parser;
struct player;
struct writer;

enum { STREAM_WORDS = 6 };

/* A null pointer means that the call's row suffices. `parse` starts after the first word of the line, whose
 * number in `words` it receives. */
struct stream_functions {
    const char *words[STREAM_WORDS]; /* the words that begin its lines, if not the row's */
    int (*parse)(struct parser *parser, struct call *call, unsigned word);
    void (*print)(struct writer *writer, const struct call *call);
    int (*check)(const struct stream *stream, const struct call *call, struct error *error);
    int (*follow)(struct follower *follower, const struct call *call, struct error *error);
    enum triptych_result (*play)(struct player *player, const struct call *call); /* changes of state */
    enum triptych_result (*draw)(struct player *player, const struct call *call); /* changes of pixels */
};

extern const struct stream_functions calls_functions[CALL_TYPES];

#endif
