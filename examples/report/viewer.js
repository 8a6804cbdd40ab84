// The viewer of the page: the material on a sphere or a flat sample under a light that is moved, in WebGL 2. A table is
// a texture over theta_h, theta_d and phi_d, read as gonio render reads one (include/gonio/render/horizon_lookup.hpp).
"use strict";

// ---- tables ----------------------------------------------------------------------------------------------------
// Bytes of base64 text that were deflated.
async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
}

// A half float of which two bits were dropped.
function half_of(code) {
  const exponent = code >> 8, fraction = (code & 255) / 256;
  return exponent === 0 ? fraction * 2 ** -14 : (1 + fraction) * 2 ** (exponent - 15);
}

// Calls visit(cell of the grid, its valid cell, cos theta_i cos theta_o there) for all cells: beyond the horizon the
// valid cell is that of the largest theta_h. Returns how many cells are valid.
function for_each_cell({ grid: [heights, rows, columns], offset, minimum_cosine }, visit) {
  const angle = (i, count, end) => ((i + offset) / count) * end, quarter = Math.PI / 2;
  const cos_phi = Array.from({ length: columns }, (_, i) => Math.cos(angle(i, columns, Math.PI)));
  const last = new Int32Array(rows * columns), cosines = new Float64Array(rows * columns);
  let valid = 0;
  for (let h = 0, cell = 0; h < heights; ++h) {
    const theta_h = quarter * ((h + offset) / heights) ** 2;
    for (let column = 0; column < rows * columns; ++column, ++cell) {
      const theta_d = angle(Math.floor(column / columns), rows, quarter);
      const sum = Math.cos(theta_h) * Math.cos(theta_d);
      const difference = Math.sin(theta_h) * Math.sin(theta_d) * cos_phi[column % columns];
      if (sum - Math.abs(difference) > minimum_cosine) {
        last[column] = valid++;
        cosines[column] = (sum - difference) * (sum + difference);
      }
      visit(cell, last[column], cosines[column]);
    }
  }
  return valid;
}

