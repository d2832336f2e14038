/* Random shaders ps_1_1 to ps_1_4: texture stages, or two phases of them, then a few operations, some of
 * them in pairs. */
#include "command/fuzz/case/shader_part.h"

/* --- ps_1_1 to ps_1_3 ----------------------------------------------------------------------------------- */

static bool has_stages(const struct maker *maker, unsigned slots)
{
    return maker->check.texture + slots <= maker->model->texture;
}

static bool write_stage(struct maker *maker, enum shader_opcode opcode, unsigned stage)
{
    struct shader_operand to = fuzz_shader_result(FILE_TEXTURE, stage, MASK_FULL);
    return fuzz_shader_has(maker, opcode) && fuzz_shader_propose(maker, opcode, &to);
}

/* Rows of a matrix, in consecutive stages; returns how many. A group once begun must be ended. */
static unsigned write_matrix(struct maker *maker, unsigned stage, unsigned left)
{
    static const uint8_t of_two[] = {SHADER_TEXM3X2TEX, SHADER_TEXM3X2DEPTH};
    static const uint8_t of_three[] = {SHADER_TEXM3X3TEX, SHADER_TEXM3X3SPEC, SHADER_TEXM3X3VSPEC,
                                       SHADER_TEXM3X3};
    unsigned rows = left > 2 && one_in(maker, 2) ? 3 : 2;
    enum shader_opcode pad = rows == 3 ? SHADER_TEXM3X3PAD : SHADER_TEXM3X2PAD, end;
    if (left < rows || !has_stages(maker, rows) || !maker->check.written.texture[0])
        return 0;
    do
        end = rows == 3 ? of_three[below(maker, sizeof of_three)] : of_two[below(maker, sizeof of_two)];
    while (!fuzz_shader_has(maker, end));
    struct check before = maker->check;
    uint32_t count = maker->shader->count;
    unsigned done = 0;
    while (done + 1 < rows && write_stage(maker, pad, stage + done))
        done++;
    if (done + 1 == rows && write_stage(maker, end, stage + done))
        return rows;
    maker->check = before;
    maker->shader->count = count;
    return 0;
}

static void write_stages_in_order(struct maker *maker)
{
    static const uint8_t opcodes[] = {SHADER_TEX,        SHADER_TEX,       SHADER_TEX,       SHADER_TEXCOORD,
                                      SHADER_TEXBEM,     SHADER_TEXBEML,   SHADER_TEXREG2AR, SHADER_TEXREG2GB,
                                      SHADER_TEXREG2RGB, SHADER_TEXDP3TEX, SHADER_TEXDP3};
    unsigned all = shader_register_count(FILE_TEXTURE, maker->model);
    unsigned stages = one_in(maker, 8) ? 0 : 1 + below(maker, all);
    for (unsigned stage = 0; stage < stages && has_stages(maker, 1);) {
        unsigned rows = one_in(maker, 3) ? write_matrix(maker, stage, all - stage) : 0;
        stage += rows;
        if (rows)
            continue;
        enum shader_opcode opcode = opcodes[below(maker, sizeof opcodes)];
        if (!has_stages(maker, 2) || !write_stage(maker, opcode, stage))
            write_stage(maker, SHADER_TEX, stage);
        stage++;
    }
    if (one_in(maker, 8) && has_stages(maker, 1))
        write_stage(maker, SHADER_TEXKILL, below(maker, all));
}

/* --- ps_1_4 --------------------------------------------------------------------------------------------- */

static void write_phase_textures(struct maker *maker)
{
    unsigned count = below(maker, 4);
    for (unsigned i = 0; i < count; i++) {
        unsigned index = below(maker, maker->model->temporaries);
        enum shader_opcode opcode = one_in(maker, 4) ? SHADER_TEXCRD : SHADER_TEXLD_1_4;
        unsigned mask =
            opcode == SHADER_TEXCRD ? fuzz_shader_choose_mask(maker, &shader_operations[opcode]) : MASK_FULL;
        struct shader_operand to = fuzz_shader_result(FILE_TEMPORARY, index, mask);
        if (!(maker->check.stage_used >> index & 1))
            fuzz_shader_propose(maker, opcode, &to);
    }
    if (maker->check.phase < 2)
        return;
    if (one_in(maker, 8)) {
        struct shader_operand killed = fuzz_shader_result(FILE_TEMPORARY, below(maker, 6), MASK_FULL);
        if (one_in(maker, 2))
            killed.file = FILE_TEXTURE;
        if (killed.file == FILE_TEXTURE ||
            (maker->check.written.temporary[killed.index] & MASK_XYZ) == MASK_XYZ)
            fuzz_shader_propose(maker, SHADER_TEXKILL, &killed);
    }
    if (one_in(maker, 6) && maker->check.written.temporary[5] & MASK_XY)
        fuzz_shader_propose(maker, SHADER_TEXDEPTH,
                            &(struct shader_operand){FILE_TEMPORARY, .swizzle = MASK_FULL, .index = 5});
}

