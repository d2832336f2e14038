#include "command/simulate/model.h"

#include "render/queue/phase.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A simulated thread, within a part. */
struct thread {
    double since; /* it has had no work since then */
    double at;    /* when it takes its next run; INFINITY: it does not take part, or has left */
    bool inside;  /* it has taken a run */
};

struct model {
    const struct timeline *timeline;
    const struct handover *costs;
    struct phase *phase; /* its parts give the tasks, but for geometry: */
    uint32_t next;       /* its counter */
    unsigned threads, leader;
    double application;          /* when thread 0 has nothing else to do */
    double counter[PHASE_PARTS]; /* when the counter of a part was last changed */
    double patience;             /* when the leader invites all, unless it has */
    double now;
    struct thread thread[MODEL_THREADS_MAXIMUM];
    struct model_time *time;
};

/* --- Threads join a part -------------------------------------------------------------------------------- */

/* When each thread has its place in the tree of those that wake others: number n wakes 2n + 1 and 2n + 2. */
static double wake_delay(const struct model *model, unsigned number)
{
    return model->costs->wake_ns * floor(log2(number + 1));
}

static bool polls(const struct model *model, unsigned number)
{
    return model->now - model->thread[number].since <= model->costs->poll_ns;
}

/* Invites up to `places` threads besides the leader, from `from` on. */
static void invite(struct model *model, double from, unsigned places, bool sleeping)
{
    unsigned woken = 0;
    for (unsigned i = 0; i < model->threads && places; i++) {
        struct thread *thread = model->thread + i;
        if (i == model->leader || thread->at < INFINITY)
            continue;
        bool polling = polls(model, i);
        if (!polling && !sleeping)
            continue;
        double delay = polling ? model->costs->enter_ns : wake_delay(model, ++woken);
        double ready = i ? from : fmax(from, model->application);
        thread->at = ready + delay;
        places--;
    }
}

/* --- Threads take tasks --------------------------------------------------------------------------------- */

static struct thread *next_thread(struct model *model)
{
    struct thread *next = model->thread;
    for (unsigned i = 1; i < model->threads; i++)
        if (model->thread[i].at < next->at)
            next = model->thread + i;
    return next;
}

/* Only one thread at a time changes a counter, and another one's changes have to be waited for. */
static double take_at(struct model *model, unsigned part, double at)
{
    double begin = fmax(at, model->counter[part]);
    return model->counter[part] = begin + model->costs->take_ns;
}

static unsigned part_of(const struct model *model, uint32_t task)
{
    unsigned part = 0;
    while (part + 1 < model->phase->parts &&
           (uint64_t)model->phase->tasks * (part + 1) / model->phase->parts <= task)
        part++;
    return part;
}

/* Geometry has one counter and is taken task by task. */
static uint32_t take_tasks(struct model *model, unsigned number, const struct timeline_part *part,
                           uint32_t *first)
{
    if (part->kind != TIMELINE_GEOMETRY)
        return phase_take(model->phase, number, first);
    *first = model->next++;
    return *first < part->tasks;
}

/* The run of tasks that a thread takes. Returns false if none is left. */
static bool take(struct model *model, struct thread *thread, const struct timeline_part *part)
{
    uint32_t first, count = take_tasks(model, (unsigned)(thread - model->thread), part, &first);
    if (!count)
        return false;
    thread->inside = true;
    thread->at = take_at(model, part->kind == TIMELINE_GEOMETRY ? 0 : part_of(model, first), thread->at);
    for (uint32_t i = first; i < first + count; i++) {
        double ns = model->timeline->task_ns[part->first + i];
        thread->at += ns;
        model->time->busy += ns;
    }
    return true;
}

/* A thread has found no task. The leader closes the part then, so that no other thread enters. */
static void leave(struct model *model, struct thread *thread, bool *closed, double *end)
{
    bool leads = thread == model->thread + model->leader;
    if (leads || thread->inside) {
        *end = fmax(*end, leads ? thread->at : thread->at + model->costs->leave_ns);
        thread->since = thread->at;
    }
    *closed |= leads;
    thread->at = INFINITY;
}

