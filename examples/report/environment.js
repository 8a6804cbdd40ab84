
// Light from all around: latitude-longitude pictures as include/gonio/render/environment_map.hpp has them, and directions
// that are drawn from one in proportion to its luminance.

const draws_side = 256, last_frame = 256;
const light_luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

// A sky with a sun, above a dark floor.
function formula_sky(rows = 64) {
  const columns = 2 * rows, radiance = new Float32Array(3 * rows * columns), sun = [0.5, 0.6, 0.6245];
  for (let i = 0; i < rows * columns; ++i) {
    const d = direction_in(rows, Math.floor(i / columns) + 0.5, i % columns + 0.5);
    const height = Math.max(d[1], 0), glow = 60 * Math.exp(150 * (dot(d, sun) - 1));
    const sky = d[1] > 0 ? [0.9 - 0.6 * height, 1 - 0.45 * height, 1.1 - 0.1 * height] : [0.2, 0.17, 0.14];
    radiance.set([sky[0] + glow, sky[1] + 0.9 * glow, sky[2] + 0.75 * glow], 3 * i);
  }
  return { rows, columns, radiance };
}

// Places are counted in rows from the top and in columns from the left.
function direction_in(rows, row, column) {
  const t = Math.PI * row / rows, l = Math.PI * column / rows - Math.PI;
  return [Math.sin(t) * Math.sin(l), Math.cos(t), -Math.sin(t) * Math.cos(l)];
}

// Directions along the rows of the picture, each standing for an equal share of its luminance, and their radiance times
// solid angle. O(pixels + draws).
function draws_of({ rows, columns, radiance }) {
  const count = draws_side ** 2, towards = new Float32Array(4 * count), weights = new Float32Array(4 * count);
  const solid = (row) => Math.PI / rows * (Math.cos(Math.PI * row / rows) - Math.cos(Math.PI * (row + 1) / rows));
  const share = (i) => light_luminance(...radiance.subarray(3 * i, 3 * i + 3)) * solid(Math.floor(i / columns));
  let total = 0;
  for (let i = 0; i < rows * columns; ++i) total += share(i);
  for (let k = 0, i = 0, passed = share(0); k < count; ++k) {
    while (passed < (k + 0.5) / count * total && i + 1 < rows * columns) passed += share(++i);
    const row = Math.floor(i / columns), up = Math.cos(Math.PI * row / rows), down = Math.cos(Math.PI * (row + 1) / rows);
    const t = Math.acos(up + (down - up) * Math.random());
    towards.set(direction_in(rows, t * rows / Math.PI, i % columns + Math.random()), 4 * k);
    const rgb = radiance.subarray(3 * i, 3 * i + 3);
    weights.set(rgb.map((each) => each * total / count / light_luminance(...rgb)), 4 * k);
  }
  return { towards, weights };
}

// The mean luminance of a white Lambertian sphere: by it gonio render exposes.
function white_luminance({ towards, weights }, turn) {
  let sum = 0;
  for (let i = 0; i < towards.length; i += 4) {
    const z = towards[i + 2] * Math.cos(turn) - towards[i] * Math.sin(turn);
    sum += light_luminance(weights[i], weights[i + 1], weights[i + 2]) * white_mean(Math.acos(Math.max(-1, Math.min(1, z)))) / Math.PI;
  }
  return sum;
}

// Shows the mean of frames that were added.
const shown_main = `
void main() {
  colour = vec4(display_value(texelFetch(added, ivec2(gl_FragCoord.xy), 0).rgb / float(frame)), 1.0);
  if (abs(gl_FragCoord.x / size * 2.0 - 1.0 - border) < 1.5 / size) colour.rgb = vec3(0.6);
}`;

// A texture of four floats a pixel, which is read as it is.
function float_texture(gl, unit, width, height, values) {
  const texture = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  return texture;
}

// Frames of a view in an environment, added in two textures by turns.
class surrounded_view {
  constructor(view) {
    const own = view.gl;
    if (!own.getExtension("EXT_color_buffer_float")) throw new Error("this browser cannot draw into floats");
    Object.assign(this, { view, gl: own, frame: 0, side: 0, turn: null });
    this.shown = view.made_of(vertex_shader, shown_main, [["corner", 2]], new Float32Array([-1, -1, 3, -1, -1, 3]));
    this.take(formula_sky());
  }

  // `map` as read_hdr returns it.
  take(map) {
    this.draws = draws_of(map);
    float_texture(this.gl, 3, draws_side, draws_side, this.draws.towards);
    float_texture(this.gl, 4, draws_side, draws_side, this.draws.weights);
    this.frame = 0;
    this.turn = null;
  }

  resize(side) {
    const { gl } = this;
    this.side = side;
    this.added = [0, 1].map(() => float_texture(gl, 5, side, side, null));
    this.target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.bindRenderbuffer(gl.RENDERBUFFER, gl.createRenderbuffer());
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, side, side);
    const depth = gl.getParameter(gl.RENDERBUFFER_BINDING);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  }

  // Adds a frame and shows the mean; `exposure` is the mean luminance of a white sphere.
  draw(state) {
    const { gl, view } = this, turn = radians(state.longitude);
    if (this.side !== view.canvas.width) this.resize(view.canvas.width);
    if (this.turn !== turn) this.white = white_luminance(this.draws, this.turn = turn);
    const [from, to] = this.frame % 2 ? this.added : [this.added[1], this.added[0]];
    const all = { ...state, exposure: state.exposure / this.white, samples: 1, frame: this.frame, surrounded: true };
    gl.activeTexture(gl.TEXTURE5);
    gl.bindTexture(gl.TEXTURE_2D, from);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, to, 0);
    view.draw(all);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_2D, to);
    view.draw({ ...all, frame: ++this.frame }, this.shown);
  }
}
