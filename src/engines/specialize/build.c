#include "engines/specialize/build.h"

#include "base/slab.h"
#include "machine/mxcsr.h"
#include "engines/specialize/sixteen.h"
#include "engines/specialize/specialize.h"
#include "engines/specialize/track.h"

/* The emitter's table of literals is zero in a new builder and after each build. */
static struct slab builders = SLAB(sizeof(struct builder));
SLAB_CLEAR_AT_UNLOAD(builders)

struct builder *specialize_take(struct error *error)
{
    struct builder *builder = slab_take(&builders);
    if (builder)
        builder->pass.rules = builder->emitter.rules = (struct peepholes){0}, builder->hinted = false;
    else
        error_set(error, "out of memory for building a routine (%zu bytes)", sizeof *builder);
    return builder;
}

void specialize_give(struct builder *builder)
{
    emit_give_text(&builder->emitter);
    slab_give(&builders, builder);
}

/* The context of an observer that verifies the result of each pass, and then calls the caller's observer. */
struct check {
    pass_observer *observer;
    void *context;
    struct error *error;
    bool failed;
};

static void check_pass(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    struct check *check = context;
    char name[48] = "a program with calls";
    if (pass < PASS_COUNT)
        snprintf(name, sizeof name, "the result of pass %s", pass_name(pass));
    if (changed && !check->failed)
        check->failed = ir_check(ir, name, check->error) != 0;
    if (check->observer)
        check->observer(check->context, pass, changed, ir);
}

static_assert((int)SUBROUTINES <= (int)SUBROUTINE_CAPACITY, "all subroutines have code");

void specialize_run_passes(struct builder *b, const struct build_options *options, pass_observer *observer,
                           void *context)
{
    const uint32_t passes = pass_select(options->profile, options->enabled, options->disabled);
    b->pass.lanes = options->width;
    b->pass.parts = options->parts;
    b->pass.judges = options->shapes != NULL;
    b->pass.may_pair = options->may_pair;
    b->pass.shapes = options->shapes ? *options->shapes : (struct pass_shapes){0};
    b->pass.rules = (struct peepholes){.without = options->without_rules};
    b->subroutines.count = 0;
    if (!b->ir.span && pass_find_subroutines(&b->ir, &b->subroutines, options->calls,
                                             options->addresses != ADDRESSES_LOADED))
        pass_run_with_subroutines(&b->ir, &b->pass, &b->subroutines, passes, observer, context);
    else
        pass_run_all(&b->ir, &b->pass, passes, observer, context);
}

/* Returns 0, or -1 with the reason if the program is verified (IR_CHECKED) and not valid. */
static int optimize_checked(struct builder *b, const struct build_options *options, pass_observer *observer,
                            void *context, struct error *error)
{
    struct check check = {observer, context, error, false};
    if (!IR_CHECKED) {
        specialize_run_passes(b, options, observer, context);
        return 0;
    }
    if (ir_check(&b->ir, "the recording", error))
        return -1;
    specialize_run_passes(b, options, check_pass, &check);
    return check.failed ? -1 : ir_check(&b->ir, "the result of the passes", error);
}

static size_t too_long(enum unit unit, struct error *error)
{
    error_set(error, "the %s routine takes more than %d operations", unit_name[unit], IR_CAPACITY - 1);
    return 0;
}

static struct register_file file_of(const struct build_options *options)
{
    struct register_file file = options->file;
    file.wide = options->width == 16;
    file.scalar = options->width == 1;
    file.allocator = options->allocator;
    return file;
}

void specialize_write_hints(struct builder *b, const struct build_options *options)
{
    const struct register_file file = file_of(options);
    allocate_write_hints(&b->ir, &b->allocation, &file);
    b->hinted = true;
}

int specialize_allocate(struct builder *b, const struct build_options *options, struct error *error)
{
    struct register_file file = file_of(options);
    file.hinted = b->hinted;
    b->hinted = false;
    allocate_registers(&b->ir, &b->allocation, &file);
    b->emitter.ir = &b->ir;
    b->emitter.rules.without = options->without_rules;
    b->emitter.allocation = &b->allocation;
    b->emitter.width = options->width;
    b->emitter.literal_pointers = options->addresses != ADDRESSES_LOADED;
    b->emitter.length = emit_length_of(options->width);
    b->emitter.textual = options->encoding == ENCODING_TEXT;
    return b->emitter.textual ? emit_take_text(&b->emitter, error) : 0;
}

/* Returns 0, or -1 with the reason if two registers for each value are not expected to be faster than one. */
static int judge(const struct builder *b, const struct build_options *options, struct error *error)
{
    const struct pass_shapes *shapes = &b->pass.shapes;
    if (options->shapes)
        *options->shapes = *shapes;
    if (!options->shapes || options->parts < 2 || specialize_is_worth(shapes))
        return 0;
    return error_set(error, "two registers for each value take %u cycles a block, one takes %u", shapes->two,
                     shapes->one);
}

static size_t build_phases(struct builder *b, const struct build_options *options, enum unit unit,
                           const union key *key, pass_observer *observer, void *context, struct error *error)
{
    if (b->ir.overflow)
        return too_long(unit, error);
    if (optimize_checked(b, options, observer, context, error))
        return 0;
    if (b->ir.overflow)
        return too_long(unit, error);
    if (judge(b, options, error))
        return 0;
    if (specialize_allocate(b, options, error))
        return 0;
    return emit_routine(&b->emitter, unit, key, error);
}

size_t specialize_code(struct builder *b, const struct build_options *options, enum unit unit,
                       const union key *key, pass_observer *observer, void *context, struct error *error)
{
    unsigned saved = mxcsr_enter();
    ir_record(&b->ir, unit, key);
    if (options->track)
        specialize_note_constants(&b->ir, b->constants);
    if (options->burnt)
        specialize_burn(&b->ir, options->burnt);
    size_t bytes = build_phases(b, options, unit, key, observer, context, error);
    mxcsr_leave(saved);
    return bytes;
}

size_t specialize_recording(struct builder *b, const struct ir *ir, const struct build_options *options,
                            enum unit unit, const union key *key, pass_observer *observer, void *context,
                            struct error *error)
{
    unsigned saved = mxcsr_enter();
    ir_duplicate(&b->ir, ir);
    size_t bytes = build_phases(b, options, unit, key, observer, context, error);
    mxcsr_leave(saved);
    return bytes;
}
