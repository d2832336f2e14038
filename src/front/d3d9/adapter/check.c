#include "check.h"
#include "front/d3d9/call.h"

enum { DEVICE_HARDWARE = 1, MULTISAMPLE_NONE = 0, MULTISAMPLE_BY_QUALITY = 1, QUALITY_LEVELS = 3 };

enum {
    USAGE_QUERIES = D3D9_USAGE_QUERY_BUMP_MAP | D3D9_USAGE_QUERY_SRGB_READ | D3D9_USAGE_QUERY_FILTER |
                    D3D9_USAGE_QUERY_SRGB_WRITE | D3D9_USAGE_QUERY_BLENDING |
                    D3D9_USAGE_QUERY_VERTEX_TEXTURE | D3D9_USAGE_QUERY_WRAP_AND_MIP,
    USAGE_OF_TEXTURES = USAGE_QUERIES | D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DEPTH_STENCIL |
                        D3D9_USAGE_DYNAMIC | D3D9_USAGE_AUTOMATIC_MIPS | D3D9_USAGE_SOFTWARE_PROCESSING
};

static bool has_sign(const struct d3d9_format *format)
{
    return format->channel[0].kind == D3D9_CHANNEL_SIGNED;
}

/* Sampling and writing convert between sRGB and linear values where the channels have 8 bits or fewer. */
static bool has_srgb(const struct d3d9_format *format)
{
    return !format->floats && format->number != TRIPTYCH_SURFACE_NULL;
}

static bool queries_fit(const struct d3d9_format *format, uint32_t usage)
{
    bool color = format->drawn == D3D9_DRAWN_COLOR;
    if (usage & D3D9_USAGE_QUERY_BUMP_MAP && !has_sign(format))
        return false;
    if (usage & D3D9_USAGE_QUERY_SRGB_READ && !(format->sampled && has_srgb(format)))
        return false;
    if (usage & D3D9_USAGE_QUERY_SRGB_WRITE &&
        !(color && format->target == D3D9_TARGET_8888 && has_srgb(format)))
        return false;
    if (usage & D3D9_USAGE_QUERY_BLENDING && !color)
        return false;
    if (usage & (D3D9_USAGE_QUERY_FILTER | D3D9_USAGE_QUERY_VERTEX_TEXTURE) && !format->sampled)
        return false;
    return true;
}

/* Programs take these for a sign of AMD's extension fetch4, which the device does not have. */
static bool is_fetch4(const struct d3d9_format *format)
{
    return format->number == TRIPTYCH_SURFACE_DF16 || format->number == TRIPTYCH_SURFACE_DF24;
}

static int32_t check_texture(const struct d3d9_format *format, uint32_t usage, uint32_t type)
{
    bool volume = type == D3D9_TYPE_VOLUME_TEXTURE || type == D3D9_TYPE_VOLUME;
    uint32_t drawn = usage & (D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DEPTH_STENCIL);
    bool nothing = format->number == TRIPTYCH_SURFACE_NULL && drawn == D3D9_USAGE_RENDER_TARGET;
    if (usage & ~(uint32_t)USAGE_OF_TEXTURES)
        return D3D9_NOT_AVAILABLE;
    if ((!format->sampled && !nothing) || is_fetch4(format))
        return D3D9_NOT_AVAILABLE;
    if (drawn && volume)
        return D3D9_NOT_AVAILABLE;
    if (type != D3D9_TYPE_TEXTURE && d3d9_format_is_depth(format))
        return D3D9_NOT_AVAILABLE;
    if (usage & D3D9_USAGE_RENDER_TARGET && format->drawn != D3D9_DRAWN_COLOR)
        return D3D9_NOT_AVAILABLE;
    if (usage & D3D9_USAGE_DEPTH_STENCIL && format->drawn != D3D9_DRAWN_DEPTH)
        return D3D9_NOT_AVAILABLE;
    if (!queries_fit(format, usage))
        return D3D9_NOT_AVAILABLE;
    if (!(usage & D3D9_USAGE_AUTOMATIC_MIPS))
        return D3D9_OK;
    if (volume)
        return D3D9_NOT_AVAILABLE;
    return format->drawn == D3D9_DRAWN_COLOR ? D3D9_OK : D3D9_NO_AUTOMATIC_MIPS;
}

