// The data of the page, and the values of its tables (docs/reference/formats.md, examples/tool/pages/viewer_table.cpp)
// for a pair of directions above a surface.
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);

// Returns the inflated bytes of base64 text.
async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
}

// Returns the value of a half float without its last two bits.
function half_of(code) {
  const exponent = code >> 8, fraction = (code & 255) / 256;
  return exponent === 0 ? fraction * 2 ** -14 : (1 + fraction) * 2 ** (exponent - 15);
}

// Calls visit(cell of the grid, its valid cell, cos theta_i cos theta_o there) for all cells. Below the horizon, the
// valid cell is the last one above it, with the largest theta_h. Returns the number of valid cells.
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

// Returns a table whose texels are red, green, blue and 1, times both cosines. A look-up interpolates them and divides
// by the last one: a cell near the horizon counts by the light it reflects. The last one is times 2^14, to fit half
// floats.
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
const radians = (degrees) => degrees * Math.PI / 180;
const angle_between = (a, b) => Math.atan2(length(cross(a, b)), dot(a, b));

// Returns coordinates from 0 to 1 along theta_h, theta_d and phi_d.
function grid_coordinates(n, wi, wo) {
  const sum = along(wi, wo, 1), difference = along(wi, wo, -1), size = length(sum);
  const phi_d = Math.atan2(dot(n, cross(sum, difference)), -dot(n, difference) * size) / Math.PI;
  return [Math.sqrt(angle_between(n, sum) * 2 / Math.PI), Math.atan2(length(difference), size) * 2 / Math.PI, phi_d - Math.floor(phi_d)];
}

// Returns red, green and blue in sr^-1, interpolated between the eight nearest cells.
function reflectance_at({ grid, shift, scale, texels }, n, wi, wo) {
  if (!(dot(n, wi) > 0 && dot(n, wo) > 0)) return [0, 0, 0];
  const coordinates = grid_coordinates(n, wi, wo).map((share, i) => share * grid[i] + shift - 0.5);
  const lower = coordinates.map(Math.floor), sum = [0, 0, 0, 0];
  for (let corner = 0; corner < 8; ++corner) {
    let weight = 1;
    const [h, d, p] = lower.map((each, i) => {
      const upper = (corner >> i) & 1, share = coordinates[i] - each;
      weight *= upper ? share : 1 - share;
      return i === 2 ? (each + upper + grid[2]) % grid[2] : Math.min(Math.max(each + upper, 0), grid[i] - 1);
    });
    for (let k = 0, at = 4 * ((h * grid[1] + d) * grid[2] + p); k < 4; ++k) sum[k] += weight * texels[at + k];
  }
  return sum.slice(0, 3).map((each) => each / sum[3] * scale);
}

// Mixes values(false) and values(true) by their logarithms, as the shader does.
function blended(share, values) {
  if (share <= 0 || share >= 1) return values(share >= 1);
  const [a, b] = [values(false), values(true)].map((each) => each.map((value) => Math.log(Math.max(value, 1e-6))));
  return a.map((each, i) => Math.exp(each + share * (b[i] - each)));
}

// Returns the uncertainty, from 0.001 to 10, of a stored level from 0 to 1.
const uncertainty_of = (level) => 0.001 * 10 ** (4 * level);
function uncertainty_at({ grid, levels }, n, wi, wo) {
  const [h, d, p] = grid_coordinates(n, wi, wo).map((share, i) => Math.min(Math.floor(share * grid[i]), grid[i] - 1));
  return uncertainty_of(levels[(h * grid[1] + d) * grid[2] + p] / 255);
}

