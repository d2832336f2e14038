/* Unwind information is correct at every instruction. Routines of every engine and unit are executed one
 * instruction at a time. At each instruction the tests' own unwinder and the unwinder of the process find the
 * caller with all its registers. */
#include "machine/code.h"
#include "machine/cpu.h"
#include "debug/debug.h"
#include "debug/dwarf.h"
#include "engines/list.h"
#include "engines/specialize/build.h"
#include "tests/support/shader/program.h"
#include "tests/support/routine/stepper.h"
#include "tests/support/picture/varied.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>
#include <unwind.h>

enum { RBX = 3, RBP = 6, RSP = 7, R12 = 12, R15 = 15, RETURN_ADDRESS = 16, BYTES_MAXIMUM = 1 << 20 };

static struct {
    const uint8_t *code;
    size_t bytes;
    struct bytes frame;                 /* .eh_frame */
    bool registered;                    /* also with the process's unwinder */
    uint64_t entry[UNWINDER_REGISTERS]; /* at the first instruction */
    uint64_t return_address, cfa;
    uint64_t lowest; /* stack pointer */
    uint32_t instructions, wrong;
    uint32_t wrong_offset;
    const char *reason;
    uint8_t visited[BYTES_MAXIMUM / 8]; /* offsets of instructions */
} seen;

static struct error error;

void setUp(void)
{
    memset(&error, 0, sizeof error);
}

void tearDown(void)
{
    bytes_free(&seen.frame);
}

/* --- Stepping ------------------------------------------------------------------------------------------- */

static void found_wrong(uint64_t at, const char *reason)
{
    if (!seen.wrong++) {
        seen.wrong_offset = (uint32_t)(at - (uintptr_t)seen.code);
        seen.reason = reason;
    }
}

static void check_own(const uint64_t value[UNWINDER_REGISTERS])
{
    static const uint8_t preserved[] = {RBX, RBP, R12, R12 + 1, R12 + 2, R15};
    struct unwinder_frame caller;
    uint64_t at = value[RETURN_ADDRESS];
    const char *reason = unwinder_step(seen.frame.data, seen.frame.count, at, value, &caller);
    if (reason)
        found_wrong(at, reason);
    else if (caller.cfa != seen.cfa)
        found_wrong(at, "the frame's address");
    else if (caller.value[RETURN_ADDRESS] != seen.return_address)
        found_wrong(at, "the return address");
    else
        for (size_t i = 0; i < sizeof preserved; i++)
            if (caller.value[preserved[i]] != seen.entry[preserved[i]])
                found_wrong(at, "a register that the caller keeps its value in");
}

struct walk {
    uint64_t at;
    int state; /* 0: before the routine's frame; 1: in it; 2: the caller was found after it */
};

static _Unwind_Reason_Code visit(struct _Unwind_Context *context, void *user)
{
    struct walk *walk = user;
    uint64_t at = _Unwind_GetIP(context);
    if (walk->state == 1) {
        walk->state = at == seen.return_address && _Unwind_GetCFA(context) == seen.cfa ? 2 : 3;
        return _URC_NORMAL_STOP;
    }
    if (at == walk->at)
        walk->state = 1;
    return _URC_NO_REASON;
}

/* Unwinds from the handler through the signal's frame to the routine. */
static void check_process(uint64_t at)
{
    struct walk walk = {.at = at};
    _Unwind_Backtrace(visit, &walk);
    if (walk.state != 2)
        found_wrong(at, "the process's unwinder does not find the caller");
}

static void look(void *user, const uint64_t value[UNWINDER_REGISTERS])
{
    uint64_t at = value[RETURN_ADDRESS], offset = at - (uintptr_t)seen.code;
    (void)user;
    if (!seen.instructions++) {
        memcpy(seen.entry, value, sizeof seen.entry);
        memcpy(&seen.return_address, (const void *)(uintptr_t)value[RSP], sizeof seen.return_address);
        seen.cfa = seen.lowest = value[RSP] + 8;
    }
    if (value[RSP] < seen.lowest)
        seen.lowest = value[RSP];
    seen.visited[offset / 8] |= (uint8_t)(1 << offset % 8);
    check_own(value);
    if (seen.registered && !seen.wrong)
        check_process(at);
}

/* Describes the routine; every row must be reached. */
static void begin_looking(const struct debug_code *code)
{
    bytes_free(&seen.frame);
    memset(&seen, 0, sizeof seen);
    TEST_ASSERT_FALSE(code->failed);
    TEST_ASSERT_TRUE(code->unwinds > 4 && code->bytes < BYTES_MAXIMUM);
    dwarf_frame(code, DWARF_EH_FRAME, &seen.frame);
    TEST_ASSERT_FALSE(seen.frame.failed);
    seen.code = code->code;
    seen.bytes = code->bytes;
}

