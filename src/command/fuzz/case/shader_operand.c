/* Operands of random shaders. A register is readable if the validator has found it written or declared. Ports
 * and swizzles are checked here, so that few proposals are refused. */
#include "command/fuzz/case/shader_part.h"

struct shader_operand fuzz_shader_operand(enum shader_file file, unsigned index)
{
    return (struct shader_operand){.file = (uint8_t)file, .index = (uint16_t)index, .swizzle = SWIZZLE_NONE};
}

struct shader_operand fuzz_shader_result(enum shader_file file, unsigned index, unsigned mask)
{
    return (struct shader_operand){.file = (uint8_t)file, .index = (uint16_t)index, .swizzle = (uint8_t)mask};
}

unsigned fuzz_shader_any_bit(struct maker *maker, uint32_t mask)
{
    unsigned skip = below(maker, (unsigned)__builtin_popcount(mask));
    while (skip--)
        mask &= mask - 1;
    return (unsigned)__builtin_ctz(mask);
}

/* --- What can be read ----------------------------------------------------------------------------------- */

static uint32_t set_of(const uint8_t *masks, unsigned count)
{
    uint32_t set = 0;
    for (unsigned i = 0; i < count; i++)
        set |= masks[i] ? 1u << i : 0;
    return set;
}

/* Those that are whole: swizzles of ps_1_1 to ps_1_3 leave no choice of components. */
static uint32_t whole_of(const uint8_t *masks, unsigned count)
{
    uint32_t set = 0;
    for (unsigned i = 0; i < count; i++)
        set |= masks[i] == MASK_FULL ? 1u << i : 0;
    return set;
}

/* The registers of the file that have a value here, a bit for each; of c# nothing. */
static uint32_t readable(const struct maker *maker, enum shader_file file)
{
    const struct check *check = &maker->check;
    bool modern = !is_pixel(maker) || shader_major(maker->model) > 1;
    switch (file) {
    case FILE_TEMPORARY:
        return has_texture_values(maker) ? whole_of(check->written.temporary, MAKER_TEMPORARIES)
                                         : set_of(check->written.temporary, MAKER_TEMPORARIES);
    case FILE_INPUT:
        if (modern)
            return set_of(check->declared_input, CHECK_INPUTS);
        return maker->model->column == COLUMN_PS_1_4 && check->phase < 2 ? 0 : 3;
    case FILE_TEXTURE:
        return modern                      ? set_of(check->declared_texture, CHECK_STAGES)
               : has_texture_values(maker) ? set_of(check->written.texture, CHECK_STAGES)
                                           : 0;
    case FILE_PLACE: return check->declared_place;
    case FILE_FACE: return check->declared_face;
    case FILE_SPRITE: return check->declared_sprite;
    default: return 0;
    }
}

static unsigned components_of(const struct maker *maker, const struct shader_operand *operand)
{
    if (operand->file == FILE_TEMPORARY)
        return maker->check.written.temporary[operand->index];
    if (operand->file == FILE_TEXTURE && has_texture_values(maker))
        return maker->check.written.texture[operand->index];
    return MASK_FULL;
}

int fuzz_shader_written(struct maker *maker, unsigned mask)
{
    uint32_t all = 0;
    for (unsigned i = 0; i < MAKER_TEMPORARIES; i++)
        if ((maker->check.written.temporary[i] & mask) == mask &&
            (maker->wild || maker->size[i] <= MAKER_LARGE))
            all |= 1u << i;
    if (all & maker->fresh)
        all &= maker->fresh;
    return all ? (int)fuzz_shader_any_bit(maker, all) : -1;
}

/* --- Relative addressing -------------------------------------------------------------------------------- */

static bool can_count(const struct maker *maker)
{
    return maker->model->column != COLUMN_VS_1_1 && shader_register_count(FILE_LOOP, maker->model) &&
           (maker->check.loops || maker->check.inside);
}

void fuzz_shader_make_element(struct maker *maker, struct shader_operand *operand)
{
    unsigned address = maker->check.written.address;
    if (operand->index < maker->array || operand->index >= maker->array_end || !address || !one_in(maker, 3))
        return;
    operand->relative = FILE_ADDRESS;
    operand->component = (uint8_t)fuzz_shader_any_bit(maker, address);
}

