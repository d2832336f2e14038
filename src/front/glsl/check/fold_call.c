/* The functions of chapter 8 for constants. They are computed in binary64 and rounded once. */
#include "front/glsl/check/builtin.h"
#include "front/glsl/check/fold.h"

#include <math.h>
#include <string.h>

static double radians_of(double x)
{
    return x * M_PI / 180;
}

static double degrees_of(double x)
{
    return x * 180 / M_PI;
}

static double inverse_root(double x)
{
    return 1 / sqrt(x);
}

static double sign_of(double x)
{
    return (x > 0) - (x < 0);
}

static double fraction(double x)
{
    return x - floor(x);
}

static double modulus(double x, double y)
{
    return x - y * floor(x / y);
}

static double smaller(double x, double y)
{
    return y < x ? y : x;
}

static double larger(double x, double y)
{
    return x < y ? y : x;
}

static double product(double x, double y)
{
    return x * y;
}

static double step(double edge, double x)
{
    return x < edge ? 0 : 1;
}

static double clamp(double x, double low, double high)
{
    return smaller(larger(x, low), high);
}

static double mix(double x, double y, double a)
{
    return x * (1 - a) + y * a;
}

static double smooth_step(double low, double high, double x)
{
    double t = clamp((x - low) / (high - low), 0, 1);
    return t * t * (3 - 2 * t);
}

/* --- All components together ---------------------------------------------------------------------------- */

static double argument(const struct glsl_expression *a, unsigned i)
{
    return (double)a->value[glsl_is_scalar(a->type) ? 0 : i].f;
}

static double dot_product(const struct glsl_expression *a, const struct glsl_expression *b)
{
    double sum = 0;
    for (unsigned i = 0; i < a->type.rows; i++)
        sum += argument(a, i) * argument(b, i);
    return sum;
}

static void dot(const struct glsl_expression *x, union glsl_scalar *r)
{
    r->f = (float)dot_product(x->argument, x->argument->next);
}

static void length(const struct glsl_expression *x, union glsl_scalar *r)
{
    r->f = (float)sqrt(dot_product(x->argument, x->argument));
}

static void distance(const struct glsl_expression *x, union glsl_scalar *r)
{
    const struct glsl_expression *a = x->argument, *b = a->next;
    double sum = 0;
    for (unsigned i = 0; i < a->type.rows; i++)
        sum += pow(argument(a, i) - argument(b, i), 2);
    r->f = (float)sqrt(sum);
}

static void cross(const struct glsl_expression *x, union glsl_scalar *r)
{
    const struct glsl_expression *a = x->argument, *b = a->next;
    for (unsigned i = 0; i < 3; i++) {
        unsigned j = (i + 1) % 3, k = (i + 2) % 3;
        r[i].f = (float)(argument(a, j) * argument(b, k) - argument(b, j) * argument(a, k));
    }
}

static void normalize(const struct glsl_expression *x, union glsl_scalar *r)
{
    double scale = 1 / sqrt(dot_product(x->argument, x->argument));
    for (unsigned i = 0; i < x->type.rows; i++)
        r[i].f = (float)(argument(x->argument, i) * scale);
}

static void face_forward(const struct glsl_expression *x, union glsl_scalar *r)
{
    const struct glsl_expression *n = x->argument, *incident = n->next, *reference = incident->next;
    double sign = dot_product(reference, incident) < 0 ? 1 : -1;
    for (unsigned i = 0; i < x->type.rows; i++)
        r[i].f = (float)(sign * argument(n, i));
}

static void reflect(const struct glsl_expression *x, union glsl_scalar *r)
{
    const struct glsl_expression *incident = x->argument, *n = incident->next;
    double twice = 2 * dot_product(n, incident);
    for (unsigned i = 0; i < x->type.rows; i++)
        r[i].f = (float)(argument(incident, i) - twice * argument(n, i));
}

static void refract(const struct glsl_expression *x, union glsl_scalar *r)
{
    const struct glsl_expression *incident = x->argument, *n = incident->next, *eta = n->next;
    double ratio = argument(eta, 0), cosine = dot_product(n, incident);
    double k = 1 - ratio * ratio * (1 - cosine * cosine);
    for (unsigned i = 0; i < x->type.rows; i++)
        r[i].f =
            k < 0 ? 0 : (float)(ratio * argument(incident, i) - (ratio * cosine + sqrt(k)) * argument(n, i));
}

