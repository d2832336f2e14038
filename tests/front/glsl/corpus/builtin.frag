precision mediump float;
varying vec4 v;

void main()
{
    ivec4 i = ivec4(v * 4.0);
    bvec4 b = equal(i, i.yzwx);
    gl_FragColor = vec4(b) + vec4(i / 2) + vec4(greaterThanEqual(v, v.yyyy));
}
