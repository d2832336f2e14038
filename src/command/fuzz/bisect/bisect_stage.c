/* The stage fragment that makes a routine wrong. Fragments contain no operations, but most of the values that
 * they leave in registers are values of the specification.
 *
 * After each fragment of the loop, code stores the registers that it writes to rows of probes. It also stores
 * the output words around the first that differs, through a register that is saved and restored. The fragment
 * after which that word is wrong has written it. Only that fragment and those that its inputs come from,
 * directly or not, can be at fault. Of these, the first one that leaves a value which no operation of the
 * recording computes is at fault. There is an exception: some fragments have forms of their own, such as
 * channels times 256. Such a value is accepted if something computed from the register is a value of the
 * recording again. If all registers are right, the fragment that has written the word is at fault. */
#include "command/fuzz/bisect/hunt.h"
#include "engines/stitch/plan.h"

#include <stdlib.h>
#include <string.h>

enum {
    VECTORS = 16,
    WORD_ROW = VECTORS,
    SPARE_ROW,
    ROWS_PER_PART,
    NO_PART = -1,
    NEAR = 16,
    ABSENT = 0x5a17b0e5
};

/* Values of an instruction in all lanes of the call. */
struct spec_value {
    uint32_t lane[LANES_MAXIMUM];
    uint16_t known; /* bit l: the lane has executed it */
};

struct stage_hunt {
    struct hunt *hunt;
    struct plan *plan, *probed;
    unsigned *number;        /* of each part in the probed plan */
    struct spec_value *spec; /* by instruction */
    uint8_t *image;
    unsigned first;       /* the first part inside of the loop */
    unsigned memory_base; /* the general register that the outputs' words are at */
    int32_t memory_at;
    uint16_t lanes;       /* those whose values must be right */
    uint16_t *matched;    /* by part: of the registers it gives, those that are values of the recording */
    uint16_t *proved;     /* and those that cannot be so by chance: no masks, and not the same in all lanes */
    uint32_t *last_match; /* by part: the latest instruction that one of them is the value of */
    int writer;           /* the part that writes the word */
};

static uint32_t vectors_of(uint32_t registers)
{
    return registers >> REGISTER_VECTORS;
}

/* --- What the specification computes -------------------------------------------------------------------- */

static void note_values(struct stage_hunt *h, const struct event_list *events, uint32_t lane)
{
    for (uint32_t n = 0; n < events->count; n++) {
        struct spec_value *value = &h->spec[events->event[n].instruction];
        memcpy(value->lane + lane, events->event[n].lane, sizeof events->event[n].lane);
        value->known |= (uint16_t)(15u << lane);
    }
}

static void perform(struct stage_hunt *h)
{
    struct hunt *hunt = h->hunt;
    struct replay *replay = hunt->replay;
    memcpy(h->image, replay->before, replay->output_bytes + replay->table_bytes);
    for (uint32_t lane = 0; lane < LANES_MAXIMUM; lane += QUAD_LANES) {
        if (!replay_has_quad(replay, lane))
            continue;
        interpret(hunt->interpreter, hunt->ir, replay, h->image, lane, true);
        struct event_list events = interpreter_events(hunt->interpreter);
        note_values(h, &events, lane);
        h->lanes |= (uint16_t)(15u << lane);
    }
}

/* --- The plan with probes ------------------------------------------------------------------------------- */

static bool begins_loop(const struct fragment *fragment)
{
    return fragment == &fragment_vertex_begin || fragment == &fragment_setup_begin ||
           fragment == &fragment_pixel_chunk;
}

/* The word that differs first, seen from the register that moves with the lanes. */
static void find_memory(struct stage_hunt *h)
{
    const struct replay *r = h->hunt->replay;
    size_t at = h->hunt->place.at;
    switch (r->unit) {
    case UNIT_VERTEX:
        h->memory_base = REGISTER_BASES + 2;
        h->memory_at = (int32_t)(at / VERTEX_SLOT_BYTES * VERTEX_SLOT_BYTES);
        return;
    case UNIT_BLIT:
        h->memory_base = REGISTER_BASES + 2;
        h->memory_at = (int32_t)(at - 4 * (size_t)h->hunt->place.element);
        return;
    case UNIT_SETUP:
        h->memory_base = REGISTER_BASES + 2;
        h->memory_at = (int32_t)(at % (8 * (size_t)r->layout.stride));
        return;
    default:
        h->memory_base = REGISTER_BASES + (at < r->color_bytes ? 5 : 6);
        at -= at < r->color_bytes ? 0 : r->color_bytes;
        h->memory_at = (int32_t)(at / TILE_PLANE_BYTES * TILE_PLANE_BYTES);
    }
}

