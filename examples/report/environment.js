
// Light of an environment, a latitude-longitude image as in include/gonio/render/environment_map.hpp. Directions are
// drawn by importance of the material and of the light and combined by the balance heuristic, as gonio render does
// (include/gonio/render/sampled_sphere.hpp): E. Veach and L. Guibas, "Optimally Combining Sampling Techniques for Monte
// Carlo Rendering", SIGGRAPH 1995.

const last_frame = 256, lobe_bins = 90;

// ---- shaders ---------------------------------------------------------------------------------------------------
const environment_shading = `
uniform sampler2D surroundings;  // radiance; in w the share of the row's light up to and including a pixel
uniform sampler2D rows;          // in w the share of all light up to and including a row
uniform sampler2D lobes;         // fit and truth over theta_h: density in sr^-1 divided by cos theta_h; in w shares
uniform float total_light, around;
uniform int frame;

vec3 turned(float by, vec3 v) { return vec3(cos(by) * v.x + sin(by) * v.z, v.y, cos(by) * v.z - sin(by) * v.x); }

// Returns the radiance from a direction, and the density in sr^-1 with which light_direction draws it.
vec4 light_from(vec3 towards) {
  vec3 d = turned(-around, towards);
  vec2 size = vec2(textureSize(surroundings, 0));
  vec2 at = vec2(atan(d.x, -d.z) / (2.0 * pi) + 0.5, atan(length(d.xz), d.y) / pi) * size;
  vec3 radiance = texelFetch(surroundings, ivec2(min(at, size - 1.0)), 0).rgb;
  return vec4(radiance, dot(radiance, vec3(0.2126, 0.7152, 0.0722)) / total_light);
}

// Returns the position of a share in a line of increasing shares, in texels.
float place_of(sampler2D shares, int line, float share) {
  int low = 0, high = textureSize(shares, 0).x - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (texelFetch(shares, ivec2(middle, line), 0).a > share) high = middle;
    else low = middle + 1;
  }
  float before = low == 0 ? 0.0 : texelFetch(shares, ivec2(low - 1, line), 0).a;
  float width = texelFetch(shares, ivec2(low, line), 0).a - before;
  return float(low) + clamp((share - before) / max(width, 1e-30), 0.0, 0.9999);
}

vec3 light_direction(vec2 u) {
  float row = place_of(rows, 0, u.x), step = pi / float(textureSize(surroundings, 0).y);
  float column = place_of(surroundings, int(row), u.y), l = column * step - pi;
  // Within a row all heights are equally likely, as solid angles are: cos a - fract (cos a - cos b), without
  // cancellation.
  float top = floor(row) * step, height = cos(top) - fract(row) * 2.0 * sin(top + 0.5 * step) * sin(0.5 * step);
  float across = sqrt(max(1.0 - height * height, 0.0));
  return turned(around, vec3(across * sin(l), height, -across * cos(l)));
}

float sine_of_bin(float bin) {
  float share = bin / float(textureSize(lobes, 0).x);
  return sin(0.5 * pi * share * share);
}

// Draws a direction of light by its half vector, more often where the material is bright.
vec3 lobe_direction(float truth_share, vec3 n, vec3 wo, vec2 u) {
  int line = u.x < truth_share ? 1 : 0;
  u.x = line == 1 ? u.x / truth_share : (u.x - truth_share) / (1.0 - truth_share);
  float bin = place_of(lobes, line, u.x), low = sine_of_bin(floor(bin)), high = sine_of_bin(floor(bin) + 1.0);
  float squared = mix(low * low, high * high, fract(bin)), across = sqrt(squared);
  vec3 x = normalize(abs(n.z) < 0.7 ? vec3(n.y, -n.x, 0.0) : vec3(0.0, n.z, -n.y)), y = cross(n, x);
  vec3 h = across * cos(2.0 * pi * u.y) * x + across * sin(2.0 * pi * u.y) * y + sqrt(1.0 - squared) * n;
  return 2.0 * dot(wo, h) * h - wo;
}

// Returns the density in sr^-1 with which lobe_direction draws wi.
float lobe_density(float truth_share, vec3 n, vec3 wi, vec3 wo) {
  vec3 sum = wi + wo;
  float theta_h = atan(length(cross(n, sum)), dot(n, sum)), size = float(textureSize(lobes, 0).x);
  int bin = int(min(sqrt(theta_h * 2.0 / pi) * size, size - 1.0));
  float density = mix(texelFetch(lobes, ivec2(bin, 0), 0).r, texelFetch(lobes, ivec2(bin, 1), 0).r, truth_share);
  return density * cos(theta_h) / (2.0 * length(sum));  // wo . h is half the length of the sum
}

uvec3 random(uvec3 v) {  // M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
  return v;
}

// Returns a point of a sequence that fills four dimensions evenly (M. Roberts, "The Unreasonable Effectiveness of
// Quasirandom Sequences", 2018): steps of t^-1 to t^-4 with t^5 = t + 1, from a random start for each pixel.
vec4 even_numbers(int number) {
  uvec3 one = random(uvec3(gl_FragCoord.xy, 1)), other = random(uvec3(gl_FragCoord.xy, 2));
  vec4 first = vec4(one.xy >> 8, other.xy >> 8) / 16777216.0;
  return fract(first + float(number) * vec4(0.85667488, 0.73389186, 0.62870672, 0.53859726));
}

vec3 reflected(float truth_share, vec3 n, vec3 wi, vec3 wo) {
  float cosine = dot(n, wi);
  if (cosine <= 0.0) return vec3(0.0);
  vec4 light = light_from(wi);
  float density = light.w + lobe_density(truth_share, n, wi, wo);
  return density > 0.0 ? reflectance(truth_share, n, wi, wo) * light.rgb * (cosine / density) : vec3(0.0);
}

// Returns the radiance seen, estimated from two directions drawn by the material and two by the light.
vec3 seen_all_around(float truth_share, vec3 n, vec3 wo) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 2; ++i) {
    vec4 u = even_numbers(2 * frame + i);
    sum += reflected(truth_share, n, light_direction(u.xy), wo);
    sum += reflected(truth_share, n, lobe_direction(truth_share, n, wo, u.zw), wo);
  }
  return 0.5 * sum;
}`;

