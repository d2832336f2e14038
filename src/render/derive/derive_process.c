/* The vertex routine of triptych_process_vertices: it computes everything that any pixel routine could read.
 */
#include "contract/key_query.h"
#include "render/derive/derive_part.h"
#include "shader/program/program.h"

/* The key of a pixel routine whose stage i reads the coordinates of channel i, and that reads the fog. */
static void read_all_stages(struct pixel_key *pixel)
{
    memset(pixel, 0, sizeof *pixel);
    pixel->stages = TEXTURE_STAGES;
    pixel->fog = FOG_VARYING;
    for (int i = 0; i < TEXTURE_STAGES; i++) {
        pixel->texture[i] = TEXTURE_2D;
        pixel->coordinates[i] = (uint8_t)i;
    }
}

static bool gives_fog(const struct state *state)
{
    const struct program *program = derive_vertex_program(state);
    return GET(state, fogenable) && (!program || derive_shader_gives(program, USAGE_FOG));
}

/* Records of points: what they read is their vertex' own. */
static void read_all_varyings(const struct state *state, struct setup_key *setup)
{
    memset(setup, 0, sizeof *setup);
    setup->primitive = PRIMITIVE_POINT;
    setup->point_size = derive_point_size(state, PRIMITIVE_POINT) != POINT_SIZE_CONSTANT;
    memset(setup->varying, INTERPOLATION_FLAT, sizeof setup->varying);
    setup->varying[VARYING_blending] = INTERPOLATION_NONE;
    if (!gives_fog(state))
        setup->varying[VARYING_fog] = INTERPOLATION_NONE;
}

void derive_process_key(const struct state *state, struct vertex_key *key)
{
    struct pixel_key pixel;
    struct setup_key setup;
    read_all_stages(&pixel);
    read_all_varyings(state, &setup);
    memset(key, 0, sizeof *key);
    derive_vertex(state, &pixel, &setup, key);
    key->clip_planes = 0; /* clip codes are not read */
}

void derive_process_job(const struct state *state, const struct vertex_key *key, struct job *job)
{
    const unsigned pixels = PARTS(TEXTURES) | PARTS(STAGES) | PARTS(DEPTH) | PARTS(REFERENCES);
    struct pixel_key pixel, none = {0};
    read_all_stages(&pixel);
    memset(job, 0, sizeof *job);
    derive_job_parts(state, key, &pixel, PARTS_OF_JOB & ~pixels, job);
    derive_job_parts(state, key, &none, PARTS(TEXTURES) | PARTS(REFERENCES), job);
    job->srgb = &srgb_tables;
}
