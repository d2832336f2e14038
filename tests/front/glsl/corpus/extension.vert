attribute vec4 position;
varying vec3 v;
invariant gl_Position;

void main()
{
    v = position.xyz * gl_DepthRange.diff;
    gl_Position = position;
}
