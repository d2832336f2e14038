/* The place of a fault in a model file that is text. Assimp's reasons do not have lines. */
#ifndef COMMAND_IMPORT_LOCATE_H
#define COMMAND_IMPORT_LOCATE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

/* Reads the text of a file that could not be imported: OBJ, PLY and STL as text, glTF. If it finds a fault,
 * sets "PATH:LINE:COLUMN: found FOUND, expected EXPECTED" and returns true. The path's ending is the format.
 * A zero byte must follow the text. */
bool locate_fault(const char *path, const char *text, size_t bytes, struct error *error);

#endif