/* c[a0.x + n], c[aL + n] of vertices and models of OpenGL, v[aL + n] of models 3, r[a0.x + n] of arrays. */
static void make_relative(struct maker *maker, struct shader_operand *operand)
{
    unsigned address = maker->check.written.address;
    bool third = shader_major(maker->model) == 3;
    if (operand->file == FILE_TEMPORARY)
        fuzz_shader_make_element(maker, operand);
    if (operand->file == FILE_CONSTANT ? is_pixel(maker) && !is_opengl(maker)
                                       : operand->file != FILE_INPUT || !third)
        return;
    if (can_count(maker) && one_in(maker, 2)) {
        operand->relative = FILE_LOOP;
    } else if (address && one_in(maker, operand->file == FILE_CONSTANT ? 2 : 6)) {
        operand->relative = FILE_ADDRESS;
        operand->component = (uint8_t)fuzz_shader_any_bit(maker, address);
    }
}

/* --- Swizzles ------------------------------------------------------------------------------------------- */

static unsigned replicated(unsigned component)
{
    return component * 0x55;
}

/* Any four of the components. */
static unsigned shuffled(struct maker *maker, unsigned components)
{
    unsigned swizzle = 0;
    for (unsigned place = 0; place < 4; place++)
        swizzle |= fuzz_shader_any_bit(maker, components) << 2 * place;
    return swizzle;
}

static unsigned choose_swizzle(struct maker *maker, unsigned components)
{
    enum { YZXW = 0xc9, ZXYW = 0xd2, WZYX = 0x1b, W = 0xff };
    static const uint8_t basic[] = {YZXW, ZXYW, WZYX};
    unsigned column = maker->model->column;
    bool whole = components == MASK_FULL;
    if (whole && below(maker, 20) < 9)
        return SWIZZLE_NONE;
    if (!is_pixel(maker) || maker->model->capabilities & CAN_SWIZZLE)
        return one_in(maker, 3) ? replicated(fuzz_shader_any_bit(maker, components))
                                : shuffled(maker, components);
    if (column >= COLUMN_PS_2_0)
        return whole && one_in(maker, 3) ? basic[below(maker, 3)]
                                         : replicated(fuzz_shader_any_bit(maker, components));
    if (column == COLUMN_PS_1_4)
        return whole && one_in(maker, 2) ? SWIZZLE_NONE : replicated(fuzz_shader_any_bit(maker, components));
    return components & MASK_W && one_in(maker, whole ? 4 : 1) ? W : SWIZZLE_NONE;
}

/* --- Modifiers of sources ------------------------------------------------------------------------------- */

static bool is_division(unsigned modifier)
{
    return modifier == MODIFIER_DIVIDE_Z || modifier == MODIFIER_DIVIDE_W;
}

static unsigned choose_modifier(struct maker *maker)
{
    unsigned modifier;
    if (below(maker, 8) < 5)
        return MODIFIER_NONE;
    do
        modifier = below(maker, MODIFIER_COUNT);
    while (shader_modifiers[modifier].columns[maker->model->column] == '.' || modifier == MODIFIER_NOT ||
           is_division(modifier));
    return modifier;
}

/* Models 3 take the constants of an instruction all with their absolute values or none. */
static void agree_on_absolutes(struct shader_instruction *instruction, unsigned source)
{
    struct shader_operand *operand = &instruction->source[source];
    for (unsigned i = 0; i < source; i++) {
        unsigned other = instruction->source[i].modifier;
        if (instruction->source[i].file != FILE_CONSTANT || operand->file != FILE_CONSTANT)
            continue;
        bool absolute = other == MODIFIER_ABSOLUTE || other == MODIFIER_NEGATE_ABSOLUTE;
        bool own = operand->modifier == MODIFIER_ABSOLUTE || operand->modifier == MODIFIER_NEGATE_ABSOLUTE;
        if (absolute != own)
            operand->modifier = (uint8_t)other;
    }
}

/* --- Values --------------------------------------------------------------------------------------------- */