/* --- Arithmetic ----------------------------------------------------------------------------------------- */

/* Colours in one half, alpha in the other. */
static void write_pair(struct maker *maker)
{
    unsigned index = below(maker, maker->pool);
    struct shader_operand color = fuzz_shader_result(FILE_TEMPORARY, index, MASK_XYZ),
                          alpha = fuzz_shader_result(FILE_TEMPORARY, below(maker, maker->pool), MASK_W);
    bool swapped = one_in(maker, 4);
    if (!fuzz_shader_propose_any(maker, swapped ? &alpha : &color))
        return;
    struct check before = maker->check;
    uint32_t count = maker->shader->count;
    if (!fuzz_shader_propose_any(maker, swapped ? &color : &alpha))
        return;
    /* The second instruction is valid by itself and is proposed again as half of a pair. */
    struct check after = maker->check;
    struct shader_instruction alone = maker->shader->instructions[count], paired = alone;
    paired.coissue = true;
    maker->check = before;
    maker->shader->count = count;
    if (maker->shader->instructions[count - 1].opcode == SHADER_DP4 || alone.opcode == SHADER_DP4 ||
        !fuzz_shader_add(maker, &paired)) {
        maker->shader->instructions[maker->shader->count++] = alone;
        maker->check = after;
    }
}

static void write_arithmetic(struct maker *maker, unsigned count)
{
    while (count-- > 0 && fuzz_shader_has_room(maker, 2) && !maker->failed) {
        if (one_in(maker, 4))
            write_pair(maker);
        else if (maker->check.phase == 1 && !maker->check.bumped && one_in(maker, 6))
            fuzz_shader_propose(maker, SHADER_BEM, NULL);
        else if (one_in(maker, 80))
            fuzz_shader_propose(maker, SHADER_NOP, NULL);
        else
            fuzz_shader_propose_any(maker, NULL);
    }
}

/* r0 is the colour: all of it must be written; mostly by something that varies. */
static void complete_color(struct maker *maker)
{
    static const uint8_t opcodes[] = {SHADER_MAD, SHADER_MUL, SHADER_ADD};
    struct shader_operand to = fuzz_shader_result(FILE_TEMPORARY, 0, MASK_FULL);
    bool complete = maker->check.written.temporary[0] == MASK_FULL;
    maker->reserve = 0;
    if (!complete && !fuzz_shader_propose(maker, one_in(maker, 2) ? SHADER_ADD : SHADER_LRP, &to))
        fuzz_shader_propose(maker, SHADER_MOV, &to);
    if (complete && one_in(maker, 2))
        fuzz_shader_gather(maker, 0);
    if (maker->wild || !fuzz_shader_has_room(maker, 1) || one_in(maker, 4))
        return;
    struct shader_instruction vary = {.opcode = opcodes[below(maker, sizeof opcodes)], .destination = to};
    vary.source[0] = fuzz_shader_choose_input(maker);
    vary.source[1] = fuzz_shader_operand(FILE_TEMPORARY, 0);
    vary.destination.shift = (int8_t) - (int)below(maker, 2);
    if (vary.opcode == SHADER_MAD) {
        vary.source[2] = vary.source[1];
        vary.source[1] = fuzz_shader_operand(FILE_CONSTANT, below(maker, maker->constants));
    }
    if (vary.source[0].file)
        fuzz_shader_add(maker, &vary);
}

void fuzz_shader_stages(struct maker *maker)
{
    bool four = maker->model->column == COLUMN_PS_1_4;
    unsigned most = maker->model->arithmetic - 1u;
    fuzz_shader_definitions(maker);
    maker->reserve = 1;
    if (!four) {
        write_stages_in_order(maker);
    } else {
        maker->check.phase = one_in(maker, 2) ? 1 : 2; /* which the validator looks ahead for */
        write_phase_textures(maker);
        if (maker->check.phase == 1) {
            write_arithmetic(maker, below(maker, most));
            if (maker->check.arithmetic_begun || maker->check.stage_used)
                fuzz_shader_add(maker, &(struct shader_instruction){.opcode = SHADER_PHASE});
            maker->check.phase = 2;
            write_phase_textures(maker);
        }
    }
    write_arithmetic(maker, below(maker, most + 1));
    complete_color(maker);
}
