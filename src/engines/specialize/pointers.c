/* Self-modifying code, as in Massalin's Synthesis: before a run, the addresses of the job are written into
 * the code, where each gather has its address as an immediate.
 *
 * The arena's pages stay as they are: code is written through the writable view, no address is both writable
 * and executable (machine/code.h). Two rules make that sound with several threads:
 *
 *   - A copy is written only while it has no users, so no thread executes bytes that change. A thread becomes
 *     a user with the lock held, and only of a copy that has its addresses.
 *   - A write ends by serializing all cores that run this process, before the lock is released. Therefore no
 *     core that runs the copy afterwards has fetched its old bytes.
 *
 * The second rule needs a system call for each write, about a microsecond with one thread and several with
 * more, which is the price of patching. */
#include "engines/specialize/pointers.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static_assert(offsetof(struct vertex_arguments, job) == 0 && offsetof(struct setup_arguments, job) == 0 &&
                  offsetof(struct pixel_arguments, job) == 0,
              "all arguments begin with the job");

struct pointer_copy {
    struct code_span span; /* empty: not made yet */
    unsigned users;        /* threads that run it */
    uint64_t age;          /* of its last use: the number of runs before it */
    bool written;
};

struct pointers {
    struct routine routine;
    struct routine_patches patches; /* written under the lock, read without it */
    struct code_arena *arena;
    pthread_mutex_t lock;
    pthread_cond_t unused; /* a copy has no users any more */
    uint64_t runs;
    unsigned most; /* copies */
    struct pointer_copy copy[POINTER_COPIES];
    uint32_t bytes;
    uint32_t places;        /* of literals in the code */
    uint32_t fields;        /* different ones */
    int32_t *field;         /* offsets in the job */
    uint16_t *number;       /* of each place: its field */
    struct code_word *word; /* of each place; scratch memory for a write */
    uint64_t *value;        /* of each copy in turn: its pointers, a word for each field */
    uint8_t *code;          /* as it was built */
};

static void count(uint64_t *counter)
{
    __atomic_store_n(counter, *counter + 1, __ATOMIC_RELAXED);
}

/* --- Pointers ------------------------------------------------------------------------------------------- */

static uint64_t *values_of(const struct pointers *p, const struct pointer_copy *copy)
{
    return p->value + (size_t)(copy - p->copy) * p->fields;
}

static uint64_t pointer_in(const struct job *job, int32_t field)
{
    uint64_t value;
    memcpy(&value, (const uint8_t *)job + field, sizeof value);
    return value;
}

static bool has_pointers(const struct pointers *p, const struct pointer_copy *copy, const struct job *job)
{
    const uint64_t *value = values_of(p, copy);
    for (uint32_t f = 0; f < p->fields; f++)
        if (value[f] != pointer_in(job, p->field[f]))
            return false;
    return copy->written;
}

static void write_pointers(struct pointers *p, struct pointer_copy *copy, const struct job *job)
{
    uint64_t *value = values_of(p, copy);
    for (uint32_t f = 0; f < p->fields; f++)
        value[f] = pointer_in(job, p->field[f]);
    for (uint32_t n = 0; n < p->places; n++)
        p->word[n].value = value[p->number[n]];
    code_patch(p->arena, &copy->span, p->word, p->places);
    copy->written = true;
    count(&p->patches.writes);
}

/* --- Copies --------------------------------------------------------------------------------------------- */

/* Returns 0, or -1 if the arena has no room. */
static int make_copy(struct pointers *p, struct pointer_copy *copy, struct error *error)
{
    if (code_reserve(p->arena, p->bytes, &copy->span, error))
        return -1;
    memcpy(copy->span.writable, p->code, p->bytes);
    code_commit(p->arena, &copy->span, p->bytes);
    count(&p->patches.copies);
    return 0;
}

static struct pointer_copy *find_written(struct pointers *p, const struct job *job)
{
    for (unsigned n = 0; n < p->patches.copies; n++)
        if (has_pointers(p, p->copy + n, job))
            return p->copy + n;
    return NULL;
}

/* The copy without users that was used longest ago; null: all have users. */
static struct pointer_copy *find_unused(struct pointers *p)
{
    struct pointer_copy *found = NULL;
    for (unsigned n = 0; n < p->patches.copies; n++)
        if (!p->copy[n].users && (!found || p->copy[n].age < found->age))
            found = p->copy + n;
    return found;
}

/* A copy to write to, a new one while there may be more; null: the thread must wait. The first copy is
 * there from the start, so a thread that waits is woken. */
