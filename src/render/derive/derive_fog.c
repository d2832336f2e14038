/* Fog: where its factor comes from (a vertex shader that gives none has no fog of its own), and the
 * constants of its formula (spec/pixel/fog.h). */
#include "render/derive/derive_part.h"
#include "shader/program/program.h"

#include <math.h>

/* Table fog's distance is w where the projection makes w a distance, and depth where w stays 1 (Direct3D 9,
 * "Eye-Relative vs. Z-based Depth"). */
bool derive_fog_by_w(const struct state *state)
{
    const float(*m)[4] = state->transform[TRIPTYCH_TRANSFORM_PROJECTION];
    return m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1;
}

void derive_fog(const struct state *state, struct pixel_key *key)
{
    if (!GET(state, fogenable))
        return;
    const struct program *vertex = derive_vertex_program(state);
    key->fog = derive_table_fog(GET(state, fogtablemode));
    /* A vertex shader without fog gives the factor 0, which is linear fog without a table's formula. */
    if (key->fog == FOG_VARYING && vertex && !derive_shader_gives(vertex, USAGE_FOG))
        key->fog = FOG_LINEAR_Z;
    else if (key->fog == FOG_VARYING)
        key->varying[VARYING_fog] = INTERPOLATION_SMOOTH;
    else if (derive_fog_by_w(state))
        key->fog += FOG_LINEAR_W - FOG_LINEAR_Z;
}

/* Linear fog that starts where it ends: of a table, everything from there on is fog; of vertices, everything.
 */
static void fog_without_range(double end, bool table, float *scale, float *offset)
{
    *scale = table ? -0x1p64f : 0;
    *offset = table ? derive_narrow(end * 0x1p64) : 0;
}

void derive_fog_formula(const struct state *state, uint32_t mode, bool table, float *scale, float *offset)
{
    double start = (double)GET_FLOAT(state, fogstart), end = (double)GET_FLOAT(state, fogend),
           density = (double)GET_FLOAT(state, fogdensity);
    double log2_e = 1.4426950408889634;
    *scale = *offset = 0;
    switch ((enum triptych_fog)mode) {
    case TRIPTYCH_FOG_NONE: return;
    case TRIPTYCH_FOG_EXP: *scale = derive_narrow(-density * log2_e); return;
    case TRIPTYCH_FOG_EXP2: *scale = derive_narrow(density * sqrt(log2_e)); return;
    case TRIPTYCH_FOG_LINEAR:
        if (end == start) {
            fog_without_range(end, table, scale, offset);
            return;
        }
        *scale = derive_narrow(-1 / (end - start));
        *offset = derive_narrow(end / (end - start));
        return;
    }
}
