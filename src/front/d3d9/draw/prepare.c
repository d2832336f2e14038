/* Values that are passed on to the renderer before a draw: see device->late. */
#include "front/d3d9/draw/buffer.h"
#include "front/d3d9/draw/draw.h"
#include "front/d3d9/resource/texture.h"
#include "front/d3d9/state/declaration.h"
#include "front/d3d9/state/shader.h"

/* D3DSAMPLERSTATETYPE. */
enum { MIPFILTER = 7, LODBIAS = 8, MAXMIPLEVEL = 9 };

/* --- Targets and areas --- */

static bool is_smaller(const struct d3d9_surface *depth, const struct d3d9_surface *target)
{
    return depth->image.width < target->image.width || depth->image.height < target->image.height ||
           depth->image.samples != target->image.samples;
}

struct d3d9_surface *d3d9_draw_target(const struct d3d9_device *device, unsigned index)
{
    struct d3d9_surface *target = device->target[index];
    return target && target->image.format->number != D3D9_DRAW_NOTHING ? target : NULL;
}

/* A depth surface that does not fit to a target is left out: Direct3D allows it while nothing needs it. */
static struct d3d9_surface *depth_to_draw(const struct d3d9_device *device)
{
    for (unsigned i = 0; i < TRIPTYCH_TARGETS && device->depth; i++)
        if (d3d9_draw_target(device, i) && is_smaller(device->depth, d3d9_draw_target(device, i)))
            return NULL;
    return device->depth;
}

/* A device without a depth surface has none to test. */
static bool pass_targets(struct d3d9_device *device)
{
    struct triptych_target_surfaces targets = {.depth_format = TRIPTYCH_DEPTH_NONE};
    struct d3d9_surface *depth = depth_to_draw(device);
    bool any = false;
    for (unsigned i = 0; i < TRIPTYCH_TARGETS; i++)
        if (d3d9_draw_target(device, i))
            any |= d3d9_surface_as_target(device->target[i], &targets.color[i]);
    if (depth)
        any |= d3d9_surface_as_target(depth, &targets.depth);
    return any && triptych_set_target_surfaces(device->renderer, &targets) == TRIPTYCH_OK;
}

static float clamp(float number)
{
    return number > 0 ? number < 1 ? number : 1 : 0;
}

/* An empty range of depth is one of 0.001. */
void d3d9_draw_pass_areas(struct d3d9_device *device)
{
    const struct d3d9_viewport *from = device->state->viewport;
    const float least = 0.001F;
    float max_z = from->max_z < from->min_z + least ? from->min_z + least : from->max_z;
    const struct d3d9_rect *s = device->state->scissor;
    struct triptych_viewport viewport = {.x = (float)from->x,
                                         .y = (float)from->y,
                                         .width = (float)from->width,
                                         .height = (float)from->height,
                                         .depth_near = clamp(from->min_z),
                                         .depth_far = clamp(max_z)};
    uint32_t left = s->left > 0 ? (uint32_t)s->left : 0, top = s->top > 0 ? (uint32_t)s->top : 0;
    triptych_set_viewport(device->renderer, &viewport);
    triptych_set_scissor(device->renderer, left, top,
                         s->right > 0 && (uint32_t)s->right > left ? (uint32_t)s->right - left : 0,
                         s->bottom > 0 && (uint32_t)s->bottom > top ? (uint32_t)s->bottom - top : 0);
}

bool d3d9_draw_prepare_targets(struct d3d9_device *device)
{
    if (device->late & D3D9_LATE_TARGETS) {
        if (!pass_targets(device))
            return false;
        /* New targets reset the areas. */
        device->late = (device->late & ~(unsigned)D3D9_LATE_TARGETS) | D3D9_LATE_AREA;
    }
    if (device->late & D3D9_LATE_AREA)
        d3d9_draw_pass_areas(device);
    device->late &= ~(unsigned)D3D9_LATE_AREA;
    return true;
}

/* --- Textures --- */

static void pass_state(struct d3d9_device *device, unsigned i, enum triptych_sampler_state row,
                       uint32_t value)
{
    triptych_set_sampler_state(device->renderer, i, row,
                               d3d9_state_sanitize(TRIPTYCH_SAMPLER_STATES, row, i, value));
}

