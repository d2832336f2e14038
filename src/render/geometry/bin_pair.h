/* Pairs of triangles that are one rectangle along the axes, such as a letter or a page's rectangle.
 *
 * The triangles share their longest edge, so each centre in their bounds is in exactly one of them
 * (render/raster/raster.h). If every pixel gets the same result from either record, the pair can be drawn as
 * one: a head with HEAD_RECTANGLE, whose first corners are the lowest and the highest position. It has no
 * edges, needs no coverage inside, has no blocks twice, and can cover a tile that neither triangle covers.
 *
 * That is so if the records have the same words after the head, and no planes but these:
 *
 *   depth                 one number in both, with steps of 0
 *   1/w                   1 in both, with steps of 0
 *   texture coordinates   that only choose texels (derive_lookups), with the positions below
 *
 * A texel depends on a coordinate's position, round(u * size) with size = 256 * the texture's size
 * (spec/texture/address.h). So both planes may differ, as long as all positions in the rectangle are the
 * same. The class of pairs has texels in step with pixels: size * u is near an integer at the first centre,
 * and grows by almost an integer from centre to centre. Letters and images that are drawn texel by texel, or
 * magnified by a divisor of 256, are in it, though their planes have rounded steps and origins at different
 * corners.
 *
 * Let n(x, y) = n0 + (x - x0) nx + (y - y0) ny be integers for the centres of the rectangle, and p(x, y) be
 * size times a plane's exact value. The test evaluates p at the four outermost centres in binary32, for both
 * planes, and compares with the same n. p - n is affine, so it is largest at one of these. All |n| are at
 * most 2^18 * 7/4 and steps at most 2^12. So all numbers are below M = 2^19 in magnitude, also at the origin,
 * which is a corner of the rectangle, less than a pixel from a centre. Products of a step and a distance are
 * below 2 M. With u = 2^-24, a position before it is rounded differs from n by the sum of these, at most:
 *
 *   1/8        what the test allows
 *   7 u M      rounding in the test: two products, two sums, the factor `size`
 *   3 u M      rounding in the pixel routine: two fused multiply-adds, the factor; w is 1 exactly
 *   2/64       steps that the joined record has as 0: PAIR_RESIDUE along each axis
 *
 * u M is 1/32, so the sum is 0.47 and less than 1/2: every position is n(x, y), in each of the planes.
 * Denormals that become 0 are far below all of these terms.
 *
 * Scaled images and shadows have other steps. Their positions are compared one by one, as the pixel routine
 * computes them (agree_everywhere), if each of the joined record's coordinates grows along one axis only.
 * Such a record has one position for each column or row. A half has a step across of an error of rounding,
 * at most. Fused multiply-adds and roundings are monotone, so its positions in a column are between those in
 * the first and the last row. If both are the joined record's, all are. Words of PAIR_LEAST to PAIR_MOST make
 * no denormal, which routines would flush.
 *
 * Tiles whose triangles of a draw are all joined, with flat diffuse colours from 0 to 1, are drawn by a
 * reading of the pixel routine that relies on it: the key's field `joined`. It has the literal 1 for 1/w, and
 * colours need fewer limits.
 *
 * A step of the joined record that adds less than PAIR_RESIDUE over the whole rectangle becomes 0, so that
 * rounding does not exclude it from the class of the span reading (render/geometry/span.h). */
#ifndef RENDER_GEOMETRY_BIN_PAIR_H
#define RENDER_GEOMETRY_BIN_PAIR_H

#include "contract/layout.h"
#include "render/draw/command.h"

#include <stdbool.h>

/* In 1/256 texel. */
#define PAIR_STRAY   0x1p-3f
#define PAIR_RESIDUE 0x1p-6f
#define PAIR_REACH   (0x1p18f * 1.75f)
#define PAIR_STEP    0x1p12f

/* Of positions that are compared one by one: the words of their planes, and the most in a row or a column. */
#define PAIR_LEAST 0x1p-60f
#define PAIR_MOST  0x1p60f
enum { PAIR_WALK = 1 << 13 };

/* The form of records of these keys. `samplers` is as derive_lookups() gives it, and `precision` the pixel
 * key's. */
struct pair_form bin_pair_form(const struct setup_key *setup, enum precision precision,
                               const uint16_t samplers[TEXTURE_STAGES]);

/* Makes the first of two visible records a rectangle, if both are its halves and draw the same. Returns true
 * if so: the second is not needed then. */
bool bin_pair_join(uint8_t *first, const uint8_t *second, const struct pair_form *form,
                   const struct job *job);

/* Returns true if a rectangle's flat diffuse colour has only components that are 0, or normal numbers up to
 * 1. */
bool bin_pair_has_unit_color(const uint8_t *record, const struct pair_form *form);

#endif