// Red, green, blue and one, times both cosines: a look-up interpolates these and divides by the last, so that a cell
// near the horizon counts by what it reflects. The one is times 2^14, so that half floats can hold it.
async function read_table(packed) {
  const bytes = await inflated(packed.codes), count = 3 * packed.cells;
  const values = new Float32Array(count), halves = Float32Array.from({ length: 8192 }, (_, code) => half_of(code));
  for (let channel = 0, i = 0; channel < 3; ++channel)
    for (let cell = 0, code = 0; cell < packed.cells; ++cell, ++i) {
      const folded = bytes[i] + 256 * bytes[count + i];
      code += folded & 1 ? -(folded + 1) / 2 : folded / 2;
      values[3 * cell + channel] = halves[code];
    }
  const texels = new Float32Array(4 * packed.grid.reduce((a, b) => a * b));
  const valid = for_each_cell(packed, (cell, number, cosines) => {
    const weight = Math.max(cosines, 1e-9);
    for (let channel = 0; channel < 3; ++channel) texels[4 * cell + channel] = values[3 * number + channel] * weight;
    texels[4 * cell + 3] = 16384 * weight;
  });
  if (valid !== packed.cells) throw new Error(`a table of ${packed.cells} cells has ${valid} above the horizon`);
  return { grid: packed.grid, shift: 0.5 - packed.offset, scale: 16384 * packed.scale, texels };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (a, b, share) => a.map((each, i) => each + share * b[i]);
const length = (a) => Math.sqrt(dot(a, a));
const angle_between = (a, b) => Math.atan2(length(cross(a, b)), dot(a, b));

// Shares of the way along the axes of theta_h, theta_d and phi_d.
function grid_coordinates(n, wi, wo) {
  const sum = along(wi, wo, 1), difference = along(wi, wo, -1), size = length(sum);
  const phi_d = Math.atan2(dot(n, cross(sum, difference)), -dot(n, difference) * size) / Math.PI;
  return [Math.sqrt(angle_between(n, sum) * 2 / Math.PI), Math.atan2(length(difference), size) * 2 / Math.PI, phi_d - Math.floor(phi_d)];
}

// Red, green and blue in sr^-1: the mean of the eight cells around.
function reflectance_at({ grid, shift, scale, texels }, n, wi, wo) {
  if (!(dot(n, wi) > 0 && dot(n, wo) > 0)) return [0, 0, 0];
  const places = grid_coordinates(n, wi, wo).map((share, i) => share * grid[i] + shift - 0.5);
  const lower = places.map(Math.floor), sum = [0, 0, 0, 0];
  for (let corner = 0; corner < 8; ++corner) {
    let weight = 1;
    const [h, d, p] = lower.map((each, i) => {
      const upper = (corner >> i) & 1, share = places[i] - each;
      weight *= upper ? share : 1 - share;
      return i === 2 ? (each + upper + grid[2]) % grid[2] : Math.min(Math.max(each + upper, 0), grid[i] - 1);
    });
    for (let k = 0, at = 4 * ((h * grid[1] + d) * grid[2] + p); k < 4; ++k) sum[k] += weight * texels[at + k];
  }
  return sum.slice(0, 3).map((each) => each / sum[3] * scale);
}

// Of a share from 0.001 to 10, as the tool wrote it.
const uncertainty_of = (level) => 0.001 * 10 ** (4 * level);
function uncertainty_at({ grid, levels }, n, wi, wo) {
  const [h, d, p] = grid_coordinates(n, wi, wo).map((share, i) => Math.min(Math.floor(share * grid[i]), grid[i] - 1));
  return uncertainty_of(levels[(h * grid[1] + d) * grid[2] + p] / 255);
}

// ---- shaders ---------------------------------------------------------------------------------------------------
const look_up = `
const float pi = 3.14159265358979;

// Shares of the way along phi_d, theta_d and theta_h's axes, of directions above a surface with normal n: the same as
// include/gonio/render/grid_coordinates.hpp has, in any frame.
vec3 grid_coordinates(vec3 n, vec3 wi, vec3 wo) {
  vec3 sum = wi + wo, difference = wi - wo;
  float size = length(sum), x = -dot(n, difference) * size, y = dot(n, cross(sum, difference));
  float phi_d = x == 0.0 && y == 0.0 ? 0.0 : fract(atan(y, x) / pi);
  float theta_d = atan(length(difference), size), theta_h = atan(length(cross(n, sum)), dot(n, sum));
  return vec3(phi_d, theta_d * 2.0 / pi, sqrt(theta_h * 2.0 / pi));
}

// sr^-1; zero below the horizon.
vec3 reflectance(vec3 n, vec3 wi, vec3 wo) {
  if (dot(n, wi) <= 0.0 || dot(n, wo) <= 0.0) return vec3(0.0);
  vec4 read = texture(values, grid_coordinates(n, wi, wo) + shift);
  return read.rgb / read.a * scale;
}`;

const vertex_shader = `#version 300 es
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }`;

// The sphere fills the square and is seen by a camera at infinity, as gonio render draws it. The flat sample is seen
// from 50 degrees off its normal, under a lamp at three times half its width.
const fragment_shader = `#version 300 es
precision highp float;
precision highp sampler3D;
uniform sampler3D values, known;
uniform vec3 shift, light;
uniform float scale, exposure, size;
uniform int samples, shape;  // 0: a sphere, 1: a flat sample
uniform bool shows_known;
out vec4 colour;
${look_up}

struct lit_point { bool hit; vec3 n, wi, wo; float irradiance; };

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

// As the map of the page: light is 2 %, dark 100 %.
vec3 colour_of_known(float share) {
  float t = clamp(log(max(share, 1e-6) / 0.02) / log(50.0), 0.0, 1.0);
  return mix(vec3(243.0, 236.0, 210.0), vec3(18.0, 58.0, 99.0), t) / 255.0;
}
vec3 linear_light(vec3 v) { return mix(v / 12.92, pow((v + 0.055) / 1.055, vec3(2.4)), step(0.04045, v)); }
vec3 display_value(vec3 v) {
  v = clamp(v, 0.0, 1.0);
  return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, v));
}

// A white Lambertian surface that faces the light is 1, times the exposure.
vec3 seen(lit_point point) {
  float cosine = dot(point.n, point.wi);
  if (!point.hit || cosine <= 0.0) return vec3(0.0);
  if (shows_known) {
    float level = texture(known, grid_coordinates(point.n, point.wi, point.wo)).r;
    return linear_light(colour_of_known(0.001 * pow(10.0, 4.0 * level)));
  }
  return reflectance(point.n, point.wi, point.wo) * (pi * cosine * point.irradiance * exposure);
}

void main() {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < samples * samples; ++i) {
    vec2 within = (vec2(i % samples, i / samples) + 0.5) / float(samples);
    vec2 p = (floor(gl_FragCoord.xy) + within) / size * 2.0 - 1.0;
    if (shape == 0) sum += seen(sphere(p));
    else sum += seen(flat_sample(p));
  }
  colour = vec4(display_value(sum / float(samples * samples)), 1.0);
}`;

// ---- WebGL -----------------------------------------------------------------------------------------------------
function program_of(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

// Over phi_d, which wraps, theta_d and theta_h, which end with their first and last nodes.
function texture_of(gl, unit, [heights, rows, columns], internal, format, type, values) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_3D, gl.createTexture());
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage3D(gl.TEXTURE_3D, 0, internal, columns, rows, heights, 0, format, type, values);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_WRAP_R, gl.CLAMP_TO_EDGE);
}