// Shows the mean of frames that were added.
const shown_main = `
void main() { colour = on_display(texelFetch(added, ivec2(gl_FragCoord.xy), 0).rgb / float(frame)); }`;

// ---- environments ----------------------------------------------------------------------------------------------
// Rows are counted from the top, columns from the left.
function direction_in(rows, row, column) {
  const t = Math.PI * row / rows, l = Math.PI * column / rows - Math.PI;
  return [Math.sin(t) * Math.sin(l), Math.cos(t), -Math.sin(t) * Math.cos(l)];
}

// Returns a room with six windows. Outside is a sky; the sun is in one of the windows.
function room_with_windows(rows = 128) {
  const columns = 2 * rows, radiance = new Float32Array(3 * rows * columns), sun = [0.5, 0.6, 0.6245];
  const from_middle = (value, step) => Math.abs(value - step * Math.floor(value / step) - step / 2);
  for (let i = 0; i < rows * columns; ++i) {
    const d = direction_in(rows, Math.floor(i / columns) + 0.5, i % columns + 0.5), up = Math.asin(d[1]);
    const longitude = Math.atan2(d[0], d[2]), bar = from_middle(longitude, radians(60)) < radians(1) || Math.abs(up - radians(29)) < radians(1);
    const is_window = from_middle(longitude, radians(60)) < radians(19) && up > radians(8) && up < radians(50) && !bar;
    const glow = 60 * Math.exp(150 * (dot(d, sun) - 1));
    const wall = d[1] > -0.3 ? [0.2, 0.19, 0.17] : [0.13, 0.09, 0.06];
    radiance.set(is_window ? [1.7 - 0.9 * d[1] + glow, 2 - 0.8 * d[1] + 0.9 * glow, 2.4 - 0.4 * d[1] + 0.75 * glow] : wall, 3 * i);
  }
  return { rows, columns, radiance };
}

// Returns the shares by which the shader draws directions, and the mean luminance of a white Lambertian sphere, by
// which gonio render exposes, of a map as read_hdr returns it. O(pixels).
function light_of({ rows, columns, radiance }) {
  const pixels = new Float32Array(4 * rows * columns), reached = new Float32Array(4 * rows), sums = [];
  let total = 0, white = 0;
  for (let row = 0; row < rows; ++row) {
    const solid = 2 * Math.PI / rows * Math.sin(Math.PI * (row + 0.5) / rows) * Math.sin(Math.PI / 2 / rows);
    let sum = 0;
    for (let i = row * columns; i < (row + 1) * columns; ++i) {
      const rgb = radiance.subarray(3 * i, 3 * i + 3), light = luminance(rgb);
      pixels.set([...rgb, sum += light], 4 * i);
      white += light * solid * white_mean(angle_between(direction_in(rows, row + 0.5, i - row * columns + 0.5), [0, 0, 1])) / Math.PI;
    }
    for (let i = row * columns; i < (row + 1) * columns; ++i) pixels[4 * i + 3] = sum > 0 ? pixels[4 * i + 3] / sum : 1;
    sums.push(total += sum * solid);
  }
  sums.forEach((each, row) => { reached[4 * row + 3] = each / total; });
  return { rows, columns, pixels, reached, total, white };
}

