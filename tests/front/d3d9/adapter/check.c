/* Formats, modes and capabilities (front/d3d9/adapter): they agree with the renderer's tables. */
#include "front/d3d9/adapter/check.h"
#include "front/d3d9/adapter/caps.h"
#include "tests/support/front/factory.h"

#include <string.h>
#include <unity.h>

enum { HARDWARE = 1, X8 = TRIPTYCH_SURFACE_X8R8G8B8, A8 = TRIPTYCH_SURFACE_A8R8G8B8 };

static struct d3d9_factory *factory;

void setUp(void)
{
    factory = factory_make(true);
}

void tearDown(void)
{
    d3d9_object_release((struct d3d9_object *)factory);
}

static int32_t check(uint32_t usage, uint32_t type, uint32_t format)
{
    return d3d9_factory_check_device_format(factory, 0, HARDWARE, X8, usage, type, format);
}

/* A texture can be made with a format if and only if the renderer can, except for those of AMD's fetch4. */
static void formats_of_textures_are_those_of_the_renderer(void)
{
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    triptych_device *device;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
    const struct d3d9_format *format;
    for (unsigned i = 0; (format = d3d9_format_at(i)); i++) {
        const struct triptych_texture_description d = {TRIPTYCH_TEXTURE_2D, format->number, 4, 4, 1, 1};
        triptych_texture *texture = NULL;
        bool made =
            triptych_texture_define(device, &d, &texture) == TRIPTYCH_OK && strncmp(format->name, "DF", 2);
        TEST_ASSERT_EQUAL_INT_MESSAGE(made, check(0, D3D9_TYPE_TEXTURE, format->number) == D3D9_OK,
                                      format->name);
        triptych_texture_destroy(device, texture);
    }
    triptych_device_destroy(device);
}

static void formats_of_targets_are_those_of_the_renderer(void)
{
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    triptych_device *device;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device, NULL, 0));
    const struct d3d9_format *format;
    for (unsigned i = 0; (format = d3d9_format_at(i)); i++) {
        const struct triptych_target_description d = {
            .width = 4, .height = 4, .color_format = {format->number}};
        bool made = triptych_set_target_description(device, &d) == TRIPTYCH_OK;
        int32_t result = check(D3D9_USAGE_RENDER_TARGET, D3D9_TYPE_SURFACE, format->number);
        TEST_ASSERT_EQUAL_INT_MESSAGE(made, result == D3D9_OK, format->name);
    }
    triptych_device_destroy(device);
}

static void checks_of_formats_refuse_other_adapters_and_displays(void)
{
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_factory_check_device_format(factory, 1, HARDWARE, X8, 0,
                                                                                D3D9_TYPE_TEXTURE, A8));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_factory_check_device_format(factory, 0, HARDWARE, 0, 0,
                                                                                D3D9_TYPE_TEXTURE, A8));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE, d3d9_factory_check_device_format(factory, 0, HARDWARE, A8, 0,
                                                                                 D3D9_TYPE_TEXTURE, A8));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, check(0, D3D9_TYPE_VERTEX_BUFFER, D3D9_FORMAT_VERTEX_DATA));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE, check(0, D3D9_TYPE_TEXTURE, TRIPTYCH_SURFACE_P8));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK,
                            check(D3D9_USAGE_RENDER_TARGET, D3D9_TYPE_TEXTURE, TRIPTYCH_SURFACE_NULL));
    TEST_ASSERT_EQUAL_INT32(D3D9_NO_AUTOMATIC_MIPS,
                            check(D3D9_USAGE_AUTOMATIC_MIPS, D3D9_TYPE_TEXTURE, TRIPTYCH_SURFACE_DXT5));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE, check(D3D9_USAGE_QUERY_SRGB_WRITE, D3D9_TYPE_SURFACE, A8));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE, check(0, D3D9_TYPE_SURFACE, TRIPTYCH_SURFACE_D24S8));
}

/* The extension is announced by a format that no resource can have. */
static void alpha_to_coverage_is_announced(void)
{
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, check(0, D3D9_TYPE_SURFACE, TRIPTYCH_TESSELLATION_ATOC));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE, check(0, D3D9_TYPE_TEXTURE, TRIPTYCH_TESSELLATION_ATOC));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE,
                            check(D3D9_USAGE_RENDER_TARGET, D3D9_TYPE_SURFACE, TRIPTYCH_TESSELLATION_ATOC));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE,
                            d3d9_check_format(0, D3D9_TYPE_SURFACE, TRIPTYCH_TESSELLATION_ATOC));
}

static void device_types_depend_on_displays_and_modes(void)
{
    const struct {
        uint32_t display, back_buffer;
        bool windowed, expected;
    } cases[] = {
        {X8, A8, true, true},
        {X8, A8, false, true},
        {X8, 0, true, true},
        {X8, 0, false, false},
        {A8, A8, true, false},
        {X8, TRIPTYCH_SURFACE_R5G6B5, true, true},
        {X8, X8, false, true},
        {X8, TRIPTYCH_SURFACE_R5G6B5, false, false},
        {TRIPTYCH_SURFACE_X1R5G5B5, TRIPTYCH_SURFACE_X1R5G5B5, false, false},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        int32_t result = d3d9_factory_check_device_type(factory, 0, HARDWARE, cases[i].display,
                                                        cases[i].back_buffer, cases[i].windowed);
        const char number[] = {(char)('0' + i), 0};
        TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].expected, result == D3D9_OK, number);
    }
}

