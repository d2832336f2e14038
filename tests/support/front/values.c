#include "tests/support/front/values.h"
#include "front/d3d9/size.h"
#include "front/d3d9/types.h"
#include "shader/program/program.h"
#include "tests/support/shader/programs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#define COUNT(array) ((uint32_t)(sizeof(array) / sizeof *(array)))
#define PICK(seed, ...)                                                                                      \
    ((const uint32_t[]){__VA_ARGS__})[values_below(seed, COUNT(((const uint32_t[]){__VA_ARGS__})))]

static bool plain; /* this call: without strange values */

static uint64_t next(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return *seed * 0x2545f4914f6cdd1d;
}

uint32_t values_below(uint64_t *seed, uint32_t limit)
{
    return (uint32_t)((next(seed) >> 32) * limit >> 32);
}

bool values_once_in(uint64_t *seed, uint32_t chances)
{
    return !values_below(seed, chances);
}

void values_begin(uint64_t *seed)
{
    plain = !values_once_in(seed, 3);
}

/* Once in `chances` times, in calls that are not plain. */
static bool is_strange(uint64_t *seed, uint32_t chances)
{
    return !plain && values_once_in(seed, chances);
}

/* --- Numbers --- */

static uint32_t any(uint64_t *seed)
{
    switch (values_below(seed, 4)) {
    case 0: return values_below(seed, 4);
    case 1: return values_below(seed, 300);
    case 2: return UINT32_C(1) << values_below(seed, 32);
    default: return (uint32_t)(next(seed) >> 32);
    }
}

static uint32_t side(uint64_t *seed)
{
    if (is_strange(seed, 20))
        return PICK(seed, 0, 0, 0x4001, 0x10000, 0x7fffffff, 0xffffffff);
    return PICK(seed, 1, 2, 3, 4, 5, 7, 8, 16, 16, 32, 32, 33, 64, 64);
}

static uint32_t bytes(uint64_t *seed)
{
    if (is_strange(seed, 15))
        return PICK(seed, 0, 0x7fffffff, 0xffffffff, 0xfffffff0, 0x80000000);
    return PICK(seed, 1, 4, 8, 12, 16, 40, 64, 100, 256, 1000, 1024, 1024, 4096, 4096);
}

static uint32_t flags(uint64_t *seed)
{
    if (is_strange(seed, 5))
        return any(seed);
    return PICK(seed, 0, 0, 0, 1, 1, 2, 3, 4, 5, 6, 7, 0x10, 0x800, 0x1000, 0x2000, 0x3000, 0x4000, 0x8000);
}

static uint32_t usage(uint64_t *seed)
{
    if (is_strange(seed, 10))
        return any(seed);
    if (plain)
        return PICK(seed, 0, 0, 0, 0, 8, 1, 2, 0x200);
    return PICK(seed, 0, 0, 0, 0, 0, 0, 1, 1, 2, 8, 0x208, 0x200, 0x200, 0x400, 0x401, 0x10);
}

static uint32_t fvf(uint64_t *seed)
{
    if (is_strange(seed, 5))
        return any(seed);
    uint32_t code = PICK(seed, 2, 2, 2, 4, 4, 6, 8, 10, 12, 14, 0x4002, 0x1006, 0x8006, 0);
    code |= PICK(seed, 0, 0x40, 0x40, 0x10, 0x20, 0x80, 0xc0, 0x52, 0xf0);
    return code | values_below(seed, 10) << 8 | (is_strange(seed, 3) ? any(seed) << 16 : 0);
}

static uint32_t stride(uint64_t *seed)
{
    if (is_strange(seed, 10))
        return any(seed);
    return PICK(seed, 0, 1, 4, 12, 16, 16, 20, 20, 24, 28, 32, 36, 255, 508);
}

/* Not many more than 60, or more than a draw may have: millions take long. */
static uint32_t quantity(uint64_t *seed)
{
    return is_strange(seed, 20) ? any(seed) | (D3D9_MOST_PRIMITIVES + 1)
                                : values_below(seed, values_once_in(seed, 3) ? 60 : 6);
}

static uint32_t place(uint64_t *seed)
{
    return is_strange(seed, 10) ? any(seed) : values_below(seed, values_once_in(seed, 4) ? 20 : 2);
}

