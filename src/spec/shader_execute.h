/* Running a shader: its steps, one after the other.
 *
 * The instructions' meanings are execute_arithmetic (shader_arithmetic.h) and execute_texture (shader_texture.h).
 * ps_1_x can issue two instructions at once; both read before either writes. */

/* The components of the result, whatever the instruction. Returns whether there is one to write. */
static inline int execute_instruction(struct env *e, struct step *s, struct vector4 *result)
{
    const struct shader_operation *row = &shader_operations[s->instruction->opcode];
    read_sources(E, s);
    if (row->flags & (IS_TEXTURE | IS_GRADIENT) || s->instruction->opcode == SHADER_BEM)
        return execute_texture(E, s, result);
    *result = execute_arithmetic(E, s);
    return 1;
}

static inline struct step step_of(struct machine *m, const struct shader_instruction *i)
{
    struct step s = {.instruction = i, .machine = m, .mask = i->destination.swizzle, .legacy = m->legacy};
    return s;
}

/* mova rounds to nearest; vs_1_1's mov takes the floor. */
static inline void execute_address(struct env *e, struct machine *m, const struct shader_instruction *i)
{
    struct step s = step_of(m, i);
    itg value[4];
    read_sources(E, &s);
    for (unsigned c = 0; c < 4; c++) {
        if (!(s.mask >> c & 1))
            continue;
        flt v = s.source[0].v[c];
        if (i->opcode == SHADER_MOV)
            v = floor_f(E, v);
        value[c] = round_i(E, v);
    }
    write_address(E, m, i, value);
}

static inline void execute_setp(struct env *e, struct machine *m, const struct shader_instruction *i)
{
    struct step s = step_of(m, i);
    msk value[4];
    read_sources(E, &s);
    for (unsigned c = 0; c < 4; c++)
        if (s.mask >> c & 1)
            value[c] = compare_values(E, i->comparison, s.source[0].v[c], s.source[1].v[c]);
    write_predicate(E, m, i, value);
}

static inline void execute_plain(struct env *e, struct machine *m, const struct shader_instruction *i)
{
    struct step s = step_of(m, i);
    struct vector4 result;
    if (execute_instruction(E, &s, &result))
        write_result(E, m, i, &result);
}

static inline void execute_pair(struct env *e, struct machine *m, const struct shader_instruction *first,
                                const struct shader_instruction *second)
{
    struct step a = step_of(m, first), b = step_of(m, second);
    struct vector4 result[2];
    int writes = execute_instruction(E, &a, &result[0]);
    int also = execute_instruction(E, &b, &result[1]);
    if (writes)
        write_result(E, m, first, &result[0]);
    if (also)
        write_result(E, m, second, &result[1]);
}

/* One step that is not a pair's first; returns the number of the next one. */
static inline uint32_t execute_step(struct env *e, struct machine *m, uint32_t at)
{
    const struct program_step *step = &m->program->step[at];
    const struct shader_instruction *i = &step->instruction;
    switch (i->opcode) {
    case SHADER_NOP:
    case SHADER_PHASE: break;
    case SHADER_IF:
    case SHADER_IF_COMPARE: execute_if(E, m, at); return step->end + 1;
    case SHADER_LOOP:
    case SHADER_REP: execute_loop(E, m, at); return step->match + 1;
    case SHADER_CALL:
    case SHADER_CALLNZ: execute_call(E, m, step); break;
    case SHADER_BREAK:
    case SHADER_BREAK_COMPARE:
    case SHADER_BREAKP: execute_break(E, m, i); break;
    case SHADER_SETP: execute_setp(E, m, i); break;
    default:
        if (i->destination.file == FILE_ADDRESS)
            execute_address(E, m, i);
        else
            execute_plain(E, m, i);
    }
    return at + 1;
}

static inline void execute_steps(struct env *e, struct machine *m, uint32_t from, uint32_t to)
{
    const struct program_step *step = m->program->step;
    for (uint32_t at = from; at < to;) {
        if (at + 1 < to && step[at + 1].instruction.coissue) {
            execute_pair(E, m, &step[at].instruction, &step[at + 1].instruction);
            at += 2;
        } else
            at = execute_step(E, m, at);
    }
}

/* A machine whose registers are all zero. The caller fills in what the shader is given. */
static inline void machine_begin(struct env *e, struct machine *m, const uint8_t booleans[2], int legacy)
{
    flt zero = lit_f(E, 0.0f);
    itg none = lit_i(E, 0);
    msk never = lit_m(E, 0);
    m->program = e->program;
    m->booleans = booleans[0] | (unsigned)booleans[1] << 8;
    m->legacy = legacy;
    for (unsigned c = 0; c < CELL_FLOATS; c++)
        m->cell[c] = m->before[c] = zero;
    for (unsigned s = 0; s < 8; s++)
        m->product[s] = zero;
    for (unsigned c = 0; c < 4; c++) {
        m->address[c] = m->address_before[c] = none;
        m->predicate[c] = m->predicate_before[c] = never;
    }
    m->counter = none;
    m->killed = m->mask = m->live = never;
    m->masked = m->loops = 0;
    m->changed = (struct cell_set){{0}};
    m->pixel = NULL;
    m->vertex = NULL;
}

static inline void machine_run(struct env *e, struct machine *m)
{
    execute_steps(E, m, 0, m->program->main);
}
