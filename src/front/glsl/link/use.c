#include "front/glsl/link/link.h"

static void note(uint8_t *use, const struct glsl_code *code, const struct glsl_operand *x)
{
    if (!x->access) {
        use[x->number] |= GLSL_USED;
        return;
    }
    const struct glsl_access *access = &code->access[x->access];
    uint32_t count = 1;
    for (unsigned i = 0; i < access->levels; i++)
        count *= access->level[i].count;
    for (uint32_t n = 0; n < count; n++) {
        uint32_t offset = 0;
        for (uint32_t i = access->levels, rest = n; i-- > 0; rest /= access->level[i].count)
            offset += rest % access->level[i].count * access->level[i].stride;
        use[x->number + offset] |= GLSL_USED;
    }
    for (uint32_t i = 0; i < access->registers; i++)
        use[access->first + i] |= GLSL_USED_RELATIVE;
}

static uint8_t *use_of(const struct glsl_stage_link *stage, unsigned file)
{
    switch (file) {
    case GLSL_FILE_UNIFORM: return stage->uniform_use;
    case GLSL_FILE_ATTRIBUTE: return stage->attribute_use;
    case GLSL_FILE_VARYING: return stage->varying_use;
    default: return NULL;
    }
}

void glsl_link_note_uses(struct glsl_linker *linker, struct glsl_stage_link *stage)
{
    const struct glsl_code *code = stage->code;
    stage->uniform_use = glsl_take(&linker->arena, code->uniform.registers + 1);
    stage->attribute_use = glsl_take(&linker->arena, code->attribute.registers + 1);
    stage->varying_use = glsl_take(&linker->arena, code->varying.registers + 1);
    for (uint32_t i = 0; i < code->count; i++) {
        const struct glsl_instruction *x = &code->instruction[i];
        for (unsigned k = 0; k < glsl_ops[x->op].sources; k++) {
            uint8_t *use = use_of(stage, x->from[k].file);
            if (use)
                note(use, code, &x->from[k]);
        }
        uint8_t *use = use_of(stage, x->to.file);
        if (use && glsl_ops[x->op].kind != GLSL_FLOW)
            note(use, code, &x->to);
    }
}
