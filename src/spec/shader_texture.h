/* What the texture instructions of shaders compute. */

/* Returns whether there is a result to write. */
static inline int execute_texture(struct env *e, struct step *s, struct vector4 *result)
{
    (void)e;
    *result = s->source[0];
    return 1;
}
