/* Memory for recordings, reused: one is megabytes of address space, of which little is touched. */
#include "base/mxcsr.h"
#include "ir/ir.h"

#include <pthread.h>
#include <sys/mman.h>

struct recording {
    struct ir ir;
    struct recording *next;
};

static pthread_mutex_t pool_lock = PTHREAD_MUTEX_INITIALIZER;
static struct recording *pool;

static struct recording *take_memory(void)
{
    pthread_mutex_lock(&pool_lock);
    struct recording *recording = pool;
    if (recording)
        pool = recording->next;
    pthread_mutex_unlock(&pool_lock);
    if (recording)
        return recording;
    void *memory =
        mmap(NULL, sizeof(struct recording), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return memory == MAP_FAILED ? NULL : memory;
}

struct ir *ir_take(enum unit unit, const union key *key, struct error *error)
{
    struct recording *recording = take_memory();
    if (!recording) {
        error_set(error, "out of memory for a recording (%zu bytes)", sizeof *recording);
        return NULL;
    }
    unsigned saved = mxcsr_enter();
    ir_record(&recording->ir, unit, key);
    mxcsr_leave(saved);
    if (recording->ir.overflow)
        error_set(error, "the %s routine takes more than %d operations", unit_name[unit], IR_CAPACITY - 1);
    else if (!IR_CHECKED || !ir_check(&recording->ir, "the recording", error))
        return &recording->ir;
    ir_give(&recording->ir);
    return NULL;
}

void ir_give(struct ir *ir)
{
    struct recording *recording = (struct recording *)(void *)ir;
    pthread_mutex_lock(&pool_lock);
    recording->next = pool;
    pool = recording;
    pthread_mutex_unlock(&pool_lock);
}
