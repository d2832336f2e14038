/* Errors of cheaper arithmetic: the approximate reciprocal, planes that are stepped, and depth as z, w and
 * 1/z. Prints JSON. */
#include <math.h>
#include <stdio.h>
#include <xmmintrin.h>

/* The largest relative error of the processor's approximate reciprocal, over a binade. */
static double reciprocal_error(int refined)
{
    double most = 0;
    for (int i = 0; i < 1 << 20; i++) {
        float x = 1 + (float)i / (1 << 20), y = _mm_cvtss_f32(_mm_rcp_ss(_mm_set_ss(x)));
        if (refined)
            y = y * (2 - x * y);
        most = fmax(most, fabs((double)x * y - 1));
    }
    return most;
}

/* The largest error in texels of a coordinate that is stepped over `width` pixels, from a texture of 256
 * texels that is repeated `repeats` times. */
static double stepping_error(int width, int repeats)
{
    float step = (float)repeats / (float)width, value = 0;
    double most = 0;
    for (int x = 0; x < width; x++, value += step)
        most = fmax(most, fabs((double)value - (double)repeats * x / width));
    return 256 * most;
}

/* The same if each block of 4x4 pixels begins with the value of the plane, and two steps walk its quads of
 * 2x2 in Z-order: a to the right, b down and back, a again. A lane of a quad adds its own offset. */
static double walked_error(int width, int repeats)
{
    float step = (float)repeats / (float)width, down = step * 0.37f;
    float a = 2 * step, b = 2 * down - 2 * step;
    double most = 0;
    for (int x = 0; x < width; x += 4) {
        float value = fmaf((float)x, step, 0), steps[3] = {a, b, a};
        for (int quad = 0; quad < 4; quad++) {
            double right = (double)repeats * (x + quad % 2 * 2) / width + (double)down * (quad / 2 * 2);
            most = fmax(most, fabs((double)value - right));
            value += quad < 3 ? steps[quad] : 0;
        }
    }
    return 256 * most;
}

/* The same with the value computed from the plane at each pixel. */
static double plane_error(int width, int repeats)
{
    float slope = (float)repeats / (float)width;
    double most = 0;
    for (int x = 0; x < width; x++)
        most = fmax(most, fabs((double)fmaf((float)x, slope, 0) - (double)repeats * x / width));
    return 256 * most;
}

/* The smallest difference of distance that 24 bits distinguish, between planes at 1 and 1000. */
static double resolution_z(double distance)
{
    double slope = 1000.0 / 999 / (distance * distance);
    return 1 / (slope * ((1 << 24) - 1));
}

static double resolution_w(void)
{
    return 999.0 / ((1 << 24) - 1);
}

/* 1/z as a float of 24 bits of mantissa. */
static double resolution_float(double distance)
{
    float stored = (float)(1 / distance);
    return fabs(1 / (double)nextafterf(stored, 0) - 1 / (double)stored);
}

int main(void)
{
    printf("{\"reciprocal\": %.3e, \"refined\": %.3e, \"stepped\": %.6f, \"walked\": %.6f, \"plane\": %.6f, ",
           reciprocal_error(0), reciprocal_error(1), stepping_error(1999, 37), walked_error(1999, 37),
           plane_error(1999, 37));
    printf("\"depth\": [");
    static const double distances[] = {1, 2, 5, 10, 50, 100, 500, 999};
    for (int i = 0; i < 8; i++) {
        double d = distances[i];
        printf("%s{\"distance\": %g, \"z\": %.3e, \"w\": %.3e, \"inverse\": %.3e}", i ? ", " : "", d,
               resolution_z(d), resolution_w(), resolution_float(d));
    }
    printf("]}\n");
    return 0;
}