/* --- Comparisons ---------------------------------------------------------------------------------------- */

/* Calls `holds` with -1, 0 or 1 for each pair of components. */
static void compare(const struct glsl_expression *x, union glsl_scalar *r, bool (*holds)(int order))
{
    const struct glsl_expression *a = x->argument, *b = a->next;
    for (unsigned i = 0; i < x->type.rows; i++) {
        bool real = a->type.base == GLSL_FLOAT;
        int above = real ? a->value[i].f > b->value[i].f : a->value[i].i > b->value[i].i;
        int below = real ? a->value[i].f < b->value[i].f : a->value[i].i < b->value[i].i;
        r[i].i = holds(above - below);
    }
}

static bool is_below(int order)
{
    return order < 0;
}

static bool is_not_above(int order)
{
    return order <= 0;
}

static bool is_above(int order)
{
    return order > 0;
}

static bool is_not_below(int order)
{
    return order >= 0;
}

static bool is_same(int order)
{
    return order == 0;
}

static bool is_other(int order)
{
    return order != 0;
}

static void less(const struct glsl_expression *x, union glsl_scalar *r)
{
    compare(x, r, is_below);
}

static void less_equal(const struct glsl_expression *x, union glsl_scalar *r)
{
    compare(x, r, is_not_above);
}

static void greater(const struct glsl_expression *x, union glsl_scalar *r)
{
    compare(x, r, is_above);
}

static void greater_equal(const struct glsl_expression *x, union glsl_scalar *r)
{
    compare(x, r, is_not_below);
}

static void equal(const struct glsl_expression *x, union glsl_scalar *r)
{
    compare(x, r, is_same);
}

static void not_equal(const struct glsl_expression *x, union glsl_scalar *r)
{
    compare(x, r, is_other);
}

static unsigned count_true(const struct glsl_expression *a)
{
    unsigned count = 0;
    for (unsigned i = 0; i < a->type.rows; i++)
        count += a->value[i].i != 0;
    return count;
}

static void any(const struct glsl_expression *x, union glsl_scalar *r)
{
    r->i = count_true(x->argument) > 0;
}

static void all(const struct glsl_expression *x, union glsl_scalar *r)
{
    r->i = count_true(x->argument) == x->argument->type.rows;
}

static void not(const struct glsl_expression *x, union glsl_scalar *r)
{
    for (unsigned i = 0; i < x->type.rows; i++)
        r[i].i = !x->argument->value[i].i;
}

/* The derivative of a constant. */
static void no_difference(const struct glsl_expression *x, union glsl_scalar *r)
{
    memset(r, 0, glsl_scalars(x->type) * sizeof *r);
}

/* --- All ------------------------------------------------------------------------------------------------ */

static const struct {
    double (*one)(double);
    double (*two)(double, double);
    double (*three)(double, double, double);
    void (*whole)(const struct glsl_expression *, union glsl_scalar *);
} functions[] = {
#define ONE(function)                     .one = (function)
#define TWO(function)                     .two = (function)
#define THREE(function)                   .three = (function)
#define WHOLE(function)                   .whole = (function)
#define NEVER(function)                   .whole = (function)
#define GLSL_FUNCTION(id, kind, evaluate) [GLSL_CALL_##id] = {kind(evaluate)},
#include "front/glsl/check/function.def"
#undef GLSL_FUNCTION
};

/* One component of a function whose components are independent. */
static double component(const struct glsl_expression *call, unsigned i)
{
    const struct glsl_expression *a = call->argument, *b = a->next, *c = b ? b->next : NULL;
    if (functions[call->index].one)
        return functions[call->index].one(argument(a, i));
    if (functions[call->index].two)
        return functions[call->index].two(argument(a, i), argument(b, i));
    return functions[call->index].three(argument(a, i), argument(b, i), argument(c, i));
}

bool glsl_fold_call(const struct glsl_expression *call, union glsl_scalar *value)
{
    bool parts = functions[call->index].one || functions[call->index].two || functions[call->index].three;
    if (!parts && !functions[call->index].whole)
        return false;
    if (parts)
        for (unsigned i = 0; i < glsl_scalars(call->type); i++)
            value[i].f = (float)component(call, i);
    else
        functions[call->index].whole(call, value);
    return true;
}
