
// The viewer of the page: draws the material on a sphere, a flat sample or a model under a movable light, in WebGL 2,
// and reads the BRDF under the pointer. shading.js and environment.js have the shaders, controls.js has the controls.

// ---- WebGL -----------------------------------------------------------------------------------------------------
function program_of(gl, vertex, fragment, attributes) {
  const program = gl.createProgram();
  attributes.forEach(([name], at) => gl.bindAttribLocation(program, at, name));
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

// Makes a texture over phi_d, which wraps, and theta_d and theta_h, which end with their first and last nodes.
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

// Returns the mean luminance of a white Lambertian sphere by the angle between light and camera, if a surface that
// faces the light has luminance 1. gonio render exposes by this mean.
const white_mean = (angle) => (2 / (3 * Math.PI)) * (Math.sin(angle) + (Math.PI - angle) * Math.cos(angle));

// Returns a direction in the axes of the image: x to the right, y up, z towards the viewer.
const light_direction = ({ longitude, latitude }) => [Math.sin(radians(longitude)) * Math.cos(radians(latitude)),
  Math.sin(radians(latitude)), Math.cos(radians(longitude)) * Math.cos(radians(latitude))];

class material_view {
  constructor(canvas, { table, truth, uncertainty }) {
    const gl = this.gl = canvas.getContext("webgl2");
    this.canvas = canvas;
    this.image = this.made_of(vertex_shader, image_main, [["corner", 2]], whole_image);
    this.image.program(false); // throws Error if the browser cannot compile it
    this.mesh = null;
    this.textures = [["values", table], ["truth", truth ?? table]].map(([name, { grid, shift, scale, texels }], unit) => {
      if (unit === 0 || truth) texture_of(gl, unit, grid, gl.RGBA16F, gl.RGBA, gl.FLOAT, texels);
      const [heights, rows, columns] = grid;
      return { name, unit: truth ? unit : 0, scale, shift: [columns, rows, heights].map((count) => shift / count) };
    });
    texture_of(gl, 2, uncertainty.grid, gl.R8, gl.RED, gl.UNSIGNED_BYTE, uncertainty.levels);
  }

  // Returns corners of triangles and the programs that draw them, made at first use. `attributes` are pairs of a name
  // and a count of numbers per corner.
  made_of(vertex, main, attributes, numbers) {
    const { gl } = this, programs = {}, corners = gl.createVertexArray();
    const program = (surrounded) => programs[surrounded] ??= program_of(gl, vertex, shading(surrounded) + main, attributes);
    const size = attributes.reduce((sum, [, count]) => sum + count, 0);
    gl.bindVertexArray(corners);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
    attributes.reduce((offset, [, count], at) => {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, count, gl.FLOAT, false, 4 * size, offset);
      return offset + 4 * count;
    }, 0);
    return { program, corners, count: numbers.length / size };
  }

  // Changes the model to `vertices`, as read_obj returns them.
  take_mesh(vertices) { this.mesh = this.made_of(mesh_vertex_shader, mesh_main, [["position", 3], ["towards", 3]], vertices); }

  drawn_as(shape) { return shape === "mesh" && this.mesh ? this.mesh : this.image; }

  // Draws a state with `samples` along each axis of a pixel. `truth` is the percentage of the image that shows the
  // truth or, if the state `blends`, the truth's share in the whole image. With `total`, the light of an environment,
  // adds a frame to the others. With `keeps`, draws over the present image.
  draw(state, drawn = this.drawn_as(state.shape), keeps = false) {
    const { gl, canvas } = this, { truth = 0, blends = false, frame = 0, total = 0 } = state;
    const program = drawn.program(total > 0);
    const at = (name) => gl.getUniformLocation(program, name);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT | (keeps ? 0 : gl.COLOR_BUFFER_BIT));
    gl.useProgram(program);
    gl.bindVertexArray(drawn.corners);
    for (const { name, unit, scale, shift } of this.textures) {
      gl.uniform1i(at(name), unit);
      gl.uniform3f(at(`${name}_shift`), ...shift);
      gl.uniform4f(at(`${name}_scale`), scale, scale, scale, 1);
    }
    ["known", "surroundings", "rows", "added", "lobes"].forEach((name, i) => gl.uniform1i(at(name), 2 + i));
    gl.uniform1i(at("frame"), frame);
    gl.uniform1f(at("total_light"), total);
    gl.uniform2f(at("within_pixel"), ...[0.75487767, 0.56984029].map((step) => (total > 0 ? (0.5 + frame * step) % 1 : 0.5)));
    gl.uniform1f(at("around"), radians(state.around ?? 0));
    gl.uniform3f(at("light"), ...light_direction(state));
    gl.uniform1f(at("exposure"), state.exposure);
    gl.uniform1f(at("size"), canvas.width);
    gl.uniform1f(at("border"), truth > 0 && !blends ? 1 - 0.02 * truth : 9);
    gl.uniform1f(at("blend"), blends ? truth / 100 : 0);
    gl.uniform1i(at("shows_known"), state.known);
    gl.uniform1f(at("turn"), radians(state.turn ?? 0));
    gl.uniform1i(at("samples"), state.samples);
    gl.uniform1i(at("shape"), Math.max(0, ["sphere", "flat", "none"].indexOf(state.shape)));
    gl.drawArrays(gl.TRIANGLES, 0, drawn.count);
  }
}
// ---- the section of the page -----------------------------------------------------------------------------------
// The state of the controls, the views under the lamp and in an environment, and a function that draws one image with
// `samples` along each axis of a pixel.
const viewer = {
  state: { light: "lamp", longitude: 45, latitude: 35.26, around: 0, stops: 0, shape: "sphere", known: false, turn: 0,
    truth: data.viewer?.truth ? 50 : 0, blends: false },
  view: null,
  surrounded: null,
  draw: null,
};
const is_surrounded = () => viewer.state.light === "environment";
const exposure_in_environment = 0.4;  // as gonio render has it

