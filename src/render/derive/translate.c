#include "render/derive/translate.h"

#include <stdio.h>
#include <stdlib.h>

_Noreturn void derive_impossible(const char *kind, uint32_t value)
{
    fprintf(stderr, "triptych: %s %u has no meaning in src/render/derive\n", kind, (unsigned)value);
    abort();
}

uint8_t derive_compare(uint32_t value)
{
    switch ((enum triptych_compare)value) {
    case TRIPTYCH_COMPARE_NEVER: return COMPARE_NEVER;
    case TRIPTYCH_COMPARE_LESS: return COMPARE_LESS;
    case TRIPTYCH_COMPARE_EQUAL: return COMPARE_EQUAL;
    case TRIPTYCH_COMPARE_LESSEQUAL: return COMPARE_LESS_EQUAL;
    case TRIPTYCH_COMPARE_GREATER: return COMPARE_GREATER;
    case TRIPTYCH_COMPARE_NOTEQUAL: return COMPARE_NOT_EQUAL;
    case TRIPTYCH_COMPARE_GREATEREQUAL: return COMPARE_GREATER_EQUAL;
    case TRIPTYCH_COMPARE_ALWAYS: return COMPARE_ALWAYS;
    }
    derive_impossible("comparison", value);
}

uint8_t derive_stencil_operation(uint32_t value)
{
    switch ((enum triptych_stencilop)value) {
    case TRIPTYCH_STENCILOP_KEEP: return STENCIL_KEEP;
    case TRIPTYCH_STENCILOP_ZERO: return STENCIL_ZERO;
    case TRIPTYCH_STENCILOP_REPLACE: return STENCIL_REPLACE;
    case TRIPTYCH_STENCILOP_INCRSAT: return STENCIL_INCREMENT_SATURATED;
    case TRIPTYCH_STENCILOP_DECRSAT: return STENCIL_DECREMENT_SATURATED;
    case TRIPTYCH_STENCILOP_INVERT: return STENCIL_INVERT;
    case TRIPTYCH_STENCILOP_INCR: return STENCIL_INCREMENT;
    case TRIPTYCH_STENCILOP_DECR: return STENCIL_DECREMENT;
    }
    derive_impossible("stencil operation", value);
}

uint8_t derive_blend_operation(uint32_t value)
{
    switch ((enum triptych_blendop)value) {
    case TRIPTYCH_BLENDOP_ADD: return BLEND_ADD;
    case TRIPTYCH_BLENDOP_SUBTRACT: return BLEND_SUBTRACT;
    case TRIPTYCH_BLENDOP_REVSUBTRACT: return BLEND_REVERSE_SUBTRACT;
    case TRIPTYCH_BLENDOP_MIN: return BLEND_MINIMUM;
    case TRIPTYCH_BLENDOP_MAX: return BLEND_MAXIMUM;
    case TRIPTYCH_BLENDOP_MULTIPLY: return BLEND_ADVANCED + (int)ADVANCED_MULTIPLY;
    case TRIPTYCH_BLENDOP_SCREEN: return BLEND_ADVANCED + (int)ADVANCED_SCREEN;
    case TRIPTYCH_BLENDOP_OVERLAY: return BLEND_ADVANCED + (int)ADVANCED_OVERLAY;
    case TRIPTYCH_BLENDOP_DARKEN: return BLEND_ADVANCED + (int)ADVANCED_DARKEN;
    case TRIPTYCH_BLENDOP_LIGHTEN: return BLEND_ADVANCED + (int)ADVANCED_LIGHTEN;
    case TRIPTYCH_BLENDOP_COLORDODGE: return BLEND_ADVANCED + (int)ADVANCED_COLOR_DODGE;
    case TRIPTYCH_BLENDOP_COLORBURN: return BLEND_ADVANCED + (int)ADVANCED_COLOR_BURN;
    case TRIPTYCH_BLENDOP_HARDLIGHT: return BLEND_ADVANCED + (int)ADVANCED_HARD_LIGHT;
    case TRIPTYCH_BLENDOP_SOFTLIGHT: return BLEND_ADVANCED + (int)ADVANCED_SOFT_LIGHT;
    case TRIPTYCH_BLENDOP_DIFFERENCE: return BLEND_ADVANCED + (int)ADVANCED_DIFFERENCE;
    case TRIPTYCH_BLENDOP_EXCLUSION: return BLEND_ADVANCED + (int)ADVANCED_EXCLUSION;
    case TRIPTYCH_BLENDOP_HUE: return BLEND_ADVANCED + (int)ADVANCED_HUE;
    case TRIPTYCH_BLENDOP_SATURATION: return BLEND_ADVANCED + (int)ADVANCED_SATURATION;
    case TRIPTYCH_BLENDOP_COLOR: return BLEND_ADVANCED + (int)ADVANCED_COLOR;
    case TRIPTYCH_BLENDOP_LUMINOSITY: return BLEND_ADVANCED + (int)ADVANCED_LUMINOSITY;
    }
    derive_impossible("blend operation", value);
}

