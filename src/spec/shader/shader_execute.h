/* Execution of one instruction: the function for its row of def/shader/shader.def, and the write of its
 * result.
 *
 * ps_1_x can issue a pair of instructions together; both read their sources before either writes. */
#ifndef SPEC_SHADER_SHADER_EXECUTE_H
#define SPEC_SHADER_SHADER_EXECUTE_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/shader/shader.h"
#include "spec/shader/shader_arithmetic.h"
#include "spec/shader/shader_texture.h"

/* Computes the result of an instruction that is not flow control, before masks, shifts and saturation, from
 * sources that are read. Returns true if there is a result to write, false if it writes no register. */
static inline bool compute_result(struct env *e, struct step *s, enum shader_opcode opcode,
                                  struct vector4 *result)
{
    switch (opcode) {
    case SHADER_MOV: *result = s->source[0]; return true;
    case SHADER_ADD: *result = execute_add(E, s); return true;
    case SHADER_SUB: *result = execute_sub(E, s); return true;
    case SHADER_MAD: *result = execute_mad(E, s); return true;
    case SHADER_MUL: *result = execute_mul(E, s); return true;
    case SHADER_RCP: *result = execute_rcp(E, s); return true;
    case SHADER_RSQ: *result = execute_rsq(E, s); return true;
    case SHADER_DP3: *result = execute_dp3(E, s); return true;
    case SHADER_DP4: *result = execute_dp4(E, s); return true;
    case SHADER_MIN: *result = execute_min(E, s); return true;
    case SHADER_MAX: *result = execute_max(E, s); return true;
    case SHADER_SLT: *result = execute_slt(E, s); return true;
    case SHADER_SGE: *result = execute_sge(E, s); return true;
    case SHADER_EXP: *result = execute_exp(E, s); return true;
    case SHADER_LOG: *result = execute_log(E, s); return true;
    case SHADER_LIT: *result = execute_lit(E, s); return true;
    case SHADER_DST: *result = execute_dst(E, s); return true;
    case SHADER_LRP: *result = execute_lrp(E, s); return true;
    case SHADER_FRC: *result = execute_frc(E, s); return true;
    case SHADER_M4X4: *result = execute_m4x4(E, s); return true;
    case SHADER_M4X3: *result = execute_m4x3(E, s); return true;
    case SHADER_M3X4: *result = execute_m3x4(E, s); return true;
    case SHADER_M3X3: *result = execute_m3x3(E, s); return true;
    case SHADER_M3X2: *result = execute_m3x2(E, s); return true;
    case SHADER_POW: *result = execute_pow(E, s); return true;
    case SHADER_CRS: *result = execute_crs(E, s); return true;
    case SHADER_SGN: *result = execute_sgn(E, s); return true;
    case SHADER_ABS: *result = execute_abs(E, s); return true;
    case SHADER_NRM: *result = execute_nrm(E, s); return true;
    case SHADER_SINCOS_2:
    case SHADER_SINCOS: *result = execute_sincos(E, s); return true;
    case SHADER_EXPP: *result = execute_expp(E, s); return true;
    case SHADER_LOGP: *result = execute_logp(E, s); return true;
    case SHADER_CND: *result = execute_cnd(E, s); return true;
    case SHADER_CMP: *result = execute_cmp(E, s); return true;
    case SHADER_DP2ADD: *result = execute_dp2add(E, s); return true;
    case SHADER_TEXLD: *result = execute_texld(E, s); return true;
    case SHADER_TEXLDP: *result = execute_texldp(E, s); return true;
    case SHADER_TEXLDB: *result = execute_texldb(E, s); return true;
    case SHADER_TEXLDL: *result = execute_texldl(E, s); return true;
    case SHADER_TEXLDD: *result = execute_texldd(E, s); return true;
    case SHADER_TEXLD_1_4: *result = execute_texld_1_4(E, s); return true;
    case SHADER_TEXCRD: *result = execute_texcrd(E, s); return true;
    case SHADER_BEM: *result = execute_bem(E, s); return true;
    case SHADER_DSX: *result = execute_dsx(E, s); return true;
    case SHADER_DSY: *result = execute_dsy(E, s); return true;
    case SHADER_TEX: *result = execute_tex(E, s); return true;
    case SHADER_TEXCOORD: *result = execute_texcoord(E, s); return true;
    case SHADER_TEXBEM: *result = execute_texbem(E, s); return true;
    case SHADER_TEXBEML: *result = execute_texbeml(E, s); return true;
    case SHADER_TEXREG2AR: *result = execute_texreg2ar(E, s); return true;
    case SHADER_TEXREG2GB: *result = execute_texreg2gb(E, s); return true;
    case SHADER_TEXREG2RGB: *result = execute_texreg2rgb(E, s); return true;
    case SHADER_TEXDP3: *result = execute_texdp3(E, s); return true;
    case SHADER_TEXDP3TEX: *result = execute_texdp3tex(E, s); return true;
    case SHADER_TEXM3X2TEX: *result = execute_texm3x2tex(E, s); return true;
    case SHADER_TEXM3X3: *result = execute_texm3x3(E, s); return true;
    case SHADER_TEXM3X3TEX: *result = execute_texm3x3tex(E, s); return true;
    case SHADER_TEXM3X3SPEC: *result = execute_texm3x3spec(E, s); return true;
    case SHADER_TEXM3X3VSPEC: *result = execute_texm3x3vspec(E, s); return true;
    case SHADER_DIV: *result = execute_div(E, s); return true;
    case SHADER_SQRT: *result = execute_sqrt(E, s); return true;
    case SHADER_FLOOR: *result = execute_floor(E, s); return true;
    case SHADER_TRUNC: *result = execute_trunc(E, s); return true;
    case SHADER_ROUND: *result = execute_round(E, s); return true;
    case SHADER_SEQ: *result = execute_seq(E, s); return true;
    case SHADER_SNE: *result = execute_sne(E, s); return true;
    case SHADER_SELECT: *result = execute_select(E, s); return true;
    case SHADER_KILL:
    case SHADER_KILL_COMPARE: execute_kill(E, s); return false;
    case SHADER_TEXKILL: execute_texkill(E, s); return false;
    case SHADER_TEXDEPTH: execute_texdepth(E, s); return false;
    case SHADER_TEXM3X2DEPTH: execute_texm3x2depth(E, s); return false;
    case SHADER_TEXM3X2PAD: execute_texm3x2pad(E, s); return false;
    case SHADER_TEXM3X3PAD: execute_texm3x3pad(E, s); return false;
    /* Flow control and other destinations (execute_step), and declarations. */
    case SHADER_NOP:
    case SHADER_CALL:
    case SHADER_CALLNZ:
    case SHADER_LOOP:
    case SHADER_RET:
    case SHADER_ENDLOOP:
    case SHADER_LABEL:
    case SHADER_DCL:
    case SHADER_REP:
    case SHADER_ENDREP:
    case SHADER_IF:
    case SHADER_IF_COMPARE:
    case SHADER_ELSE:
    case SHADER_ENDIF:
    case SHADER_BREAK:
    case SHADER_BREAK_COMPARE:
    case SHADER_MOVA:
    case SHADER_DEFB:
    case SHADER_DEFI:
    case SHADER_DEF:
    case SHADER_SETP:
    case SHADER_BREAKP:
    case SHADER_PHASE:
    case SHADER_WHILE:
    case SHADER_ENDWHILE:
    case SHADER_CONTINUE:
    case SHADER_ARRAY:
    case SHADER_COUNT: break;
    }
    return false;
}