/* Surfaces without a usage are offscreen plain surfaces. */
static int32_t check_surface(const struct d3d9_format *format, uint32_t usage)
{
    bool ati = format->number == TRIPTYCH_SURFACE_ATI1 || format->number == TRIPTYCH_SURFACE_ATI2;
    uint32_t allowed = D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DEPTH_STENCIL | USAGE_QUERIES;
    if (usage & ~allowed)
        return D3D9_NOT_AVAILABLE;
    if (usage & D3D9_USAGE_RENDER_TARGET)
        return format->drawn == D3D9_DRAWN_COLOR && queries_fit(format, usage) ? D3D9_OK : D3D9_NOT_AVAILABLE;
    if (usage & D3D9_USAGE_DEPTH_STENCIL)
        return format->drawn == D3D9_DRAWN_DEPTH && !is_fetch4(format) ? D3D9_OK : D3D9_NOT_AVAILABLE;
    if (usage & (D3D9_USAGE_QUERY_SRGB_WRITE | D3D9_USAGE_QUERY_BLENDING))
        return D3D9_NOT_AVAILABLE;
    return format->sampled && !d3d9_format_is_depth(format) && !ati ? D3D9_OK : D3D9_NOT_AVAILABLE;
}

int32_t d3d9_check_format(uint32_t usage, uint32_t type, uint32_t number)
{
    const struct d3d9_format *format = d3d9_format_find(number);
    switch (type) {
    case D3D9_TYPE_VERTEX_BUFFER:
    case D3D9_TYPE_INDEX_BUFFER: return D3D9_INVALID_CALL;
    case D3D9_TYPE_SURFACE: return format ? check_surface(format, usage) : D3D9_NOT_AVAILABLE;
    case D3D9_TYPE_TEXTURE:
    case D3D9_TYPE_CUBE:
    case D3D9_TYPE_VOLUME:
    case D3D9_TYPE_VOLUME_TEXTURE: return format ? check_texture(format, usage, type) : D3D9_NOT_AVAILABLE;
    default: return D3D9_INVALID_CALL;
    }
}

bool d3d9_check_back_buffer(uint32_t display, uint32_t back_buffer, bool windowed)
{
    const struct d3d9_format *format = d3d9_format_find(back_buffer);
    if (!format || !d3d9_format_is_display(display))
        return false;
    if (windowed)
        return format->drawn == D3D9_DRAWN_COLOR && back_buffer != TRIPTYCH_SURFACE_NULL;
    return back_buffer == display ||
           (display == TRIPTYCH_SURFACE_X8R8G8B8 && back_buffer == TRIPTYCH_SURFACE_A8R8G8B8) ||
           (display == TRIPTYCH_SURFACE_X1R5G5B5 && back_buffer == TRIPTYCH_SURFACE_A1R5G5B5);
}

/* The number of quality levels of a type; 0: the type is not supported. */
static uint32_t quality_levels(uint32_t type)
{
    switch (type) {
    case MULTISAMPLE_NONE:
    case 2:
    case 4:
    case 8: return 1;
    case MULTISAMPLE_BY_QUALITY: return QUALITY_LEVELS;
    default: return 0;
    }
}

/* The type D3DMULTISAMPLE_NONMASKABLE has 2, 4 and 8 samples for its qualities. */
uint32_t d3d9_check_samples(uint32_t type, uint32_t quality)
{
    if (type == MULTISAMPLE_NONE)
        return 1; /* of any quality */
    if (quality >= quality_levels(type))
        return 0;
    return type == MULTISAMPLE_BY_QUALITY ? 2u << quality : type;
}

uint32_t d3d9_check_mode_count(uint32_t adapter, uint32_t format)
{
    uint32_t count, found = 0;
    const struct d3d9_host_mode *modes = d3d9_host_modes(adapter, &count);
    for (uint32_t i = 0; i < count; i++)
        found += modes[i].format == format;
    return found;
}

/* --- IDirect3D9 --- */

