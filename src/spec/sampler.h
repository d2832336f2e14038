/* Samplers: what a key says of one, and where the job describes its texture. Stages of the fixed functions,
 * a pixel shader's s0 to s15 and a vertex shader's s0 to s3 are all sampled alike by what follows. */

struct sampler_key {
    int kind, texel;         /* enum texture_kind, enum texel */
    int filter, minify, mip; /* enum filter, enum minify, enum mip */
    int anisotropy;          /* largest number of taps */
    int address[3];          /* enum address_mode of u, v and w */
    int job;                 /* its struct texture_job: bytes from the job's start */
};

#define TEXTURE_FIELD(job, field) ((job) + (int)offsetof(struct texture_job, field))

static inline int sampler_job(int sampler)
{
    return (int)(offsetof(struct job, texture) + (size_t)sampler * sizeof(struct texture_job));
}

/* Sampler i, 0 to 15: texture stage i's, or a pixel shader's s#. */
static inline struct sampler_key pixel_sampler(const struct pixel_key *k, int i)
{
    return (struct sampler_key){
        .kind = k->texture[i],
        .texel = k->texel[i],
        .filter = k->filter[i],
        .minify = k->minify[i],
        .mip = k->mip[i],
        .anisotropy = k->anisotropy[i],
        .address = {k->address_u[i], k->address_v[i], k->address_w[i]},
        .job = sampler_job(i),
    };
}
