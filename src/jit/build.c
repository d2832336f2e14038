#include "jit/build.h"

#include "base/mxcsr.h"
#include "jit/jit.h"

#include <pthread.h>
#include <sys/mman.h>

static pthread_mutex_t pool_lock = PTHREAD_MUTEX_INITIALIZER;
static struct builder *pool;

/* Pages that nothing has touched yet: calloc would clear all of them where malloc had freed that much before.
 */
static struct builder *create(void)
{
    void *memory =
        mmap(NULL, sizeof(struct builder), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return memory == MAP_FAILED ? NULL : memory;
}

struct builder *builder_take(struct error *error)
{
    pthread_mutex_lock(&pool_lock);
    struct builder *builder = pool;
    if (builder)
        pool = builder->next;
    pthread_mutex_unlock(&pool_lock);
    if (!builder)
        builder = create();
    if (!builder)
        error_set(error, "out of memory for building a routine (%zu bytes)", sizeof *builder);
    return builder;
}

void builder_give(struct builder *builder)
{
    pthread_mutex_lock(&pool_lock);
    builder->next = pool;
    pool = builder;
    pthread_mutex_unlock(&pool_lock);
}

/* Of an observer that checks what each pass leaves before the caller's sees it. */
struct check {
    pass_observer *observer;
    void *context;
    struct error *error;
    int failed;
};

static void check_pass(void *context, enum pass pass, const struct ir *ir)
{
    struct check *check = context;
    char made[32];
    snprintf(made, sizeof made, "what pass %s left", jit_pass_name(pass));
    if (!check->failed)
        check->failed = ir_check(ir, made, check->error);
    if (check->observer)
        check->observer(check->context, pass, ir);
}

/* Returns 0, or -1 with the reason in a build that checks. */
static int optimize_checked(struct builder *b, const struct build_options *options, pass_observer *observer,
                            void *context, struct error *error)
{
    struct check check = {observer, context, error, 0};
    if (!IR_CHECKED) {
        optimize(&b->ir, &b->pass, options->profile, options->disabled, observer, context);
        return 0;
    }
    if (ir_check(&b->ir, "the recording", error))
        return -1;
    optimize(&b->ir, &b->pass, options->profile, options->disabled, check_pass, &check);
    return check.failed ? -1 : ir_check(&b->ir, "what the passes left", error);
}

static size_t build_stages(struct builder *b, const struct build_options *options, enum unit unit,
                           const union key *key, pass_observer *observer, void *context, struct error *error)
{
    if (b->ir.overflow) {
        error_set(error, "the %s routine takes more than %d operations", unit_name[unit], IR_CAPACITY - 1);
        return 0;
    }
    b->pass.lanes = options->width;
    if (optimize_checked(b, options, observer, context, error))
        return 0;
    struct register_file file = options->file;
    file.wide = options->width == 16;
    allocate(&b->ir, &b->allocation, &file);
    b->emitter.ir = &b->ir;
    b->emitter.allocation = &b->allocation;
    b->emitter.width = options->width;
    b->emitter.length = length_of(options->width);
    return emit_routine(&b->emitter, unit, key, error);
}

size_t build_code(struct builder *b, const struct build_options *options, enum unit unit,
                  const union key *key, pass_observer *observer, void *context, struct error *error)
{
    unsigned saved = mxcsr_enter();
    ir_record(&b->ir, unit, key);
    size_t bytes = build_stages(b, options, unit, key, observer, context, error);
    mxcsr_leave(saved);
    return bytes;
}

size_t build_recording(struct builder *b, const struct ir *ir, const struct build_options *options,
                       enum unit unit, const union key *key, pass_observer *observer, void *context,
                       struct error *error)
{
    unsigned saved = mxcsr_enter();
    ir_duplicate(&b->ir, ir);
    size_t bytes = build_stages(b, options, unit, key, observer, context, error);
    mxcsr_leave(saved);
    return bytes;
}
