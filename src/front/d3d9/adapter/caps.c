#include "caps.h"
#include "front/d3d9/host.h"
#include "front/d3d9/size.h"
#include "triptych.h"
#include <string.h>

/* A bit that is set if the renderer supports a state. */
struct state_bit {
    uint32_t bit;
    enum triptych_state state;
};

static uint32_t bits_of_states(const struct state_bit *bits, unsigned count)
{
    uint32_t all = 0;
    for (unsigned i = 0; i < count; i++)
        if (triptych_state_at(TRIPTYCH_RENDER_STATES, bits[i].state)->support == TRIPTYCH_SUPPORT_YES)
            all |= bits[i].bit;
    return all;
}
#define BITS_OF_STATES(...)                                                                                  \
    bits_of_states((const struct state_bit[]){__VA_ARGS__},                                                  \
                   sizeof((const struct state_bit[]){__VA_ARGS__}) / sizeof(struct state_bit))

static const struct triptych_kind *kind_named(const char *name)
{
    const struct triptych_kind *kind = NULL;
    for (unsigned i = 0; (kind = triptych_kind_at(i)) && strcmp(kind->name, name);)
        i++;
    return kind;
}

static bool supports(const char *kind, uint32_t number)
{
    const struct triptych_value *value = triptych_value_find(kind_named(kind), number);
    return value && value->support == TRIPTYCH_SUPPORT_YES;
}

/* One bit for each value of a kind: value 1 is the lowest. Direct3D has such bits for values up to `last`. */
static uint32_t bits_of_values(const char *name, uint32_t last)
{
    uint32_t all = 0;
    for (uint32_t number = 1; number <= last; number++)
        if (supports(name, number))
            all |= 1u << (number - 1);
    return all;
}

/* D3DPTADDRESSCAPS: bit 4 is the independence of the coordinates, bit 5 the value mirroronce. */
static uint32_t address_bits(void)
{
    enum { INDEPENDENT = 0x10, MIRROR_ONCE = 0x20, VALUE_MIRROR_ONCE = 5 };
    return bits_of_values("ADDRESS", VALUE_MIRROR_ONCE - 1) | INDEPENDENT |
           (supports("ADDRESS", VALUE_MIRROR_ONCE) ? MIRROR_ONCE : 0);
}

/* D3DPTFILTERCAPS: minification, levels and magnification have their bits from 8, 16 and 24 on. */
static uint32_t filter_bits(void)
{
    uint32_t filters = bits_of_values("FILTER", 3), levels = bits_of_values("MIPFILTER", 2);
    return filters << 8 | levels << 16 | filters << 24;
}

static void fill_device(struct d3d9_caps *caps)
{
    enum {
        CAPS_READ_SCAN_LINE = 0x20000,
        CAPS2_GAMMA = 0x20000,
        CAPS2_DYNAMIC_TEXTURES = 0x20000000,
        CAPS2_AUTOMATIC_MIPS = 0x40000000,
        CAPS3_ALPHA_FLIP = 0x20,
        CAPS3_COPIES = 0x300,
        INTERVAL_ONE = 1,
        CURSOR_COLOR = 1,
        /* buffers and textures in all memories, draws after a flip, transformation, rasterization, pure
         * devices */
        DEVICE = 0x10 | 0x20 | 0x40 | 0x80 | 0x100 | 0x200 | 0x400 | 0x800 | 0x1000 | 0x2000 | 0x8000 |
                 0x10000 | 0x20000 | 0x80000 | 0x100000,
        /* offsets of streams, shared offsets, StretchRect from textures */
        DEVICE2 = 0x1 | 0x40 | 0x10
    };
    caps->device_type = 1;
    caps->caps = CAPS_READ_SCAN_LINE;
    caps->caps2 = CAPS2_GAMMA | CAPS2_DYNAMIC_TEXTURES | CAPS2_AUTOMATIC_MIPS;
    caps->caps3 = CAPS3_ALPHA_FLIP | CAPS3_COPIES;
    caps->presentation_intervals = INTERVAL_ONE | 0x80000000u;
    caps->cursor_caps = CURSOR_COLOR;
    caps->dev_caps = DEVICE;
    caps->dev_caps2 = DEVICE2;
}

