// The viewer of the page: the material on a sphere, a flat sample or a model under a light that is moved, in WebGL 2. A table is
// a texture over theta_h, theta_d and phi_d, read as gonio render reads one (include/gonio/render/horizon_lookup.hpp).

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

// sr^-1, of the fit or the truth, of directions above the horizon.
vec3 reflectance(bool is_truth, vec3 n, vec3 wi, vec3 wo) {
  vec3 at = grid_coordinates(n, wi, wo);
  vec4 read = is_truth ? texture(truth, at + truth_shift) * truth_scale : texture(values, at + values_shift) * values_scale;
  return read.rgb / read.a;
}`;

const vertex_shader = `#version 300 es
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }`;

// What is seen of a lit point.
const shading = `#version 300 es
precision highp float;
precision highp sampler3D;
uniform sampler3D values, truth, known;
uniform vec3 values_shift, truth_shift, light;
uniform vec4 values_scale, truth_scale;
uniform float exposure, size, border;  // right of the border the truth is shown
uniform bool shows_known, surrounded;
uniform sampler2D towards_light, weights, added;  // of light from all around, and the frames so far
uniform int frame;
uniform float around;
out vec4 colour;
${look_up}

struct lit_point { bool hit; vec3 n, wi, wo; float irradiance; };

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

float random(uvec3 v) {  // M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
  return float(v.x >> 8) / 16777216.0;
}

// Sixteen directions of the environment, one from each share of its light, added to the frames before.
vec3 seen_all_around(lit_point point, bool is_truth) {
  vec3 sum = texelFetch(added, ivec2(gl_FragCoord.xy), 0).rgb * (frame > 0 ? 1.0 : 0.0);
  if (!point.hit || dot(point.n, point.wo) <= 0.0) return sum;
  for (int i = 0; i < 16; ++i) {
    float share = (float(i) + random(uvec3(gl_FragCoord.xy, 16 * frame + i))) / 16.0;
    int at = min(int(share * 65536.0), 65535);
    vec3 d = texelFetch(towards_light, ivec2(at % 256, at / 256), 0).xyz;
    vec3 wi = vec3(cos(around) * d.x + sin(around) * d.z, d.y, cos(around) * d.z - sin(around) * d.x);
    float cosine = dot(point.n, wi);
    if (cosine <= 0.0) continue;
    vec3 weight = texelFetch(weights, ivec2(at % 256, at / 256), 0).rgb * 4096.0;
    sum += reflectance(is_truth, point.n, wi, point.wo) * weight * (cosine * exposure);
  }
  return sum;
}

// A white Lambertian surface that faces the light is 1, times the exposure.
vec3 seen(lit_point point, bool is_truth) {
  if (surrounded) return seen_all_around(point, is_truth);
  float cosine = dot(point.n, point.wi);
  if (!point.hit || cosine <= 0.0 || dot(point.n, point.wo) <= 0.0) return vec3(0.0);
  if (shows_known && !is_truth) {
    float level = texture(known, grid_coordinates(point.n, point.wi, point.wo)).r;
    return linear_light(colour_of_known(0.001 * pow(10.0, 4.0 * level)));
  }
  return reflectance(is_truth, point.n, point.wi, point.wo) * (pi * cosine * point.irradiance * exposure);
}`;

// The sphere fills the square and is seen by a camera at infinity, as gonio render draws it. The flat sample is seen
// from 50 degrees off its normal, under a lamp at three times half its width.
const image_main = `
uniform int samples, shape;  // 0: a sphere, 1: a flat sample

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

void main() {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < samples * samples; ++i) {
    vec2 within = (vec2(i % samples, i / samples) + 0.5) / float(samples);
    if (surrounded) within = fract(vec2(0.5) + float(frame) * vec2(0.75487767, 0.56984029));
    vec2 p = (floor(gl_FragCoord.xy) + within) / size * 2.0 - 1.0;
    if (shape == 0) sum += seen(sphere(p), p.x > border);
    else sum += seen(flat_sample(p), p.x > border);
  }
  if (surrounded) {
    colour = vec4(sum, 1.0);
    return;
  }
  colour = vec4(display_value(sum / float(samples * samples)), 1.0);
  if (abs(gl_FragCoord.x / size * 2.0 - 1.0 - border) < 1.5 / size) colour.rgb = vec3(0.6);
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
  if (Math.max(heights, rows, columns) > gl.getParameter(gl.MAX_3D_TEXTURE_SIZE)) throw new Error("the table is too large for WebGL");
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

