attribute vec4 position;
varying vec4 v;

void main()
{
    vec4 p = position, q = p.wzyx;
    vec4 a = radians(p) + degrees(q) + sin(p) + cos(p) + tan(p) + asin(p) + acos(p) + atan(p) + atan(p, q);
    vec4 b = pow(p, q) + exp(p) + log(p) + exp2(p) + log2(p) + sqrt(p) + inversesqrt(p);
    vec4 c = abs(p) + sign(p) + floor(p) + ceil(p) + fract(p) + mod(p, q) + mod(p, 2.0) + min(p, q) + max(p, 1.0);
    vec4 d = clamp(p, 0.0, 1.0) + mix(p, q, 0.5) + step(p, q) + smoothstep(p, q, a);
    vec3 e = cross(p.xyz, q.xyz) + normalize(p.xyz) + faceforward(p.xyz, q.xyz, p.yzw);
    vec2 f = reflect(p.xy, q.xy) + refract(p.xy, q.xy, 0.5) + vec2(length(p), distance(p, q));
    bvec4 g = lessThan(p, q), h = notEqual(lessThanEqual(p, q), greaterThan(a, b));
    mat2 m = matrixCompMult(mat2(p), mat2(q));
    v = a + b + c + d + vec4(e, dot(p, q)) + vec4(f, m[0]) + vec4(any(g), all(h), not(g.xy));
    gl_Position = p;
}
