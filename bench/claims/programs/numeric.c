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

/* A walk of quads of 2x2 pixels in Z-order by two steps, which repeat: a to the right, b down and back. So it
 * goes down a strip of 4 pixels in width. A lane of a quad adds its own offset. */
struct walk {
    double error; /* the largest, in texels */
    double equal; /* the share of quads whose value has the bits of the plane's, in percent */
};

/* Each strip begins with the value of its plane again after `height` pixels: 4 are a block, 64 a tile. */
static struct walk walk_strips(int width, int repeats, int height)
{
    float step = (float)repeats / (float)width, down = step * 0.37f;
    float a = 2 * step, b = 2 * down - 2 * step;
    double most = 0;
    int quads = 0, equal = 0;
    for (int left = 0; left < width; left += 4) {
        float value = fmaf((float)left, step, 0);
        for (int quad = 0; quad < height; quad++, quads++) { /* two for each two rows */
            int x = left + quad % 2 * 2, y = quad / 2 * 2;
            double right = (double)repeats * x / width + (double)down * y;
            most = fmax(most, fabs((double)value - right));
            equal += value == fmaf((float)y, down, fmaf((float)x, step, 0));
            value += quad % 2 ? b : a;
        }
    }
    return (struct walk){256 * most, 100.0 * equal / quads};
}

/* The step data of a component, for quads of four lanes: two steps, or an offset for each quad of a block. */
static void print_walks(void)
{
    static const int heights[] = {4, 64, 1024};
    printf("\"step_bytes\": %zu, \"offset_bytes\": %zu, \"walks\": [", 2 * sizeof(__m128),
           4 * sizeof(__m128));
    for (int i = 0; i < 3; i++) {
        struct walk walk = walk_strips(1999, 37, heights[i]);
        printf("%s{\"height\": %d, \"error\": %.6f, \"equal\": %.2f}", i ? ", " : "", heights[i], walk.error,
               walk.equal);
    }
    printf("], ");
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
    printf("{\"reciprocal\": %.3e, \"refined\": %.3e, \"stepped\": %.6f, \"plane\": %.6f, ",
           reciprocal_error(0), reciprocal_error(1), stepping_error(1999, 37), plane_error(1999, 37));
    print_walks();
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
