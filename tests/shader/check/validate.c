/* The validator accepts shaders that follow the rules of their models. It refuses others with the position of
 * the broken rule. */
#include "tests/shader/check/reason.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

#define END_2 "mov oPos, r0\n"

static const char *const good[] = {
    "vs_1_1\ndcl_position v0\ndcl_color v5\nm4x4 oPos, v0, c0\nmov oD0, v5\nmov oFog.x, c4.x\n",
    "vs_1_1\ndcl_position v0\ndcl_blendindices v1\ndef c95, 3, 0, 0, 1\nmul r0, v1, c95.x\nmov a0.x, r0.y\n"
    "m4x3 r1.xyz, v0, c[a0.x + 10]\nmov r1.w, c95.w\nm4x4 oPos, r1, c0\nexpp r2.y, r1.x\nmov oT0.xy, r2.y\n",
    "vs_1_1\ndcl_position v0\nfrc r0.xy, v0\nlit r1, v0\ndst r2, v0, r1\nmad oPos, r1, v0, r2\n",
    "vs_2_0\ndcl_position v0\ndefi i0, 4, 0, 1, 0\ndefb b0, true\nmov r0, v0\nif b0\nloop aL, i0\n"
    "mad r0, c[aL], v0.x, r0\nendloop\nelse\nrep i0\nadd r0, r0, v0\nendrep\nendif\ncall l0\n" END_2
    "ret\nlabel l0\nadd r0, r0, v0\nret\n",
    "vs_2_0\ndcl_position v0\nmova a0, v0\nsincos r0.xy, v0.x, c0, c1\nmov r0.zw, c2[a0.w]\nnrm r1, r0\n"
    "crs r2.xyz, r1, r0\npow r2.w, r1.x, r0.y\nsgn r0, r2, r3, r4\nlrp r5, r0, r1, r2\n" END_2,
    "vs_2_x\ndcl_position v0\nsetp_gt p0, v0, c0\nmov r0, v0\n(p0) add r0, r0, v0\n(!p0.x) mul r0.xy, r0, "
    "v0\n"
    "if p0.x\nif_lt r0.x, c0.y\nmov r31, r0\nendif\nendif\nrep i0\nbreak_ge r0.x, r0.y\nbreakp "
    "p0.w\nbreak\nendrep\n"
    "callnz l1, !p0.z\n" END_2 "ret\nlabel l1\nret\n",
    "vs_2_sw\ndcl_position v0\nmad r0, c0, c8191, c5000\nadd r0, r0, v0\n" END_2,
    "vs_3_0\ndcl_position v0\ndcl_texcoord v3\ndcl_2d s0\ndcl_position o0\ndcl_texcoord o1.xy\ndcl_fog o1.z\n"
    "texldl r0, v3, s0\nadd_sat o0, r0, -v0_abs\nmov o1.xy, r0\nmov o1.z, v0.x\n",
    "vs_3_0\ndcl_position o4\ndcl_position v0\ndcl_color o5\nloop aL, i0\nmov o[aL + 4], v[aL]\nendloop\n",
    "ps_1_1\ntex t0\ntex t1\nmul_x2_sat r0.xyz, t0, v0\n+mov r0.w, t1\n",
    "ps_1_1\ntex t0\ntexm3x3pad t1, t0_bx2\ntexm3x3pad t2, t0_bx2\ntexm3x3vspec t3, t0_bx2\ndp3_sat r0, "
    "t3_bx2, c0\n",
    "ps_1_3\ntexcoord t0\ntexkill t1\ntexm3x2pad t2, t0\ntexm3x2depth t3, t0\nmov r0, 1-t0\ncnd r0, r0.w, "
    "t0, v0\n",
    "ps_1_2\ndef c0, 1, 1, 1, 1\ntex t0\ntexdp3 t1, t0\nadd r0.xyz, t0.w, c0\ndp4 r0.w, t0, c0.w\n",
    "ps_1_4\ntexld r0, t0\ntexcrd r1.xyz, t1\nadd r0.xy, r0, r1\nmov r0.z, c0.x\nphase\ntexld r2, r0_dz\nmov "
    "r0, r2\n",
    "ps_1_4\ntexld r0, t0.xyw\ntexcrd r1.xy, t0_dw.xyw\nmov r0, r0_x2\n",
    "ps_1_4\ntexld r0, t0\ntexld r1, t1\nbem r1.xy, r1, r0\nmov r1.z, r0\nphase\ntexld r1, r1\nmul_d8 r0, "
    "r1, v0\n",
    "ps_2_0\ndcl t0.xy\ndcl v0\ndcl_2d s0\ntexld_pp r0, t0, s0\nmul r0, r0, v0.wzyx\nmov oC0, r0\nmov oC1, "
    "r0\n"
    "mov oDepth, r0.x\n",
    "ps_2_0\ndcl t0\ndcl_2d s0\ntexld r0, t0, s0\ntexld r0, r0, s0\ntexld r0, r0, s0\ntexld r0, r0, s0\nmov "
    "oC0, r0\n",
    "ps_2_a\ndcl t0\ndcl_2d s0\ndsx r1, t0\ntexldd r0, t0.yxzw, s0, r1, r1\nsetp_eq p0, r0, r1\n(p0) mov r0, "
    "r1.xxyz\n"
    "mov oC0, r0\n",
    "ps_2_b\ndcl t0\ndcl_2d s0\ntexld r31, t0, s0\nmov oC0, r31\n",
    "ps_2_x\ndcl v0\nif_gt v0.x, c0.x\nmov r0, v0\nelse\nmov r0, c0\nendif\nmov oC0, r0\n",
    "ps_3_0\ndcl_texcoord v0.xy\ndcl_color v1\ndcl vPos.xy\ndcl vFace\ndcl_cube s3\ntexld r0, v0.xyxy, s3\n"
    "cmp r0, vFace, r0, vPos.xyxy\nloop aL, i0\nadd r0, r0, v[aL]\nendloop\nif_ne r0.x, r0.y\ntexld r1, v0, "
    "s3\n"
    "texldl r1, r0, s3\nendif\nadd_sat oC0, r0, r1\nmul oC3.x, r0, r1\nmov oDepth, r0.x\n",
    /* as compilers write them: skinning and fog, normal mapping with reflection */
    "vs_2_0\ndef c40, 765.005859, 0, 1, -0.5\ndcl_position v0\ndcl_blendweight v1\ndcl_blendindices v2\n"
    "dcl_normal v3\ndcl_texcoord v4\nmul r0, v2.zyxw, c40.x\nmova a0, r0\nmul r1, v1.x, c10[a0.z]\n"
    "mad r1, c10[a0.y], v1.y, r1\ndp4 r2.x, v0, r1\ndp4 r2.y, v0, c11\ndp4 r2.z, v0, c12\n"
    "mov r2.w, c40.z\ndp4 oPos.x, r2, c0\ndp4 oPos.y, r2, c1\ndp4 oPos.z, r2, c2\ndp4 r3.w, r2, c3\n"
    "mov oPos.w, r3.w\nmov oFog, r3.w\ndp3 r4.x, v3, v3\nrsq r4.x, r4.x\nmul r4.xyz, v3, r4.x\n"
    "dp3 r4.w, r4, c20\nmax r4.w, r4.w, c40.y\nmin oD0, r4.w, c40.z\nmad oT0.xy, v4, c21.xy, c21.zw\n",
    "ps_2_0\ndef c8, 2, -1, 0.0625, 0\ndcl t0.xy\ndcl t1.xyz\ndcl t2.xyz\ndcl_2d s0\ndcl_2d s1\n"
    "dcl_cube s2\ntexld r0, t0, s0\ntexld_pp r1, t0, s1\nmad_pp r1.xyz, r1, c8.x, c8.y\n"
    "nrm_pp r2.xyz, t1\ndp3_sat_pp r2.w, r2, r1\nadd r3.xyz, r2, r2\ndp3 r3.w, r1, t2\n"
    "mad r3.xyz, r1, r3.w, -t2\ntexld r3, r3, s2\nlog r4.w, r2.w\nmul r4.w, r4.w, c0.w\n"
    "exp_sat r4.w, r4.w\nmul r0.xyz, r0, r2.w\nmad r0.xyz, r4.w, c1, r0\ncmp r0.w, -r2.w, c8.w, c8.z\n"
    "mov_pp oC0, r0\n",
    "ps_3_sw\ndef c8000, 1, 2, 3, 4\nmad oC0, c8000, c0, c1\n",
    "ps_3_0\nmov oDepth, c0.x\n",
};