/* A texture with a first level (SetLOD): larger levels do not exist. Without mipmaps only this level is
 * sampled, otherwise this one or that of the sampler. */
static void pass_first_level(struct d3d9_device *device, unsigned i, uint32_t lod)
{
    const uint32_t *sampler = device->state->sampler + i * D3D9_SAMPLER_STATES;
    const float nearest = -1000;
    bool mipmaps = !lod || sampler[MIPFILTER] != TRIPTYCH_FILTER_NONE;
    uint32_t level = lod > sampler[MAXMIPLEVEL] || !mipmaps ? lod : sampler[MAXMIPLEVEL];
    pass_state(device, i, TRIPTYCH_SAMPLER_MIPFILTER, mipmaps ? sampler[MIPFILTER] : TRIPTYCH_FILTER_POINT);
    pass_state(device, i, TRIPTYCH_SAMPLER_MIPMAPLODBIAS,
               mipmaps ? sampler[LODBIAS] : triptych_float_bits(nearest));
    pass_state(device, i, TRIPTYCH_SAMPLER_MAXMIPLEVEL, level);
    device->lod[i] = lod;
    device->first_level = (device->first_level & ~(1u << i)) | (lod ? 1u << i : 0);
}

static void pass_texture(struct d3d9_device *device, unsigned i)
{
    struct d3d9_base_texture *texture = device->state->texture[i];
    uint32_t lod = texture ? texture->lod : 0;
    triptych_set_texture(device->renderer, i, texture ? d3d9_base_texture_use(texture) : NULL);
    if (lod || device->first_level >> i & 1)
        pass_first_level(device, i, lod);
}

static void pass_textures(struct d3d9_device *device)
{
    device->sampled = 0;
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++) {
        pass_texture(device, i);
        device->sampled |= device->state->texture[i] ? 1u << i : 0;
    }
}

/* Textures whose contents have changed since they were bound. */
static void refresh_textures(struct d3d9_device *device)
{
    for (uint32_t left = device->sampled; left; left &= left - 1) {
        unsigned i = (unsigned)__builtin_ctz(left);
        const struct d3d9_base_texture *texture = device->state->texture[i];
        if (texture->pending || texture->lod != device->lod[i])
            pass_texture(device, i);
    }
}

/* --- Vertices --- */

/* Vertices in the window have passed the vertex shader. A shader for software vertex processing runs only
 * there (draw/draw.c). */
static bool is_transformed(const struct d3d9_declaration *declaration)
{
    for (unsigned i = 0; declaration && i < declaration->translated; i++)
        if (declaration->translation[i].usage == TRIPTYCH_USAGE_POSITIONT)
            return true;
    return false;
}

static void pass_shaders(struct d3d9_device *device)
{
    const struct d3d9_state *state = device->state;
    const struct d3d9_shader *vertex = state->vertex_shader[0], *pixel = state->pixel_shader[0];
    bool used =
        vertex && !is_transformed(state->declaration[0]) && (!vertex->software || device->software_vertices);
    triptych_set_vertex_shader(device->renderer, used ? vertex->shader : NULL);
    triptych_set_pixel_shader(device->renderer, pixel ? pixel->shader : NULL);
}

static void pass_declaration(struct d3d9_device *device)
{
    const struct d3d9_declaration *declaration = device->state->declaration[0];
    if (declaration)
        triptych_set_declaration(device->renderer, declaration->translation, declaration->translated);
}

/* The bytes of a stream without a buffer. */
static triptych_buffer *zeros(struct d3d9_device *device)
{
    enum { BYTES = 65536 }; /* the largest offset of an element, and its bytes */
    if (!device->zeros) {
        static const char none[BYTES];
        triptych_buffer_create(device->renderer, none, BYTES, &device->zeros);
    }
    return device->zeros;
}

static bool pass_stream(struct d3d9_device *device, unsigned i)
{
    const struct d3d9_stream *stream = device->state->stream + i;
    bool exists = stream->buffer && stream->offset < stream->buffer->bytes;
    triptych_buffer *buffer = exists ? d3d9_buffer_use(stream->buffer) : zeros(device);
    if (!buffer)
        return false;
    triptych_set_stream(device->renderer, i, buffer, exists ? stream->offset : 0,
                        exists ? stream->stride : 0);
    return true;
}

