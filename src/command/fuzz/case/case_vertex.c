/* Vertices and indices of random kinds: any elements in any types that a declaration can have, values from
 * plausible to anything. Elements follow each other without gaps, so that they begin at any byte. Wild ones
 * lie in a buffer of words, since text has no NaN; up to three bytes complete the last word of a vertex. */
#include "base/bits.h"
#include "command/fuzz/case/case_part.h"

#include "contract/key.h"
#include "command/stream/stream.h"
#include "capture/word.h"

#include <math.h>
#include <string.h>

enum { VERTICES = 12, CHANGE_WORDS = 3 };

/* --- Which elements ------------------------------------------------------------------------------------- */

static enum triptych_format random_type(struct maker *maker)
{
    return random_chance(&maker->random, 2)
               ? TRIPTYCH_FORMAT_FLOAT1 + random_below(&maker->random, 4)
               : (enum triptych_format)(1 + random_below(&maker->random, TRIPTYCH_FORMAT_COUNT - 1));
}

/* Positions are of four components as a rule: what has fewer cannot be behind the eye. */
static struct case_element position_element(struct maker *maker)
{
    if (maker->window)
        return (struct case_element){TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_FLOAT4};
    enum triptych_format usual =
        random_chance(&maker->random, 3) ? TRIPTYCH_FORMAT_FLOAT3 : TRIPTYCH_FORMAT_FLOAT4;
    return (struct case_element){TRIPTYCH_POSITION,
                                 random_chance(&maker->random, 12) ? random_type(maker) : usual};
}

static unsigned choose_elements(struct maker *maker, struct case_element elements[CASE_ELEMENTS])
{
    unsigned count = 0, one_in = 2 + random_below(&maker->random, 3);
    elements[count++] = position_element(maker);
    for (unsigned e = 0; e < STREAM_ELEMENTS && count < CASE_ELEMENTS; e++) {
        bool common = e == TRIPTYCH_DIFFUSE || e == TRIPTYCH_TEXCOORD || e == TRIPTYCH_NORMAL;
        bool wanted = maker->elements >> e & 1 ? !random_chance(&maker->random, 12)
                                               : random_chance(&maker->random, common ? 2 : 4 * one_in);
        if (wanted && e != TRIPTYCH_POSITION && e != TRIPTYCH_POSITIONT)
            elements[count++] = (struct case_element){e, random_type(maker)};
    }
    return count;
}

/* --- Values --------------------------------------------------------------------------------------------- */

/* In clip space, since most transforms are identities, or in pixels. */
static void random_position(struct maker *maker, float position[4])
{
    static const float odd[] = {-1, 0, 1e-3f, 100};
    if (maker->window) {
        position[0] = random_float(&maker->random, -3, (float)maker->width + 3);
        position[1] = random_float(&maker->random, -3, (float)maker->height + 3);
        position[2] = random_float(&maker->random, 0, 1);
        position[3] = random_float(&maker->random, 0.125f, 2);
        return;
    }
    float w = random_chance(&maker->random, 2) ? 1 : random_float(&maker->random, 0.25f, 4);
    if (random_chance(&maker->random, 16))
        w = odd[random_below(&maker->random, 4)];
    for (int c = 0; c < 3; c++)
        position[c] = w * random_float(&maker->random, c == 2 ? -0.125f : -1.5f, c == 2 ? 1.125f : 1.5f);
    position[3] = w;
}

static float element_value(struct maker *maker, unsigned element, unsigned c, const float position[4])
{
    if (element == TRIPTYCH_POSITION || element == TRIPTYCH_POSITIONT)
        return position[c];
    if (element == TRIPTYCH_POINT_SIZE)
        return random_float(&maker->random, 0, 6);
    if (element == ELEMENT_indices1)
        return (float)random_below(&maker->random, 4);
    return random_float(&maker->random, element == TRIPTYCH_DIFFUSE ? 0 : -1, 2);
}

/* Integer fields: their own range, as the text format needs it. Indices of matrices stay below the number of
 * transforms. */