/* Files, with the probability of reading one of them where all can be read. */
static enum shader_file choose_file(struct maker *maker, const struct shader_operation *row, unsigned source)
{
    static const struct {
        uint8_t file, weight;
    } rows[] = {{FILE_TEMPORARY, 12}, {FILE_INPUT, 5}, {FILE_TEXTURE, 5}, {FILE_CONSTANT, 5},
                {FILE_PLACE, 1},      {FILE_FACE, 1},  {FILE_SPRITE, 1}};
    enum { ROWS = sizeof rows / sizeof *rows };
    /* Rows of a matrix and a series have the constants' port. */
    bool taken = row->source[1] == OPERAND_MATRIX || row->source[1] == OPERAND_SERIES;
    unsigned weights[ROWS] = {0}, sum = 0;
    for (unsigned i = 0; i < ROWS; i++) {
        bool constant = rows[i].file == FILE_CONSTANT;
        if (constant && source == 0 && below(maker, 4))
            continue;
        weights[i] =
            (constant ? maker->constants > 0 && !taken : readable(maker, rows[i].file)) ? rows[i].weight : 0;
        sum += weights[i];
    }
    if (!sum)
        return taken || !maker->constants ? FILE_NONE : FILE_CONSTANT;
    unsigned chosen = below(maker, sum), i = 0;
    while (chosen >= weights[i])
        chosen -= weights[i++];
    return rows[i].file;
}

/* r#: unread registers first, and tame ones. */
static unsigned choose_temporary(struct maker *maker, uint32_t set)
{
    uint32_t tame = 0;
    for (unsigned i = 0; i < MAKER_TEMPORARIES; i++)
        tame |= maker->size[i] <= MAKER_LARGE ? 1u << i : 0;
    if (!maker->wild && set & tame && !one_in(maker, 6))
        set &= tame;
    if (set & maker->fresh && below(maker, 5) < 3)
        set &= maker->fresh;
    return fuzz_shader_any_bit(maker, set);
}

static struct shader_operand choose_register(struct maker *maker, enum shader_file file)
{
    struct shader_operand operand = fuzz_shader_operand(file, 0);
    if (file == FILE_CONSTANT)
        operand.index = (uint16_t)below(maker, maker->constants);
    else if (file == FILE_TEMPORARY)
        operand.index = (uint16_t)choose_temporary(maker, readable(maker, file));
    else if (shader_registers[file].index == NUMBERED)
        operand.index = (uint16_t)fuzz_shader_any_bit(maker, readable(maker, file));
    make_relative(maker, &operand);
    return operand;
}

struct shader_operand fuzz_shader_choose_input(struct maker *maker)
{
    uint32_t inputs = readable(maker, FILE_INPUT), coordinates = readable(maker, FILE_TEXTURE);
    bool both = inputs && coordinates && one_in(maker, 2);
    /* The first input of vertices is their position; not all of its components vary. */
    if (!is_pixel(maker) && inputs & (inputs - 1))
        inputs &= inputs - 1;
    if (coordinates && (!inputs || both))
        return fuzz_shader_operand(FILE_TEXTURE, fuzz_shader_any_bit(maker, coordinates));
    return inputs ? fuzz_shader_operand(FILE_INPUT, fuzz_shader_any_bit(maker, inputs))
                  : fuzz_shader_operand(FILE_NONE, 0);
}

/* An earlier source of the instruction from the same file, if no port is left for another register of it. */
static const struct shader_operand *shared_port(const struct maker *maker,
                                                const struct shader_instruction *instruction, unsigned source,
                                                enum shader_file file)
{
    const struct shader_operand *first = NULL;
    unsigned used = 0, ports = (unsigned)(shader_registers[file].ports[maker->model->column] - '0');
    for (unsigned i = 0; i < source; i++)
        if (instruction->source[i].file == file &&
            shader_operations[instruction->opcode].source[i] != OPERAND_SERIES) {
            first = &instruction->source[i];
            used++;
        }
    return used >= ports && !(maker->model->capabilities & CAN_SOFTWARE) ? first : NULL;
}

static bool choose_value(struct maker *maker, struct shader_instruction *instruction, unsigned source,
                         bool scalar)
{
    struct shader_operand *operand = &instruction->source[source];
    enum shader_file file = choose_file(maker, &shader_operations[instruction->opcode], source);
    if (!file)
        return false;
    const struct shader_operand *shared = shared_port(maker, instruction, source, file);
    *operand = shared ? *shared : choose_register(maker, file);
    unsigned components = components_of(maker, operand);
    if (!components)
        return false;
    operand->swizzle = (uint8_t)(scalar ? replicated(fuzz_shader_any_bit(maker, components))
                                        : choose_swizzle(maker, components));
    operand->modifier = (uint8_t)choose_modifier(maker);
    agree_on_absolutes(instruction, source);
    return true;
}

