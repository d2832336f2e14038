/* The texts of the workloads' shaders, GLSL ES 1.00. */
#ifndef BENCH_PEERS_GLES_SHADER_H
#define BENCH_PEERS_GLES_SHADER_H

enum vertex_shader { PASS, VECTORS, LIT, PLACE };
enum pixel_shader {
    CONSTANT,
    TEXTURE,
    TWO_TEXTURES,
    MODULATE,
    COVERAGE,
    INVERSE,
    MULTIPLY_ADD,
    MIX_4,
    MIX_16,
    MIX_64,
    NORMALIZE,
    PHONG,
    COLOR,
    NEW
};

/* Each call returns a new text. It contains a number that differs in each call and has no effect; in the
 * shader NEW, `number` is one of the constants. The text is valid until the next call. */
const char *vertex_text(enum vertex_shader shader);
const char *pixel_text(enum pixel_shader shader, unsigned number);

#endif