static struct pointer_copy *find_writable(struct pointers *p)
{
    struct error error;
    struct pointer_copy *next = p->copy + p->patches.copies;
    if (!p->copy[0].written)
        return p->copy;
    if (p->patches.copies < p->most && !make_copy(p, next, &error))
        return next;
    return find_unused(p);
}

static struct pointer_copy *take_copy(struct pointers *p, const struct job *job)
{
    pthread_mutex_lock(&p->lock);
    struct pointer_copy *copy;
    while (!(copy = find_written(p, job))) {
        if ((copy = find_writable(p))) {
            write_pointers(p, copy, job);
            break;
        }
        count(&p->patches.waits);
        pthread_cond_wait(&p->unused, &p->lock);
    }
    copy->users++;
    copy->age = p->runs++;
    pthread_mutex_unlock(&p->lock);
    return copy;
}

static void give_copy(struct pointers *p, struct pointer_copy *copy)
{
    pthread_mutex_lock(&p->lock);
    if (!--copy->users)
        pthread_cond_broadcast(&p->unused);
    pthread_mutex_unlock(&p->lock);
}

static void run(const void *arguments, const struct routine *routine)
{
    struct pointers *p = (struct pointers *)(uintptr_t)routine; /* its first member */
    const struct job *job = *(const struct job *const *)arguments;
    struct pointer_copy *copy = take_copy(p, job);
    routine_function *code;
    memcpy(&code, &copy->span.executable, sizeof code);
    code(arguments, routine);
    give_copy(p, copy);
}

/* --- Making a routine ----------------------------------------------------------------------------------- */

static uint16_t number_field(struct pointers *p, int32_t field)
{
    uint32_t number = 0;
    while (number < p->fields && p->field[number] != field)
        number++;
    if (number == p->fields)
        p->field[p->fields++] = field;
    return (uint16_t)number;
}

static int allocate_pointers(struct pointers *p)
{
    const size_t n = p->places;
    p->field = calloc(n, sizeof *p->field);
    p->number = calloc(n, sizeof *p->number);
    p->word = calloc(n, sizeof *p->word);
    p->value = calloc(n * p->most, sizeof *p->value);
    p->code = malloc(p->bytes);
    return p->field && p->number && p->word && p->value && p->code ? 0 : -1;
}

static int fill(struct pointers *p, const struct emitter *m, struct error *error)
{
    if (allocate_pointers(p))
        return error_set(error, "out of memory for the pointers of a routine");
    for (uint32_t n = 0; n < p->places; n++) {
        p->number[n] = number_field(p, m->pointer[n].field);
        p->word[n].offset = m->pointer[n].offset;
    }
    memcpy(p->code, m->code, p->bytes);
    return make_copy(p, p->copy, error);
}

static struct pointers *create(struct code_arena *arena, size_t bytes, enum addresses addresses)
{
    struct pointers *p = calloc(1, sizeof *p);
    if (!p)
        return NULL;
    p->arena = arena;
    p->bytes = (uint32_t)bytes;
    p->most = addresses == ADDRESSES_SHARED ? POINTER_COPIES : 1;
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->unused, NULL);
    return p;
}

struct routine *specialize_pointers_routine(const struct builder *b, struct code_arena *arena, size_t bytes,
                                            enum addresses addresses, struct error *error)
{
    if (!code_can_patch(arena))
        return error_set(error, "addresses in code need the system call membarrier"), NULL;
    struct pointers *p = create(arena, bytes, addresses);
    if (!p)
        return error_set(error, "out of memory for a routine"), NULL;
    p->places = b->emitter.pointers;
    if (fill(p, &b->emitter, error)) {
        specialize_pointers_free(&p->routine);
        return NULL;
    }
    p->routine.code = p->copy[0].span.executable;
    p->routine.run = run;
    p->routine.patches = &p->patches;
    return &p->routine;
}

void specialize_pointers_free(struct routine *routine)
{
    struct pointers *p = (struct pointers *)(void *)routine;
    for (unsigned n = 0; n < p->patches.copies; n++)
        code_free(p->arena, &p->copy[n].span);
    pthread_mutex_destroy(&p->lock);
    pthread_cond_destroy(&p->unused);
    free(p->field);
    free(p->number);
    free(p->word);
    free(p->value);
    free(p->code);
    free(p);
}

bool specialize_pointers_match(const struct builder *b, const struct routine *routine)
{
    const struct pointers *p = (const void *)routine;
    return !memcmp(b->emitter.code, p->code, p->bytes);
}
