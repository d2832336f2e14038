/* Each test plants a bug in an engine, and the bisector must name the operation and its line. The linker
 * plants the bugs (Makefile: --wrap), so the engines are those of the library. */
#include "command/fuzz/bisect/bisect.h"
#include "engines/list.h"
#include "engines/external/external.h"
#include "engines/specialize/encode/encode.h"
#include "engines/specialize/passes/pass.h"
#include "engines/stitch/plan.h"
#include "command/support/tool.h"
#include "command/tool/command_line.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

/* --- Plants --------------------------------------------------------------------------------------------- */

/* The bug that is planted now, if any. */
static struct {
    enum ir_op batch_op, batch_becomes;   /* steps of the batch interpreter */
    enum ir_op reduce_op, reduce_becomes; /* pass reduce replaces the first operation by the second */
    unsigned reduce_at;                   /* in this instruction of those with the operation, from 0 */
    bool dead_drops_store;
    bool multiply_adds; /* the specializer's encoder writes vpaddw for vpmullw */
    bool shy;           /* the bug in the specializer is absent when passes receive probes */
    const struct fragment *fragment, *fragment_becomes;
    int32_t argument;                /* added to the fragment's first argument */
    const char *text, *text_becomes; /* of the external engine */
} plant;

static void plant_step(enum ir_op op, enum ir_op becomes)
{
    plant.batch_op = op;
    plant.batch_becomes = becomes;
}

static void plant_fragment(const struct fragment *fragment, const struct fragment *becomes, int32_t argument)
{
    plant.fragment = fragment;
    plant.fragment_becomes = becomes;
    plant.argument = argument;
}

/* As in emu/batch/schedule.h. */
struct schedule_step;
typedef const struct schedule_step *step_function(void *batch, const struct schedule_step *step);

step_function *__real_schedule_step_of(enum ir_op op), *__wrap_schedule_step_of(enum ir_op op);
typedef unsigned pass_function(struct ir *ir, struct pass_memory *memory);
pass_function __real_pass_reduce, __wrap_pass_reduce, __real_pass_dead, __wrap_pass_dead;
typedef void encode_function(struct encoder *, enum x86_vector, enum vector_length, unsigned, unsigned,
                             unsigned);
encode_function __real_encode_rrr, __wrap_encode_rrr;
typedef int join_function(struct plan *, struct code_arena *, struct code_span *, struct error *);
join_function __real_plan_join, __wrap_plan_join;
typedef void *compile_function(const struct external_options *options, const char *text, size_t bytes,
                               struct error *error);
compile_function __real_external_compile, __wrap_external_compile;

step_function *__wrap_schedule_step_of(enum ir_op op)
{
    return __real_schedule_step_of(plant.batch_op && op == plant.batch_op ? plant.batch_becomes : op);
}

/* True if the last program of the passes had probes: only probes store after the tables of the lanes. */
static bool hides;

static void look_for_probes(const struct ir *ir)
{
    hides = false;
    for (uint32_t n = 1; n < ir->count && plant.shy; n++)
        hides |= ir->instruction[n].op == IR_store && ir->instruction[n].base == BASE_LANES;
}

unsigned __wrap_pass_reduce(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = __real_pass_reduce(ir, memory), met = 0;
    look_for_probes(ir);
    for (uint32_t n = 1; n < ir->count && plant.reduce_op && !hides; n++)
        if (ir->instruction[n].op == plant.reduce_op && met++ == plant.reduce_at) {
            ir->instruction[n].op = plant.reduce_becomes;
            return changes + 1;
        }
    return changes;
}

void __wrap_encode_rrr(struct encoder *encoder, enum x86_vector instruction, enum vector_length length,
                       unsigned to, unsigned first, unsigned second)
{
    if (plant.multiply_adds && !hides && instruction == X86_vpmullw)
        instruction = X86_vpaddw;
    __real_encode_rrr(encoder, instruction, length, to, first, second);
}

unsigned __wrap_pass_dead(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = __real_pass_dead(ir, memory);
    for (uint32_t n = 1; n < ir->count && plant.dead_drops_store; n++)
        if (ir->instruction[n].op == IR_store && ir->instruction[n].base == BASE_COLOR) {
            ir->instruction[n] = (struct ir_instruction){.op = IR_nop};
            return changes + 1;
        }
    return changes;
}