// The mean of what a white Lambertian sphere shows, by the angle between light and camera, if a surface that faces the
// light shows 1: by it gonio render exposes.
const white_mean = (angle) => (2 / (3 * Math.PI)) * (Math.sin(angle) + (Math.PI - angle) * Math.cos(angle));

const radians = (degrees) => degrees * Math.PI / 180;
// In the axes of the picture: x to the right, y up, z towards the viewer.
const light_direction = ({ longitude, latitude }) => [Math.sin(radians(longitude)) * Math.cos(radians(latitude)),
  Math.sin(radians(latitude)), Math.cos(radians(longitude)) * Math.cos(radians(latitude))];

class material_view {
  constructor(canvas, table, uncertainty) {
    const gl = this.gl = canvas.getContext("webgl2", { alpha: false, antialias: false });
    this.canvas = canvas;
    this.program = program_of(gl, vertex_shader, fragment_shader);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 3, -1, -1, 3]), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(gl.getAttribLocation(this.program, "corner"));
    gl.vertexAttribPointer(gl.getAttribLocation(this.program, "corner"), 2, gl.FLOAT, false, 0, 0);
    texture_of(gl, 0, table.grid, gl.RGBA16F, gl.RGBA, gl.FLOAT, table.texels);
    texture_of(gl, 1, uncertainty.grid, gl.R8, gl.RED, gl.UNSIGNED_BYTE, uncertainty.levels);
    gl.useProgram(this.program);
    const [heights, rows, columns] = table.grid;
    gl.uniform1i(this.at("values"), 0);
    gl.uniform1i(this.at("known"), 1);
    gl.uniform3f(this.at("shift"), table.shift / columns, table.shift / rows, table.shift / heights);
    gl.uniform1f(this.at("scale"), table.scale);
  }

  at(name) { return this.gl.getUniformLocation(this.program, name); }

  // `samples` of a pixel along each axis.
  draw({ longitude, latitude, exposure, shape, known, samples }) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.uniform3f(this.at("light"), ...light_direction({ longitude, latitude }));
    gl.uniform1f(this.at("exposure"), exposure);
    gl.uniform1f(this.at("size"), canvas.width);
    gl.uniform1i(this.at("samples"), samples);
    gl.uniform1i(this.at("shape"), shape === "sphere" ? 0 : 1);
    gl.uniform1i(this.at("shows_known"), known);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}

// ---- the section of the page -----------------------------------------------------------------------------------
const viewer = { state: { longitude: 45, latitude: 35.26, stops: 0, shape: "sphere", known: false }, view: null, draw() {} };

function slider(label, key, [min, max, step], told, changed) {
  const output = element("output");
  const input = element("input", { type: "range", min, max, step, value: viewer.state[key] });
  const show = () => { input.value = viewer.state[key]; output.textContent = told(viewer.state[key]); };
  input.addEventListener("input", () => { viewer.state[key] = Number(input.value); changed(); });
  return { show, row: element("label", {}, element("span", {}, label), input, output) };
}

// Draws now with one sample a pixel, and with nine when nothing has moved for a while.
function redraw_with(view, base) {
  let waiting = 0;
  const drawn = (samples) => view.draw({ ...viewer.state, exposure: base * 2 ** viewer.state.stops, samples });
  viewer.draw = drawn;
  return () => {
    requestAnimationFrame(() => drawn(1));
    clearTimeout(waiting);
    waiting = setTimeout(() => requestAnimationFrame(() => drawn(3)), 150);
  };
}

