#extension GL_OES_standard_derivatives : enable
#extension GL_EXT_shader_texture_lod : enable
#extension GL_EXT_frag_depth : enable
#extension GL_EXT_draw_buffers : enable
precision highp float;
varying vec3 v;
uniform sampler2D plane;
uniform samplerCube cube;

void main()
{
    vec2 dx = dFdx(v.xy), dy = dFdy(v.xy);
    gl_FragData[0] = texture2DGradEXT(plane, v.xy, dx, dy) + texture2DProjGradEXT(plane, v, dx, dy);
    gl_FragData[1] = texture2DLodEXT(plane, v.xy, 1.0) + textureCubeLodEXT(cube, v, 2.0);
    gl_FragData[2] = texture2DProjLodEXT(plane, vec4(v, 2.0), 1.0) + vec4(fwidth(v), gl_FragCoord.w);
    gl_FragDepthEXT = gl_FragCoord.z * gl_DepthRange.far;
}
