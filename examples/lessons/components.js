// Lesson 2: a material made of five numbers, and the error as a function of the number of measurements.

// Meanings of the shipped prior's components, as in docs/learn/components.md.
const named = ["Height of the highlight", "Brightness of all else", "Width of the highlight", "Grazing angles (Fresnel)", "A mixture"];
const keys = named.map((_, i) => `component_${i + 1}`);
for (const key of keys) viewer.state[key] = 0;

// ---- the material ----------------------------------------------------------------------------------------------
let shown_table = null; // the table on the sphere

// Weights (red, then green, then blue) of the start material plus the sliders' change, equal in all channels.
const weights_by = (start, deviations) => start.map((weight, i) => weight + viewer.state[keys[i % keys.length]] * deviations[i % keys.length]);

function choose_start(materials, changed) {
  const select = element("select", {}, ...materials.map(({ name }, i) => element("option", { value: i }, name)));
  select.addEventListener("input", changed);
  return { row: element("label", {}, element("span", {}, "Start from"), select), weights: () => materials[select.value].weights, select };
}

async function fill_material(section, computed) {
  const canvas = lit_canvas("A sphere of the material under a light, which arrow keys move");
  const described = computed.ask("describe_components"), count = keys.length;
  const deviations = described.slice(0, count), shares = described.slice(count);
  const mean = { name: "the mean of all materials", weights: new Array(3 * count).fill(0) };
  const materials = [mean, ...computed.materials().sort((a, b) => a.name.localeCompare(b.name, "en"))];
  const values = shown_table = new changing_table(computed.cells());
  viewer.view = new material_view(canvas, { table: values.shown, truth: null, uncertainty: { grid: [1, 1, 1], levels: new Uint8Array(1) } });
  const start = angle_between(light_direction(viewer.state), [0, 0, 1]);
  const redraw = redraw_with(viewer.view, 2 / white_mean(start));

  const told = (value) => `${value > 0 ? "+" : ""}${value.toFixed(1)}`;
  const sliders = keys.map((key, i) => slider(`${i + 1}. ${named[i]}, ${(100 * shares[i]).toFixed(0)}\u00a0%`, key, [-3, 3, 0.1], told, () => material_changed()));
  const exposure = slider("Exposure", "stops", [-6, 6, 0.25], (value) => `${told(value)} stops`, () => { exposure.show(); redraw(); });
  const from = choose_start(materials, () => material_changed());
  const reset = element("button", { type: "button" }, "Reset");
  const material_changed = () => {
    sliders.forEach((each) => each.show());
    values.take(computed.tabulate(weights_by(from.weights(), deviations)));
    values.show_in(viewer.view);
    redraw();
  };
  reset.addEventListener("click", () => {
    for (const key of keys) viewer.state[key] = 0;
    from.select.value = 0;
    material_changed();
  });
  moved_by_hand(canvas, (right, up) => { move_light(right, up); redraw(); });
  section.append(element("div", { className: "viewer" }, canvas,
    element("div", { className: "controls" }, from.row, ...sliders.map((each) => each.row), reset, exposure.row)));
  exposure.show();
  material_changed();
}

// ---- the error -------------------------------------------------------------------------------------------------
const counts = [1, 2, 5, 10, 20], painted_materials = ["red-paint", "blue-rubber"], colours = ["var(--wrong)", "var(--fit)"];

function error_chart(points) {
  const chart = Plot.plot({
    width: width_of(640), height: 340, marginLeft: 56, marginRight: 92, marginBottom: 44, style: { fontSize: "13px" },
    x: { type: "log", domain: [0.9, 22], label: "measurements", labelArrow: "none", ticks: counts, tickFormat: String, labelAnchor: "center" },
    y: { type: "log", domain: [0.6, 60], label: "Delta E of a sphere", ticks: [1, 2, 5, 10, 20, 50], tickFormat: String, grid: true },
    marks: [
      Plot.ruleY([1], { stroke: "var(--soft)", strokeDasharray: "4,3" }),
      ...painted_materials.flatMap((name, i) => [
        Plot.line(points.filter((each) => each.name === name), { x: "count", y: "error", stroke: colours[i], strokeWidth: 2 }),
        Plot.dot(points.filter((each) => each.name === name), { x: "count", y: "error", fill: colours[i], r: 4, symbol: ["circle", "square"][i] }),
        Plot.text(points.filter((each) => each.name === name && each.count === 20), { x: "count", y: "error", text: "name", fill: colours[i], textAnchor: "start", dx: 8, dy: i ? 7 : -7 }),
      ]),
    ],
  });
  chart.setAttribute("role", "img");
  chart.setAttribute("aria-label", "Delta E against the number of measurements, for two materials; the table below has the numbers");
  return without_names(chart);
}

function fill_errors(section, computed) {
  viewer.state.components = 100;
  const figure = element("figure"), values = element("div"), status = element("p", { className: "soft" });
  status.setAttribute("role", "status");
  let change = 0;
  const compute = async () => {
    const mine = ++change, points = [];
    for (const count of counts)
      for (let i = 0; i < painted_materials.length; ++i) {
        status.textContent = `Measuring ${painted_materials[i]} in ${count} ${count === 1 ? "direction" : "directions"} ...`;
        await painted();
        if (mine !== change) return;
        computed.tell(data.directions.slice(0, count).flat());
        points.push({ name: painted_materials[i], count, error: computed.calls.delta_e(i, viewer.state.components) });
      }
    figure.replaceChildren(error_chart(points));
    values.replaceChildren(table(["measurements", ...painted_materials],
      counts.map((count) => [String(count), ...points.filter((each) => each.count === count).map((each) => each.error.toFixed(2))]), "Delta E"));
    status.textContent = `With ${viewer.state.components} of 100 components.`;
  };
  const components = slider("Components used", "components", [1, 100, 1], String, () => { components.show(); compute(); });
  components.show();
  section.append(element("div", { className: "controls" }, components.row), status, figure, values,
    paragraph("This runs the program of the lesson (examples/learn/why_twenty.cpp): two materials by formula, which the 137 do not contain, " +
      "measured without noise in the first directions that gonio design chooses, reconstructed as gonio reconstruct does it. The dashed line is a difference that an observer just notices.", "soft"));
  return compute();
}

open_lesson("Five components by slider",
  ["The logarithms of 137 measured materials are a mean and 100 components. Each slider adds one of the first five, in standard deviations of what the materials have. The percentage is its share of all that tells the materials apart."],
  async (computed) => {
    const material = element("section", {}, element("h2", {}, "A material of five numbers"),
      paragraph("Drag on the sphere, or use the arrow keys, to move the light. A material to start from is drawn by its own five numbers: the colour and the highlight are there, the rest is not."));
    const errors = element("section", {}, element("h2", {}, "Why 20 measurements are enough"),
      paragraph("Each measurement is an equation for the components' weights. How far from the truth is the sphere? And with fewer components?"));
    page.append(material, errors);
    await fill_material(material, computed).catch((error) => material.append(paragraph(`No sphere can be shown here: ${error.message}.`, "failed")));
    fill_errors(errors, computed);
  });