const turned = (degrees) => ((degrees + 540) % 360) - 180;
function move_light(by_longitude, by_latitude) {
  viewer.state.longitude = turned(viewer.state.longitude + by_longitude);
  viewer.state.latitude = Math.max(-90, Math.min(90, viewer.state.latitude + by_latitude));
}

function moved_by_hand(canvas, changed) {
  const steps = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] };
  canvas.addEventListener("keydown", (event) => {
    if (!steps[event.key]) return;
    event.preventDefault();
    move_light(...steps[event.key]);
    changed();
  });
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (!canvas.hasPointerCapture(event.pointerId)) return;
    move_light(0.5 * event.movementX, -0.5 * event.movementY);
    changed();
  });
}

// What the material reflects at the pointer, of the sphere.
function told_at(event, canvas, table, uncertainty) {
  const box = canvas.getBoundingClientRect();
  const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
  const n = [x, y, Math.sqrt(1 - x * x - y * y)], wi = light_direction(viewer.state), wo = [0, 0, 1];
  if (viewer.state.shape !== "sphere" || !(n[2] > 0)) return "";
  const degrees = (a) => angle(angle_between(n, a) * 180 / Math.PI);
  if (dot(n, wi) <= 0) return `theta_i ${degrees(wi)}: no light`;
  return `theta_i ${degrees(wi)}, theta_o ${degrees(wo)}: ${channels(reflectance_at(table, n, wi, wo))} sr\u207b\u00b9, ` +
    `known to ${percent(uncertainty_at(uncertainty, n, wi, wo))}`;
}

function choice(label, key, options, changed) {
  const select = element("select", {}, ...options.map(([value, name]) => element("option", { value }, name)));
  select.addEventListener("input", () => { viewer.state[key] = select.value; changed(); });
  return element("label", {}, element("span", {}, label), select);
}

function controls(changed) {
  const degrees = (value) => `${Math.round(value)}\u00b0`;
  const sliders = [
    slider("Light, to the right", "longitude", [-180, 180, 1], degrees, changed),
    slider("Light, upwards", "latitude", [-90, 90, 1], degrees, changed),
    slider("Exposure", "stops", [-6, 6, 0.25], (value) => `${value > 0 ? "+" : ""}${value} stops`, changed)];
  const known = element("input", { type: "checkbox" });
  known.addEventListener("input", () => { viewer.state.known = known.checked; changed(); });
  const legend = element("p", { className: "legend soft" }, "2 %", element("span", { className: "ramp" }), "100 %");
  return {
    box: element("div", { className: "controls" },
      choice("Shape", "shape", [["sphere", "sphere"], ["flat", "flat sample"]], changed), ...sliders.map((each) => each.row),
      element("label", {}, element("span", {}, "How well directions are known"), known), legend),
    show: () => {
      sliders.forEach((each) => each.show());
      legend.hidden = !viewer.state.known;
    },
  };
}

async function show_viewer() {
  const canvas = element("canvas", { width: 512, height: 512, tabIndex: 0 });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The material under a light, which arrow keys move");
  const section = element("section", { className: "screen-only" }, element("h2", {}, "Under a light"));
  add(section);
  if (!canvas.getContext("webgl2") || typeof DecompressionStream === "undefined") {
    section.append(paragraph("This browser has no WebGL 2, without which no light can be moved. The image above shows the material.", "no-viewer"));
    return;
  }
  const table = await read_table(data.viewer.table);
  const uncertainty = { grid: data.viewer.uncertainty.grid, levels: await inflated(data.viewer.uncertainty.codes) };
  viewer.view = new material_view(canvas, table, uncertainty);
  const start = angle_between(light_direction(viewer.state), [0, 0, 1]);
  const redraw = redraw_with(viewer.view, data.viewer.exposure / white_mean(start));
  const panel = controls(() => changed());
  const changed = () => { panel.show(); redraw(); };
  const readout = element("p", { className: "soft readout" });
  canvas.addEventListener("pointermove", (event) => { readout.textContent = told_at(event, canvas, table, uncertainty); });
  moved_by_hand(canvas, changed);
  section.append(paragraph("Drag, or use the arrow keys, to move the light. A pointer over the sphere reads the BRDF."),
    element("div", { className: "viewer" }, element("div", {}, canvas, readout), panel.box));
  changed();
}
