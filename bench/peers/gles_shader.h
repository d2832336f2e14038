/* The texts of the workloads' shaders, GLSL ES 1.00. */
#ifndef BENCH_PEERS_GLES_SHADER_H
#define BENCH_PEERS_GLES_SHADER_H

enum vertex_shader { PASS, VECTORS, LIT, PLACE };
enum pixel_shader { CONSTANT, TEXTURE, TWO_TEXTURES, MULTIPLY_ADD, NORMALIZE, PHONG, COLOR, NEW };

/* Each call gives a text that no call before gave: a number in it that matters not, but for NEW, whose
 * `number` is one of its constants. The text is valid until the next call. */
const char *vertex_text(enum vertex_shader shader);
const char *pixel_text(enum pixel_shader shader, unsigned number);

#endif
