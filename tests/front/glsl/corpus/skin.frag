precision mediump float;
varying float v_height;

void main()
{
    vec2 from = gl_PointCoord - 0.5;
    gl_FragColor = vec4(v_height, gl_FrontFacing ? 1.0 : 0.0, dot(from, from), 1.0);
}
