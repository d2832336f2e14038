#include "ir/field.h"

#include "base/srgb.h"
#include "contract/layout.h"

#include <stdarg.h>
#include <string.h>

/* The structures, as record_of_<name>. */
#define RECORD(record, type) typedef __typeof__(type) record_of_##record;
#define FIELD(...)
#define PART(...)
#define POINTER(...)
#define PLACE(...)
#include "def/state/record.def"
#undef RECORD
#undef FIELD
#undef PART
#undef POINTER
#undef PLACE

enum kind { KIND_flt, KIND_itg, KIND_half, KIND_PART, KIND_POINTER, KIND_RECORD };

/* A field; or a record, whose fields follow. */
struct row {
    const char *name;
    uint32_t offset, bytes, step; /* step: of an element */
    uint8_t kind;
    uint8_t target; /* enum ir_record: of a record itself, of parts and pointers what they consist of */
    uint8_t columns, rows;
};

#define MEMBER(record, member)                                                                               \
#member, offsetof(record_of_##record, member), sizeof(((record_of_##record *)NULL)->member)

static const struct row table[] = {
#define RECORD(record, type)                                                                                 \
    {#record, 0, sizeof(record_of_##record), 0, KIND_RECORD, IR_RECORD_##record, 0, 0},
#define FIELD(record, member, kind, columns, rows)                                                           \
    {MEMBER(record, member), KIND_##kind == KIND_half ? 2 : 4, KIND_##kind, 0, columns, rows},
#define PART(record, member, other)                                                                          \
    {MEMBER(record, member), sizeof(record_of_##other), KIND_PART, IR_RECORD_##other, 0, 0},
#define POINTER(record, member, other)                                                                       \
    {MEMBER(record, member), sizeof(void *), KIND_POINTER, IR_RECORD_##other, 0, 0},
#define PLACE(record, name, offset, bytes, kind, step) {#name, offset, bytes, step, KIND_##kind, 0, 0, 0},
#include "def/state/record.def"
#undef RECORD
#undef FIELD
#undef PART
#undef POINTER
#undef PLACE
};

enum { ROWS = sizeof table / sizeof *table };

static const struct row *record_row(enum ir_record record)
{
    const struct row *row = table;
    while (row->kind != KIND_RECORD || row->target != record)
        row++;
    return row;
}

static void start(struct ir_field *field, bool named)
{
    field->type = TYPE_non;
    field->pointer = false;
    field->named = named;
    field->target = IR_RECORD_words;
    field->name[0] = 0;
}

__attribute__((format(printf, 2, 3))) static void add_name(struct ir_field *field, const char *format, ...)
{
    va_list arguments;
    if (!field->named)
        return;
    size_t length = strlen(field->name);
    va_start(arguments, format);
    vsnprintf(field->name + length, sizeof field->name - length, format, arguments);
    va_end(arguments);
}

static void add_index(struct ir_field *field, const struct row *row, uint32_t index)
{
    if (row->rows)
        add_name(field, "[%u]", index / row->columns / row->rows);
    if (row->columns)
        add_name(field, "[%u][%u]", row->rows ? index / row->columns % row->rows : index / row->columns,
                 index % row->columns);
    else
        add_name(field, "[%u]", index);
}

/* Elements of slots and rows are arrays of words themselves. */
static bool ends_in_element(const struct row *row, struct ir_field *field, uint32_t within)
{
    if (!within)
        return true;
    if (row->step <= sizeof(void *) || within % 4)
        return false;
    add_name(field, "+%u", within);
    return true;
}

static bool find_in(enum ir_record record, int64_t offset, struct ir_field *field)
{
    const struct row *row = record_row(record) + 1;
    while (row < table + ROWS && row->kind != KIND_RECORD &&
           (offset < row->offset || offset >= (int64_t)row->offset + row->bytes))
        row++;
    if (row == table + ROWS || row->kind == KIND_RECORD)
        return false;
    uint32_t from = (uint32_t)offset - row->offset, within = from % row->step;
    add_name(field, "%s%s", *field->name ? "." : "", row->name);
    if (row->bytes > row->step)
        add_index(field, row, from / row->step);
    if (row->kind == KIND_PART)
        return find_in(row->target, within, field);
    field->type = row->kind == KIND_flt ? TYPE_flt : TYPE_itg;
    field->pointer = row->kind == KIND_POINTER;
    field->target = row->target;
    return ends_in_element(row, field, within);
}

static bool find_field(enum ir_record record, int64_t offset, struct ir_field *field)
{
    return record == IR_RECORD_words || find_in(record, offset, field);
}

bool ir_find_field(enum ir_record record, int64_t offset, struct ir_field *field)
{
    start(field, true);
    return find_field(record, offset, field);
}

/* --- Triangles ------------------------------------------------------------------------------------------ */

static const char *const varying_name[VARYING_COUNT] = {
#define VARYING(name, components, text) #name,
#include "def/state/varying.def"
#undef VARYING
};

static bool find_plane(const char *name, int64_t within, struct ir_field *field)
{
    add_name(field, "%s", name);
    return within >= 0 && within < (int64_t)sizeof(struct plane) && find_in(IR_RECORD_plane, within, field);
}

static bool find_varying(const struct ir *ir, int64_t offset, struct ir_field *field)
{
    for (unsigned v = 0; v < VARYING_COUNT; v++) {
        bool smooth = ir->interpolation[v] == INTERPOLATION_SMOOTH;
        int64_t bytes = smooth ? sizeof(struct plane) : sizeof(float),
                within = offset - ir->layout.varying[v];
        if (!ir->interpolation[v] || within < 0 || within >= bytes * varying_components[v])
            continue;
        add_name(field, "%s[%d]", varying_name[v], (int)(within / bytes));
        field->type = TYPE_flt;
        return smooth ? find_plane("", within % bytes, field) : within % bytes == 0;
    }
    return false;
}

static bool find_coverage(const struct triangle_layout *layout, int64_t offset, struct ir_field *field)
{
    static const enum ir_record record[COVERAGE_COUNT] = {[COVERAGE_EDGES] = IR_RECORD_smooth_triangle,
                                                          [COVERAGE_LINE] = IR_RECORD_smooth_line,
                                                          [COVERAGE_POINT] = IR_RECORD_smooth_point};
    return layout->coverage && find_in(record[layout->coverage], offset - RECORD_COVERAGE, field);
}

/* In a triangle's record; `offset` may be in one of those after it, which has the same layout. */
static bool find_in_triangle(const struct ir *ir, int64_t offset, struct ir_field *field)
{
    const struct triangle_layout *layout = &ir->layout;
    if (layout->stride)
        offset %= layout->stride;
    if (offset < (int64_t)sizeof(struct triangle_head))
        return find_in(IR_RECORD_triangle, offset, field);
    if (find_coverage(layout, offset, field))
        return true;
    if (layout->depth && offset >= layout->depth && offset < layout->depth + (int)sizeof(struct plane))
        return find_plane("depth", offset - layout->depth, field);
    if (layout->smooth && offset >= layout->reciprocal_w &&
        offset < layout->reciprocal_w + (int)sizeof(struct plane))
        return find_plane("reciprocal_w", offset - layout->reciprocal_w, field);
    return find_varying(ir, offset, field);
}

/* --- Instructions --------------------------------------------------------------------------------------- */

static enum ir_record record_of_base(const struct ir *ir, enum base base)
{
    switch (base) {
    case BASE_JOB: return IR_RECORD_job;
    case BASE_INPUT: return ir->unit == UNIT_SETUP ? IR_RECORD_indices : IR_RECORD_words;
    case BASE_OUTPUT: return ir->unit == UNIT_SETUP ? IR_RECORD_triangle : IR_RECORD_vertices;
    case BASE_VERTICES: return IR_RECORD_vertices;
    case BASE_ENTRY: return IR_RECORD_entry;
    case BASE_TRIANGLE: return IR_RECORD_triangle;
    case BASE_LANES: return IR_RECORD_lanes;
    default: return IR_RECORD_words;
    }
}

static bool find_at(const struct ir *ir, enum base base, int64_t offset, struct ir_field *field)
{
    enum ir_record record = record_of_base(ir, base);
    return record == IR_RECORD_triangle ? find_in_triangle(ir, offset, field)
                                        : find_field(record, offset, field);
}

/* Finds the field that a gather reads through its pointer. An element can be in any record of the array. */
static bool find_pointed(const struct ir_field *pointer, int32_t displacement, struct ir_field *field)
{
    int64_t bytes = pointer->target ? record_row(pointer->target)->bytes : 1;
    return displacement >= 0 && find_field(pointer->target, displacement % bytes, field);
}

static const char *find_memory(const struct ir *ir, const struct ir_instruction *i, struct ir_field *pointer,
                               struct ir_field *field)
{
    if (i->op == IR_gather && i->field != GATHER_DIRECT) {
        if (!find_at(ir, i->base, i->field, pointer) || !pointer->pointer)
            return "its field is not a pointer";
        return find_pointed(pointer, i->k, field) ? NULL
                                                  : "no field begins there in what its pointer points to";
    }
    if (!find_at(ir, i->base, i->k, field))
        return "no field begins there";
    return field->pointer ? "its field is a pointer" : NULL;
}

const char *ir_find_memory(const struct ir *ir, const struct ir_instruction *i, struct ir_field *pointer,
                           struct ir_field *field)
{
    start(pointer, true);
    start(field, true);
    return find_memory(ir, i, pointer, field);
}

const char *ir_find_unnamed(const struct ir *ir, const struct ir_instruction *i, struct ir_field *pointer,
                            struct ir_field *field)
{
    start(pointer, false);
    start(field, false);
    return find_memory(ir, i, pointer, field);
}