static uint32_t float_bits(uint64_t *seed)
{
    float number;
    uint32_t bits;
    switch (values_below(seed, 12)) {
    case 0: return PICK(seed, 0x7fc00000, 0x7f800000, 0xff800000, 0x7f7fffff, 1, 0x80000000, 0xff7fffff);
    case 1: return (uint32_t)(next(seed) >> 32);
    case 2:
    case 3: number = (float)(int)values_below(seed, 5) - 2; break;
    case 4: number = (float)values_below(seed, 6400) / 100; break;
    default: number = (float)values_below(seed, 2000) / 1000 - 1; break;
    }
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

static uint32_t format(uint64_t *seed, const char *name)
{
    static const char codes[][5] = {"DXT1", "DXT2", "DXT3", "DXT4", "DXT5", "UYVY", "YUY2", "ATI1", "ATI2",
                                    "NULL", "INTZ", "RESZ", "DF16", "DF24", "INST", "R2VB", "ATOC", "NVDB"};
    uint32_t code;
    if (strstr(name, "index") && !values_once_in(seed, 10))
        return PICK(seed, 101, 102);
    if (!values_once_in(seed, 4))
        return PICK(seed, 21, 21, 21, 21, 22, 22, 23, 75, 77, 101, 102);
    if (values_once_in(seed, 2)) {
        memcpy(&code, codes[values_below(seed, COUNT(codes))], sizeof code);
        return code;
    }
    return is_strange(seed, 8) ? any(seed) : values_below(seed, 120);
}

static uint32_t render_state(uint64_t *seed)
{
    return is_strange(seed, 10) ? any(seed) : 7 + values_below(seed, 204);
}

static uint32_t small(uint64_t *seed)
{
    return is_strange(seed, 10) ? any(seed) : 1 + values_below(seed, 4);
}

/* By the name of the argument. */
static uint32_t named(uint64_t *seed, const char *name)
{
    static const struct {
        const char *names;
        uint32_t (*make)(uint64_t *seed);
    } rows[] = {
        {" width height edge ", side},
        {" bytes room ", bytes},
        {" flags ", flags},
        {" depth levels ", small},
        {" usage ", usage},
        {" fvf ", fvf},
        {" stride ", stride},
        {" count vertex_count ", quantity},
        {" value segments ", float_bits},
        {" first base_vertex lowest_vertex first_index source_first destination_first index stage sampler "
         "stream "
         "level adapter swapchain palette quality samples ",
         place},
    };
    char padded[64] = " ";
    strncat(padded, name, sizeof padded - 3);
    strcat(padded, " ");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (strstr(rows[i].names, padded))
            return rows[i].make(seed);
    return values_once_in(seed, 4) ? any(seed) : place(seed);
}

static uint32_t unlikely(uint64_t *seed, uint32_t usual)
{
    return is_strange(seed, 10) ? any(seed) : usual;
}

uint32_t values_number(uint64_t *seed, const char *type, const char *name)
{
    if (!strcmp(type, "D3DFORMAT"))
        return format(seed, name);
    if (!strcmp(type, "D3DPOOL"))
        return unlikely(seed, PICK(seed, 0, 0, 0, 1, 1, 2));
    if (!strcmp(type, "D3DDEVTYPE"))
        return unlikely(seed, 1);
    if (!strcmp(type, "D3DPRIMITIVETYPE"))
        return unlikely(seed, 1 + values_below(seed, 6));
    if (!strcmp(type, "D3DRENDERSTATETYPE"))
        return render_state(seed);
    if (!strcmp(type, "D3DTRANSFORMSTATETYPE"))
        return unlikely(seed, PICK(seed, 2, 3, 16, 17, 23, 256, 256, 257, 511));
    if (!strcmp(type, "D3DTEXTURESTAGESTATETYPE"))
        return unlikely(seed, values_below(seed, 34));
    if (!strcmp(type, "D3DSAMPLERSTATETYPE"))
        return unlikely(seed, values_below(seed, 14));
    if (!strcmp(type, "D3DMULTISAMPLE_TYPE"))
        return unlikely(seed, PICK(seed, 0, 0, 0, 0, 1, 2, 4, 8));
    if (!strcmp(type, "D3DQUERYTYPE"))
        return unlikely(seed, 4 + values_below(seed, 16));
    if (!strcmp(type, "D3DSTATEBLOCKTYPE"))
        return unlikely(seed, 1 + values_below(seed, 3));
    if (!strcmp(type, "BOOL"))
        return unlikely(seed, values_below(seed, 2));
    if (!strcmp(type, "float"))
        return float_bits(seed);
    if (!strncmp(type, "D3D", 3) && strcmp(type, "D3DCOLOR"))
        return unlikely(seed, values_below(seed, 6));
    if (is_strange(seed, 30))
        return any(seed);
    return named(seed, name);
}

/* --- Structures --- */

static void fill_rectangle(uint64_t *seed, struct d3d9_rect *to)
{
    int32_t *number = &to->left;
    for (int i = 0; i < 4; i++)
        number[i] = values_once_in(seed, 20) ? (int32_t)any(seed) : (int32_t)values_below(seed, 20) * 2;
    if (!values_once_in(seed, 6)) {
        to->right = (int32_t)((uint32_t)to->left + values_below(seed, 33));
        to->bottom = (int32_t)((uint32_t)to->top + values_below(seed, 33));
    }
}

static void fill_box(uint64_t *seed, struct d3d9_box *to)
{
    uint32_t *number = &to->left;
    for (int i = 0; i < 6; i++)
        number[i] = values_once_in(seed, 20) ? any(seed) : values_below(seed, 5) * 2;
    if (values_once_in(seed, 6))
        return;
    to->right = to->left + values_below(seed, 9);
    to->bottom = to->top + values_below(seed, 9);
    to->back = to->front + values_below(seed, 5);
}

static void fill_parameters(uint64_t *seed, struct d3d9_present_parameters *to)
{
    bool full = values_once_in(seed, 5);
    *to = (struct d3d9_present_parameters){
        .back_buffer_width = full ? 640 : values_below(seed, 2) * side(seed),
        .back_buffer_height = full ? 480 : values_below(seed, 2) * side(seed),
        .back_buffer_format = unlikely(seed, PICK(seed, 0, 21, 22, 22, 23)),
        .back_buffer_count = unlikely(seed, values_below(seed, 4)),
        .multi_sample_type = unlikely(seed, PICK(seed, 0, 0, 0, 2, 4)),
        .swap_effect = unlikely(seed, 1 + values_below(seed, 4)),
        .device_window = values_below(seed, 2) * 0x1234,
        .windowed = !full,
        .enable_auto_depth_stencil = (int32_t)values_below(seed, 2),
        .auto_depth_stencil_format = unlikely(seed, PICK(seed, 75, 75, 77, 80)),
        .flags = unlikely(seed, values_below(seed, 3)),
        .full_screen_refresh_rate = unlikely(seed, full ? 60 * values_below(seed, 2) : 0),
        .presentation_interval = unlikely(seed, PICK(seed, 0, 0, 1, 0x80000000)),
    };
    if (!values_once_in(seed, 4))
        to->multi_sample_quality = 0;
}

static void fill_identifier(uint64_t *seed, struct d3d9_guid *to)
{
    static const struct d3d9_guid known[] = {
#define INTERFACE(NAME, name, com, BASE, a, b, c, ...) {a, b, c, {__VA_ARGS__}},
#include "front/d3d9/interface.def"
#undef INTERFACE
    };
    *to = values_once_in(seed, 4) ? (struct d3d9_guid){values_below(seed, 3), 0, 0, {0}}
                                  : known[values_below(seed, COUNT(known))];
}

static void fill_mode(uint64_t *seed, struct d3d9_display_mode_ex *to)
{
    *to = (struct d3d9_display_mode_ex){unlikely(seed, sizeof *to), 640, 480, 60, 22, 1};
    if (values_once_in(seed, 3))
        to->width = any(seed);
}

static void fill_filter(uint64_t *seed, struct d3d9_display_mode_filter *to)
{
    *to = (struct d3d9_display_mode_filter){unlikely(seed, sizeof *to), PICK(seed, 22, 23, 21),
                                            values_below(seed, 3)};
}

static void fill_palette(uint64_t *seed, struct d3d9_palette_entry *to)
{
    *to = (struct d3d9_palette_entry){1, 2, 3, values_once_in(seed, 1000) ? 7 : 255};
}

/* Words: floats and small integers. */
static void fill_words(uint64_t *seed, uint8_t *to, size_t bytes)
{
    for (size_t i = 0; i < bytes; i += sizeof(uint32_t)) {
        uint32_t word = values_once_in(seed, 4) ? values_below(seed, 4) : float_bits(seed);
        memcpy(to + i, &word, bytes - i < sizeof word ? bytes - i : sizeof word);
    }
}

void values_fill(uint64_t *seed, const char *type, void *memory, size_t bytes)
{
#define EACH(name, structure, fill)                                                                          \
    if (!strcmp(type, name)) {                                                                               \
        struct structure *to = memory;                                                                       \
        for (size_t i = 0; i < bytes / sizeof *to; i++)                                                      \
            fill(seed, to + i);                                                                              \
        return;                                                                                              \
    }
    EACH("RECT", d3d9_rect, fill_rectangle)
    EACH("D3DRECT", d3d9_rect, fill_rectangle)
    EACH("D3DBOX", d3d9_box, fill_box)
    EACH("D3DPRESENT_PARAMETERS", d3d9_present_parameters, fill_parameters)
    EACH("GUID", d3d9_guid, fill_identifier)
    EACH("D3DDISPLAYMODEEX", d3d9_display_mode_ex, fill_mode)
    EACH("D3DDISPLAYMODEFILTER", d3d9_display_mode_filter, fill_filter)
    EACH("PALETTEENTRY", d3d9_palette_entry, fill_palette)
#undef EACH
    if (!strcmp(type, "HANDLE")) {
        memset(memory, 0, bytes);
        return;
    }
    fill_words(seed, memory, bytes);
    if (!strcmp(type, "D3DVIEWPORT9") && !values_once_in(seed, 6)) {
        struct d3d9_viewport *viewport = memory;
        *viewport = (struct d3d9_viewport){
            values_below(seed, 9), values_below(seed, 9), side(seed), side(seed), 0, 1};
    }
    if (!strcmp(type, "D3DLIGHT9") && !values_once_in(seed, 6))
        ((struct d3d9_light *)memory)->type = 1 + values_below(seed, 3);
    if ((!strcmp(type, "UINT") || !strcmp(type, "DWORD")) && bytes == sizeof(uint32_t)) {
        uint32_t number = values_below(seed, 5000);
        memcpy(memory, &number, sizeof number);
    }
}

/* --- Contents that give the size --- */

static unsigned samples(void)
{
    unsigned count = 0;
    while (sample_program(count))
        count++;
    return count;
}

static const struct program *sample(uint64_t *seed, bool pixel)
{
    const struct program *program;
    do
        program = sample_program(values_below(seed, samples()));
    while (!values_once_in(seed, 50) && (program->tokens[0] >> 16 == 0xffff) != pixel);
    return program;
}

/* Tokens that are damaged at a few places still end, or are long enough for any reader that stops at the
 * limit of d3d9_size_code. */
void *values_code(uint64_t *seed, bool pixel)
{
    enum { LIMIT = (1 << 20) + (1 << 15) };
    const struct program *program = sample(seed, pixel);
    size_t count = program->token_count;
    bool damaged = values_once_in(seed, 3);
    uint32_t *code = calloc(damaged ? LIMIT : count, sizeof *code);
    TEST_ASSERT_NOT_NULL(code);
    memcpy(code, program->tokens, count * sizeof *code);
    for (uint32_t i = 0, changes = damaged ? 1 + values_below(seed, 3) : 0; i < changes; i++)
        code[values_below(seed, (uint32_t)count)] ^=
            values_once_in(seed, 2) ? UINT32_C(1) << values_below(seed, 32) : any(seed);
    if (!damaged)
        return code;
    size_t tokens = d3d9_size_code(code);
    uint32_t *exact = realloc(code, tokens * sizeof *code);
    return exact ? exact : code;
}

void *values_elements(uint64_t *seed)
{
    uint32_t count = values_once_in(seed, 20) ? values_below(seed, 66) : 1 + values_below(seed, 5);
    struct d3d9_vertex_element *elements = calloc(count + 1, sizeof *elements);
    uint16_t offset = 0;
    TEST_ASSERT_NOT_NULL(elements);
    for (uint32_t i = 0; i < count; i++) {
        elements[i] =
            (struct d3d9_vertex_element){(uint16_t)(values_once_in(seed, 5) ? values_below(seed, 3) : 0),
                                         offset,
                                         (uint8_t)(i ? values_below(seed, 18) : 1 + values_below(seed, 3)),
                                         (uint8_t)(values_once_in(seed, 20) ? values_below(seed, 8) : 0),
                                         (uint8_t)(i ? values_below(seed, 14) : 9 * values_below(seed, 2)),
                                         (uint8_t)(values_once_in(seed, 3) ? values_below(seed, 17) : 0)};
        offset = (uint16_t)(offset + (values_once_in(seed, 20) ? any(seed) : 4 * values_below(seed, 5)));
    }
    elements[count] = (struct d3d9_vertex_element){0xff, 0, 17, 0, 0, 0};
    if (count == D3D9_SIZE_ELEMENTS && values_once_in(seed, 2))
        elements[count - 1].stream = 0;
    return elements;
}

void *values_region(uint64_t *seed)
{
    uint32_t count = values_below(seed, 4);
    struct d3d9_region *region = calloc(1, sizeof *region + count * sizeof region->rectangles[0]);
    TEST_ASSERT_NOT_NULL(region);
    region->header_bytes = sizeof *region;
    region->type = 1;
    region->count = count;
    region->bytes = count * (uint32_t)sizeof region->rectangles[0];
    for (uint32_t i = 0; i < count; i++)
        fill_rectangle(seed, &region->rectangles[i]);
    return region;
}