/* D3DPBLENDCAPS: the factors of a second colour, srccolor2 and its inverse, are those of Direct3D 9Ex. */
static uint32_t factor_bits(const char *kind, bool extended)
{
    enum { LAST = 14, SECOND = 16, INVERSE_SECOND = 17 }; /* blendfactor has one bit with its inverse */
    uint32_t second = (supports(kind, SECOND) ? 0x4000u : 0) | (supports(kind, INVERSE_SECOND) ? 0x8000u : 0);
    return bits_of_values(kind, LAST) | (extended ? second : 0);
}

static void fill_states(bool extended, struct d3d9_caps *caps)
{
    enum {
        /* all culling modes, the argument temp */
        MISC = 0x10 | 0x20 | 0x40 | 0x400,
        /* depth tests, fog of vertices and pixels by z and w, anisotropy, perspective colours */
        RASTER = 0x10 | 0x80 | 0x100 | 0x2000 | 0x20000 | 0x100000 | 0x200000 | 0x400000,
        SHADE_GOURAUD = 0x8 | 0x200 | 0x4000 | 0x80000,
        LINE = 0x1 | 0x2 | 0x4 | 0x8 | 0x10,
        W_BUFFER = 0x40000,
        STENCIL_TWO_SIDED = 0x100
    };
    caps->primitive_misc_caps =
        MISC | BITS_OF_STATES({0x2, TRIPTYCH_STATE_ZWRITEENABLE}, {0x80, TRIPTYCH_STATE_COLORWRITEENABLE},
                              {0x100, TRIPTYCH_STATE_CLIPPLANEENABLE}, {0x800, TRIPTYCH_STATE_BLENDOP},
                              {0x4000, TRIPTYCH_STATE_COLORWRITEENABLE1}, {0x10000, TRIPTYCH_STATE_FOGENABLE},
                              {0x20000, TRIPTYCH_STATE_SEPARATEALPHABLENDENABLE},
                              {0x40000, TRIPTYCH_STATE_COLORWRITEENABLE1},
                              {0x80000, TRIPTYCH_STATE_COLORWRITEENABLE1},
                              {0x200000, TRIPTYCH_STATE_SRGBWRITEENABLE});
    if (triptych_state_at(TRIPTYCH_STAGE_STATES, TRIPTYCH_STAGE_CONSTANT)->support == TRIPTYCH_SUPPORT_YES)
        caps->primitive_misc_caps |= 0x8000;
    caps->raster_caps =
        RASTER | (supports("ZBUFFER", 2) ? W_BUFFER : 0) |
        BITS_OF_STATES({0x1, TRIPTYCH_STATE_DITHERENABLE}, {0x10000, TRIPTYCH_STATE_RANGEFOGENABLE},
                       {0x1000000, TRIPTYCH_STATE_SCISSORTESTENABLE},
                       {0x2000000, TRIPTYCH_STATE_SLOPESCALEDEPTHBIAS}, {0x4000000, TRIPTYCH_STATE_DEPTHBIAS},
                       {0x8000000, TRIPTYCH_STATE_MULTISAMPLEANTIALIAS});
    caps->z_cmp_caps = caps->alpha_cmp_caps = bits_of_values("COMPARE", 8);
    caps->src_blend_caps = factor_bits("SRCBLEND", extended);
    caps->dest_blend_caps = factor_bits("DESTBLEND", extended);
    caps->shade_caps = SHADE_GOURAUD;
    caps->line_caps = LINE | BITS_OF_STATES({0x20, TRIPTYCH_STATE_ANTIALIASEDLINEENABLE});
    caps->stencil_caps = bits_of_values("STENCILOP", 8) |
                         BITS_OF_STATES({STENCIL_TWO_SIDED, TRIPTYCH_STATE_TWOSIDEDSTENCILMODE});
}