static void end_looking(const struct debug_code *code, const char *name, uint32_t instructions)
{
    char message[256];
    snprintf(message, sizeof message, "%s: %u of %u instructions, first at offset 0x%x: %s", name, seen.wrong,
             seen.instructions, seen.wrong_offset, seen.reason ? seen.reason : "");
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, seen.wrong, message);
    TEST_ASSERT_TRUE_MESSAGE(seen.instructions >= instructions, message);
    for (uint32_t i = 0; i < code->unwinds; i++) {
        uint32_t offset = code->unwind[i].offset;
        TEST_ASSERT_TRUE_MESSAGE(seen.visited[offset / 8] >> offset % 8 & 1,
                                 "a row is not at an instruction");
    }
}

/* --- Routines of a rendered picture -------------------------------------------------------------------- */

static const struct engine *real;
static struct {
    unsigned calls[UNIT_COUNT];
    unsigned operations; /* routines of the stitcher that are not of stages */
    uint64_t largest;    /* frame of a vertex routine, bytes */
} stepped;

enum { CALLS_EACH = 3 };

typedef void step_function(const void *first, const void *second);

static void step(const void *call, const struct routine *routine)
{
    step_function *function;
    struct debug_code code = {.code = routine->code};
    memcpy(&function, &routine->code, sizeof function);
    if (stepped.calls[routine->unit]++ >= CALLS_EACH) {
        function(call, routine);
        return;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, real->describe(routine, &code, &error), error.text);
    begin_looking(&code);
    seen.registered = true;
    stepper_call(function, call, routine, code.code, code.bytes, look, NULL);
    end_looking(&code, real->name, 60);
    stepped.operations += routine->granularity && !strcmp(routine->granularity, "operation");
    if (routine->unit == UNIT_VERTEX && seen.cfa - seen.lowest > stepped.largest)
        stepped.largest = seen.cfa - seen.lowest;
    debug_code_free(&code);
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *reason)
{
    (void)self;
    struct routine *routine = engine_build(real, arena, unit, key, reason);
    if (routine)
        routine->run = step;
    return routine;
}

static void every_instruction_of_every_engine_finds_its_caller(void)
{
    static struct varied_image expected, found;
    unsigned engines = 0;
    varied_render(engine_find("emulate"), &(struct device_options){.threads = 1}, 0, 6, &expected);
    for (unsigned i = 0; (real = engine_at(i)); i++) {
        struct engine stepping = *real;
        if (!real->describe || engine_unavailable(real))
            continue;
        memset(&stepped, 0, sizeof stepped);
        stepping.build = build;
        varied_render(&stepping, &(struct device_options){.threads = 1, .debug = "unwind"}, 0, 6, &found);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &found, sizeof found, real->name);
        for (int unit = 0; unit < UNIT_COUNT; unit++)
            TEST_ASSERT_TRUE_MESSAGE(stepped.calls[unit] >= CALLS_EACH, real->name);
        TEST_ASSERT_TRUE(strcmp(real->name, "stitch-operation") || stepped.operations >= 3 * CALLS_EACH);
        engines++;
    }
    TEST_ASSERT_TRUE(engines >= 5);
}

/* --- Large frames, whose pages are touched before rsp has its final value --------------------- */

/* All registers change in a loop, so that each component is a variable of its own. */
static void write_shader(char *text, size_t capacity)
{
    size_t at =
        (size_t)snprintf(text, capacity, "vs_3_0\ndcl_position v0\ndcl_position o0\ndefi i0, 2, 0, 1, 0\n");
    for (int i = 0; i < 32; i++)
        at += (size_t)snprintf(text + at, capacity - at, "mov r%d, v0\n", i);
    at += (size_t)snprintf(text + at, capacity - at, "rep i0\n");
    for (int i = 0; i < 32; i++)
        at += (size_t)snprintf(text + at, capacity - at, "add r%d, r%d, r%d\n", i, i, (i + 7) % 32);
    at += (size_t)snprintf(text + at, capacity - at, "endrep\n");
    for (int i = 1; i < 32; i++)
        at += (size_t)snprintf(text + at, capacity - at, "max r0, r0, r%d\n", i);
    snprintf(text + at, capacity - at, "mov o0, r0\n");
}

static void draw_shaded(const struct engine *engine, struct varied_image *image)
{
    static char text[8192];
    triptych_device *device;
    triptych_shader *shader;
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        TRIPTYCH_OK,
        device_create(engine, &(struct device_options){.threads = 1, .debug = "unwind"}, &device, &error),
        error.text);
    write_shader(text, sizeof text);
    varied_begin(device);
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK,
                                  triptych_shader_assemble(device, "large", text, strlen(text), &shader),
                                  triptych_error(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_vertex_shader(device, shader));
    varied_draw(device, 0);
    varied_read(device, image);
    triptych_device_destroy(device);
}

static void a_frame_of_several_pages_finds_its_caller_at_every_instruction(void)
{
    static const char *const names[] = {"stitch", "stitch-operation"};
    static struct varied_image expected, found;
    draw_shaded(engine_find("emulate"), &expected);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        real = engine_find(names[i]);
        struct engine stepping = *real;
        stepping.build = build;
        memset(&stepped, 0, sizeof stepped);
        draw_shaded(&stepping, &found);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &found, sizeof found, real->name);
        TEST_ASSERT_TRUE_MESSAGE(stepped.largest > 4096, real->name);
    }
}