static void add_field(struct maker *maker, unsigned element, const struct vertex_type *type)
{
    int64_t half = (int64_t)1 << (type->bits - 1);
    uint32_t most = (uint32_t)(2 * half - 1);
    if (type->encoding == ENCODING_HALF)
        case_number(maker, -2, 2);
    else if (type->encoding == ENCODING_SIGNED)
        text_add(maker->text, " %d", (int)((int64_t)((uint32_t)random_u64(&maker->random) & most) - half));
    else if (element == TRIPTYCH_INDICES || element == ELEMENT_indices1)
        text_add(maker->text, " %u", random_below(&maker->random, 4));
    else
        text_add(maker->text, " %u", (uint32_t)random_u64(&maker->random) & most);
}

static void add_typed(struct maker *maker, const struct case_element *element, const float position[4])
{
    const struct vertex_type *type = &key_vertex_types[element->format];
    if (type->encoding == ENCODING_COLOR) {
        case_color(maker);
        return;
    }
    for (unsigned c = 0; c < type->components; c++)
        if (type->encoding == ENCODING_FLOAT)
            text_add(maker->text, " %.9g", (double)element_value(maker, element->number, c, position));
        else
            add_field(maker, element->number, type);
}

/* Returns the element's bytes. */
static unsigned make_wild(struct maker *maker, const struct case_element *element, const float position[4],
                          uint8_t *bytes)
{
    const struct vertex_type *type = &key_vertex_types[element->format];
    uint32_t words[4];
    for (unsigned w = 0; 4 * w < type->bytes; w++) {
        float value = element_value(maker, element->number, w, position);
        uint32_t bits = bits_of_float(value);
        if (type->encoding != ENCODING_FLOAT)
            bits = (uint32_t)random_u64(&maker->random);
        else if (random_chance(&maker->random, 8))
            bits = wild_bits(&maker->random);
        words[w] = bits;
    }
    memcpy(bytes, words, type->bytes);
    return type->bytes;
}

/* A vertex of elements in any types. */
static void add_wild(struct maker *maker, const struct case_element *elements, unsigned count,
                     const float position[4])
{
    uint32_t vertex[4 * CASE_ELEMENTS] = {0};
    unsigned bytes = 0;
    for (unsigned e = 0; e < count; e++)
        bytes += make_wild(maker, &elements[e], position, (uint8_t *)vertex + bytes);
    for (unsigned w = 0; 4 * w < bytes; w++)
        text_add(maker->text, " %u", vertex[w]);
}

/* --- Resources ------------------------------------------------------------------------------------------ */

static void add_block(struct maker *maker, const struct case_element *elements, unsigned count,
                      unsigned vertices)
{
    text_add(maker->text, " {\n");
    for (unsigned v = 0; v < vertices; v++) {
        float position[4];
        random_position(maker, position);
        for (unsigned e = 0; e < count && !maker->wild; e++)
            add_typed(maker, &elements[e], position);
        if (maker->wild)
            add_wild(maker, elements, count, position);
        text_add(maker->text, "\n");
    }
    text_add(maker->text, "}\n");
}

/* `count` elements as a resource of their own. */
static void add_resource(struct maker *maker, unsigned number, const struct case_element *elements,
                         unsigned count, unsigned vertices)
{
    if (maker->wild) {
        text_add(maker->text, "buffer v%u u32", number);
    } else {
        text_add(maker->text, "vertices v%u", number);
        case_add_elements(maker, elements, count);
    }
    add_block(maker, elements, count, vertices);
}

static void add_indices(struct maker *maker)
{
    maker->indices = 3 * (1 + random_below(&maker->random, 4));
    maker->index_bits = random_chance(&maker->random, 2) ? 16 : 32;
    text_add(maker->text, "indices i0 %u {", maker->index_bits);
    for (unsigned i = 0; i < maker->indices; i++)
        text_add(maker->text, " %u", random_below(&maker->random, maker->vertices));
    text_add(maker->text, " }\nbind indices i0\n");
}

