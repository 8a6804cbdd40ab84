
// The common code of the viewer's shaders. A table is a texture over theta_h, theta_d and phi_d, read as gonio render
// reads it (include/gonio/render/horizon_lookup.hpp).
const look_up = `
const float pi = 3.14159265358979;

// Returns the coordinates from 0 to 1 along phi_d, theta_d and theta_h of directions above a surface with normal n, as
// in include/gonio/render/grid_coordinates.hpp but in any frame.
vec3 grid_coordinates(vec3 n, vec3 wi, vec3 wo) {
  vec3 sum = wi + wo, difference = wi - wo;
  float size = length(sum), x = -dot(n, difference) * size, y = dot(n, cross(sum, difference));
  float phi_d = x == 0.0 && y == 0.0 ? 0.0 : fract(atan(y, x) / pi);
  float theta_d = atan(length(difference), size), theta_h = atan(length(cross(n, sum)), dot(n, sum));
  return vec3(phi_d, theta_d * 2.0 / pi, sqrt(theta_h * 2.0 / pi));
}

// Returns reflectance in sr^-1 for directions above the horizon: of the fit for a truth_share of 0, of the truth for 1,
// between them of both, mixed by their logarithms.
vec3 reflectance(float truth_share, vec3 n, vec3 wi, vec3 wo) {
  vec3 at = grid_coordinates(n, wi, wo), fitted, true_one;
  if (truth_share < 1.0) {
    vec4 read = textureLod(values, at + values_shift, 0.0) * values_scale;
    fitted = read.rgb / read.a;
    if (truth_share <= 0.0) return fitted;
  }
  vec4 read = textureLod(truth, at + truth_shift, 0.0) * truth_scale;
  true_one = read.rgb / read.a;
  if (truth_share >= 1.0) return true_one;
  return exp(mix(log(max(fitted, 1e-6)), log(max(true_one, 1e-6)), truth_share));
}`;

const vertex_shader = `#version 300 es
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }`;
const whole_image = new Float32Array([-1, -1, 3, -1, -1, 3]);

// Returns the shader of lit points, for an environment or for the lamp. One program with a branch would be slower for
// both.
const shading = (surrounded) => `#version 300 es
precision highp float;
precision highp sampler3D;
uniform sampler3D values, truth, known;
uniform vec3 values_shift, truth_shift, light;
uniform vec4 values_scale, truth_scale;
uniform float exposure, size;
uniform float border, blend;  // shares of the truth: 1 right of the border, blend left of it
uniform bool shows_known;
const bool surrounded = ${surrounded};
uniform sampler2D added;  // in an environment: the sum of the frames so far
out vec4 colour;
${look_up}
${environment_shading}

struct lit_point { bool hit; vec3 n, wi, wo; float irradiance; };

// Returns the colour of an uncertainty, as in the page's map: light is 2 %, dark 100 %.
vec3 colour_of_known(float share) {
  float t = clamp(log(max(share, 1e-6) / 0.02) / log(50.0), 0.0, 1.0);
  return mix(vec3(243.0, 236.0, 210.0), vec3(18.0, 58.0, 99.0), t) / 255.0;
}
vec3 linear_light(vec3 v) { return mix(v / 12.92, pow((v + 0.055) / 1.055, vec3(2.4)), step(0.04045, v)); }
vec3 display_value(vec3 v) {
  v = clamp(v, 0.0, 1.0);
  return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, v));
}

// Returns the pixel's column, from -1 to 1.
float right_of_middle() { return gl_FragCoord.x / size * 2.0 - 1.0; }
vec4 on_display(vec3 v) {
  return vec4(abs(right_of_middle() - border) < 1.5 / size ? vec3(0.6) : display_value(v), 1.0);
}
vec4 added_or_shown(vec3 v) {
  if (!surrounded) return on_display(v);
  return vec4(frame > 0 ? v + texelFetch(added, ivec2(gl_FragCoord.xy), 0).rgb : v, 1.0);
}

// Returns the colour of a point. A white Lambertian surface that faces the light has the value of exposure.
vec3 seen(lit_point point, float x) {
  float truth_share = x > border ? 1.0 : blend;
  if (!point.hit || dot(point.n, point.wo) <= 0.0) return vec3(0.0);
  if (surrounded) return seen_all_around(truth_share, point.n, point.wo) * exposure;
  float cosine = dot(point.n, point.wi);
  if (cosine <= 0.0) return vec3(0.0);
  if (shows_known && truth_share < 1.0) {
    float level = texture(known, grid_coordinates(point.n, point.wi, point.wo)).r;
    return linear_light(colour_of_known(0.001 * pow(10.0, 4.0 * level)));
  }
  return reflectance(truth_share, point.n, point.wi, point.wo) * (pi * cosine * point.irradiance * exposure);
}`;

// The sphere fills the square and is seen by a camera at infinity, as gonio render draws it. The flat sample is seen
// from 50 degrees off its normal, under a lamp at a distance of three times half its width.
const image_main = `
uniform int samples, shape;  // 0: a sphere, 1: a flat sample, 2: nothing but the environment
uniform vec2 within_pixel;

lit_point sphere(vec2 p) {
  float squared = dot(p, p);
  return lit_point(squared < 1.0, vec3(p, sqrt(max(1.0 - squared, 0.0))), light, vec3(0.0, 0.0, 1.0), 1.0);
}

lit_point flat_sample(vec2 p) {
  vec3 n = vec3(0.0, 0.76604444, 0.64278761), right = vec3(1.0, 0.0, 0.0), up = cross(n, right);
  vec3 eye = vec3(0.0, 0.0, 5.0), ray = normalize(vec3(1.3 * p, -5.0));
  vec3 at = eye - ray * (dot(eye, n) / dot(ray, n));
  vec3 lamp = 3.0 * light - at;
  bool hit = max(abs(dot(at, right)), abs(dot(at, up))) < 1.0;
  return lit_point(hit, n, normalize(lamp), -ray, 9.0 / dot(lamp, lamp));
}

vec3 seen_at(vec2 p) {
  lit_point point;
  if (shape == 1) point = flat_sample(p);
  else point = sphere(p);
  point.hit = point.hit && shape < 2;
  if (surrounded && !point.hit) return light_from(vec3(p, -3.0)).rgb * exposure;
  return seen(point, p.x);
}

void main() {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < samples * samples; ++i) {
    vec2 within = surrounded ? within_pixel : (vec2(i % samples, i / samples) + 0.5) / float(samples);
    sum += seen_at((floor(gl_FragCoord.xy) + within) / size * 2.0 - 1.0);
  }
  colour = added_or_shown(sum / float(samples * samples));
}`;
