/* The register contract of every fragment: each is executed by itself, with canaries in everything that it
 * must not change.
 *
 * A fragment may change only the registers that it lists as given or clobbered. Its outputs, its writes to
 * memory and its jumps may depend only on the registers that it lists as read: it runs twice, with other
 * random bits in the rest. Register holes get random registers, in several rounds. A fragment writes only
 * to the stack frame and to the memory of the bases, and leaves MXCSR and the direction flag unchanged.
 *
 * The memory of the bases is filled with one word of 64 bits that is a valid pointer, the small integers 0
 * and 8192, and two tiny floats. Every address that a fragment loads from there is valid. */
#define _GNU_SOURCE
#include "machine/code.h"
#include "machine/mxcsr.h"
#include "engines/stitch/plan.h"
#include "engines/stitch/stitch.h"
#include "tests/support/differential/trampoline.h"

#include <string.h>
#include <sys/mman.h>
#include <unity.h>

enum {
    REGION_BYTES = 64 << 10, /* of one base */
    REGIONS = 8,
    MEMORY_BYTES = REGIONS * REGION_BYTES,
    STACK_BYTES = 16 << 10,
    FRAME_OFFSET = 8 << 10, /* of rsp in the stack */
    FRAME_BYTES = 2 << 10,
    ENTER_BYTES = 1 << 10, /* below rsp, for the one fragment that makes a frame */
    RECORD_BYTES = 256,
    VECTORS = 15, /* that are given to holes */
    ROUNDS = 8    /* with other registers in the holes */
};
#define MEMORY_ADDRESS  0x200000000000ull
#define MAPPED_BYTES    (1ull << 30)
#define DIRECTION_FLAG  0x400u
#define MXCSR_CONTROL   0xffc0u
#define MXCSR_SOMETHING 0x7f80u /* the caller's, in these tests */

static struct code_arena *arena;
static uint8_t *memory;
static alignas(64) uint8_t stack[STACK_BYTES];
static const union key no_state;
static char message[256];
static uint64_t seed;

static uint64_t random_word(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return seed * 0x2545f4914f6cdd1dull;
}

static void fill_memory(void)
{
    for (size_t i = 0; i < MEMORY_BYTES; i += 8)
        memcpy(memory + i, &(uint64_t){MEMORY_ADDRESS}, 8);
    for (size_t i = 0; i < STACK_BYTES; i += 4)
        memcpy(stack + i, &(uint32_t){(uint32_t)(i % 256 * 4)}, 4);
}

/* The saved stack frame that `leave` restores, at the end of the frame's bytes. */
static void fill_frame_end(void)
{
    uint8_t *end = stack + FRAME_OFFSET + FRAME_BYTES - 16;
    memcpy(end - 44, &(uint32_t){MXCSR_SOMETHING}, 4);
    memcpy(end + 8, &(const void *){trampoline_exit}, sizeof(void *));
}

/* Random bits in all registers, then valid values in the registers that the fragment reads: bases,
 * constants, small integers in vectors. */
static void fill_registers(struct machine_state *in, uint32_t read)
{
    for (size_t i = 0; i < 16 * 32; i += 8)
        memcpy(&in->ymm[0][0] + i, &(uint64_t){random_word()}, 8);
    for (size_t i = 0; i < sizeof in->zmm_high; i += 8)
        memcpy(&in->zmm_high[0][0] + i, &(uint64_t){random_word()}, 8);
    for (int r = 0; r < 16; r++)
        in->general[r] = random_word();
    for (int n = 0; n < 16; n++)
        for (uint32_t lane = 0; lane < 8 && read >> (REGISTER_VECTORS + n) & 1; lane++)
            memcpy(&in->ymm[n][4 * lane], &(uint32_t){lane * 12 + (uint32_t)n}, 4);
    uint64_t known[16] = {[3] = (uint64_t)(uintptr_t)stitch_constants, [6] = 16, [7] = MEMORY_ADDRESS};
    for (int r = REGISTER_BASES; r < 16; r++)
        known[r] = MEMORY_ADDRESS + (uint64_t)(r - REGISTER_BASES) * REGION_BYTES + 1024;
    known[12] = read & 1 << 12 ? RECORD_BYTES : known[12];
    known[15] = read & 1 << 12 ? 3 * RECORD_BYTES : 0x1ff;
    for (int r = 0; r < 16; r++)
        if (read >> r & 1)
            in->general[r] = known[r];
    in->general[REGISTER_FRAME] = (uint64_t)(uintptr_t)(stack + FRAME_OFFSET);
    if (read >> REGISTER_FRAME_END & 1)
        in->general[REGISTER_FRAME_END] = (uint64_t)(uintptr_t)(stack + FRAME_OFFSET + FRAME_BYTES - 16);
    in->mxcsr = MXCSR_CONTRACT;
}

