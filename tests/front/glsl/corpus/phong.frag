precision mediump float;
struct Light {
    vec3 direction;
    vec3 color;
    float power;
};
uniform Light lights[2];
uniform sampler2D surface;
uniform vec4 ambient;
varying vec3 v_normal, v_eye;
varying vec2 v_uv;

vec3 shade(const in Light light, vec3 n, vec3 e)
{
    float diffuse = max(dot(n, light.direction), 0.0);
    if (diffuse <= 0.0)
        return vec3(0.0);
    vec3 h = normalize(light.direction + e);
    return light.color * (diffuse + pow(max(dot(n, h), 0.0), light.power));
}

void main()
{
    vec3 n = normalize(v_normal), e = normalize(v_eye), sum = ambient.rgb;
    for (int i = 0; i < 2; i++)
        sum += shade(lights[i], n, e);
    vec4 texel = texture2D(surface, v_uv);
    if (texel.a < 0.5)
        discard;
    gl_FragColor = vec4(sum * texel.rgb, ambient.a);
}
