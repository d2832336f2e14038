/* The job: the values that a draw's routines read at run time. They are derived from the state when the draw
 * is recorded.
 *
 * Generated code addresses the fields by offset from one register, so the structure is plain words. Anything
 * that would change the code itself is in the key instead. Vectors are rows, as in Direct3D 9: p' = p * M,
 * and matrices are m[row][column]. Camera space is the space after world * view. Colours are 0 to 1,
 * unclamped where the state is. */
#ifndef CONTRACT_JOB_H
#define CONTRACT_JOB_H

#include "base/srgb.h"
#include "contract/key.h"

#include <stdalign.h>
#include <stdint.h>

/* Vertex i's attribute begins at data + i * stride, any byte. `data` includes the offsets of the stream and
 * the element. Routines read whole words: after an attribute whose size is not a multiple of four, up to
 * FETCH_OVERREAD bytes, whose values do not matter, must be readable. */
enum { FETCH_OVERREAD = 3 };
struct attribute_job {
    const uint8_t *data;
    int32_t stride; /* bytes */
    int32_t reserved;
};

/* A light, multiplied by those reflectances that are the material's. `position` is in camera space; of a
 * directional light it is the unit vector to the light, and its ambient part is in base_color or
 * ambient_light. A spot's `axis` points against the direction of its light. */
struct light_job {
    float position[3]; /* or direction */
    float range;       /* a light with a position is off beyond it */
    float diffuse[3];
    float attenuation0;
    float ambient[3];
    float attenuation1;
    float attenuation2;
    float specular[3];
    float axis[3];
    float outer_cosine; /* of half the angle of the outer cone */
    float cone_scale;   /* 1 / (inner cosine - outer cosine) */
    float falloff;
    float reserved[2];
};

/* A world matrix for vertex blending. */
struct palette_entry {
    float world_view[4][4];
    float normal[3][4]; /* as in struct job */
};

/* One level of a texture's faces (render/texture/texture.h). Offsets count texels, not bytes. Each lane with
 * a level of its own reads the first four words, of volumes the first six. */
struct texture_level {
    int32_t offset; /* of its first texel from the face's */
    int32_t pitch;  /* from a row to the next */
    int32_t width, height, depth;
    int32_t slice_texels; /* from a slice to the next */
    int32_t reserved[2];
};

/* No texture has a level that is more than this many levels away. */
#define LOD_BIAS_MAXIMUM 64.0f

/* A texture's last texel is followed by padding: TEXTURE_MARGIN_ROWS of its longest rows and
 * TEXTURE_MARGIN_TEXELS texels. Routines may read the padding, because they load texels by windows
 * (engines/specialize/emit/gather_window.c); they do not use the values. */
enum { TEXTURE_MARGIN_ROWS = 4, TEXTURE_MARGIN_TEXELS = 16 };

struct texture_job {
    const uint32_t *texels; /* rows of `pitch` texels: RGBA8 words, red in the low byte, or the key's */
    int32_t width;          /* texels, 1 to 8192; of the level that is sampled if the others are not */
    int32_t height;
    float width_256; /* width * 256: texture coordinates become 24.8 fixed point */
    float height_256;
    int32_t last_u; /* width - 1: the mask of a power of two, the limit of a clamp */
    int32_t last_v;
    int32_t pitch;      /* texels from a row to the next */
    int32_t last_u_256; /* last_u and last_v in 24.8 fixed point: the limits of a clamped position */
    int32_t last_v_256;
    /* Read only for volumes, cubes and levels of detail. */
    int32_t depth, last_w, last_w_256;
    float depth_256;
    int32_t slice_texels, face_texels;       /* texels from a slice, a face to the next */
    float lod_offset;                        /* 256 * (mipmaplodbias + the level of texels) */
    int32_t first_level_256, last_level_256; /* levels that may be sampled, times 256 */
    const struct texture_level *levels;
    uint32_t border;
    float lod_bias_256; /* 256 times mipmaplodbias */
};