// In the axes of the picture: x to the right, y up, z towards the viewer.
const light_direction = ({ longitude, latitude }) => [Math.sin(radians(longitude)) * Math.cos(radians(latitude)),
  Math.sin(radians(latitude)), Math.cos(radians(longitude)) * Math.cos(radians(latitude))];

class material_view {
  constructor(canvas, { table, truth, uncertainty }) {
    const gl = this.gl = canvas.getContext("webgl2");
    this.canvas = canvas;
    this.image = this.made_of(vertex_shader, image_main, [["corner", 2]], new Float32Array([-1, -1, 3, -1, -1, 3]));
    this.mesh = null;
    this.textures = [["values", table], ["truth", truth ?? table]].map(([name, { grid, shift, scale, texels }], unit) => {
      if (unit === 0 || truth) texture_of(gl, unit, grid, gl.RGBA16F, gl.RGBA, gl.FLOAT, texels);
      const [heights, rows, columns] = grid;
      return { name, unit: truth ? unit : 0, scale, shift: [columns, rows, heights].map((count) => shift / count) };
    });
    texture_of(gl, 2, uncertainty.grid, gl.R8, gl.RED, gl.UNSIGNED_BYTE, uncertainty.levels);
  }

  // A program, and corners of triangles with attributes of so many numbers.
  made_of(vertex, main, attributes, numbers) {
    const { gl } = this, program = program_of(gl, vertex, shading + main), corners = gl.createVertexArray();
    const size = attributes.reduce((sum, [, count]) => sum + count, 0);
    gl.bindVertexArray(corners);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
    attributes.reduce((offset, [name, count]) => {
      const at = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, count, gl.FLOAT, false, 4 * size, offset);
      return offset + 4 * count;
    }, 0);
    return { program, corners, count: numbers.length / size };
  }

  // `vertices` as read_obj returns them.
  take_mesh(vertices) { this.mesh = this.made_of(mesh_vertex_shader, mesh_main, [["place", 3], ["towards", 3]], vertices); }

  // `samples` of a pixel along each axis; `truth` is the share of the image that shows it, in percent.
  draw({ longitude, latitude, exposure, shape, known, samples, truth = 0, turn = 0, frame = 0, surrounded = false }, drawn) {
    const { gl, canvas } = this, { program, corners, count } = drawn ?? (shape === "mesh" && this.mesh ? this.mesh : this.image);
    const at = (name) => gl.getUniformLocation(program, name);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program);
    gl.bindVertexArray(corners);
    for (const { name, unit, scale, shift } of this.textures) {
      gl.uniform1i(at(name), unit);
      gl.uniform3f(at(`${name}_shift`), ...shift);
      gl.uniform4f(at(`${name}_scale`), scale, scale, scale, 1);
    }
    ["known", "towards_light", "weights", "added"].forEach((name, i) => gl.uniform1i(at(name), 2 + i));
    gl.uniform1i(at("surrounded"), surrounded);
    gl.uniform1i(at("frame"), frame);
    gl.uniform1f(at("around"), radians(longitude));
    gl.uniform3f(at("light"), ...light_direction({ longitude, latitude }));
    gl.uniform1f(at("exposure"), exposure);
    gl.uniform1f(at("size"), canvas.width);
    gl.uniform1f(at("border"), truth > 0 ? 1 - 0.02 * truth : 9);
    gl.uniform1i(at("shows_known"), known);
    gl.uniform1f(at("turn"), radians(turn));
    gl.uniform1i(at("samples"), samples);
    gl.uniform1i(at("shape"), shape === "flat" ? 1 : 0);
    gl.drawArrays(gl.TRIANGLES, 0, count);
  }
}