int __wrap_plan_join(struct plan *plan, struct code_arena *arena, struct code_span *span, struct error *error)
{
    for (unsigned i = 0; i < plan->count && plant.fragment; i++)
        if (plan->part[i].fragment == plant.fragment) {
            plan->part[i].fragment = plant.fragment_becomes;
            plan->part[i].arguments.value[0] += plant.argument;
        }
    return __real_plan_join(plan, arena, span, error);
}

void *__wrap_external_compile(const struct external_options *options, const char *text, size_t bytes,
                              struct error *error)
{
    char *changed = malloc(bytes + 1);
    TEST_ASSERT_NOT_NULL(changed);
    memcpy(changed, text, bytes);
    changed[bytes] = 0;
    char *routine = strstr(changed, "void routine(");
    for (char *at = routine; plant.text && (at = strstr(at, plant.text));)
        memcpy(at, plant.text_becomes, strlen(plant.text));
    void *object = __real_external_compile(options, changed, bytes, error);
    free(changed);
    return object;
}

/* --- The bisector --------------------------------------------------------------------------------------- */

static struct bisection found;
static struct text printed;

void setUp(void)
{
    memset(&plant, 0, sizeof plant);
}

void tearDown(void)
{
    text_free(&printed);
}

#define VERTICES                                                                                             \
    "triptych 1\n"                                                                                           \
    "target 32 32\n"                                                                                         \
    "vertices corner position:float4 diffuse:color texcoord:float2 {\n"                                      \
    "-1 -1 0.25 1 0xffff8040 0 1\n-1 1 0.25 1 0xff20ff60 0 0\n1 -1 0.75 1 0xff4020ff 1 1\n}\n"               \
    "state lighting false\nstate cullmode none\nbind vertices corner\n"

/* Texture times diffuse. The first draw is behind the viewer and covers no pixel. */
static const char modulate[] = VERTICES "texture t 2 2 { ffc08040 ff4080c0 ff204060 fff0f0f0 }\n"
                                        "clear color 0 0 0 1 depth 1\n"
                                        "transform world translate 0 0 -9\ndraw triangles 0 1\n"
                                        "transform world identity\nframe\n"
                                        "bind texture t\ndraw triangles 0 1\n";

/* A loop of five passes. The operand of the fraction is an integer in the first pass. */
static const char looping[] = VERTICES "shader loops {\n"
                                       "ps_3_0\n"
                                       "defi i0, 5, 0, 1, 0\n"
                                       "def c0, 0.25, 0.375, 0.125, 0.75\n"
                                       "def c1, 0, 1, 2, 3\n"
                                       "mov r0, c1\n"
                                       "rep i0\n"
                                       "frc r1, r0\n"
                                       "add r0, r0, c0\n"
                                       "endrep\n"
                                       "mov oC0, r1\n"
                                       "}\n"
                                       "pixelshader loops\ndraw triangles 0 1\n";

static void run(const char *text, const char *reference, const char *other,
                const struct bisect_options *options)
{
    struct stream *stream;
    struct error error = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("case.tri", text, strlen(text), &stream, &error),
                                  error.text);
    int result = bisect(stream, engine_find(reference), engine_find(other), options, &found, &error);
    stream_free(stream);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
    bisection_print(&found, &printed);
    TEST_ASSERT_FALSE(printed.failed);
}

static bool can_run(const char *engine)
{
    return !engine_unavailable(engine_find(engine));
}

#define NEEDS(engine)                                                                                        \
    if (!can_run(engine))                                                                                    \
    TEST_IGNORE_MESSAGE(engine " cannot run here")

static void names(const char *operation, const char *file)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(BISECT_FOUND, found.outcome, printed.data);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(operation, found.operation, printed.data);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(file, found.place, strlen(file), printed.data);
    TEST_ASSERT_NOT_EQUAL_MESSAGE(found.value[0], found.value[1], printed.data);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(found.expected, found.value[0], printed.data);
}

/* --- Tests ---------------------------------------------------------------------------------------------- */

