#include "size.h"

enum { END_STREAM = 0xff };

enum { MOST_TOKENS = 1 << 20 };
enum { TOKEN_COMMENT = 0xfffe, TOKEN_END = 0xffff };

uint64_t d3d9_size_elements(const struct d3d9_vertex_element *elements)
{
    uint64_t count = 0;
    while (elements && count < D3D9_SIZE_ELEMENTS && elements[count++].stream != END_STREAM)
        continue;
    return count;
}

/* The tokens that follow an instruction's first one and need not be looked at. From model 2.0 on instructions
 * have their length, and operands may look like an end. */
static uint32_t tokens_after(uint32_t version, uint32_t token)
{
    if (token >> 31 == 0 && (token & 0xffff) == TOKEN_COMMENT)
        return token >> 16 & 0x7fff;
    return (version >> 8 & 0xff) >= 2 ? token >> 24 & 0xf : 0;
}

uint64_t d3d9_size_code(const uint32_t *code)
{
    uint64_t count = 1; /* the version */
    if (!code)
        return 0;
    while (count < MOST_TOKENS) {
        uint32_t token = code[count++];
        if (token == TOKEN_END)
            break;
        count += tokens_after(code[0], token);
    }
    return count;
}

uint64_t d3d9_size_region(const struct d3d9_region *region)
{
    return region ? sizeof *region + (uint64_t)region->count * sizeof region->rectangles[0] : 0;
}