uint8_t derive_logic_operation(uint32_t value)
{
    switch ((enum triptych_logicop)value) {
    case TRIPTYCH_LOGICOP_NONE:
    case TRIPTYCH_LOGICOP_NOOP:
    case TRIPTYCH_LOGICOP_COPY: return LOGIC_COPY;
    case TRIPTYCH_LOGICOP_CLEAR: return LOGIC_CLEAR;
    case TRIPTYCH_LOGICOP_AND: return LOGIC_AND;
    case TRIPTYCH_LOGICOP_ANDREVERSE: return LOGIC_AND_REVERSE;
    case TRIPTYCH_LOGICOP_ANDINVERTED: return LOGIC_AND_INVERTED;
    case TRIPTYCH_LOGICOP_XOR: return LOGIC_XOR;
    case TRIPTYCH_LOGICOP_OR: return LOGIC_OR;
    case TRIPTYCH_LOGICOP_NOR: return LOGIC_NOR;
    case TRIPTYCH_LOGICOP_EQUIV: return LOGIC_EQUIV;
    case TRIPTYCH_LOGICOP_INVERT: return LOGIC_INVERT;
    case TRIPTYCH_LOGICOP_ORREVERSE: return LOGIC_OR_REVERSE;
    case TRIPTYCH_LOGICOP_COPYINVERTED: return LOGIC_COPY_INVERTED;
    case TRIPTYCH_LOGICOP_ORINVERTED: return LOGIC_OR_INVERTED;
    case TRIPTYCH_LOGICOP_NAND: return LOGIC_NAND;
    case TRIPTYCH_LOGICOP_SET: return LOGIC_SET;
    }
    derive_impossible("logic operation", value);
}

uint8_t derive_factor(uint32_t value)
{
    switch ((enum triptych_blend)value) {
    case TRIPTYCH_BLEND_ZERO: return FACTOR_ZERO;
    case TRIPTYCH_BLEND_ONE: return FACTOR_ONE;
    case TRIPTYCH_BLEND_SRCCOLOR: return FACTOR_SOURCE_COLOR;
    case TRIPTYCH_BLEND_INVSRCCOLOR: return FACTOR_INVERSE_SOURCE_COLOR;
    case TRIPTYCH_BLEND_SRCALPHA: return FACTOR_SOURCE_ALPHA;
    case TRIPTYCH_BLEND_INVSRCALPHA: return FACTOR_INVERSE_SOURCE_ALPHA;
    case TRIPTYCH_BLEND_DESTALPHA: return FACTOR_TARGET_ALPHA;
    case TRIPTYCH_BLEND_INVDESTALPHA: return FACTOR_INVERSE_TARGET_ALPHA;
    case TRIPTYCH_BLEND_DESTCOLOR: return FACTOR_TARGET_COLOR;
    case TRIPTYCH_BLEND_INVDESTCOLOR: return FACTOR_INVERSE_TARGET_COLOR;
    case TRIPTYCH_BLEND_SRCALPHASAT: return FACTOR_SATURATED_ALPHA;
    case TRIPTYCH_BLEND_BLENDFACTOR: return FACTOR_CONSTANT;
    case TRIPTYCH_BLEND_INVBLENDFACTOR: return FACTOR_INVERSE_CONSTANT;
    case TRIPTYCH_BLEND_BLENDFACTORALPHA: return FACTOR_CONSTANT_ALPHA;
    case TRIPTYCH_BLEND_INVBLENDFACTORALPHA: return FACTOR_INVERSE_CONSTANT_ALPHA;
    case TRIPTYCH_BLEND_SRCCOLOR2: return FACTOR_SECOND_COLOR;
    case TRIPTYCH_BLEND_INVSRCCOLOR2: return FACTOR_INVERSE_SECOND_COLOR;
    case TRIPTYCH_BLEND_SRCALPHA2: return FACTOR_SECOND_ALPHA;
    case TRIPTYCH_BLEND_INVSRCALPHA2: return FACTOR_INVERSE_SECOND_ALPHA;
    case TRIPTYCH_BLEND_BOTHSRCALPHA:
    case TRIPTYCH_BLEND_BOTHINVSRCALPHA: break;
    }
    derive_impossible("blend factor", value);
}