static int32_t check_device(uint32_t adapter, uint32_t type)
{
    if (adapter >= d3d9_host_adapter_count())
        return D3D9_INVALID_CALL;
    return type == DEVICE_HARDWARE ? D3D9_OK : D3D9_NOT_AVAILABLE;
}

int32_t d3d9_factory_check_device_type(struct d3d9_factory *self, uint32_t adapter, uint32_t type,
                                       uint32_t display, uint32_t back_buffer, int32_t windowed)
{
    (void)self;
    int32_t result = check_device(adapter, type);
    if (result < 0)
        return result;
    if (!windowed && !d3d9_check_mode_count(adapter, display))
        return D3D9_NOT_AVAILABLE;
    if (windowed && back_buffer == D3D9_FORMAT_UNKNOWN)
        back_buffer = display;
    return d3d9_check_back_buffer(display, back_buffer, windowed) ? D3D9_OK : D3D9_NOT_AVAILABLE;
}

/* ATOC is not a format of resources: as a surface without usage it announces the vendors' extension alpha to
 * coverage, which D3DRS_ADAPTIVETESS_Y enables. */
static bool is_alpha_to_coverage(uint32_t usage, uint32_t type, uint32_t number)
{
    return number == TRIPTYCH_TESSELLATION_ATOC && type == D3D9_TYPE_SURFACE && !usage;
}

int32_t d3d9_factory_check_device_format(struct d3d9_factory *self, uint32_t adapter, uint32_t type,
                                         uint32_t adapter_format, uint32_t usage, uint32_t resource_type,
                                         uint32_t format)
{
    (void)self;
    if (adapter_format == D3D9_FORMAT_UNKNOWN)
        return D3D9_INVALID_CALL;
    int32_t result = check_device(adapter, type);
    if (result < 0)
        return result;
    if (!d3d9_format_is_display(adapter_format))
        return D3D9_NOT_AVAILABLE;
    if (is_alpha_to_coverage(usage, resource_type, format))
        return D3D9_OK;
    return d3d9_check_format(usage, resource_type, format);
}

int32_t d3d9_factory_check_device_multi_sample_type(struct d3d9_factory *self, uint32_t adapter,
                                                    uint32_t type, uint32_t number, int32_t windowed,
                                                    uint32_t samples, uint32_t *levels)
{
    enum { MOST_SAMPLES = 16 };
    (void)self, (void)windowed;
    const struct d3d9_format *format = d3d9_format_find(number);
    int32_t result = check_device(adapter, type);
    if (result < 0)
        return result;
    if (samples > MOST_SAMPLES || number == D3D9_FORMAT_UNKNOWN)
        return D3D9_INVALID_CALL;
    uint32_t found = quality_levels(samples);
    if (levels)
        *levels = found ? found : 1;
    if (samples == MULTISAMPLE_NONE)
        return D3D9_OK;
    return found && format && format->drawn != D3D9_DRAWN_NOTHING ? D3D9_OK : D3D9_NOT_AVAILABLE;
}

int32_t d3d9_factory_check_depth_stencil_match(struct d3d9_factory *self, uint32_t adapter, uint32_t type,
                                               uint32_t adapter_format, uint32_t target, uint32_t depth)
{
    (void)self;
    int32_t result = check_device(adapter, type);
    if (result < 0)
        return result;
    if (!d3d9_format_is_display(adapter_format))
        return D3D9_NOT_AVAILABLE;
    result = d3d9_check_format(D3D9_USAGE_RENDER_TARGET, D3D9_TYPE_SURFACE, target);
    return result < 0 ? result : d3d9_check_format(D3D9_USAGE_DEPTH_STENCIL, D3D9_TYPE_SURFACE, depth);
}

int32_t d3d9_factory_check_device_format_conversion(struct d3d9_factory *self, uint32_t adapter,
                                                    uint32_t type, uint32_t source, uint32_t target)
{
    (void)self;
    int32_t result = check_device(adapter, type);
    if (result < 0)
        return result;
    if (d3d9_check_format(0, D3D9_TYPE_SURFACE, source) < 0)
        return D3D9_NOT_AVAILABLE;
    return d3d9_check_format(D3D9_USAGE_RENDER_TARGET, D3D9_TYPE_SURFACE, target);
}