static void engines_that_agree_are_reported_as_such(void)
{
    static const char *const others[] = {"batch",        "stitch",        "stitch-operation",
                                         "specialize",   "specialize-4",  "specialize-16",
                                         "specialize-1", "specialize-8x2"};
    for (unsigned i = 0; i < sizeof others / sizeof *others; i++) {
        if (!can_run(others[i]))
            continue;
        run(looping, "emulate", others[i], NULL);
        TEST_ASSERT_EQUAL_INT(BISECT_SAME, found.outcome);
        text_free(&printed);
        run(modulate, "emulate", others[i], NULL);
        TEST_ASSERT_EQUAL_INT(BISECT_SAME, found.outcome);
        text_free(&printed);
    }
}

static void an_operation_of_the_batch_interpreter(void)
{
    plant_step(IR_mul_x, IR_add_x);
    run(modulate, "emulate", "batch", NULL);
    names("mul_x", "spec/math/color.h:");
    TEST_ASSERT_EQUAL_INT(UNIT_PIXEL, found.unit);
    TEST_ASSERT_EQUAL_UINT64(1, found.draw);
    TEST_ASSERT_EQUAL_UINT(1, found.frame);
    TEST_ASSERT_EQUAL_UINT(0, found.draw_of_frame);
    TEST_ASSERT_NOT_NULL(strstr(printed.data, ", unit pixel\n"));
}

static void in_a_vertex_routine(void)
{
    plant_step(IR_mad_f, IR_select_f); /* three operands */
    run(modulate, "emulate", "batch", NULL);
    names("mad_f", "spec/");
    TEST_ASSERT_EQUAL_INT(UNIT_VERTEX, found.unit);
    TEST_ASSERT_EQUAL_UINT64(0, found.draw);
}

static void in_a_setup_routine(void)
{
    plant_step(IR_div_f, IR_sub_f);
    run(modulate, "emulate", "batch-16", NULL);
    names("div_f", "spec/");
    TEST_ASSERT_EQUAL_INT(UNIT_SETUP, found.unit);
}

/* Routines that change pixels without a draw: after the last draw, and when the picture is read. */
static void in_a_blit(void)
{
    static const char clears[] = VERTICES "transform world translate 0 0 -9\ndraw triangles 0 1\n"
                                          "clear color 0 1 0 1 part 3 5 9 11\n";
    plant_step(IR_and_m, IR_or_m);
    run(clears, "emulate", "batch", NULL);
    names("and_m", "spec/blit/clear.h:");
    TEST_ASSERT_EQUAL_INT(UNIT_BLIT, found.unit);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(printed.data, ", unit blit\n"), printed.data);
}

static void in_the_average_of_samples(void)
{
    static const char samples[] = "triptych 1\ntarget 32 32 samples 4\nclear color 1 0.5 0 1\n"
                                  "clear color 0 1 0 1 part 3 5 9 11\n";
    plant_step(IR_ushr_x, IR_shl_x);
    run(samples, "emulate", "batch", NULL);
    names("ushr_x", "spec/blit/mean.h:");
}

static void only_the_selected_pixel_is_compared(void)
{
    const struct bisect_options options = {.draw = BISECT_ANY, .x = 7, .y = 20};
    plant_step(IR_mul_x, IR_add_x);
    run(modulate, "emulate", "batch", &options);
    names("mul_x", "spec/math/color.h:");
    TEST_ASSERT_EQUAL_INT(7, found.x);
    TEST_ASSERT_EQUAL_INT(20, found.y);
}

static void only_the_selected_draw_is_compared(void)
{
    const struct bisect_options options = {.draw = 0, .x = BISECT_ANY, .y = BISECT_ANY};
    plant_step(IR_mul_x, IR_add_x);
    run(modulate, "emulate", "batch", &options);
    TEST_ASSERT_EQUAL_INT(BISECT_SAME, found.outcome);
}

static void the_first_pass_of_a_loop_in_which_it_differs(void)
{
    plant_step(IR_floor_f, IR_half_f);
    run(looping, "emulate", "batch", NULL);
    names("floor_f", "spec/shader");
    TEST_ASSERT_TRUE(found.in_loop);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, found.visit_pass, printed.data);
}

static void a_pass_that_is_wrong_is_named_with_the_operation(void)
{
    NEEDS("specialize");
    static const char *const engines[] = {"specialize",    "specialize-4", "specialize-thesis",
                                          "specialize-16", "specialize-1", "specialize-8x2"};
    for (unsigned i = 0; i < sizeof engines / sizeof *engines; i++) {
        if (!can_run(engines[i]))
            continue;
        plant.reduce_op = IR_mul_x;
        plant.reduce_becomes = IR_add_x;
        plant.reduce_at = 1;
        run(modulate, "emulate", engines[i], NULL);
        names("mul_x", "spec/math/color.h:");
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(found.pass, "pass reduce"), printed.data);
        text_free(&printed);
    }
}