// Returns a function that draws again: under the lamp now with one sample per pixel, and with nine after 150 ms without
// a change; in an environment by adding frames.
function redraw_with(view, base) {
  let waiting = 0, change = 0;
  const exposed = (base) => ({ ...viewer.state, exposure: base * 2 ** viewer.state.stops });
  viewer.draw = (samples) => view.draw({ ...exposed(base), samples });
  const add_frames = (mine) => {
    if (mine !== change || viewer.surrounded.frame >= last_frame) return;
    viewer.surrounded.draw(exposed(exposure_in_environment));
    requestAnimationFrame(() => add_frames(mine));
  };
  return () => {
    clearTimeout(waiting);
    const mine = ++change;
    if (is_surrounded()) {
      viewer.surrounded.frame = 0;
      requestAnimationFrame(() => add_frames(mine));
      return;
    }
    requestAnimationFrame(() => { if (mine === change) viewer.draw(1); });
    waiting = setTimeout(() => requestAnimationFrame(() => { if (mine === change) viewer.draw(3); }), 150);
  };
}

const turned = (degrees) => ((degrees + 540) % 360) - 180;
function move_light(by_longitude, by_latitude) {
  const key = is_surrounded() ? "around" : "longitude";
  viewer.state[key] = turned(viewer.state[key] + by_longitude);
  if (!is_surrounded()) viewer.state.latitude = Math.max(-90, Math.min(90, viewer.state.latitude + by_latitude));
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

// Returns the sphere's normal under the pointer; null beside the sphere.
function normal_at(event, canvas) {
  const box = canvas.getBoundingClientRect();
  const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
  return viewer.state.shape === "sphere" && x * x + y * y < 1 ? [x, y, Math.sqrt(1 - x * x - y * y)] : null;
}

// Returns the truth's share at a point of the image, from 0 to 1.
function truth_share_at([x]) {
  const { truth, blends } = viewer.state;
  if (blends) return truth / 100;
  return truth > 0 && x > 1 - 0.02 * truth ? 1 : 0;
}

// Returns a text on the reflectance at a point of the image and its uncertainty.
function told_at(n, reflects, uncertainty) {
  const wi = light_direction(viewer.state), wo = [0, 0, 1], degrees = (a) => angle(angle_between(n, a) * 180 / Math.PI);
  if (is_surrounded()) return `theta_o ${degrees(wo)}: light from all around, by the lobe`;
  if (dot(n, wi) <= 0) return `theta_i ${degrees(wi)}: no light`;
  const share = truth_share_at(n), known = `known to ${percent(uncertainty_at(uncertainty, n, wi, wo))}`;
  return `theta_i ${degrees(wi)}, theta_o ${degrees(wo)}: ${channels(reflects(share, n, wi, wo))} sr\u207b\u00b9, ` +
    (share === 0 ? known : share === 1 ? "the truth" : `${percent(share)} the truth`);
}

// Returns a canvas for the viewer. Throws Error if the browser has no WebGL 2.
function lit_canvas(description) {
  const canvas = element("canvas", { width: 512, height: 512, tabIndex: 0 });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", description);
  if (!canvas.getContext("webgl2", { alpha: false })) throw new Error("this browser has no WebGL 2");
  return canvas;
}

// Returns the names of both halves of the image, and a function that hides the names of halves that are not shown.
function half_labels(names) {
  const halves = names.map((name) => element("span", {}, name)), box = element("div", { className: "halves" }, ...halves);
  return {
    box,
    show: () => {
      box.hidden = viewer.state.blends;
      halves.forEach((each, i) => { each.hidden = viewer.state.truth === (i === 0 ? 100 : 0); });
    },
  };
}

async function fill_viewer(section) {
  const canvas = lit_canvas("The material under a light, which arrow keys move");
  if (typeof DecompressionStream === "undefined") throw new Error("this browser cannot unpack tables");
  const table = await read_table(data.viewer.table);
  const uncertainty = { grid: data.viewer.uncertainty.grid, levels: await inflated(data.viewer.uncertainty.codes) };
  const truth = data.viewer.truth ? await read_table(data.viewer.truth) : null;
  const reflects = (share, ...directions) => blended(share, (which) => reflectance_at(which ? truth : table, ...directions));
  viewer.view = new material_view(canvas, { table, truth, uncertainty });
  const start = angle_between(light_direction(viewer.state), [0, 0, 1]);
  const redraw = redraw_with(viewer.view, data.viewer.exposure / white_mean(start));
  const surround = () => { viewer.surrounded ??= new surrounded_view(viewer.view, { table, truth }); };
  const panel = controls(() => changed(), surround);
  const lobe = lobe_figure((...directions) => reflects(viewer.state.blends ? viewer.state.truth / 100 : 0, ...directions), uncertainty);
  const readout = element("p", { className: "soft readout" });
  const labels = half_labels(data.viewer.truth ? ["from the samples", "the truth"] : []);
  const changed = () => {
    panel.show();
    labels.show();
    redraw();
    readout.textContent = "";
    lobe.draw({ known: viewer.state.known && !is_surrounded(), is_view: is_surrounded() });
  };
  moved_by_hand(canvas, (right, up) => { move_light(right, up); changed(); });
  canvas.addEventListener("pointermove", (event) => {
    const n = normal_at(event, canvas);
    readout.textContent = n ? told_at(n, reflects, uncertainty) : "";
    const theta_i = n ? angle_between(n, is_surrounded() ? [0, 0, 1] : light_direction(viewer.state)) : Math.PI;
    if (theta_i < radians(89)) lobe.draw({ theta_i });
  });
  panel.box.append(lobe.box);
  section.append(paragraph("Drag, or use the arrow keys, to move the light. A pointer over the sphere reads the BRDF there, and shows its lobe."),
    element("div", { className: "viewer" }, element("div", {}, element("div", { className: "image" }, canvas, labels.box), readout), panel.box));
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
