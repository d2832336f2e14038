#include "known.h"
#include "front/d3d9/size.h"

#include <stddef.h>

/* D3DPRIMITIVETYPE, and the number of primitives. */
static bool is_primitive(uint32_t type, uint32_t count)
{
    enum { POINTS = 1, FAN = 6 };
    return type >= POINTS && type <= FAN && count <= D3D9_MOST_PRIMITIVES;
}

static bool is_light(const struct d3d9_light *light)
{
    enum { POINT = 1, DIRECTIONAL = 3 };
    return light->type >= POINT && light->type <= DIRECTIONAL;
}

static struct d3d9_head *head_of(uint64_t object)
{
    return (struct d3d9_head *)(uintptr_t)object;
}

#define OWN(object)      (!(object) || head_of(object)->parent == b->self)
#define SUCCEEDS(object) (head_of(object)->draws != 0)
#define KNOWN(class, name, condition)                                                                        \
    static bool known_##class##_##name(const void *block)                                                    \
    {                                                                                                        \
        const struct d3d9_block_##class##_##name *b = block;                                                 \
        (void)b;                                                                                             \
        return condition;                                                                                    \
    }
#include "known.def"
#undef KNOWN

bool d3d9_known(unsigned code, const void *block)
{
    static bool (*const functions[D3D9_CODE_COUNT])(const void *block) = {
#define KNOWN(class, name, condition) [D3D9_CODE_##class##_##name] = known_##class##_##name,
#include "known.def"
#undef KNOWN
    };
    return code < D3D9_CODE_COUNT && functions[code] && functions[code](block);
}

bool d3d9_known_count(unsigned code, void *block)
{
    struct d3d9_block_object_add_ref *add = block;
    struct d3d9_block_object_release *release = block;
    if (code == D3D9_CODE_object_add_ref && head_of(add->self)->references >= 1) {
        add->result = ++head_of(add->self)->references;
        return true;
    }
    if (code == D3D9_CODE_object_release && head_of(release->self)->references >= 2) {
        release->result = --head_of(release->self)->references;
        return true;
    }
    return false;
}
