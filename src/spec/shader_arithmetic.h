/* What the arithmetic instructions of shaders compute. */

static inline struct vector4 execute_mov(struct env *e, const struct step *s)
{
    (void)e;
    return s->source[0];
}

static inline struct vector4 execute_arithmetic(struct env *e, const struct step *s)
{
    switch (s->instruction->opcode) {
    default: return execute_mov(E, s);
    }
}