uint8_t derive_cull(uint32_t value)
{
    switch ((enum triptych_cull)value) {
    case TRIPTYCH_CULL_NONE: return CULL_NONE;
    case TRIPTYCH_CULL_CW: return CULL_CLOCKWISE;
    case TRIPTYCH_CULL_CCW: return CULL_COUNTERCLOCKWISE;
    }
    derive_impossible("cull mode", value);
}

/* A filter between levels is none, point or linear. Anisotropic magnification is linear. */
static enum filter filter_of(uint32_t value)
{
    switch ((enum triptych_filter)value) {
    case TRIPTYCH_FILTER_NONE:
    case TRIPTYCH_FILTER_POINT: return FILTER_POINT;
    case TRIPTYCH_FILTER_LINEAR:
    case TRIPTYCH_FILTER_ANISOTROPIC: return FILTER_LINEAR;
    case TRIPTYCH_FILTER_PYRAMIDALQUAD:
    case TRIPTYCH_FILTER_GAUSSIANQUAD:
    case TRIPTYCH_FILTER_CONVOLUTIONMONO: break;
    }
    derive_impossible("filter", value);
}

uint8_t derive_filter(uint32_t value)
{
    return (uint8_t)filter_of(value);
}

uint8_t derive_mip_filter(uint32_t value)
{
    if (value == TRIPTYCH_FILTER_NONE)
        return MIP_NONE;
    return filter_of(value) == FILTER_LINEAR ? MIP_LINEAR : MIP_POINT;
}

uint8_t derive_address(uint32_t value, uint32_t size)
{
    bool power = !(size & (size - 1));
    switch ((enum triptych_address)value) {
    case TRIPTYCH_ADDRESS_WRAP: return power ? ADDRESS_WRAP_POWER : ADDRESS_WRAP;
    case TRIPTYCH_ADDRESS_MIRROR: return power ? ADDRESS_MIRROR_POWER : ADDRESS_MIRROR;
    case TRIPTYCH_ADDRESS_CLAMP: return ADDRESS_CLAMP;
    case TRIPTYCH_ADDRESS_BORDER: return ADDRESS_BORDER;
    case TRIPTYCH_ADDRESS_MIRRORONCE: return ADDRESS_MIRROR_ONCE;
    }
    derive_impossible("addressing", value);
}

uint8_t derive_table_fog(uint32_t value)
{
    switch ((enum triptych_fog)value) {
    case TRIPTYCH_FOG_NONE: return FOG_VARYING;
    case TRIPTYCH_FOG_EXP: return FOG_EXP_Z;
    case TRIPTYCH_FOG_EXP2: return FOG_EXP2_Z;
    case TRIPTYCH_FOG_LINEAR: return FOG_LINEAR_Z;
    }
    derive_impossible("fog mode", value);
}

uint8_t derive_fog_mode(uint32_t value)
{
    switch ((enum triptych_fog)value) {
    case TRIPTYCH_FOG_NONE: return VERTEX_FOG_SPECULAR_ALPHA;
    case TRIPTYCH_FOG_EXP: return VERTEX_FOG_EXP;
    case TRIPTYCH_FOG_EXP2: return VERTEX_FOG_EXP2;
    case TRIPTYCH_FOG_LINEAR: return VERTEX_FOG_LINEAR;
    }
    derive_impossible("fog mode", value);
}
