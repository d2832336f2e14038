/* Vertex shaders and constants for the tests of edge cases of pixel shaders. */
#ifndef TESTS_SPEC_SHADER_EDGES_H
#define TESTS_SPEC_SHADER_EDGES_H

#include "tests/support/picture/part.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Shaders that pass coordinates on, for pixel shaders of models 1 and 2, and of models 3. */
static const char first[] = "vs_1_1\ndcl_position v0\ndcl_texcoord0 v1\ndcl_texcoord1 v2\nmov oPos, v0\n"
                            "mov oT0, v1\nmov oT1, v2\n";
static const char third[] = "vs_3_0\ndcl_position v0\ndcl_texcoord v1\ndcl_position o0\ndcl_texcoord o1\n"
                            "mov o0, v0\nmov o1, v1\n";

static inline void set_pixel_constant(unsigned number, float x, float y, float z, float w)
{
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, number, (const float[4]){x, y, z, w}, 1));
}

#endif
