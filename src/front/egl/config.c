#include "config.h"

#include "calls.h"
#include "display.h"
#include "front/gl/dispatch/dispatch.h"
#include "thread.h"

#include <stdlib.h>

struct color {
    EGLint red, green, blue, alpha;
    enum triptych_surface_format format;
};

struct depth {
    EGLint depth, stencil;
    enum triptych_depth_format format;
};

static const struct color colors[] = {
    {8, 8, 8, 8, TRIPTYCH_SURFACE_A8R8G8B8}, {8, 8, 8, 0, TRIPTYCH_SURFACE_X8R8G8B8},
    {5, 6, 5, 0, TRIPTYCH_SURFACE_R5G6B5},   {5, 5, 5, 1, TRIPTYCH_SURFACE_A1R5G5B5},
    {4, 4, 4, 4, TRIPTYCH_SURFACE_A4R4G4B4}, {10, 10, 10, 2, TRIPTYCH_SURFACE_A2B10G10R10},
};

/* Stencil without depth is in a surface whose depth is not used. */
static const struct depth depths[] = {
    {0, 0, TRIPTYCH_DEPTH_NONE},   {0, 8, TRIPTYCH_DEPTH_D24S8},  {16, 0, TRIPTYCH_DEPTH_D16},
    {24, 0, TRIPTYCH_DEPTH_D24X8}, {24, 8, TRIPTYCH_DEPTH_D24S8},
};

static const unsigned samples[] = {1, 4};

enum {
    COLORS = sizeof colors / sizeof *colors,
    DEPTHS = sizeof depths / sizeof *depths,
    SAMPLES = sizeof samples / sizeof *samples
};
_Static_assert(COLORS *DEPTHS *SAMPLES == EGL_CONFIGS, "each combination is a config");

enum criterion { AT_LEAST, EXACT, MASK, IGNORED };

static const struct attribute {
    EGLint name, initial;
    enum criterion criterion;
} attributes[] = {
#define EGL_ATTRIBUTE(name, criterion, initial) {EGL_##name, initial, criterion},
#include "config_attribute.def"
#undef EGL_ATTRIBUTE
};

static void set_sizes(EGLint *value, const struct color *color, const struct depth *depth, unsigned count)
{
    value[EGL_INDEX_RED_SIZE] = color->red;
    value[EGL_INDEX_GREEN_SIZE] = color->green;
    value[EGL_INDEX_BLUE_SIZE] = color->blue;
    value[EGL_INDEX_ALPHA_SIZE] = color->alpha;
    value[EGL_INDEX_BUFFER_SIZE] = color->red + color->green + color->blue + color->alpha;
    value[EGL_INDEX_DEPTH_SIZE] = depth->depth;
    value[EGL_INDEX_STENCIL_SIZE] = depth->stencil;
    value[EGL_INDEX_SAMPLE_BUFFERS] = count > 1;
    value[EGL_INDEX_SAMPLES] = count > 1 ? (EGLint)count : 0;
    value[EGL_INDEX_BIND_TO_TEXTURE_RGB] = count == 1 && !color->alpha;
    value[EGL_INDEX_BIND_TO_TEXTURE_RGBA] = count == 1 && color->alpha;
}

