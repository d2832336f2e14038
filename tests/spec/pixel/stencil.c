/* Stencil, on every engine: every comparison and operation, both windings, masks, the order of alpha, stencil
 * and depth tests, formats of 1, 4 and 8 bits, and clears. The test computes the expected contents of every
 * pixel from the definition in spec/pixel/stencil.h. */
#include "tests/support/picture/canvas.h"

#include <stdio.h>
#include <string.h>

enum { CELL = 8, CELLS = SIZE / CELL, ROUNDS = 90 };

struct side {
    uint32_t function, fail, depth_fail, pass; /* Direct3D 9's numbers */
    uint32_t reference, mask, write_mask;
};

/* All states on which the effect of a draw depends. */
struct setting {
    struct side side[2]; /* clockwise, counter-clockwise */
    uint32_t depth_function;
    int two_sided, separate, depth_on, depth_writes, alpha_test, counterclockwise, color_writes;
};

static uint8_t stencil[SIZE * SIZE], got[SIZE * SIZE];
static float depth[SIZE * SIZE], got_depth[SIZE * SIZE];
static uint32_t color[SIZE * SIZE];
static uint32_t maximum; /* of the format's stencil */

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void put(enum triptych_state state, uint32_t value)
{
    OK(triptych_set_state(device, state, value));
}

static void use_format(enum triptych_depth_format format)
{
    struct triptych_target_description description = {.width = SIZE, .height = SIZE, .depth_format = format};
    OK(triptych_set_target_description(device, &description));
    maximum = (1u << triptych_stencil_bits(format)) - 1;
}

/* Fills every cell of the target with its own stencil, depth (0.25, 0.5 or 0.75) and colour. */
static void fill_cells(void)
{
    put(TRIPTYCH_STATE_SCISSORTESTENABLE, 1);
    for (unsigned y = 0; y < CELLS; y++)
        for (unsigned x = 0; x < CELLS; x++) {
            uint32_t value = random_word() % 300, word = random_word() & 0x00ffffff;
            float z = 0.25f * (float)(1 + random_word() % 3), channels[4];
            for (int c = 0; c < 4; c++)
                channels[c] = (float)channel(word, c) / 255.0f;
            OK(triptych_set_scissor(device, x * CELL, y * CELL, CELL, CELL));
            OK(triptych_clear_buffers(device, 7, channels, z, value));
            for (unsigned i = 0; i < CELL * CELL; i++) {
                unsigned p = (y * CELL + i / CELL) * SIZE + x * CELL + i % CELL;
                stencil[p] = (uint8_t)(value & maximum);
                depth[p] = z;
                color[p] = word;
            }
        }
    put(TRIPTYCH_STATE_SCISSORTESTENABLE, 0);
}

static int compares(uint32_t function, double a, double b)
{
    TEST_ASSERT_LESS_OR_EQUAL_UINT32_MESSAGE(8, function, "a comparison without an expected value");
    int order = a < b ? 1 : a == b ? 2 : 4;
    return (function - 1) & order ? 1 : 0;
}

static uint32_t operated(uint32_t operation, uint32_t s, uint32_t reference)
{
    switch (operation) {
    case 1: return s;
    case 2: return 0;
    case 3: return reference & maximum;
    case 4: return s == maximum ? s : s + 1;
    case 5: return s ? s - 1 : 0;
    case 6: return maximum - s;
    case 7: return s == maximum ? 0 : s + 1;
    case 8: return s ? s - 1 : maximum;
    }
    TEST_FAIL_MESSAGE("a stencil operation without an expected value");
    return 0;
}

