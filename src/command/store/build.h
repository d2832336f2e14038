/* The build id of this program: a hash of its code, which the linker writes. */
#ifndef COMMAND_STORE_BUILD_H
#define COMMAND_STORE_BUILD_H

#include <stddef.h>
#include <stdint.h>

/* The id of the program or shared object that contains this function; null if it has none. */
const uint8_t *store_build_id(size_t *bytes);

#endif
