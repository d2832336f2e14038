attribute vec4 position;
attribute vec3 normal;
attribute vec2 uv;
uniform mat4 model, projection;
uniform mat3 turn;
varying vec3 v_normal, v_eye;
varying vec2 v_uv;

void main()
{
    vec4 world = model * position;
    gl_Position = projection * world;
    v_normal = turn * normal;
    v_eye = -world.xyz;
    v_uv = uv;
}
