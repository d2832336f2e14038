/* Operands: the rules of register files, kinds of operands and models, and reads of components that were
 * never written. */
#include "shader/check/check.h"

#include <string.h>

static const char *file_name(const struct shader_operand *operand)
{
    return shader_registers[operand->file].name;
}

static bool is_vertex(const struct check *check)
{
    return check->model->stage == STAGE_VERTEX;
}

/* ps_1_1 to ps_1_3: t# are registers like r#, filled by texture instructions. */
static bool has_texture_values(const struct check *check)
{
    return check->model->column >= COLUMN_PS_1_1 && check->model->column <= COLUMN_PS_1_3;
}

/* --- Written components -------------------------------------------------------------------------------- */

void check_note_written(struct written *written, const struct shader_instruction *instruction)
{
    const struct shader_operand *result = &instruction->destination;
    switch (shader_operations[instruction->opcode].destination) {
    case OPERAND_NONE:
    case OPERAND_KILL:
    case OPERAND_DECLARED: return;
    }
    if (result->file == FILE_TEMPORARY && result->index < CHECK_TEMPORARIES)
        written->temporary[result->index] |= result->swizzle;
    else if (result->file == FILE_TEXTURE && result->index < CHECK_STAGES)
        written->texture[result->index] |= result->swizzle;
    else if (result->file == FILE_ADDRESS)
        written->address |= result->swizzle;
    else if (result->file == FILE_PREDICATE)
        written->predicate |= result->swizzle;
}

/* The components read of a source, before its swizzle is applied. A lookup in a two-dimensional texture reads
 * no third coordinate. */
static unsigned places_read(const struct check *check, unsigned source)
{
    enum { Z = 4, PLANE = 2 };
    unsigned places = shader_source_components(check->at, source), sampler = check->at->source[1].index;
    bool plane = check->row->source[1] == OPERAND_SAMPLER && sampler < CHECK_SAMPLERS &&
                 check->declared_kind[sampler] == PLANE;
    return plane ? places & ~(unsigned)Z : places;
}

static unsigned swizzled(unsigned places, unsigned swizzle)
{
    unsigned components = 0;
    for (unsigned i = 0; i < 4; i++)
        if (places >> i & 1)
            components |= 1u << swizzle_component(swizzle, i);
    return components;
}

static int refuse_unwritten(struct check *check, const struct shader_operand *operand, unsigned missing)
{
    static const char letters[] = "xyzw";
    unsigned component = 0;
    while (!(missing >> component & 1))
        component++;
    return REFUSE(check, operand, "found %s%u.%c, expected something to write it before it is read",
                  file_name(operand), operand->index, letters[component]);
}

static int check_written(struct check *check, const struct shader_operand *operand, unsigned components)
{
    const struct written *written = &check->written;
    unsigned have = MASK_FULL;
    if (shader_is_opengl(check->model))
        return 0;
    if (operand->file == FILE_TEMPORARY)
        have = written->temporary[operand->index];
    else if (operand->file == FILE_TEXTURE && has_texture_values(check))
        have = written->texture[operand->index];
    else if (operand->file == FILE_PREDICATE)
        have = written->predicate;
    return components & ~have ? refuse_unwritten(check, operand, components & ~have) : 0;
}

/* --- Registers ----------------------------------------------------------------------------------------- */

bool check_is_in_array(const struct check *check, unsigned index)
{
    for (const struct shader_instruction *i = check->shader->instructions;
         i < check->at && shader_operations[i->opcode].flags & IS_SETUP; i++)
        if (i->opcode == SHADER_ARRAY && i->destination.index <= index && i->source[0].index >= index)
            return true;
    return false;
}

/* Models of OpenGL: constants, inputs and arrays; outputs that are written. */
static int check_opengl_relative(struct check *check, const struct shader_operand *operand)
{
    bool indexed = operand->file == FILE_CONSTANT || operand->file == FILE_INPUT;
    if (operand->file == FILE_TEMPORARY && !check_is_in_array(check, operand->index))
        return REFUSE(check, operand, "found r%u with a relative index, expected it in an array before",
                      operand->index);
    if (!indexed && operand->file != FILE_TEMPORARY)
        return REFUSE(check, operand, "found %s with a relative index, expected none", file_name(operand));
    return 0;
}

