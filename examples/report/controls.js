
// The controls beside the viewer's image: sliders, choices and files, which set viewer.state and call changed().

const in_degrees = (value) => `${Math.round(value)}\u00b0`;

function slider(label, key, [min, max, step], told, changed) {
  const output = element("output");
  const input = element("input", { type: "range", min, max, step, value: viewer.state[key] });
  const show = () => { input.value = viewer.state[key]; output.textContent = told(viewer.state[key]); };
  input.addEventListener("input", () => { viewer.state[key] = Number(input.value); changed(); });
  return { show, row: element("label", {}, element("span", {}, label), input, output) };
}

// `options` are pairs of a value of the state and its name.
function choice(label, key, options, changed, state = viewer.state) {
  const select = element("select", {}, ...options.map(([value, name]) => element("option", { value }, name)));
  select.addEventListener("input", () => { state[key] = options[select.selectedIndex][0]; changed(); });
  return element("label", {}, element("span", {}, label), select);
}

// Returns the choice of a model's file and a slider that turns the model. Both are visible while the shape is a model.
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

// Returns the choice of light: a lamp, or an environment, which is a room or a file with a light probe. `surround`
// prepares the viewer for environments.
function light_rows(changed, surround) {
  const input = element("input", { type: "file", accept: ".hdr" }), problem = element("output", { className: "problem" });
  const lights = choice("Light", "light", [["lamp", "lamp"], ["environment", "environment"]], () => {
    problem.textContent = "";
    try {
      if (is_surrounded()) surround();
    } catch (error) {
      viewer.state.light = lights.querySelector("select").value = "lamp";
      problem.textContent = `no environment: ${error.message}`;
    }
    changed();
  });
  input.addEventListener("change", async () => {
    problem.textContent = "";
    try {
      viewer.surrounded.take(input.files.length ? read_hdr(new Uint8Array(await input.files[0].arrayBuffer())) : room_with_windows());
    } catch (error) {
      problem.textContent = `not a light probe: ${error.message}`;
    }
    changed();
  });
  const file = element("label", { title: "Without a file: a room with windows" }, element("span", {}, "File (.hdr)"), input);
  const around = slider("Turned, to the right", "around", [-180, 180, 1], in_degrees, changed);
  const lamp = [slider("Light, to the right", "longitude", [-180, 180, 1], in_degrees, changed),
    slider("Light, upwards", "latitude", [-90, 90, 1], in_degrees, changed)];
  return {
    rows: [lights, problem, file, around.row, ...lamp.map((each) => each.row)],
    show: () => {
      [around, ...lamp].forEach((each) => each.show());
      for (const each of [file, around.row]) each.hidden = !is_surrounded();
      lamp.forEach((each) => { each.row.hidden = is_surrounded(); });
    },
  };
}

// Returns the choice of the truth's share: on the right of a border, or mixed with the fit.
function truth_rows(changed) {
  const share = slider("Truth", "truth", [0, 100, 1], (value) => `${value} %`, changed);
  const shown = choice("Truth is shown", "blends", [[false, "beside the fit"], [true, "blended with the fit"]], changed);
  return { rows: [shown, share.row], show: share.show };
}

// Returns the switch of uncertainty. A pair of directions has an uncertainty: this needs the lamp.
function known_rows(changed) {
  const known = element("input", { type: "checkbox" });
  known.addEventListener("input", () => { viewer.state.known = known.checked; changed(); });
  const legend = element("p", { className: "legend soft" }, "2 %", element("span", { className: "ramp" }), "100 %");
  const label = element("label", {}, element("span", {}, "Uncertainty"), known);
  return {
    rows: [label, legend],
    show: () => {
      known.disabled = is_surrounded();
      label.title = is_surrounded() ? "How well a direction is known needs light from one direction: choose the lamp" : "";
      legend.hidden = is_surrounded() || !viewer.state.known;
    },
  };
}

function controls(changed, surround) {
  const exposure = slider("Exposure", "stops", [-6, 6, 0.25], (value) => `${value > 0 ? "+" : ""}${value} stops`, changed);
  const model = model_rows(changed);
  const parts = [light_rows(changed, surround), { rows: [exposure.row], show: exposure.show }, known_rows(changed)];
  if (data.viewer.truth) parts.splice(2, 0, truth_rows(changed));
  return {
    box: element("div", { className: "controls" },
      choice("Shape", "shape", [["sphere", "sphere"], ["flat", "flat sample"], ["mesh", "a model"]], changed), ...model.rows,
      ...parts.flatMap((each) => each.rows)),
    show: () => {
      [model, ...parts].forEach((each) => each.show());
      model.rows.forEach((each) => { each.hidden = viewer.state.shape !== "mesh"; });
    },
  };
}