// ---- the section of the page -----------------------------------------------------------------------------------
// What the controls say, what is drawn by it, and the drawing of one image with so many samples a pixel.
const viewer = {
  state: { light: "lamp", longitude: 45, latitude: 35.26, stops: 0, shape: "sphere", known: false, turn: 0, truth: data.viewer?.truth ? 50 : 0 },
  view: null,
  surrounded: null,
  draw: null,
};

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
  let change = 0;
  const converge = (mine) => {
    if (mine !== change || viewer.surrounded.frame >= last_frame) return;
    viewer.surrounded.draw({ ...viewer.state, exposure: 0.4 * 2 ** viewer.state.stops });
    requestAnimationFrame(() => converge(mine));
  };
  return () => {
    clearTimeout(waiting);
    const mine = ++change;
    if (viewer.state.light === "environment" && viewer.surrounded && !viewer.state.known) {
      viewer.surrounded.frame = 0;
      requestAnimationFrame(() => converge(mine));
      return;
    }
    requestAnimationFrame(() => { if (mine === change) drawn(1); });
    waiting = setTimeout(() => requestAnimationFrame(() => drawn(3)), 150);
  };
}

const turned = (degrees) => ((degrees + 540) % 360) - 180;
function move_light(by_longitude, by_latitude) {
  viewer.state.longitude = turned(viewer.state.longitude + by_longitude);
  viewer.state.latitude = Math.max(-90, Math.min(90, viewer.state.latitude + by_latitude));
}

// Calls move(degrees to the right, degrees up) when arrow keys are pressed or the pointer drags.
function moved_by_hand(canvas, move) {
  const steps = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] };
  canvas.addEventListener("keydown", (event) => {
    if (!steps[event.key]) return;
    event.preventDefault();
    move(...steps[event.key]);
  });
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (canvas.hasPointerCapture(event.pointerId)) move(0.5 * event.movementX, -0.5 * event.movementY);
  });
}

// The normal that the pointer is over, of the sphere; nothing beside it.
function normal_at(event, canvas) {
  const box = canvas.getBoundingClientRect();
  const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
  return viewer.state.shape === "sphere" && x * x + y * y < 1 ? [x, y, Math.sqrt(1 - x * x - y * y)] : null;
}

// What the material reflects there.
function told_at(n, table, uncertainty, is_truth) {
  const wi = light_direction(viewer.state), wo = [0, 0, 1], degrees = (a) => angle(angle_between(n, a) * 180 / Math.PI);
  if (dot(n, wi) <= 0) return `theta_i ${degrees(wi)}: no light`;
  return `theta_i ${degrees(wi)}, theta_o ${degrees(wo)}: ${channels(reflectance_at(table, n, wi, wo))} sr\u207b\u00b9, ` +
    (is_truth ? "the truth" : `known to ${percent(uncertainty_at(uncertainty, n, wi, wo))}`);
}

function choice(label, key, options, changed) {
  const select = element("select", {}, ...options.map(([value, name]) => element("option", { value }, name)));
  select.addEventListener("input", () => { viewer.state[key] = select.value; changed(); });
  return element("label", {}, element("span", {}, label), select);
}

// A file of the reader's own, and a slider that turns it; both are shown while a model is.
function model_rows(changed) {
  const input = element("input", { type: "file", accept: ".obj" }), problem = element("output");
  input.addEventListener("change", async () => {
    problem.textContent = "";
    try {
      if (input.files.length) viewer.view.take_mesh(read_obj(await input.files[0].text()));
    } catch (error) {
      problem.textContent = `not a model: ${error.message}`;
    }
    changed();
  });
  const turn = slider("Turned by", "turn", [-180, 180, 1], (value) => `${value}\u00b0`, changed);
  return { rows: [element("label", {}, element("span", {}, "File (.obj)"), input, problem), turn.row], show: turn.show };
}

// A lamp, or an environment: a sky, or a light probe of the reader's own.
function light_rows(changed) {
  const input = element("input", { type: "file", accept: ".hdr" }), problem = element("output");
  const attempt = async (what) => {
    problem.textContent = "";
    try {
      await what();
    } catch (error) {
      problem.textContent = `no such light: ${error.message}`;
    }
    changed();
  };
  input.addEventListener("change", () => attempt(async () => {
    if (input.files.length) viewer.surrounded.take(read_hdr(new Uint8Array(await input.files[0].arrayBuffer())));
  }));
  const lights = choice("Light", "light", [["lamp", "a lamp"], ["environment", "from all around"]], () => attempt(() => {
    if (viewer.state.light === "environment") viewer.surrounded ??= new surrounded_view(viewer.view);
  }));
  const file = element("label", {}, element("span", {}, "Light probe (.hdr)"), input);
  return { rows: [lights, file, problem], show: () => { file.hidden = viewer.state.light !== "environment"; } };
}

