#include "command/fuzz/case/case.h"

#include "command/fuzz/case/case_part.h"
#include "command/stream/stream.h"
#include "command/fuzz/case/shader.h"
#include "render/target/target.h"

void case_number(struct maker *maker, float least, float most)
{
    text_add(maker->text, " %.9g", (double)random_float(&maker->random, least, most));
}

void case_numbers(struct maker *maker, unsigned count, float least, float most)
{
    while (count--)
        case_number(maker, least, most);
}

void case_color(struct maker *maker)
{
    text_add(maker->text, " 0x%08x", (uint32_t)random_u64(&maker->random));
}

void case_clear(struct maker *maker, bool depth, bool stencil)
{
    text_add(maker->text, "clear color");
    case_numbers(maker, 4, 0, 1);
    if (depth)
        text_add(maker->text, " depth %.9g", (double)random_float(&maker->random, 0.5f, 1));
    if (stencil)
        text_add(maker->text, " stencil %u", random_below(&maker->random, 256));
    text_add(maker->text, "\n");
}

/* Masks and parts, also outside of the target. */
static void add_clear_of_parts(struct maker *maker)
{
    struct random *random = &maker->random;
    text_add(maker->text, "clear color");
    case_numbers(maker, 4, 0, 1);
    if (maker->has_depth && random_chance(random, 2))
        text_add(maker->text, " depth %.9g", (double)random_float(random, 0, 1));
    if (maker->has_stencil && random_chance(random, 2))
        text_add(maker->text, " stencil %u stencilmask %u", random_below(random, 256),
                 random_below(random, 256));
    if (random_chance(random, 2))
        text_add(maker->text, " colormask %u", random_below(random, 16));
    if (random_chance(random, 3))
        text_add(maker->text, " everywhere");
    for (unsigned i = random_below(random, 6); i; i--)
        text_add(maker->text, " part %u %u %u %u", random_below(random, maker->width + 8),
                 random_below(random, maker->height + 8), random_below(random, maker->width + 8),
                 random_below(random, maker->height + 8));
    text_add(maker->text, "\n");
}

/* --- Meshes and contents of the target ------------------------------------------------------------------ */

enum { CONTENTS_BYTES = 16384 };

static void add_mesh(struct maker *maker)
{
    static const char *const shapes[] = {"box", "grid 2 1", "sphere 4 3", "cylinder 5 1", "torus 0.25 4 3"};
    maker->mesh = true;
    text_add(maker->text, "mesh m0 %s\n",
             shapes[random_below(&maker->random, sizeof shapes / sizeof *shapes)]);
}

/* Words of any bits for all pixels of the target. */
static void add_contents(struct maker *maker)
{
    size_t bytes = target_contents_bytes(&maker->target);
    if (!bytes || bytes > CONTENTS_BYTES)
        return;
    maker->contents = true;
    text_add(maker->text, "buffer k0 u32");
    case_words(maker, bytes / sizeof(uint32_t));
}

static void add_resources(struct maker *maker)
{
    if (random_chance(&maker->random, 24))
        add_mesh(maker);
    if (random_chance(&maker->random, 24))
        add_contents(maker);
}

/* They are those of the target, not of attached surfaces. */
static void write_contents(struct maker *maker)
{
    if (maker->contents && !maker->attached)
        text_add(maker->text, "contents k0\n");
}

/* --- Draws ---------------------------------------------------------------------------------------------- */

enum { PRIMITIVES = TRIPTYCH_PRIMITIVE_COUNT };

static const struct {
    const char *word;
    unsigned each, more; /* n primitives have n * each + more vertices */
} primitives[PRIMITIVES] = {
#define PRIMITIVE(name, word, kind, parts, each, more, meaning) {#word, each, more},
#include "def/state/primitive.def"
#undef PRIMITIVE
};

static void add_draw(struct maker *maker)
{
    struct random *random = &maker->random;
    unsigned p = random_chance(random, 3) ? random_below(random, PRIMITIVES) : random_below(random, 3);
    bool indexed = maker->indices && (maker->instanced || !random_chance(random, 4));
    unsigned corners = indexed ? maker->indices : maker->vertices;
    unsigned most = (corners - primitives[p].more) / primitives[p].each;
    text_add(maker->text, indexed ? "draw-indexed %s 0 0 %u\n" : "draw %s 0 %u\n", primitives[p].word,
             most && random_chance(random, 3) ? 1 + random_below(random, most) : most);
}

/* The vertices of v0 as an immediate draw. */
static void add_user_draw(struct maker *maker)
{
    struct random *random = &maker->random;
    unsigned p = random_below(random, PRIMITIVES);
    bool indexed = maker->indices && (maker->instanced || random_chance(random, 2));
    unsigned corners = indexed ? maker->indices : maker->vertices;
    unsigned most = (corners - primitives[p].more) / primitives[p].each;
    text_add(maker->text, indexed ? "draw-indexed-user %s %u v0 %u i0 %u\n" : "draw-user %s %u v0 %u\n",
             primitives[p].word, most, maker->stride, maker->index_bits);
}