static void expect_drawn(const struct setting *s, uint32_t word, float z, int p)
{
    const struct side *side = &s->side[s->two_sided && s->counterclockwise];
    const struct side *values = s->separate ? side : &s->side[0];
    if (s->alpha_test && (texel[p] >> 24) < 128)
        return;
    uint32_t mask = values->mask & maximum, old = stencil[p];
    int passes = compares(side->function, values->reference & mask, old & mask);
    int nearer = !s->depth_on || compares(s->depth_function, (double)z, (double)depth[p]);
    uint32_t operation = !passes ? side->fail : !nearer ? side->depth_fail : side->pass;
    uint32_t new = operated(operation, old, values->reference);
    stencil[p] = (uint8_t)((old & ~values->write_mask) | (new & values->write_mask &maximum));
    if (!passes || !nearer)
        return;
    if (s->depth_on && s->depth_writes)
        depth[p] = z;
    if (s->color_writes)
        color[p] = s->alpha_test ? texel[p] : word;
}

/* Unbinds the texture, so that pixels have the diffuse colour. */
static void unbind_texture(void)
{
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg2");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg2");
}

/* One of the state's words, also one that was added to the table. */
static uint32_t random_value(enum triptych_state state)
{
    const struct triptych_kind *kind = triptych_state_at(TRIPTYCH_RENDER_STATES, state)->kind;
    unsigned count = 0;
    while (triptych_value_at(kind, count))
        count++;
    return triptych_value_at(kind, random_word() % count)->number;
}

static uint32_t random_mask(void)
{
    return random_word() % 4 ? 0xffffffff : random_word() & random_word();
}

static struct side random_side(void)
{
    return (struct side){random_value(TRIPTYCH_STATE_STENCILFUNC),
                         random_value(TRIPTYCH_STATE_STENCILFAIL),
                         random_value(TRIPTYCH_STATE_STENCILZFAIL),
                         random_value(TRIPTYCH_STATE_STENCILPASS),
                         random_word() % 3 ? random_word() % 16 : random_word() % 256,
                         random_mask(),
                         random_mask()};
}

static struct setting random_setting(void)
{
    return (struct setting){.side = {random_side(), random_side()},
                            .depth_function = random_value(TRIPTYCH_STATE_ZFUNC),
                            .two_sided = (int)(random_word() & 1),
                            .separate = (int)(random_word() & 1),
                            .depth_on = random_word() % 4 != 0,
                            .depth_writes = (int)(random_word() & 1),
                            .alpha_test = random_word() % 3 == 0,
                            .counterclockwise = (int)(random_word() & 1),
                            .color_writes = random_word() % 4 != 0};
}

static void apply(const struct setting *s)
{
    float mirror[4][4] = {{s->counterclockwise ? -1 : 1}, {[1] = 1}, {[2] = 1}, {[3] = 1}};
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_WORLD, (const float(*)[4])mirror));
    put(TRIPTYCH_STATE_STENCILENABLE, 1);
    put(TRIPTYCH_STATE_STENCILFUNC, s->side[0].function);
    put(TRIPTYCH_STATE_STENCILFAIL, s->side[0].fail);
    put(TRIPTYCH_STATE_STENCILZFAIL, s->side[0].depth_fail);
    put(TRIPTYCH_STATE_STENCILPASS, s->side[0].pass);
    put(TRIPTYCH_STATE_CCW_STENCILFUNC, s->side[1].function);
    put(TRIPTYCH_STATE_CCW_STENCILFAIL, s->side[1].fail);
    put(TRIPTYCH_STATE_CCW_STENCILZFAIL, s->side[1].depth_fail);
    put(TRIPTYCH_STATE_CCW_STENCILPASS, s->side[1].pass);
    put(TRIPTYCH_STATE_TWOSIDEDSTENCILMODE, (uint32_t)s->two_sided);
    put(TRIPTYCH_STATE_STENCILSEPARATE, (uint32_t)s->separate);
    put(TRIPTYCH_STATE_STENCILREF, s->side[0].reference);
    put(TRIPTYCH_STATE_STENCILMASK, s->side[0].mask);
    put(TRIPTYCH_STATE_STENCILWRITEMASK, s->side[0].write_mask);
    put(TRIPTYCH_STATE_CCW_STENCILREF, s->side[1].reference);
    put(TRIPTYCH_STATE_CCW_STENCILMASK, s->side[1].mask);
    put(TRIPTYCH_STATE_CCW_STENCILWRITEMASK, s->side[1].write_mask);
    put(TRIPTYCH_STATE_ZENABLE, (uint32_t)s->depth_on);
    put(TRIPTYCH_STATE_ZFUNC, s->depth_function);
    put(TRIPTYCH_STATE_ZWRITEENABLE, (uint32_t)s->depth_writes);
    put(TRIPTYCH_STATE_ALPHATESTENABLE, (uint32_t)s->alpha_test);
    put(TRIPTYCH_STATE_ALPHAFUNC, 7);
    put(TRIPTYCH_STATE_ALPHAREF, 128);
    put(TRIPTYCH_STATE_COLORWRITEENABLE, s->color_writes ? 15 : 0);
    if (s->alpha_test)
        bind_random_texture(SIZE, SIZE);
    else
        unbind_texture();
}