/* Different vector registers, and the frame or a base for an address hole. */
static void fill_register_arguments(const struct fragment *fragment, union arguments *arguments)
{
    unsigned next = (unsigned)(random_word() % VECTORS);
    for (int n = 0; n < ARGUMENT_COUNT; n++)
        if ((fragment->given | fragment->read) >> n & 1)
            arguments->value[n] = (int32_t)(next = (next + 1 + random_word() % 3) % VECTORS);
    unsigned base = (unsigned)(random_word() % 8);
    if (fragment->based)
        arguments->value[ARGUMENT_BASE] = base == 7 ? REGISTER_FRAME : REGISTER_BASES + (int32_t)base;
}

/* Valid arguments for the holes: by kind, and by name if a number has a special meaning. */
static union arguments plausible_arguments(const struct fragment *fragment)
{
    union arguments arguments;
    const char *name = stitch_fragment_text(fragment).arguments;
    for (int n = 0; n < ARGUMENT_COUNT; n++) {
        arguments.value[n] = 64 * (n + 1);
        if (name && !strncmp(name, "mxcsr", 5))
            arguments.value[n] = MXCSR_CONTRACT;
        if (name && !strncmp(name, "frame", 5))
            arguments.value[n] = -640;
        if (name && (!strncmp(name, "stride", 6) || !strncmp(name, "bytes", 5)))
            arguments.value[n] = RECORD_BYTES;
        name = name ? strchr(name, ' ') : NULL;
        name = name ? name + 1 : NULL;
    }
    for (unsigned i = 0; i < fragment->holes; i++)
        if (fragment->hole[i].kind == HOLE_JUMP)
            arguments.value[fragment->hole[i].argument] = 2;
        else if (fragment->hole[i].kind == HOLE_BYTE)
            arguments.value[fragment->hole[i].argument] = 0;
    fill_register_arguments(fragment, &arguments);
    return arguments;
}

/* jmp [rip + 0], and the address after it. */
static struct fragment jump_to(uint8_t code[14], const char *target)
{
    static const uint8_t jump[6] = {0xff, 0x25, 0, 0, 0, 0};
    memcpy(code, jump, sizeof jump);
    memcpy(code + sizeof jump, &target, sizeof target);
    return (struct fragment){.name = "jump", .code = code, .bytes = 14};
}

static void run(const struct part *part, const struct machine_state *in, struct machine_state *out)
{
    static struct plan plan;
    uint8_t exit_code[14], taken_code[14];
    struct fragment exit = jump_to(exit_code, trampoline_exit),
                    taken = jump_to(taken_code, trampoline_exit_taken);
    struct code_span span;
    struct error error = {{0}};
    plan_enter(&plan);
    plan.count = 0;
    plan_append(&plan, part->fragment, part->arguments);
    plan_append(&plan, &exit, (union arguments){{0}});
    plan_append(&plan, &taken, (union arguments){{0}});
    if (plan_join(&plan, arena, &span, &error))
        TEST_FAIL_MESSAGE(error.text);
    trampoline_run(span.executable, in, out);
    code_free(arena, &span);
}

static const char *violation(const struct fragment *fragment, const char *what, int number)
{
    snprintf(message, sizeof message, "%s: %s %d", fragment->name, what, number);
    return message;
}

static const char *check_registers(const struct part *part, const struct machine_state *in,
                                   const struct machine_state *out)
{
    const struct fragment *fragment = part->fragment;
    uint32_t may_change = part_changes(part);
    for (int r = 0; r < 16; r++)
        if (!(may_change >> r & 1) && in->general[r] != out->general[r])
            return violation(fragment, "changes general-purpose register", r);
    for (int n = 0; n < 16; n++)
        if (!(may_change >> (REGISTER_VECTORS + n) & 1) && memcmp(in->ymm[n], out->ymm[n], 32))
            return violation(fragment, "changes ymm", n);
    for (int n = 0; n < 16; n++)
        if (trampoline_is_wide() && !(may_change >> (REGISTER_VECTORS + n) & 1) &&
            memcmp(in->zmm_high[n], out->zmm_high[n], 32))
            return violation(fragment, "changes the upper half of zmm", n);
    if (out->flags & DIRECTION_FLAG)
        return violation(fragment, "sets the direction flag", 1);
    return NULL;
}

