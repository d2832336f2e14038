#include "clipping.h"

#include "machine/mxcsr.h"

#include <math.h>
#include <string.h>

_Alignas(64) float clipping_batch[SLOT_COUNT * CLIPPING_LANES];

struct job clipping_job;

int clipping_user_planes;

static uint64_t clipping_state;

static unsigned clipping_saved;

void clipping_begin(void)
{
    clipping_state = CLIPPING_SEED;
    clipping_saved = mxcsr_enter();
    memset(clipping_batch, 0xff, sizeof clipping_batch); /* so that no lane is correct by chance */
    clipping_job.guard_left = -16.0f;
    clipping_job.guard_right = 15.0f;
    clipping_job.guard_bottom = -12.5f;
    clipping_job.guard_top = 13.5f;
    memset(clipping_job.clip_plane, 0, sizeof clipping_job.clip_plane);
    clipping_user_planes = 0;
}

void clipping_end(void)
{
    mxcsr_leave(clipping_saved);
}

uint32_t clipping_draw(void) /* xorshift64* */
{
    clipping_state ^= clipping_state >> 12;
    clipping_state ^= clipping_state << 25;
    clipping_state ^= clipping_state >> 27;
    return (uint32_t)(clipping_state * 0x2545F4914F6CDD1DULL >> 32);
}

float clipping_uniform(float low, float high)
{
    return low + (high - low) * (float)(clipping_draw() >> 8) * 0x1p-24f;
}

float *clipping_word(int slot, uint32_t lane)
{
    return &clipping_batch[slot * CLIPPING_LANES + (int)lane];
}

uint32_t clipping_code_of(float x, float y, float z, float w)
{
    uint32_t code = 0;
    code |= -w <= x ? 0 : CLIP_LEFT;
    code |= x <= w ? 0 : CLIP_RIGHT;
    code |= -w <= y ? 0 : CLIP_BOTTOM;
    code |= y <= w ? 0 : CLIP_TOP;
    code |= 0 <= z ? 0 : CLIP_NEAR;
    code |= z <= w ? 0 : CLIP_FAR;
    code |= CLIP_EYE_W <= w ? 0 : CLIP_EYE;
    code |= clipping_job.guard_left * w <= x ? 0 : CLIP_GUARD_LEFT;
    code |= x <= clipping_job.guard_right * w ? 0 : CLIP_GUARD_RIGHT;
    code |= clipping_job.guard_bottom * w <= y ? 0 : CLIP_GUARD_BOTTOM;
    code |= y <= clipping_job.guard_top * w ? 0 : CLIP_GUARD_TOP;
    for (int i = 0; i < clipping_user_planes; i++) {
        const float *p = clipping_job.clip_plane[i];
        code |= fmaf(x, p[0], fmaf(y, p[1], fmaf(z, p[2], w * p[3]))) >= 0 ? 0 : CLIP_USER << i;
    }
    return code;
}

uint32_t clipping_code(uint32_t lane)
{
    return clipping_code_of(*clipping_word(SLOT_X, lane), *clipping_word(SLOT_Y, lane),
                            *clipping_word(SLOT_Z, lane), *clipping_word(SLOT_W, lane));
}

void clipping_put(uint32_t lane, float x, float y, float z, float w)
{
    *clipping_word(SLOT_X, lane) = x;
    *clipping_word(SLOT_Y, lane) = y;
    *clipping_word(SLOT_Z, lane) = z;
    *clipping_word(SLOT_W, lane) = w;
    uint32_t code = clipping_code(lane);
    memcpy(clipping_word(SLOT_CODE, lane), &code, sizeof code);
    for (int s = SLOT_CODE + 1; s < SLOT_COUNT; s++)
        *clipping_word(s, lane) = clipping_uniform(-2, 2);
}

float clipping_power(int low, int high)
{
    return ldexpf(clipping_uniform(-1, 1), low + (int)(clipping_draw() % (uint32_t)(high - low + 1)));
}

void clipping_put_random(uint32_t lane, enum clipping_spread spread)
{
    static const float on[] = {0, 1, -1, 2, 15, -16, 13.5f, -12.5f, CLIP_EYE_W, 0.5f};
    switch (spread) {
    case CLIPPING_MODERATE:
        clipping_put(lane, clipping_uniform(-3, 3), clipping_uniform(-3, 3), clipping_uniform(-1, 3),
                     clipping_uniform(-1, 3));
        break;
    case CLIPPING_WIDE:
        clipping_put(lane, clipping_uniform(-90, 90), clipping_uniform(-90, 90), clipping_uniform(-2, 6),
                     clipping_uniform(-1, 5));
        break;
    case CLIPPING_EXTREME:
        clipping_put(lane, clipping_power(-60, 120), clipping_power(-60, 120), clipping_power(-60, 120),
                     clipping_power(-60, 120));
        break;
    case CLIPPING_DEEP:
        clipping_put(lane, clipping_uniform(-1, 1), clipping_uniform(-1, 1), clipping_power(-30, 60),
                     clipping_uniform(-1, 5));
        break;
    default:
        clipping_put(lane, on[clipping_draw() % 10], on[clipping_draw() % 10], on[clipping_draw() % 10],
                     on[clipping_draw() % 10]);
        break;
    }
}

const uint8_t clipping_smooth[VARYING_COUNT] = {[0 ... VARYING_COUNT - 1] = INTERPOLATION_SMOOTH};

struct clipper clipping_clipper(void)
{
    struct clipper clipper =
        clipper_create(&clipping_job, clipping_smooth, clipping_batch, CLIPPING_FIRST_FREE);
    clipper.smooth |= 1ull << SLOT_POINT_SIZE;
    return clipper;
}

void clipping_set_user_planes(int count)
{
    clipping_user_planes = count;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 4; c++)
            clipping_job.clip_plane[i][c] = clipping_uniform(c < 3 ? -1 : 0, 1);
}