/* Numbers, and where relative addressing may be. */
static int check_register(struct check *check, const struct shader_operand *operand, bool destination)
{
    unsigned count = shader_register_count(operand->file, check->model);
    if (shader_registers[operand->file].index == NUMBERED && operand->index >= count)
        return REFUSE(check, operand, "found %s%u, expected %s0 to %s%u", file_name(operand), operand->index,
                      file_name(operand), file_name(operand), count - 1);
    if (!operand->relative)
        return 0;
    bool loop = operand->relative == FILE_LOOP, three = shader_major(check->model) == 3;
    bool opengl = shader_is_opengl(check->model);
    if (opengl && check_opengl_relative(check, operand))
        return -1;
    bool indexed = destination                      ? operand->file == FILE_OUTPUT && loop
                   : operand->file == FILE_CONSTANT ? is_vertex(check)
                                                    : operand->file == FILE_INPUT && three;
    if (!indexed && !opengl)
        return REFUSE(check, operand, "found %s with a relative index by %s, expected %s", file_name(operand),
                      loop ? "aL" : "a0", operand->file == FILE_OUTPUT ? "aL" : "none");
    if (loop && !check->loops && !check->inside)
        return REFUSE(check, operand, "found aL outside a loop, expected it between loop and endloop");
    if (!loop && !opengl && !(check->written.address >> operand->component & 1))
        return REFUSE(check, operand, "found a0.%c, expected something to write it before it is read",
                      "xyzw"[operand->component]);
    return 0;
}

/* Inputs, samplers and outputs must have been declared. */
static int check_declared(struct check *check, const struct shader_operand *operand)
{
    bool modern = is_vertex(check) || shader_major(check->model) >= 2, declared = true;
    switch (operand->file) {
    case FILE_INPUT: declared = !modern || operand->relative || check->declared_input[operand->index]; break;
    case FILE_TEXTURE: declared = !modern || check->declared_texture[operand->index]; break;
    case FILE_SAMPLER: declared = check->declared_kind[operand->index]; break;
    case FILE_OUTPUT: declared = operand->relative || check->declared_output[operand->index]; break;
    case FILE_PLACE: declared = check->declared_place; break;
    case FILE_FACE: declared = check->declared_face; break;
    case FILE_SPRITE: declared = check->declared_sprite; break;
    }
    if (declared)
        return 0;
    if (shader_registers[operand->file].index != NUMBERED)
        return REFUSE(check, operand, "found %s, expected a dcl of it before", file_name(operand));
    return REFUSE(check, operand, "found %s%u, expected a dcl of it before", file_name(operand),
                  operand->index);
}

/* --- Sources ------------------------------------------------------------------------------------------- */

/* The file of a kind of operand; FILE_NONE if it allows several. */
static enum shader_file file_of(enum shader_operand_kind kind)
{
    switch (kind) {
    case OPERAND_SCRATCH:
    case OPERAND_TEMPORARY: return FILE_TEMPORARY;
    case OPERAND_SERIES:
    case OPERAND_CONSTANT: return FILE_CONSTANT;
    case OPERAND_SAMPLER: return FILE_SAMPLER;
    case OPERAND_SAMPLED:
    case OPERAND_STAGE: return FILE_TEXTURE;
    case OPERAND_INTEGER:
    case OPERAND_CONSTANT_INTEGER: return FILE_INTEGER;
    case OPERAND_CONSTANT_BOOLEAN: return FILE_BOOLEAN;
    case OPERAND_COUNTER: return FILE_LOOP;
    case OPERAND_LABEL: return FILE_LABEL;
    case OPERAND_PREDICATE:
    case OPERAND_FLAGS: return FILE_PREDICATE;
    case OPERAND_ADDRESS: return FILE_ADDRESS;
    default: return FILE_NONE;
    }
}

static int check_file(struct check *check, const struct shader_operand *operand,
                      enum shader_operand_kind kind)
{
    unsigned file = operand->file, wanted = file_of(kind);
    const char *expected = "a register that can be read";
    bool good = shader_registers[file].access & CAN_READ && shader_registers[file].access & IS_FLOAT;
    if (wanted) {
        good = file == wanted;
        expected = shader_registers[wanted].name;
    } else if (kind == OPERAND_CONDITION) {
        good = file == FILE_BOOLEAN || file == FILE_PREDICATE;
        expected = "b or p0";
    } else if (kind == OPERAND_SET) {
        good = file == FILE_TEXTURE || file == FILE_TEMPORARY;
        expected = "t or r";
    } else if (kind == OPERAND_COORDINATES && shader_major(check->model) == 2) {
        good = file == FILE_TEXTURE || file == FILE_TEMPORARY;
        expected = "t or r";
    } else if (kind == OPERAND_MATRIX) {
        good = file == FILE_CONSTANT || file == FILE_TEMPORARY;
        expected = "c or r";
    }
    /* In ps_1_4, only texture instructions read t#. */
    if (check->model->column == COLUMN_PS_1_4 && file == FILE_TEXTURE && kind != OPERAND_SET)
        good = false;
    return good ? 0 : REFUSE(check, operand, "found %s, expected %s", file_name(operand), expected);
}

