/* Paths of assets in a stream that is written to a folder other than its own. */
#ifndef COMMAND_ASSETS_FOLDER_H
#define COMMAND_ASSETS_FOLDER_H

#include "command/stream/stream.h"

/* The prefix for relative paths in a file at `path`: the path from its folder to the stream's folder, or ""
 * if they are equal. The caller frees *prefix, even after a failure. */
int folder_prefix(const struct stream *stream, const char *path, char **prefix, struct error *error);

/* Joins prefix and path; the caller frees the result. Returns null if memory is short. */
char *folder_join(const char *prefix, const char *path);

#endif
