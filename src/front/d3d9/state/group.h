/* Groups of values, as the functions of this folder see them. */
#ifndef D3D9_STATE_GROUP_H
#define D3D9_STATE_GROUP_H

#include "front/d3d9/state.h"

enum d3d9_state_content { STATE_VALUE, STATE_OBJECT };

struct d3d9_state_group {
    size_t offset, bytes; /* in struct d3d9_state, and of an element */
    unsigned first, count;
    enum d3d9_state_content content;
};

extern const struct d3d9_state_group d3d9_state_group[D3D9_GROUPS];

/* The rows of the tables of states. */
enum {
#define STATE(number, name, ...) STATE_ROW_##name,
#include "def/state/state.def"
#undef STATE
};
enum {
#define SAMPLER_STATE(number, name, ...) SAMPLER_ROW_##name,
#include "def/state/sampler_state.def"
#undef SAMPLER_STATE
};
enum {
#define STAGE_STATE(number, name, ...) STAGE_ROW_##name,
#include "def/state/stage_state.def"
#undef STAGE_STATE
};

/* The group of a cell. */
enum d3d9_group d3d9_state_group_of(unsigned cell);
void *d3d9_state_element(struct d3d9_state *, enum d3d9_group group, unsigned index);
/* Changes an element; holds and drops objects. Returns true if the value changes. */
bool d3d9_state_assign(struct d3d9_state *, enum d3d9_group group, unsigned index, const void *value);

#endif