static void a_store_that_a_pass_drops_is_named(void)
{
    NEEDS("specialize");
    plant.dead_drops_store = true;
    run(modulate, "emulate", "specialize", NULL);
    names("store", "spec/pixel/write.h:");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(found.pass, "pass dead"), printed.data);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(found.reason, "a store is wrong or missing"), printed.data);
}

static void a_fault_of_the_encoder_is_not_attributed_to_a_pass(void)
{
    NEEDS("specialize");
    plant.multiply_adds = true;
    run(modulate, "emulate", "specialize", NULL);
    names("mul_x", "spec/math/color.h:");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(found.pass, "no pass"), printed.data);
}

/* With probes the difference disappears. The bisector still names the pass, and the store of the first wrong
 * word. */
static void a_pass_that_is_right_when_it_is_probed(void)
{
    NEEDS("specialize");
    plant.reduce_op = IR_mul_x;
    plant.reduce_becomes = IR_add_x;
    plant.shy = true;
    run(modulate, "emulate", "specialize", NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(BISECT_NARROWED, found.outcome, printed.data);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(found.pass, "pass reduce"), printed.data);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(found.reason, "disappear"), printed.data);
    TEST_ASSERT_EQUAL_STRING("store", found.operation);
}

/* The same with a bug after the passes: the result of the passes can be probed. */
static void code_that_is_right_when_its_recording_is_probed(void)
{
    NEEDS("specialize");
    plant.multiply_adds = plant.shy = true;
    run(modulate, "emulate", "specialize", NULL);
    names("mul_x", "spec/math/color.h:");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(found.pass, "no pass"), printed.data);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(found.reason, "found after the passes"), printed.data);
}

/* The stage fragments of the stitcher are the reference. They are correct, so the bisector uses the values of
 * the recording as theirs. */
static void against_stage_fragments(void)
{
    NEEDS("stitch");
    plant_step(IR_mul_x, IR_add_x);
    run(modulate, "stitch", "batch", NULL);
    names("mul_x", "spec/math/color.h:");
    TEST_ASSERT_EQUAL_STRING("", found.fragment);
}

static void an_operation_fragment(void)
{
    NEEDS("stitch-operation");
    plant_fragment(&fragment_mul_x, &fragment_add_x, 0);
    run(modulate, "emulate", "stitch-operation", NULL);
    names("mul_x", "spec/math/color.h:");
}

static void the_specializer_against_the_stitcher(void)
{
    NEEDS("specialize");
    plant_fragment(&fragment_mul_x, &fragment_add_x, 0);
    run(modulate, "specialize", "stitch-operation", NULL);
    names("mul_x", "spec/math/color.h:");
    TEST_ASSERT_EQUAL_STRING("", found.pass);
}

static void a_statement_of_the_external_engine(void)
{
    NEEDS("external");
    plant.text = "mul_x(";
    plant.text_becomes = "add_x(";
    run(modulate, "emulate", "external", NULL);
    names("mul_x", "spec/math/color.h:");
}

static void names_fragment(const char *name)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(BISECT_FOUND, found.outcome, printed.data);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(name, found.fragment, strlen(name), printed.data);
}

static void a_stage_fragment_in_the_middle_of_a_routine(void)
{
    NEEDS("stitch");
    plant_fragment(&fragment_stage_two_modulate, &fragment_stage_two_add, 0);
    run(modulate, "emulate", "stitch", NULL);
    names_fragment("stage_two_modulate, ");
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE("spec/", found.place, 5, printed.data);
}

static void a_stage_fragment_whose_result_is_compared(void)
{
    NEEDS("stitch");
    /* the plane begins a word too late */
    plant_fragment(&fragment_depth_new, &fragment_depth_new, sizeof(float));
    run(modulate, "emulate", "stitch", NULL);
    names_fragment("depth_new, ");
}

