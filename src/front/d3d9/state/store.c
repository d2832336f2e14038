/* Sets of values: their groups, defaults and copies. */
#include "front/d3d9/state.h"
#include "front/d3d9/state/group.h"

#include <math.h>
#include <string.h>

const struct d3d9_state_group d3d9_state_group[D3D9_GROUPS] = {
#define GROUP(NAME, member, count, content, all)                                                             \
    {offsetof(struct d3d9_state, member), sizeof(((struct d3d9_state *)NULL)->member[0]), D3D9_CELL_##NAME,  \
     count, STATE_##content},
#include "front/d3d9/group.def"
#undef GROUP
};

unsigned d3d9_mask_next(const struct d3d9_mask *mask, unsigned from)
{
    if (from >= D3D9_CELLS)
        return D3D9_CELLS;
    unsigned word = from / 64;
    uint64_t bits = mask->bits[word] & (UINT64_MAX << from % 64);
    while (!bits) {
        if (++word == sizeof mask->bits / sizeof *mask->bits)
            return D3D9_CELLS;
        bits = mask->bits[word];
    }
    return word * 64 + (unsigned)__builtin_ctzll(bits);
}

enum d3d9_group d3d9_state_group_of(unsigned cell)
{
    unsigned group = D3D9_GROUPS - 1;
    while (d3d9_state_group[group].first > cell)
        group--;
    return (enum d3d9_group)group;
}

void *d3d9_state_element(struct d3d9_state *state, enum d3d9_group group, unsigned index)
{
    return (char *)state + d3d9_state_group[group].offset + (size_t)index * d3d9_state_group[group].bytes;
}

bool d3d9_state_assign(struct d3d9_state *state, enum d3d9_group group, unsigned index, const void *value)
{
    void *element = d3d9_state_element(state, group, index);
    size_t bytes = d3d9_state_group[group].bytes;
    if (!memcmp(element, value, bytes))
        return false;
    if (d3d9_state_group[group].content == STATE_OBJECT) {
        struct d3d9_object *old, *new;
        memcpy(&old, element, sizeof old);
        memcpy(&new, value, sizeof new);
        d3d9_object_hold(new);
        memcpy(element, value, bytes);
        d3d9_object_drop(old);
    } else {
        memcpy(element, value, bytes);
    }
    return true;
}

bool d3d9_state_copy(struct d3d9_state *to, const struct d3d9_state *from, unsigned cell)
{
    enum d3d9_group group = d3d9_state_group_of(cell);
    unsigned index = cell - d3d9_state_group[group].first;
    return d3d9_state_assign(to, group, index, d3d9_state_element((struct d3d9_state *)from, group, index));
}

/* --- Numbers of Direct3D --- */

int d3d9_state_render_row(uint32_t number)
{
    static const uint8_t rows[D3D9_RENDER_STATES] = {
#define STATE(number, name, ...) [number] = STATE_ROW_##name + 1,
#include "def/state/state.def"
#undef STATE
    };
    return number < D3D9_RENDER_STATES ? rows[number] - 1 : -1;
}

int d3d9_state_sampler_row(uint32_t number)
{
    static const uint8_t rows[D3D9_SAMPLER_STATES] = {
#define SAMPLER_STATE(number, name, ...) [number] = SAMPLER_ROW_##name + 1,
#include "def/state/sampler_state.def"
#undef SAMPLER_STATE
    };
    return number < D3D9_SAMPLER_STATES ? rows[number] - 1 : -1;
}

int d3d9_state_stage_row(uint32_t number)
{
    static const uint8_t rows[D3D9_STAGE_STATES] = {
#define STAGE_STATE(number, name, ...) [number] = STAGE_ROW_##name + 1,
#include "def/state/stage_state.def"
#undef STAGE_STATE
    };
    return number < D3D9_STAGE_STATES ? rows[number] - 1 : -1;
}

int d3d9_state_sampler(uint32_t number)
{
    enum { DISPLACEMENT = 256, FIRST_VERTEX, LAST_VERTEX = FIRST_VERTEX + 3 };
    if (number < TRIPTYCH_VERTEX_SAMPLER)
        return (int)number;
    if (number == DISPLACEMENT)
        return D3D9_DISPLACEMENT_SAMPLER;
    return number >= FIRST_VERTEX && number <= LAST_VERTEX
               ? (int)(TRIPTYCH_VERTEX_SAMPLER + number - FIRST_VERTEX)
               : -1;
}

int d3d9_state_transform(uint32_t number)
{
    enum { VIEW = 2, PROJECTION = 3, TEXTURE0 = 16, TEXTURE7 = 23, WORLD = 256, LAST_WORLD = 511 };
    if (number == VIEW)
        return TRIPTYCH_TRANSFORM_VIEW;
    if (number == PROJECTION)
        return TRIPTYCH_TRANSFORM_PROJECTION;
    if (number >= TEXTURE0 && number <= TEXTURE7)
        return (int)(TRIPTYCH_TRANSFORM_TEXTURE0 + number - TEXTURE0);
    if (number == WORLD)
        return TRIPTYCH_TRANSFORM_WORLD;
    if (number > WORLD && number <= LAST_WORLD)
        return (int)(TRIPTYCH_TRANSFORM_WORLD1 + number - WORLD - 1);
    return -1;
}

/* --- Sets --- */

struct d3d9_state *d3d9_state_make(unsigned vertex_floats)
{
    struct d3d9_state *state;
    size_t bytes = sizeof *state + vertex_floats * sizeof state->vertex_float[0];
    state = d3d9_memory_allocate(bytes);
    return state;
}

static void drop_objects(struct d3d9_state *state)
{
    for (unsigned g = 0; g < D3D9_GROUPS; g++)
        for (unsigned i = 0; d3d9_state_group[g].content == STATE_OBJECT && i < d3d9_state_group[g].count;
             i++) {
            char *element = d3d9_state_element(state, (enum d3d9_group)g, i);
            struct d3d9_object *object;
            memcpy(&object, element, sizeof object);
            memset(element, 0, d3d9_state_group[g].bytes);
            d3d9_object_drop(object);
        }
}

void d3d9_state_free(struct d3d9_state *state)
{
    if (state)
        drop_objects(state);
    d3d9_memory_free(state);
}

static void default_states(struct d3d9_state *state)
{
    for (unsigned n = 0; n < D3D9_RENDER_STATES; n++)
        if (d3d9_state_render_row(n) >= 0)
            state->render[n] =
                triptych_state_default(TRIPTYCH_RENDER_STATES, (unsigned)d3d9_state_render_row(n), 0);
    for (unsigned n = 0; n < D3D9_SAMPLER_STATES; n++)
        for (unsigned i = 0; i < D3D9_SAMPLERS && d3d9_state_sampler_row(n) >= 0; i++)
            state->sampler[i * D3D9_SAMPLER_STATES + n] = triptych_state_default(
                TRIPTYCH_SAMPLER_STATES, (unsigned)d3d9_state_sampler_row(n), i < TRIPTYCH_SAMPLERS ? i : 0);
    for (unsigned n = 0; n < D3D9_STAGE_STATES; n++)
        for (unsigned i = 0; i < TRIPTYCH_STAGES && d3d9_state_stage_row(n) >= 0; i++)
            state->stage[i * D3D9_STAGE_STATES + n] =
                triptych_state_default(TRIPTYCH_STAGE_STATES, (unsigned)d3d9_state_stage_row(n), i);
}

void d3d9_state_initialize(struct d3d9_state *state, unsigned vertex_floats, bool depth)
{
    enum { DEPTH_TEST = 7 }; /* D3DRS_ZENABLE */
    static const struct d3d9_matrix identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    drop_objects(state);
    memset(state, 0, sizeof *state + vertex_floats * sizeof state->vertex_float[0]);
    default_states(state);
    state->render[DEPTH_TEST] = depth;
    for (unsigned i = 0; i < TRIPTYCH_TRANSFORM_COUNT; i++)
        state->transform[i] = identity;
    state->viewport->max_z = 1;
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++)
        state->frequency[i] = 1;
}
