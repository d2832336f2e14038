/* Values at the edges of binary32, of 32-bit integers and of 16-bit halves. */
#ifndef TESTS_SUPPORT_SHADER_EDGES_H
#define TESTS_SUPPORT_SHADER_EDGES_H

#include <stdint.h>

extern const uint32_t edges[];
extern const unsigned edge_count;

#endif
