// The viewer's lobe: reflectance in all directions for one direction of the light, as a surface in space.

// Projects a point, seen from 22 degrees above the surface and turned about the normal: right, up and nearness.
function projected([x, y, z], turn) {
  const ahead = radians(22), right = x * Math.cos(turn) - y * Math.sin(turn), back = x * Math.sin(turn) + y * Math.cos(turn);
  return [right, z * Math.cos(ahead) + back * Math.sin(ahead), z * Math.sin(ahead) - back * Math.cos(ahead)];
}

const spherical = (theta, phi) => [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];

// Returns rows of directions from the normal to 88 degrees with the reflectance for light at theta_i. For a view at
// theta_i, it is the same by reciprocity.
function lobe_of(reflects, uncertainty, theta_i) {
  const n = [0, 0, 1], wi = spherical(theta_i, 0), rows = 44, columns = 72;
  return Array.from({ length: rows + 1 }, (_, row) => Array.from({ length: columns + 1 }, (_, column) => {
    const wo = spherical(radians(88 * row / rows), 2 * Math.PI * column / columns);
    return { wo, value: luminance(reflects(n, wi, wo)), known: uncertainty_at(uncertainty, n, wi, wo) };
  }));
}

// Returns the fields between the directions, from back to front.
function lobe_fields(lobe, radius, turn) {
  const points = lobe.map((row) => row.map((each) => ({ known: each.known, at: each.wo.map((x) => radius(each.value) * x) })));
  const fields = [];
  for (let i = 0; i + 1 < points.length; ++i)
    for (let k = 0; k + 1 < points[i].length; ++k) {
      const corners = [points[i][k], points[i][k + 1], points[i + 1][k + 1], points[i + 1][k]];
      const across = cross(along(corners[2].at, corners[0].at, -1), along(corners[3].at, corners[1].at, -1));
      const drawn = corners.map((each) => projected(each.at, turn)), size = length(across);
      if (size > 0) fields.push({ drawn, known: corners[0].known, shade: Math.abs(dot(projected(across, turn), [0.35, 0.65, 0.67])) / size,
        near: drawn.reduce((sum, each) => sum + each[2], 0) });
    }
  return fields.sort((a, b) => a.near - b.near);
}

// Returns the colour of an uncertainty, the same as in the page's map and in the shader.
function colour_of_known(share) {
  const t = Math.min(Math.max(Math.log(share / 0.02) / Math.log(50), 0), 1);
  return [243, 236, 210].map((each, i) => each + t * ([18, 58, 99][i] - each));
}

function draw_lobe(canvas, reflects, uncertainty, { theta_i, turn, known }) {
  const context = canvas.getContext("2d"), style = getComputedStyle(canvas), colour = (name) => style.getPropertyValue(name);
  const lobe = lobe_of(reflects, uncertainty, theta_i), values = lobe.flatMap((row) => row.map((each) => each.value));
  const { radius, kind } = radius_of(values), largest = Math.max(...values.map(radius)) || 1;
  const size = 0.44 * canvas.width, on_canvas = ([x, y]) => [0.5 * canvas.width + size * x, 0.74 * canvas.height - size * y];
  const path = (points) => {
    context.beginPath();
    points.forEach((each) => context.lineTo(...on_canvas(projected(each, turn))));
  };
  const line = (points, stroke, dashes = []) => {
    path(points);
    Object.assign(context, { strokeStyle: stroke, lineWidth: canvas.width / 300 });
    context.setLineDash(dashes);
    context.stroke();
    context.setLineDash([]);
  };
  context.clearRect(0, 0, canvas.width, canvas.height);
  // The plane of the surface as a circle of largest radius, the normal, and the lobe.
  line(Array.from({ length: 73 }, (_, i) => spherical(Math.PI / 2, radians(5 * i))), colour("--line"));
  line([[0, 0, 0], [0, 0, 1]], colour("--line"));
  for (const { drawn, known: share, shade } of lobe_fields(lobe, (value) => radius(value) / largest, turn)) {
    const base = known ? colour_of_known(share) : [88, 150, 214];
    context.fillStyle = context.strokeStyle = `rgb(${base.map((each) => each * (0.45 + 0.55 * shade))})`;
    context.beginPath();
    drawn.forEach((each) => context.lineTo(...on_canvas(each)));
    context.closePath();
    context.fill();
    context.lineWidth = 0.7;
    context.stroke();
  }
  line([[0, 0, 0], spherical(theta_i, 0).map((x) => 1.1 * x)], colour("--ink"), [canvas.width / 60, canvas.width / 100]);
  line([[0, 0, 0], spherical(theta_i, Math.PI).map((x) => 1.1 * x)], colour("--ink"), [canvas.width / 200, canvas.width / 100]);
  return kind;
}

// Returns a figure of the lobe, which dragging and arrow keys turn, and a function that draws it again with changes.
function lobe_figure(reflects, uncertainty) {
  const canvas = element("canvas", { width: 600, height: 460, tabIndex: 0, className: "lobe" }), caption = element("figcaption");
  const state = { theta_i: radians(45), turn: radians(-62), known: false, is_view: false };
  canvas.setAttribute("role", "img");
  const draw = (changes = {}) => {
    Object.assign(state, changes);
    const kind = draw_lobe(canvas, reflects, uncertainty, state);
    const at = `${state.is_view ? "a view" : "light"} at ${angle(state.theta_i * 180 / Math.PI)}`;
    caption.textContent = `Lobe for ${at} (dashes; dots: mirror); radius ${kind}`;
    canvas.setAttribute("aria-label", `The lobe for ${at}, which arrow keys turn`);
  };
  moved_by_hand(canvas, (right) => draw({ turn: state.turn + radians(right) }));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => draw());
  return { box: element("figure", {}, canvas, caption), draw };
}