static inline bool execute_instruction(struct env *e, struct step *s, struct vector4 *result)
{
    read_sources(E, s);
    return compute_result(E, s, (enum shader_opcode)s->instruction->opcode, result);
}

static inline struct step step_of(struct machine *m, const struct shader_instruction *i)
{
    struct step s = {.instruction = i, .machine = m, .mask = i->destination.swizzle, .legacy = m->legacy};
    return s;
}

/* mova rounds to nearest; vs_1_1's mov takes the floor. */
static inline void execute_address(struct env *e, struct machine *m, const struct shader_instruction *i)
{
    struct step s = step_of(m, i);
    itg value[4];
    read_sources(E, &s);
    for (unsigned c = 0; c < 4; c++) {
        if (!(s.mask >> c & 1))
            continue;
        flt v = s.source[0].v[c];
        if (i->opcode == SHADER_MOV)
            v = floor_f(E, v);
        value[c] = round_i(E, v);
    }
    write_address(E, m, i, value);
}

static inline void execute_setp(struct env *e, struct machine *m, const struct shader_instruction *i)
{
    struct step s = step_of(m, i);
    msk value[4];
    read_sources(E, &s);
    for (unsigned c = 0; c < 4; c++)
        if (s.mask >> c & 1)
            value[c] = compare_values(E, i->comparison, s.source[0].v[c], s.source[1].v[c]);
    write_predicate(E, m, i, value);
}

static inline void execute_plain(struct env *e, struct machine *m, const struct shader_instruction *i)
{
    struct step s = step_of(m, i);
    struct vector4 result;
    if (execute_instruction(E, &s, &result))
        write_result(E, m, i, &result);
}

static inline void execute_pair(struct env *e, struct machine *m, const struct shader_instruction *first,
                                const struct shader_instruction *second)
{
    struct step a = step_of(m, first), b = step_of(m, second);
    struct vector4 result[2];
    int writes = execute_instruction(E, &a, &result[0]);
    int also = execute_instruction(E, &b, &result[1]);
    if (writes)
        write_result(E, m, first, &result[0]);
    if (also)
        write_result(E, m, second, &result[1]);
}

#endif