static const char *check_mxcsr(const struct fragment *fragment, const struct machine_state *out)
{
    uint32_t expected = fragment == &fragment_leave ? MXCSR_SOMETHING : MXCSR_CONTRACT;
    return (out->mxcsr & MXCSR_CONTROL) == (expected & MXCSR_CONTROL)
               ? NULL
               : violation(fragment, "leaves MXCSR at", (int)out->mxcsr);
}

/* Only `enter` may write below the frame's lowest word. */
static const char *check_stack(const struct fragment *fragment, const uint8_t *before)
{
    size_t low = FRAME_OFFSET - (fragment == &fragment_enter ? ENTER_BYTES : 0);
    for (size_t i = 0; i < STACK_BYTES; i++)
        if ((i < low || i >= FRAME_OFFSET + FRAME_BYTES) && stack[i] != before[i])
            return violation(fragment, "writes outside of its frame, at stack byte", (int)i);
    return NULL;
}

static int same_outputs(uint32_t given, const struct machine_state *a, const struct machine_state *b)
{
    for (int r = 0; r < 16; r++)
        if (given >> r & 1 && a->general[r] != b->general[r])
            return 0;
    for (int n = 0; n < 16; n++)
        if (given >> (REGISTER_VECTORS + n) & 1 && memcmp(a->ymm[n], b->ymm[n], 32))
            return 0;
    return a->taken == b->taken;
}

/* Returns null, or the violation of the fragment's descriptor. */
static const char *find_part_violation(const struct part *part)
{
    static uint8_t stack_before[STACK_BYTES], stack_after[STACK_BYTES], memory_after[MEMORY_BYTES];
    const struct fragment *fragment = part->fragment;
    struct machine_state in, out[2];
    for (int i = 0; i < 2; i++) {
        fill_memory();
        fill_frame_end();
        memcpy(stack_before, stack, sizeof stack);
        fill_registers(&in, part_reads(part));
        if (fragment->based && part->arguments.value[ARGUMENT_BASE] >= REGISTER_BASES)
            in.general[part->arguments.value[ARGUMENT_BASE]] = MEMORY_ADDRESS + 1024;
        run(part, &in, &out[i]);
        const char *found = check_registers(part, &in, &out[i]);
        found = found ? found : check_mxcsr(fragment, &out[i]);
        found = found ? found : check_stack(fragment, stack_before);
        if (found)
            return found;
        if (!i) {
            memcpy(stack_after, stack, sizeof stack);
            memcpy(memory_after, memory, MEMORY_BYTES);
        }
    }
    /* `enter` saves and `leave` restores registers that they do not list. */
    if (fragment == &fragment_enter || fragment == &fragment_leave)
        return NULL;
    if (!same_outputs(part_gives(part), &out[0], &out[1]) || memcmp(stack_after, stack, sizeof stack) ||
        memcmp(memory_after, memory, MEMORY_BYTES))
        return violation(fragment, "depends on a register that it does not list, run", 2);
    return NULL;
}

static const char *find_violation(const struct fragment *fragment)
{
    const char *found = NULL;
    int rounds = fragment->given | fragment->read ? ROUNDS : 1;
    for (int round = 0; round < rounds && !found; round++) {
        struct part part = {.fragment = fragment, .arguments = plausible_arguments(fragment)};
        found = find_part_violation(&part);
    }
    return found;
}

static void every_fragment_keeps_its_contract(void)
{
    for (const struct fragment *f = __start_stitch_fragments; f < __stop_stitch_fragments; f++) {
        const char *found = find_violation(f);
        if (found)
            TEST_FAIL_MESSAGE(found);
    }
}