static int check_modifier(struct check *check, const struct shader_operand *operand,
                          enum shader_operand_kind kind)
{
    const struct shader_modifier *modifier = &shader_modifiers[operand->modifier];
    bool divides = operand->modifier == MODIFIER_DIVIDE_Z || operand->modifier == MODIFIER_DIVIDE_W;
    bool good = !operand->modifier;
    switch (kind) {
    case OPERAND_VECTOR:
    case OPERAND_SCALAR: good = operand->modifier != MODIFIER_NOT && !divides; break;
    case OPERAND_COORDINATES:
        good = good || (shader_major(check->model) == 3 && operand->modifier != MODIFIER_NOT);
        break;
    case OPERAND_SET: good = good || divides; break;
    case OPERAND_SAMPLED: good = good || operand->modifier == MODIFIER_SIGN; break;
    case OPERAND_CONDITION:
    case OPERAND_PREDICATE: good = good || operand->modifier == MODIFIER_NOT; break;
    default: break;
    }
    return good ? 0
                : REFUSE(check, operand, "found the modifier '%s%s', expected none of that kind here",
                         modifier->before, modifier->after);
}

static bool is_basic_swizzle(unsigned swizzle)
{
    enum { YZXW = 0xc9, ZXYW = 0xd2, WZYX = 0x1b };
    return swizzle == SWIZZLE_NONE || swizzle_replicates(swizzle) || swizzle == YZXW || swizzle == ZXYW ||
           swizzle == WZYX;
}

/* Swizzles of float values in pixel shaders. */
static int check_pixel_swizzle(struct check *check, const struct shader_operand *operand)
{
    enum { B = 0xaa, A = 0xff, ALPHA = 8 };
    unsigned swizzle = operand->swizzle, column = check->model->column;
    if (check->model->capabilities & CAN_SWIZZLE || swizzle == SWIZZLE_NONE)
        return 0;
    if (column >= COLUMN_PS_2_0)
        return is_basic_swizzle(swizzle)
                   ? 0
                   : REFUSE(check, operand,
                            "found a swizzle that %s does not have, expected one component, "
                            ".yzxw, .zxyw or .wzyx",
                            check->model->name);
    if (column == COLUMN_PS_1_4 ? swizzle_replicates(swizzle)
                                : swizzle == A || (swizzle == B && check->at->destination.swizzle == ALPHA))
        return 0;
    return REFUSE(check, operand, "found a swizzle that %s does not have, expected %s", check->model->name,
                  column == COLUMN_PS_1_4 ? "one component" : ".w, or .z where only w is written");
}

static int check_swizzle(struct check *check, const struct shader_operand *operand,
                         enum shader_operand_kind kind)
{
    enum { XYZZ = 0xa4, XYWW = 0xf4 };
    unsigned swizzle = operand->swizzle;
    bool free = check->model->capabilities & CAN_SWIZZLE || shader_major(check->model) == 3;
    switch (kind) {
    case OPERAND_VECTOR: return is_vertex(check) ? 0 : check_pixel_swizzle(check, operand);
    case OPERAND_SCALAR:
        return swizzle_replicates(swizzle)
                   ? 0
                   : REFUSE(check, operand, "found several components, expected one, like %s%u.x",
                            file_name(operand), operand->index);
    case OPERAND_PREDICATE:
    case OPERAND_CONDITION:
        if (operand->file == FILE_PREDICATE)
            return swizzle_replicates(swizzle)
                       ? 0
                       : REFUSE(check, operand, "found several components of p0, expected one, like p0.x");
        break;
    case OPERAND_SET:
        if (swizzle == XYZZ || swizzle == XYWW || swizzle == SWIZZLE_NONE)
            return 0;
        return REFUSE(check, operand, "found another swizzle, expected .xyz or .xyw");
    case OPERAND_COORDINATES:
    case OPERAND_SAMPLER:
        if (free)
            return 0;
        break;
    default: break;
    }
    return swizzle == SWIZZLE_NONE
               ? 0
               : REFUSE(check, operand, "found a swizzle of %s, expected none here", file_name(operand));
}

static int check_rows(struct check *check, const struct shader_operand *operand)
{
    unsigned last = operand->index + check->row->rows - 1u;
    if (!operand->relative && last >= shader_register_count(operand->file, check->model))
        return REFUSE(check, operand, "found %s%u as the last row of the matrix, expected at most %s%u",
                      file_name(operand), last, file_name(operand),
                      shader_register_count(operand->file, check->model) - 1);
    for (unsigned i = 0; i < check->row->rows && operand->file == FILE_TEMPORARY; i++) {
        struct shader_operand row = *operand;
        row.index += (uint16_t)i;
        if (check_written(check, &row, places_read(check, 1)))
            return -1;
    }
    return 0;
}