/* Expects these contents. Depths are multiples of a quarter, and a format changes them by less than its
 * step. */
static void expect_contents(const struct setting *s, const char *format)
{
    char what[256];
    snprintf(what, sizeof what,
             "%s: functions %u %u, fail %u %u, depth fail %u %u, pass %u %u, references %u %u, masks %x %x, "
             "write masks "
             "%x %x, two-sided %d, separate %d, counter-clockwise %d, depth %d %u, alpha test %d",
             format, s->side[0].function, s->side[1].function, s->side[0].fail, s->side[1].fail,
             s->side[0].depth_fail, s->side[1].depth_fail, s->side[0].pass, s->side[1].pass,
             s->side[0].reference, s->side[1].reference, s->side[0].mask, s->side[1].mask,
             s->side[0].write_mask, s->side[1].write_mask, s->two_sided, s->separate, s->counterclockwise,
             s->depth_on, s->depth_function, s->alpha_test);
    OK(triptych_read_stencil(device, got, sizeof got));
    OK(triptych_read_depth(device, got_depth, sizeof got_depth));
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        if (stencil[p] != got[p])
            TEST_ASSERT_EQUAL_UINT8_MESSAGE(stencil[p], got[p], what);
        if (depth[p] != got_depth[p])
            TEST_ASSERT_FLOAT_WITHIN_MESSAGE(0x1p-14f, depth[p], got_depth[p], what);
        expect_pixel(p % SIZE, p / SIZE, color[p], what);
    }
}

static void draw_and_follow(const struct setting *s)
{
    float z = 0.25f * (float)(1 + random_word() % 3);
    uint32_t packed = random_word();
    apply(s);
    if (s->counterclockwise)
        draw_square(z, packed, NULL, 1, 0, 0, 1);
    else
        draw_square(z, packed, NULL, 0, 0, 1, 1);
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_drawn(s, image_word(packed), z, p);
}

static void check_operations(void)
{
    static const enum triptych_depth_format formats[] = {TRIPTYCH_DEPTH_D24S8, TRIPTYCH_DEPTH_D24X4S4,
                                                         TRIPTYCH_DEPTH_D15S1, TRIPTYCH_DEPTH_D24FS8};
    for (int round = 0; round < ROUNDS; round++) {
        enum triptych_depth_format format = formats[round % 9 < 6 ? 0 : round % 9 - 5];
        use_format(format);
        fill_cells();
        struct setting setting = random_setting();
        for (int draw = 0; draw < 2; draw++)
            draw_and_follow(&setting);
        expect_contents(&setting, triptych_depth_format_name(format));
    }
}

static void test_tests_and_operations_are_as_defined(void)
{
    on_every_engine(check_operations);
}

/* Culling removes one winding. The other one still uses its own states of two-sided mode. */
static void check_culled(void)
{
    for (int round = 0; round < 4; round++) {
        int counterclockwise = round & 1;
        struct setting setting = {.side = {{8, 1, 1, 7, 0, 255, 255}, {8, 1, 1, 4, 0, 255, 15}},
                                  .depth_function = 8,
                                  .two_sided = 1,
                                  .separate = round >> 1,
                                  .counterclockwise = counterclockwise,
                                  .color_writes = 1};
        setting.side[1].pass = 8; /* decr */
        use_format(TRIPTYCH_DEPTH_D24S8);
        fill_cells();
        set(TRIPTYCH_STATE_CULLMODE, counterclockwise ? "cw" : "ccw");
        draw_and_follow(&setting);
        expect_contents(&setting, "culled");
        set(TRIPTYCH_STATE_CULLMODE, counterclockwise ? "ccw" : "cw");
        apply(&setting);
        draw_square(0.25f, 0xffffffff, NULL, 0, 0, 1, 1);
        expect_contents(&setting, "culled away");
        set(TRIPTYCH_STATE_CULLMODE, "none");
    }
}