/* Fragments with one violation each: the harness reports all kinds. */
static void violations_are_reported(void)
{
    static const struct {
        const char *name;
        uint8_t code[12];
        uint16_t bytes;
        uint32_t in, out;
    } offence[] = {
        {"changes ymm3", {0xc5, 0xe4, 0x57, 0xdb}, 4, 0, 0}, /* vxorps ymm3, ymm3, ymm3 */
        {"changes the upper half of ymm9",
         {0xc4, 0x41, 0x30, 0x57, 0xc9},
         5,
         0,
         0},                                                           /* vxorps xmm9, xmm9, xmm9 */
        {"changes r12", {0x49, 0xff, 0xc4}, 3, 0, 0},                  /* inc r12 */
        {"reads ymm1", {0xc5, 0xfc, 0x28, 0xc1}, 4, 0, 1 << 16},       /* vmovaps ymm0, ymm1 */
        {"reads rcx", {0x48, 0x89, 0xc8}, 3, 0, 1 << 0},               /* mov rax, rcx */
        {"writes below the frame", {0x89, 0x44, 0x24, 0xfc}, 4, 0, 0}, /* mov [rsp - 4], eax */
        {"stores a register", {0x89, 0x04, 0x24}, 3, 0, 0},            /* mov [rsp], eax */
        {"sets the direction flag", {0xfd}, 1, 0, 0},                  /* std */
        {"changes MXCSR", {0xc7, 0x04, 0x24, 0x80, 0x1f, 0, 0, 0x0f, 0xae, 0x14, 0x24}, 11, 0, 0},
        /* mov dword [rsp], 0x1f80; ldmxcsr [rsp] */
    };
    for (size_t i = 0; i < sizeof offence / sizeof *offence; i++) {
        struct fragment f = {.name = offence[i].name,
                             .code = offence[i].code,
                             .bytes = offence[i].bytes,
                             .in = offence[i].in,
                             .out = offence[i].out};
        TEST_ASSERT_NOT_NULL_MESSAGE(find_violation(&f), offence[i].name);
    }
}

/* The arguments that the holes use, as a mask. */
static unsigned used_arguments(const struct fragment *fragment)
{
    unsigned used = 0;
    for (unsigned i = 0; i < fragment->holes; i++) {
        const struct hole *hole = fragment->hole + i;
        TEST_ASSERT_LESS_THAN_MESSAGE(HOLE_KIND_COUNT, hole->kind, fragment->name);
        if (hole->kind == HOLE_VECTOR) {
            unsigned role[] = {hole->argument & 3u, hole->argument >> 2 & 7u, hole->argument >> 5};
            used |= role[0] < 3 ? 1u << role[0] : 0;
            used |= (role[1] < 4 ? 1u << role[1] : 0) | (role[2] < 4 ? 1u << role[2] : 0);
        } else if (hole->kind != HOLE_CONSTANTS && hole->kind != HOLE_LITERALS)
            used |= 1u << hole->argument;
    }
    return used;
}

static void argument_names_match_the_holes(void)
{
    for (const struct fragment *f = __start_stitch_fragments; f < __stop_stitch_fragments; f++) {
        const char *names = stitch_fragment_text(f).arguments;
        TEST_ASSERT_NOT_NULL_MESSAGE(names, f->name);
        unsigned named = 0;
        for (const char *at = names; *at; at += strspn(at, ", "), named++)
            at += strcspn(at, ",");
        TEST_ASSERT_EQUAL_HEX_MESSAGE((1u << named) - 1, used_arguments(f), f->name);
        TEST_ASSERT_EQUAL_HEX_MESSAGE(0, (f->given | f->read) & ~used_arguments(f), f->name);
    }
}

/* A fragment that folds an argument is followed by its form with that argument in memory. */
static void a_form_with_an_operand_in_memory_follows_its_fragment(void)
{
    for (const struct fragment *f = __start_stitch_fragments; f < __stop_stitch_fragments; f++) {
        if (!f->folded)
            continue;
        char name[64];
        snprintf(name, sizeof name, "%s_memory", f->name);
        TEST_ASSERT_LESS_THAN_MESSAGE(__stop_stitch_fragments - f, 1, name);
        TEST_ASSERT_EQUAL_STRING(name, f[1].name);
        TEST_ASSERT_EQUAL_HEX_MESSAGE(f->read & ~(1u << f->folded), f[1].read, name);
        TEST_ASSERT_EQUAL_HEX_MESSAGE(f->given, f[1].given, name);
        TEST_ASSERT_EQUAL_HEX_MESSAGE(f->apart, f[1].apart, name);
        TEST_ASSERT_TRUE_MESSAGE(f[1].based && !f->based && !f[1].folded, name);
    }
}

/* ---- whole routines */

