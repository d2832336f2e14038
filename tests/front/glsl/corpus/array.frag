precision mediump float;
uniform samplerCube cubes[2];
uniform sampler2D planes[3];
varying mat3 v_basis;
varying vec2 v_list[3];

vec4 sum(sampler2D plane, vec2 at[2])
{
    return texture2D(plane, at[0]) + texture2D(plane, at[1], 1.0);
}

void main()
{
    vec2 at[2];
    vec4 color = textureCube(cubes[1], v_basis[0]);
    for (int i = 0; i < 3; i++) {
        at[0] = v_list[i];
        at[1] = v_list[2 - i];
        color += sum(planes[i], at) + texture2DProj(planes[0], v_basis[i]);
    }
    color.rgb *= v_basis;
    gl_FragColor = color;
}
