#include "jit/build.h"

#include "base/mxcsr.h"

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

static size_t build_stages(struct builder *b, const struct build_options *options, enum unit unit,
                           const union key *key, pass_observer *observer, void *context, struct error *error)
{
    ir_record(&b->ir, unit, key);
    if (b->ir.overflow) {
        error_set(error, "the %s routine takes more than %d operations", unit_name[unit], IR_CAPACITY - 1);
        return 0;
    }
    optimize(&b->ir, &b->pass, options->profile, options->disabled, observer, context);
    allocate(&b->ir, &b->allocation, options->registers ? options->registers : ALLOCATABLE);
    b->emitter.ir = &b->ir;
    b->emitter.allocation = &b->allocation;
    b->emitter.width = options->width;
    b->emitter.length = options->width == 4 ? X86_128 : X86_256;
    return emit_routine(&b->emitter, unit, key, error);
}

size_t build_code(struct builder *b, const struct build_options *options, enum unit unit,
                  const union key *key, pass_observer *observer, void *context, struct error *error)
{
    unsigned saved = mxcsr_enter();
    size_t bytes = build_stages(b, options, unit, key, observer, context, error);
    mxcsr_leave(saved);
    return bytes;
}