/* Instances exist in indexed draws only. */
static void pass_frequency(struct d3d9_device *device, unsigned i, bool instances)
{
    enum { COUNT = (1 << 30) - 1 };
    uint32_t frequency = device->state->frequency[i], count = frequency & COUNT ? frequency & COUNT : 1;
    enum triptych_frequency kind = !instances        ? TRIPTYCH_FREQUENCY_VERTEX
                                   : frequency >> 31 ? TRIPTYCH_FREQUENCY_INSTANCE
                                   : frequency >> 30 ? TRIPTYCH_FREQUENCY_INDEXED
                                                     : TRIPTYCH_FREQUENCY_VERTEX;
    triptych_set_stream_frequency(device->renderer, i, kind, kind == TRIPTYCH_FREQUENCY_VERTEX ? 1 : count);
}

static bool pass_indices(struct d3d9_device *device)
{
    enum { INDEX32 = 102 };
    struct d3d9_buffer *indices = device->state->indices[0];
    triptych_buffer *buffer = indices ? d3d9_buffer_use(indices) : NULL;
    if (buffer)
        triptych_set_indices(device->renderer, buffer, indices->format == INDEX32 ? 32 : 16);
    return buffer;
}

/* The streams that the declaration names. Stream 0 of a draw from the program's memory is not bound. */
static bool pass_streams(struct d3d9_device *device, unsigned needs)
{
    uint32_t streams = device->state->declaration[0]->streams;
    bool passed = true;
    if (!(needs & D3D9_NEEDS_STREAMS))
        streams &= ~UINT32_C(1);
    device->instances = false;
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++) {
        pass_frequency(device, i, needs & D3D9_NEEDS_INSTANCES);
        device->instances |= device->state->frequency[i] >> 30;
        if (streams >> i & 1)
            passed &= pass_stream(device, i);
    }
    return passed && (!(needs & D3D9_NEEDS_INDICES) || pass_indices(device));
}

/* Buffers that have changed since they were bound. */
static bool refresh_streams(struct d3d9_device *device, unsigned needs)
{
    uint32_t streams = device->state->declaration[0]->streams;
    if (!(needs & D3D9_NEEDS_STREAMS))
        streams &= ~UINT32_C(1);
    for (; streams; streams &= streams - 1) {
        struct d3d9_buffer *buffer = device->state->stream[__builtin_ctz(streams)].buffer;
        if (buffer && buffer->change != D3D9_BUFFER_UNCHANGED && !d3d9_buffer_use(buffer))
            return false;
    }
    struct d3d9_buffer *indices = device->state->indices[0];
    return !(needs & D3D9_NEEDS_INDICES) || indices->change == D3D9_BUFFER_UNCHANGED ||
           d3d9_buffer_use(indices);
}

bool d3d9_draw_prepare(struct d3d9_device *device, unsigned needs)
{
    if (!d3d9_draw_prepare_targets(device))
        return false;
    unsigned late = device->late;
    if (late & D3D9_LATE_TEXTURES)
        pass_textures(device);
    else if (device->sampled)
        refresh_textures(device);
    if (late & (D3D9_LATE_DECLARATION | D3D9_LATE_SHADERS))
        pass_shaders(device);
    if (late & D3D9_LATE_DECLARATION)
        pass_declaration(device);
    if (late & D3D9_LATE_LIGHTS)
        d3d9_lights_forward(device);
    /* Another declaration can name streams that were not passed on. */
    if (late & (D3D9_LATE_STREAMS | D3D9_LATE_DECLARATION))
        device->passed = 0;
    bool streams = !device->passed || needs & ~device->passed ||
                   (device->instances && (needs ^ device->passed) & D3D9_NEEDS_INSTANCES);
    if (streams ? !pass_streams(device, needs) : !refresh_streams(device, needs)) {
        device->late = D3D9_LATE_STREAMS;
        return false;
    }
    device->passed = streams ? needs : device->passed;
    device->late = 0;
    return true;
}