static void append_move(struct stage_hunt *h, const struct fragment *fragment, unsigned vector, uint32_t row)
{
    const struct replay *r = h->hunt->replay;
    int32_t base = REGISTER_BASES + (r->unit == UNIT_PIXEL ? 3 : 1);
    plan_append(h->probed, fragment,
                (union arguments){{(int32_t)vector, replay_probe_place(r, row), [ARGUMENT_BASE] = base}});
}

static void append_probes(struct stage_hunt *h, unsigned part)
{
    uint32_t given = vectors_of(part_gives(h->plan->part + part)), row = part * ROWS_PER_PART;
    for (unsigned v = 0; v < VECTORS; v++)
        if (given >> v & 1)
            append_move(h, &fragment_store, v, row + v);
    if (h->hunt->place.at >= h->hunt->replay->output_bytes)
        return;
    append_move(h, &fragment_store, 0, row + SPARE_ROW);
    plan_append(h->probed, &fragment_load,
                (union arguments){{0, h->memory_at, [ARGUMENT_BASE] = (int32_t)h->memory_base}});
    append_move(h, &fragment_store, 0, row + WORD_ROW);
    append_move(h, &fragment_load, 0, row + SPARE_ROW);
}

static void move_jumps(struct stage_hunt *h)
{
    for (unsigned p = 0; p < h->plan->count; p++) {
        const struct fragment *fragment = h->plan->part[p].fragment;
        int32_t *value = h->probed->part[h->number[p]].arguments.value;
        uint32_t moved = 0;
        for (unsigned i = 0; i < fragment->holes; i++) {
            unsigned argument = fragment->hole[i].argument;
            if (fragment->hole[i].kind != HOLE_JUMP || moved >> argument & 1)
                continue;
            moved |= 1u << argument;
            value[argument] = (int32_t)h->number[value[argument]];
        }
    }
}

/* A part that changes the register by which rows are found could not be probed; there is none. */
static bool keeps_bases(const struct stage_hunt *h)
{
    uint32_t base = 1u << (REGISTER_BASES + (h->hunt->replay->unit == UNIT_PIXEL ? 3 : 1));
    for (unsigned p = h->first; p + 1 < h->plan->count; p++)
        if (part_changes(h->plan->part + p) & base &&
            part_gives(h->plan->part + p) != part_reads(h->plan->part + p) &&
            vectors_of(part_gives(h->plan->part + p)))
            return false;
    return true;
}

static void insert_probes(struct stage_hunt *h)
{
    bool inside = false;
    plan_enter(h->probed);
    h->probed->count = 0;
    for (unsigned p = 0; p < h->plan->count; p++) {
        const struct part *part = h->plan->part + p;
        h->number[p] = plan_append(h->probed, part->fragment, part->arguments);
        if (inside)
            append_probes(h, p);
        if (begins_loop(part->fragment)) {
            inside = true;
            h->first = p + 1;
        }
        inside &= part->fragment != &fragment_vertex_next && part->fragment != &fragment_setup_next;
    }
    h->probed->frame_bytes = h->plan->frame_bytes;
    move_jumps(h);
}

/* --- Which registers are right -------------------------------------------------------------------------- */

static bool is_same(const struct stage_hunt *h, const uint32_t *row, uint32_t instruction)
{
    const struct spec_value *value = h->spec + instruction;
    uint16_t both = value->known & h->lanes;
    for (unsigned lane = 0; lane < LANES_MAXIMUM; lane++)
        if (both >> lane & 1 && !hunt_agrees(h->hunt->ir, instruction, row[lane], value->lane[lane]))
            return false;
    return both != 0;
}

static bool is_stored(const struct stage_hunt *h, const uint32_t *row)
{
    for (unsigned lane = 0; lane < LANES_MAXIMUM; lane++)
        if (h->lanes >> lane & 1 && row[lane] != ABSENT)
            return true;
    return false;
}

static bool is_varied(const uint32_t *row, uint16_t lanes)
{
    for (unsigned lane = 0; lane < LANES_MAXIMUM; lane++)
        if (lanes >> lane & 1 && row[lane] != row[__builtin_ctz(lanes)])
            return true;
    return false;
}