static void a_stage_fragment_of_the_vertex_routine(void)
{
    NEEDS("stitch");
    plant_fragment(&fragment_clip_position_w, &fragment_clip_position_w, 4);
    run(modulate, "emulate", "stitch", NULL);
    names_fragment("clip_position_w, ");
    TEST_ASSERT_EQUAL_INT(UNIT_VERTEX, found.unit);
}

static void a_stage_fragment_of_the_setup_routine(void)
{
    NEEDS("stitch");
    plant_fragment(&fragment_smooth_plane, &fragment_smooth_plane, VERTEX_SLOT_BYTES);
    run(modulate, "emulate", "stitch", NULL);
    names_fragment("smooth_plane, ");
    TEST_ASSERT_EQUAL_INT(UNIT_SETUP, found.unit);
}

static void the_report_begins_with_the_line(void)
{
    plant_step(IR_mul_x, IR_add_x);
    run(modulate, "emulate", "batch", NULL);
    TEST_ASSERT_EQUAL_STRING_LEN("spec/math/color.h:", printed.data, 13);
    TEST_ASSERT_NOT_NULL(strstr(printed.data, ": mul_x: emulate "));
    TEST_ASSERT_NOT_NULL(strstr(printed.data, ", batch "));
    TEST_ASSERT_NOT_NULL(strstr(printed.data, "key of the pixel routine: depth_function"));
}

/* Runs the command without its output, and reads its report. */
static void the_command_writes_a_report(void)
{
    char folder[] = "/tmp/bisect-XXXXXX", stream[64], report[64], text[4096] = "";
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(stream, sizeof stream, "%s/case.tri", folder);
    snprintf(report, sizeof report, "%s/report.json", folder);
    FILE *file = fopen(stream, "w");
    fputs(modulate, file);
    fclose(file);
    fflush(stdout);
    int kept = dup(STDOUT_FILENO), nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    plant_step(IR_mul_x, IR_add_x);
    char *arguments[] = {"triptych", "bisect", stream,   "--engines", "emulate,batch",
                         "--pixel",  "7,20",   "--json", report};
    int status = command_line_run(sizeof arguments / sizeof *arguments, arguments);
    fflush(stdout);
    dup2(kept, STDOUT_FILENO);
    close(kept);
    close(nowhere);
    file = fopen(report, "r");
    TEST_ASSERT_NOT_NULL(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    remove(stream);
    remove(report);
    rmdir(folder);
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, status);
    static const char *const parts[] = {"\"outcome\":\t\"found\"",
                                        "\"operation\":\t\"mul_x\"",
                                        "\"place\":\t\"spec/math/color.h:",
                                        "\"x\":\t7",
                                        "\"y\":\t20",
                                        "\"draw\":\t1"};
    for (unsigned i = 0; i < sizeof parts / sizeof *parts; i++)
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, parts[i]), text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(engines_that_agree_are_reported_as_such);
    RUN_TEST(an_operation_of_the_batch_interpreter);
    RUN_TEST(in_a_vertex_routine);
    RUN_TEST(in_a_setup_routine);
    RUN_TEST(in_a_blit);
    RUN_TEST(in_the_average_of_samples);
    RUN_TEST(only_the_selected_pixel_is_compared);
    RUN_TEST(only_the_selected_draw_is_compared);
    RUN_TEST(the_first_pass_of_a_loop_in_which_it_differs);
    RUN_TEST(a_pass_that_is_wrong_is_named_with_the_operation);
    RUN_TEST(a_store_that_a_pass_drops_is_named);
    RUN_TEST(a_fault_of_the_encoder_is_not_attributed_to_a_pass);
    RUN_TEST(a_pass_that_is_right_when_it_is_probed);
    RUN_TEST(code_that_is_right_when_its_recording_is_probed);
    RUN_TEST(against_stage_fragments);
    RUN_TEST(an_operation_fragment);
    RUN_TEST(the_specializer_against_the_stitcher);
    RUN_TEST(a_statement_of_the_external_engine);
    RUN_TEST(a_stage_fragment_in_the_middle_of_a_routine);
    RUN_TEST(a_stage_fragment_whose_result_is_compared);
    RUN_TEST(a_stage_fragment_of_the_vertex_routine);
    RUN_TEST(a_stage_fragment_of_the_setup_routine);
    RUN_TEST(the_report_begins_with_the_line);
    RUN_TEST(the_command_writes_a_report);
    return UNITY_END();
}