static void fill_textures(struct d3d9_caps *caps)
{
    enum {
        /* perspective, alpha, projection, cubes, volumes, levels of all */
        TEXTURE = 0x1 | 0x4 | 0x400 | 0x800 | 0x2000 | 0x4000 | 0x8000 | 0x10000,
        STRETCH_FILTERS = 0x100 | 0x200 | 0x1000000 | 0x2000000,
        MOST_REPEATS = 8192
    };
    caps->texture_caps = TEXTURE;
    caps->texture_filter_caps = caps->cube_texture_filter_caps = filter_bits();
    caps->volume_texture_filter_caps = caps->vertex_texture_filter_caps = filter_bits();
    caps->stretch_rect_filter_caps = STRETCH_FILTERS;
    caps->texture_address_caps = caps->volume_texture_address_caps = address_bits();
    caps->max_texture_width = caps->max_texture_height = TRIPTYCH_TEXTURE_MAXIMUM;
    caps->max_volume_extent = TRIPTYCH_VOLUME_MAXIMUM;
    caps->max_texture_repeat = MOST_REPEATS;
    caps->max_texture_aspect_ratio = TRIPTYCH_TEXTURE_MAXIMUM;
    caps->max_anisotropy = (uint32_t)kind_named("ANISOTROPY")->last;
    caps->texture_op_caps = bits_of_values("TEXTUREOP", 26);
    caps->max_texture_blend_stages = caps->max_simultaneous_textures = TRIPTYCH_STAGES;
}

static float default_float(enum triptych_state state)
{
    uint32_t bits = triptych_state_default(TRIPTYCH_RENDER_STATES, state, 0);
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

static void fill_vertices(struct d3d9_caps *caps)
{
    enum {
        FVF = 0x100000 | 8, /* point sizes, 8 sets of coordinates */
        /* generated coordinates, sources of materials, all lights */
        PROCESSING = 0x1 | 0x2 | 0x8 | 0x10 | 0x100,
        BLEND_MATRICES = 4,
        MOST_VERTICES = 0xffffff,
        MOST_STRIDE = 65535,
        DECLARATION_TYPES = 0x3ff
    };
    caps->max_vertex_w = 1e10f;
    caps->guard_band_left = caps->guard_band_top = -1e8f;
    caps->guard_band_right = caps->guard_band_bottom = 1e8f;
    caps->fvf_caps = FVF;
    caps->vertex_processing_caps =
        PROCESSING | BITS_OF_STATES({0x20, TRIPTYCH_STATE_LOCALVIEWER}, {0x40, TRIPTYCH_STATE_TWEENFACTOR});
    caps->max_active_lights = TRIPTYCH_LIGHTS;
    caps->max_user_clip_planes = TRIPTYCH_CLIP_PLANES;
    caps->max_vertex_blend_matrices = BLEND_MATRICES;
    caps->max_vertex_blend_matrix_index = BITS_OF_STATES({255, TRIPTYCH_STATE_INDEXEDVERTEXBLENDENABLE});
    caps->max_point_size = default_float(TRIPTYCH_STATE_POINTSIZE_MAX);
    caps->max_primitive_count = D3D9_MOST_PRIMITIVES;
    caps->max_vertex_index = MOST_VERTICES;
    caps->max_streams = TRIPTYCH_STREAMS;
    caps->max_stream_stride = MOST_STRIDE;
    caps->decl_types = DECLARATION_TYPES;
}

static void fill_shaders(struct d3d9_caps *caps)
{
    enum { SLOTS = 32768, EXECUTED = 65535, PIXEL_2_X = 0x1f, TEMPORARIES = 32, DYNAMIC_DEPTH = 24 };
    caps->vertex_shader_version = 0xfffe0300;
    caps->pixel_shader_version = 0xffff0300;
    caps->max_vertex_shader_const = 256;
    caps->pixel_shader_1x_max_value = 8;
    caps->vs20_caps = (struct d3d9_vertex_shader_caps){1, DYNAMIC_DEPTH, TEMPORARIES, 4};
    caps->ps20_caps = (struct d3d9_pixel_shader_caps){PIXEL_2_X, DYNAMIC_DEPTH, TEMPORARIES, 4, 512};
    caps->max_vshader_instructions_executed = caps->max_pshader_instructions_executed = EXECUTED;
    caps->max_vertex_shader30_instruction_slots = caps->max_pixel_shader30_instruction_slots = SLOTS;
    caps->num_simultaneous_rts = TRIPTYCH_TARGETS;
}

void d3d9_caps_fill(uint32_t adapter, bool extended, struct d3d9_caps *caps)
{
    *caps = (struct d3d9_caps){.adapter_ordinal = adapter};
    fill_device(caps);
    fill_states(extended, caps);
    fill_textures(caps);
    fill_vertices(caps);
    fill_shaders(caps);
    /* All adapters are outputs of one device. */
    caps->adapter_ordinal_in_group = adapter;
    caps->number_of_adapters_in_group = adapter ? 0 : d3d9_host_adapter_count();
}