static void set_kinds(EGLint *value, const struct egl_display *display)
{
    const EGLint interfaces =
        EGL_OPENGL_ES2_BIT | (gl_dispatch_interfaces() & GL_ES1 ? EGL_OPENGL_ES_BIT : 0);
    value[EGL_INDEX_COLOR_BUFFER_TYPE] = EGL_RGB_BUFFER;
    value[EGL_INDEX_CONFIG_CAVEAT] = EGL_NONE;
    value[EGL_INDEX_CONFORMANT] = value[EGL_INDEX_RENDERABLE_TYPE] = interfaces;
    value[EGL_INDEX_MAX_PBUFFER_WIDTH] = TRIPTYCH_TARGET_MAXIMUM;
    value[EGL_INDEX_MAX_PBUFFER_HEIGHT] = TRIPTYCH_TARGET_MAXIMUM;
    value[EGL_INDEX_MAX_PBUFFER_PIXELS] = TRIPTYCH_TARGET_MAXIMUM * TRIPTYCH_TARGET_MAXIMUM;
    value[EGL_INDEX_MAX_SWAP_INTERVAL] = 1;
    value[EGL_INDEX_NATIVE_VISUAL_TYPE] = EGL_NONE;
    value[EGL_INDEX_TRANSPARENT_TYPE] = EGL_NONE;
    value[EGL_INDEX_SURFACE_TYPE] = EGL_PBUFFER_BIT;
    if (display->platform == EGL_PLATFORM_X11_KHR)
        value[EGL_INDEX_SURFACE_TYPE] |= EGL_SWAP_BEHAVIOR_PRESERVED_BIT;
}

/* A config without a visual of its format has no windows. */
static void set_native(EGLint *value, const struct egl_display *display)
{
    if (display->platform != EGL_PLATFORM_X11_KHR)
        return;
    const EGLint bits = value[EGL_INDEX_RED_SIZE] + value[EGL_INDEX_GREEN_SIZE] + value[EGL_INDEX_BLUE_SIZE];
    uint32_t visual = egl_x11_visual(&display->x11, (unsigned)bits);
    value[EGL_INDEX_NATIVE_RENDERABLE] = visual != 0;
    value[EGL_INDEX_NATIVE_VISUAL_ID] = (EGLint)visual;
    value[EGL_INDEX_NATIVE_VISUAL_TYPE] = visual ? EGL_X11_TRUE_COLOR : EGL_NONE;
    value[EGL_INDEX_SURFACE_TYPE] |= visual ? EGL_WINDOW_BIT | EGL_PIXMAP_BIT : 0;
}

static int order(EGLint a, EGLint b)
{
    return (a > b) - (a < b);
}

static const unsigned smaller_first[] = {
    EGL_INDEX_BUFFER_SIZE,  EGL_INDEX_SAMPLE_BUFFERS,     EGL_INDEX_SAMPLES,  EGL_INDEX_DEPTH_SIZE,
    EGL_INDEX_STENCIL_SIZE, EGL_INDEX_NATIVE_VISUAL_TYPE, EGL_INDEX_RED_SIZE, EGL_INDEX_ALPHA_SIZE};

/* The order of configs without requested colours. Caveats and types of all configs are equal. The sizes of
 * red and alpha make it the same everywhere: bytes are before ten bits, and 565 is before 5551. */
static int compare_sizes(const struct egl_config *a, const struct egl_config *b)
{
    for (unsigned i = 0; i < sizeof smaller_first / sizeof *smaller_first; i++) {
        int difference = order(a->value[smaller_first[i]], b->value[smaller_first[i]]);
        if (difference)
            return difference;
    }
    return 0;
}

static int compare(const void *a, const void *b)
{
    return compare_sizes(a, b);
}

void egl_config_make(struct egl_display *display)
{
    struct egl_config *config = display->config;
    for (unsigned i = 0; i < EGL_CONFIGS; i++, config++) {
        const struct color *color = &colors[i / (DEPTHS * SAMPLES)];
        const struct depth *depth = &depths[i / SAMPLES % DEPTHS];
        *config = (struct egl_config){{0}, color->format, depth->format, samples[i % SAMPLES]};
        set_sizes(config->value, color, depth, config->samples);
        set_kinds(config->value, display);
        set_native(config->value, display);
    }
    qsort(display->config, EGL_CONFIGS, sizeof *display->config, compare);
    for (unsigned i = 0; i < EGL_CONFIGS; i++)
        display->config[i].value[EGL_INDEX_CONFIG_ID] = (EGLint)i + 1;
    display->configs = EGL_CONFIGS;
}

const struct egl_config *egl_config_find(const struct egl_display *display, EGLConfig handle)
{
    for (unsigned i = 0; i < display->configs; i++)
        if (handle == &display->config[i])
            return handle;
    return NULL;
}