/* The bytes that later replace some of the vertices. */
static void add_source(struct maker *maker)
{
    text_add(maker->text, "buffer c0 u32 {");
    for (unsigned i = 0; i < CHANGE_WORDS; i++) {
        float value = random_float(&maker->random, -2, 2);
        text_add(maker->text, " %u", maker->wild ? wild_bits(&maker->random) : bits_of_float(value));
    }
    text_add(maker->text, " }\n");
}

void case_change_buffer(struct maker *maker)
{
    unsigned room = maker->vertices * maker->bytes;
    if (random_chance(&maker->random, 12))
        text_add(maker->text, "discard v0\n");
    else if (room >= CHANGE_WORDS * 4)
        text_add(maker->text, "write v0 %u c0\n", random_below(&maker->random, room - CHANGE_WORDS * 4 + 1));
}

/* The second stream steps with instances. There are no more instances than vertices. */
static void add_instances(struct maker *maker)
{
    maker->instanced = true;
    text_add(maker->text, "frequency 0 indexed %u\nfrequency 1 instance %u\n",
             1 + random_below(&maker->random, maker->vertices < 4 ? maker->vertices : 4),
             1 + random_below(&maker->random, 2));
}

/* The elements, in one part or two. */
static void divide_elements(struct maker *maker, struct case_element elements[CASE_ELEMENTS],
                            unsigned part[2])
{
    maker->coded = !maker->wild && !maker->elements && random_chance(&maker->random, 8);
    unsigned count = maker->coded ? case_coded_elements(maker, elements) : choose_elements(maker, elements);
    part[0] = count;
    part[1] = 0;
    if (count > 1 && !maker->coded && random_chance(&maker->random, 5)) {
        part[0] = 1 + random_below(&maker->random, count - 1);
        part[1] = count - part[0];
    }
}

void case_vertices(struct maker *maker)
{
    struct case_element elements[CASE_ELEMENTS];
    unsigned part[2];
    maker->vertices = 3 + random_below(&maker->random, VERTICES - 2);
    divide_elements(maker, elements, part);
    unsigned skip = case_bind_skip(maker, part);
    add_resource(maker, 0, elements, part[0], maker->vertices + skip);
    add_source(maker);
    maker->bytes = case_stride(maker, elements, part[0]);
    if (part[1])
        add_resource(maker, 1, elements + part[0], part[1], maker->vertices);
    case_bind(maker, elements, part, skip);
    maker->indices = 0;
    if (random_chance(&maker->random, 3))
        add_indices(maker);
    if (part[1] && maker->indices && random_chance(&maker->random, 2))
        add_instances(maker);
}

/* --- Pages ----------------------------------------------------------------------------------------------
 *
 * Textured rectangles of two triangles. Their texels are in step with their pixels, or almost, so that their
 * halves are joined or just not (render/geometry/bin_pair.h). */

enum { RECTANGLES = 12 };

/* A rectangle: its sides in pixels, and the texture coordinates there, by axis. */
struct page_rectangle {
    float side[2][2], coordinate[2][2];
    uint32_t color[4]; /* of its corners */
    uint32_t other;    /* bits that the second half has inverted */
    bool slips;        /* each corner has coordinates of its own */
};

static float pick(struct maker *maker, const float *values, unsigned count)
{
    return values[random_below(&maker->random, count)];
}

/* One axis: from a position of texels on, as a rule a texel for each pixel. */
static void choose_axis(struct maker *maker, struct page_rectangle *r, unsigned axis, unsigned length,
                        unsigned texels)
{
    static const float phases[] = {0, 0, 0, 0.5f, 0.5f, 0.5f, 0.25f, 1.0f / 256},
                       steps[] = {1, 1, -1, 0.5f, 2, 0}, others[] = {1.0f / 3, 1 + 0x1p-12f, 1 + 0x1p-9f};
    struct random *random = &maker->random;
    float extent = (float)(1 + random_below(random, random_chance(random, 3) ? 80 : 16));
    float *side = r->side[axis], *coordinate = r->coordinate[axis];
    float step = random_chance(random, 8) ? pick(maker, others, 3) : pick(maker, steps, 6);
    side[0] = (float)random_between(random, -4, (int32_t)length) + pick(maker, phases, 8);
    if (random_chance(random, 8))
        extent += pick(maker, phases, 8);
    side[1] = side[0] + extent;
    float first = (float)random_between(random, -3, (int32_t)texels) + pick(maker, phases, 8);
    coordinate[0] = first / (float)texels;
    coordinate[1] = (first + extent * step) / (float)texels;
}