/* Calls the routine as C does, with a stack of its own. The arguments may be those of any unit. */
static void run_routine(const struct routine *routine, const void *call, struct machine_state *in,
                        struct machine_state *out)
{
    static alignas(64) uint8_t routine_stack[64 << 10];
    uint8_t *top = routine_stack + sizeof routine_stack - 64;
    fill_registers(in, 0);
    memcpy(top - 8, &(const void *){trampoline_exit}, sizeof(void *));
    in->general[REGISTER_FRAME] = (uint64_t)(uintptr_t)(top - 8);
    in->general[REGISTER_CALL] = (uint64_t)(uintptr_t)call;
    in->mxcsr = MXCSR_SOMETHING;
    trampoline_run(routine->code, in, out);
}

static void check_convention(const struct engine *engine, enum unit unit, const union key *key,
                             const void *call)
{
    static const uint8_t saved[] = {3, 5, 12, 13, 14, 15}, zero[16];
    struct machine_state in, out;
    struct error error = {{0}};
    struct routine *routine = engine_build(engine, arena, unit, key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    run_routine(routine, call, &in, &out);
    for (size_t i = 0; i < sizeof saved; i++)
        TEST_ASSERT_EQUAL_HEX64_MESSAGE(in.general[saved[i]], out.general[saved[i]], "callee-saved register");
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(in.general[REGISTER_FRAME] + 8, out.general[REGISTER_FRAME], "rsp");
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(MXCSR_SOMETHING, out.mxcsr & MXCSR_CONTROL, "MXCSR");
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(0, out.flags & DIRECTION_FLAG, "direction flag");
    for (int n = 0; n < 16; n++)
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(zero, out.ymm[n] + 16, 16, "upper half of a vector register");
    engine->free(arena, routine);
}

/* Runs the routine with no elements and with some, on zeros. */
static void check_conventions(const struct engine *engine, uint32_t count)
{
    static const struct job job;
    static alignas(64) float batch[SLOT_COUNT * VERTEX_CAPACITY];
    static alignas(64) uint32_t color[TILE_PIXELS], depth[TILE_PIXELS], index[3 * SETUP_CAPACITY];
    static alignas(64) uint8_t records[16 * RECORD_BYTES];
    static const struct entry entry = {.coverage = 0x8001};
    struct lane_table lanes = lane_table;
    struct vertex_arguments vertex = {&job, index, batch, count};
    struct setup_arguments setup = {&job, index, batch, records, count, 0};
    struct pixel_arguments pixel = {&job, &entry, records, &lanes, color, depth, 1, 0};
    union key key = no_state;
    key.vertex.lighting = key.vertex.varying[0] = key.vertex.varying[1] = 1;
    check_convention(engine, UNIT_VERTEX, &key, &vertex);
    key = no_state;
    key.setup.depth = key.setup.varying[0] = 1;
    check_convention(engine, UNIT_SETUP, &key, &setup);
    key = no_state;
    key.pixel.write_mask[0] = 15;
    key.pixel.depth_function = COMPARE_LESS_EQUAL;
    key.pixel.varying[0] = 1;
    check_convention(engine, UNIT_PIXEL, &key, &pixel);
}

static void routines_obey_the_calling_convention(void)
{
    check_conventions(&engine_stitch, 0);
    check_conventions(&engine_stitch, 16);
    check_conventions(&engine_stitch_operation, 0);
    check_conventions(&engine_stitch_operation, 16);
}

static void map_memory(void)
{
    void *wanted = (void *)(uintptr_t)MEMORY_ADDRESS; /* a fixed address is the point */
    memory = mmap(wanted, MAPPED_BYTES, PROT_READ | PROT_WRITE,
                  MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE, -1, 0);
    TEST_ASSERT_EQUAL_PTR(wanted, memory);
}

void setUp(void)
{
    struct error error = {{0}};
    if (engine_unavailable(&engine_stitch))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_stitch));
    seed = 0xca4a41e5;
    if (!memory)
        map_memory();
    arena = code_create(1 << 20, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    code_destroy(arena);
    arena = NULL;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_fragment_keeps_its_contract);
    RUN_TEST(violations_are_reported);
    RUN_TEST(routines_obey_the_calling_convention);
    RUN_TEST(argument_names_match_the_holes);
    RUN_TEST(a_form_with_an_operand_in_memory_follows_its_fragment);
    return UNITY_END();
}
