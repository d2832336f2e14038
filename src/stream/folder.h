/* Paths of assets in a stream that is written to another folder than the one it was read from. */
#ifndef STREAM_FOLDER_H
#define STREAM_FOLDER_H

#include "stream/stream.h"

/* What goes in front of relative paths in a file at `path`: the way from its folder to that of the stream, "" if they
 * are one. The caller frees it, also after a failure. */
int folder_prefix(const struct stream *stream, const char *path, char **prefix, struct error *error);

/* The path as it is to be written; the caller frees it. Null when memory is short. */
char *folder_join(const char *prefix, const char *path);

#endif
