/* Sine and cosine in binary64 with the same bits everywhere. They consist of additions, multiplications,
 * divisions and a rounding to an integer. IEEE 754 defines these exactly. The C library's functions differ in
 * the last bit between versions and processors.
 *
 * The error is less than three units in the last place. Arguments are radians from -SINE_MOST to SINE_MOST;
 * the result for others is NaN. The rounding mode must be to nearest. */
#ifndef COMMAND_STREAM_SINE_H
#define COMMAND_STREAM_SINE_H

enum { SINE_MOST = 1000000 };

double sine_of(double x);

/* The cosine. */
double sine_of_complement(double x);

#endif
