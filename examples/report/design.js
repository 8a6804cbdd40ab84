// The parts of the page of gonio design --report: which directions to measure, and what that leaves unknown.

function design_answer() {
  const { design } = data, count = design.directions.length;
  add(element("h1", {}, data.name), paragraph(design.sentence, "headline"),
    paragraph(`${count} ${count === 1 ? "measurement" : "measurements"}, in the order in which they help most: ` +
      "whoever stops early has measured the best ones.", "soft"));
}

function told_of_pose(each) {
  return `measurement ${each.number}\nlight: theta ${angle(each.theta_i)}, phi ${angle(each.phi_i)}\nviewer: theta ${angle(each.theta_o)}, phi ${angle(each.phi_o)}`;
}

function design_map() {
  const { design } = data, given = data.samples ?? [], known = data.map ? fields_of_map(data.map) : { marks: [], scale: undefined };
  add(element("h2", {}, "Where"), paragraph((data.map ? "The number in each field: to how many percent directions are known now, the median over the third angle. " : "") +
    "Numbered: what to measure" + (given.length ? "; small dots: what was measured." : ".") + " Left: the highlight; top: grazing light and viewer."));
  const chart = Plot.plot({ ...angle_axes, color: known.scale, marks: [
    ...known.marks,
    ...(data.map ? [] : [Plot.gridX({ stroke: "var(--line)" }), Plot.gridY({ stroke: "var(--line)" })]),
    Plot.dot(given, { x: "theta_h", y: "theta_d", r: 3, fill: "#ffffff", stroke: "#000000" }),
    Plot.dot(design.directions, { x: "theta_h", y: "theta_d", r: 9, fill: "#c2410c", stroke: "#ffffff", strokeWidth: 1.5 }),
    Plot.text(design.directions, { x: "theta_h", y: "theta_d", text: (each) => String(each.number), fill: "#ffffff", fontWeight: 700, fontSize: 11 }),
    Plot.tip(design.directions, Plot.pointer({ x: "theta_h", y: "theta_d", title: told_of_pose })),
  ] });
  add(figure(chart, `Map of ${design.directions.length} directions to measure over half and difference angle`, "gonio plan turns them into an order and an image of lamp and camera.",
    ["measurement", "theta_h", "theta_d", "phi_d"],
    design.directions.map((each) => [String(each.number), angle(each.theta_h), angle(each.theta_d), angle(each.phi_d)])));
}

function design_table() {
  const row = (each) => [String(each.number), ...["theta_i", "phi_i", "theta_o", "phi_o"].map((name) => angle(each[name]))];
  add(element("h2", {}, "Directions"), element("div", { className: "scroll" },
    table(["measurement", "light, theta", "light, phi", "viewer, theta", "viewer, phi"], data.design.directions.map(row))));
}