/* A corner's coordinate, perhaps off by around 1/8 or 1/2 of 1/256 texel. */
static float slip(struct maker *maker, const struct page_rectangle *r, float value, unsigned texels)
{
    static const float slips[] = {0, 0x1p-20f, 0.12f / 256, 0.4f / 256, 0.6f / 256, 0.9f / 256};
    float by = pick(maker, slips, 6) / (float)texels;
    return !r->slips ? value : random_chance(&maker->random, 2) ? value + by : value - by;
}

/* Corner `i` of one half: bit 0 is set to the right, bit 1 below. */
static void add_corner(struct maker *maker, const struct page_rectangle *r, unsigned i, uint32_t color,
                       const float coordinate[2])
{
    text_add(maker->text, "%.9g %.9g 0.5 1 0x%08x %.9g %.9g\n", (double)r->side[0][i & 1],
             (double)r->side[1][i >> 1], color, (double)coordinate[0], (double)coordinate[1]);
}

/* The halves share a diagonal, and begin with any of their corners, in either winding. */
static void add_halves(struct maker *maker, const struct page_rectangle *r, const unsigned texels[2])
{
    struct random *random = &maker->random;
    unsigned free = random_below(random, 4);
    float coordinate[4][2];
    for (unsigned i = 0; i < 4; i++) {
        coordinate[i][0] = slip(maker, r, r->coordinate[0][i & 1], texels[0]);
        coordinate[i][1] = slip(maker, r, r->coordinate[1][i >> 1], texels[1]);
    }
    for (unsigned half = 0; half < 2; half++) {
        unsigned corner = free ^ (half ? 3 : 0), first = random_below(random, 3),
                 step = 1 + random_below(random, 2);
        unsigned around[3] = {corner, corner ^ 1, corner ^ 2};
        for (unsigned n = 0; n < 3; n++) {
            unsigned i = around[(first + n * step) % 3];
            add_corner(maker, r, i, half ? r->color[i] ^ r->other : r->color[i], coordinate[i]);
        }
    }
}

/* One colour, often white; or, if the case is shaded, often gradients along an axis or from the first corner
 * on. Halves of these have one plane. */
static void choose_colors(struct maker *maker, struct page_rectangle *r, bool shaded)
{
    struct random *random = &maker->random;
    const bool white = random_chance(random, 3);
    const uint32_t first = white ? UINT32_MAX : (uint32_t)random_u64(random),
                   across = (uint32_t)random_u64(random) & 0x3f3f3f3f,
                   down = (uint32_t)random_u64(random) & 0x3f3f3f3f;
    const unsigned kind = shaded && !white ? 1 + random_below(random, 4) : 0;
    const uint32_t least = kind == 3 ? first & 0x7f7f7f7f : first;
    for (unsigned i = 0; i < 4; i++)
        switch (kind) {
        case 1: r->color[i] = i & 1 ? first ^ across : first; break;
        case 2: r->color[i] = i & 2 ? first ^ down : first; break;
        case 3: r->color[i] = least + (i & 1 ? across : 0) + (i & 2 ? down : 0); break;
        case 4: r->color[i] = (uint32_t)random_u64(random); break;
        default: r->color[i] = first;
        }
    if (random_chance(random, 12))
        r->other = 1u << random_below(random, 32);
}

static void add_vertices(struct maker *maker, unsigned count, const unsigned texels[2], bool shaded)
{
    struct random *random = &maker->random;
    text_add(maker->text, "vertices r0 positiont:float4 diffuse:color texcoord:float2 {\n");
    for (unsigned n = 0; n < count; n++) {
        struct page_rectangle r = {.slips = random_chance(random, 2)};
        choose_axis(maker, &r, 0, maker->width, texels[0]);
        choose_axis(maker, &r, 1, maker->height, texels[1]);
        choose_colors(maker, &r, shaded);
        add_halves(maker, &r, texels);
    }
    text_add(maker->text, "}\n");
}