/* --- Other sources -------------------------------------------------------------------------------------- */

/* Rows of a matrix: constants, or temporaries that are there. */
static struct shader_operand choose_matrix(struct maker *maker, unsigned rows)
{
    unsigned index = below(maker, maker->pool);
    unsigned complete = 0;
    while (complete < rows && index + complete < maker->model->temporaries &&
           maker->check.written.temporary[index + complete] == MASK_FULL)
        complete++;
    if (complete == rows)
        return fuzz_shader_operand(FILE_TEMPORARY, index);
    unsigned all = maker->constants > rows ? maker->constants : rows;
    struct shader_operand operand = fuzz_shader_operand(FILE_CONSTANT, below(maker, all - rows + 1));
    make_relative(maker, &operand);
    return operand;
}

/* Where to sample: mostly coordinates that come in. */
static bool choose_coordinates(struct maker *maker, unsigned opcode, struct shader_operand *operand)
{
    bool gradient = shader_operations[opcode].flags & IS_GRADIENT;
    bool third = shader_major(maker->model) == 3;
    enum shader_file in = third ? FILE_INPUT : FILE_TEXTURE;
    uint32_t temporaries = 0, set = readable(maker, in);
    for (unsigned i = 0; i < MAKER_TEMPORARIES; i++)
        temporaries |= maker->check.written.temporary[i] == MASK_FULL ? 1u << i : 0;
    if (gradient && !is_opengl(maker) && check_is_divergent(&maker->check))
        temporaries = 0;
    if (temporaries && (!set || one_in(maker, 3)))
        *operand = fuzz_shader_operand(FILE_TEMPORARY, choose_temporary(maker, temporaries));
    else if (set)
        *operand = fuzz_shader_operand(in, fuzz_shader_any_bit(maker, set));
    else
        return false;
    if (third && one_in(maker, 6))
        operand->modifier = (uint8_t)choose_modifier(maker);
    if ((third || maker->model->capabilities & CAN_SWIZZLE) && one_in(maker, 4))
        operand->swizzle = (uint8_t)choose_swizzle(maker, components_of(maker, operand));
    return true;
}

static bool choose_sampler(struct maker *maker, struct shader_operand *operand)
{
    uint32_t set = set_of(maker->check.declared_kind, CHECK_SAMPLERS);
    if (!set)
        return false;
    *operand = fuzz_shader_operand(FILE_SAMPLER, fuzz_shader_any_bit(maker, set));
    if (maker->model->capabilities & CAN_SWIZZLE && one_in(maker, 6))
        operand->swizzle = (uint8_t)shuffled(maker, MASK_FULL);
    return true;
}

struct shader_operand fuzz_shader_choose_predicate(struct maker *maker, unsigned mask)
{
    struct shader_operand predicate = fuzz_shader_operand(FILE_PREDICATE, 0);
    unsigned written = maker->check.written.predicate;
    if ((written & mask) != mask || one_in(maker, 3))
        predicate.swizzle = (uint8_t)replicated(fuzz_shader_any_bit(maker, written));
    predicate.modifier = one_in(maker, 3) ? MODIFIER_NOT : MODIFIER_NONE;
    return predicate;
}

/* A Boolean constant, or one component of the predicate. */
static void choose_condition(struct maker *maker, struct shader_operand *operand, bool predicate)
{
    if (predicate || (maker->check.written.predicate && one_in(maker, 2))) {
        *operand = fuzz_shader_choose_predicate(maker, 0);
        operand->swizzle = (uint8_t)replicated(fuzz_shader_any_bit(maker, maker->check.written.predicate));
        return;
    }
    *operand = fuzz_shader_operand(FILE_BOOLEAN, one_in(maker, 4) ? below(maker, 16) : below(maker, 3));
    operand->modifier = one_in(maker, 3) ? MODIFIER_NOT : MODIFIER_NONE;
}