static void shaders_that_follow_the_rules_are_accepted(void)
{
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", reason_of(good[i]), good[i]);
}

/* The text around the statements. It is valid, and only the statement in it breaks a rule. */
static const char vs1[] = "vs_1_1\ndcl_position v0\nmov oPos, v0\n%s\n";
static const char vs2[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\n%s\n";
static const char vsx[] = "vs_2_x\ndcl_position v0\nmov oPos, v0\n%s\n";
static const char vs3[] = "vs_3_0\ndcl_position o0\ndcl_position v0\nmov o0, v0\n%s\n";
static const char ps1[] = "ps_1_1\ntex t0\nmov r0, t0\n%s\n";
static const char ps3[] = "ps_1_3\n%s\nmov r0, t0\n";
static const char ps4[] = "ps_1_4\ntexld r0, t0\nmov r1, r0\nphase\n%s\nmov r0, c0\n";
static const char ps20[] = "ps_2_0\ndcl t0\ndcl_2d s0\nmov r0, t0\n%s\nmov oC0, r0\n";
static const char psx[] = "ps_2_x\ndcl t0\ndcl_2d s0\nmov r0, t0\n%s\nmov oC0, r0\n";
static const char ps30[] = "ps_3_0\ndcl_texcoord v0\ndcl_2d s0\nmov r0, v0\n%s\nmov oC0, r0\n";
static const char bare[] = "%s";

static const struct {
    const char *frame, *text, *reason;
} bad[] = {
    /* rules that none of the groups below has */
    {bare, "ps_1_4\ntexcrd r0.xyz, t0\nphase\ntexld r1, r0_dz\ntexld r2, r0_dz\ntexld r3, r0_dz\nmov r0, r1",
     "t:6:11: found the modifier '_dz' a third time, expected at most two"},
    {ps1, "mov r0.xyz, t0\n+nop", "t:5:1: found + before nop, expected arithmetic that pairs"},
    {ps20, "mov oDepth, r0.x\nmov oDepth, r0.x", "t:6:5: found oDepth written again, expected it once"},
    {ps20, "mov oDepth.x, r0.x", "t:5:5: found a mask of oDepth, expected none"},
    {vs3, "mov o[aL], v0", "t:5:5: found aL outside a loop, expected it between loop and endloop"},
    {bare, "vs_3_0\ndcl_position o[a0.x]\nmov o0, c0",
     "t:2:14: found a relative index, expected none of dcl"},
    /* registers */
    {vs1, "mov r12, v0", "t:4:5: found r12, expected r0 to r11"},
    {vs1, "mov r0, c256", "t:4:9: found c256, expected c0 to c255"},
    {vs1, "mov r0, v1", "t:4:9: found v1, expected a dcl of it before"},
    {vs1, "mov r0, v16", "t:4:9: found v16, expected v0 to v15"},
    {vs1, "mov oT8, v0", "t:4:5: found oT8, expected oT0 to oT7"},
    {vs1, "mov oD2, v0", "t:4:5: found oD2, expected oD0 to oD1"},
    {vs1, "mov r0, oPos", "t:4:9: found oPos, expected a register that can be read"},
    {vs1, "mov c0, v0", "t:4:5: found c as the destination of mov, expected a register that can be written"},
    {vs1, "mov v0, v0", "t:4:5: found v as the destination of mov"},
    {vs1, "mov r0, a0", "t:4:9: found a, expected a register that can be read"},
    {vs1, "mov a0.y, v0", "t:4:5: found another component of a0, expected a0.x"},
    {vs1, "add a0.x, v0, v0", "t:4:5: found a as the destination of add"},
    {vs1, "m4x4 r0, v0, c253", "t:4:14: found c256 as the last row of the matrix, expected at most c255"},
    {vs1, "m4x4 r0, v0, v0", "t:4:14: found v, expected c or r"},
    {vs2, "mov a0.x, v0", "t:4:5: found a as the destination of mov"},
    {vs2, "mova r0, v0", "t:4:6: found r as the destination of mova, expected a"},
    {vs2, "mov r0, i0", "t:4:9: found i, expected a register that can be read"},
    {vs2, "rep c0\nendrep", "t:4:5: found c, expected i"},
    {vs2, "loop i0, i0\nendloop", "t:4:6: found i, expected aL"},
    {vs2, "if r0\nendif", "t:4:4: found r, expected b or p0"},
    {vs2, "call r0", "t:4:6: found r, expected l"},
    {vs2, "rep i16\nendrep", "t:4:5: found i16, expected i0 to i15"},
    {vs2, "sincos r0.xy, v0.x, v0, c1", "t:4:21: found v, expected c"},
    {vsx, "setp_gt r0, v0, v0", "t:4:9: found r as the destination of setp, expected p"},
    {vs3, "mov o1, v0", "t:5:5: found o1 with components that no dcl declares"},
    {vs3, "texldl r0, v0, s0", "t:5:16: found s0, expected a dcl of it before"},
    {ps1, "mov r2, t0", "t:4:5: found r2, expected r0 to r1"},
    {ps1, "mov v0, t0", "t:4:5: found v as the destination of mov"},
    {ps1, "mov r0, c8", "t:4:9: found c8, expected c0 to c7"},
    {ps4, "mov r2, t0", "t:5:9: found t, expected a register that can be read"},
    {ps4, "mov t0, c0", "t:5:5: found t as the destination of mov"},
    {ps20, "texld r0, v0, s0", "t:5:11: found v, expected t or r"},
    {ps20, "texld r0, t0, t0", "t:5:15: found t, expected s"},
    {ps20, "texld r0, t0, s1", "t:5:15: found s1, expected a dcl of it before"},
    {ps20, "texld r0, t1, s0", "t:5:11: found t1, expected a dcl of it before"},
    {ps20, "mov oC4, r0", "t:5:5: found oC4, expected oC0 to oC3"},
    {ps20, "mov r0, v0", "t:5:9: found v0, expected a dcl of it before"},
    {"ps_2_a\n%s\nmov oC0, r0\n", "mov r22, c0", "t:2:5: found r22, expected r0 to r21"},
    {"ps_3_0\ndcl_position v0\nmov oC0, v0\n%s", "",
     "t:2:14: found v0, expected another usage than the position, or vPos"},
    {ps30, "mov r0, vPos", "t:5:9: found vPos, expected a dcl of it before"},
    {ps30, "texkill c0", "t:5:9: found c as the destination of texkill, expected r or v"},
    /* relative addressing */
    {vs1, "mov r0, c[a0.x]", "t:4:9: found a0.x, expected something to write it before it is read"},
    {vs2, "mov r0, c[aL]", "t:4:9: found aL outside a loop, expected it between loop and endloop"},
    {vs2, "mova a0.x, v0\nmov r0, c[a0.y]", "t:5:9: found a0.y, expected something to write it"},
    {vs2, "mova a0.x, v0\nmov r0, v[a0.x]", "t:5:9: found v with a relative index by a0, expected none"},
    {vs3, "mova a0.x, v0\nmov o[a0.x], v0", "t:6:5: found o with a relative index, expected none or o by aL"},
    {ps30, "loop aL, i0\nmov r0, c[aL]\nendloop",
     "t:6:9: found c with a relative index by aL, expected none"},
    /* never written */
    {vs1, "mov r1, r0", "t:4:9: found r0.x, expected something to write it before it is read"},
    {vs1, "mov r0.xy, v0\nadd r1, r0.xyxz, v0", "t:5:9: found r0.z, expected something to write it"},
    {vs1, "mov r0.xyz, v0\ndp4 r1, r0, v0", "t:5:9: found r0.w, expected something to write it"},
    {vs1, "mov r0.x, v0\nrcp r1, r0.y", "t:5:9: found r0.y, expected something to write it"},
    {vs1, "m3x2 r1.xy, v0, r2", "t:4:17: found r2.x, expected something to write it"},
    {vsx, "(p0) mov r0, v0", "t:4:2: found p0.x, expected something to write it before it is read"},
    {vsx, "setp_gt p0.x, v0, v0\nif p0.y\nendif", "t:5:4: found p0.y, expected something to write it"},
    {ps1, "mov r0, t1", "t:4:9: found t1.x, expected something to write it before it is read"},
    {ps20, "texkill r1", "t:5:9: found r1.xyzw, expected something to write it before it is read"},
    {ps4, "mov r0.w, r1.w", "t:5:11: found r1.w, expected something to write it before it is read"},
    /* ports */
    {vs1, "add r0, c0, c1",
     "t:4:13: found 2 different registers of c, expected at most 1 in one instruction"},
    {"vs_1_1\ndcl_position v0\ndcl_color v1\nmov oPos, v0\n%s\n", "mul r0, v0, v1",
     "t:5:13: found 2 different registers of v, expected at most 1"},
    {ps20, "mad r0, c0, c1, r0", "t:5:13: found 2 different registers of c, expected at most 1"},
    {ps1, "mad r0, c0, c1, c2", "t:4:17: found 3 different registers of c, expected at most 2"},
    {vs2, "mova a0.xy, v0\nadd r0, c[a0.x], c[a0.y]", "t:5:18: found 2 different registers of c"},
    /* masks */
    {vs1, "m4x3 r0, v0, c0", "t:4:6: found another mask, expected .xyz of m4x3"},
    {vs1, "m4x4 r0.xyz, v0, c0", "t:4:6: found another mask, expected no mask of m4x4"},
    {vs1, "m3x2 r0.x, v0, c0", "t:4:6: found another mask, expected .xy of m3x2"},
    {vs1, "frc r0, v0", "t:4:5: found another mask, expected .y or .xy of frc"},
    {vs2, "crs r0, v0, c0", "t:4:5: found another mask, expected a mask without w of crs"},
    {vs2, "nrm r0.xy, v0", "t:4:5: found another mask, expected .xyz or no mask of nrm"},
    {vs2, "sincos r0, v0.x, c0, c1", "t:4:8: found another mask, expected .x, .y or .xy of sincos"},
    {ps1, "mov r0.xy, t0", "t:4:5: found another mask, expected .xyz, .w or none in ps_1_1"},
    {ps3, "tex t0.xyz", "t:2:5: found another mask, expected no mask of tex"},
    {ps4, "texcrd r2, t0", "t:5:8: found another mask, expected .xy or .xyz of texcrd"},
    {ps20, "texld r0.xyz, t0, s0", "t:5:7: found another mask, expected no mask of texld"},
    {vs2, "crs r0.xyz, v0.yzxw, c0", "t:4:13: found a swizzle, expected none of crs"},
    /* the destination is not a source */
    {vs2, "mov r0, v0\ncrs r0.xyz, r0, v0",
     "t:5:13: found r0 as source and destination, expected another source"},
    {vs2, "mov r0, v0\nm4x4 r0, r0, c0", "t:5:10: found r0 as source and destination"},
    /* modifiers */
    {vs1, "mov_sat r0, v0", "t:4:9: found _sat, which mov does not have in vs_1_1"},
    {vs3, "frc_sat r0, v0", "t:5:9: found _sat, which frc does not have in vs_3_0"},
    {vs3, "mov_pp r0, v0", "t:5:8: found _pp, which mov does not have in vs_3_0"},
    {vs1, "mov_x2 r0, v0", "t:4:8: found a shift, which mov does not have in vs_1_1"},
    {ps1, "mov_x8 r0, t0", "t:4:8: found another shift, expected _x2, _x4 or _d2 in ps_1_1"},
    {ps3, "tex_sat t0", "t:2:9: found _sat, which tex does not have in ps_1_3"},
    {ps3, "tex_x2 t0", "t:2:8: found a shift, which tex does not have in ps_1_3"},
    {ps20, "texld_sat r0, t0, s0", "t:5:11: found _sat, which texld does not have in ps_2_0"},
    {ps20, "mov_centroid r0, t0", "t:5:14: found _centroid, expected it after a pixel shader's dcl"},
    {vs1, "m4x4 r0, v0, -c0", "t:4:15: found the modifier '-', expected none of that kind here"},
    {vs2, "mov r0, !v0", "t:4:10: found the modifier '!', expected none of that kind here"},
    {vs2, "if -b0\nendif", "t:4:5: found the modifier '-', expected none of that kind here"},
    {ps20, "texld r0, -t0, s0", "t:5:12: found the modifier '-', expected none of that kind here"},
    {ps4, "mov r0, r1_dz", "t:5:9: found the modifier '_dz', expected none of that kind here"},
    {vs3, "mad r0, c0_abs, v0, c0",
     "t:5:21: found c0 without _abs, expected all constants of an instruction alike"},
    /* swizzles */
    {vs1, "rcp r0, v0", "t:4:9: found several components, expected one, like v0.x"},
    {vs2, "pow r0, v0.x, v0.xy", "t:4:15: found several components, expected one"},
    {vs1, "m4x4 r0, v0, c0.x", "t:4:14: found a swizzle of c, expected none here"},
    {ps1, "mov r0, t0.x", "t:4:9: found a swizzle that ps_1_1 does not have, expected .w, or .z"},
    {ps1, "mov r0, t0.z", "t:4:9: found a swizzle that ps_1_1 does not have"},
    {ps4, "mov r0, r1.yxz", "t:5:9: found a swizzle that ps_1_4 does not have, expected one component"},
    {ps4, "texld r2, t0.xyy", "t:5:11: found another swizzle, expected .xyz or .xyw"},
    {ps20, "mov r0, t0.yxzw",
     "t:5:9: found a swizzle that ps_2_0 does not have, expected one component, .yzxw"},
    {ps20, "texld r0, t0.yzxw, s0", "t:5:11: found a swizzle of t, expected none here"},
    {psx, "setp_gt p0, r0, r0\nif p0\nendif",
     "t:6:4: found several components of p0, expected one, like p0.x"},
    {psx, "setp_gt p0, r0, r0\n(p0.yx) mov r0, t0",
     "t:6:2: found a swizzle of p0, expected none or one component"},
    /* predication */
    {"ps_2_b\ndcl t0\nmov r0, t0\n%s\nmov oC0, r0\n", "(p0) mov r0, t0",
     "t:4:2: found a predicate, which ps_2_b does not have"},
    {"ps_2_b\ndcl t0\nmov r0, t0\n%s\nmov oC0, r0\n", "setp_gt p0, r0, r0",
     "t:4:1: found setp, which ps_2_b does not have"},
    {psx, "setp_gt p0, r0, r0\n(p0) if b0\nendif", "t:6:2: found a predicate at if, expected none"},
    {psx, "setp_gt p0, r0, r0\n(p0) texkill r0", "t:6:2: found a predicate at texkill, expected none"},
    {psx, "setp_gt p0, r0, r0\n(-p0) mov r0, t0", "t:6:3: found another modifier of a predicate, expected !"},
    /* declarations and definitions */
    {vs1, "dcl_normal v1", "t:4:1: found dcl after instructions that execute, expected it before them"},
    {vs1, "def c0, 1, 2, 3, 4", "t:4:1: found def after instructions that execute"},
    {bare, "vs_1_1\ndcl_position v0\ndcl_position v1\n", "t:3:14: found v1, expected another usage than one"},
    {bare, "vs_1_1\ndcl_position v0\ndcl_normal v0\n",
     "t:3:12: found v0, expected a register that is not declared"},
    {bare, "vs_1_1\ndcl_position v16\n", "t:2:14: found v16, expected a register that the model has"},
    {bare, "vs_1_1\ndcl_position r0\n", "t:2:14: found r0, expected an input, an output or a sampler"},
    {bare, "ps_2_0\ndcl r0\n", "t:2:5: found r0, expected an input, an output or a sampler"},
    {bare, "ps_2_0\ndcl_2d s0\ndcl_cube s0\n",
     "t:3:10: found s0, expected a sampler that is not declared already"},
    {bare, "ps_2_0\ndcl_2d s0.x\n", "t:2:8: found a mask of a sampler, expected none"},
    {bare, "vs_3_0\ndcl_position o0.xyz\n", "t:2:14: found a mask of the position, expected none"},
    {bare, "vs_3_0\ndcl_color o0\ndcl_color o1\n", "t:3:11: found o1, expected another usage than one"},
    {bare, "ps_3_0\ndcl vFace\ndcl vFace\n",
     "t:3:5: found vFace, expected a register that is not declared already"},
    {bare, "ps_1_1\ndef c0, 1, 2, 3, 4\ndef c0, 1, 2, 3, 4\n",
     "t:3:5: found c0 defined again, expected it once"},
    {bare, "ps_1_1\ndef c8, 1, 2, 3, 4\n", "t:2:5: found c8, expected c0 to c7"},
    {bare, "ps_1_1\ndef c0.x, 1, 2, 3, 4\n", "t:2:5: found a mask or a relative index"},
    {vs3, "dcl_2d_pp s0", "t:5:1: found dcl after"},
    {bare, "vs_3_0\ndcl_2d_pp s0", "t:2:11: found _pp, which dcl does not have in vs_3_0"},
    /* flow control */
    {vs2, "if b0", "t:4:1: found if without its end, expected endif"},
    {vs2, "loop aL, i0\nif b0\nendloop\nendif",
     "t:6:1: found endloop, expected loop before it in the same block"},
    {vs2, "rep i0\nendloop", "t:5:1: found endloop, expected loop before it"},
    {vs2, "rep i0", "t:4:1: found rep without its end, expected endrep"},
    {vs2, "else", "t:4:1: found else, expected if before it"},
    {vs2, "endif", "t:4:1: found endif, expected if before it"},
    {vs2, "if b0\nelse\nelse\nendif", "t:6:1: found another else, expected endif"},
    {vs2, "rep i0\nrep i0\nendrep\nendrep", "t:5:1: found loops 2 deep, expected at most 1 in vs_2_0"},
    {vsx, "break", "t:4:1: found break outside a loop, expected it inside loop or rep"},
    {vsx, "if_gt v0.x, v0.y\nbreak_gt v0.x, v0.y\nendif", "t:5:1: found break outside a loop"},
    {vs2, "call l0", "t:4:6: found a call of l0, expected a label l0"},
    {vs2, "call l16", "t:4:6: found l16, expected l0 to l15"},
    {vs2, "call l0\nret\nlabel l0\ncall l0\nret",
     "t:7:6: found a call of l0 after its label, expected calls forward"},
    {vs2, "call l0\nret\nlabel l0\ncall l1\nret\nlabel l1\nret",
     "t:4:6: found calls 2 deep, expected at most 1 in vs_2_0"},
    {vs2, "label l0\nret", "t:4:1: found a label, expected ret before it"},
    {vs2, "ret\nlabel l0\nret\nlabel l0\nret", "t:7:7: found another label l0, expected each once"},
    {vs2, "ret\nmov r0, v0", "t:5:1: found mov after ret, expected a label"},
    {vs2, "ret\nlabel l0\nmov r0, v0", "t:6:1: found the end of the shader in a subroutine, expected ret"},
    {vs2, "if b0\nret\nendif", "t:5:1: found ret inside a block, expected the block's end before it"},
    {"vs_2_0\ndefi i0, 256, 0, 1, 0\n%s\n", "rep i0\nendrep",
     "t:3:5: found a loop of 256 times, expected 0 to 255"},
    {"vs_2_0\ndefi i0, 4, -1, 1, 0\n%s\n", "loop aL, i0\nendloop",
     "t:3:10: found a loop from -1, expected 0 to 255"},
    {"vs_2_0\ndefi i0, 4, 0, 128, 0\n%s\n", "loop aL, i0\nendloop", "t:3:10: found a loop by steps of 128"},
    {"ps_2_a\n%s\nmov oC0, r0\n", "if b0\nendif", "t:2:1: found if, which ps_2_a does not have"},
    {"ps_2_b\n%s\nmov oC0, r0\n", "dsx r0, c0", "t:2:1: found dsx, which ps_2_b does not have"},
    /* gradients */
    {ps30, "if_gt r0.x, r0.y\ntexld r1, r0, s0\nendif",
     "t:6:11: found texld of r0 where neighbouring pixels may not be"},
    {ps30, "if_gt r0.x, r0.y\ndsx r1, r0\nendif",
     "t:6:9: found dsx of r0 where neighbouring pixels may not be"},
    {ps30, "rep i0\ntexld r1, r0, s0\nbreak_gt r0.x, r0.y\nendrep", "t:6:11: found texld of r0 where"},
    {ps30, "rep i0\ntexld r1, r0, s0\nif_gt r0.x, r0.y\nbreak\nendif\nendrep",
     "t:6:11: found texld of r0 where"},
    {ps30, "setp_gt p0, r0, r0\n(p0) texld r1, r0, s0", "t:6:16: found texld of r0 where"},
    {"ps_3_0\ndcl_texcoord v0\ndcl_2d s0\nmov r0, v0\n%s\n",
     "mov oC0, r0\nif_gt r0.x, r0.y\ncall l0\nendif\nret\nlabel l0\ntexld r1, r0, s0\nret",
     "t:11:11: found texld of r0 where"},
    {ps30, "if_gt r0.x, r0.y\nmov oC1, r0\nendif", "t:6:5: found oC written under a computed condition"},
    /* ps_1_x */
    {ps1, "tex t1", "t:4:1: found tex after arithmetic, expected texture instructions first"},
    {ps3, "tex t1\ntex t0", "t:3:5: found t0, expected the stages in order, each once"},
    {ps3, "tex t0\ntex t0", "t:3:5: found t0, expected the stages in order, each once"},
    {ps3, "tex t0\ntexbem t1, t1", "t:3:12: found t1.x, expected something to write it before it is read"},
    {ps3, "tex t0\ntexbem t1, t2", "t:3:12: found t2.x, expected something to write it"},
    {ps3, "tex t0\ntexm3x2tex t1, t0", "t:3:1: found texm3x2tex, expected the matrix's first rows before it"},
    {ps3, "tex t0\ntexm3x2pad t1, t0\ntexm3x2tex t3, t0",
     "t:4:12: found t3, expected t2: rows take consecutive stages"},
    {ps3, "tex t0\ntexm3x3pad t1, t0\ntexm3x3tex t2, t0",
     "t:4:1: found texm3x3tex after texm3x3pad, expected"},
    {ps3, "tex t0\ntexm3x2pad t1, t0", "t:4:1: found mov after texm3x2pad, expected the matrix's next row"},
    {ps1, "cnd r0, r0, t0, v0", "t:4:9: found another condition, expected r0.w"},
    {"ps_1_1\n%s\n", "tex t0\nmov r0.xyz, t0\n",
     "t:3:1: found the end of the shader and r0 partly written, expected it"},
    {"ps_1_1\n%s\n", "tex t0\n", "t:2:1: found the end of the shader and r0 never written"},
    {ps1, "+mov r0.w, t0", "t:4:6: found a pair that writes the same pipe"},
    {ps1, "mov r1.xyz, t0\n+mov r1.xyz, t0", "t:5:6: found a pair that writes the same pipe"},
    {ps3, "+tex t0", "t:2:1: found + without an instruction to pair with, expected arithmetic before it"},
    {ps1, "mov r1.xyz, t0\n+mov r1.w, t0\n+mov r1.xyz, t0",
     "t:6:1: found + without an instruction to pair with"},
    {ps4, "phase", "t:5:1: found another phase, expected at most one"},
    {ps4, "mov r2, c0\ntexld r3, t0", "t:6:1: found texld after arithmetic"},
    {ps4, "texld r3, t0\ntexld r3, t1", "t:6:7: found r3 again, expected each once a phase"},
    {ps4, "texld r3, t0_dz", "t:5:11: found the modifier '_dz' of t0, expected it of r"},
    {ps4, "texld r3, t0_dw", "t:5:11: found the modifier '_dw', expected it of t with .xyw"},
    {ps4, "texld r3, t0.xyw", "t:5:11: found .xyz and .xyw of t0, expected the same every time"},
    {ps4, "texcrd r3.xyz, r1", "t:5:16: found r1, expected t"},
    {ps4, "texld r2, t0\ntexld r3, r2",
     "t:6:11: found r2, which this phase has sampled to, expected a value of the first phase"},
    {ps4, "texdepth r4", "t:5:10: found r4, expected r5 of texdepth"},
    {bare, "ps_1_4\ntexcrd r0.xyz, t0\ntexld r1, r0\nphase\nmov r0, c0\n",
     "t:3:11: found r0, expected t: r can be sampled at in the second phase"},
    {bare, "ps_1_4\ntexkill t0\nphase\nmov r0, c0\n", "t:2:1: found texkill in the first phase"},
    {bare, "ps_1_4\nmov r0, v0\nphase\nmov r0, c0\n",
     "t:2:9: found v0 in the first phase, expected it in the second"},
    {ps4, "bem r1.xy, c0, r1", "t:5:1: found bem in the second phase, expected it once"},
    /* outputs */
    {bare, "vs_1_1\nmov r0, c0\n", "t:2:1: found the end of the shader and oPos never written"},
    {bare, "vs_1_1\nmov oPos.xyz, c0\n", "t:2:1: found the end of the shader and oPos partly written"},
    {bare, "vs_1_1\n", "t:1:1: found the end of the shader and oPos never written"},
    {bare, "vs_3_0\ndcl_color o0\nmov o0, c0\n",
     "t:3:1: found the end of the shader and no output declared as the"},
    {bare, "vs_3_0\ndcl_position o0\nmov o0.xyz, c0\n",
     "t:3:1: found the end of the shader and the position not written"},
    {bare, "ps_2_0\nmov oDepth, c0.x\n", "t:2:1: found the end of the shader and oC0 never written"},
    {bare, "ps_2_0\nmov oC0, c0\nmov oC2, c0\n",
     "t:3:1: found the end of the shader and a target written but not"},
    {ps20, "add oC1, r0, r0", "t:5:5: found oC as the destination of add, expected mov, without _sat"},
    {ps20, "mov oC1.xyz, r0", "t:5:5: found a mask, a swizzle or a modifier on the way to oC1"},
    {ps20, "mov oC1, -r0", "t:5:5: found a mask, a swizzle or a modifier on the way to oC1"},
    {ps20, "mov oC1, r0\nmov oC1, r0", "t:6:5: found oC1 written again, expected it once"},
    {ps20, "mov oDepth, r0", "t:5:13: found several components for oDepth, expected one, like r0.x"},
    {ps20, "texld r0, r0, s0\ntexld r0, r0, s0\ntexld r0, r0, s0\ntexld r0, r0, s0",
     "t:8:11: found a texture read that depends on others 4 deep, expected at most 3 in ps_2_0"},
};

/* Replaces the frame's %s by the statements. */
static void put_in(const char *frame, const char *statements, char text[1024])
{
    const char *hole = strstr(frame, "%s");
    snprintf(text, 1024, "%.*s%s%s", (int)(hole - frame), frame, statements, hole + 2);
}

static void shaders_that_break_a_rule_are_refused_where_they_do(void)
{
    TEST_ASSERT_TRUE(sizeof bad / sizeof *bad > 150);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[1024];
        put_in(bad[i].frame, bad[i].text, text);
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(bad[i].reason, reason_of(text), strlen(bad[i].reason), text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(shaders_that_follow_the_rules_are_accepted);
    RUN_TEST(shaders_that_break_a_rule_are_refused_where_they_do);
    return UNITY_END();
}