/* Returns true unless the values are all zeros or all ones, which many registers hold by chance. */
static bool is_telling(const uint32_t *row, uint16_t lanes)
{
    return is_varied(row, lanes) || (row[__builtin_ctz(lanes)] && ~row[__builtin_ctz(lanes)]);
}

static bool is_computed(const struct ir_instruction *i)
{
    return i->op != IR_literal && !(ir_op_information[i->op].properties & IR_READS);
}

/* The first instruction after those of the inputs whose value the row has, else the first of all; 0 for none.
 * A value that is common by chance must be computed from the inputs, soon, or be one of them. */
static uint32_t match_row(const struct stage_hunt *h, const uint32_t *row, uint32_t inputs)
{
    const struct ir *ir = h->hunt->ir;
    bool telling = is_telling(row, h->lanes);
    for (uint32_t n = inputs ? inputs : 1; n < ir->count && (telling || n <= inputs + NEAR); n++)
        if ((telling || is_computed(ir->instruction + n)) && is_same(h, row, n))
            return n;
    for (uint32_t n = 1; n < inputs && telling; n++)
        if (is_same(h, row, n))
            return n;
    return 0;
}

/* A value that was never stored counts as right: control has skipped it. */
static void match_part(struct stage_hunt *h, unsigned p, uint32_t holds[VECTORS])
{
    uint32_t given = vectors_of(part_gives(h->plan->part + p)),
             read = vectors_of(part_reads(h->plan->part + p));
    uint32_t inputs = 0;
    for (unsigned v = 0; v < VECTORS; v++)
        if (read >> v & 1 && holds[v] > inputs)
            inputs = holds[v];
    for (unsigned v = 0; v < VECTORS; v++) {
        const uint32_t *row = replay_probe_row(h->hunt->replay, h->image, p * ROWS_PER_PART + v);
        if (!(given >> v & 1))
            continue;
        holds[v] = is_stored(h, row) ? match_row(h, row, inputs) : 0;
        h->matched[p] |= (uint16_t)((holds[v] || !is_stored(h, row)) << v);
        if (holds[v] && h->hunt->ir->instruction[holds[v]].type != TYPE_msk)
            h->proved[p] |= (uint16_t)(is_varied(row, h->lanes) << v);
        h->last_match[p] = holds[v] > h->last_match[p] ? holds[v] : h->last_match[p];
    }
}

static void match_parts(struct stage_hunt *h)
{
    uint32_t holds[VECTORS] = {0};
    for (unsigned p = h->first; p < h->plan->count; p++)
        match_part(h, p, holds);
}

/* The last part after which the word changes to its final value. */
static void find_writer(struct stage_hunt *h)
{
    const struct replay *r = h->hunt->replay;
    uint32_t lane = h->hunt->place.element, before, now;
    if (r->unit == UNIT_SETUP)
        lane = lane / 8 * 8;
    memcpy(&before, r->before + h->hunt->place.at, sizeof before);
    h->writer = NO_PART;
    for (unsigned p = h->first; p < h->plan->count; p++) {
        now = replay_probe_row(r, h->image, p * ROWS_PER_PART + WORD_ROW)[lane];
        if (now == ABSENT)
            continue;
        if (now != before)
            h->writer = (int)p;
        before = now;
    }
}

/* --- Whose fault it is ---------------------------------------------------------------------------------- */

/* Registers given by each part that the writer has its inputs from. */
static void slice(const struct stage_hunt *h, uint16_t *needed)
{
    uint32_t wanted = vectors_of(part_reads(h->plan->part + h->writer));
    for (int p = h->writer - 1; p >= (int)h->first; p--) {
        uint32_t given = vectors_of(part_gives(h->plan->part + p));
        needed[p] = (uint16_t)(given & wanted);
        if (needed[p])
            wanted = (wanted & ~given) | vectors_of(part_reads(h->plan->part + p));
    }
}

/* Returns true if something computed from the register is certainly a value of the recording again. */
static bool leads_to_a_match(const struct stage_hunt *h, unsigned part, unsigned vector)
{
    uint32_t from = 1u << vector;
    for (unsigned p = part + 1; p < h->plan->count && (int)p <= h->writer; p++) {
        uint32_t given = vectors_of(part_gives(h->plan->part + p));
        bool reads = vectors_of(part_reads(h->plan->part + p)) & from;
        for (unsigned v = 0; v < VECTORS && reads; v++)
            if (given >> v & 1 && h->proved[p] >> v & 1)
                return true;
        from = reads ? from | given : from & ~given;
    }
    return false;
}