/* The clip mask: one byte a texel. */
struct clip_mask_job {
    const uint8_t *texels;
    int32_t x, y;           /* the pixel of texel 0, 0 */
    int32_t last_u, last_v; /* width - 1, height - 1 */
    int32_t pitch;          /* texels from a row to the next */
    int32_t reserved;
};

/* The displacement of a stage; rows of the matrix are du and dv. */
struct bump_job {
    float matrix[2][2];
    float luminance_scale, luminance_offset;
};

/* In parts that are derived together (def/job_part.def), the smallest parts first. */
struct job {
    alignas(64) const struct srgb_tables *srgb;
    const float *constants[2]; /* of the vertex and the pixel shader: program_write_constants */

    const struct palette_entry *palette; /* all world matrices, if vertices have matrix indices */

    /* Guard band: guard_left * w <= x <= guard_right * w and guard_bottom * w <= y <= guard_top * w keep
     * projected vertices within +-16383 pixels. */
    float guard_left, guard_right, guard_bottom, guard_top;

    /* Viewport: window position in 1/256 pixel = ndc * scale + offset; depth = ndc z * depth_scale +
     * depth_offset. */
    float scale_x, offset_x;
    float scale_y, offset_y;
    float depth_scale, depth_offset;

    /* Depth as integer: depth_maximum is 2^bits - 1. A w-buffer's depth is w * w_scale + w_offset. */
    float depth_maximum;
    float w_scale, w_offset;
    int32_t stencil_maximum;   /* 2^bits - 1 */
    int32_t stencil_reference; /* 0 to stencil_maximum, like the masks */
    int32_t stencil_mask;      /* of reference and stored value when they are compared */
    int32_t stencil_write_mask;

    uint32_t fog_color; /* RGBA8, red in the low byte, like all packed colours here */
    float fog_scale;    /* of the fog's distance: see spec/pixel/fog.h */
    float fog_offset;

    int32_t alpha_reference; /* 0 to 255 */
    uint32_t blend_constant;
    float tween_factor;

    float depth_bias;              /* added to the depth of triangles */
    float depth_bias_slope;        /* the same, times the triangle's greatest slope */
    float point_size;              /* in pixels; before the limits if vertices have sizes */
    float point_least, point_most; /* the limits in that case */
    float point_scale[3];          /* constant, linear and quadratic term of the attenuation with distance */
    float viewport_height;         /* the size in pixels of a size of 1 where the attenuation is 1 */

    float world_view_projection[4][4];
    float world_view[4][4];
    float normal[3][4]; /* inverse transpose of world * view, 3x3; the fourth column is unused */

    struct attribute_job attribute[ATTRIBUTE_COUNT];
    struct attribute_job input[INPUTS]; /* v# of the vertex shader */

    uint32_t texture_factor;
    uint32_t stage_constant[TEXTURE_STAGES];
    struct bump_job bump[TEXTURE_STAGES]; /* by the stage that is displaced; for ps_1_x by the stage itself */

    struct texture_job texture[SAMPLERS];
    struct clip_mask_job clip_mask; /* if the key has one */

    float base_color[4]; /* emissive + material ambient * (scene ambient + directional ambients); w: material
                            alpha. With reflectances from the vertex only emissive, or 0 if it is from there
                          */
    float ambient_light[3]; /* scene ambient + directional ambients, when it is not in base_color */
    float power;            /* the material's */
    float specular_alpha;   /* the material's */
    struct light_job light[LIGHT_COUNT];

    float texture_matrix[TEXTURE_STAGES][4][4]; /* by channel */

    float projection[4][4];                     /* if matrices are blended */
    struct palette_entry blend[BLEND_MATRICES]; /* world matrices 0 to 3 */

    float clip_plane[CLIP_PLANES_USER][4]; /* in clip space; inside: product with x y z w >= 0 */

    /* Of counter-clockwise triangles, if the key's stencil values are not only the first. */
    int32_t ccw_stencil_reference, ccw_stencil_mask, ccw_stencil_write_mask;
};

#endif
