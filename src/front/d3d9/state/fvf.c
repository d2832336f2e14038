/* Vertex format codes (D3DFVF) as elements of a declaration. */
#include "front/d3d9/state/declaration.h"

enum {
    FVF_POSITION = 0x400e,
    FVF_XYZ = 0x002,
    FVF_XYZRHW = 0x004,
    FVF_XYZB1 = 0x006,
    FVF_XYZB2 = 0x008,
    FVF_XYZB5 = 0x00e,
    FVF_XYZW = 0x4002,
    FVF_NORMAL = 0x010,
    FVF_PSIZE = 0x020,
    FVF_DIFFUSE = 0x040,
    FVF_SPECULAR = 0x080,
    FVF_LAST_UBYTE4 = 0x1000,
    FVF_LAST_COLOR = 0x8000
};

/* D3DDECLTYPE. */
enum { TYPE_FLOAT1, TYPE_FLOAT2, TYPE_FLOAT3, TYPE_FLOAT4, TYPE_COLOR, TYPE_UBYTE4 };

struct sequence {
    struct d3d9_vertex_element *element;
    unsigned count;
    uint16_t offset;
};

static void add(struct sequence *s, unsigned type, enum triptych_usage usage, unsigned index)
{
    s->element[s->count++] = (struct d3d9_vertex_element){
        .offset = s->offset, .type = (uint8_t)type, .usage = (uint8_t)usage, .usage_index = (uint8_t)index};
    s->offset += type <= TYPE_FLOAT4 ? 4 * (type + 1) : 4;
}

/* The last of the weights can be indices; XYZB5 always has them. */
static void add_weights(struct sequence *s, uint32_t fvf)
{
    uint32_t position = fvf & FVF_POSITION;
    uint32_t weights = (position - FVF_XYZB1) / 2 + 1;
    bool indexed = fvf & (FVF_LAST_UBYTE4 | FVF_LAST_COLOR) || position == FVF_XYZB5;
    unsigned indices = fvf & FVF_LAST_UBYTE4 ? TYPE_UBYTE4 : fvf & FVF_LAST_COLOR ? TYPE_COLOR : TYPE_FLOAT1;
    weights -= indexed;
    if (position == FVF_XYZB2 && indices == TYPE_COLOR) {
        /* Direct3D's own conversion. */
        add(s, TYPE_COLOR, TRIPTYCH_USAGE_BLENDWEIGHT, 0);
        add(s, TYPE_UBYTE4, TRIPTYCH_USAGE_BLENDINDICES, 0);
        return;
    }
    if (weights)
        add(s, TYPE_FLOAT1 + weights - 1, TRIPTYCH_USAGE_BLENDWEIGHT, 0);
    if (indexed)
        add(s, indices, TRIPTYCH_USAGE_BLENDINDICES, 0);
}

static void add_position(struct sequence *s, uint32_t fvf)
{
    uint32_t position = fvf & FVF_POSITION;
    if (position == FVF_XYZRHW)
        add(s, TYPE_FLOAT4, TRIPTYCH_USAGE_POSITIONT, 0);
    else if (position == FVF_XYZW)
        add(s, TYPE_FLOAT4, TRIPTYCH_USAGE_POSITION, 0);
    else if (position)
        add(s, TYPE_FLOAT3, TRIPTYCH_USAGE_POSITION, 0);
    if (position >= FVF_XYZB1 && position <= FVF_XYZB5)
        add_weights(s, fvf);
}

unsigned d3d9_state_fvf_elements(uint32_t fvf, struct d3d9_vertex_element *elements)
{
    static const uint8_t set_type[4] = {TYPE_FLOAT2, TYPE_FLOAT3, TYPE_FLOAT4, TYPE_FLOAT1};
    struct sequence s = {.element = elements};
    uint32_t sets = fvf >> 8 & 15;
    add_position(&s, fvf);
    if (fvf & FVF_NORMAL)
        add(&s, TYPE_FLOAT3, TRIPTYCH_USAGE_NORMAL, 0);
    if (fvf & FVF_PSIZE)
        add(&s, TYPE_FLOAT1, TRIPTYCH_USAGE_PSIZE, 0);
    if (fvf & FVF_DIFFUSE)
        add(&s, TYPE_COLOR, TRIPTYCH_USAGE_COLOR, 0);
    if (fvf & FVF_SPECULAR)
        add(&s, TYPE_COLOR, TRIPTYCH_USAGE_COLOR, 1);
    for (uint32_t i = 0; i < sets && i < 8; i++)
        add(&s, set_type[fvf >> (16 + 2 * i) & 3], TRIPTYCH_USAGE_TEXCOORD, i);
    return s.count;
}
