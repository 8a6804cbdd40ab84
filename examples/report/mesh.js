// Reads models for the viewer: Wavefront OBJ files on the reader's disk.

const most_triangles = 1e6;

// Returns the index, from 0, of a field such as 3, counted from 1, or -1, counted back from the last.
function obj_index(field, count) {
  const index = Number(field) > 0 ? Number(field) - 1 : count + Number(field);
  if (!Number.isInteger(index) || index < 0 || index >= count) throw new Error(`there is no vertex ${field}`);
  return index;
}

// Returns positions, normals, and the corners of triangles: indices of a position and of a normal, or null without a normal.
// Polygons become fans of triangles.
function obj_triangles(text) {
  const positions = [], normals = [], corners = [];
  const numbers = (fields) => {
    const found = fields.slice(1, 4).map(Number);
    if (found.length < 3 || !found.every(Number.isFinite)) throw new Error(`"${fields.join(" ")}" has no three numbers`);
    return found;
  };
  for (const line of text.split("\n")) {
    const fields = line.trim().split(/\s+/);
    if (fields[0] === "v") positions.push(numbers(fields));
    if (fields[0] === "vn") normals.push(numbers(fields));
    if (fields[0] !== "f") continue;
    const face = fields.slice(1).map((each) => {
      const [position, , normal] = each.split("/");
      return [obj_index(position, positions.length), normal ? obj_index(normal, normals.length) : null];
    });
    for (let i = 2; i < face.length; ++i) corners.push(face[0], face[i - 1], face[i]);
    if (corners.length > 3 * most_triangles) throw new Error(`more than ${most_triangles} triangles`);
  }
  if (!corners.length) throw new Error("no faces");
  return { positions, normals, corners };
}

// Returns a normal for each position: the sum of the normals of its triangles, weighted by area.
function smooth_normals({ positions, corners }) {
  const sums = positions.map(() => [0, 0, 0]);
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => corners[i + k][0]);
    const across = cross(along(positions[b], positions[a], -1), along(positions[c], positions[a], -1));
    for (const k of [a, b, c]) sums[k] = along(sums[k], across, 1);
  }
  return sums;
}

// Returns the position, within the unit sphere, and the normal of each corner of the triangles: six numbers per corner.
// Throws Error if the text is no model.
function read_obj(text) {
  const model = obj_triangles(text), smooth = smooth_normals(model);
  const used = model.corners.map(([position]) => model.positions[position]);
  const bound = (pick) => [0, 1, 2].map((k) => used.reduce((best, each) => pick(best, each[k]), used[0][k]));
  const low = bound(Math.min), high = bound(Math.max), centre = along(low, high, 1).map((each) => each / 2);
  const radius = used.reduce((most, each) => Math.max(most, length(along(each, centre, -1))), 0);
  if (!(radius > 0)) throw new Error("no extent");
  const vertices = new Float32Array(6 * used.length);
  model.corners.forEach(([position, normal], i) => {
    vertices.set(along(model.positions[position], centre, -1).map((each) => each / radius), 6 * i);
    vertices.set(normal === null ? smooth[position] : model.normals[normal], 6 * i + 3);
  });
  return vertices;
}

const mesh_vertex_shader = `#version 300 es
in vec3 position, towards;
uniform float turn, size;
uniform vec2 within_pixel;
out vec3 normal;
vec3 turned(vec3 v) { return vec3(cos(turn) * v.x + sin(turn) * v.z, v.y, cos(turn) * v.z - sin(turn) * v.x); }
void main() {
  vec3 at = turned(position);
  normal = turned(towards);
  gl_Position = vec4(at.xy + (1.0 - 2.0 * within_pixel) / size, -0.99 * at.z, 1.0);
}`;

// Draws both sides of a triangle: seen from behind, its normal is reversed.
const mesh_main = `
in vec3 normal;
void main() {
  vec3 n = normalize(normal);
  if (n.z < 0.0 && !gl_FrontFacing) n = -n;
  lit_point point = lit_point(true, n, light, vec3(0.0, 0.0, 1.0), 1.0);
  colour = added_or_shown(seen(point, right_of_middle()));
}`;
