/* A trial in the specification's language. Include it after a binding and spec/spec.h. */

static void trial_run(struct env *e, const struct trial_memory *memory)
{
    static const struct pixel_key pixel;
    static const struct vertex_key vertex;
    const struct trial *trial = memory->trial;
    int first = memory->program->model->stage == STAGE_PIXEL && shader_major(memory->program->model) == 1;
    const uint8_t booleans[2] = {(uint8_t)trial->booleans, (uint8_t)(trial->booleans >> 8)};
    static struct machine m;
    machine_begin(E, &m, booleans, trial->legacy);
    if (memory->program->model->stage == STAGE_PIXEL)
        m.pixel = &pixel;
    else
        m.vertex = &vertex;
    flt zero = lit_f(E, 0.0f);
    for (int r = 0; r < OUTPUT_COUNT; r++)
        for (int c = 0; c < 4; c++)
            m.input[r][c] = zero;
    for (int o = 0; o < TRIAL_OPERANDS; o++)
        for (int c = 0; c < 4; c++) {
            flt value = load_f(E, BASE_INPUT, 4 * TRIAL_LANES * (4 * o + c));
            m.input[first ? o : o + 1][c] = m.coordinate[o + 1][c] = value;
        }
    machine_run(E, &m);
    for (unsigned r = 0; r < trial->results; r++)
        for (unsigned c = 0; c < 4; c++)
            store_f(E, BASE_OUTPUT, (int)(4 * TRIAL_LANES * (4 * r + c)),
                    m.cell[trial_cell(memory->program, r) + c]);
}