function controls(changed) {
  const degrees = (value) => `${Math.round(value)}\u00b0`;
  const sliders = [
    slider("Light, to the right", "longitude", [-180, 180, 1], degrees, changed),
    slider("Light, upwards", "latitude", [-90, 90, 1], degrees, changed),
    slider("Exposure", "stops", [-6, 6, 0.25], (value) => `${value > 0 ? "+" : ""}${value} stops`, changed)];
  if (data.viewer.truth) sliders.push(slider("Truth, from the right", "truth", [0, 100, 1], (value) => `${value} %`, changed));
  const model = model_rows(changed), light = light_rows(changed);
  const known = element("input", { type: "checkbox" });
  known.addEventListener("input", () => { viewer.state.known = known.checked; changed(); });
  const legend = element("p", { className: "legend soft" }, "2 %", element("span", { className: "ramp" }), "100 %");
  return {
    box: element("div", { className: "controls" },
      choice("Shape", "shape", [["sphere", "sphere"], ["flat", "flat sample"], ["mesh", "a model"]], changed), ...model.rows,
      ...light.rows, ...sliders.map((each) => each.row),
      element("label", {}, element("span", {}, "Uncertainty"), known), legend),
    show: () => {
      [...sliders, model, light].forEach((each) => each.show());
      model.rows.forEach((each) => { each.hidden = viewer.state.shape !== "mesh"; });
      legend.hidden = !viewer.state.known;
    },
  };
}

async function fill_viewer(section) {
  const canvas = element("canvas", { width: 512, height: 512, tabIndex: 0 });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The material under a light, which arrow keys move");
  if (!canvas.getContext("webgl2", { alpha: false })) throw new Error("this browser has no WebGL 2");
  if (typeof DecompressionStream === "undefined") throw new Error("this browser cannot unpack tables");
  const table = await read_table(data.viewer.table);
  const uncertainty = { grid: data.viewer.uncertainty.grid, levels: await inflated(data.viewer.uncertainty.codes) };
  const truth = data.viewer.truth ? await read_table(data.viewer.truth) : null;
  viewer.view = new material_view(canvas, { table, truth, uncertainty });
  const start = angle_between(light_direction(viewer.state), [0, 0, 1]);
  const redraw = redraw_with(viewer.view, data.viewer.exposure / white_mean(start));
  const panel = controls(() => changed()), lobe = lobe_figure(table, uncertainty);
  const changed = () => {
    panel.show();
    redraw();
    lobe.draw({ known: viewer.state.known });
  };
  const readout = element("p", { className: "soft readout" });
  canvas.addEventListener("pointermove", (event) => {
    const n = normal_at(event, canvas);
    const is_truth = n !== null && n[0] > 1 - 0.02 * viewer.state.truth;
    readout.textContent = n ? told_at(n, is_truth ? truth : table, uncertainty, is_truth) : "";
    const theta_i = n ? angle_between(n, light_direction(viewer.state)) : Math.PI;
    if (theta_i < radians(89)) lobe.draw({ theta_i });
  });
  moved_by_hand(canvas, (right, up) => { move_light(right, up); changed(); });
  panel.box.append(lobe.box);
  section.append(paragraph("Drag, or use the arrow keys, to move the light. A pointer over the sphere reads the BRDF there, and shows its lobe."),
    element("div", { className: "viewer" }, element("div", {}, canvas, readout), panel.box));
  changed();
}

async function show_viewer() {
  const section = element("section", { className: "screen-only" }, element("h2", {}, "Under a light"));
  add(section);
  try {
    await fill_viewer(section);
  } catch (error) {
    section.append(paragraph(`No light can be moved here: ${error.message}. The image above shows the material.`, "no-viewer"));
  }
}