static int find_culprit(const struct stage_hunt *h, const uint16_t *needed)
{
    for (unsigned p = h->first; (int)p < h->writer; p++)
        for (unsigned v = 0; v < VECTORS; v++)
            if ((needed[p] & ~h->matched[p]) >> v & 1 && !leads_to_a_match(h, p, v))
                return (int)p;
    return h->writer;
}

static void note_fragment(struct stage_hunt *h, unsigned part)
{
    struct bisection *b = h->hunt->bisection;
    const struct ir *ir = h->hunt->ir;
    const struct fragment *fragment = h->plan->part[part].fragment;
    uint32_t before = 0;
    for (unsigned p = h->first; p < part; p++)
        before = h->last_match[p] > before ? h->last_match[p] : before;
    snprintf(b->fragment, sizeof b->fragment, "%s, part %u: %s", fragment->name, part,
             stitch_fragment_text(fragment).meaning);
    b->outcome = BISECT_FOUND;
    b->operation = fragment->name;
    *b->place = 0;
    const struct ir_instruction *i = &ir->instruction[before];
    if (before)
        snprintf(b->place, sizeof b->place, "%s:%u", ir->file[i->file], i->line);
    snprintf(b->reason, sizeof b->reason,
             "a fragment is not divided into operations: the line is that of the last value (%s) before it",
             ir_op_information[i->op].name);
}

static int look(struct stage_hunt *h, const struct routine *routine, struct error *error)
{
    struct hunt *hunt = h->hunt;
    struct replay *replay = hunt->replay;
    uint16_t *needed = calloc(h->plan->count, sizeof *needed);
    if (!needed)
        return error_set(error, "out of memory for %u fragments", h->plan->count);
    struct routine *probed =
        plan_routine(h->probed, routine->engine, hunt->arena, routine->unit, &routine->key, error);
    if (probed) {
        uint32_t *row = replay_probe_row(replay, h->image, 0);
        for (size_t i = 0; i < (size_t)h->plan->count * ROWS_PER_PART * LANES_MAXIMUM; i++)
            row[i] = ABSENT;
        perform(h);
        replay_run(replay, probed, h->image);
        routine->engine->free(hunt->arena, probed);
        match_parts(h);
        find_writer(h);
        if (h->writer != NO_PART) {
            slice(h, needed);
            note_fragment(h, (unsigned)find_culprit(h, needed));
        } else {
            snprintf(hunt->bisection->reason, sizeof hunt->bisection->reason,
                     "no fragment was observed that writes the differing output");
        }
    }
    free(needed);
    return probed ? 0 : -1;
}

static int look_into(struct stage_hunt *h, const struct routine *routine, struct error *error)
{
    unsigned count;
    plan_stages(h->plan, routine->unit, &routine->key);
    count = h->plan->count;
    h->number = calloc(count, sizeof *h->number);
    h->matched = calloc(count, sizeof *h->matched);
    h->proved = calloc(count, sizeof *h->proved);
    h->last_match = calloc(count, sizeof *h->last_match);
    h->spec = calloc(h->hunt->ir->count, sizeof *h->spec);
    if (!h->number || !h->matched || !h->proved || !h->last_match || !h->spec ||
        replay_reserve(h->hunt->replay, count * ROWS_PER_PART) || !(h->image = replay_image(h->hunt->replay)))
        return error_set(error, "out of memory for %u fragments", count);
    find_memory(h);
    insert_probes(h);
    return keeps_bases(h) ? look(h, routine, error) : 0;
}

int hunt_stages(struct hunt *hunt, unsigned side, struct error *error)
{
    struct stage_hunt h = {.hunt = hunt, .plan = plan_take(error)};
    h.probed = h.plan ? plan_take(error) : NULL;
    int result = h.probed ? look_into(&h, hunt->routine[side], error) : -1;
    free(h.number);
    free(h.matched);
    free(h.proved);
    free(h.last_match);
    free(h.spec);
    free(h.image);
    if (h.probed)
        plan_give(h.probed);
    if (h.plan)
        plan_give(h.plan);
    return result;
}