/* ps_1_4: t# as .xyz or .xyw, the latter perhaps divided by w; r# of the first phase, perhaps divided by
 * z. */
static void choose_set(struct maker *maker, const struct shader_instruction *instruction,
                       struct shader_operand *operand)
{
    enum { XYZZ = 0xa4, XYWW = 0xf4 };
    const struct check *check = &maker->check;
    uint32_t values = 0;
    for (unsigned i = 0; i < maker->model->temporaries; i++)
        if ((check->written.temporary[i] & MASK_XYZ) == MASK_XYZ && !(check->stage_used >> i & 1))
            values |= 1u << i;
    if (values && check->phase == 2 && instruction->opcode == SHADER_TEXLD_1_4 && one_in(maker, 2)) {
        *operand = fuzz_shader_operand(FILE_TEMPORARY, fuzz_shader_any_bit(maker, values));
        operand->swizzle = XYZZ;
        operand->modifier = check->divides < 2 && one_in(maker, 3) ? MODIFIER_DIVIDE_Z : MODIFIER_NONE;
        return;
    }
    *operand =
        fuzz_shader_operand(FILE_TEXTURE, below(maker, shader_register_count(FILE_TEXTURE, maker->model)));
    unsigned third = check->selected[operand->index];
    bool fourth = third ? third == 4 : one_in(maker, 3);
    bool two = instruction->opcode == SHADER_TEXCRD && instruction->destination.swizzle == MASK_XY;
    operand->swizzle = fourth || two ? XYWW : XYZZ;
    bool divided = instruction->opcode == SHADER_TEXCRD ? two : fourth && one_in(maker, 2);
    operand->modifier = divided ? MODIFIER_DIVIDE_W : MODIFIER_NONE;
}

/* ps_1_1 to ps_1_3: an earlier stage's value. */
static bool choose_sampled(struct maker *maker, const struct shader_instruction *instruction,
                           struct shader_operand *operand)
{
    uint32_t set = set_of(maker->check.written.texture, CHECK_STAGES);
    set &= (1u << instruction->destination.index) - 1;
    if (!set)
        return false;
    *operand = fuzz_shader_operand(FILE_TEXTURE, fuzz_shader_any_bit(maker, set));
    operand->modifier = one_in(maker, 3) ? MODIFIER_SIGN : MODIFIER_NONE;
    return true;
}

bool fuzz_shader_choose_source(struct maker *maker, struct shader_instruction *instruction, unsigned source)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    struct shader_operand *operand = &instruction->source[source];
    switch (row->source[source]) {
    case OPERAND_VECTOR:
        if (instruction->opcode == SHADER_CND && source == 0 && has_texture_values(maker)) {
            *operand = fuzz_shader_operand(FILE_TEMPORARY, 0);
            operand->swizzle = (uint8_t)replicated(3);
            return maker->check.written.temporary[0] & MASK_W;
        }
        if (!choose_value(maker, instruction, source, false))
            return false;
        if (instruction->opcode == SHADER_CRS && !is_opengl(maker))
            operand->swizzle = SWIZZLE_NONE;
        return true;
    case OPERAND_SCALAR: return choose_value(maker, instruction, source, true);
    case OPERAND_MATRIX: *operand = choose_matrix(maker, row->rows); return true;
    case OPERAND_SCRATCH:
        *operand = fuzz_shader_operand(FILE_TEMPORARY, below(maker, maker->pool));
        return true;
    case OPERAND_SERIES:
        *operand = fuzz_shader_operand(FILE_CONSTANT, below(maker, maker->constants ? maker->constants : 1));
        return true;
    case OPERAND_COORDINATES: return choose_coordinates(maker, instruction->opcode, operand);
    case OPERAND_SAMPLER: return choose_sampler(maker, operand);
    case OPERAND_CONDITION: choose_condition(maker, operand, false); return true;
    case OPERAND_PREDICATE: choose_condition(maker, operand, true); return true;
    case OPERAND_SET: choose_set(maker, instruction, operand); return true;
    case OPERAND_SAMPLED: return choose_sampled(maker, instruction, operand);
    case OPERAND_COUNTER: *operand = fuzz_shader_operand(FILE_LOOP, 0); return true;
    default: return false;
    }
}