/* States and a draw, which are also correct if they are played again. */
static void add_sequence(struct maker *maker)
{
    text_add(maker->text, "sequence s0\n");
    case_states(maker, random_below(&maker->random, 6));
    add_draw(maker);
    text_add(maker->text, random_chance(&maker->random, 2) ? "end\nplay s0\n" : "end\nplay s0\nplay s0\n");
}

/* It replaces the vertices, so it is the last draw. The elements of instances belong to a stream, which a
 * mesh does not have. */
static void draw_mesh(struct maker *maker)
{
    if (maker->mesh && !maker->instanced)
        text_add(maker->text, "draw mesh m0\n");
}

static void change_something(struct maker *maker)
{
    case_states(maker, random_below(&maker->random, 6));
    if (random_chance(&maker->random, 6))
        case_copy(maker);
    if (random_chance(&maker->random, 8))
        case_fill(maker);
    if (random_chance(&maker->random, 8))
        case_write_pixels(maker);
    if (random_chance(&maker->random, 6))
        add_clear_of_parts(maker);
    if (random_chance(&maker->random, 6))
        case_change(maker);
    if (random_chance(&maker->random, 6))
        case_change_buffer(maker);
    if (maker->images && random_chance(&maker->random, 3))
        case_switch_target(maker);
    if (random_chance(&maker->random, 8))
        case_samplers(maker);
    if (random_chance(&maker->random, 8))
        case_switch_shaders(maker);
    if (random_chance(&maker->random, 8))
        write_contents(maker);
    if (random_chance(&maker->random, 8))
        case_lights_off(maker);
}

static void add_any_draw(struct maker *maker, bool first)
{
    struct random *random = &maker->random;
    if (first && random_chance(random, 16))
        add_sequence(maker);
    else if (maker->stride && (maker->indices || !maker->instanced) && random_chance(random, 3))
        add_user_draw(maker);
    else
        add_draw(maker);
}

/* The target is read where it is drawn to: what one draw leaves the next ones blend with and compare with.
 * Queries begin and end in one frame. */
static void add_draws(struct maker *maker)
{
    struct random *random = &maker->random;
    unsigned draws = 1 + random_below(random, 3);
    bool query = random_chance(random, 4);
    if (query)
        text_add(maker->text, "begin-query q0\n");
    for (unsigned d = 0; d < draws; d++) {
        if (d && !query && random_chance(random, 6))
            text_add(maker->text, "frame\n");
        if (d)
            change_something(maker);
        add_any_draw(maker, d == 0);
    }
    draw_mesh(maker);
    if (!maker->instanced && random_chance(random, 3))
        case_rectangles(maker);
    if (query)
        text_add(maker->text, "end-query q0\n");
}

/* The bytes of buffers are copied when they are used. */
static void add_releases(struct maker *maker)
{
    if (random_chance(&maker->random, 12))
        text_add(maker->text, "release c0\n");
    if (maker->contents && random_chance(&maker->random, 2))
        text_add(maker->text, "release k0\n");
}

/* Draws to a texture, which later draws may sample. */
static void add_pass(struct maker *maker)
{
    if (!random_chance(&maker->random, 8) || !case_attach(maker))
        return;
    text_add(maker->text, "clear color");
    case_numbers(maker, 4, 0, 1);
    text_add(maker->text, "\n");
    add_draw(maker);
    if (maker->images && random_chance(&maker->random, 2))
        case_switch_target(maker);
    case_detach(maker);
    case_samplers(maker);
}

/* --- The whole ------------------------------------------------------------------------------------------ */

/* The writers of shaders add the elements that shaders need. */
static void choose(struct maker *maker)
{
    struct random *random = &maker->random;
    maker->wild = random_chance(random, 5);
    maker->window = random_chance(random, 8);
    maker->stages =
        random_chance(random, 3) ? random_below(random, TRIPTYCH_STAGES + 1) : 1 + random_below(random, 2);
    maker->samplers = (1u << maker->stages) - 1;
    if (random_chance(random, 8))
        maker->elements = 1ull << ELEMENT_indices1 | 1ull << ELEMENT_color2;
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        maker->sampler_type[i] = ANY_TEXTURE;
}

void case_write(struct random *random, struct text *text)
{
    struct maker maker = {.random = *random, .text = text};
    struct fuzz_shader made[TRIPTYCH_SHADER_STAGE_COUNT];
    choose(&maker);
    text_add(text, "triptych 1\n");
    case_target(&maker);
    case_shaders(&maker, made);
    case_textures(&maker);
    case_images(&maker);
    text_add(text, "query q0\n");
    case_vertices(&maker);
    add_resources(&maker);
    case_window(&maker);
    case_transforms(&maker);
    case_lights(&maker);
    case_constants(&maker);
    case_samplers(&maker);
    case_stages(&maker);
    case_features(&maker);
    case_states(&maker, random_chance(&maker.random, 4) ? 0 : random_below(&maker.random, 24));
    add_pass(&maker);
    case_clear(&maker, maker.has_depth, maker.has_stencil);
    if (random_chance(&maker.random, 8))
        add_clear_of_parts(&maker);
    add_draws(&maker);
    add_releases(&maker);
    *random = maker.random;
}