static int index_of(EGLint name)
{
    for (unsigned i = 0; i < EGL_ATTRIBUTES; i++)
        if (attributes[i].name == name)
            return (int)i;
    return -1;
}

/* --- eglChooseConfig --- */

struct choice {
    EGLint wanted[EGL_ATTRIBUTES];
    EGLNativePixmapType pixmap; /* 0: any */
};

static bool allows_any(EGLint name)
{
    return name != EGL_LEVEL;
}

/* Values that no attribute of its kind has. */
static bool is_value(EGLint name, EGLint value)
{
    switch (name) {
    case EGL_COLOR_BUFFER_TYPE: return value == EGL_RGB_BUFFER || value == EGL_LUMINANCE_BUFFER;
    case EGL_CONFIG_CAVEAT:
        return value == EGL_NONE || value == EGL_SLOW_CONFIG || value == EGL_NON_CONFORMANT_CONFIG;
    case EGL_TRANSPARENT_TYPE: return value == EGL_NONE || value == EGL_TRANSPARENT_RGB;
    case EGL_BIND_TO_TEXTURE_RGB:
    case EGL_BIND_TO_TEXTURE_RGBA:
    case EGL_NATIVE_RENDERABLE: return value == EGL_TRUE || value == EGL_FALSE;
    case EGL_CONFIG_ID: return value > 0;
    case EGL_LEVEL:
    case EGL_NATIVE_VISUAL_ID:
    case EGL_NATIVE_VISUAL_TYPE: return true;
    default: return value >= 0;
    }
}

static bool read_pair(struct choice *choice, EGLint name, EGLint value)
{
    if (name == EGL_MATCH_NATIVE_PIXMAP) {
        choice->pixmap = (EGLNativePixmapType)(uint32_t)value;
        return value != EGL_DONT_CARE;
    }
    int i = index_of(name);
    if (i < 0 || (value == EGL_DONT_CARE ? !allows_any(name) : !is_value(name, value)))
        return false;
    choice->wanted[i] = value;
    return true;
}

static bool read_choice(struct choice *choice, const EGLint *list)
{
    choice->pixmap = 0;
    for (unsigned i = 0; i < EGL_ATTRIBUTES; i++)
        choice->wanted[i] = attributes[i].initial;
    for (; list && *list != EGL_NONE; list += 2)
        if (!read_pair(choice, list[0], list[1]))
            return false;
    return true;
}

static bool fits_attribute(enum criterion criterion, EGLint value, EGLint wanted)
{
    if (wanted == EGL_DONT_CARE)
        return true;
    switch (criterion) {
    case AT_LEAST: return value >= wanted;
    case EXACT: return value == wanted;
    case MASK: return (value & wanted) == wanted;
    default: return true;
    }
}

static bool fits_pixmap(const struct egl_display *display, const struct egl_config *config,
                        EGLNativePixmapType pixmap)
{
    struct egl_x11_size size;
    if (!pixmap)
        return true;
    return display->platform == EGL_PLATFORM_X11_KHR &&
           egl_x11_size(&display->x11, (uint32_t)pixmap, &size) &&
           egl_x11_shows(&size, config->value[EGL_INDEX_BUFFER_SIZE]);
}

/* The identity excludes all other criteria. Values of transparency count only with transparency. */
static bool fits(const struct egl_display *display, const struct egl_config *config,
                 const struct choice *choice)
{
    const EGLint *wanted = choice->wanted;
    if (wanted[EGL_INDEX_CONFIG_ID] != EGL_DONT_CARE)
        return config->value[EGL_INDEX_CONFIG_ID] == wanted[EGL_INDEX_CONFIG_ID];
    for (unsigned i = 0; i < EGL_ATTRIBUTES; i++) {
        bool transparent = i >= EGL_INDEX_TRANSPARENT_RED_VALUE && i <= EGL_INDEX_TRANSPARENT_BLUE_VALUE;
        if (transparent && wanted[EGL_INDEX_TRANSPARENT_TYPE] != EGL_TRANSPARENT_RGB)
            continue;
        if (!fits_attribute(attributes[i].criterion, config->value[i], wanted[i]))
            return false;
    }
    return fits_pixmap(display, config, choice->pixmap);
}