static int check_source(struct check *check, unsigned source)
{
    const struct shader_operand *operand = &check->at->source[source];
    enum shader_operand_kind kind = check->row->source[source];
    if (check_file(check, operand, kind) || check_register(check, operand, false) ||
        check_modifier(check, operand, kind) || check_swizzle(check, operand, kind) ||
        check_declared(check, operand))
        return -1;
    if (kind == OPERAND_MATRIX)
        return check_rows(check, operand);
    bool condition = operand->file == FILE_PREDICATE;
    return check_written(check, operand,
                         condition ? 1u << (operand->swizzle & 3)
                                   : swizzled(places_read(check, source), operand->swizzle));
}

/* --- All sources together ------------------------------------------------------------------------------ */

static bool same_register(const struct shader_operand *a, const struct shader_operand *b)
{
    return a->file == b->file && a->index == b->index && a->relative == b->relative &&
           a->component == b->component;
}

/* Each port reads one register of a file; the constants of a series have ports of their own. */
static int check_ports(struct check *check)
{
    const struct shader_operand *source = check->at->source;
    unsigned count[FILE_COUNT] = {0};
    if (check->model->capabilities & CAN_SOFTWARE)
        return 0;
    for (unsigned i = 0; i < SHADER_SOURCES && check->row->source[i]; i++) {
        bool again = check->row->source[i] == OPERAND_SERIES;
        for (unsigned j = 0; j < i; j++)
            again = again || same_register(&source[i], &source[j]);
        unsigned ports = (unsigned)shader_registers[source[i].file].ports[check->model->column] - '0';
        if (!again && ++count[source[i].file] > ports)
            return REFUSE(check, &source[i],
                          "found %u different registers of %s, expected at most %u in one "
                          "instruction",
                          count[source[i].file], file_name(&source[i]), ports);
    }
    return 0;
}

/* Models 3: all constants of an instruction have _abs, or none. */
static int check_absolutes(struct check *check)
{
    const struct shader_operand *first = NULL;
    for (unsigned i = 0; i < SHADER_SOURCES && check->row->source[i]; i++) {
        const struct shader_operand *source = &check->at->source[i];
        if (source->file != FILE_CONSTANT)
            continue;
        bool absolute = source->modifier == MODIFIER_ABSOLUTE || source->modifier == MODIFIER_NEGATE_ABSOLUTE;
        bool other =
            first && (first->modifier == MODIFIER_ABSOLUTE || first->modifier == MODIFIER_NEGATE_ABSOLUTE);
        if (first && absolute != other)
            return REFUSE(check, source, "found c%u %s _abs, expected all constants of an instruction alike",
                          source->index, absolute ? "with" : "without");
        first = source;
    }
    return 0;
}

int check_sources(struct check *check)
{
    for (unsigned i = 0; i < SHADER_SOURCES && check->row->source[i]; i++) {
        const struct shader_operand *source = &check->at->source[i];
        if (check_source(check, i))
            return -1;
        if (shader_is_opengl(check->model))
            continue;
        if (check->at->opcode == SHADER_CRS && source->swizzle != SWIZZLE_NONE)
            return REFUSE(check, source, "found a swizzle, expected none of crs");
        if (check->row->flags & IS_APART && check->at->destination.file == source->file &&
            check->at->destination.index == source->index)
            return REFUSE(check, source, "found %s%u as source and destination, expected another source",
                          file_name(source), source->index);
    }
    /* ps_1_1 to ps_1_3 choose by one component of one register. */
    if (check->at->opcode == SHADER_CND && has_texture_values(check)) {
        const struct shader_operand *chooser = &check->at->source[0];
        if (chooser->file != FILE_TEMPORARY || chooser->index || chooser->swizzle != 0xff ||
            chooser->modifier)
            return REFUSE(check, chooser, "found another condition, expected r0.w");
    }
    if (shader_is_opengl(check->model))
        return 0;
    return check_ports(check) || check_absolutes(check) ? -1 : 0;
}

int check_predicate(struct check *check)
{
    const struct shader_operand *predicate = &check->at->predicate;
    unsigned mask = check->at->destination.swizzle;
    if (!predicate->file)
        return 0;
    if (!(check->model->capabilities & CAN_PREDICATION))
        return REFUSE(check, predicate, "found a predicate, which %s does not have", check->model->name);
    if (check->row->flags & (IS_SETUP | IS_FLOW) || !check->row->destination ||
        check->row->destination == OPERAND_KILL)
        return REFUSE(check, predicate, "found a predicate at %s, expected none: it writes nothing",
                      check->row->name);
    if (check_register(check, predicate, false))
        return -1;
    if (predicate->modifier && predicate->modifier != MODIFIER_NOT)
        return REFUSE(check, predicate, "found another modifier of a predicate, expected !");
    if (predicate->swizzle != SWIZZLE_NONE && !swizzle_replicates(predicate->swizzle))
        return REFUSE(check, predicate, "found a swizzle of p0, expected none or one component");
    return check_written(check, predicate, swizzled(mask, predicate->swizzle));
}
