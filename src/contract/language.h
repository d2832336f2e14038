/* The staged language, in which the specification is written (docs/staging.md).
 *
 * The specification is ordinary C over values whose meaning a *binding* defines. An engine includes its
 * binding first, then spec/spec.h: the emulator's binding computes each operation, the recorder's appends it
 * to a list. A binding provides
 *
 *   flt itg fix msk      the types of values: binary32, int32, two 16-bit integers, all ones or zeros
 *   struct env, E        the state of the binding; E names it, together with the current line of the source
 *   add_f(E, a, b) ...   every operation of def/op.def; permute_f
 *   lit_f(E, 1.0f) ...   constants
 *   load_ store_         a word for each lane; uniform_ loads one word for all lanes. By the key's promise,
 *                        that of uniform_unit_f is from 0 to 1, and neither -0 nor a denormal
 *   gather_ scatter_     a word for each lane, from or to an address of its own
 *   WHEN (E, mask)       a region that may be skipped when no lane of the mask is set
 *   LOOP (E, variable)   a region that is repeated while any lane of the mask variable is set
 *   get_ set_            variables, by number; only these leave a region or pass to the next round
 *   OBSERVE (E, name, number, value)
 *                        names a value by a row of def/observed.def; most bindings leave it out, and it then
 *                        does nothing
 *   NOTE_STEP (E, step)  the following operations belong to a step of the shader, or to NO_STEP; most
 *                        bindings leave it out, and it then does nothing
 *   NOTE_SAMPLING (E, begins)
 *                        the sampling of a texture begins, or ends: the operations between have no effect but
 *                        their values; most bindings leave it out, and it then does nothing
 *
 * Three more names choose how a shader is executed, and not what it computes. The forms of the emulator
 * (emu/emulate/form.h) define them; without them they are functions of the specification:
 *
 *   MACHINE (E, m)       declares m, the address of a shader's machine (spec/shader/shader.h)
 *   READ_REGISTERS       reads the registers of a source: read_registers
 *   EXECUTE_NEXT         executes the step at a position, and returns the next position: execute_next
 *
 * This file defines a binding that does nothing, if none was included before. With it each header of the
 * specification compiles by itself, so an editor can open it. */
#ifndef CONTRACT_LANGUAGE_H
#define CONTRACT_LANGUAGE_H

#ifndef E

#include "contract/binding.h"

typedef struct {
    float nothing;
} flt;
typedef struct {
    int32_t nothing;
} itg;
typedef struct {
    uint16_t nothing;
} fix;
typedef struct {
    int32_t nothing;
} msk;

struct env {
    const struct program *program; /* of the shader, if the key has one */
};

#define E e

#define UNUSED          __attribute__((unused))
#define ARGUMENT_flt(n) , UNUSED flt n
#define ARGUMENT_itg(n) , UNUSED itg n
#define ARGUMENT_fix(n) , UNUSED fix n
#define ARGUMENT_msk(n) , UNUSED msk n
#define ARGUMENT_non(n)

#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    static inline result name(UNUSED struct env *e ARGUMENT_##ta(a) ARGUMENT_##tb(b) ARGUMENT_##tc(c))       \
    {                                                                                                        \
        return (result){0};                                                                                  \
    }
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    static inline result name(UNUSED struct env *e ARGUMENT_##ta(a), UNUSED int k)                           \
    {                                                                                                        \
        return (result){0};                                                                                  \
    }
#define CAST(name, result, from)                                                                             \
    static inline result name(UNUSED struct env *e, UNUSED from a)                                           \
    {                                                                                                        \
        return (result){0};                                                                                  \
    }
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST

#define LITERAL(name, result, from)                                                                          \
    static inline result name(UNUSED struct env *e, UNUSED from value)                                       \
    {                                                                                                        \
        return (result){0};                                                                                  \
    }
LITERAL(lit_f, flt, float)
LITERAL(lit_i, itg, int32_t)
LITERAL(lit_x, fix, uint16_t)
LITERAL(lit_m, msk, int32_t)
LITERAL(get_f, flt, int)
LITERAL(get_i, itg, int)
LITERAL(get_m, msk, int)
#undef LITERAL

#define MEMORY(letter, type)                                                                                 \
    static inline type load_##letter(UNUSED struct env *e, UNUSED enum base base, UNUSED int offset)         \
    {                                                                                                        \
        return (type){0};                                                                                    \
    }                                                                                                        \
    static inline type uniform_##letter(UNUSED struct env *e, UNUSED enum base base, UNUSED int offset)      \
    {                                                                                                        \
        return (type){0};                                                                                    \
    }                                                                                                        \
    static inline type gather_##letter(UNUSED struct env *e, UNUSED enum base base, UNUSED int field,        \
                                       UNUSED itg index, UNUSED int scale, UNUSED int displacement)          \
    {                                                                                                        \
        return (type){0};                                                                                    \
    }                                                                                                        \
    static inline void store_##letter(UNUSED struct env *e, UNUSED enum base base, UNUSED int offset,        \
                                      UNUSED type value)                                                     \
    {                                                                                                        \
    }                                                                                                        \
    static inline void scatter_##letter(UNUSED struct env *e, UNUSED enum base base, UNUSED int offset,      \
                                        UNUSED int stride, UNUSED type value)                                \
    {                                                                                                        \
    }
MEMORY(f, flt)
MEMORY(i, itg)
#undef MEMORY

static inline flt uniform_unit_f(UNUSED struct env *e, UNUSED enum base base, UNUSED int offset)
{
    return (flt){0};
}

static inline void set_f(UNUSED struct env *e, UNUSED int variable, UNUSED flt value)
{
}
static inline void set_i(UNUSED struct env *e, UNUSED int variable, UNUSED itg value)
{
}
static inline void set_m(UNUSED struct env *e, UNUSED int variable, UNUSED msk value)
{
}

static inline flt permute_f(UNUSED struct env *e, flt a, UNUSED int lanes)
{
    return a;
}

#define WHEN(e, mask)     for (msk region_ = (mask), *once_ = &region_; once_; once_ = NULL)
#define LOOP(e, variable) for (int round_ = (variable); round_ >= 0; round_ = -1)

#undef UNUSED
#undef ARGUMENT_flt
#undef ARGUMENT_itg
#undef ARGUMENT_fix
#undef ARGUMENT_msk
#undef ARGUMENT_non

#endif

#ifndef OBSERVE
#define OBSERVE(e, name, number, value)
#endif

#ifndef NOTE_STEP
#define NOTE_STEP(e, step)
#endif

#ifndef MACHINE
#define MACHINE(e, m) struct machine m##_storage, *const m = &m##_storage
#endif

#ifndef READ_REGISTERS
#define READ_REGISTERS read_registers
#endif

#ifndef EXECUTE_NEXT
#define EXECUTE_NEXT execute_next
#endif

#ifndef NOTE_SAMPLING
#define NOTE_SAMPLING(e, begins)
#endif
#endif
