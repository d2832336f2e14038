#include "area.h"

#include <math.h>

enum { CORNERS = 8 };

struct polygon {
    double x[CORNERS], y[CORNERS];
    int count;
};

struct area_side area_side_of(double from_x, double from_y, double to_x, double to_y, int turned)
{
    double a = from_y - to_y, b = to_x - from_x, sign = turned ? -1 : 1;
    return (struct area_side){sign * a, sign * b, -sign * (a * from_x + b * from_y)};
}

static double value(const struct area_side *side, double x, double y)
{
    return side->a * x + side->b * y + side->c;
}

static void add(struct polygon *p, double x, double y)
{
    p->x[p->count] = x;
    p->y[p->count++] = y;
}

static struct polygon clipped(const struct polygon *p, const struct area_side *side)
{
    struct polygon r = {.count = 0};
    for (int i = 0; i < p->count; i++) {
        int j = (i + 1) % p->count;
        double from = value(side, p->x[i], p->y[i]), to = value(side, p->x[j], p->y[j]);
        if (from >= 0)
            add(&r, p->x[i], p->y[i]);
        if ((from >= 0) != (to >= 0)) {
            double t = from / (from - to);
            add(&r, p->x[i] + t * (p->x[j] - p->x[i]), p->y[i] + t * (p->y[j] - p->y[i]));
        }
    }
    return r;
}

static struct polygon square(int x, int y)
{
    return (struct polygon){{x, x + 1, x + 1, x}, {y, y, y + 1, y + 1}, 4};
}

static double area_of(const struct polygon *p)
{
    double sum = 0;
    for (int i = 1; i + 1 < p->count; i++)
        sum += (p->x[i] - p->x[0]) * (p->y[i + 1] - p->y[0]) - (p->x[i + 1] - p->x[0]) * (p->y[i] - p->y[0]);
    return sum / 2;
}

/* The side's values at the corners of the pixel that are farthest inside and outside. */
static double most_at(const struct area_side *side, int x, int y)
{
    return value(side, x + (side->a > 0), y + (side->b > 0));
}

static double least_at(const struct area_side *side, int x, int y)
{
    return value(side, x + (side->a < 0), y + (side->b < 0));
}

bool area_touches(const struct area_side *side, int count, int x, int y)
{
    for (int i = 0; i < count; i++)
        if (most_at(&side[i], x, y) <= 0)
            return false;
    return true;
}

double area_within(const struct area_side *side, int count, int x, int y)
{
    struct polygon p = square(x, y);
    if (!area_touches(side, count, x, y))
        return 0;
    for (int i = 0; i < count; i++)
        if (least_at(&side[i], x, y) < 0)
            p = clipped(&p, &side[i]);
    return area_of(&p);
}

int area_cuts(const struct area_side *side, int count, int x, int y)
{
    int cuts = 0;
    for (int i = 0; i < count; i++)
        cuts += most_at(&side[i], x, y) > 0 && least_at(&side[i], x, y) < 0;
    return cuts;
}

/* The integral of sqrt(r r - t t) from 0 to t. */
static double under_circle(double radius, double t)
{
    t = fmin(fmax(t, -radius), radius);
    return (t * sqrt(radius * radius - t * t) + radius * radius * asin(t / radius)) / 2;
}

/* The area of the circle around 0 at less than x and less than y, both at most 0. */
static double in_corner(double radius, double x, double y)
{
    if (x * x + y * y >= radius * radius)
        return 0;
    double from = -sqrt(radius * radius - y * y);
    return under_circle(radius, x) - under_circle(radius, from) + y * (x - from);
}

/* The same with any signs. */
static double in_quadrant(double radius, double x, double y)
{
    double whole = 3.14159265358979323846 * radius * radius;
    x = fmin(fmax(x, -radius), radius);
    y = fmin(fmax(y, -radius), radius);
    if (x > 0)
        return 2 * in_quadrant(radius, 0, y) - in_quadrant(radius, -x, y);
    if (y > 0)
        return 2 * in_quadrant(radius, x, 0) - in_quadrant(radius, x, -y);
    return x == 0 && y == 0 ? whole / 4 : in_corner(radius, x, y);
}

double area_in_circle(double centre_x, double centre_y, double radius, int x, int y)
{
    double left = x - centre_x, top = y - centre_y;
    return in_quadrant(radius, left + 1, top + 1) - in_quadrant(radius, left, top + 1) -
           in_quadrant(radius, left + 1, top) + in_quadrant(radius, left, top);
}