/* A routine of the specializer whose frame is too large for unrolled probes: all values are alive together.
 */
static void record_values(struct ir *ir, int count)
{
    static uint16_t alive[IR_CAPACITY];
    ir_start(ir);
    alive[0] = ir_append(ir, (struct ir_instruction){.op = IR_load, .type = TYPE_itg, .base = BASE_INPUT});
    for (int i = 1; i < count; i++)
        alive[i] =
            ir_append(ir, (struct ir_instruction){
                              .op = IR_mul_i, .type = TYPE_itg, .operand = {alive[i - 1], alive[i - 1]}});
    for (int i = 1; i < count; i++)
        alive[0] = ir_append(
            ir, (struct ir_instruction){.op = IR_xor_i, .type = TYPE_itg, .operand = {alive[0], alive[i]}});
    ir_append(ir, (struct ir_instruction){.op = IR_store, .base = BASE_OUTPUT, .operand = {alive[0]}});
}

static void describe_built(const struct builder *builder, const void *code, struct debug_code *described)
{
    const struct emitter *m = &builder->emitter;
    *described = (struct debug_code){.code = code, .bytes = m->code_bytes};
    for (uint32_t i = 0; i < m->unwinds; i++)
        debug_add_unwind(described, m->unwind[i].offset, m->unwind[i].rule, m->unwind[i].reg,
                         m->unwind[i].value);
}

static void run_large(struct builder *builder, struct code_arena *arena, int values)
{
    static struct program_data data;
    struct code_span span;
    struct debug_code code;
    step_function *function;
    uint64_t seed = 1;
    record_values(&builder->ir, values);
    struct register_file file = allocate_register_file(ALLOCATABLE, 8);
    allocate_registers(&builder->ir, &builder->allocation, &file);
    size_t bytes = program_emit(builder, 8, &error);
    TEST_ASSERT_TRUE_MESSAGE(bytes && !code_reserve(arena, bytes, &span, &error), error.text);
    memcpy(span.writable, builder->emitter.code, bytes);
    const void *start = code_commit(arena, &span, bytes);
    memcpy(&function, &start, sizeof function);
    program_fill(&data, &seed);
    struct vertex_arguments call = {&data.job, data.input, data.output, 16};
    describe_built(builder, start, &code);
    begin_looking(&code);
    stepper_call(function, &call, NULL, start, bytes, look, NULL);
    end_looking(&code, "large", (uint32_t)values);
    debug_code_free(&code);
    code_free(arena, &span);
}

static void frames_that_are_touched_in_a_loop_find_their_caller(void)
{
    enum { SLOT = 32, FEW = 1000, MANY = 2500, UNROLLED = 16 * 4096 };
    struct code_arena *arena = code_create(0, NULL, &error);
    struct builder *builder = specialize_take(&error);
    TEST_ASSERT_TRUE_MESSAGE(arena && builder, error.text);
    run_large(builder, arena, FEW);
    TEST_ASSERT_TRUE(seen.cfa - seen.lowest < UNROLLED && seen.cfa - seen.lowest > FEW * SLOT / 2);
    run_large(builder, arena, MANY);
    TEST_ASSERT_TRUE(seen.cfa - seen.lowest > UNROLLED);
    specialize_give(builder);
    code_destroy(arena);
}

/* --- Opt-in -------------------------------------------------------------------------------------------- */

/* If it is not enabled, the process's unwinder ends at the routine. */
static void the_process_unwinds_only_if_enabled(void)
{
    struct code_arena *arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    struct code_span span;
    TEST_ASSERT_EQUAL_INT(0, code_reserve(arena, 64, &span, &error));
    memset(span.writable, 0x90, 63);
    span.writable[63] = 0xc3;
    struct debug_code code = {
        .name = "nothing", .code = code_commit(arena, &span, 64), .bytes = 64, .folder = ""};
    debug_add_unwind(&code, 0, DEBUG_CFA, 4, 8);
    step_function *function;
    memcpy(&function, &code.code, sizeof function);
    for (int told = 0; told < 3; told++) {
        struct debug_record *record = told == 1 ? debug_add(1 << DEBUG_unwind, &code, &error) : NULL;
        bytes_free(&seen.frame);
        memset(&seen, 0, sizeof seen);
        dwarf_frame(&code, DWARF_EH_FRAME, &seen.frame);
        seen.code = code.code;
        seen.bytes = code.bytes;
        seen.registered = true;
        stepper_call(function, NULL, NULL, code.code, code.bytes, look, NULL);
        TEST_ASSERT_EQUAL_UINT32(64, seen.instructions);
        TEST_ASSERT_EQUAL_INT(told == 1, seen.wrong == 0);
        debug_remove(record);
    }
    debug_code_free(&code);
    code_destroy(arena);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_instruction_of_every_engine_finds_its_caller);
    RUN_TEST(a_frame_of_several_pages_finds_its_caller_at_every_instruction);
    RUN_TEST(frames_that_are_touched_in_a_loop_find_their_caller);
    RUN_TEST(the_process_unwinds_only_if_enabled);
    return UNITY_END();
}