/* Returns when the last thread has left. */
static double take_all(struct model *model, const struct timeline_part *part, unsigned places)
{
    double end = model->now;
    bool closed = false;
    for (struct thread *thread; (thread = next_thread(model))->at < INFINITY;)
        if (thread->at > model->patience && !closed) {
            double from = model->patience;
            model->patience = INFINITY;
            invite(model, from, places, true);
        } else if ((closed && !thread->inside) || !take(model, thread, part))
            leave(model, thread, &closed, &end);
    return end;
}

static void cut(struct model *model, const struct timeline_part *part, enum pool_call call)
{
    model->next = 0;
    model->phase->call = call;
    phase_cut(model->phase, part->tasks, call == POOL_ALONE ? 1 : model->threads);
    memset(model->counter, 0, sizeof model->counter);
}

static void run_tasks(struct model *model, const struct timeline_part *part)
{
    enum pool_call call = model->threads > 1 ? phase_call_for(part->estimate_ns) : POOL_ALONE;
    unsigned places = part->tasks < model->threads ? part->tasks - 1 : model->threads - 1;
    cut(model, part, call);
    for (unsigned i = 0; i < model->threads; i++)
        model->thread[i] =
            (struct thread){model->thread[i].since, i == model->leader ? model->now : INFINITY, false};
    model->patience = call == POOL_ALL || model->threads == 1 ? INFINITY : model->now + PHASE_PATIENCE_NS;
    if (call != POOL_ALONE)
        invite(model, model->now, places, call == POOL_ALL);
    model->now = take_all(model, part, places);
}

/* --- Parts, buffers, frames ----------------------------------------------------------------------------- */

static void run_part(struct model *model, const struct timeline_part *part)
{
    double begin = model->now;
    if (part->tasks)
        run_tasks(model, part);
    else {
        model->now += (double)part->ns;
        model->time->busy += (double)part->ns;
    }
    model->thread[model->leader].since = model->now;
    model->time->part[part->kind] += model->now - begin;
}

/* Renders the parts up to the application's next one, which is returned. */
static uint32_t render_buffer(struct model *model, uint32_t at)
{
    for (; at < model->timeline->parts && model->timeline->part[at].kind != TIMELINE_SUBMIT; at++)
        run_part(model, model->timeline->part + at);
    return at;
}

static double submit_ns(const struct model *model, uint32_t at)
{
    return at < model->timeline->parts ? (double)model->timeline->part[at].ns : 0;
}

static uint32_t end_of_buffer(const struct timeline *timeline, uint32_t at)
{
    while (at < timeline->parts && timeline->part[at].kind != TIMELINE_SUBMIT)
        at++;
    return at;
}

/* The application fills a buffer and waits for the previous one, which ends at model->now. */
static void run_frame(struct model *model)
{
    const struct timeline *timeline = model->timeline;
    double submitted = 0;
    for (uint32_t at = 0; at < timeline->parts;) {
        bool background = timeline->part[at].background && model->threads > 1;
        submitted += submit_ns(model, at);
        model->time->busy += submit_ns(model, at);
        model->time->part[TIMELINE_SUBMIT] += fmax(0, submitted - model->now);
        model->now = submitted = fmax(submitted, model->now);
        model->leader = background ? 1 : 0;
        model->application =
            background ? submitted + submit_ns(model, end_of_buffer(timeline, at + 1)) : submitted;
        at = render_buffer(model, at + 1);
        if (!background)
            submitted = model->now;
    }
    model->time->frame = fmax(model->now, submitted);
}

int model_run(const struct timeline *timeline, unsigned threads, const struct handover *costs,
              struct model_time *time, struct error *error)
{
    struct model *model = calloc(1, sizeof *model);
    struct phase *phase = aligned_alloc(64, (sizeof *phase + 63) & ~(size_t)63);
    *time = (struct model_time){0};
    if (model && phase) {
        memset(phase, 0, sizeof *phase);
        *model = (struct model){
            .timeline = timeline, .costs = costs, .phase = phase, .threads = threads, .time = time};
        run_frame(model);
    }
    bool done = model && phase;
    free(model);
    free(phase);
    return done ? 0 : (error_set(error, "no memory for the simulation of %u threads", threads), -1);
}
