// The materials of the prior that ships, to browse: as spheres, two side by side under a light, and in the plane of a light.

const model_keys = ["red", "green", "blue", "metal", "highlight", "roughness"];
Object.assign(viewer.state, { truth: 50, red: 0.45, green: 0.06, blue: 0.05, metal: 0, highlight: 0.04, roughness: 0.25 });
const model_name = "the model";
const library = { materials: [], chosen: ["", model_name], tables: [] };

const number_of = (name) => library.materials.indexOf(name);
const model_numbers = () => model_keys.map((key) => viewer.state[key]);
const reflectances = (computed, name) => (name === model_name ? computed.tabulate(model_numbers(), "tabulate_model")
  : computed.tabulate([], "tabulate_material", number_of(name)));
const curve_of = (computed, name) => (name === model_name ? computed.ask("model_curve", model_numbers())
  : computed.ask("material_curve", [], number_of(name)));

// ---- the contact sheet -------------------------------------------------------------------------------------------
function tile(name, choose) {
  const canvas = element("canvas", { width: 96, height: 96 });
  canvas.setAttribute("aria-hidden", "true");
  const button = element("button", { type: "button", title: name }, canvas, element("span", {}, name));
  button.addEventListener("click", () => choose(name));
  return { canvas, button };
}

// Draws every tile through one view on a hidden canvas.
async function fill_tiles(computed, tiles) {
  const table = new changing_table(computed.cells());
  const canvas = element("canvas", { width: 96, height: 96 });
  if (!canvas.getContext("webgl2", { alpha: false, preserveDrawingBuffer: true })) throw new Error("this browser has no WebGL 2");
  const view = new material_view(canvas, { table: table.shown, truth: null, uncertainty: no_uncertainty });
  const state = { ...viewer.state, truth: 0, samples: 3, exposure: 0.7 / white_mean(angle_between(light_direction(viewer.state), [0, 0, 1])) };
  for (const [i, name] of library.materials.entries()) {
    table.take(reflectances(computed, name));
    table.show_in(view);
    view.draw(state);
    tiles[i].canvas.getContext("2d").drawImage(canvas, 0, 0);
    if (i % 4 === 3) await painted();
  }
}

// ---- two materials -----------------------------------------------------------------------------------------------
const no_uncertainty = { grid: [1, 1, 1], levels: new Uint8Array(1) };
const sides = [{ label: "Left", colour: "var(--fit)", dash: "none" }, { label: "Right", colour: "var(--wrong)", dash: "7,4" }];

function plane_chart(angles, curves) {
  const points = curves.map((curve) => angles.map((angle, i) => ({ angle, value: Math.max(1e-5, 0.2126 * curve[3 * i] + 0.7152 * curve[3 * i + 1] + 0.0722 * curve[3 * i + 2]) })));
  const chart = Plot.plot({
    width: width_of(640), height: 320, marginLeft: 60, marginBottom: 44, style: { fontSize: "13px" },
    x: { domain: [-88, 88], label: "viewer, degrees from the normal; the light is at \u221245", labelArrow: "none", labelAnchor: "center", ticks: [-75, -45, -15, 15, 45, 75] },
    y: { type: "log", label: "luminance, sr\u207b\u00b9", grid: true, ticks: 5, tickFormat: (value) => String(Number(value.toPrecision(1))) },
    marks: points.map((each, i) => Plot.line(each, { x: "angle", y: "value", stroke: sides[i].colour, strokeWidth: 2, strokeDasharray: sides[i].dash })),
  });
  chart.setAttribute("role", "img");
  chart.setAttribute("aria-label", `Luminance of ${library.chosen.join(" and ")} against the viewer's angle`);
  return without_names(chart);
}

const legend = () => element("ul", { className: "curves" }, ...sides.map(({ colour, dash }, i) => {
  const line = element("span", { className: "line" });
  line.style.borderTop = `3px ${dash === "none" ? "solid" : "dashed"} ${colour}`;
  return element("li", {}, line, library.chosen[i]);
}));

function chooser(side, changed) {
  const select = element("select", {}, ...[model_name, ...library.materials].map((name) => element("option", {}, name)));
  select.addEventListener("input", () => { library.chosen[side] = select.value; changed(side); });
  return { row: element("label", {}, element("span", {}, sides[side].label), select), show: () => { select.value = library.chosen[side]; } };
}