/* The clockwise side replaces 200 by its reference in the upper four bits, the other one in the lower four;
 * then each side is drawn again where its own reference and mask find what is left. */
static void check_separate(void)
{
    struct setting setting = {.side = {{8, 1, 1, 3, 0x5a, 255, 0xf0}, {8, 1, 1, 3, 0xa6, 255, 0x0f}},
                              .depth_function = 8,
                              .two_sided = 1,
                              .separate = 1,
                              .color_writes = 1};
    use_format(TRIPTYCH_DEPTH_D24S8);
    OK(triptych_clear_buffers(device, 7, (const float[4]){0, 0, 0, 0}, 1, 200)); /* 0xc8 */
    for (int p = 0; p < SIZE * SIZE; p++)
        stencil[p] = 200, depth[p] = 1, color[p] = 0;
    draw_and_follow(&setting);
    TEST_ASSERT_EQUAL_HEX8(0x58, stencil[0]);
    setting.counterclockwise = 1;
    draw_and_follow(&setting);
    TEST_ASSERT_EQUAL_HEX8(0x56, stencil[0]);
    expect_contents(&setting, "replaced");
    setting.side[0] = (struct side){3, 1, 1, 1, 0x5f, 0xf0, 255}; /* 0x50 equals 0x50 */
    setting.side[1] = (struct side){3, 1, 1, 7, 0x5f, 0x0f, 255}; /* 0x0f does not equal 0x06 */
    draw_and_follow(&setting);
    expect_contents(&setting, "the other side's test fails");
    setting.counterclockwise = 0;
    draw_and_follow(&setting);
    expect_contents(&setting, "the first side's test passes");
}

static void test_each_side_can_have_its_own_reference_and_masks(void)
{
    on_every_engine(check_separate);
}

static void test_culling_leaves_one_windings_states(void)
{
    on_every_engine(check_culled);
}

/* Formats without stencil ignore the stencil states. */
static void check_without(void)
{
    static const enum triptych_depth_format formats[] = {TRIPTYCH_DEPTH_D16, TRIPTYCH_DEPTH_D32,
                                                         TRIPTYCH_DEPTH_D24X8, TRIPTYCH_DEPTH_D32F_LOCKABLE,
                                                         TRIPTYCH_DEPTH_NONE};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        use_format(formats[i]);
        put(TRIPTYCH_STATE_STENCILENABLE, 1);
        put(TRIPTYCH_STATE_STENCILFUNC, 1);
        OK(triptych_clear_buffers(device, TRIPTYCH_CLEAR_COLOR, (const float[4]){0, 0, 0, 0}, 0, 0));
        draw_square(0.5f, 0xff336699, NULL, 0, 0, 1, 1);
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p++)
            expect_pixel(p % SIZE, p / SIZE, image_word(0xff336699), "a target without stencil");
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_read_stencil(device, got, sizeof got));
        TEST_ASSERT_NOT_NULL(strstr(triptych_error(device), "expected one with stencil"));
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL,
                              triptych_clear_buffers(device, TRIPTYCH_CLEAR_STENCIL, NULL, 0, 0));
    }
}

static void test_formats_without_stencil_have_no_test(void)
{
    on_every_engine(check_without);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_tests_and_operations_are_as_defined);
    RUN_TEST(test_each_side_can_have_its_own_reference_and_masks);
    RUN_TEST(test_culling_leaves_one_windings_states);
    RUN_TEST(test_formats_without_stencil_have_no_test);
    return UNITY_END();
}