/* Bits of the colours that the program requests with a size. */
static EGLint requested_bits(const struct egl_config *config, const struct choice *choice)
{
    static const unsigned sizes[] = {EGL_INDEX_RED_SIZE, EGL_INDEX_GREEN_SIZE, EGL_INDEX_BLUE_SIZE,
                                     EGL_INDEX_ALPHA_SIZE};
    EGLint bits = 0;
    for (unsigned i = 0; i < 4; i++)
        if (choice->wanted[sizes[i]] > 0)
            bits += config->value[sizes[i]];
    return bits;
}

/* Insertion keeps the order of configs with equal bits, which is that of their numbers. */
static void insert(const struct egl_config **sorted, unsigned count, const struct egl_config *config,
                   const struct choice *choice)
{
    while (count && requested_bits(sorted[count - 1], choice) < requested_bits(config, choice)) {
        sorted[count] = sorted[count - 1];
        count--;
    }
    sorted[count] = config;
}

static EGLint give(const struct egl_config *const *sorted, unsigned found, EGLConfig *configs, EGLint size)
{
    if (!configs)
        return (EGLint)found;
    EGLint count = size < 0 ? 0 : size < (EGLint)found ? size : (EGLint)found;
    for (EGLint i = 0; i < count; i++)
        configs[i] = (EGLConfig)sorted[i];
    return count;
}

static EGLBoolean choose(struct egl_display *display, const EGLint *list, EGLConfig *configs, EGLint size,
                         EGLint *count)
{
    struct choice choice;
    const struct egl_config *sorted[EGL_CONFIGS];
    unsigned found = 0;
    if (!count)
        return egl_fail(EGL_BAD_PARAMETER);
    if (!read_choice(&choice, list))
        return egl_fail(EGL_BAD_ATTRIBUTE);
    for (unsigned i = 0; i < display->configs; i++)
        if (fits(display, &display->config[i], &choice))
            insert(sorted, found++, &display->config[i], &choice);
    *count = give(sorted, found, configs, size);
    return EGL_TRUE;
}

EGLBoolean egl_ChooseConfig(EGLDisplay dpy, const EGLint *list, EGLConfig *configs, EGLint size,
                            EGLint *count)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    EGLBoolean result = choose(display, list, configs, size, count);
    egl_display_leave(display);
    return result;
}

EGLBoolean egl_GetConfigs(EGLDisplay dpy, EGLConfig *configs, EGLint size, EGLint *count)
{
    struct egl_display *display = egl_display_enter(dpy);
    const struct egl_config *all[EGL_CONFIGS];
    if (!display)
        return EGL_FALSE;
    for (unsigned i = 0; i < display->configs; i++)
        all[i] = &display->config[i];
    EGLBoolean result = count ? EGL_TRUE : (EGLBoolean)egl_fail(EGL_BAD_PARAMETER);
    if (result)
        *count = give(all, display->configs, configs, size);
    egl_display_leave(display);
    return result;
}

static EGLBoolean get(struct egl_display *display, EGLConfig handle, EGLint name, EGLint *value)
{
    const struct egl_config *config = egl_config_find(display, handle);
    int i = index_of(name);
    if (!config)
        return egl_fail(EGL_BAD_CONFIG);
    if (i < 0)
        return egl_fail(EGL_BAD_ATTRIBUTE);
    if (!value)
        return egl_fail(EGL_BAD_PARAMETER);
    *value = config->value[i];
    return EGL_TRUE;
}

EGLBoolean egl_GetConfigAttrib(EGLDisplay dpy, EGLConfig config, EGLint name, EGLint *value)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_FALSE;
    EGLBoolean result = get(display, config, name, value);
    egl_display_leave(display);
    return result;
}
