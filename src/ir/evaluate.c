/* Evaluates one lane of an operation with the expression of its row in def/op.def, for constant folding and
 * tests. */
#include "base/bits.h"
#include "contract/lane.h"
#include "ir/ir.h"

typedef float value_flt;
typedef int32_t value_itg;
typedef int32_t value_msk;
typedef uint16_t value_fix;
typedef int value_non;

static float get_flt(uint32_t bits)
{
    return bits_to_float(bits);
}

static int32_t get_itg(uint32_t bits)
{
    return (int32_t)bits;
}

static uint32_t put_flt(float value)
{
    return bits_of_float(value);
}

static uint32_t put_itg(int32_t value)
{
    return (uint32_t)value;
}

static uint16_t get_fix(uint32_t bits)
{
    return (uint16_t)bits;
}

static uint32_t put_fix(uint32_t value)
{
    return value & 0xffff;
}

#define get_msk    get_itg
#define put_msk    put_itg
#define get_non(x) 0
#define USE(a)     (void)(a)

/* Each row as a function of three words. For pairs it evaluates the low halves. */
#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    static uint32_t evaluate_##name(uint32_t wa, uint32_t wb, uint32_t wc, int32_t k)                        \
    {                                                                                                        \
        value_##ta a = get_##ta(wa);                                                                         \
        value_##tb b = get_##tb(wb);                                                                         \
        value_##tc c = get_##tc(wc);                                                                         \
        USE(a), USE(b), USE(c), USE(k), USE(wa), USE(wb), USE(wc);                                           \
        return put_##result(expression);                                                                     \
    }
#define OPK OP
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef CAST

typedef uint32_t evaluate_function(uint32_t, uint32_t, uint32_t, int32_t);

static evaluate_function *const evaluate[IR_OP_COUNT] = {
#define OP(name, ...) [IR_##name] = evaluate_##name,
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
};

uint32_t ir_evaluate(enum ir_op op, uint32_t a, uint32_t b, uint32_t c, int32_t k)
{
    uint32_t low = evaluate[op](a, b, c, k);
    if (ir_op_information[op].result != TYPE_fix)
        return low;
    return low | evaluate[op](a >> 16, b >> 16, c >> 16, k) << 16;
}