/* Filters and modes. Some make texels depend on more than positions. */
static void add_sampler(struct maker *maker)
{
    static const char *const modes[] = {"clamp", "clamp", "clamp", "wrap", "mirror", "mirroronce", "border"};
    struct random *random = &maker->random;
    const char *filter = random_chance(random, 2) ? "point" : "linear";
    text_add(maker->text, "sampler 0 addressu %s\nsampler 0 addressv %s\n", modes[random_below(random, 7)],
             modes[random_below(random, 7)]);
    text_add(maker->text, "sampler 0 magfilter %s\nsampler 0 minfilter %s\nsampler 0 mipfilter none\n",
             filter, random_chance(random, 8) ? "linear" : filter);
}

/* The first shader is chosen most often. In some, coordinates are colours, by themselves or as factors. */
static void add_shading(struct maker *maker)
{
    static const char *const shaders[] = {"texld r0, t0, s0\n mul r0, r0, v0",
                                          "texld r0, t0, s0\n mad r0, r0, v0, t0.x",
                                          "texld r0, t0, s0\n texld r1, t0, s0\n mad r0, r0, v0.w, r1",
                                          "mov r1, t0\n texld r0, r1, s0",
                                          "texld r0, t0, s0\n mov r0.w, t0.x",
                                          "texld r0, t0, s0\n mov r0.y, t0.y",
                                          "texld r0, t0, s0\n mul r0.xz, r0, t0.x\n mul r0.y, r0, t0.y"};
    enum { SHADERS = sizeof shaders / sizeof *shaders };
    struct random *random = &maker->random;
    text_add(maker->text, "stage 0 colorop modulate\nstage 0 colorarg1 texture\nstage 0 colorarg2 diffuse\n"
                          "stage 0 texcoordindex 0\nstage 1 colorop disable\nvertexshader none\n");
    if (!random_chance(random, 2)) {
        text_add(maker->text, "pixelshader none\n");
        return;
    }
    text_add(maker->text,
             "shader r1 {\n ps_2_0\n dcl v0\n dcl t0.xy\n dcl_2d s0\n %s\n mov oC0, r0\n}\npixelshader r1\n",
             shaders[random_chance(random, 2) ? random_below(random, SHADERS) : 0]);
}

/* Neighbouring texels differ much. */
static void add_texture(struct maker *maker, unsigned texels[2])
{
    static const char *const formats[] = {"A8R8G8B8", "A8R8G8B8", "A8", "L8", "A8L8"};
    struct random *random = &maker->random;
    for (unsigned axis = 0; axis < 2; axis++)
        texels[axis] =
            random_chance(random, 3) ? 1 + random_below(random, 40) : 8u << random_below(random, 5);
    if (random_chance(random, 8))
        texels[random_below(random, 2)] = 512u << random_below(random, 4);
    text_add(maker->text, "texture r2 2d %s %u %u", formats[random_below(random, 5)], texels[0], texels[1]);
    if (random_chance(random, 4)) {
        text_add(maker->text, " gradient\n");
        return;
    }
    text_add(maker->text, " checker 1");
    case_color(maker);
    case_color(maker);
    text_add(maker->text, "\n");
}

void case_rectangles(struct maker *maker)
{
    struct random *random = &maker->random;
    unsigned texels[2], count = 1 + random_below(random, RECTANGLES);
    bool shaded = random_chance(random, 2);
    add_texture(maker, texels);
    add_vertices(maker, count, texels, shaded);
    add_sampler(maker);
    add_shading(maker);
    text_add(maker->text, "state shademode %s\nstate cullmode none\nstate fillmode solid\n",
             shaded ? "gouraud" : "flat");
    if (!random_chance(random, 4))
        text_add(maker->text, "state fogenable false\nstate specularenable false\nstate zenable false\n"
                              "state edgeantialias 0\n");
    text_add(maker->text, "bind texture 0 r2\nbind vertices r0\ndraw triangles 0 %u\n", 2 * count);
}