function model_sliders(changed) {
  const share = (value) => `${Math.round(100 * value)} %`, told = (value) => value.toFixed(2);
  return [slider("Colour, red", "red", [0, 1, 0.01], told, changed), slider("green", "green", [0, 1, 0.01], told, changed),
    slider("blue", "blue", [0, 1, 0.01], told, changed), slider("Metal", "metal", [0, 1, 0.01], share, changed),
    slider("Highlight (f0)", "highlight", [0, 0.2, 0.005], (value) => value.toFixed(3), changed),
    slider("Roughness (alpha)", "roughness", [0.02, 1, 0.01], told, changed)];
}

function fill_pair(section, computed) {
  const canvas = lit_canvas("A sphere under a light, which arrow keys move: the left half of one material, the right half of another");
  const figure = element("figure"), names = element("div"), labels = half_labels(library.chosen);
  const angles = computed.ask("curve_angles");
  library.tables = sides.map(() => new changing_table(computed.cells()));
  library.tables.forEach((each, side) => each.take(reflectances(computed, library.chosen[side])));
  viewer.view = new material_view(canvas, { table: library.tables[0].shown, truth: library.tables[1].shown, uncertainty: no_uncertainty });
  const redraw = redraw_with(viewer.view, 1 / white_mean(angle_between(light_direction(viewer.state), [0, 0, 1])));
  const changed = (side) => {
    library.tables[side].take(reflectances(computed, library.chosen[side]));
    library.tables[side].show_in(viewer.view, side);
    show();
  };
  const choosers = sides.map((_, side) => chooser(side, changed));
  const sliders = model_sliders(() => library.chosen.forEach((name, side) => { if (name === model_name) changed(side); }));
  const border = slider("Border", "truth", [0, 100, 1], (value) => `${100 - value} %`, () => show());
  const exposure = slider("Exposure", "stops", [-6, 6, 0.25], (value) => `${value > 0 ? "+" : ""}${value} stops`, () => show());
  const show = () => {
    [...choosers, ...sliders, border, exposure, labels].forEach((each) => each.show());
    [...labels.box.children].forEach((each, side) => { each.textContent = library.chosen[side]; });
    sliders.forEach((each) => { each.row.hidden = !library.chosen.includes(model_name); });
    figure.replaceChildren(plane_chart(angles, library.chosen.map((name) => curve_of(computed, name))));
    names.replaceChildren(legend());
    redraw();
  };
  moved_by_hand(canvas, (right, up) => { move_light(right, up); redraw(); });
  section.append(element("div", { className: "viewer" }, element("div", { className: "image" }, canvas, labels.box),
    element("div", { className: "controls" }, ...choosers.map((each) => each.row), border.row, exposure.row, ...sliders.map((each) => each.row))),
  element("h3", {}, "Both in the plane of a light"), names, figure);
  show();
  return (name) => { library.chosen[0] = name; changed(0); };
}

open_lesson("Materials to browse",
  ["All materials of the prior that ships, each by its 100 components. Click a sphere: it is the left half of the large one. The right half is another material, or a model of six numbers: a matt base below a GGX lobe. How near can you bring the model to the material?"],
  async (computed) => {
    library.materials = computed.materials().map(({ name }) => name);
    const named = decodeURIComponent(location.hash.slice(1));
    library.chosen[0] = library.materials.includes(named) ? named : "red-plastic";
    const pair = element("section", {}, element("h2", {}, "Two under a light"), paragraph("Drag on the sphere, or use the arrow keys, to move the light."));
    const sheet = element("section", {}, element("h2", {}, `${library.materials.length} materials`));
    page.append(pair, sheet);
    try {
      const choose = fill_pair(pair, computed);
      const tiles = library.materials.map((name) => tile(name, (chosen) => {
        choose(chosen);
        history.replaceState(null, "", `#${encodeURIComponent(chosen)}`);
        pair.scrollIntoView();
      }));
      sheet.append(element("div", { className: "sheet" }, ...tiles.map((each) => each.button)));
      await fill_tiles(computed, tiles);
    } catch (error) {
      pair.append(paragraph(`No sphere can be shown here: ${error.message}.`, "failed"));
      sheet.append(element("ul", {}, ...library.materials.map((name) => element("li", {}, name))));
    }
  });