static void samples_have_quality_levels(void)
{
    uint32_t levels = 0;
    TEST_ASSERT_EQUAL_INT32(
        D3D9_OK, d3d9_factory_check_device_multi_sample_type(factory, 0, HARDWARE, X8, 1, 1, &levels));
    TEST_ASSERT_EQUAL_UINT32(3, levels);
    TEST_ASSERT_EQUAL_UINT32(8, d3d9_check_samples(1, 2));
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_check_samples(1, 3));
    TEST_ASSERT_EQUAL_UINT32(4, d3d9_check_samples(4, 0));
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_check_samples(0, 1));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE, d3d9_factory_check_device_multi_sample_type(
                                                    factory, 0, HARDWARE, X8, 1, 15, &levels));
    TEST_ASSERT_EQUAL_UINT32(1, levels);
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_factory_check_device_multi_sample_type(
                                                   factory, 0, HARDWARE, X8, 1, 65536, &levels));
}

static void modes_are_those_of_the_host(void)
{
    struct d3d9_display_mode mode;
    TEST_ASSERT_EQUAL_UINT32(3, d3d9_factory_get_adapter_mode_count(factory, 0, X8));
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_factory_get_adapter_mode_count(factory, 0, A8));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_factory_enum_adapter_modes(factory, 0, X8, 2, &mode));
    TEST_ASSERT_EQUAL_UINT32(75, mode.refresh_rate);
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_factory_enum_adapter_modes(factory, 0, X8, 3, &mode));
    struct d3d9_display_mode_ex ex = {0};
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL,
                            d3d9_factory_get_adapter_display_mode_ex(factory, 0, &ex, NULL));
    ex.size = sizeof ex;
    uint32_t rotation = 0;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_factory_get_adapter_display_mode_ex(factory, 0, &ex, &rotation));
    TEST_ASSERT_EQUAL_UINT32(640, ex.width);
    TEST_ASSERT_EQUAL_UINT32(1, ex.scan_line_ordering);
    TEST_ASSERT_EQUAL_UINT32(1, rotation);
    struct d3d9_luid luid;
    d3d9_factory_get_adapter_luid(factory, 0, &luid);
    TEST_ASSERT_EQUAL_INT32(5, luid.high);
}

/* Numbers of Direct3D's documentation for a device with everything that the tables have. */
static void capabilities_follow_from_the_tables(void)
{
    struct d3d9_caps caps;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_factory_get_device_caps(factory, 0, HARDWARE, &caps));
    TEST_ASSERT_EQUAL_HEX32(0xff, caps.z_cmp_caps);
    TEST_ASSERT_EQUAL_HEX32(0xffff, caps.src_blend_caps);
    TEST_ASSERT_EQUAL_HEX32(0xe7ff, caps.dest_blend_caps); /* not the two for both factors */
    TEST_ASSERT_EQUAL_HEX32(0x1ff, caps.stencil_caps);
    TEST_ASSERT_EQUAL_HEX32(0x3f, caps.texture_address_caps);
    TEST_ASSERT_EQUAL_HEX32(0x7030700, caps.texture_filter_caps);
    TEST_ASSERT_EQUAL_HEX32(0x3ffffff, caps.texture_op_caps);
    TEST_ASSERT_EQUAL_UINT32(16, caps.max_anisotropy);
    TEST_ASSERT_EQUAL_HEX32(0x40000, caps.raster_caps & 0x40000);
    TEST_ASSERT_EQUAL_HEX32(0x20, caps.line_caps & 0x20); /* antialiasedlineenable */
    TEST_ASSERT_EQUAL_FLOAT(64, caps.max_point_size);
    TEST_ASSERT_EQUAL_UINT32(1, caps.number_of_adapters_in_group);
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE, d3d9_factory_get_device_caps(factory, 0, 2, &caps));
    d3d9_caps_fill(0, false, &caps); /* the factors of a second colour are those of Direct3D 9Ex */
    TEST_ASSERT_EQUAL_HEX32(0x3fff, caps.src_blend_caps);
    TEST_ASSERT_EQUAL_HEX32(0x27ff, caps.dest_blend_caps);
}

static void the_identifier_names_the_display(void)
{
    struct d3d9_adapter_identifier identifier;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_factory_get_adapter_identifier(factory, 0, 0, &identifier));
    TEST_ASSERT_EQUAL_STRING("\\\\.\\DISPLAY1", identifier.device_name);
    TEST_ASSERT_EQUAL_STRING_LEN("Triptych", identifier.description, 8);
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL,
                            d3d9_factory_get_adapter_identifier(factory, 1, 0, &identifier));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(formats_of_textures_are_those_of_the_renderer);
    RUN_TEST(formats_of_targets_are_those_of_the_renderer);
    RUN_TEST(checks_of_formats_refuse_other_adapters_and_displays);
    RUN_TEST(alpha_to_coverage_is_announced);
    RUN_TEST(device_types_depend_on_displays_and_modes);
    RUN_TEST(samples_have_quality_levels);
    RUN_TEST(modes_are_those_of_the_host);
    RUN_TEST(capabilities_follow_from_the_tables);
    RUN_TEST(the_identifier_names_the_display);
    return UNITY_END();
}