// Returns the lobe of a table of read_table: four numbers, as the shader reads them, for equal steps of sqrt(theta_h).
function lobe_of_halves({ grid: [heights, ...others], texels }) {
  const count = others[0] * others[1], line = new Float32Array(4 * lobe_bins), means = [];
  for (let row = 0; row < heights; ++row) {
    let sum = 0, weight = 0;
    for (let i = 4 * row * count; i < 4 * (row + 1) * count; i += 4) {
      sum += luminance(texels.subarray(i, i + 3));
      weight += texels[i + 3];
    }
    means.push(sum / weight);
  }
  const squared = (bin) => Math.sin(Math.PI / 2 * (bin / lobe_bins) ** 2) ** 2;
  let total = 0;
  for (let bin = 0; bin < lobe_bins; ++bin) {
    const row = Math.floor(bin / lobe_bins * heights);
    line[4 * bin] = 0.5 * (means[row] + means[Math.min(row + 1, heights - 1)]);
    line[4 * bin + 3] = total += line[4 * bin] * (squared(bin + 1) - squared(bin));
  }
  return line.map((each, i) => (i % 4 === 0 ? each / (Math.PI * total) : each / total));
}

// ---- accumulation ----------------------------------------------------------------------------------------------
// Returns a texture of four floats per pixel, read without interpolation.
function float_texture(gl, unit, width, height, values) {
  const texture = gl.createTexture();
  if (Math.max(width, height) > gl.getParameter(gl.MAX_TEXTURE_SIZE)) throw new Error(`${width} x ${height} pixels are too many for this browser`);
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  return texture;
}

// Adds the frames of a view in an environment, in two textures by turns. Throws Error if the browser cannot.
class surrounded_view {
  constructor(view, { table, truth }) {
    const { gl } = view;
    if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("this browser cannot draw into floats");
    Object.assign(this, { view, gl, frame: 0, side: 0, made: [] });
    this.shown = view.made_of(vertex_shader, shown_main, [["corner", 2]], whole_image);
    [this.shown, view.image].forEach((each) => each.program(true));
    const lines = new Float32Array(8 * lobe_bins);
    [table, truth ?? table].forEach((each, i) => lines.set(lobe_of_halves(each), 4 * lobe_bins * i));
    float_texture(gl, 6, lobe_bins, 2, lines);
    this.take(room_with_windows());
  }

  // Changes the environment to `map`, as read_hdr returns it.
  take(map) {
    const { gl } = this, { rows, columns, pixels, reached, total, white } = light_of(map);
    const made = [float_texture(gl, 3, columns, rows, pixels), float_texture(gl, 4, rows, 1, reached)];
    this.made.forEach((each) => gl.deleteTexture(each));
    Object.assign(this, { made, total, white, frame: 0 });
  }

  resize(side) {
    const { gl } = this, depth = gl.createRenderbuffer();
    this.added?.forEach((each) => gl.deleteTexture(each));
    gl.deleteFramebuffer(this.target ?? null);
    gl.deleteRenderbuffer(this.depth ?? null);
    Object.assign(this, { side, depth });
    this.added = [0, 1].map(() => float_texture(gl, 5, side, side, null));
    this.target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, side, side);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  }

  // Adds a frame and shows the mean; `exposure` is the mean luminance of a white sphere before the light is turned.
  draw(state) {
    const { gl, view, total } = this;
    if (this.side !== view.canvas.width) this.resize(view.canvas.width);
    const [from, to] = this.frame % 2 ? this.added : [this.added[1], this.added[0]];
    const all = { ...state, exposure: state.exposure / this.white, samples: 1, known: false, frame: this.frame, total };
    gl.activeTexture(gl.TEXTURE5);
    gl.bindTexture(gl.TEXTURE_2D, from);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, to, 0);
    if (state.shape === "mesh" && view.mesh) view.draw({ ...all, shape: "none" }, view.image);
    view.draw(all, view.drawn_as(state.shape), state.shape === "mesh");
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_2D, to);
    view.draw({ ...all, frame: ++this.frame }, this.shown);
  }
}
